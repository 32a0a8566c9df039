//! Nanoscope, the files of the atomic force microscopes of Digital Instruments, Veeco and Bruker (.di, .spm, .000).
//!
//! A text header of sections (`\*Ciao image list`) with entries (`\Samps/line: 512`) ends with `\*File list end`; the
//! integers of each image follow at its `Data offset`, line by line from the bottom up. An image is scaled by the
//! hard value Z of `\@2:Z scale: V [Sens. Zsens] (0.005 V/LSB) 2.91 V` and the sensitivity S that the brackets name
//! (`\@Sens. Zsens: V 20.8 nm/V`):
//!
//! ```text
//! height = n Z S / 2^(8 B),   B: `Bytes/pixel`
//! ```
//!
//! From version 9.2 on every number takes 4 bytes; B is ignored. Files before version 4.3 have other scales and are
//! refused. (Digital Instruments, "Nanoscope command reference manual", and the readers of Gwyddion and
//! SurfaceTopography.) How high an image is follows in [`extent`] from its scan size, aspect ratio and lines.

pub(crate) mod curves;
mod extent;

use super::cursor::Cursor;
use super::entries::Entries;
use super::finish::{Lateral, Measured, Unit, unit_of};
use super::grid::{self, Layout};
use super::request::check_channels;
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Problem, Reader, Request, Result};

pub(super) const NANOSCOPE: Reader = Reader::new("di", is_nanoscope, read).also_called(&["spm", "nanoscope"]);

/// First words of a file; "?" in place of "\\" says that the numbers are written as text.
const STARTS: [&str; 3] = ["*file list", "*force file list", "*ec file list"];
/// Headers have some 100 kB.
const LONGEST_HEADER: usize = 1 << 20;
/// From this version on all numbers have 32 bits.
const VERSION_OF_32_BITS: u32 = 0x0920_0000;

/// Whether the bytes are a Nanoscope file.
fn is_nanoscope(bytes: &[u8]) -> bool {
    let Some((b'\\' | b'?', rest)) = bytes.split_first() else { return false };
    let starts =
        |start: &str| rest.get(..start.len()).is_some_and(|r| r.eq_ignore_ascii_case(start.as_bytes()));
    STARTS.into_iter().any(starts)
}

/// Reads the image asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    if bytes.first() == Some(&b'?') {
        let instead = "save it as binary, or export it as ASCII matrix from NanoScope Analysis";
        return Err(Problem::unsupported("a Nanoscope file whose numbers are written as text", instead));
    }
    let header = Header::parse(bytes);
    if let Some(detail) = header.no_map() {
        return Err(request.no_heights(detail));
    }
    let images: Vec<&Entries> = header.sections.iter().filter(|s| is_image(s)).collect();
    check_channels(images.len())?;
    let names: Vec<String> = images.iter().map(|image| image_names(image).0).collect();
    if names.is_empty() {
        return Err(request.no_heights("no image in it"));
    }
    let unit = |i: usize| header.scale(images[i]).map_or(Unit::Unstated, |(_, unit)| unit);
    // "Height Sensor" is the label of the image named ZSensor.
    let by_label = request.channel.filter(|wanted| !names.iter().any(|n| n.eq_ignore_ascii_case(wanted)));
    let by_label = by_label
        .and_then(|wanted| images.iter().position(|image| image_names(image).1.eq_ignore_ascii_case(wanted)));
    let index = match by_label {
        Some(index) => index,
        None => request.choose_heights(&names, unit)?,
    };
    let image = images[index];

    let (scale, unit) = header.scale(image)?;
    let plane = header.plane(image)?;
    let offset = image.whole("Data offset")?;
    let what = format!("the image {:?}", names[index]);
    let data = Cursor::at(bytes, offset, Order::Little, &what)?.rest();
    let layout = Layout::dense(plane.points, plane.kind, Order::Little);
    let heights = layout.bottom_up().map(data, &what, |n| n * scale)?;
    let measured = Measured::new(heights, unit, plane.lateral).of_channel(names, index);
    Ok(measured.with(header.metadata(image)))
}

/// Sections with titles in small letters.
struct Header {
    sections: Vec<Entries>,
}

/// Points, numbers and lengths of an image.
struct Plane {
    points: [u64; 2],
    kind: Kind,
    lateral: Lateral,
}

