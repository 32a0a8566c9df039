//! Compound documents (OLE), which hold files ("streams") inside one file.
//!
//! The file is cut into sectors of 512 or 4096 bytes. A table says which sector follows each one; the directory is a
//! chain of sectors with entries of 128 bytes (name, first sector, length). (Microsoft, "\[MS-CFB\]: compound file binary
//! file format".) Streams below 4096 bytes lie in a stream of their own, which is not read here.

use super::Problem;
use super::cursor::Cursor;
use super::sample::Order;

const SIGNATURE: &[u8] = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1";
/// Values of the table from here on are no sectors: free, or the end of a chain.
const LAST_SECTOR: u32 = 0xffff_fffa;
const STREAM: u8 = 2;
const LEAST_STREAM: u64 = 4096;
const WHAT: &str = "the compound document";

/// Whether the bytes are a compound document.
pub(super) fn is_compound(bytes: &[u8]) -> bool {
    bytes.starts_with(SIGNATURE)
}

/// A compound document.
pub(super) struct Compound<'a> {
    bytes: &'a [u8],
    /// Bytes of a sector.
    sector: u64,
    /// The sector that follows each one.
    next: Vec<u32>,
    directory: u32,
}

impl<'a> Compound<'a> {
    /// Reads the table of sectors.
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self, Problem> {
        let at = |offset: u64| Cursor::at(bytes, offset, Order::Little, WHAT);
        let shift = at(30)?.u16(WHAT)?;
        if !matches!(shift, 9 | 12) {
            return Err(Problem::malformed(
                "the size of the sectors",
                format!("2^{shift}"),
                "2^9 or 2^12 bytes",
            ));
        }
        let directory = at(48)?.u32(WHAT)?;
        let mut compound = Compound { bytes, sector: 1 << shift, next: Vec::new(), directory };
        // The sectors of the table: 109 in the header, the others in a chain of sectors.
        let sectors = (bytes.len() as u64 / compound.sector) as usize;
        let mut list = at(76)?.bytes(4 * 109, WHAT)?;
        let mut more = at(68)?.u32(WHAT)?;
        for _ in 0..=sectors {
            let numbers = list.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b));
            for sector in numbers.filter(|n| *n < LAST_SECTOR) {
                // No more than the sectors of the file, however often one is listed.
                if compound.next.len() < sectors {
                    let table = compound.sector(sector)?.as_chunks::<4>().0;
                    compound.next.extend(table.iter().map(|b| u32::from_le_bytes(*b)));
                }
            }
            if more >= LAST_SECTOR || compound.next.len() >= sectors {
                break;
            }
            let (numbers, last) = compound.sector(more)?.split_at(compound.sector as usize - 4);
            (list, more) = (numbers, Cursor::new(last, Order::Little).u32(WHAT)?);
        }
        Ok(compound)
    }

    /// The stream of this name, where there is one.
    pub(super) fn stream(&self, name: &str) -> Result<Option<Vec<u8>>, Problem> {
        let wanted: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let mut sector = self.directory;
        for _ in 0..self.next.len() {
            for entry in self.sector(sector)?.as_chunks::<128>().0 {
                let [name, rest] = [&entry[..64], &entry[64..]];
                let mut c = Cursor::new(rest, Order::Little);
                let (length, kind) = (c.u16(WHAT)?, c.u8(WHAT)?);
                let stated = usize::from(length).saturating_sub(2);
                if kind == STREAM && name.get(..stated) == Some(wanted.as_slice()) {
                    let mut c = Cursor::at(rest, 52, Order::Little, WHAT)?;
                    let (first, length) = (c.u32(WHAT)?, c.u64(WHAT)?);
                    // The upper half has no meaning in documents with small sectors.
                    let length = if self.sector == 512 { length & 0xffff_ffff } else { length };
                    return self.chain(first, length).map(Some);
                }
            }
            sector = self.after(sector)?;
            if sector >= LAST_SECTOR {
                break;
            }
        }
        Ok(None)
    }

    fn chain(&self, first: u32, length: u64) -> Result<Vec<u8>, Problem> {
        let available = self.bytes.len() as u64;
        if length > available {
            return Err(Problem::truncated("a stream of the compound document", length, available));
        }
        if length < LEAST_STREAM {
            return Err(Problem::malformed("the length of the stream", length, "at least 4096 bytes"));
        }
        let length = length as usize;
        let mut stream = Vec::with_capacity(length);
        let mut sector = first;
        loop {
            let part = self.sector(sector)?;
            stream.extend_from_slice(&part[..part.len().min(length - stream.len())]);
            if stream.len() == length {
                return Ok(stream);
            }
            sector = self.after(sector)?;
        }
    }

    fn after(&self, sector: u32) -> Result<u32, Problem> {
        let next = self.next.get(sector as usize).copied();
        next.ok_or_else(|| {
            Problem::malformed("a chain of the compound document", sector, "a sector of the file")
        })
    }

    fn sector(&self, number: u32) -> Result<&'a [u8], Problem> {
        let offset = (u64::from(number) + 1) * self.sector;
        Cursor::at(self.bytes, offset, Order::Little, WHAT)?
            .bytes(self.sector, "a sector of the compound document")
    }
}
