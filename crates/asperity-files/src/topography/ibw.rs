//! Igor Pro binary waves (.ibw), version 5: the files of Asylum Research's atomic force microscopes.
//!
//! A header of 64 bytes (lengths of all parts) and one of 320 (type, points, spacing and units of up to four
//! dimensions), the numbers with x fastest, line by line from the bottom up, layer by layer; then the formula, the
//! note, long units and the labels of the dimensions (32 bytes each, the first of the dimension itself, the others of
//! its elements). The layers are the channels. (WaveMetrics, "Technical note 003: Igor binary format".)
//!
//! Asylum Research writes one unit, m, for all layers. What a layer is, its label says: "HeightRetrace" and
//! "DeflectionRetrace" are lengths, "PhaseRetrace" is an angle.

use super::cursor::{Cursor, text};
use super::finish::{Lateral, Measured, unit_of};
use super::grid::{self, Layout};
use super::request::check_channels;
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Problem, Reader, Request, Result};

pub(super) const IBW: Reader = Reader::new("ibw", is_ibw, read);

const HEADER: u64 = 64;
const WAVE_HEADER: u64 = 320;
const LABEL: usize = 32;

/// Order of the bytes, where the first two are the version 5.
fn order(bytes: &[u8]) -> Option<Order> {
    match bytes {
        [5, 0, ..] => Some(Order::Little),
        [0, 5, ..] => Some(Order::Big),
        _ => None,
    }
}

/// Whether the bytes are a wave of Igor Pro.
fn is_ibw(bytes: &[u8]) -> bool {
    let Some(order) = order(bytes) else { return false };
    let number = |at: u64| Cursor::at(bytes, at, order, "").and_then(|mut c| c.i32("")).unwrap_or(-1);
    let kind = Cursor::at(bytes, 80, order, "").and_then(|mut c| c.u16("")).unwrap_or(u16::MAX);
    let points = (0..4).map(|d| i64::from(number(132 + 4 * d))).take_while(|n| *n > 0);
    let count = points.fold(1i64, i64::saturating_mul);
    number(4) >= WAVE_HEADER as i32 && kind < 0x80 && number(76) >= 0 && count == i64::from(number(76)).max(1)
}

/// Reads the layer asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    const H: &str = "the header of the Igor wave";
    let order = order(bytes).ok_or_else(|| {
        Problem::unsupported("an Igor wave of another version than 5", "save it with Igor Pro 6 or newer")
    })?;
    let mut c = Cursor::at(bytes, 4, order, H)?;
    let mut lengths = [0; 13];
    for length in &mut lengths {
        *length = u64::from(c.u32(H)?);
    }
    let [wave, formula, note, ..] = lengths;

    let at = |offset| Cursor::at(bytes, offset, order, H);
    let code = at(80)?.u16(H)?;
    let name = at(92)?.text(LABEL as u64, H)?;
    let mut c = at(132)?;
    let points = [c.u32(H)?, c.u32(H)?, c.u32(H)?, c.u32(H)?].map(u64::from);
    let spacing = [c.f64(H)?, c.f64(H)?];
    let mut c = at(212)?;
    let short_units = [c.text(4, H)?, c.text(4, H)?, c.text(4, H)?];
    let kind = kind(code)?;

    // What follows the numbers.
    let mut c = Cursor::at(bytes, HEADER + wave, order, "the end of the Igor wave")?;
    c.bytes(formula, "the formula")?;
    let note = note_entries(c.bytes(note, "the note")?);
    // The units of the data and of the dimensions; long ones replace the short ones of the header.
    let long = lengths[3..8].iter().map(|length| c.text(*length, "a unit of the Igor wave"));
    let long = long.collect::<Result<Vec<_>, _>>()?.into_iter();
    let either = |(long, short): (String, String)| if long.is_empty() { short } else { long };
    let units: Vec<String> = long.zip(short_units).map(either).collect();
    let mut labels = Vec::new();
    for length in &lengths[8..12] {
        let block = c.bytes(*length, "the labels of a dimension")?;
        labels.push(block.as_chunks::<LABEL>().0.iter().skip(1).map(|l| text(l)).collect::<Vec<_>>());
    }

    let [nx, ny, layers, more] = points;
    if more > 1 {
        return Err(request.no_heights("four dimensions"));
    }
    if nx < 2 || ny < 2 {
        return Err(request.no_heights(format!("a curve of {} points", nx.max(ny))));
    }
    if layers == 0 && labels[1].iter().any(|l| !l.is_empty()) {
        return Err(request.no_heights(format!("{ny} curves ({})", labels[1].join(", "))));
    }
    let layers = layers.max(1);
    check_channels(usize::try_from(layers).unwrap_or(usize::MAX))?;
    let layer = grid::points(nx, ny)? as u64 * kind.width() as u64;
    let data = Cursor::at(bytes, HEADER + WAVE_HEADER, order, "the Igor wave")?.rest();
    Problem::check_length("the Igor wave", layer.saturating_mul(layers), data.len())?;
    let label = |i: usize| labels[2].get(i).filter(|l| !l.is_empty());
    let names: Vec<String> = (0..layers as usize)
        .map(|i| label(i).cloned().unwrap_or_else(|| format!("no name ({})", i + 1)))
        .collect();
    let unit = |i: usize| match label(i) {
        Some(label) if !note.is_empty() => unit_of(&asylum_unit(label, &note), LoneA::Ampere),
        _ => unit_of(&units[0], LoneA::Ampere),
    };
    let index = request.choose_heights(&names, unit)?;

    let start = index * layer as usize;
    let layout = Layout::dense([nx, ny], kind, order);
    let heights = layout.bottom_up().map(&data[start..], "a layer of the Igor wave", |h| h)?;
    let size = [nx as f64 * spacing[0].abs(), ny as f64 * spacing[1].abs()];
    let lateral = Lateral::of(size, [&units[1], &units[2]].map(|u| unit_of(u, LoneA::Ampere)));
    let measured = Measured::new(heights, unit(index), lateral).of_channel(names, index);
    Ok(measured.with([("Wave", name)]).with(note))
}

