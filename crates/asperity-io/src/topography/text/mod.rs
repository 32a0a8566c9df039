//! Text: a matrix (one line per y, values along x) or points (x, y, height), with or without a header.
//!
//! The file is a run of lines that hold only numbers (a block) between lines that do not (headers). Separator and
//! decimal mark are found from the whole of the file, so "1,5 2,5" and "1,5,2,5" are told apart; where both readings
//! are possible the file is refused.

mod dialect;
mod encoding;
mod header;
mod labels;
mod matrix;
mod parse;
mod xyz;

use std::borrow::Cow;

use memchr::memchr;

use dialect::{Dialect, Separator};
use header::Header;

use super::{Format, Problem};

pub(super) use matrix::read_matrix;
pub(super) use parse::numbers;
pub(super) use xyz::read_xyz;

/// One block of numbers and what the lines before it say.
struct Block<'a> {
    header: Header,
    /// The lines of numbers.
    data: &'a [u8],
    /// Line of the file where they start, from 1.
    line: usize,
}

/// A text file taken apart.
struct Text<'a> {
    dialect: Dialect,
    blocks: Vec<Block<'a>>,
}

/// Whether the bytes are text with a block of numbers, and which.
pub(super) fn detect(bytes: &[u8]) -> Option<Format> {
    // Enough for any header; a line of numbers that is cut off at the end is left away.
    const PREFIX: usize = 1 << 20;
    let mut prefix = &bytes[..bytes.len().min(PREFIX)];
    if bytes.len() > PREFIX {
        prefix = &prefix[..prefix.iter().rposition(|b| *b == b'\n').map_or(PREFIX, |end| end + 1)];
    }
    let text = encoding::utf8(prefix)?;
    let text = Text::split(&text).ok()?;
    let block = text.blocks.first()?;
    let columns = parse::columns(text.dialect, block.data);
    let named = xyz::named_columns(&block.header.columns).is_some() && block.header.columns.len() == columns;
    Some(if (columns == 3 && !block.header.says_matrix()) || (columns > 3 && named) {
        Format::Xyz
    } else if matches!(text.dialect.separator, Separator::Byte(b',' | b';')) {
        Format::Csv
    } else {
        Format::Text
    })
}

/// The bytes as UTF-8 (or as an 8-bit code, which only concerns the header).
fn decode(bytes: &[u8]) -> Result<Cow<'_, [u8]>, Problem> {
    encoding::utf8(bytes).ok_or_else(|| {
        Problem::malformed(
            "the file",
            "binary",
            "text; leave the format away to have it found from the content",
        )
    })
}

impl<'a> Text<'a> {
    fn split(bytes: &'a [u8]) -> Result<Self, Problem> {
        let mut blocks: Vec<Block> = Vec::new();
        let mut header = Header::default();
        // Byte range and first line of the block that is being collected.
        let mut open: Option<(usize, usize)> = None;
        let mut at = 0;
        let mut number = 0;
        while at < bytes.len() {
            number += 1;
            let end = memchr(b'\n', &bytes[at..]).map_or(bytes.len(), |n| at + n + 1);
            let line = &bytes[at..end];
            let is_data = match dialect::first_look(line) {
                dialect::Look::Blank => None,
                dialect::Look::Number => Some(open.is_some() || dialect::is_numbers(line)),
                dialect::Look::Letter => Some(dialect::is_numbers(line)),
                dialect::Look::Comment => Some(false),
            };
            match (is_data, open) {
                (Some(true), None) => open = Some((at, number)),
                (Some(false), _) => {
                    if let Some((start, line)) = open.take() {
                        blocks.push(Block { header: header.clone(), data: &bytes[start..at], line });
                        header.next_block();
                    }
                    header.line(line);
                }
                _ => {}
            }
            at = end;
        }
        match open {
            Some((start, line)) => blocks.push(Block { header, data: &bytes[start..], line }),
            // What follows the last numbers is said about them.
            None => {
                if let Some(last) = blocks.last_mut() {
                    last.header = header;
                }
            }
        }
        let dialect = Dialect::of(blocks.iter().map(|b| b.data))?;
        Ok(Text { dialect, blocks })
    }
}
