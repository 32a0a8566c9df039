//! FRT MicroProf (.frt), the files of FRT's optical profilers.
//!
//! The signature `FRTM_GLIDERV1.00` (or 1.01), the number of blocks, and blocks of a tag, a length (32 bits; 64 in
//! version 1.01) and a content: 0x66 the points and bits per point, 0x67 the lengths in m, 0x6c metres per unit of
//! height, 0x0b the heights, 0x7d several images with their own points. Lines run from the bottom up; the number 1
//! marks an undefined point. (The readers of Gwyddion and SurfaceTopography.)

use super::cursor::Cursor;
use super::finish::{Lateral, Measured, Unit};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::{Problem, Reader, Request, Result};

pub(super) const FRT: Reader = Reader::new("frt", |bytes| bytes.starts_with(SIGNATURE), read);

const SIGNATURE: &[u8] = b"FRTM_GLIDERV1.0";
const UNDEFINED: f64 = 1.0;

mod tag {
    pub(super) const HEIGHTS: u16 = 0x0b;
    pub(super) const COMMENT: u16 = 0x65;
    pub(super) const POINTS: u16 = 0x66;
    pub(super) const SIZE: u16 = 0x67;
    pub(super) const SCALE: u16 = 0x6c;
    pub(super) const SETUP: u16 = 0x77;
    pub(super) const IMAGES: u16 = 0x7d;
}

/// Kinds of images that are lengths; others are intensities and pictures.
const HEIGHTS: [(u32, &str); 4] =
    [(0x4, "Topography"), (0x80, "Thickness"), (0x800, "Sample thickness"), (0x1000, "AFM")];
const BOTTOM_SENSOR: u32 = 0x1000_0000;

struct Image<'a> {
    name: String,
    points: [u64; 2],
    bits: u32,
    data: &'a [u8],
}

/// Reads the image asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    const H: &str = "the start of the FRT file";
    let mut c = Cursor::new(bytes, Order::Little);
    c.bytes(SIGNATURE.len() as u64, H)?;
    let wide = match c.u8(H)? {
        b'0' => false,
        b'1' => true,
        other => {
            return Err(Problem::malformed("the version of the FRT file", char::from(other), "1.00 or 1.01"));
        }
    };
    let count = c.u16(H)?;
    let (mut points, mut size, mut scale, mut heights) = (None, None, None, None);
    let (mut images, mut metadata) = (Vec::new(), Vec::new());
    for _ in 0..count {
        const B: &str = "a block of the FRT file";
        let tag = c.u16(B)?;
        let length = if wide { c.u64(B)? } else { u64::from(c.u32(B)?) };
        let what = format!("the block {tag:#x} of the FRT file");
        let content = c.bytes(length, &what)?;
        let mut c = Cursor::new(content, Order::Little);
        match tag {
            tag::POINTS => {
                points = Some(([u64::from(c.u32(&what)?), u64::from(c.u32(&what)?)], c.u32(&what)?))
            }
            tag::SIZE => size = Some([c.f64(&what)?, c.f64(&what)?]),
            tag::SCALE => {
                let _range = c.u32(&what)?;
                scale = Some(c.f64(&what)?);
            }
            tag::HEIGHTS => heights = Some(content),
            tag::IMAGES => images = parse_images(&mut c, &what)?,
            tag::COMMENT | tag::SETUP => {
                let key = if tag == tag::COMMENT { "Comment" } else { "Setup" };
                metadata.push((key, super::cursor::text(content)));
            }
            _ => {}
        }
    }
    if let (Some(data), Some((points, bits))) = (heights, points) {
        // The first image repeats these heights.
        images.retain(|image| image.data != data);
        images.insert(0, Image { name: "default".into(), points, bits, data });
    }
    let names: Vec<String> = images.iter().map(|i| i.name.clone()).collect();
    let index = request.choose(&names)?;
    let image = &images[index];
    let missing = |what: &str| Problem::malformed(what, "missing", "present");
    let unit = scale.ok_or_else(|| missing("the block 0x6c (scale of the heights)"))?;
    let what = format!("the heights {:?} of the FRT file", image.name);
    let height = |n: f64| if n == UNDEFINED { f64::NAN } else { n * unit };
    let layout = Layout::dense(image.points, kind(image.bits)?, Order::Little);
    let heights = layout.bottom_up().map(image.data, &what, height)?;
    let lateral = size.map_or(Lateral::Unstated(String::new()), Lateral::Metres);
    Ok(Measured::new(heights, Unit::Metres(1.0), lateral).of_channel(names, index).with(metadata))
}

fn kind(bits: u32) -> Result<Kind> {
    match bits {
        16 => Ok(Kind::U16),
        32 => Ok(Kind::I32),
        other => Err(Problem::malformed("the bits per point", other, "16 or 32")),
    }
}

/// The images of lengths.
fn parse_images<'a>(c: &mut Cursor<'a>, what: &str) -> Result<Vec<Image<'a>>> {
    let _buffers = c.bytes(8, what)?;
    let mut images = Vec::new();
    while !c.rest().is_empty() {
        let (data_type, points) = (c.u32(what)?, [u64::from(c.u32(what)?), u64::from(c.u32(what)?)]);
        let bits = c.u32(what)?;
        let data = c.bytes(grid::points(points[0], points[1])? as u64 * kind(bits)?.width() as u64, what)?;
        if let Some((_, name)) = HEIGHTS.iter().find(|(bit, _)| data_type & bit != 0) {
            let sensor = if data_type & BOTTOM_SENSOR == 0 { "top" } else { "bottom" };
            let number = (data_type >> 24 & 0xf) + 1;
            images.push(Image { name: format!("{name} ({sensor} sensor) {number}"), points, bits, data });
        }
    }
    Ok(images)
}
