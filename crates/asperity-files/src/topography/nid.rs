//! Nanosurf NID and EZD, the files of Nanosurf's atomic force microscopes.
//!
//! A text header like an INI file ("[DataSet]", key=value) up to "#!", then the numbers of the data sets one after the
//! other in the order of the entries `Gr0-Ch0`, `Gr0-Ch1`, ..., each line by line from the bottom up. Integers of N bits
//! span the range of a data set:
//!
//! ```text
//! value = Dim2Min + Dim2Range (n/2^N + 1/2 where they have a sign)
//! ```
//!
//! (The readers of Gwyddion and SurfaceTopography; Nanosurf does not publish the format.)

use super::cursor::{Cursor, text};
use super::entries::Entries;
use super::finish::{Lateral, Measured, Unit, unit_of};
use super::grid::{self, Layout};
use super::request::check_channels;
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Problem, Reader, Request, Result};

pub(super) const NID: Reader = Reader::new("nid", is_nid, read).also_called(&["ezd"]);

const START: &[u8] = b"[DataSet]";
/// Headers have some 30 kB.
const LONGEST_HEADER: usize = 1 << 20;

/// Whether the bytes are a Nanosurf file.
fn is_nid(bytes: &[u8]) -> bool {
    bytes.strip_prefix(START).is_some_and(|rest| matches!(rest.first(), Some(b'\r' | b'\n')))
}

/// A data set: how its numbers are stored and what they are.
struct Set<'a> {
    section: &'a Entries,
    points: [u64; 2],
    kind: Kind,
    order: Order,
    offset: u64,
}

/// Reads the data set asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let (sections, data) = header(bytes)?;
    let sets = sets(&sections)?;
    let names: Vec<String> = sets.iter().map(Set::name).collect();
    let unit = |i: usize| match sets[i].lateral() {
        Lateral::Metres(_) => sets[i].unit("Dim2Unit"),
        // A curve over a voltage or a force is not a map, even if its values are lengths.
        _ => Unit::Unstated,
    };
    let index = request.choose_heights(&names, unit)?;
    let set = &sets[index];

    let what = format!("the data set {:?}", names[index]);
    let bits = 8 * set.kind.width() as i32;
    let (least, range) = (set.section.number("Dim2Min")?, set.section.number("Dim2Range")?);
    let signed = matches!(set.kind, Kind::I8 | Kind::I16 | Kind::I32);
    let (step, least) = (range / 2f64.powi(bits), if signed { least + range / 2.0 } else { least });
    let data = Cursor::at(data, set.offset, set.order, &what)?.rest();
    let heights =
        Layout::dense(set.points, set.kind, set.order).bottom_up().map(data, &what, |n| least + step * n)?;
    let info = sections.iter().find(|s| s.title == "DataSet-Info");
    let metadata = info.into_iter().chain([set.section]).cloned().flatten();
    let metadata = metadata.filter(|(key, _)| !key.starts_with("--"));
    let measured = Measured::new(heights, set.unit("Dim2Unit"), set.lateral());
    Ok(measured.of_channel(names, index).with(metadata))
}

/// The sections of the header, and the numbers after it.
fn header(bytes: &[u8]) -> Result<(Vec<Entries>, &[u8])> {
    const END: &[u8] = b"\n#!";
    let head = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let length = bytes.len() as u64;
    let end = memchr::memmem::find(head, END).ok_or_else(|| {
        Problem::truncated("the header of the Nanosurf file, up to \"#!\",", length + 2, length)
    })?;
    let mut sections: Vec<Entries> = Vec::new();
    for line in head[..end].split(|byte| *byte == b'\n').map(text) {
        if let Some(title) = line.strip_prefix('[').and_then(|l| l.strip_suffix(']')) {
            sections.push(Entries::new(title));
        } else if let (Some((key, value)), Some(section)) = (line.split_once('='), sections.last_mut()) {
            section.push(key, value);
        }
    }
    Ok((sections, &bytes[end + END.len()..]))
}

/// The data sets in their order.
fn sets(sections: &[Entries]) -> Result<Vec<Set<'_>>> {
    let mut places: Vec<([u32; 2], &str)> = Vec::new();
    for (key, section) in sections.first().into_iter().flat_map(Entries::iter) {
        let place = key.strip_prefix("Gr").and_then(|k| k.split_once("-Ch"));
        if let Some((group, channel)) = place
            && let (Ok(group), Ok(channel)) = (group.parse(), channel.parse())
        {
            places.push(([group, channel], section));
        }
    }
    places.sort_by_key(|(place, _)| *place);
    places.dedup_by_key(|(place, _)| *place);
    check_channels(places.len())?;
    let mut sets = Vec::new();
    let mut offset = 0u64;
    for (_, title) in places {
        // Data sets that were not saved have an entry without a section.
        let Some(section) = sections.iter().find(|s| s.title == title) else { continue };
        let points = [section.whole("Points")?, section.whole("Lines")?];
        let count = grid::points(points[0], points[1])? as u64;
        if section.get("SaveMode") != Some("Binary") {
            return Err(section.wrong("SaveMode", "\"Binary\""));
        }
        let signed = section.get("SaveSign") != Some("Unsigned");
        let kind = match (section.get("SaveBits"), signed) {
            (Some("8"), true) => Kind::I8,
            (Some("8"), false) => Kind::U8,
            (Some("16"), true) => Kind::I16,
            (Some("16"), false) => Kind::U16,
            (Some("32"), true) => Kind::I32,
            (Some("32"), false) => Kind::U32,
            _ => return Err(section.wrong("SaveBits", "8, 16 or 32")),
        };
        let order = if section.get("SaveOrder") == Some("Intel") { Order::Little } else { Order::Big };
        sets.push(Set { section, points, kind, order, offset });
        offset = offset.saturating_add(count * kind.width() as u64);
    }
    Ok(sets)
}

impl Set<'_> {
    fn lateral(&self) -> Lateral {
        let units = [self.unit("Dim0Unit"), self.unit("Dim1Unit")];
        match (self.section.number("Dim0Range"), self.section.number("Dim1Range")) {
            (Ok(x), Ok(y)) => Lateral::of([x, y], units),
            _ => Lateral::Unstated(String::new()),
        }
    }

    /// "Scan forward (Z-Axis)".
    fn name(&self) -> String {
        let part = |key: &str| self.section.get(key).unwrap_or("?");
        format!("{} ({})", part("Frame"), part("Dim2Name"))
    }

    fn unit(&self, key: &str) -> Unit {
        unit_of(self.section.get(key).unwrap_or_default(), LoneA::Ampere)
    }
}
