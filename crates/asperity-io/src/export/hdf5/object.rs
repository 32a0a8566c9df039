//! Object headers of HDF5 (version 2) and the messages in them.
//!
//! Specification: "HDF5 File Format Specification Version 3.0", sections IV.A.1.b (object header) and
//! IV.A.2 (messages).

use super::checksum::lookup3;

/// No address.
pub(super) const UNDEFINED: u64 = u64::MAX;

/// Types of the numbers, texts and references in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Type {
    Float64,
    Int64,
    Int32,
    UInt8,
    /// Text of that many bytes, the last of which is 0.
    Fixed(usize),
    /// UTF-8 text of any length, in a heap.
    Text,
    /// A list of object references, in a heap.
    References,
}

impl Type {
    /// Bytes of one element.
    pub(super) fn size(self) -> usize {
        match self {
            Type::Float64 | Type::Int64 => 8,
            Type::Int32 => 4,
            Type::UInt8 => 1,
            Type::Fixed(length) => length,
            Type::Text | Type::References => 16,
        }
    }

    /// Datatype message: class and version 1, bit field, size, properties.
    fn message(self) -> Vec<u8> {
        let datatype = |class: u8, bits: [u8; 3], size: usize, properties: &[u8]| {
            let mut bytes = vec![0x10 | class];
            bytes.extend(bits);
            bytes.extend((size as u32).to_le_bytes());
            bytes.extend(properties);
            bytes
        };
        // Bit offset and precision, as 16-bit numbers.
        let integer =
            |signed: u8, size: usize| datatype(0, [signed << 3, 0, 0], size, &[0, 0, 8 * size as u8, 0]);
        match self {
            // IEEE 754: implied leading bit, sign at 63, exponent of 11 bits from 52, bias 1023.
            Type::Float64 => {
                let mut properties = vec![0, 0, 64, 0, 52, 11, 0, 52];
                properties.extend(1023u32.to_le_bytes());
                datatype(1, [0x20, 63, 0], 8, &properties)
            }
            Type::Int64 => integer(1, 8),
            Type::Int32 => integer(1, 4),
            Type::UInt8 => integer(0, 1),
            Type::Fixed(length) => datatype(3, [0, 0, 0], length, &[]),
            Type::Text => datatype(9, [1, 1, 0], 16, &integer(0, 1)),
            Type::References => datatype(9, [0, 0, 0], 16, &datatype(7, [0, 0, 0], 8, &[])),
        }
    }
}

/// Dataspace message; no lengths for a single element.
fn dataspace(shape: &[usize]) -> Vec<u8> {
    let mut bytes = vec![2, shape.len() as u8, 0, u8::from(!shape.is_empty())];
    bytes.extend(shape.iter().flat_map(|n| (*n as u64).to_le_bytes()));
    bytes
}

/// An object header under construction.
#[derive(Default)]
pub(super) struct Object {
    messages: Vec<u8>,
}

impl Object {
    fn message(&mut self, kind: u8, body: &[u8]) {
        self.messages.push(kind);
        self.messages.extend((body.len() as u16).to_le_bytes());
        self.messages.push(0);
        self.messages.extend(body);
    }

    /// A data set whose numbers lie at `address` in one piece.
    pub(super) fn data_set(kind: Type, shape: &[usize], address: u64) -> Object {
        let mut object = Object::default();
        let bytes = shape.iter().product::<usize>() as u64 * kind.size() as u64;
        object.message(0x01, &dataspace(shape));
        object.message(0x03, &kind.message());
        // Fill value version 3: space allocated late, written if set by the user, not set.
        object.message(0x05, &[3, 0x0a]);
        // Layout version 3, class 1: contiguous.
        let mut layout = vec![3, 1];
        layout.extend(if bytes == 0 { UNDEFINED } else { address }.to_le_bytes());
        layout.extend(bytes.to_le_bytes());
        object.message(0x08, &layout);
        object
    }

