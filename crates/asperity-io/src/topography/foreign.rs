//! Formats that are not read: which instrument or program wrote the file, and how to get its heights.

use super::{Problem, compound, unpack};

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
use Way::{Export, Gwyddion, SurfaceTopography};

/// First bytes, name of the format, where it is read, and the export of the maker's program.
const STARTS: [(&[u8], &str, Way, &str); 24] = [
    (b"VK3_", "Keyence VK3 (laser microscope)", SurfaceTopography, "CSV of the heights from VK Analyzer"),
    (b"VK4_", "Keyence VK4 (laser microscope)", SurfaceTopography, "CSV of the heights from VK Analyzer"),
    (
        b"VK6",
        "Keyence VK6 (laser microscope)",
        SurfaceTopography,
        "CSV of the heights from MultiFileAnalyzer",
    ),
    (
        b"VK7",
        "Keyence VK7 (laser microscope)",
        SurfaceTopography,
        "CSV of the heights from MultiFileAnalyzer",
    ),
    (
        b"KPK",
        "Keyence ZON (digital microscope)",
        SurfaceTopography,
        "CSV of the heights from MultiFileAnalyzer",
    ),
    (b"VCA DATA", "Bruker OPDx (Vision64, Dektak)", SurfaceTopography, "OPD, SDF or ASCII from Vision64"),
    (
        b"OLYMPUSRAWFORMAT",
        "Olympus OIR (laser microscope)",
        SurfaceTopography,
        "CSV of the heights from the LEXT software",
    ),
    (b"\x01\xb0\x93\xff", "NT-MDT MDT (atomic force microscope)", SurfaceTopography, "ASCII from Nova"),
    (b"WSxM file copyright", "WSxM", SurfaceTopography, "ASCII matrix from WSxM"),
    (
        b"fileType",
        "Agilent or Molecular Imaging MI (atomic force microscope)",
        SurfaceTopography,
        "ASCII from PicoView",
    ),
    (b"OmniSurf3D", "Digital Metrology OmniSurf3D", SurfaceTopography, "SDF from OmniSurf3D"),
    (b"Binary TrueMap Data File", "TrueMap TMD", SurfaceTopography, "SDF from TrueMap"),
    (b"MATLAB 5.0 MAT-file", "MATLAB MAT", SurfaceTopography, "writematrix of the heights as CSV"),
    (b":NANONIS_VERSION:", "Nanonis SXM (scanning probe microscope)", Gwyddion, "ASCII from Nanonis"),
    (b"S\0T\0i\0M\0a\0g\0e\0", "RHK SM4 (scanning probe microscope)", Gwyddion, "ASCII from RHK's software"),
    (
        b";ANFATEC Parameterfile",
        "Anfatec (atomic force microscope)",
        Gwyddion,
        "ASCII from Anfatec's software",
    ),
    (
        b"[Parameter]",
        "Omicron or JEOL (scanning probe microscope)",
        Gwyddion,
        "ASCII from the instrument's software",
    ),
    (b"ZISRAWFILE", "Zeiss CZI (microscope)", Export, "SUR or X3P from ConfoMap"),
    (b"\x70\0\0\0", "Leica LIF (microscope)", Export, "SUR from Leica Map"),
    (b"[p3dlin]", "Taylor Hobson (stylus)", SurfaceTopography, "SDF or ASCII from the instrument's software"),
    (b"UK SOFT", "Burleigh (scanning probe microscope)", Gwyddion, "ASCII from the instrument's software"),
    (b"%PDF", "PDF", Export, "the measurement instead of its report"),
    (b"\x89PNG", "PNG", Export, "the heights instead of a picture of them"),
    (b"\xff\xd8\xff", "JPEG", Export, "the heights instead of a picture of them"),
];

/// The answer for a file of none of the formats that are read.
pub(super) fn unread(bytes: &[u8]) -> Problem {
    let starts = STARTS.iter().find(|(start, ..)| bytes.starts_with(start));
    let known = starts.map(|(_, name, way, export)| (*name, *way, *export));
    match known.or_else(|| container(bytes)) {
        Some((name, way, export)) => foreign(name, way, export),
        None => Problem::Unrecognised,
    }
}