impl Header {
    fn parse(bytes: &[u8]) -> Self {
        let bytes = &bytes[..bytes.len().min(LONGEST_HEADER)];
        let mut sections: Vec<Entries> = Vec::new();
        for line in bytes.split(|b| *b == b'\n') {
            let line = super::cursor::text(line);
            // The numbers of the first image follow the last entry.
            let Some(entry) = line.strip_prefix('\\') else { if line.is_empty() { continue } else { break } };
            if let Some(title) = entry.strip_prefix('*') {
                if title.eq_ignore_ascii_case("file list end") {
                    break;
                }
                sections.push(Entries::new(title.to_lowercase()));
            } else if let Some(section) = sections.last_mut() {
                // "\Capture mode : ...": the colon before a blank, as "@2:Z scale" has one too.
                let (key, value) = entry.split_once(": ").unwrap_or((entry.trim_end_matches(':'), ""));
                section.push(key, value);
            }
        }
        Header { sections }
    }

    /// The first entry of this name in the sections with a title that ends like this.
    fn get(&self, title: &str, key: &str) -> Option<&str> {
        self.sections.iter().filter(|s| s.title.ends_with(title)).find_map(|s| s.get(key))
    }

    /// What the file holds instead of a map.
    fn no_map(&self) -> Option<&'static str> {
        let is = |key: &str, value: &str| {
            self.sections.iter().any(|s| s.get(key).is_some_and(|v| v.eq_ignore_ascii_case(value)))
        };
        if self.sections.first().is_some_and(|s| s.title.starts_with("force"))
            || is("operating mode", "force")
            || self.get("file list", "start context") == Some("FOL")
        {
            return Some("force curves; an image of the same measurement has its own file");
        }
        let context = self.get("file list", "start context").unwrap_or_default();
        let uneven = context.ends_with("VAR") && !is("operating mode", "force volume");
        uneven.then_some("profiles that are not evenly spaced")
    }

    fn version(&self) -> u32 {
        let version = self.get("file list", "version").unwrap_or_default();
        u32::from_str_radix(version.trim_start_matches("0x"), 16).unwrap_or(0)
    }

    /// What one unit of the image's numbers is worth, and in which unit.
    fn scale(&self, image: &Entries) -> Result<(f64, Unit)> {
        let scale = image.get("@4:z scale").or(image.get("@2:z scale")).ok_or_else(|| {
            Problem::unsupported(
                "a Nanoscope file without \"@2:Z scale\" (before version 4.3)",
                "open it in NanoScope Analysis or Gwyddion and save it in a newer format",
            )
        })?;
        let hard = Scale::parse(scale)
            .ok_or_else(|| image.wrong("@2:Z scale", "like \"V [Sens. Zsens] (0.005 V/LSB) 2.9 V\""))?;
        let bytes = bytes_per_number(image)?;
        let per_number = hard.value / 256f64.powi(i32::try_from(bytes).unwrap_or(2));
        let soft = hard.sensitivity.and_then(|name| {
            let key = format!("@{name}");
            let lists = ["scanner list", "microscope list", "scan list", "afm list", "stm list"];
            Scale::parse(lists.into_iter().find_map(|list| self.get(list, &key))?)
        });
        let Some(soft) = soft else { return Ok((per_number, unit_of(hard.unit, LoneA::Ampere))) };
        // A sensitivity without a unit is that of the hard value.
        let Some((of, per)) = soft.unit.split_once('/') else {
            return Ok((per_number * soft.value, unit_of(hard.unit, LoneA::Ampere)));
        };
        match ratio(hard.unit, per) {
            Some(ratio) => Ok((per_number * ratio * soft.value, unit_of(of, LoneA::Ampere))),
            None => Ok((per_number * soft.value, Unit::Other(format!("{} {}", hard.unit, soft.unit)))),
        }
    }

    fn plane(&self, image: &Entries) -> Result<Plane> {
        let stated = [image.whole("Samps/line")?, image.whole("Number of lines")?];
        let length = image.whole("Data length")?;
        let scan = self.scan_points();
        let count = |[x, y]: [u64; 2]| grid::points(x, y).map(|n| n as u64);
        let stated_count = count(stated)?;
        let bytes = bytes_per_number(image)?;
        let wide = self.version() >= VERSION_OF_32_BITS && length >= stated_count.saturating_mul(4);
        let (kind, width) = if wide || bytes == 4 { (Kind::I32, 4) } else { (Kind::I16, 2) };
        // Some files state a wrong number of points for an image; the length of its data tells.
        let mut points = stated;
        if stated_count.saturating_mul(width) != length
            && let Some(scan) = scan
            && let Ok(scan_count) = count(scan)
        {
            let needed = scan_count.saturating_mul(width);
            if length == needed || (stated_count.saturating_mul(width) > length && length >= needed) {
                points = scan;
            }
        }
        let needed = count(points)?.saturating_mul(width);
        if needed > length {
            return Err(Problem::truncated("the \"Data length\" of the image", needed, length));
        }
        Ok(Plane { points, kind, lateral: self.lateral(image, stated, points)? })
    }

    /// Points along x and y of the whole scan.
    fn scan_points(&self) -> Option<[u64; 2]> {
        let count = |key: &str| self.get("scan list", key)?.parse().ok();
        Some([count("samps/line")?, count("lines")?])
    }

    fn metadata(&self, image: &Entries) -> Vec<(String, String)> {
        let global = [("file list", "Version"), ("file list", "Date"), ("equipment list", "Description")];
        let global = global
            .into_iter()
            .filter_map(|(title, key)| Some((key.to_owned(), self.get(title, key)?.to_owned())));
        global.chain(image.clone()).collect()
    }
}