    /// A group whose links are all in its header.
    pub(super) fn group() -> Object {
        let mut object = Object::default();
        let mut info = vec![0, 0];
        info.extend([UNDEFINED.to_le_bytes(); 2].concat());
        object.message(0x02, &info);
        object.message(0x0a, &[0, 0]);
        object
    }

    /// A hard link of a group; names are shorter than 256 bytes.
    pub(super) fn link(&mut self, name: &str, address: u64) {
        let mut body = vec![1, 0, name.len() as u8];
        body.extend(name.as_bytes());
        body.extend(address.to_le_bytes());
        self.message(0x06, &body);
    }

    /// An attribute; the caller keeps its data below 64 KiB.
    pub(super) fn attribute(&mut self, name: &str, kind: Type, shape: &[usize], data: &[u8]) {
        let (datatype, space) = (kind.message(), dataspace(shape));
        let mut body = vec![3, 0];
        for length in [name.len() + 1, datatype.len(), space.len()] {
            body.extend((length as u16).to_le_bytes());
        }
        body.push(1); // the name is UTF-8
        body.extend(name.as_bytes());
        body.push(0);
        body.extend(datatype);
        body.extend(space);
        body.extend(data);
        self.message(0x0c, &body);
    }

    /// A text attribute within the header, as dimension scales are known by.
    pub(super) fn mark(&mut self, name: &str, text: &str) {
        let bytes = [text.as_bytes(), &[0]].concat();
        self.attribute(name, Type::Fixed(bytes.len()), &[], &bytes);
    }

    /// The header as it is in the file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let mut bytes = b"OHDR\x02\x02".to_vec(); // version 2; the length below has four bytes
        bytes.extend((self.messages.len() as u32).to_le_bytes());
        bytes.extend(&self.messages);
        bytes.extend(lookup3(&bytes).to_le_bytes());
        bytes
    }
}

/// A global heap collection: items of any length, each known by its place.
pub(super) struct Heap {
    address: u64,
    items: Vec<u8>,
    count: u32,
}

impl Heap {
    /// An empty heap that will lie at `address`.
    pub(super) fn new(address: u64) -> Heap {
        Heap { address, items: Vec::new(), count: 0 }
    }

    /// Adds an item of `length` elements; returns its place, the datum of [`Type::Text`] and
    /// [`Type::References`].
    pub(super) fn put(&mut self, length: usize, bytes: &[u8]) -> [u8; 16] {
        let mut place = [0; 16];
        if length == 0 {
            return place;
        }
        self.count += 1;
        self.items.extend((self.count as u16).to_le_bytes());
        self.items.extend([0; 6]); // reference count and reserved
        self.items.extend((bytes.len() as u64).to_le_bytes());
        self.items.extend(bytes);
        self.items.resize(self.items.len().next_multiple_of(8), 0);
        place[..4].copy_from_slice(&(length as u32).to_le_bytes());
        place[4..12].copy_from_slice(&self.address.to_le_bytes());
        place[12..].copy_from_slice(&self.count.to_le_bytes());
        place
    }

    /// The heap as it is in the file.
    pub(super) fn bytes(&self) -> Vec<u8> {
        // At least 4096 bytes, of which the rest is free: item 0, its size with its own header.
        let used = 16 + self.items.len();
        let size = (used + 16).max(4096);
        let mut heap = b"GCOL\x01\0\0\0".to_vec();
        heap.extend((size as u64).to_le_bytes());
        heap.extend(&self.items);
        heap.extend([0; 8]);
        heap.extend(((size - used) as u64).to_le_bytes());
        heap.resize(size, 0);
        heap
    }
}

/// Superblock of version 2.
pub(super) fn superblock(end: u64, root: u64) -> Vec<u8> {
    let mut bytes = b"\x89HDF\r\n\x1a\n\x02\x08\x08\x00".to_vec(); // version; bytes of addresses and lengths
    for address in [0, UNDEFINED, end, root] {
        bytes.extend(address.to_le_bytes());
    }
    bytes.extend(lookup3(&bytes).to_le_bytes());
    bytes
}

/// Bytes of [`superblock`].
pub(super) const SUPERBLOCK: u64 = 48;
