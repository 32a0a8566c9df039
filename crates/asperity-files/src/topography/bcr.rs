//! BCR-STM and BCRF, interchange files of scanning probe microscopes (Image Metrology).
//!
//! A header of "key = value" lines, filled up to 2048 characters (or `headersize`), then the points line by line:
//! 16-bit integers times `bit2nm` (bcrstm) or binary32 (bcrf), in `zunit`, which is nm where it is not given, as
//! `xunit` and `yunit` are. The greatest number of the type marks an undefined point.

use super::cursor::utf16;
use super::entries::Entries;
use super::finish::{Lateral, Measured, unit_of};
use super::grid::Layout;
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Problem, Reader, Request, Result};

pub(super) const BCR: Reader =
    Reader::new("bcr", |bytes| characters(bytes).is_some(), read).also_called(&["bcrf"]);

const START: &str = "fileformat = bcr";
const LEAST_HEADER: usize = 2048;

/// How the characters of the header are written: bytes, or UTF-16 of an order.
fn characters(bytes: &[u8]) -> Option<Option<Order>> {
    let starts =
        |bytes: &[u8], order| bytes.get(..2 * START.len()).is_some_and(|start| utf16(start, order) == START);
    match bytes {
        _ if bytes.starts_with(START.as_bytes()) => Some(None),
        [0xfe, 0xff, rest @ ..] if starts(rest, Order::Big) => Some(Some(Order::Big)),
        [0xff, 0xfe, rest @ ..] | rest if starts(rest, Order::Little) => Some(Some(Order::Little)),
        _ => None,
    }
}

/// Reads the surface.
fn read(bytes: &[u8], _: &Request) -> Result<Measured> {
    let characters = characters(bytes)
        .ok_or_else(|| Problem::malformed("the start of the file", "something else", START))?;
    let width = if characters.is_some() { 2 } else { 1 };
    let header = |length: usize| {
        let bytes = bytes.get(..length * width).unwrap_or(bytes);
        match characters {
            Some(order) => utf16(bytes, order),
            None => bytes.iter().map(|b| char::from(*b)).collect(),
        }
    };
    let length = entries(&header(LEAST_HEADER)).get("headersize").and_then(|n| n.parse().ok());
    let length: usize = length.unwrap_or(LEAST_HEADER).clamp(LEAST_HEADER, 1 << 20);
    let entries = entries(&header(length));
    let data = bytes
        .get(length * width..)
        .ok_or_else(|| Problem::truncated("the BCR header", (length * width) as u64, bytes.len() as u64))?;

    let (kind, undefined) = match entries.get("fileformat").map(|f| f.trim_end_matches("_unicode")) {
        Some("bcrstm") => (Kind::I16, f64::from(i16::MAX)),
        Some("bcrf") => (Kind::F32, 1.7e38),
        _ => return Err(entries.wrong("fileformat", "bcrstm or bcrf")),
    };
    let order = if entries.get("intelmode").is_some_and(|i| i == "0") { Order::Big } else { Order::Little };
    let [nx, ny] = [entries.whole("xpixels")?, entries.whole("ypixels")?];
    let scale = match (kind, entries.get("bit2nm")) {
        (Kind::I16, Some(_)) => entries.number("bit2nm")?,
        _ => 1.0,
    };
    let height = |v: f64| if v >= undefined { f64::NAN } else { v * scale };
    let heights = Layout::dense([nx, ny], kind, order).map(data, "the points of the BCR file", height)?;

    let unit = |key: &str| unit_of(entries.get(key).unwrap_or("nm"), LoneA::Angstrom);
    let lateral = match (entries.number("xlength"), entries.number("ylength")) {
        (Ok(x), Ok(y)) => Lateral::of([x, y], [unit("xunit"), unit("yunit")]),
        _ => Lateral::Unstated(String::new()),
    };
    Ok(Measured::new(heights, unit("zunit"), lateral).with(entries))
}

fn entries(header: &str) -> Entries {
    let lines = header.split(['\n', '\r', '\0']).filter(|l| !l.starts_with(['%', '#']));
    Entries::from_lines("the BCR header", lines.map(|l| l.trim_start_matches('\u{feff}')))
}
