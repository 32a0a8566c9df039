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
use super::finish::{Lateral, Measured, Unit, check_channels, choose_heights, unit_of};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Format, Problem};

const START: &[u8] = b"[DataSet]";
/// Headers have some 30 kB.
const LONGEST_HEADER: usize = 1 << 20;

/// Whether the bytes are a Nanosurf file.
pub(super) fn is_nid(bytes: &[u8]) -> bool {
    bytes.strip_prefix(START).is_some_and(|rest| matches!(rest.first(), Some(b'\r' | b'\n')))
}

/// Entries under a title.
struct Section {
    title: String,
    entries: Vec<(String, String)>,
}

/// A data set: how its numbers are stored and what they are.
struct Set<'a> {
    section: &'a Section,
    points: [u64; 2],
    kind: Kind,
    order: Order,
    offset: u64,
}

/// Reads the data set asked for.
pub(super) fn read_nid(bytes: &[u8], channel: Option<&str>) -> Result<Measured, Problem> {
    let (sections, data) = header(bytes)?;
    let sets = sets(&sections)?;
    let names: Vec<String> = sets.iter().map(|set| set.section.name()).collect();
    let unit = |i: usize| match sets[i].lateral() {
        Lateral::Metres(_) => sets[i].section.unit("Dim2Unit"),
        // A curve over a voltage or a force is no map, whatever its values are.
        _ => Unit::Unstated,
    };
    let index = choose_heights(Format::Nid, &names, unit, channel)?;
    let set = &sets[index];

    let what = format!("the data set {:?}", names[index]);
    let bits = 8 * set.kind.width() as i32;
    let (least, range) = (set.section.number("Dim2Min")?, set.section.number("Dim2Range")?);
    let signed = matches!(set.kind, Kind::I8 | Kind::I16 | Kind::I32);
    let (step, least) = (range / 2f64.powi(bits), if signed { least + range / 2.0 } else { least });
    let data = Cursor::at(data, set.offset, set.order, &what)?.rest();
    let heights =
        Layout::dense(set.points, set.kind, set.order).map_from_bottom(data, &what, |n| least + step * n)?;
    let info = sections.iter().find(|s| s.title == "DataSet-Info").map(|s| s.entries.as_slice());
    let metadata = info.unwrap_or_default().iter().chain(&set.section.entries);
    let metadata =
        metadata.filter(|(key, value)| !key.starts_with("--") && !value.is_empty()).cloned().collect();
    Ok(Measured {
        heights,
        unit: set.section.unit("Dim2Unit"),
        lateral: set.lateral(),
        channel: Some(names[index].clone()),
        channels: names,
        metadata,
    })
}

/// The sections of the header, and the numbers after it.
fn header(bytes: &[u8]) -> Result<(Vec<Section>, &[u8]), Problem> {
    let head = &bytes[..bytes.len().min(LONGEST_HEADER)];
    let mut sections: Vec<Section> = Vec::new();
    let mut at = 0;
    while at < head.len() {
        if head[at..].starts_with(b"#!") {
            return Ok((sections, &bytes[at + 2..]));
        }
        let end = memchr::memchr(b'\n', &head[at..]).map_or(head.len(), |n| at + n + 1);
        let line = text(&head[at..end]);
        at = end;
        if let Some(title) = line.strip_prefix('[').and_then(|l| l.strip_suffix(']')) {
            sections.push(Section { title: title.to_owned(), entries: Vec::new() });
        } else if let (Some((key, value)), Some(section)) = (line.split_once('='), sections.last_mut()) {
            section.entries.push((key.trim().to_owned(), value.trim().to_owned()));
        }
    }
    Err(Problem::truncated(
        "the header of the Nanosurf file, up to \"#!\",",
        bytes.len() as u64 + 2,
        bytes.len() as u64,
    ))
}

/// The data sets in their order.
fn sets(sections: &[Section]) -> Result<Vec<Set<'_>>, Problem> {
    let global = sections.first().map(|s| s.entries.as_slice()).unwrap_or_default();
    let mut places: Vec<([u32; 2], &str)> = Vec::new();
    for (key, section) in global {
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
        match section.get("SaveMode") {
            Some("Binary") => {}
            other => return Err(section.wrong("SaveMode", other, "\"Binary\"")),
        }
        let signed = section.get("SaveSign") != Some("Unsigned");
        let kind = match (section.get("SaveBits"), signed) {
            (Some("8"), true) => Kind::I8,
            (Some("8"), false) => Kind::U8,
            (Some("16"), true) => Kind::I16,
            (Some("16"), false) => Kind::U16,
            (Some("32"), true) => Kind::I32,
            (Some("32"), false) => Kind::U32,
            (other, _) => return Err(section.wrong("SaveBits", other, "8, 16 or 32")),
        };
        let order = if section.get("SaveOrder") == Some("Intel") { Order::Little } else { Order::Big };
        sets.push(Set { section, points, kind, order, offset });
        offset = offset.saturating_add(count * kind.width() as u64);
    }
    Ok(sets)
}

impl Set<'_> {
    fn lateral(&self) -> Lateral {
        let length = |key: &str| self.section.number(key).ok();
        match (
            length("Dim0Range"),
            length("Dim1Range"),
            self.section.unit("Dim0Unit"),
            self.section.unit("Dim1Unit"),
        ) {
            (Some(x), Some(y), Unit::Metres(ux), Unit::Metres(uy)) => Lateral::Metres([x * ux, y * uy]),
            (Some(x), Some(y), Unit::Unstated, _) => Lateral::Bare([x, y]),
            (_, _, Unit::Other(label), _) | (_, _, _, Unit::Other(label)) => {
                Lateral::Unstated(format!(" in a unit of length (it says {label:?})"))
            }
            _ => Lateral::Unstated(String::new()),
        }
    }
}

impl Section {
    fn get(&self, key: &str) -> Option<&str> {
        self.entries.iter().find(|(k, _)| k == key).map(|(_, v)| v.as_str())
    }

    /// "Scan forward (Z-Axis)".
    fn name(&self) -> String {
        let part = |key: &str| self.get(key).unwrap_or("?");
        format!("{} ({})", part("Frame"), part("Dim2Name"))
    }

    fn unit(&self, key: &str) -> Unit {
        unit_of(self.get(key).unwrap_or_default(), LoneA::Ampere)
    }

    fn number(&self, key: &str) -> Result<f64, Problem> {
        let value = self.get(key).and_then(|v| v.parse().ok()).filter(|v: &f64| v.is_finite());
        value.ok_or_else(|| self.wrong(key, self.get(key), "a number"))
    }

    fn whole(&self, key: &str) -> Result<u64, Problem> {
        self.get(key)
            .and_then(|v| v.parse().ok())
            .ok_or_else(|| self.wrong(key, self.get(key), "a whole number"))
    }

    fn wrong(&self, key: &str, value: Option<&str>, expected: &str) -> Problem {
        Problem::malformed(
            format!("{key} of the data set {:?}", self.title),
            value.unwrap_or("missing"),
            expected,
        )
    }
}
