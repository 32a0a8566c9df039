//! Separator and decimal mark of a text file, from its numbers.

use memchr::memchr;

use crate::topography::{Problem, Result};

/// The separator between two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    /// Spaces and tabs.
    Blank,
    /// One comma or semicolon; an empty field is undefined.
    Byte(u8),
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dialect {
    pub(super) separator: Separator,
    /// "1,5" is one and a half.
    pub(super) decimal_comma: bool,
}

/// What a line is at first glance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Look {
    Blank,
    Comment,
    Number,
    Letter,
}

/// Looks at the first character of a line.
pub(super) fn first_look(line: &[u8]) -> Look {
    match line.iter().find(|b| !b.is_ascii_whitespace() && **b != 0x1a) {
        None => Look::Blank,
        Some(b'#' | b'%' | b'/') => Look::Comment,
        Some(b'0'..=b'9' | b'+' | b'-' | b'.' | b',' | b';') => Look::Number,
        Some(_) => Look::Letter,
    }
}

/// Whether a line holds numbers and marks of undefined points, and nothing else, in some dialect.
pub(super) fn is_numbers(line: &[u8]) -> bool {
    let (mut numbers, mut marks) = (0, 0);
    for token in line.split(|b| b.is_ascii_whitespace() || matches!(b, b',' | b';')) {
        if token.is_empty() {
        } else if is_number(token) {
            numbers += 1;
        } else if is_undefined(token) || is_infinite(token) {
            marks += 1;
        } else {
            return false;
        }
    }
    numbers > 0 || marks > 1
}

/// Sign, digits with at most one point, exponent.
fn is_number(token: &[u8]) -> bool {
    let token = token.strip_prefix(b"+").or(token.strip_prefix(b"-")).unwrap_or(token);
    let (mantissa, exponent) = match token.iter().position(|b| matches!(b, b'e' | b'E' | b'd' | b'D')) {
        Some(at) => (&token[..at], Some(&token[at + 1..])),
        None => (token, None),
    };
    let digits = |part: &[u8]| !part.is_empty() && part.iter().all(u8::is_ascii_digit);
    let mantissa_holds = mantissa.iter().filter(|b| **b == b'.').count() <= 1
        && mantissa.iter().any(u8::is_ascii_digit)
        && mantissa.iter().all(|b| b.is_ascii_digit() || *b == b'.');
    mantissa_holds
        && exponent.is_none_or(|e| digits(e.strip_prefix(b"+").or(e.strip_prefix(b"-")).unwrap_or(e)))
}

/// Whether a token marks an undefined point.
pub(super) fn is_undefined(token: &[u8]) -> bool {
    let token = token.strip_prefix(b"+").or(token.strip_prefix(b"-")).unwrap_or(token);
    const MARKS: &str = "nan nan(ind) nan(snan) 1.#qnan 1.#nan 1.#ind bad na n/a #n/a null";
    token.is_empty()
        || is_one_of(token, MARKS)
        || (token.len() < 16 && (token.iter().all(|b| *b == b'*') || token.iter().all(|b| *b == b'-')))
}

/// Whether a token is infinite, which no height is.
fn is_infinite(token: &[u8]) -> bool {
    let token = token.strip_prefix(b"+").or(token.strip_prefix(b"-")).unwrap_or(token);
    is_one_of(token, "inf infinity infinite 1.#inf")
}

fn is_one_of(token: &[u8], words: &str) -> bool {
    words.split(' ').any(|word| token.eq_ignore_ascii_case(word.as_bytes()))
}

impl Dialect {
    /// The only dialect in which all blocks of numbers make sense.
    ///
    /// # Errors
    /// Where two dialects do, or none.
    pub(super) fn of<'a>(blocks: impl Iterator<Item = &'a [u8]> + Clone) -> Result<Self> {
        let has = |byte| blocks.clone().any(|b| memchr(byte, b).is_some());
        let mixed = |value: &str| {
            Problem::malformed(
                "the use of commas",
                value,
                "either between numbers or as decimal mark; write numbers with a decimal point, and nothing between thousands",
            )
        };
        let (semicolon, comma, point) = (has(b';'), has(b','), has(b'.'));
        let dialect = |separator, decimal_comma| Ok(Dialect { separator, decimal_comma });
        match (semicolon, comma, point) {
            (true, true, true) => Err(mixed(&match blocks.clone().find_map(grouped) {
                Some(number) => format!("beside decimal points and semicolons, as in {number:?}"),
                None => "beside decimal points and semicolons".to_owned(),
            })),
            (true, decimal_comma, _) => dialect(Separator::Byte(b';'), decimal_comma),
            (false, false, _) => dialect(Separator::Blank, false),
            (false, true, true) => dialect(Separator::Byte(b','), false),
            (false, true, false) => {
                let mut commas = Commas::default();
                blocks.for_each(|block| commas.scan(block));
                if commas.blank_between_numbers {
                    // "1,5 2,5": the numbers are separated by blanks.
                    if commas.beside_blank || commas.twice_in_token {
                        return Err(mixed("both between and inside numbers that are separated by blanks"));
                    }
                    dialect(Separator::Blank, true)
                } else if commas.beside_blank && commas.inside {
                    // "1,5, 2,5": two numbers or four?
                    Err(mixed("with and without blanks beside them"))
                } else {
                    dialect(Separator::Byte(b','), false)
                }
            }
        }
    }
}