/// Whether the kind of file is known by its end too: the table of a zip archive, the texts of a TIFF.
pub(super) fn told_by_end(head: &[u8]) -> bool {
    [&b"PK\x03\x04"[..], b"II*\0", b"MM\0*"].iter().any(|start| head.starts_with(start))
}

/// Files that look like another format: HDF5 of Zygo's Mx software.
pub(super) fn refuse_look_alikes(bytes: &[u8]) -> Result<(), Problem> {
    // Its heights are phases with converters of their own; both names are in every file.
    let holds = |name: &[u8]| memchr::memmem::find(bytes, name).is_some();
    if holds(b"MetaData") && holds(b"Z Converter") {
        let export = "SUR, SDF or MetroPro DAT from Mx";
        return Err(foreign("Zygo DATX (interferometer)", SurfaceTopography, export));
    }
    Ok(())
}

fn foreign(name: &str, way: Way, export: &str) -> Problem {
    let elsewhere = match way {
        SurfaceTopography => {
            "Python's asperity.Surface.read reads it where the package SurfaceTopography is installed \
             (pip install SurfaceTopography; .write(\"surface.npz\") keeps it for cases), or "
        }
        Gwyddion => "open it in Gwyddion (gwyddion.net) and save it as .gwy, or ",
        Export => "",
    };
    Problem::Foreign { name: name.to_owned(), instead: format!("{elsewhere}export {export}") }
}

/// Zip archives, TIFF and compound documents, which many instruments write.
fn container(bytes: &[u8]) -> Option<(&'static str, Way, &'static str)> {
    // Texts inside a TIFF name the instrument; they lie near its start or its end.
    let near = |word: &[u8]| {
        const NEAR: usize = 1 << 20;
        let (start, end) = (&bytes[..bytes.len().min(NEAR)], &bytes[bytes.len().saturating_sub(NEAR)..]);
        [start, end].into_iter().any(|part| memchr::memmem::find(part, word).is_some())
    };
    if bytes.starts_with(b"PK\x03\x04") {
        let names = unpack::Archive::open(bytes).map(|archive| archive.names()).unwrap_or_default();
        let has = |end: &str| names.iter().any(|n| n.to_lowercase().ends_with(end));
        return Some(if has("index.xml") && has(".raw") {
            (
                "Sensofar PLUX (confocal microscope)",
                SurfaceTopography,
                "SUR, PLU or X3P from SensoSCAN or SensoVIEW",
            )
        } else if has(".oir") || has("matlmeasurement.xml") {
            (
                "Olympus POIR (laser microscope)",
                SurfaceTopography,
                "CSV of the heights from the LEXT software",
            )
        } else if has(".jpk-header") || has("header.properties") {
            (
                "JPK (atomic force microscope), force curves",
                Export,
                "an image of heights from JPK Data Processing",
            )
        } else if has(".nms") {
            ("Nanosurf NMS", SurfaceTopography, "NID from the instrument's software")
        } else if names.iter().any(|n| n == "[Content_Types].xml") {
            ("Excel or Word", Export, "the heights as CSV")
        } else {
            (
                "a zip archive of another program",
                Export,
                "unpack it first, or the heights as X3P, SDF or text",
            )
        });
    }
    if bytes.starts_with(b"II*\0") || bytes.starts_with(b"MM\0*") {
        return Some(if near(b"jpk-data-file") || near(b"JPK") {
            ("JPK (atomic force microscope)", SurfaceTopography, "text from JPK Data Processing")
        } else if near(b"TiffTagDescData") || near(b"LEXT") || near(b"OLS") {
            (
                "Olympus LEXT (laser microscope)",
                SurfaceTopography,
                "CSV of the heights from the LEXT software",
            )
        } else if near(b"PSIA")
            || near(b"Park")
            || near(&50432u16.to_le_bytes()) && near(&50434u16.to_le_bytes())
        {
            (
                "Park Systems TIFF (atomic force microscope)",
                SurfaceTopography,
                "text from XEI or SmartAnalysis",
            )
        } else {
            ("TIFF", Export, "the heights instead of a picture of them, as X3P, SDF or text")
        });
    }
    if compound::is_compound(bytes) {
        let export = "X3P, SDF or text from the program that wrote it";
        return Some(("a compound document of Microsoft (not of MountainsMap)", Export, export));
    }
    None
}
