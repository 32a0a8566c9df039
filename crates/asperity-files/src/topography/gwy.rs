//! Gwyddion GWY: a tree of named values.
//!
//! After the signature "GWYP" follows one object: its type name, its length and its components, each a name, a type
//! letter and a value ("i" int32, "d" double, "s" string, "D" array of doubles, "o" object, ...). Channel N is the
//! object `/N/data` (GwyDataField: xres, yres, xreal, yreal, si_unit_xy, si_unit_z, data), its title
//! `/N/data/title`, its mask `/N/mask`; masked points are read as undefined. (Gwyddion user guide, "Gwyddion file
//! format".)

use std::collections::BTreeMap;

use ndarray::Array2;

use super::cursor::{Cursor, text};
use super::finish::{Lateral, Measured, Unit, unit_of};
use super::grid::{self, Layout};
use super::sample::{Kind, Order};
use super::unit::LoneA;
use super::{Problem, Reader, Request, Result, write};

pub(super) const GWY: Reader =
    Reader::new("gwy", |bytes| bytes.starts_with(SIGNATURE), read).written_by(write::gwy::encode);

const SIGNATURE: &[u8] = b"GWYP";
/// Objects lie in objects: Gwyddion nests some five deep.
const DEEPEST: usize = 32;

/// Reads the channel asked for.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let mut cursor = Cursor::new(bytes, Order::Little);
    cursor.bytes(SIGNATURE.len() as u64, "the signature")?;
    let container = Object::parse(&mut cursor, 0)?;
    let mut numbers: Vec<u32> = container.components.keys().filter_map(|name| number(name)).collect();
    numbers.sort_unstable();
    numbers.dedup();
    let field = |n: u32, key: &str| match container.get(&format!("/{n}/{key}")) {
        Some(Value::Object(field)) if field.kind == b"GwyDataField" => Some(field),
        _ => None,
    };
    let fields: Vec<(u32, &Object)> = numbers.iter().filter_map(|n| Some((*n, field(*n, "data")?))).collect();
    let names: Vec<String> = fields
        .iter()
        .map(|(n, _)| match container.get(&format!("/{n}/data/title")) {
            Some(Value::Text(title)) if !text(title).is_empty() => text(title),
            _ => format!("channel {n}"),
        })
        .collect();
    let index = request.choose_heights(&names, |i| fields[i].1.unit("si_unit_z"))?;
    let (n, data) = fields[index];

    let mut heights = data.map()?;
    if let Some(mask) = field(n, "mask") {
        let mask = mask.map()?;
        if mask.dim() != heights.dim() {
            let expected = format!("{:?} as that of the heights", heights.dim());
            return Err(Problem::malformed("the shape of the mask", format!("{:?}", mask.dim()), expected));
        }
        grid::undefine(&mut heights, &mask, |masked| masked > 0.5);
    }
    let length = |key: &str| match data.get(key) {
        Some(Value::Double(length)) if length.is_finite() && *length != 0.0 => Some(length.abs()),
        _ => None,
    };
    let unit = data.unit("si_unit_xy");
    let lateral = match (length("xreal"), length("yreal")) {
        (Some(x), Some(y)) => Lateral::of([x, y], [unit.clone(), unit]),
        _ => Lateral::Unstated(String::new()),
    };
    let meta = match container.get(&format!("/{n}/meta")) {
        Some(Value::Object(meta)) => Some(&meta.components),
        _ => None,
    };
    let metadata = meta.into_iter().flatten().filter_map(|(key, value)| match value {
        Value::Text(value) => Some((text(key), text(value))),
        _ => None,
    });
    let unit = data.unit("si_unit_z");
    Ok(Measured::new(heights, unit, lateral).of_channel(names, index).with(metadata))
}

/// N of "/N/data".
fn number(key: &[u8]) -> Option<u32> {
    std::str::from_utf8(key).ok()?.strip_prefix('/')?.strip_suffix("/data")?.parse().ok()
}

