//! Formats that are not read: the instrument or program that wrote the file, and how to get its heights.

use super::{Problem, Result, compound, unpack};

/// A format: its name, where it is read, and the export of the maker's program.
type Known = (&'static str, Way, &'static str);

/// Where the heights of a file can be read.
#[derive(Clone, Copy)]
enum Way {
    /// The Python package SurfaceTopography reads the format.
    SurfaceTopography,
    /// The program Gwyddion reads it.
    Gwyddion,
    /// Only the maker's program does.
    Export,
}

const VK_ANALYZER: &str = "CSV of the heights from VK Analyzer";
const MULTI_FILE: &str = "CSV of the heights from MultiFileAnalyzer";
const LEXT: &str = "CSV of the heights from the LEXT software";
const MAKER: &str = "ASCII from the instrument's software";
const PICTURE: &str = "the heights instead of a picture of them";

/// First bytes, name and export of the formats that the Python package SurfaceTopography reads.
const BY_PACKAGE: [(&[u8], &str, &str); 14] = [
    (b"VK3_", "Keyence VK3 (laser microscope)", VK_ANALYZER),
    (b"VK4_", "Keyence VK4 (laser microscope)", VK_ANALYZER),
    (b"VK6", "Keyence VK6 (laser microscope)", MULTI_FILE),
    (b"VK7", "Keyence VK7 (laser microscope)", MULTI_FILE),
    (b"KPK", "Keyence ZON (digital microscope)", MULTI_FILE),
    (b"VCA DATA", "Bruker OPDx (Vision64, Dektak)", "OPD, SDF or ASCII from Vision64"),
    (b"OLYMPUSRAWFORMAT", "Olympus OIR (laser microscope)", LEXT),
    (b"\x01\xb0\x93\xff", "NT-MDT MDT (atomic force microscope)", "ASCII from Nova"),
    (b"WSxM file copyright", "WSxM", "ASCII matrix from WSxM"),
    (b"fileType", "Agilent or Molecular Imaging MI (atomic force microscope)", "ASCII from PicoView"),
    (b"OmniSurf3D", "Digital Metrology OmniSurf3D", "SDF from OmniSurf3D"),
    (b"Binary TrueMap Data File", "TrueMap TMD", "SDF from TrueMap"),
    (b"MATLAB 5.0 MAT-file", "MATLAB MAT", "writematrix of the heights as CSV"),
    (b"[p3dlin]", "Taylor Hobson (stylus)", "SDF or ASCII from the instrument's software"),
];

/// The same of the formats that the program Gwyddion reads.
const BY_GWYDDION: [(&[u8], &str, &str); 5] = [
    (b":NANONIS_VERSION:", "Nanonis SXM (scanning probe microscope)", "ASCII from Nanonis"),
    (b"S\0T\0i\0M\0a\0g\0e\0", "RHK SM4 (scanning probe microscope)", "ASCII from RHK's software"),
    (b";ANFATEC Parameterfile", "Anfatec (atomic force microscope)", "ASCII from Anfatec's software"),
    (b"[Parameter]", "Omicron or JEOL (scanning probe microscope)", MAKER),
    (b"UK SOFT", "Burleigh (scanning probe microscope)", MAKER),
];

/// The same of the formats that only the maker's program reads.
const BY_EXPORT: [(&[u8], &str, &str); 5] = [
    (b"ZISRAWFILE", "Zeiss CZI (microscope)", "SUR or X3P from ConfoMap"),
    (b"\x70\0\0\0", "Leica LIF (microscope)", "SUR from Leica Map"),
    (b"%PDF", "PDF", "the measurement instead of its report"),
    (b"\x89PNG", "PNG", PICTURE),
    (b"\xff\xd8\xff", "JPEG", PICTURE),
];

