//! Digital Surf SUR, the files of MountainsMap and of many instruments.
//!
//! An object is a header of 512 bytes, a comment, a private zone and the points as 16- or 32-bit integers, line by
//! line; since 2010 the points may be packed as zlib streams (signature DSCOMPRESSED). A file holds several objects
//! one after the other: the layers of a surface, or a surface and its images. Height = integer x spacing, plus the
//! offset where the z axis is absolute; on a relative axis the offset has no meaning. Points that were not measured
//! have the value (least z - 2).
//!
//! Layout after the "Surface format" of Digital Surf as the readers of Gwyddion and RosettaSciIO know it.

use std::io::Read;

use flate2::read::ZlibDecoder;
use ndarray::Axis;

use super::cursor::Cursor;
use super::finish::{Lateral, Measured, unit_of};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::unpack::{most_unpacked, read_bounded};
use super::{Problem, Reader, Request, Result};

pub(super) const SUR: Reader = Reader::new(
    "sur",
    |bytes| bytes.starts_with(b"DIGITAL SURF") || bytes.starts_with(b"DSCOMPRESSED"),
    read,
);

/// Kinds of objects whose first object, or every one, is a surface.
mod studiable {
    pub(super) const PROFILE: i16 = 1;
    pub(super) const SURFACE: i16 = 2;
    pub(super) const SERIES_OF_SURFACES: i16 = 5;
    pub(super) const MULTILAYER_SURFACE: i16 = 8;
    pub(super) const INTENSITY_SURFACE: i16 = 11;
    pub(super) const RGB_SURFACE: i16 = 13;
    pub(super) const RGB_INTENSITY_SURFACE: i16 = 16;
}

/// Reads the surface asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let mut cursor = Cursor::new(bytes, Order::Little);
    let first = Object::parse(&mut cursor)?;
    // The first header counts the objects; "P size" is the number of channels of each, 0 for one.
    let count = usize::from(first.objects.max(1)) * usize::from(first.channels.max(1));
    let all_are_surfaces = matches!(
        first.kind,
        studiable::SURFACE | studiable::SERIES_OF_SURFACES | studiable::MULTILAYER_SURFACE
    );
    let has_surface = all_are_surfaces
        || matches!(
            first.kind,
            studiable::INTENSITY_SURFACE | studiable::RGB_SURFACE | studiable::RGB_INTENSITY_SURFACE
        )
        // Gwyddion writes surfaces as profiles of many lines.
        || (first.kind == studiable::PROFILE && first.points[1] > 1);
    if !has_surface {
        let detail = format!("its objects are of the kind {}, not surfaces", first.kind);
        return Err(request.no_heights(detail));
    }
    let mut objects = vec![first];
    while all_are_surfaces && objects.len() < count && !cursor.rest().is_empty() {
        objects.push(Object::parse(&mut cursor)?);
    }
    let names: Vec<String> = match objects.as_slice() {
        [only] => vec![only.name.clone()],
        more => more
            .iter()
            .enumerate()
            .map(|(i, o)| if o.name.is_empty() { format!("layer {i}") } else { format!("{} {i}", o.name) })
            .collect(),
    };
    let index = request.choose(&names)?;
    objects.swap_remove(index).measured(names, index)
}

/// One object: what the header says, and its points.
struct Object<'a> {
    objects: u16,
    channels: u16,
    kind: i16,
    name: String,
    /// The number of points that were not measured; NaN if all were.
    undefined: f64,
    bits: i16,
    /// Along x and y.
    points: [u64; 2],
    values_per_point: u32,
    spacing: [f64; 3],
    unit: [String; 3],
    inversion: i16,
    /// Of the heights; 0 on a relative axis.
    offset: f64,
    metadata: Vec<(&'static str, String)>,
    data: Data<'a>,
}