/// How many of the second unit are one of the first: "mV" and "V" differ by a prefix.
fn ratio(unit: &str, other: &str) -> Option<f64> {
    const PREFIXES: [(&[char], f64); 5] = [
        (&['k'], 1e3),
        (&['m'], 1e-3),
        (&['u', '\u{b5}', '\u{3bc}', '~'], 1e-6),
        (&['n'], 1e-9),
        (&['p'], 1e-12),
    ];
    // A unit without a prefix, or with each that it may have.
    fn readings_of(unit: &str) -> impl Iterator<Item = (f64, &str)> {
        let prefixed =
            PREFIXES.iter().filter_map(move |(prefix, factor)| Some((*factor, unit.strip_prefix(*prefix)?)));
        std::iter::once((1.0, unit)).chain(prefixed.filter(|(_, base)| !base.is_empty()))
    }
    let (unit, other) = (unit.trim(), other.trim());
    readings_of(unit).find_map(|(factor, base)| {
        readings_of(other).find(|(_, of_other)| base == *of_other).map(|(of_other, _)| factor / of_other)
    })
}

/// The value of "V [Sens. Zsens] (0.005 V/LSB) 2.91 V" or "V 20.8 nm/V".
struct Scale<'a> {
    sensitivity: Option<&'a str>,
    value: f64,
    unit: &'a str,
}

impl<'a> Scale<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let mut rest = text.trim().strip_prefix(['V', 'C'])?.trim_start();
        let mut sensitivity = None;
        if let Some(inner) = rest.strip_prefix('[') {
            let (name, after) = inner.split_once(']')?;
            sensitivity = Some(name.trim()).filter(|name| !name.is_empty());
            rest = after.trim_start();
        }
        if rest.starts_with('(') {
            // Units hold parentheses too: "(0.0005 log(Arb)/LSB)".
            let mut depth = 0;
            let end = rest.char_indices().find_map(|(at, c)| {
                depth += i32::from(c == '(') - i32::from(c == ')');
                (depth == 0).then_some(at + 1)
            })?;
            rest = rest[end..].trim_start();
        }
        let (number, unit) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
        let value: f64 = number.parse().ok().filter(|v: &f64| v.is_finite())?;
        Some(Scale { sensitivity, value, unit: unit.trim() })
    }
}

fn is_image(section: &Entries) -> bool {
    ["ciao image list", "afm image list", "stm image list", "ncafm image list", "image list"]
        .contains(&section.title.as_str())
}

/// Name and label of an image: `S [ZSensor] "Height Sensor"`.
fn image_names(image: &Entries) -> (String, String) {
    let keys = ["@2:image data", "@3:image data", "@4:image data", "image data"];
    let value = keys.into_iter().find_map(|key| image.get(key)).unwrap_or("no name");
    let label = value.split('"').nth(1).unwrap_or(value).trim();
    let name = value.split_once('[').and_then(|(_, rest)| rest.split_once(']')).map(|(name, _)| name.trim());
    (name.filter(|n| !n.is_empty()).unwrap_or(label).to_owned(), label.to_owned())
}

fn bytes_per_number(image: &Entries) -> Result<u64> {
    match image.get("Bytes/pixel") {
        None | Some("2") => Ok(2),
        Some("4") => Ok(4),
        Some(_) => Err(image.wrong("Bytes/pixel", "2 or 4")),
    }
}
