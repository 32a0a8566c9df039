//! BCR-STM and BCRF, interchange files of scanning probe microscopes (Image Metrology).
//!
//! A header of "key = value" lines, filled up to 2048 characters (or `headersize`), then the points line by line:
//! 16-bit integers times `bit2nm` (bcrstm) or binary32 (bcrf), in `zunit`, which is nm where it is not given, as
//! `xunit` and `yunit` are. The greatest number of the type marks an undefined point.

use super::entries::Entries;
use super::finish::{Lateral, Measured, unit_of};
use super::grid::Layout;
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Problem, Reader, Request};

pub(super) const BCR: Reader =
    Reader { name: "bcr", aliases: &["bcrf"], sniff: |bytes| characters(bytes).is_some(), read, write: None };

const START: &str = "fileformat = bcr";
const LEAST_HEADER: usize = 2048;

/// Width and order of the characters of the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Characters {
    Bytes,
    Wide(Order),
}

fn characters(bytes: &[u8]) -> Option<Characters> {
    let wide = |bytes: &[u8], unit: fn(u16) -> [u8; 2]| {
        bytes.starts_with(&START.encode_utf16().flat_map(unit).collect::<Vec<u8>>())
    };
    match bytes {
        _ if bytes.starts_with(START.as_bytes()) => Some(Characters::Bytes),
        [0xff, 0xfe, rest @ ..] if wide(rest, u16::to_le_bytes) => Some(Characters::Wide(Order::Little)),
        [0xfe, 0xff, rest @ ..] if wide(rest, u16::to_be_bytes) => Some(Characters::Wide(Order::Big)),
        _ if wide(bytes, u16::to_le_bytes) => Some(Characters::Wide(Order::Little)),
        _ => None,
    }
}

/// Reads the surface.
fn read(bytes: &[u8], _: &Request) -> Result<Measured, Problem> {
    let characters = characters(bytes)
        .ok_or_else(|| Problem::malformed("the start of the file", "something else", START))?;
    let width = if characters == Characters::Bytes { 1 } else { 2 };
    let header = |length: usize| {
        let bytes = bytes.get(..length * width).unwrap_or(bytes);
        match characters {
            Characters::Bytes => bytes.iter().map(|b| char::from(*b)).collect::<String>(),
            Characters::Wide(order) => {
                let unit = if order == Order::Little { u16::from_le_bytes } else { u16::from_be_bytes };
                let units = bytes.as_chunks::<2>().0.iter().map(|b| unit(*b));
                char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
            }
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
