//! MountainsMap documents (.mnt) of Digital Surf.
//!
//! A compound document whose stream `ScopedContents` is a tree of entries: tag (16 bits), length (64 bits), content. The
//! document lists objects by class; class 9012 is a measured surface. Surfaces that Mountains made from it (levelled,
//! filtered) are not stored. A surface has two lateral axes (points, spacing), a height axis (step per count, origin in
//! its display unit) and the counts in blocks of zlib, line by line:
//!
//! ```text
//! height = count x step + origin
//! ```
//!
//! A mask of (nx + 2) x (ny + 2) bytes marks measured points by 9. (SurfaceTopography's description of the format;
//! Digital Surf does not publish it.)

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::compound::{self, is_compound};
use super::cursor::{Cursor, utf16};
use super::finish::{Lateral, Measured, Unit, unit_of};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::unit::{LoneA, metres};
use super::unpack::{most_unpacked, read_bounded};
use super::{Problem, Reader, Request, Result, foreign};

// Other documents of this kind are refused by the reader.
pub(super) const MNT: Reader = Reader::new("mnt", is_compound, read);

const CONTENTS: &str = "ScopedContents";
/// Tag of the part that an entry extends.
const BASE: u16 = 0xffff;
const MEASURED: f64 = 9.0;

mod class {
    pub(super) const SURFACE: u32 = 9012;
    pub(super) const MEASUREMENT: u32 = 9062;
    pub(super) const COUNTS: u32 = 9049;
    pub(super) const MASK: u32 = 9056;
}

/// Reads the surface asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let contents = compound::stream(bytes, CONTENTS)
        .map_err(|error| Problem::malformed("the compound document", error, "undamaged"))?;
    let Some(contents) = contents else {
        return Err(foreign::unread(bytes));
    };
    let tree = Node(contents.get(8..).unwrap_or_default());
    // Main part, contents, document, list of objects.
    let objects =
        tree.at(&[0x1, 0x2bd, 0x2, 0x1])?.ok_or_else(|| request.no_heights("no list of objects"))?;
    let mut surfaces = Vec::new();
    let mut c = Cursor::new(objects.0, Order::Little);
    while !c.rest().is_empty() {
        let _length = c.u64("an object of the MNT file")?;
        let (_, object) = entry(&mut c)?;
        if object.class()? == Some(class::SURFACE)
            && let Some(body) = object.find(0x2)?
            && let Some(surface) = Surface::of(body)?
        {
            surfaces.push(surface);
        }
    }
    let names: Vec<String> = surfaces.iter().map(|s| s.name.clone()).collect();
    let index = request.choose_heights(&names, |i| surfaces[i].unit())?;
    surfaces.swap_remove(index).measured(names, index)
}

/// The entries of one level.
#[derive(Clone, Copy)]
struct Node<'a>(&'a [u8]);

fn entry<'a>(c: &mut Cursor<'a>) -> Result<(u16, Node<'a>)> {
    const E: &str = "an entry of the MNT file";
    let (tag, length) = (c.u16(E)?, c.u64(E)?);
    Ok((tag, Node(c.bytes(length, E)?)))
}

impl<'a> Node<'a> {
    /// The first entry with this tag.
    fn find(self, tag: u16) -> Result<Option<Node<'a>>> {
        let mut c = Cursor::new(self.0, Order::Little);
        while !c.rest().is_empty() {
            let (found, content) = entry(&mut c)?;
            if found == tag {
                return Ok(Some(content));
            }
        }
        Ok(None)
    }

    fn at(self, path: &[u16]) -> Result<Option<Node<'a>>> {
        let step = |node: Option<Node<'a>>, tag: &u16| node.map_or(Ok(None), |node| node.find(*tag));
        path.iter().try_fold(Some(self), step)
    }

    fn class(self) -> Result<Option<u32>> {
        Ok(self.at(&[0x1, 0x1])?.and_then(Node::whole))
    }

    fn whole(self) -> Option<u32> {
        Some(u32::from_le_bytes(*self.0.first_chunk().filter(|_| self.0.len() == 4)?))
    }

    fn number(self) -> Option<f64> {
        let number = f64::from_le_bytes(*self.0.first_chunk().filter(|_| self.0.len() == 8)?);
        number.is_finite().then_some(number)
    }

    /// A mark (4) and UTF-16.
    fn text(self) -> Option<String> {
        let text = utf16(self.0.strip_prefix(&[4])?, Order::Little);
        Some(text.trim_matches(['\0', ' ']).to_owned())
    }
}

