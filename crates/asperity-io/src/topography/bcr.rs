//! BCR-STM and BCRF, interchange files of scanning probe microscopes (Image Metrology).
//!
//! A header of "key = value" lines, filled up to 2048 characters (or `headersize`), then the points line by line:
//! 16-bit integers times `bit2nm` (bcrstm) or binary32 (bcrf), in `zunit`, which is nm where it is not given, as
//! `xunit` and `yunit` are. The greatest number of the type marks an undefined point.

use super::Problem;
use super::cursor::text;
use super::finish::{Lateral, Measured, Unit};
use super::grid::Layout;
use super::sample::{Kind, Order};
use super::unit::{LoneA, metres};

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

/// Whether the bytes are a BCR file.
pub(super) fn is_bcr(bytes: &[u8]) -> bool {
    characters(bytes).is_some()
}

/// Reads the surface.
pub(super) fn read_bcr(bytes: &[u8]) -> Result<Measured, Problem> {
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
    let length = Entries::of(&header(LEAST_HEADER)).get("headersize").and_then(|n| n.parse().ok());
    let length: usize = length.unwrap_or(LEAST_HEADER).clamp(LEAST_HEADER, 1 << 20);
    let entries = Entries::of(&header(length));
    let data = bytes
        .get(length * width..)
        .ok_or_else(|| Problem::truncated("the BCR header", (length * width) as u64, bytes.len() as u64))?;

    let (kind, undefined) = match entries.get("fileformat").map(|f| f.trim_end_matches("_unicode")) {
        Some("bcrstm") => (Kind::I16, f64::from(i16::MAX)),
        Some("bcrf") => (Kind::F32, 1.7e38),
        other => return Err(Problem::malformed("fileformat", other.unwrap_or("missing"), "bcrstm or bcrf")),
    };
    let order = if entries.get("intelmode").is_some_and(|i| i == "0") { Order::Big } else { Order::Little };
    let [nx, ny] = [entries.whole("xpixels")?, entries.whole("ypixels")?];
    let scale = match (kind, entries.get("bit2nm")) {
        (Kind::I16, Some(_)) => entries.number("bit2nm")?,
        _ => 1.0,
    };
    let height = |v: f64| if v >= undefined { f64::NAN } else { v * scale };
    let heights = Layout::dense([nx, ny], kind, order).map(data, "the points of the BCR file", height)?;

    let label = |key: &str| entries.get(key).unwrap_or("nm");
    let unit_of = |key: &str| metres(label(key), LoneA::Angstrom);
    let lateral =
        match (entries.number("xlength"), entries.number("ylength"), unit_of("xunit"), unit_of("yunit")) {
            (Ok(x), Ok(y), Some(ux), Some(uy)) => Lateral::Metres([x * ux, y * uy]),
            (Ok(_), Ok(_), ..) => {
                Lateral::Unstated(format!(" in a unit of length (it says {:?})", label("xunit")))
            }
            _ => Lateral::Unstated(String::new()),
        };
    let unit = unit_of("zunit").map_or_else(|| Unit::Other(label("zunit").to_owned()), Unit::Metres);
    Ok(Measured { heights, unit, lateral, channel: None, channels: Vec::new(), metadata: entries.0 })
}

/// "key = value" lines.
struct Entries(Vec<(String, String)>);

impl Entries {
    fn of(header: &str) -> Self {
        let lines = header.split(['\n', '\r', '\0']).filter(|l| !l.starts_with(['%', '#']));
        let entries = lines.filter_map(|l| l.trim_start_matches('\u{feff}').split_once('='));
        Entries(
            entries
                .map(|(key, value)| (text(key.as_bytes()).to_lowercase(), text(value.as_bytes())))
                .collect(),
        )
    }

    fn get(&self, key: &str) -> Option<&str> {
        self.0.iter().find(|(k, _)| k == key).map(|(_, v)| v.as_str())
    }

    fn number(&self, key: &str) -> Result<f64, Problem> {
        let value = self.get(key).unwrap_or("missing");
        value.parse().map_err(|_| Problem::malformed(format!("{key} of the BCR header"), value, "a number"))
    }

    fn whole(&self, key: &str) -> Result<u64, Problem> {
        let value = self.get(key).unwrap_or("missing");
        value
            .parse()
            .map_err(|_| Problem::malformed(format!("{key} of the BCR header"), value, "a whole number"))
    }
}
