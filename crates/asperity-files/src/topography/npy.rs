//! NumPy arrays: NPY, and NPZ, a zip of them.
//!
//! The header is a Python dictionary `{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3), }` after the
//! signature, the version and its length (NumPy Enhancement Proposal 1). Axis 0 of the array is x. NPY states
//! neither size nor unit; an NPZ states them where it has the arrays `size` (two lengths) and `unit` (text, of the
//! size and the heights), as the writer of this crate puts them.

use ndarray::Array2;

use super::cursor::Cursor;
use super::finish::{Lateral, Measured, Unit, unit_of};
use super::grid::{self, Layout};
use super::sample::{Kind, Order, decode};
use super::unit::LoneA;
use super::unpack::{Archive, holds_member};
use super::{HISTORY, Problem, Reader, Request, Result, write};

pub(super) const NPY: Reader = Reader::new("npy", |bytes| bytes.starts_with(SIGNATURE), read);

pub(super) const NPZ: Reader =
    Reader::new("npz", |bytes| holds_member(bytes, |name| name.ends_with(".npy")), read_archive)
        .written_by(write::npz::encode);

const SIGNATURE: &[u8] = b"\x93NUMPY";

/// Reads an NPY file.
fn read(bytes: &[u8], request: &Request) -> Result<Measured> {
    let heights = Npy::parse(bytes)?.heights(request)?;
    Ok(Measured::new(heights, Unit::Unstated, Lateral::Unstated(String::new())))
}

/// Reads the channel asked for from an NPZ file: each two-dimensional array is a channel.
fn read_archive(bytes: &[u8], request: &Request) -> Result<Measured> {
    let mut archive = Archive::open(bytes)?;
    let (mut names, mut size, mut unit, mut metadata) = (Vec::new(), None, None, Vec::new());
    for member in archive.names() {
        let Some(name) = member.strip_suffix(".npy") else { continue };
        // The header and all of a small array.
        let start = archive.start(&member, 1 << 16)?;
        let Ok(array) = Npy::parse(&start) else { continue };
        match name {
            "size" if array.shape == [2] => {
                size = array.values().ok().and_then(|v| <[f64; 2]>::try_from(v).ok());
            }
            "unit" if array.shape.is_empty() => unit = array.text(),
            "history" if array.shape.is_empty() => {
                metadata.extend(array.text().map(|text| (HISTORY, text)));
            }
            _ if array.shape.len() == 2 && array.kind().is_some() => names.push(name.to_owned()),
            _ => {}
        }
    }
    let index = match names.iter().position(|n| n == "heights") {
        Some(heights) if request.channel.is_none() => heights,
        _ => request.choose(&names)?,
    };
    let content = archive.member(&format!("{}.npy", names[index]))?;
    let array = Npy::parse(&content)?;
    let unit = unit_of(&unit.unwrap_or_default(), LoneA::Angstrom);
    let lateral = match (size, &unit) {
        (Some(size), Unit::Metres(metres)) => Lateral::Metres(size.map(|l| l * metres)),
        (Some(size), _) => Lateral::Bare(size),
        (None, _) => Lateral::Unstated(String::new()),
    };
    Ok(Measured::new(array.heights(request)?, unit, lateral).of_channel(names, index).with(metadata))
}

/// An array in an NPY file.
struct Npy<'a> {
    descr: &'a str,
    fortran_order: bool,
    shape: Vec<u64>,
    data: &'a [u8],
}