/// A number with a comma and a point, as between thousands.
fn grouped(block: &[u8]) -> Option<String> {
    let tokens = block.split(|byte| byte.is_ascii_whitespace() || *byte == b';');
    let mut both = tokens.filter(|token| token.contains(&b',') && token.contains(&b'.'));
    both.next().map(|token| String::from_utf8_lossy(&token[..token.len().min(40)]).into_owned())
}

/// Where the commas of a file without decimal points and semicolons stand.
#[derive(Default)]
struct Commas {
    /// Two tokens are separated by blanks alone.
    blank_between_numbers: bool,
    /// A comma next to a blank (not at the end of a line).
    beside_blank: bool,
    /// A comma between two characters of numbers.
    inside: bool,
    /// Two such commas in one token.
    twice_in_token: bool,
}

impl Commas {
    fn scan(&mut self, block: &[u8]) {
        for line in block.split(|b| matches!(b, b'\n' | b'\r')) {
            let line = line.trim_ascii().strip_suffix(b",").unwrap_or(line.trim_ascii());
            let mut in_token = 0;
            for (at, byte) in line.iter().enumerate() {
                let neighbours = [at.checked_sub(1).map(|before| line[before]), line.get(at + 1).copied()];
                if *byte == b',' {
                    let blank = neighbours.iter().flatten().any(u8::is_ascii_whitespace);
                    self.beside_blank |= blank;
                    self.inside |= !blank;
                    in_token += 1;
                    self.twice_in_token |= in_token > 1;
                } else if byte.is_ascii_whitespace() {
                    in_token = 0;
                    // A run of blanks separates numbers if there is no comma at either end of it.
                    if neighbours[1].is_some_and(|b| !b.is_ascii_whitespace() && b != b',') {
                        let before = line[..at].iter().rev().find(|b| !b.is_ascii_whitespace());
                        self.blank_between_numbers |= before.is_some_and(|b| *b != b',');
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Option<(Separator, bool)> {
        Dialect::of([text.as_bytes()].into_iter()).ok().map(|d| (d.separator, d.decimal_comma))
    }

    #[test]
    fn a_comma_is_what_the_rest_of_the_file_says() {
        let comma = Separator::Byte(b',');
        let semicolon = Separator::Byte(b';');
        for (text, expected) in [
            ("1 2 3\n1.5\t2 3", Some((Separator::Blank, false))),
            ("1 2 3\n1,5 2 3", Some((Separator::Blank, true))),
            ("1,5\t2,5\n1e-3\t2", Some((Separator::Blank, true))),
            ("1,2,3\n4,5,6", Some((comma, false))),
            ("1, 2, 3\n4, 5, 6,", Some((comma, false))),
            ("1.5,2", Some((comma, false))),
            ("1.5, 2", Some((comma, false))),
            ("1;2", Some((semicolon, false))),
            ("1,5; 2,5", Some((semicolon, true))),
            ("1,5, 2,5", None),
            ("1,2,3 4,5,6", None),
            ("1,000.5;2", None),
        ] {
            assert_eq!(of(text), expected, "{text:?}");
        }
    }

    #[test]
    fn headers_are_not_numbers() {
        for line in ["h=305 w=75", "2024-01-05 12:00", "--- data ---", "X;Y;Z", ",,,", "1 mm 2 mm", "e5", "."]
        {
            assert!(!is_numbers(line.as_bytes()), "{line:?}");
        }
        for line in ["1", "-1e-003\t+2.5E6", "1,5;2,5", "NaN nan", "1 *** --", ".5", "5.", "1.5D-3 2", "3;;4"]
        {
            assert!(is_numbers(line.as_bytes()), "{line:?}");
        }
    }
}