/// Formats of text whose numbers would be taken for a matrix or for points in lengths.
const TEXTS: [(&str, &str, &str); 5] = [
    (
        "zygo xyz data file",
        "Zygo XYZ (text of an interferometer, whose x and y are numbers of pixels)",
        "MetroPro DAT, SDF or SUR",
    ),
    (
        "zygo ascii data file",
        "Zygo ASCII (text of an interferometer, whose numbers are phases)",
        "MetroPro DAT, SDF or SUR",
    ),
    ("igor", "Igor text (.itx, whose lines run along y)", "an Igor binary wave (.ibw)"),
    ("dsaa", "Surfer grid (DSAA)", "x, y and z as text, or the rows alone"),
    (
        "ncols",
        "ESRI ASCII grid",
        "x, y and z as text, or the rows alone, with nan where nothing was measured",
    ),
];

/// Refuses text of such a format.
pub(super) fn refuse_texts(text: &[u8]) -> Result<()> {
    let starts =
        |name: &str| text.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name.as_bytes()));
    match TEXTS.iter().find(|(start, ..)| starts(start)) {
        Some((_, name, export)) => Err(foreign((name, Way::Export, export))),
        None => Ok(()),
    }
}

/// The error for a file in a format that is not read.
pub(super) fn unread(bytes: &[u8]) -> Problem {
    let groups =
        [(Way::SurfaceTopography, &BY_PACKAGE[..]), (Way::Gwyddion, &BY_GWYDDION), (Way::Export, &BY_EXPORT)];
    if bytes.is_empty() {
        return Problem::malformed("the file", "empty", "one of an instrument or a program");
    }
    let known = groups.into_iter().find_map(|(way, starts)| {
        let (_, name, export) = starts.iter().find(|(start, ..)| bytes.starts_with(start))?;
        Some((*name, way, *export))
    });
    known.or_else(|| container(bytes)).map_or(Problem::Unrecognised, foreign)
}

/// Whether the end of a file decides its format too: the table of a zip archive, the texts of a TIFF.
pub(super) fn is_known_by_end(head: &[u8]) -> bool {
    [&b"PK\x03\x04"[..], b"II*\0", b"MM\0*"].iter().any(|start| head.starts_with(start))
}

/// Files that look like another format: HDF5 of Zygo's Mx software and of JPK's fast scans.
pub(super) fn refuse_look_alikes(bytes: &[u8]) -> Result<()> {
    // Its heights are phases with converters of their own; both names are in every file.
    let holds = |name: &[u8]| memchr::memmem::find(bytes, name).is_some();
    if holds(b"MetaData") && holds(b"Z Converter") {
        let export = "SUR, SDF or MetroPro DAT from Mx";
        return Err(foreign(("Zygo DATX (interferometer)", Way::SurfaceTopography, export)));
    }
    // Its layout is not published, and programs that read it differ in the order of its points and in the scale of its heights.
    if holds(b"Measurement_000") && holds(b"Channel_0") {
        let export = "one image of heights as text from JPK Data Processing";
        return Err(foreign(("JPK HDF5 (atomic force microscope, .h5-jpk)", Way::Export, export)));
    }
    Ok(())
}

fn foreign((name, way, export): Known) -> Problem {
    let elsewhere = match way {
        Way::SurfaceTopography => {
            "Python's asperity.Surface.read reads it where the package SurfaceTopography is installed \
             (pip install SurfaceTopography; .write(\"surface.npz\") keeps it for cases), or "
        }
        Way::Gwyddion => "open it in Gwyddion (gwyddion.net) and save it as .gwy, or ",
        Way::Export => "",
    };
    Problem::Foreign { name: name.to_owned(), instead: format!("{elsewhere}export {export}") }
}

/// Zip archives of instruments: endings of the names of members, whether an archive must hold all of them or one, and its format.
const ARCHIVES: [(&[&str], bool, Known); 5] = [
    (
        &["index.xml", ".raw"],
        true,
        (
            "Sensofar PLUX (confocal microscope)",
            Way::SurfaceTopography,
            "SUR, PLU or X3P from SensoSCAN or SensoVIEW",
        ),
    ),
    (
        &[".oir", "matlmeasurement.xml"],
        false,
        ("Olympus POIR (laser microscope)", Way::SurfaceTopography, LEXT),
    ),
    (
        &[".jpk-header", "header.properties"],
        false,
        (
            "JPK (atomic force microscope), force curves",
            Way::Export,
            "an image of heights from JPK Data Processing",
        ),
    ),
    (&[".nms"], false, ("Nanosurf NMS", Way::SurfaceTopography, "NID from the instrument's software")),
    (&["[content_types].xml"], false, ("Excel or Word", Way::Export, "the heights as CSV")),
];

