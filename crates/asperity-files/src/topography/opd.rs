//! Wyko (Veeco, Bruker) OPD, the files of white-light interferometers.
//!
//! A directory of named blocks (24 bytes each: name, type, length, flags), then the blocks in its order. The heights
//! are an array block (nx, ny, bytes per number, then the columns one after the other, from the top down) in units
//! of Wavelength / Mult nanometres; pixels are Pixel_size x (Pixel_size Aspect) millimetres.

use ndarray::{Array2, Axis};

use super::cursor::Cursor;
use super::finish::{Lateral, Measured, Unit};
use super::sample::{Kind, Order, decode};
use super::{Problem, Reader, Request, Result, cursor, grid};

pub(super) const OPD: Reader = Reader::new("opd", is_opd, read);

/// Names of the arrays that hold heights; others ("Image", "SecArr_0") hold intensities.
const HEIGHTS: [&str; 5] = ["RAW_DATA", "RAW DATA", "Raw", "OPD", "SAMPLE_DATA"];

mod block_type {
    pub(super) const ARRAY: u16 = 3;
    pub(super) const TEXT: u16 = 5;
    pub(super) const SHORT: u16 = 6;
    pub(super) const FLOAT: u16 = 7;
    pub(super) const DOUBLE: u16 = 8;
    pub(super) const LONG: u16 = 12;
}

/// Whether the bytes are an OPD file.
fn is_opd(bytes: &[u8]) -> bool {
    bytes.get(2..).is_some_and(|b| b.starts_with(b"Directory\0"))
}

struct Block<'a> {
    name: String,
    kind: u16,
    content: &'a [u8],
}

/// Reads the heights asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let blocks = blocks(bytes)?;
    let arrays: Vec<&Block> =
        blocks.iter().filter(|b| b.kind == block_type::ARRAY && HEIGHTS.contains(&b.name.as_str())).collect();
    let names: Vec<String> = arrays.iter().map(|b| b.name.clone()).collect();
    let index = request.choose(&names)?;

    let number = |name: &str| blocks.iter().find(|b| b.name == name).and_then(Block::number);
    let wavelength = number("Wavelength").ok_or_else(|| {
        Problem::malformed("the block \"Wavelength\"", "missing", "present: it scales the heights")
    })?;
    let mult = number("Mult").filter(|m| *m != 0.0).unwrap_or(1.0);
    let aspect = number("Aspect").filter(|a| *a != 0.0).unwrap_or(1.0);

    const NM: f64 = 1e-9;
    const MM: f64 = 1e-3;
    let mut heights = arrays[index].array()?;
    grid::replace(&mut heights, |v| v * (wavelength / mult));
    let (nx, ny) = heights.dim();
    let lateral = match number("Pixel_size") {
        Some(pixel) => Lateral::Metres([nx as f64 * pixel * MM, ny as f64 * pixel * aspect * MM]),
        None => Lateral::Unstated(String::new()),
    };
    let metadata = blocks.iter().filter_map(|b| Some((b.name.clone(), b.label()?)));
    Ok(Measured::new(heights, Unit::Metres(NM), lateral).of_channel(names, index).with(metadata))
}

fn blocks(bytes: &[u8]) -> Result<Vec<Block<'_>>> {
    const D: &str = "the OPD directory";
    const ENTRY: u32 = 24;
    let mut directory = Cursor::at(bytes, 2, Order::Little, D)?;
    let entry = |c: &mut Cursor| -> Result<(String, u16, u32)> {
        let (name, kind, length) = (c.text(16, D)?, c.u16(D)?, c.u32(D)?);
        let _flags = c.u16(D)?;
        Ok((name, kind, length))
    };
    let (_, _, length) = entry(&mut directory)?;
    let mut content = Cursor::at(bytes, 2 + u64::from(length), Order::Little, D)?;
    let mut blocks = Vec::new();
    for _ in 1..length / ENTRY {
        let (name, kind, length) = entry(&mut directory)?;
        // Lengths are signed; blocks without content are not in the file.
        let length = i32::from_le_bytes(length.to_le_bytes()).max(0);
        let content = content.bytes(length as u64, &format!("the block {name:?}"))?;
        if !content.is_empty() {
            blocks.push(Block { name, kind, content });
        }
    }
    Ok(blocks)
}

impl Block<'_> {
    /// The number in a block. In some files the declared type does not fit the length: then the length decides.
    fn number(&self) -> Option<f64> {
        let mut c = Cursor::new(self.content, Order::Little);
        let value = match (self.kind, self.content.len()) {
            (block_type::SHORT | block_type::FLOAT, 2) => c.i16("").ok().map(f64::from),
            (block_type::SHORT | block_type::LONG, 4..) => c.i32("").ok().map(f64::from),
            (block_type::FLOAT, 4..) => c.f32("").ok().map(f64::from),
            (block_type::DOUBLE, 8..) => c.f64("").ok(),
            _ => None,
        };
        value.filter(|v| v.is_finite())
    }

    /// The content as text, for the metadata.
    fn label(&self) -> Option<String> {
        match self.kind {
            block_type::TEXT if self.content.len() <= 256 => {
                Some(cursor::text(self.content)).filter(|t| !t.is_empty())
            }
            _ => self.number().map(|v| v.to_string()),
        }
    }

    /// The array, x along axis 0, y downwards.
    fn array(&self) -> Result<Array2<f64>> {
        let what = format!("the array {:?}", self.name);
        let mut c = Cursor::new(self.content, Order::Little);
        let [nx, ny, width] = [c.u16(&what)?, c.u16(&what)?, c.u16(&what)?];
        let points = grid::points(u64::from(nx), u64::from(ny))?;
        // Numbers from this value on mark undefined points.
        let (kind, invalid) = match width {
            1 => (Kind::U8, f64::INFINITY),
            2 => (Kind::I16, 32766.0),
            4 => (Kind::F32, f64::from(1e38_f32)),
            other => {
                return Err(Problem::malformed(format!("bytes per number of {what}"), other, "1, 2 or 4"));
            }
        };
        let mut values = decode(c.rest(), kind, Order::Little, points, &what)?;
        for value in &mut values {
            if value.is_nan() || *value >= invalid {
                *value = f64::NAN;
            }
        }
        let mut array = Array2::from_shape_vec((usize::from(nx), usize::from(ny)), values)
            .map_err(|e| Problem::malformed(what, e, "nx ny numbers"))?;
        array.invert_axis(Axis(1));
        Ok(array.as_standard_layout().into_owned())
    }
}
