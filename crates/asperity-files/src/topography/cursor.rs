//! A place in the bytes of a file: every read is checked against the end, none allocates.

use super::sample::Order;
use super::text::label;
use super::{Problem, Result};

/// Reads numbers and texts one after the other.
#[derive(Clone, Debug)]
pub(super) struct Cursor<'a> {
    rest: &'a [u8],
    order: Order,
}

macro_rules! number {
    ($name:ident, $number:ty, $doc:literal) => {
        #[doc = $doc]
        pub(super) fn $name(&mut self, what: &str) -> Result<$number> {
            let bytes = self.array(what)?;
            Ok(match self.order {
                Order::Little => <$number>::from_le_bytes(bytes),
                Order::Big => <$number>::from_be_bytes(bytes),
            })
        }
    };
}

impl<'a> Cursor<'a> {
    /// At the start of `bytes`, whose numbers have this byte order.
    pub(super) fn new(bytes: &'a [u8], order: Order) -> Self {
        Cursor { rest: bytes, order }
    }

    /// At a distance from the start of `bytes`.
    pub(super) fn at(bytes: &'a [u8], offset: u64, order: Order, what: &str) -> Result<Self> {
        let rest = usize::try_from(offset).ok().and_then(|at| bytes.get(at..));
        let rest = rest.ok_or_else(|| Problem::truncated(what, offset, bytes.len() as u64))?;
        Ok(Cursor { rest, order })
    }

    /// What has not been read.
    pub(super) fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// The next `count` bytes.
    pub(super) fn bytes(&mut self, count: u64, what: &str) -> Result<&'a [u8]> {
        let split = usize::try_from(count).ok().and_then(|n| self.rest.split_at_checked(n));
        let (bytes, rest) = split.ok_or_else(|| Problem::truncated(what, count, self.rest.len() as u64))?;
        self.rest = rest;
        Ok(bytes)
    }

    fn array<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        let (bytes, rest) = self
            .rest
            .split_first_chunk()
            .ok_or_else(|| Problem::truncated(what, N as u64, self.rest.len() as u64))?;
        self.rest = rest;
        Ok(*bytes)
    }

    /// A text of fixed length, padded by zeros or blanks, in UTF-8 or Latin-1.
    pub(super) fn text(&mut self, length: u64, what: &str) -> Result<String> {
        Ok(text(self.bytes(length, what)?))
    }

    number!(u8, u8, "One byte.");
    number!(u16, u16, "Two bytes without a sign.");
    number!(i16, i16, "Two bytes with a sign.");
    number!(u32, u32, "Four bytes without a sign.");
    number!(i32, i32, "Four bytes with a sign.");
    number!(u64, u64, "Eight bytes without a sign.");
    number!(f32, f32, "IEEE 754 binary32.");
    number!(f64, f64, "IEEE 754 binary64.");
}

/// The text in UTF-16 of this byte order.
pub(super) fn utf16(bytes: &[u8], order: Order) -> String {
    let unit = if order == Order::Little { u16::from_le_bytes } else { u16::from_be_bytes };
    let units: Vec<u16> = bytes.as_chunks().0.iter().map(|bytes| unit(*bytes)).collect();
    String::from_utf16_lossy(&units)
}

/// A text up to its first zero, without surrounding blanks, in UTF-8 or Latin-1.
pub(super) fn text(bytes: &[u8]) -> String {
    let bytes = bytes.split(|b| *b == 0).next().unwrap_or_default();
    label(bytes).trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reading_past_the_end_is_answered() {
        let mut cursor = Cursor::new(&[1, 0, b'a', b'b', 0, 9], Order::Little);
        assert_eq!(cursor.u16("n").ok(), Some(1));
        assert_eq!(cursor.text(3, "t").ok().as_deref(), Some("ab"));
        let truncated = |r: Result<_, _>| matches!(r, Err(Problem::Truncated { available: 1, .. }));
        assert!(truncated(cursor.u32("n").map(drop)) && truncated(cursor.bytes(u64::MAX, "b").map(drop)));
        assert_eq!(cursor.u8("n").ok(), Some(9));
        assert!(Cursor::at(&[0; 4], u64::MAX, Order::Big, "x").is_err());
    }
}
