//! X3P, ISO 25178-72 (ISO 5436-2): a zip archive of an XML description and a binary matrix.
//!
//! `main.xml` gives in Record1 the axes (type I: equally spaced by Increment from Offset; data type I = int16,
//! L = int32, F = binary32, D = binary64), in Record3 the size of the matrix and either a link to the binary
//! points (x runs fastest, little-endian) with a link to the bit mask of valid points, or the points as a list of
//! `Datum`. Lengths are metres. The increment of the z axis belongs to integers and to incremental axes ("needed for incremental axis
//! and integer data types", says the schema); other numbers are heights:
//!
//! ```text
//! height = number x Increment + Offset   (axis type I, or data type I or L)        height = number + Offset   (else)
//! ```
//!
//! Programs pack the archive from within its folder or with it; links are relative to `main.xml`.

use ndarray::Array2;

use super::entries::Entries;
use super::finish::{Lateral, Measured, Unit};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::unpack::{Archive, holds_member};
use super::{HISTORY, Problem, Reader, Request, Result, write};
use crate::xml::{Malformed, Piece, walk};

pub(super) const X3P: Reader =
    Reader::new("x3p", |bytes| holds_member(bytes, |name| folder_of_main(name).is_some()), read)
        .written_by(write::x3p::encode);

/// Elements nest five deep in the standard's schema.
const DEEPEST: usize = 32;
/// It has some 40 elements.
const MOST_ELEMENTS: usize = 10_000;

/// Reads the layer asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let mut members = Members::open(bytes)?;
    let xml = members.linked("main.xml")?;
    let main = Main::parse(&xml)?;
    let elements = &main.elements;
    check(elements, request)?;
    let [nx, ny] =
        [elements.whole("Record3/MatrixDimension/SizeX")?, elements.whole("Record3/MatrixDimension/SizeY")?];
    let layers = elements.whole("Record3/MatrixDimension/SizeZ").unwrap_or(1).max(1);
    let count = grid::points(nx, ny)?;
    let all = grid::points(nx.saturating_mul(ny), layers)?;
    let names: Vec<String> = match layers {
        1 => vec![String::new()],
        // More layers than bytes are refused when the points are read; no list of names for them.
        _ => (0..layers.min(1 << 16)).map(|i| format!("layer {i}")).collect(),
    };
    let layer = request.choose(&names)?;
    let range = layer * count..(layer + 1) * count;

    let or = |path: &str, default| elements.get(path).map_or(Ok(default), |_| elements.number(path));
    let counts = elements.get("Record1/Axes/CZ/AxisType") == Some("I")
        || matches!(elements.get("Record1/Axes/CZ/DataType"), Some("I" | "L"));
    let increment = if counts { or("Record1/Axes/CZ/Increment", 1.0)? } else { 1.0 };
    let offset = or("Record1/Axes/CZ/Offset", 0.0)?;
    let height = |v: f64| v * increment + offset;
    let heights = match elements.get("Record3/DataLink/PointDataLink") {
        Some(link) => main.linked(&mut members, link, [nx, ny], all, range, height)?,
        None if main.data.len() == all => {
            let lines: Vec<&[f64]> = main.data[range].chunks_exact(nx as usize).collect();
            grid::from_lines(nx as usize, &lines, height)
        }
        None => {
            let expected = format!("{nx} x {ny} x {layers} as MatrixDimension says");
            return Err(Problem::malformed("the number of points in DataList", main.data.len(), expected));
        }
    };
    let [dx, dy] =
        [elements.number("Record1/Axes/CX/Increment")?, elements.number("Record1/Axes/CY/Increment")?];
    let lateral = Lateral::Metres([nx as f64 * dx.abs(), ny as f64 * dy.abs()]);
    Ok(Measured::new(heights, Unit::Metres(1.0), lateral)
        .of_channel(names, layer)
        .with(metadata(main.elements)))
}

impl From<Malformed> for Problem {
    fn from(Malformed(why): Malformed) -> Self {
        Problem::malformed("main.xml", why, "well-formed XML")
    }
}

/// The folder of a member that is called main.xml: "" or "scan/".
fn folder_of_main(name: &str) -> Option<&str> {
    let at = name.rfind(['/', '\\']).map_or(0, |at| at + 1);
    name[at..].eq_ignore_ascii_case("main.xml").then_some(&name[..at])
}

/// The members of the archive, by their names below the folder of main.xml.
struct Members<'a> {
    archive: Archive<'a>,
    names: Vec<String>,
    folder: String,
}

impl<'a> Members<'a> {
    fn open(bytes: &'a [u8]) -> Result<Self> {
        let archive = Archive::open(bytes)?;
        let names = archive.names();
        let mut folders: Vec<&str> = names.iter().filter_map(|name| folder_of_main(name)).collect();
        folders.sort_by_key(|folder| folder.len());
        let folder = match folders.as_slice() {
            [] => {
                return Err(Problem::malformed("the zip archive", "without main.xml", "one of an X3P file"));
            }
            ["", ..] => String::new(),
            [folder] => (*folder).to_owned(),
            more => {
                let several = format!("in {} folders ({})", more.len(), more[..more.len().min(5)].join(", "));
                return Err(Problem::malformed(
                    "main.xml of the zip archive",
                    several,
                    "there once; unpack the archive and pack one surface",
                ));
            }
        };
        Ok(Members { archive, names, folder })
    }