impl<'a> Npy<'a> {
    fn parse(bytes: &'a [u8]) -> Result<Self> {
        const HEADER: &str = "the NPY header";
        let rest = bytes
            .strip_prefix(SIGNATURE)
            .ok_or_else(|| Problem::malformed("the signature", "something else", "\\x93NUMPY"))?;
        let mut c = Cursor::new(rest, Order::Little);
        let [major, _minor] = [c.u8(HEADER)?, c.u8(HEADER)?];
        let length = if major == 1 { u64::from(c.u16(HEADER)?) } else { u64::from(c.u32(HEADER)?) };
        let header = std::str::from_utf8(c.bytes(length, HEADER)?)
            .map_err(|_| Problem::malformed(HEADER, "not text", "a Python dictionary"))?;
        let field = |key: &str| {
            // Keys are quoted by ' or "; no value contains one of them as text.
            let at = header.find(&format!("'{key}'")).or_else(|| header.find(&format!("\"{key}\"")));
            at.and_then(|at| header[at + key.len() + 2..].trim_start().strip_prefix(':'))
                .map(str::trim_start)
                .ok_or_else(|| {
                    Problem::malformed(HEADER, header, format!("a dictionary with the key {key:?}"))
                })
        };
        let descr = field("descr")?;
        let quoted = descr.strip_prefix(['\'', '"']).ok_or_else(|| {
            let instead = "save one field of it as an array of its own";
            Problem::unsupported("an NPY file of records (a structured type)", instead)
        })?;
        let descr = quoted.split(['\'', '"']).next().unwrap_or_default();
        let fortran_order = match field("fortran_order")? {
            value if value.starts_with("False") => false,
            value if value.starts_with("True") => true,
            value => {
                return Err(Problem::malformed("'fortran_order' in the NPY header", value, "True or False"));
            }
        };
        let tuple = field("shape")?;
        let numbers = |inner: &str| {
            let numbers = inner.split(',').map(str::trim).filter(|n| !n.is_empty());
            numbers.map(|n| n.trim_end_matches('L').parse().ok()).collect::<Option<Vec<u64>>>()
        };
        let inner = tuple.strip_prefix('(').and_then(|t| t.split_once(')')).map(|(inner, _)| inner);
        let shape = inner.and_then(numbers).ok_or_else(|| {
            Problem::malformed("'shape' in the NPY header", tuple, "a tuple of whole numbers")
        })?;
        Ok(Npy { descr, fortran_order, shape, data: c.rest() })
    }

    /// Type and order of the numbers, or `None` where they are no real numbers.
    fn kind(&self) -> Option<(Kind, Order)> {
        // "|": one byte; "=": of the machine that wrote it, which is little-endian.
        let order = if self.descr.starts_with('>') { Order::Big } else { Order::Little };
        let name = self.descr.trim_start_matches(['<', '>', '|', '=']);
        let kind = match name {
            "f2" => Kind::F16,
            "f4" => Kind::F32,
            "f8" => Kind::F64,
            "i1" => Kind::I8,
            "i2" => Kind::I16,
            "i4" => Kind::I32,
            "i8" => Kind::I64,
            "u1" | "b1" => Kind::U8,
            "u2" => Kind::U16,
            "u4" => Kind::U32,
            "u8" => Kind::U64,
            _ => return None,
        };
        Some((kind, order))
    }

    fn real(&self) -> Result<(Kind, Order)> {
        self.kind().ok_or_else(|| {
            Problem::unsupported(
                format!("an NPY file of numbers of type {:?}", self.descr),
                "save real numbers (float64, float32, integers)",
            )
        })
    }

    /// The numbers in the order of the file.
    fn values(&self) -> Result<Vec<f64>> {
        let (kind, order) = self.real()?;
        let count = self.shape.iter().try_fold(1u64, |n, m| n.checked_mul(*m)).unwrap_or(u64::MAX);
        let count = grid::points(count, 1)?;
        decode(self.data, kind, order, count, "the NPY array")
    }

    fn heights(&self, request: &Request) -> Result<Array2<f64>> {
        let &[nx, ny] = self.shape.as_slice() else {
            let detail = format!("its array has the shape {:?}, not (nx, ny)", self.shape);
            return Err(request.no_heights(detail));
        };
        grid::points(nx, ny)?;
        // In Fortran order x runs fastest.
        if self.fortran_order {
            let (kind, order) = self.real()?;
            return Layout::dense([nx, ny], kind, order).map(self.data, "the NPY array", |v| v);
        }
        Array2::from_shape_vec((nx as usize, ny as usize), self.values()?)
            .map_err(|e| Problem::malformed("the NPY array", e, "nx times ny numbers"))
    }

