//! ISO 25178-71 SDF, surface data files, as text (aISO-1.0) and binary (bISO-1.0); also version 2.0, whose counts
//! have 32 bits.
//!
//! Header: manufacturer, dates, NumPoints (along x), NumProfiles (along y), the scales along x, y, z in metres per
//! unit, the type of the numbers; then the profiles one after the other. Undefined points are BAD in text and the
//! least number of a signed type (the greatest of an unsigned one, which early files use) in binary.

use ndarray::Array2;

use super::cursor::{Cursor, text};
use super::entries::Entries;
use super::finish::{Lateral, Measured, Unit};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::text::numbers;
use super::{Problem, Reader, Request, Result, write};

pub(super) const SDF: Reader = Reader::new("sdf", is_sdf, read).written_by(write::sdf::encode);

/// Whether the bytes are an SDF file.
fn is_sdf(bytes: &[u8]) -> bool {
    matches!(bytes.trim_ascii_start().first_chunk(), Some(b"aISO-1.0" | b"aISO-2.0"))
        || matches!(bytes.first_chunk(), Some(b"bISO-1.0" | b"bISO-2.0"))
}

/// Reads the surface.
fn read(bytes: &[u8], _: &Request) -> Result<Measured> {
    if bytes.first() == Some(&b'b') { read_binary(bytes) } else { read_text(bytes) }
}

/// Types of numbers by their code.
fn kind(code: u64) -> Result<Kind> {
    const KINDS: [Kind; 8] =
        [Kind::U8, Kind::U16, Kind::U32, Kind::F32, Kind::I8, Kind::I16, Kind::I32, Kind::F64];
    let index = usize::try_from(code).ok();
    index
        .and_then(|i| KINDS.get(i).copied())
        .ok_or_else(|| Problem::malformed("DataType of the SDF header", code, "from 0 to 7"))
}

/// The number that marks an undefined point.
fn undefined(kind: Kind) -> Option<f64> {
    match kind {
        Kind::I8 => Some(f64::from(i8::MIN)),
        Kind::I16 => Some(f64::from(i16::MIN)),
        Kind::I32 => Some(f64::from(i32::MIN)),
        Kind::U16 => Some(f64::from(u16::MAX)),
        Kind::U32 => Some(f64::from(u32::MAX)),
        Kind::F32 => Some(f64::from(f32::MIN)),
        Kind::F64 => Some(f64::MIN),
        _ => None,
    }
}

fn read_binary(bytes: &[u8]) -> Result<Measured> {
    const H: &str = "the SDF header";
    let mut c = Cursor::new(bytes, Order::Little);
    let version = c.bytes(8, H)?;
    let mut metadata = Vec::new();
    for (key, length) in [("ManufacID", 10), ("CreateDate", 12), ("ModDate", 12)] {
        metadata.push((key, c.text(length, H)?));
    }
    let (points, profiles) = match version {
        b"bISO-2.0" => (u64::from(c.u32(H)?), u64::from(c.u32(H)?)),
        _ => (u64::from(c.u16(H)?), u64::from(c.u16(H)?)),
    };
    let scale = [c.f64(H)?, c.f64(H)?, c.f64(H)?];
    let _resolution = c.f64(H)?;
    let [compression, data_type, _check] = [c.u8(H)?, c.u8(H)?, c.u8(H)?];
    refuse_compression(u64::from(compression))?;
    let kind = kind(u64::from(data_type))?;
    let (undefined, dz) = (undefined(kind).unwrap_or(f64::NAN), scale[2]);
    let height = |v: f64| if v == undefined { f64::NAN } else { v * dz };
    let layout = Layout::dense([points, profiles], kind, Order::Little);
    let heights = layout.map(c.rest(), "the points of the SDF file", height)?;
    Ok(measured(heights, scale).with(metadata))
}

fn read_text(bytes: &[u8]) -> Result<Measured> {
    let (header, data, line) = split(bytes)?;
    let lines = header.split(|b| *b == b'\n').map(text).filter(|l| !l.starts_with(';'));
    let header = Entries::from_lines("the SDF header", lines);
    let whole = |key: &str| header.whole(key);
    if header.get("Compression").is_some() {
        refuse_compression(whole("Compression")?)?;
    }
    let (points, profiles) = (whole("NumPoints")?, whole("NumProfiles")?);
    let scale = [header.number("Xscale")?, header.number("Yscale")?, header.number("Zscale")?];
    // Text says nothing that depends on the type of the numbers, but a wrong one means another format.
    kind(whole("DataType")?)?;
    let count = grid::points(points, profiles)?;
    let values = numbers(data, line)?;
    if values.len() != count {
        let expected = format!("{points} x {profiles} as the header says (the file may be truncated)");
        return Err(Problem::malformed("the number of points", values.len(), expected));
    }
    let lines: Vec<&[f64]> = values.chunks_exact(points as usize).collect();
    let heights = grid::from_lines(points as usize, &lines, |v| v * scale[2]);
    Ok(measured(heights, scale).with(header))
}

fn measured(heights: Array2<f64>, [dx, dy, _]: [f64; 3]) -> Measured {
    let (nx, ny) = heights.dim();
    let lateral = Lateral::Metres([nx as f64 * dx, ny as f64 * dy]);
    Measured::new(heights, Unit::Metres(1.0), lateral)
}

/// Header and numbers, which lines of one asterisk end, and the line where the numbers start. The trailer after
/// the second asterisk is free text.
fn split(bytes: &[u8]) -> Result<(&[u8], &[u8], usize)> {
    let asterisk = |from: usize| {
        let line_start = |at: usize| bytes[from..at].iter().rev().find(|b| !matches!(b, b' ' | b'\t'));
        memchr::memchr_iter(b'*', &bytes[from..])
            .map(|n| from + n)
            .find(|at| line_start(*at).is_none_or(|b| matches!(b, b'\n' | b'\r')))
    };
    let end = asterisk(0).ok_or_else(|| {
        Problem::malformed("the end of the SDF header", "missing", "a line with one asterisk")
    })?;
    let stop = asterisk(end + 1).unwrap_or(bytes.len());
    let line = 1 + memchr::memchr_iter(b'\n', &bytes[..end]).count();
    Ok((&bytes[..end], &bytes[end + 1..stop], line))
}

fn refuse_compression(code: u64) -> Result<()> {
    if code == 0 {
        return Ok(());
    }
    Err(Problem::unsupported(
        format!("compression {code} of an SDF file, for which ISO 25178-71 defines no method"),
        "export the file without compression",
    ))
}
