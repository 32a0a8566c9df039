//! Text: a matrix (one line per y, values along x) or points (x, y, height), with or without a header.
//!
//! The file is a run of lines that hold only numbers (a block) between lines that do not (headers). Separator and
//! decimal mark are found from the whole file, so that "1,5 2,5" and "1,5,2,5" are distinguished; if both readings are possible,
//! the file is refused.

mod dialect;
mod encoding;
mod header;
mod labels;
mod matrix;
mod parse;
mod plain;
mod profile;
mod xyz;

use std::borrow::Cow;

use memchr::memchr;

use dialect::{Dialect, Separator};
use header::Header;

use super::{Format, Problem, Reader, Result, foreign, write};

pub(super) use encoding::label;
pub(crate) use header::leading_number;
pub(super) use parse::numbers;
pub(super) use profile::{is_profile, read_columns};

pub(super) const XYZ: Reader = Reader::new("xyz", |bytes| detect(bytes) == Some(Format::Xyz), xyz::read);

pub(super) const CSV: Reader = Reader::new("csv", |bytes| detect(bytes) == Some(Format::Csv), matrix::read);

pub(super) const TEXT: Reader = Reader::new("asc", |bytes| detect(bytes) == Some(Format::Text), matrix::read)
    .also_called(&["text", "txt", "matrix"])
    .written_by(write::text::encode);

/// One block of numbers and what the lines before it say.
struct Block<'a> {
    header: Header,
    /// The lines of numbers.
    data: &'a [u8],
    /// Line of the file where they start, from 1.
    line: usize,
    /// Number of the metadata that stand before the block or, for the last block, also after it.
    metadata: usize,
}

/// A text file split into headers and blocks of numbers.
struct Text<'a> {
    dialect: Dialect,
    blocks: Vec<Block<'a>>,
    /// Keys and values of the header lines, as far as they are kept.
    metadata: Vec<(String, String)>,
}

/// Most header lines that are kept as metadata.
const MOST_METADATA: usize = 200;
/// Most lines without numbers, and most blocks: files with more are another kind of text.
const MOST_HEADER_LINES: usize = 10_000;
const MOST_BLOCKS: usize = 1000;

/// A text file of any code as text; `None` where it is binary.
pub(crate) fn to_text(bytes: &[u8]) -> Option<String> {
    encoding::utf8(bytes).map(|text| encoding::label(&text))
}

/// Whether a line holds numbers and marks of undefined points only.
pub(crate) fn is_numbers(line: &str) -> bool {
    dialect::is_numbers(line.as_bytes())
}

/// What separates the numbers of all lines (`None`: blanks), and whether commas are decimal marks.
///
/// # Errors
/// Where the lines make sense in two ways, or in none.
pub(crate) fn dialect<'a>(lines: impl Iterator<Item = &'a str> + Clone) -> Result<(Option<char>, bool)> {
    let dialect = Dialect::of(lines.map(str::as_bytes))?;
    let separator = match dialect.separator {
        Separator::Blank => None,
        Separator::Byte(byte) => Some(char::from(byte)),
    };
    Ok((separator, dialect.decimal_comma))
}

/// Whether the bytes are text with a block of numbers, and which.
fn detect(bytes: &[u8]) -> Option<Format> {
    // Enough for any header; a line of numbers that is cut off at the end is ignored.
    const PREFIX: usize = 1 << 20;
    let mut prefix = &bytes[..bytes.len().min(PREFIX)];
    if bytes.len() > PREFIX {
        prefix = &prefix[..prefix.iter().rposition(|b| *b == b'\n').map_or(PREFIX, |end| end + 1)];
    }
    let text = plain::plain(prefix)?;
    // Text whose numbers are ambiguous is still text: the error when it is read gives the reason.
    let Ok(text) = Text::split(&text) else { return Some(Format::Text) };
    let block = text.blocks.first()?;
    let columns = parse::columns(text.dialect, block.data);
    let names = block.header.columns();
    let named = xyz::named_columns(&names).is_some() && names.len() == columns;
    Some(if (columns == 3 && !block.header.says_matrix()) || (columns > 3 && named) {
        Format::Xyz
    } else if matches!(text.dialect.separator, Separator::Byte(b',' | b';')) {
        Format::Csv
    } else {
        Format::Text
    })
}

/// The bytes as UTF-8 (or as an 8-bit code, which only concerns the header).
fn decode(bytes: &[u8]) -> Result<Cow<'_, [u8]>> {
    plain::plain(bytes).ok_or_else(|| {
        Problem::malformed("the file", "binary", "text; omit the format to have it detected from the content")
    })
}

impl<'a> Text<'a> {
    fn split(bytes: &'a [u8]) -> Result<Self> {
        foreign::refuse_texts(bytes)?;
        let mut blocks: Vec<Block> = Vec::new();
        let mut header = Header::default();
        let (mut metadata, mut header_lines) = (Vec::new(), 0);
        let another_text = |what: &str| {
            Problem::malformed(what, "too large", "that of a matrix or a list of points with a header")
        };
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
                        if blocks.len() == MOST_BLOCKS {
                            return Err(another_text("the number of blocks of numbers"));
                        }
                        let (data, metadata) = (&bytes[start..at], metadata.len());
                        blocks.push(Block { header: header.clone(), data, line, metadata });
                        header.next_block();
                    }
                    header_lines += 1;
                    if header_lines > MOST_HEADER_LINES {
                        return Err(another_text("the number of lines without numbers"));
                    }
                    let entry = header.line(line);
                    metadata.extend(entry.filter(|_| metadata.len() < MOST_METADATA));
                }
                _ => {}
            }
            at = end;
        }
        match open {
            Some((start, line)) => {
                let (data, metadata) = (&bytes[start..], metadata.len());
                blocks.push(Block { header, data, line, metadata });
            }
            // Lines after the last numbers describe the last block.
            None => {
                if let Some(last) = blocks.last_mut() {
                    // They do not name its columns.
                    header.keep_names_of(&mut last.header);
                    (last.header, last.metadata) = (header, metadata.len());
                }
            }
        }
        let dialect = Dialect::of(blocks.iter().map(|b| b.data))?;
        Ok(Text { dialect, blocks, metadata })
    }

    /// What the header says beside sizes and units.
    fn metadata(&self, block: &Block) -> Vec<(String, String)> {
        self.metadata[..block.metadata].to_vec()
    }
}
