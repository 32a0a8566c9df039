//! The codes of text files: UTF-8, UTF-16 with or without a byte order mark, and any 8-bit code that extends ASCII.

use std::borrow::Cow;

use crate::topography::cursor::utf16;
use crate::topography::sample::Order;

/// The text with one byte per ASCII character, or `None` where the bytes are binary.
///
/// An 8-bit code passes as it is: numbers are ASCII in all of them, and labels are decoded by [`label`].
pub(super) fn utf8(bytes: &[u8]) -> Option<Cow<'_, [u8]>> {
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => Cow::Owned(utf16(rest, Order::Little).into_bytes()),
        [0xfe, 0xff, rest @ ..] => Cow::Owned(utf16(rest, Order::Big).into_bytes()),
        [0xef, 0xbb, 0xbf, rest @ ..] => Cow::Borrowed(rest),
        _ => match unmarked_utf16(bytes) {
            Some(order) => Cow::Owned(utf16(bytes, order).into_bytes()),
            None => Cow::Borrowed(bytes),
        },
    };
    // Control characters other than tab, line feed, form feed and carriage return are in no text.
    let start = &text[..text.len().min(1 << 16)];
    let binary = start.iter().any(|b| *b < b' ' && !matches!(b, b'\t' | b'\n' | b'\x0c' | b'\r' | b'\x1a'));
    (!binary).then_some(text)
}

/// The order of the bytes of UTF-16 without a byte order mark: of nearly every pair one byte is 0, always the same one, and the
/// other one a character of ASCII. Symbols of units may be neither.
fn unmarked_utf16(bytes: &[u8]) -> Option<Order> {
    let (pairs, _) = bytes[..bytes.len().min(1 << 12)].as_chunks::<2>();
    let ascii = |byte: u8| matches!(byte, b'\t' | b'\n' | b'\r' | b' '..=b'~');
    let is_text = |low: usize| {
        let count = pairs.iter().filter(|pair| ascii(pair[low]) && pair[1 - low] == 0).count();
        pairs.len() > 1 && 10 * count >= 9 * pairs.len()
    };
    [(0, Order::Little), (1, Order::Big)].into_iter().find(|(low, _)| is_text(*low)).map(|(_, order)| order)
}

/// A line or part of it as text: UTF-8, else Latin-1 with the quotation marks and dashes of Windows.
pub(in crate::topography) fn label(bytes: &[u8]) -> String {
    let character = |byte: u8| match byte {
        0x91 => '\u{2018}',
        0x92 => '\u{2019}',
        0x93 => '\u{201c}',
        0x94 => '\u{201d}',
        0x96 => '\u{2013}',
        0x97 => '\u{2014}',
        other => char::from(other),
    };
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|b| character(*b)).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_gives_the_same_text() {
        let text = "# Breite: 1 \u{b5}m\n1 2\n";
        let units = || [0xfeff].into_iter().chain(text.encode_utf16());
        let little: Vec<u8> = units().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = units().flat_map(u16::to_be_bytes).collect();
        let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
        // The last two have lost their byte order mark.
        for bytes in [text.as_bytes(), &little, &big, &latin1, &little[2..], &big[2..]] {
            assert_eq!(label(&utf8(bytes).unwrap()), text);
        }
        for binary in [&b"CDF\x01\0\0"[..], b"\x01\0\x02\0\x03\0", b"1\0\x02\0\x03\0", b"\0\0\0\0"] {
            assert!(utf8(binary).is_none(), "{binary:?}");
        }
    }
}
