//! Messages on stderr. A message is never worth a result: where it cannot be written (a closed terminal, a full disk), it is
//! dropped.
//!
//! Titles, names and lines of files may hold control characters, which would move the cursor, change colours of a terminal or
//! turn the order of its letters. They are shown as escapes.

use std::borrow::Cow;
use std::fmt::Arguments;
use std::io::Write;

/// Writes a line on stderr.
macro_rules! message {
    ($($text:tt)*) => { $crate::messages::line(format_args!($($text)*)) };
}
pub(crate) use message;

/// See [`message`].
pub fn line(text: Arguments<'_>) {
    write(&format!("{}\n", printable(&text.to_string())));
}

/// Writes a text on stderr as it is, colours and all.
pub fn write(text: &str) {
    // Nobody can be told that nobody listens.
    let _ = std::io::stderr().write_all(text.as_bytes());
}

/// Whether a terminal would act on a character: control characters except line feed and tab, and marks of the direction of text.
pub fn hidden(c: char) -> bool {
    let turns =
        matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    turns || c.is_control() && c != '\n' && c != '\t'
}

/// A text whose [`hidden`] characters are written as escapes, in the form of JSON, so that JSON stays JSON.
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        if hidden(c) {
            shown += &format!("\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_shown_as_escapes() {
        assert_eq!(printable("a\tb\n10 µm"), "a\tb\n10 µm");
        assert_eq!(printable("a\u{1b}[2Jb\rc\u{9b}"), "a\\u001b[2Jb\\u000dc\\u009b");
        assert_eq!(printable("a\u{202e}b\u{200f}c\u{2069}"), "a\\u202eb\\u200fc\\u2069");
    }
}
