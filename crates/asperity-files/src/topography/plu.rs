//! Sensofar PLU and APX, the files of confocal microscopes and interferometers.
//!
//! Little-endian without a signature: date (128 bytes of text), time, comment (256), the calibration (rows, columns,
//! pixel sizes and offsets in µm), the kind of measurement, the settings of the scan, and the layers: rows, columns,
//! binary32 heights in µm, their range, images. 1000001 marks an undefined point. (Sensofar, "PLu file format", as
//! the readers of Gwyddion and SurfaceTopography know it.)

use super::cursor::{Cursor, text};
use super::finish::{Lateral, Measured, Unit};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::{Reader, Request, Result};

// The least certain sign: there is no signature.
pub(super) const PLU: Reader = Reader::new("plu", is_plu, read).also_called(&["apx"]);

const UNDEFINED: f64 = 1_000_001.0;
const UM: f64 = 1e-6;
/// The kind of measurement that is an area; names of all kinds.
const TOPOGRAPHY: u32 = 3;
const KINDS: [&str; 7] = [
    "an image",
    "a profile",
    "several profiles",
    "a topography",
    "coordinates",
    "a thickness",
    "a custom measurement",
];

struct Header {
    date: String,
    comment: String,
    points: [u64; 2],
    pixel: [f64; 2],
    kind: u32,
}

impl Header {
    fn parse(c: &mut Cursor) -> Result<Self> {
        const H: &str = "the PLU header";
        let date = c.text(128, H)?;
        let _time = c.u32(H)?;
        let comment = c.text(256, H)?;
        let [rows, columns, _tall] = [c.u32(H)?, c.u32(H)?, c.u32(H)?];
        let _y_multiple = c.f32(H)?;
        let pixel = [f64::from(c.f32(H)?), f64::from(c.f32(H)?)];
        let _offsets = c.bytes(16, H)?;
        let kind = c.u32(H)?;
        let _algorithm_method_objective_area = c.bytes(16, H)?;
        Ok(Header { date, comment, points: [columns.into(), rows.into()], pixel, kind })
    }
}

/// Whether the bytes can be a PLU file: there is no signature, but a date "Fri Mar 10 16:35:59 2023" and sane numbers.
fn is_plu(bytes: &[u8]) -> bool {
    let Ok(header) = Header::parse(&mut Cursor::new(bytes, Order::Little)) else { return false };
    let words: Vec<&str> = header.date.split_whitespace().collect();
    let has_clock =
        words.iter().any(|w| w.split(':').count() >= 2 && w.split(':').all(|n| n.parse::<u8>().is_ok()));
    let has_year =
        words.iter().flat_map(|w| w.split(['/', '-', '.'])).any(|w| w.len() == 4 && w.parse::<u16>().is_ok());
    // Date and comment are text that zeros may end.
    let is_text =
        |field: &[u8]| text(field).chars().all(|c| !c.is_control() || matches!(c, '\r' | '\n' | '\t'));
    let [nx, ny] = header.points;
    has_clock
        && has_year
        && is_text(&bytes[..128])
        && (1..=1 << 16).contains(&nx)
        && (1..=1 << 16).contains(&ny)
        && (header.kind as usize) < KINDS.len()
        && header.pixel.iter().all(|p| p.is_finite())
}

/// One layer of heights.
struct Layer<'a> {
    points: [u64; 2],
    heights: &'a [u8],
}

/// Reads the layer asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    const S: &str = "the settings of the PLU file";
    let mut c = Cursor::new(bytes, Order::Little);
    let header = Header::parse(&mut c)?;
    if header.kind != TOPOGRAPHY {
        let kind =
            KINDS.get(header.kind as usize).map_or(format!("kind {}", header.kind), |k| (*k).to_owned());
        return Err(request.no_heights(format!("{kind}, not a topography")));
    }
    // Their meaning depends on the kind of the area, their length does not.
    c.bytes(40, S)?;
    let [_restore, layers, _version, _hardware, images] = [c.u8(S)?, c.u8(S)?, c.u8(S)?, c.u8(S)?, c.u8(S)?];
    c.bytes(7, S)?;
    let mut found = Vec::new();
    for _ in 0..layers.max(1) {
        const L: &str = "a layer of the PLU file";
        let [rows, columns] = [u64::from(c.u32(L)?), u64::from(c.u32(L)?)];
        let points = grid::points(columns, rows)? as u64;
        found.push(Layer { points: [columns, rows], heights: c.bytes(4 * points, L)? });
        let _range = c.bytes(8, L)?;
        // Pictures of 24 bits; those after the last layer don't matter.
        if found.len() < usize::from(layers) {
            c.bytes(3 * points * u64::from(images), L)?;
        }
    }
    let names: Vec<String> = (0..found.len()).map(|i| format!("layer{i}")).collect();
    let index = request.choose(&names)?;
    let layer = &found[index];
    let height = |h: f64| if h == UNDEFINED { f64::NAN } else { h };
    let layout = Layout::dense(layer.points, Kind::F32, Order::Little);
    let heights = layout.map(layer.heights, "the heights of the PLU file", height)?;
    let [nx, ny] = layer.points.map(|n| n as f64);
    let lateral = Lateral::Metres([nx * header.pixel[0] * UM, ny * header.pixel[1] * UM]);
    let metadata = [("Date", header.date), ("Comment", header.comment)];
    Ok(Measured::new(heights, Unit::Metres(UM), lateral).of_channel(names, index).with(metadata))
}
