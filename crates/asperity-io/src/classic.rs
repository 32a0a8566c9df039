//! The header of classic NetCDF, big-endian: lists of dimensions, attributes and variables, each variable with the offset of its
//! data. (NetCDF classic format specification, Unidata.)

/// Types of the classic format.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Type {
    Byte = 1,
    Char = 2,
    Int = 4,
    Double = 6,
}

impl Type {
    /// Bytes of a number.
    pub(crate) fn size(self) -> u64 {
        match self {
            Type::Byte | Type::Char => 1,
            Type::Int => 4,
            Type::Double => 8,
        }
    }
}

pub(crate) const DIMENSION: u32 = 0x0a;
pub(crate) const VARIABLE: u32 = 0x0b;
pub(crate) const ATTRIBUTE: u32 = 0x0c;
/// Lengths are multiples of four bytes.
pub(crate) fn padded(bytes: u64) -> u64 {
    bytes.next_multiple_of(4)
}

/// What a file says of itself or of a variable.
pub(crate) enum Attribute {
    Text(String),
    Reals(Vec<f64>),
    Counts(Vec<i64>),
}

/// A header that grows.
pub(crate) struct Header {
    pub(crate) bytes: Vec<u8>,
    wide: bool,
}

impl Header {
    /// Of a file with so many records, in the form of 64-bit data or of 64-bit offsets.
    pub(crate) fn new(records: u64, wide: bool) -> Self {
        let mut header = Header { bytes: vec![b'C', b'D', b'F', if wide { 5 } else { 2 }], wide };
        header.size(records);
        header
    }

    pub(crate) fn tag(&mut self, tag: u32) {
        self.bytes.extend(tag.to_be_bytes());
    }

    /// A count or length: 32 bits, 64 in the wide form.
    pub(crate) fn size(&mut self, size: u64) {
        if self.wide {
            self.bytes.extend(size.to_be_bytes());
        } else {
            self.tag(u32::try_from(size).unwrap_or(u32::MAX));
        }
    }

    /// Starts a list.
    pub(crate) fn list(&mut self, tag: u32, length: usize) {
        self.tag(if length == 0 { 0 } else { tag });
        self.size(length as u64);
    }

    pub(crate) fn text(&mut self, text: &str) {
        self.size(text.len() as u64);
        self.padded(text.as_bytes());
    }

    fn padded(&mut self, bytes: &[u8]) {
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
    }

    pub(crate) fn attribute(&mut self, name: &str, attribute: &Attribute) {
        self.text(name);
        let doubles =
            |values: &mut dyn Iterator<Item = f64>| values.flat_map(f64::to_be_bytes).collect::<Vec<u8>>();
        let (kind, length, bytes) = match attribute {
            Attribute::Text(text) => (Type::Char, text.len(), text.as_bytes().to_vec()),
            Attribute::Reals(reals) => (Type::Double, reals.len(), doubles(&mut reals.iter().copied())),
            Attribute::Counts(counts) => {
                let ints: Option<Vec<i32>> = counts.iter().map(|n| i32::try_from(*n).ok()).collect();
                match ints {
                    Some(ints) => {
                        (Type::Int, ints.len(), ints.into_iter().flat_map(i32::to_be_bytes).collect())
                    }
                    None => (Type::Double, counts.len(), doubles(&mut counts.iter().map(|n| *n as f64))),
                }
            }
        };
        self.tag(kind as u32);
        self.size(length as u64);
        self.padded(&bytes);
    }
}