/// Step, origin and their units.
struct Scale {
    step: f64,
    unit: String,
    display_unit: String,
    /// The display unit in units of the step.
    ratio: f64,
    origin: f64,
}

impl Scale {
    fn of(node: Node, axis: &str) -> Result<Self> {
        let number = |tag| Ok::<_, Problem>(node.find(tag)?.and_then(Node::number));
        let text = |tag| Ok::<_, Problem>(node.find(tag)?.and_then(Node::text).unwrap_or_default());
        let step = number(0x1)?;
        let step = step.ok_or_else(|| {
            Problem::malformed(format!("the step of the {axis} axis"), "missing", "a number")
        })?;
        let unit = text(0x2)?;
        let display_unit = Some(text(0x3)?).filter(|u| !u.is_empty()).unwrap_or_else(|| unit.clone());
        let (ratio, origin) = (number(0x4)?.unwrap_or(1.0), number(0x5)?.unwrap_or(0.0));
        Ok(Scale { step, unit, display_unit, ratio, origin })
    }

    /// Metres per count, and the origin in metres.
    fn metres(&self) -> Option<[f64; 2]> {
        let of = |unit: &str| metres(unit, LoneA::Angstrom);
        Some([self.step * of(&self.unit)?, self.origin * of(&self.display_unit)?])
    }
}

/// A measured surface.
struct Surface<'a> {
    name: String,
    title: Option<String>,
    points: [u64; 2],
    axes: [Scale; 3],
    counts: Node<'a>,
    mask: Option<Node<'a>>,
}

impl<'a> Surface<'a> {
    /// `None` where the object has no heights.
    fn of(body: Node<'a>) -> Result<Option<Self>> {
        let title = body.at(&[BASE, 0x4])?.and_then(Node::text).filter(|t| !t.is_empty());
        let Some(object) = body.find(0x1)? else { return Ok(None) };
        if object.class()? != Some(class::MEASUREMENT) {
            return Ok(None);
        }
        let Some(measurement) = object.at(&[0x2, BASE])? else { return Ok(None) };
        let (Some(grid), Some(counts), Some(z)) =
            (measurement.find(BASE)?, measurement.find(0x1)?, measurement.at(&[0x2, BASE])?)
        else {
            return Ok(None);
        };
        let (Some(x), Some(y)) = (grid.at(&[0x1, BASE])?, grid.at(&[0x2, BASE])?) else { return Ok(None) };
        if counts.class()? != Some(class::COUNTS) {
            return Ok(None);
        }
        let points = |axis: Node| {
            let points = axis.find(0x1)?.and_then(Node::whole).map(u64::from);
            points.ok_or_else(|| Problem::malformed("the points of an axis", "missing", "a whole number"))
        };
        let scale = |axis: Node, name: &str| Scale::of(axis.find(BASE)?.unwrap_or(Node(&[])), name);
        let name = grid.at(&[BASE, BASE, 0x1])?.and_then(Node::text).filter(|n| !n.is_empty());
        let mask = match grid.find(0x3)? {
            Some(mask) if mask.class()? == Some(class::MASK) => mask.at(&[0x2, 0x5])?,
            _ => None,
        };
        Ok(Some(Surface {
            name: name.or_else(|| title.clone()).unwrap_or_else(|| "Default".into()),
            title,
            points: [points(x)?, points(y)?],
            axes: [scale(x, "x")?, scale(y, "y")?, Scale::of(z, "height")?],
            counts,
            mask,
        }))
    }

    fn unit(&self) -> Unit {
        unit_of(&self.axes[2].display_unit, LoneA::Angstrom)
    }