/// A value that matters here; others are skipped.
enum Value<'a> {
    Int(i32),
    Double(f64),
    Text(&'a [u8]),
    /// The bytes of an array of doubles.
    Doubles(&'a [u8]),
    Object(Object<'a>),
    Skipped,
}

struct Object<'a> {
    kind: &'a [u8],
    components: BTreeMap<&'a [u8], Value<'a>>,
}

impl<'a> Object<'a> {
    fn parse(cursor: &mut Cursor<'a>, depth: usize) -> Result<Self> {
        if depth > DEEPEST {
            let expected = format!("at most {DEEPEST}");
            return Err(Problem::malformed("the depth of nested objects", depth, expected));
        }
        let kind = string(cursor)?;
        let length = cursor.u32("the length of an object")?;
        let content = cursor.bytes(u64::from(length), &format!("the object {:?}", text(kind)))?;
        let mut inner = Cursor::new(content, Order::Little);
        let mut components = BTreeMap::new();
        while !inner.rest().is_empty() {
            let name = string(&mut inner)?;
            match Value::parse(&mut inner, name, depth)? {
                Value::Skipped => {}
                value => drop(components.insert(name, value)),
            }
        }
        Ok(Object { kind, components })
    }

    fn get(&self, key: &str) -> Option<&Value<'a>> {
        self.components.get(key.as_bytes())
    }

    /// Unit of a data field. A missing unit means a number without dimension.
    fn unit(&self, key: &str) -> Unit {
        let Some(Value::Object(unit)) = self.get(key) else { return Unit::Unstated };
        match unit.get("unitstr") {
            // A lone A is the ampere of Gwyddion's current channels.
            Some(Value::Text(label)) => unit_of(&text(label), LoneA::Ampere),
            _ => Unit::Unstated,
        }
    }

    /// The values of a data field.
    fn map(&self) -> Result<Array2<f64>> {
        let resolution = |key: &str| match self.get(key) {
            Some(Value::Int(n)) => Ok(u64::try_from(*n).unwrap_or(0)),
            _ => Err(Problem::malformed(format!("{key:?} of the data field"), "missing", "present")),
        };
        let points = [resolution("xres")?, resolution("yres")?];
        let Some(Value::Doubles(bytes)) = self.get("data") else {
            return Err(Problem::malformed("\"data\" of the data field", "missing", "an array of doubles"));
        };
        Layout::dense(points, Kind::F64, Order::Little).map(bytes, "the data field", |v| v)
    }
}

impl<'a> Value<'a> {
    fn parse(c: &mut Cursor<'a>, name: &[u8], depth: usize) -> Result<Self> {
        let what = || format!("the component {:?}", text(name));
        let kind = c.u8(&what())?;
        let array = |c: &mut Cursor<'a>, width: u64| {
            let count = c.u32(&what())?;
            c.bytes(u64::from(count) * width, &what())
        };
        Ok(match kind {
            b'i' => Value::Int(c.i32(&what())?),
            b'd' => Value::Double(c.f64(&what())?),
            b's' => Value::Text(string(c)?),
            b'o' => Value::Object(Object::parse(c, depth + 1)?),
            b'D' => Value::Doubles(array(c, 8)?),
            b'b' | b'c' => c.bytes(1, &what()).map(|_| Value::Skipped)?,
            b'q' => c.bytes(8, &what()).map(|_| Value::Skipped)?,
            b'C' => array(c, 1).map(|_| Value::Skipped)?,
            b'I' => array(c, 4).map(|_| Value::Skipped)?,
            b'Q' => array(c, 8).map(|_| Value::Skipped)?,
            b'S' | b'O' => {
                for _ in 0..c.u32(&what())? {
                    if kind == b'S' { string(c).map(drop)? } else { Object::parse(c, depth + 1).map(drop)? }
                }
                Value::Skipped
            }
            other => {
                let (what, kind) = (format!("the type of {}", what()), char::from(other));
                return Err(Problem::malformed(what, kind, "one of bciqdsoCIQDSO"));
            }
        })
    }
}

/// A string that ends with a zero.
fn string<'a>(cursor: &mut Cursor<'a>) -> Result<&'a [u8]> {
    let rest = cursor.rest();
    let length = memchr::memchr(0, rest)
        .ok_or_else(|| Problem::truncated("a string", rest.len() as u64 + 1, rest.len() as u64))?;
    Ok(&cursor.bytes(length as u64 + 1, "a string")?[..length])
}