fn kind(code: u16) -> Result<Kind> {
    Ok(match code {
        0x02 => Kind::F32,
        0x04 => Kind::F64,
        0x08 => Kind::I8,
        0x10 => Kind::I16,
        0x20 => Kind::I32,
        0x48 => Kind::U8,
        0x50 => Kind::U16,
        0x60 => Kind::U32,
        other => {
            let what = format!("an Igor wave of the type {other:#x} (complex numbers or text)");
            return Err(Problem::unsupported(what, "save a wave of real numbers"));
        }
    })
}

/// The "key: value" lines of the note.
fn note_entries(note: &[u8]) -> Vec<(String, String)> {
    const MOST: usize = 2000;
    let lines = note.split(|b| matches!(b, b'\r' | b'\n')).take(MOST).map(text);
    lines.filter_map(|l| l.split_once(':').map(|(k, v)| (k.trim().to_owned(), v.trim().to_owned()))).collect()
}

/// Unit of a layer: an entry "HeightUnit" of the note, or what the start of the label means.
fn asylum_unit(label: &str, note: &[(String, String)]) -> String {
    let base = label
        .find("Mod")
        .filter(|at| label[at + 3..].chars().all(|c| c.is_ascii_digit()))
        .map_or(label, |at| &label[..at]);
    let base = base.strip_suffix("Retrace").or(base.strip_suffix("Trace")).unwrap_or(base);
    let key = format!("{base}Unit");
    if let Some((_, unit)) = note.iter().find(|(k, _)| *k == key) {
        return unit.clone();
    }
    // From the digital outputs, or from a second pass: the same quantity.
    let quantity = base.strip_prefix("DAC").or(base.strip_prefix("Nap")).unwrap_or(base);
    const UNITS: [(&str, &str); 9] = [
        ("Height", "m"),
        ("ZSensor", "m"),
        ("Deflection", "m"),
        ("Amplitude", "m"),
        ("Phase", "deg"),
        ("Current", "A"),
        ("Frequency", "Hz"),
        ("Capacitance", "F"),
        ("Count", "counts"),
    ];
    UNITS.iter().find(|(start, _)| quantity.starts_with(start)).map_or("V", |(_, unit)| unit).to_owned()
}
