//! The codes of text files: UTF-8, UTF-16 with a byte order mark, and any 8-bit code that extends ASCII.

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
        _ => Cow::Borrowed(bytes),
    };
    // Control characters other than tab, line feed, form feed and carriage return are in no text.
    let start = &text[..text.len().min(1 << 16)];
    let binary = start.iter().any(|b| *b < b' ' && !matches!(b, b'\t' | b'\n' | b'\x0c' | b'\r' | b'\x1a'));
    (!binary).then_some(text)
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
        let utf16: Vec<u8> =
            [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect();
        let latin1: Vec<u8> = text.chars().map(|c| c as u8).collect();
        for bytes in [text.as_bytes(), &utf16, &latin1] {
            assert_eq!(label(&utf8(bytes).unwrap()), text);
        }
        assert!(utf8(b"CDF\x01\0\0").is_none());
    }
}