    fn measured(self, names: Vec<String>, index: usize) -> Result<Measured> {
        const WHAT: &str = "the heights of the MNT file";
        let [x, y, z] = &self.axes;
        let count = grid::points(self.points[0], self.points[1])? as u64;
        let ([step, origin], unit) = match z.metres() {
            Some(metres) => (metres, Unit::Metres(1.0)),
            None => ([z.step, z.origin * z.ratio], unit_of(&z.unit, LoneA::Angstrom)),
        };
        let bytes = blocks(self.counts, count, WHAT)?;
        let kind = match bytes.len() as u64 / count {
            2 => Kind::I16,
            4 => Kind::I32,
            other => return Err(Problem::malformed("the bytes per height", other, "2 or 4")),
        };
        let layout = Layout::dense(self.points, kind, Order::Little);
        let mut heights = layout.map(&bytes, WHAT, |n| n * step + origin)?;
        drop(bytes);
        if let Some(mask) = self.mask {
            const MASK: &str = "the mask of the MNT file";
            // With a border of one point.
            let points = self.points.map(|n| n + 2);
            let bytes = blocks(mask, points[0].saturating_mul(points[1]), MASK)?;
            let layout = Layout { kind: Kind::U8, stride: points[0], ..layout };
            let first = bytes.get(points[0] as usize + 1..).unwrap_or_default();
            grid::undefine(&mut heights, &layout.map(first, MASK, |m| m)?, |m| m != MEASURED);
        }
        let [nx, ny] = self.points.map(|n| n as f64);
        let size = [nx * x.step.abs(), ny * y.step.abs()];
        let lateral = Lateral::of(size, [&x.unit, &y.unit].map(|u| unit_of(u, LoneA::Angstrom)));
        let title = self.title.map(|title| ("Title", title));
        Ok(Measured::new(heights, unit, lateral).of_channel(names, index).with(title))
    }
}

/// An array of `count` elements in blocks of zlib: offset and number of elements, packed length, stream.
fn blocks(array: Node, count: u64, what: &str) -> Result<Vec<u8>> {
    let missing = || Problem::malformed(what, "missing", "present");
    let array = array.find(0x2)?.ok_or_else(missing)?;
    let stated = array.find(0x1)?.and_then(Node::whole).map(u64::from);
    if stated != Some(count) {
        let stated = stated.map_or("missing".to_owned(), |n| n.to_string());
        return Err(Problem::malformed(format!("the number of points of {what}"), stated, count.to_string()));
    }
    let data = array.find(0x2)?.ok_or_else(missing)?.0;
    let mut c = Cursor::new(data, Order::Little);
    let length = c.u64(what)?;
    let most = most_unpacked(data.len());
    if length % count != 0 || length / count > 4 || length > most {
        let expected = format!("1, 2 or 4 for each of {count} points and at most {most}");
        return Err(Problem::malformed(format!("the bytes of {what}"), length, expected));
    }
    let width = length / count;
    let mut blocks = Vec::new();
    let mut left = length;
    while !c.rest().is_empty() {
        let (offset, elements, packed) = (c.u64(what)?, u64::from(c.u32(what)?), c.u32(what)?);
        let stream = c.bytes(u64::from(packed), what)?;
        let bytes = elements * width;
        // The lengths may not exceed the whole, and memory is taken as the bytes come.
        let likely = bytes.min(left).min(8 * u64::from(packed));
        let block = read_bounded(ZlibDecoder::new(stream).take(bytes), left, likely, what)?;
        if block.len() as u64 != bytes {
            return Err(Problem::truncated(format!("a block of {what}"), bytes, block.len() as u64));
        }
        left -= bytes;
        blocks.push((offset.saturating_mul(width), block));
    }
    blocks.sort_by_key(|(offset, _)| *offset);
    let mut whole = Vec::with_capacity((length - left) as usize);
    for (offset, block) in blocks {
        if offset != whole.len() as u64 {
            let expected = format!("at {}, after the one before it", whole.len());
            return Err(Problem::malformed(format!("a block of {what}"), format!("at {offset}"), expected));
        }
        whole.extend(block);
    }
    Problem::check_length(what, length, whole.len())?;
    Ok(whole)
}