/// TIFF of instruments: texts near the start or the end of the file, and its format.
const PICTURES: [(&[&[u8]], Known); 3] = [
    (&[b"jpk-data-file", b"JPK Instruments"], JPK),
    (&[b"TiffTagDescData", b"LEXT"], ("Olympus LEXT (laser microscope)", Way::SurfaceTopography, LEXT)),
    (&[b"PSIA", b"Park Systems"], PARK),
];
const JPK: Known =
    ("JPK TIFF (atomic force microscope)", Way::SurfaceTopography, "text from JPK Data Processing");
const PARK: Known =
    ("Park Systems TIFF (atomic force microscope)", Way::SurfaceTopography, "text from XEI or SmartAnalysis");
/// Ranges of the private tags of TIFF that tell an instrument.
const TAGS: [(std::ops::RangeInclusive<u16>, Known); 2] = [(50432..=50441, PARK), (0x8000..=0x80ff, JPK)];

/// The tags of the first directory of a TIFF file.
fn tags(bytes: &[u8]) -> Vec<u16> {
    let big = bytes.starts_with(b"MM");
    let short = |at: usize| -> Option<u16> {
        let two = [*bytes.get(at)?, *bytes.get(at.checked_add(1)?)?];
        Some(if big { u16::from_be_bytes(two) } else { u16::from_le_bytes(two) })
    };
    let directory = || -> Option<Vec<u16>> {
        let (first, second) = (usize::from(short(4)?), usize::from(short(6)?));
        let start = if big { first << 16 | second } else { second << 16 | first };
        (0..usize::from(short(start)?)).map(|n| short(start.checked_add(2 + 12 * n)?)).collect()
    };
    directory().unwrap_or_default()
}

/// Zip archives, TIFF and compound documents, which many instruments write.
fn container(bytes: &[u8]) -> Option<Known> {
    if bytes.starts_with(b"PK\x03\x04") {
        let names = unpack::Archive::open(bytes).map(|archive| archive.names()).unwrap_or_default();
        let has = |end: &&str| names.iter().any(|name| name.to_lowercase().ends_with(end));
        let archive = ARCHIVES
            .iter()
            .find(|(ends, all, _)| if *all { ends.iter().all(has) } else { ends.iter().any(has) });
        let other = (
            "a zip archive of another program",
            Way::Export,
            "unpack it first, or the heights as X3P, SDF or text",
        );
        return Some(archive.map_or(other, |(.., known)| *known));
    }
    if bytes.starts_with(b"II*\0") || bytes.starts_with(b"MM\0*") {
        const NEAR: usize = 1 << 20;
        let (start, end) = (&bytes[..bytes.len().min(NEAR)], &bytes[bytes.len().saturating_sub(NEAR)..]);
        let near = |word: &[u8]| [start, end].iter().any(|part| memchr::memmem::find(part, word).is_some());
        let named = PICTURES.iter().find(|(words, _)| words.iter().any(|word| near(word)));
        let tags = tags(bytes);
        let tagged = || {
            let known =
                TAGS.iter().find(|(range, _)| tags.iter().filter(|tag| range.contains(tag)).count() >= 2);
            known.map(|(_, known)| *known)
        };
        let other = ("TIFF", Way::Export, "the heights instead of a picture of them, as X3P, SDF or text");
        return tagged().or(named.map(|(_, known)| *known)).or(Some(other));
    }
    let export = "X3P, SDF or text from the program that wrote it";
    compound::is_compound(bytes).then_some((
        "a compound document of Microsoft (not of MountainsMap)",
        Way::Export,
        export,
    ))
}
