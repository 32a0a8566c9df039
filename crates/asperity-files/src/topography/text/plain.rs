//! Spellings of whole files that are rewritten before they are read: lines that end in a carriage return alone, numbers between quotes, and
//! the minus sign of typography.

use std::borrow::Cow;

use memchr::{memchr, memmem};

use super::{dialect, encoding};

/// The minus sign U+2212 in UTF-8.
const MINUS: &[u8] = "\u{2212}".as_bytes();

/// The text of a file, its numbers without quotes; `None` where it is binary.
pub(super) fn plain(bytes: &[u8]) -> Option<Cow<'_, [u8]>> {
    let mut text = encoding::utf8(bytes)?;
    if memchr(b'\n', &text).is_none() && memchr(b'\r', &text).is_some() {
        text.to_mut().iter_mut().filter(|byte| **byte == b'\r').for_each(|byte| *byte = b'\n');
    }
    if memmem::find(&text, MINUS).is_some() {
        text = Cow::Owned(without_minus(&text));
    }
    if memchr(b'"', &text).is_some() {
        text = Cow::Owned(unquoted(&text));
    }
    Some(text)
}

fn without_minus(text: &[u8]) -> Vec<u8> {
    let mut plain = Vec::with_capacity(text.len());
    let mut from = 0;
    for at in memmem::find_iter(text, MINUS) {
        plain.extend_from_slice(&text[from..at]);
        plain.push(b'-');
        from = at + MINUS.len();
    }
    plain.extend_from_slice(&text[from..]);
    plain
}

/// The lines of a text whose fields are all numbers, without quotes around them. Where commas stand in the fields too, as decimal marks,
/// semicolons part them.
fn unquoted(text: &[u8]) -> Vec<u8> {
    let lines = || text.split_inclusive(|byte| *byte == b'\n');
    let has_comma = |field: &Vec<u8>| field.contains(&b',');
    let commas = lines().filter_map(fields).any(|(fields, _)| fields.iter().any(has_comma));
    let mut plain = Vec::with_capacity(text.len());
    for line in lines() {
        let Some((fields, separators)) = fields(line) else {
            plain.extend_from_slice(line);
            continue;
        };
        for (n, field) in fields.iter().enumerate() {
            plain.extend_from_slice(field);
            plain.extend(separators.get(n).map(|separator| if commas { b';' } else { *separator }));
        }
        plain.extend(line.ends_with(b"\n").then_some(b'\n'));
    }
    plain
}

/// The fields of a line that holds numbers and nothing else, and the separators between them.
fn fields(line: &[u8]) -> Option<(Vec<Vec<u8>>, Vec<u8>)> {
    let line = line.trim_ascii();
    // Beside semicolons or tabs, commas are decimal marks.
    let mut quoted = false;
    let mut outside = |byte: &u8| {
        quoted ^= *byte == b'"';
        !quoted
    };
    let outer: Vec<u8> = line.iter().copied().filter(|byte| outside(byte)).collect();
    let separator = [b';', b'\t'].into_iter().find(|byte| outer.contains(byte)).unwrap_or(b',');
    let (mut fields, mut separators) = (vec![Vec::new()], Vec::new());
    let mut quoted = false;
    for byte in line {
        match *byte {
            b'"' => quoted = !quoted,
            byte if byte == separator && !quoted => {
                separators.push(byte);
                fields.push(Vec::new());
            }
            other => fields[separators.len()].push(other),
        }
    }
    let is_number = |field: &Vec<u8>| {
        let field = field.trim_ascii();
        dialect::is_numbers(field) || dialect::is_undefined(field)
    };
    let is_empty = fields.iter().all(|field| field.trim_ascii().is_empty());
    (!quoted && !is_empty && fields.iter().all(is_number)).then_some((fields, separators))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_lose_their_quotes_and_names_keep_them() {
        for (text, expected) in [
            ("\"a b\",\"c\"\n\"1.5\",\"2\"\n", "\"a b\",\"c\"\n1.5,2\n"),
            ("\"1,5\",\"-2\"\r\n\"3\",4", "1,5;-2\n3;4"),
            ("\"1,5\";2,5\n3;4\n", "1,5;2,5\n3;4\n"),
            ("1\r2\r", "1\n2\n"),
            ("\u{2212}1 2\n", "-1 2\n"),
            ("\"1;2\n", "\"1;2\n"),
        ] {
            assert_eq!(String::from_utf8_lossy(&plain(text.as_bytes()).unwrap()), expected, "{text:?}");
        }
    }
}
