//! The header of classic NetCDF, big-endian: lists of dimensions, attributes and variables, each variable with the offset of its
//! data. (NetCDF classic format specification, Unidata.)

/// Types of the classic format.
#[derive(Clone, Copy, PartialEq)]
pub enum Type {
    /// 8 bits.
    Byte = 1,
    /// A character of 8 bits.
    Char = 2,
    /// A whole number of 32 bits.
    Int = 4,
    /// A binary64 number.
    Double = 6,
}

impl Type {
    /// Bytes of a number.
    pub fn size(self) -> u64 {
        match self {
            Type::Byte | Type::Char => 1,
            Type::Int => 4,
            Type::Double => 8,
        }
    }
}

const DIMENSION: u32 = 0x0a;
const VARIABLE: u32 = 0x0b;
const ATTRIBUTE: u32 = 0x0c;

/// Lengths are multiples of four bytes.
pub fn padded(bytes: u64) -> u64 {
    bytes.next_multiple_of(4)
}

/// What a file says of itself or of a variable.
#[derive(Clone)]
pub enum Attribute {
    /// Characters.
    Text(String),
    /// Binary64 numbers.
    Reals(Vec<f64>),
    /// Whole numbers; as binary64 where one of them needs more than 32 bits.
    Counts(Vec<i64>),
}

/// A variable of a file.
pub struct Variable<'a> {
    /// Its name.
    pub name: &'a str,
    /// Numbers of its dimensions.
    pub dimensions: Vec<usize>,
    /// What the file says of it.
    pub attributes: Vec<(&'a str, Attribute)>,
    /// Type of its data.
    pub kind: Type,
    /// Bytes of its data, or of those of one record.
    pub bytes: u64,
    /// Whether its data follow in records.
    pub record: bool,
}

/// The header of a file with so many records, in the form of 64-bit data (`wide`) or of 64-bit offsets. The data of the fixed
/// variables follow in their order, then the records; each is [`padded`]. A dimension of length 0 is that of the records.
pub fn header(
    records: usize,
    wide: bool,
    dimensions: &[(&str, usize)],
    attributes: &[(String, Attribute)],
    variables: &[Variable<'_>],
) -> Vec<u8> {
    let with_offsets = |offsets: &[u64]| {
        let mut header = Header { bytes: vec![b'C', b'D', b'F', if wide { 5 } else { 2 }], wide };
        header.size(records as u64);
        header.list(DIMENSION, dimensions.len());
        for (name, length) in dimensions {
            header.text(name);
            header.size(*length as u64);
        }
        header.list(ATTRIBUTE, attributes.len());
        attributes.iter().for_each(|(name, attribute)| header.attribute(name, attribute));
        header.list(VARIABLE, variables.len());
        for (variable, offset) in variables.iter().zip(offsets) {
            header.variable(variable, *offset);
        }
        header.bytes
    };
    // The length of the header does not depend on the offsets in it.
    let mut offsets = vec![0; variables.len()];
    let mut end = with_offsets(&offsets).len() as u64;
    for record in [false, true] {
        for (variable, offset) in variables.iter().zip(&mut offsets).filter(|(v, _)| v.record == record) {
            *offset = end;
            end += padded(variable.bytes);
        }
    }
    with_offsets(&offsets)
}

/// A header that grows.
struct Header {
    bytes: Vec<u8>,
    wide: bool,
}

impl Header {
    fn tag(&mut self, tag: u32) {
        self.bytes.extend(tag.to_be_bytes());
    }

    /// A count or length: 32 bits, 64 in the wide form.
    fn size(&mut self, size: u64) {
        if self.wide {
            self.bytes.extend(size.to_be_bytes());
        } else {
            self.tag(u32::try_from(size).unwrap_or(u32::MAX));
        }
    }

    /// Starts a list.
    fn list(&mut self, tag: u32, length: usize) {
        self.tag(if length == 0 { 0 } else { tag });
        self.size(length as u64);
    }

    fn text(&mut self, text: &str) {
        self.size(text.len() as u64);
        self.padded(text.as_bytes());
    }

    fn padded(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }

    fn attribute(&mut self, name: &str, attribute: &Attribute) {
        self.text(name);
        let (kind, length, bytes) = match attribute {
            Attribute::Text(text) => (Type::Char, text.len(), text.as_bytes().to_vec()),
            Attribute::Reals(reals) => {
                (Type::Double, reals.len(), reals.iter().flat_map(|x| x.to_be_bytes()).collect())
            }
            Attribute::Counts(counts) if counts.iter().all(|n| i32::try_from(*n).is_ok()) => {
                (Type::Int, counts.len(), counts.iter().flat_map(|n| (*n as i32).to_be_bytes()).collect())
            }
            Attribute::Counts(counts) => {
                (Type::Double, counts.len(), counts.iter().flat_map(|n| (*n as f64).to_be_bytes()).collect())
            }
        };
        self.tag(kind as u32);
        self.size(length as u64);
        self.padded(&bytes);
    }

    fn variable(&mut self, variable: &Variable<'_>, offset: u64) {
        self.text(variable.name);
        self.size(variable.dimensions.len() as u64);
        variable.dimensions.iter().for_each(|dimension| self.size(*dimension as u64));
        self.list(ATTRIBUTE, variable.attributes.len());
        variable.attributes.iter().for_each(|(name, attribute)| self.attribute(name, attribute));
        self.tag(variable.kind as u32);
        // A size that 32 bits cannot hold is written as the greatest number, and readers take it from the shape.
        self.size(padded(variable.bytes));
        self.bytes.extend(offset.to_be_bytes());
    }
}