enum Data<'a> {
    Plain(&'a [u8]),
    /// zlib streams and their unpacked lengths.
    Packed(Vec<(&'a [u8], u32)>),
}

impl<'a> Object<'a> {
    fn parse(c: &mut Cursor<'a>) -> Result<Self> {
        const H: &str = "the SUR header";
        let signature = c.clone().text(12, H)?;
        let packed = match signature.as_str() {
            "DIGITAL SURF" => false,
            "DSCOMPRESSED" => true,
            _ => {
                let expected = "\"DIGITAL SURF\"";
                return Err(Problem::malformed("the signature of a SUR object", signature, expected));
            }
        };
        let header = c.bytes(512, H)?;
        let at = |offset| Cursor::at(header, offset, Order::Little, H);
        let short = |offset| at(offset)?.i16(H);
        let text = |offset, length| at(offset)?.text(length, H);
        let values_per_point = at(94)?.u32(H)?;
        let bits = short(98)?;
        let [points, lines] = [at(108)?.u32(H)?, at(112)?.u32(H)?].map(u64::from);
        let unit = [text(180, 16)?, text(196, 16)?, text(212, 16)?];
        let [second, minute, hour] = [short(306)?, short(308)?, short(310)?];
        let [day, month, year] = [short(312)?, short(314)?, short(316)?];
        let offset = f64::from(at(474)?.f32(H)?);
        let comment = c.text(u64::from(at(334)?.u16(H)?), "the SUR comment")?;
        let _private = c.bytes(u64::from(at(336)?.u16(H)?), "the private zone of the SUR object")?;

        let data = if packed {
            let count = c.u32("the number of packed streams")?;
            let lengths = c.bytes(8 * u64::from(count), "the lengths of the packed streams")?;
            let mut lengths = Cursor::new(lengths, Order::Little);
            let mut streams = Vec::new();
            for _ in 0..count {
                let [unpacked, packed] = [lengths.u32("a length")?, lengths.u32("a length")?];
                streams.push((c.bytes(u64::from(packed), "a packed stream")?, unpacked));
            }
            Data::Packed(streams)
        } else {
            let points = grid::points(points, lines)? as u64;
            let width = u64::from(bits.unsigned_abs()) / 8;
            let length = points.saturating_mul(width).saturating_mul(u64::from(values_per_point.max(1)));
            Data::Plain(c.bytes(length, "the points of the SUR object")?)
        };
        let date = match year > 0 {
            true => format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}"),
            false => String::new(),
        };
        let mut metadata = vec![("operator", text(50, 30)?), ("comment", comment), ("date", date)];
        if offset != 0.0 {
            metadata.push(("z offset", format!("{offset} {}", unit[2])));
        }
        Ok(Object {
            objects: at(14)?.u16(H)?,
            channels: at(80)?.u16(H)?,
            kind: short(18)?,
            name: text(20, 30)?,
            undefined: if short(86)? == 1 { f64::from(at(100)?.i32(H)?) - 2.0 } else { f64::NAN },
            bits,
            points: [points, lines],
            values_per_point,
            spacing: [at(120)?.f32(H)?, at(124)?.f32(H)?, at(128)?.f32(H)?].map(f64::from),
            unit,
            inversion: short(290)?,
            // Of the heights, on an absolute axis.
            offset: if short(88)? != 0 { offset } else { 0.0 },
            metadata,
            data,
        })
    }

    fn measured(self, names: Vec<String>, index: usize) -> Result<Measured> {
        if self.values_per_point > 1 {
            let what = format!("a SUR object with {} values per point", self.values_per_point);
            return Err(Problem::unsupported(what, "export the surface alone from MountainsMap"));
        }
        let kind = match self.bits {
            16 => Kind::I16,
            32 => Kind::I32,
            other => return Err(Problem::malformed("the bits per point", other, "16 or 32")),
        };
        let unpacked;
        let bytes = match &self.data {
            Data::Plain(bytes) => *bytes,
            Data::Packed(streams) => {
                let points = grid::points(self.points[0], self.points[1])?;
                unpacked = unpack(streams, points as u64 * kind.width() as u64)?;
                unpacked.as_slice()
            }
        };
        let [dx, dy, dz] = self.spacing;
        // 1: heights inverted; 2: and mirrored left-right; 3: and upside down.
        let sign = if matches!(self.inversion, 1..=3) { -1.0 } else { 1.0 };
        let height = |v: f64| if v == self.undefined { f64::NAN } else { sign * v * dz + self.offset };
        let layout = Layout::dense(self.points, kind, Order::Little);
        let mut heights = layout.map(bytes, "the points of the SUR object", height)?;
        if let 2 | 3 = self.inversion {
            heights.invert_axis(Axis(usize::from(self.inversion == 3)));
            heights = heights.as_standard_layout().into_owned();
        }
        let (nx, ny) = heights.dim();

        let [ux, uy, unit] = self.unit.each_ref().map(|u| unit_of(u, LoneA::Angstrom));
        let lateral = Lateral::of([nx as f64 * dx.abs(), ny as f64 * dy.abs()], [ux, uy]);
        Ok(Measured::new(heights, unit, lateral).of_channel(names, index).with(self.metadata))
    }
}

/// The first `needed` bytes of the streams.
fn unpack(streams: &[(&[u8], u32)], needed: u64) -> Result<Vec<u8>> {
    const WHAT: &str = "the points of the SUR object";
    let packed: usize = streams.iter().map(|(stream, _)| stream.len()).sum();
    let most = most_unpacked(packed);
    if needed > most {
        let expected = "no more than 64 times their packed length";
        return Err(Problem::malformed(format!("the length of {WHAT}"), format!("{needed} bytes"), expected));
    }
    let likely = needed.min(8 * packed as u64);
    let mut bytes = Vec::with_capacity(likely as usize);
    for (stream, length) in streams {
        let length = u64::from(*length);
        bytes.extend(read_bounded(ZlibDecoder::new(*stream).take(length), most, likely.min(length), WHAT)?);
        if bytes.len() as u64 >= needed {
            break;
        }
    }
    Ok(bytes)
}