    /// The text of an array of one string ('<U2': UCS-4, '|S2': bytes).
    fn text(&self) -> Option<String> {
        let wide = |number: fn([u8; 4]) -> u32| {
            let characters = self.data.as_chunks::<4>().0.iter();
            characters.filter_map(|bytes| char::from_u32(number(*bytes))).collect()
        };
        let text: String = match self.descr.get(..2)? {
            "<U" => wide(u32::from_le_bytes),
            ">U" => wide(u32::from_be_bytes),
            "|S" => String::from_utf8_lossy(self.data).into_owned(),
            _ => return None,
        };
        Some(text.trim_matches('\0').to_owned())
    }
}

#[cfg(test)]
mod tests {
    use crate::topography::{Problem, ReadOptions, Topography, TopographyError, read_bytes};

    const UM: f64 = 1e-6;

    /// The 3 x 2 array [[0, 1], [2, 3], [4, 5]] as NumPy writes it.
    fn npy(descr: &str, fortran: bool, data: &[u8]) -> Vec<u8> {
        let order = if fortran { "True" } else { "False" };
        let header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': (3, 2), }}\n");
        let mut file = b"\x93NUMPY\x01\x00".to_vec();
        file.extend((header.len() as u16).to_le_bytes());
        file.extend(header.bytes());
        file.extend(data);
        file
    }

    fn read(file: &[u8]) -> Result<Topography, TopographyError> {
        read_bytes(file, &ReadOptions { size: Some([3.0, 2.0]), height_unit: Some(UM), ..Default::default() })
    }

    #[test]
    fn axis_0_is_x_in_both_orders_and_all_types() {
        let c_order = [0u8, 1, 2, 3, 4, 5];
        let f_order = [0u8, 2, 4, 1, 3, 5];
        let files = [
            npy("<f8", false, &c_order.map(|v| f64::from(v).to_le_bytes()).concat()),
            npy("<f8", true, &f_order.map(|v| f64::from(v).to_le_bytes()).concat()),
            npy(">f4", false, &c_order.map(|v| f32::from(v).to_be_bytes()).concat()),
            npy("<i2", true, &f_order.map(|v| i16::from(v).to_le_bytes()).concat()),
            npy(">u8", false, &c_order.map(|v| u64::from(v).to_be_bytes()).concat()),
            npy("|u1", false, &c_order),
        ];
        for file in files {
            let surface = read(&file).unwrap();
            for ((x, y), h) in surface.heights.indexed_iter() {
                assert_eq!(*h, (2 * x + y) as f64 * UM);
            }
            assert_eq!(surface.size, [3.0, 2.0]);
        }
    }

    #[test]
    fn size_and_unit_are_asked_for_by_name() {
        let file = npy("|u1", false, &[0; 6]);
        let message = |options| read_bytes(&file, &options).unwrap_err().to_string();
        let no_unit = message(ReadOptions { size: Some([1.0, 1.0]), ..Default::default() });
        assert!(no_unit.contains("--height-unit"), "{no_unit}");
        let no_size = message(ReadOptions { height_unit: Some(1.0), ..Default::default() });
        assert!(no_size.contains("--size"), "{no_size}");
    }

    #[test]
    fn what_is_no_map_of_real_numbers_is_refused() {
        let problem = |file: &[u8]| read(file).unwrap_err().problem;
        assert!(matches!(problem(&npy("<c16", false, &[0; 96])), Problem::Unsupported { .. }));
        assert!(matches!(
            problem(&npy("<f8", false, &[0; 47])),
            Problem::Truncated { needed: 48, available: 47, .. }
        ));
        let mut flat = npy("<f8", false, &[0; 48]);
        let at = flat.windows(6).position(|w| w == b"(3, 2)").unwrap();
        flat[at..at + 6].copy_from_slice(b"(6,  )");
        assert!(matches!(problem(&flat), Problem::NoHeights { .. }));
        flat[at..at + 6].copy_from_slice(b"(-3,2)");
        assert!(matches!(problem(&flat), Problem::Malformed { .. }));
    }
}