    /// A member that main.xml links to.
    fn linked(&mut self, link: &str) -> Result<Vec<u8>> {
        let plain = |name: &str| name.replace('\\', "/").to_lowercase();
        let link = link.trim_start_matches("./").trim_start_matches(['/', '\\']);
        let whole = format!("{}{link}", self.folder);
        let wanted = plain(&whole);
        let found = self
            .names
            .iter()
            .find(|name| **name == whole)
            .or_else(|| self.names.iter().find(|name| plain(name) == wanted));
        self.archive.member(found.unwrap_or(&whole))
    }
}

/// The elements of main.xml by their path below the root, and the list of data.
struct Main {
    elements: Entries,
    data: Vec<f64>,
}

impl Main {
    fn parse(xml: &[u8]) -> Result<Self> {
        let mut main = Main { elements: Entries::new("main.xml"), data: Vec::new() };
        let mut path: Vec<String> = Vec::new();
        let mut content = String::new();
        walk(&String::from_utf8_lossy(xml), |piece| {
            match piece {
                Piece::Open(..) if path.len() == DEEPEST => {
                    return Err(Malformed(format!("more than {DEEPEST} elements deep")).into());
                }
                Piece::Open(name, _) => {
                    path.push(name.to_owned());
                    content.clear();
                }
                Piece::Text(text) => content.push_str(text),
                Piece::Close(_) => {
                    let text = content.trim();
                    match path.last().map(String::as_str) {
                        // <Datum/> is an undefined point.
                        Some("Datum") => main.data.push(datum(text)?),
                        Some(_) if !text.is_empty() && main.elements.len() < MOST_ELEMENTS => {
                            main.elements.push(&path[1..].join("/"), text);
                        }
                        _ => {}
                    }
                    path.pop();
                    content.clear();
                }
            }
            Ok::<(), Problem>(())
        })?;
        Ok(main)
    }

    /// The heights of one layer from a member of the archive; `all` is the number of points in all layers.
    fn linked(
        &self,
        members: &mut Members,
        link: &str,
        [nx, ny]: [u64; 2],
        all: usize,
        range: std::ops::Range<usize>,
        height: impl Fn(f64) -> f64 + Sync,
    ) -> Result<Array2<f64>> {
        let kind = match self.elements.get("Record1/Axes/CZ/DataType") {
            Some("I") => Kind::I16,
            Some("L") => Kind::I32,
            Some("F") => Kind::F32,
            Some("D") => Kind::F64,
            _ => return Err(self.elements.wrong("Record1/Axes/CZ/DataType", "I, L, F or D")),
        };
        let content = members.linked(link)?;
        let needed = all as u64 * kind.width() as u64;
        Problem::check_length(&format!("the points in {link:?}"), needed, content.len())?;
        let bytes = &content[range.start * kind.width()..range.end * kind.width()];
        let mut heights = Layout::dense([nx, ny], kind, Order::Little).map(bytes, "the points", height)?;
        if let Some(link) = self.elements.get("Record3/DataLink/ValidPointsLink") {
            let mask = members.linked(link)?;
            Problem::check_length(&format!("the mask in {link:?}"), all.div_ceil(8) as u64, mask.len())?;
            // One bit per point, the least significant first; 1 = valid.
            for ((x, y), height) in heights.indexed_iter_mut() {
                let point = range.start + y * nx as usize + x;
                if mask[point / 8] >> (point % 8) & 1 == 0 {
                    *height = f64::NAN;
                }
            }
        }
        Ok(heights)
    }
}

/// Refuses profiles, point clouds and points that are not equally spaced.
fn check(elements: &Entries, request: &Request) -> Result<()> {
    if let Some(kind @ ("PRF" | "PCL")) = elements.get("Record1/FeatureType") {
        return Err(request.no_heights(format!("its feature type is {kind}, not SUR")));
    }
    for axis in ["CX", "CY"] {
        if elements.get(&format!("Record1/Axes/{axis}/AxisType")) == Some("A") {
            return Err(Problem::unsupported(
                format!("an X3P file whose points are not equally spaced (axis {axis} is absolute)"),
                "resample it to a regular grid before the export",
            ));
        }
    }
    Ok(())
}

/// Record2: instrument, dates, comment.
fn metadata(elements: Entries) -> impl Iterator<Item = (String, String)> {
    let record = elements
        .into_iter()
        .filter_map(|(key, value)| Some((key.strip_prefix("Record2/")?.to_owned(), value)));
    record.flat_map(split_history)
}

/// The history of the heights, which the writer of this crate puts at the end of the comment.
fn split_history((key, value): (String, String)) -> Vec<(String, String)> {
    let mark = format!(" {HISTORY}: ");
    match value.split_once(&mark) {
        Some((comment, history)) if key == "Comment" => {
            vec![(key, comment.to_owned()), (HISTORY.to_owned(), history.to_owned())]
        }
        _ => vec![(key, value)],
    }
}

/// A list entry: the height alone, or "x;y;height"; an empty one is undefined.
fn datum(text: &str) -> Result<f64> {
    let text = text.rsplit(';').next().unwrap_or_default().trim();
    if text.is_empty() {
        return Ok(f64::NAN);
    }
    text.parse().map_err(|_| Problem::malformed("a Datum in main.xml", text, "a number"))
}
