//! Sheets of .xls files of Excel 5 to 2003: records in the stream `Workbook` or `Book` of a compound document (Microsoft,
//! \[MS-XLS\], versions 5 and 8 of its format, BIFF). Numbers, texts, truth values and results of formulas are read; formatting is
//! ignored.

use super::cells::Cells;
use super::{Book, MOST_CHARACTERS, Named, damaged};
use crate::curve::error::{CurveError, Result, fault};
use crate::topography::compound;

/// Kinds of records (\[MS-XLS\] 2.3).
mod kind {
    pub const FORMULA: u16 = 0x0006;
    pub const END: u16 = 0x000a;
    pub const PASSWORD: u16 = 0x002f;
    pub const CONTINUE: u16 = 0x003c;
    pub const SHEET: u16 = 0x0085;
    pub const SEVERAL_RK: u16 = 0x00bd;
    pub const STRINGS: u16 = 0x00fc;
    pub const FORMATTED_LABEL: u16 = 0x00d6;
    pub const STRING_CELL: u16 = 0x00fd;
    pub const NUMBER: u16 = 0x0203;
    pub const LABEL: u16 = 0x0204;
    pub const TRUTH: u16 = 0x0205;
    pub const FORMULA_STRING: u16 = 0x0207;
    pub const RK: u16 = 0x027e;
    pub const BEGIN: u16 = 0x0809;
}

/// A workbook whose sheets are read one by one.
pub(super) struct Excel {
    stream: Vec<u8>,
    version: Version,
    sheets: Vec<(Named, usize)>,
    strings: Vec<String>,
}

impl Excel {
    pub(super) fn open(bytes: &[u8]) -> Result<Self> {
        let stream_of = |name| {
            compound::stream(bytes, name)
                .map_err(|error| fault(format!("cannot be read as a spreadsheet (.xls): {error}")))
        };
        let stream = match stream_of("Workbook")? {
            Some(stream) => stream,
            None => stream_of("Book")?.ok_or_else(other)?,
        };
        let (mut sheets, mut parts) = (Vec::new(), Vec::new());
        let (mut version, mut last) = (Version::Eight, 0);
        for (kind, data) in records(&stream) {
            match kind {
                kind::BEGIN => version = Version::of(two(data, 0)?)?,
                kind::PASSWORD => {
                    return Err(fault("the spreadsheet is locked by a password; save it without"));
                }
                // Of the kinds of sheets only that of cells.
                kind::SHEET if part(data, 5, 1)? == [0] => {
                    let length = usize::from(part(data, 6, 1)?[0]);
                    let name = version.text(data, 7, length)?;
                    let hidden = part(data, 4, 1)?[0] & 3 != 0;
                    let start = u32::from_le_bytes(array(data, 0)?) as usize;
                    sheets.push((Named { name, hidden }, start));
                }
                kind::STRINGS => parts.push(data),
                kind::CONTINUE if last == kind::STRINGS => parts.push(data),
                kind::END => break,
                _ => {}
            }
            if kind != kind::CONTINUE {
                last = kind;
            }
        }
        let strings = Strings { parts, at: 8 }.read()?;
        Ok(Excel { stream, version, sheets, strings })
    }
}

impl Book for Excel {
    fn sheets(&self) -> Vec<Named> {
        self.sheets.iter().map(|(named, _)| named.clone()).collect()
    }

    fn cells(&mut self, name: &str) -> Result<Cells> {
        let start = self.sheets.iter().find(|(named, _)| named.name == name).map(|(_, start)| *start);
        let stream = start.and_then(|start| self.stream.get(start..)).ok_or_else(damaged)?;
        let mut cells = Cells::default();
        // Charts within the sheet have records of their own, between their begin and their end.
        let mut depth = 0;
        // Where the text goes that a formula gives.
        let mut place = None;
        for (kind, data) in records(stream) {
            match kind {
                kind::BEGIN => depth += 1,
                kind::END => depth -= 1,
                _ => {}
            }
            if depth <= 0 {
                break;
            }
            if depth > 1 {
                continue;
            }
            let at = || Ok::<_, CurveError>((u32::from(two(data, 0)?), u32::from(two(data, 2)?)));
            let mut number = |(row, column), value: f64| cells.push(row, column, &format!("{value:?}"));
            match kind {
                kind::NUMBER => number(at()?, f64::from_le_bytes(array(data, 6)?))?,
                kind::RK => number(at()?, rk(array(data, 6)?))?,
                kind::SEVERAL_RK => {
                    let (row, first) = at()?;
                    // Six bytes a cell, then the last column.
                    for (n, cell) in data[4..].chunks_exact(6).enumerate() {
                        number((row, first + n as u32), rk(array(cell, 2)?))?;
                    }
                }
                kind::FORMULA => match part(data, 6, 8)? {
                    [0, .., 0xff, 0xff] => place = Some(at()?),
                    // A truth value, an error, or nothing.
                    [.., 0xff, 0xff] => {}
                    _ => number(at()?, f64::from_le_bytes(array(data, 6)?))?,
                },
                kind::FORMULA_STRING => {
                    if let Some((row, column)) = place.take() {
                        cells.push(row, column, &self.version.counted(data, 0)?)?;
                    }
                }
                kind::LABEL | kind::FORMATTED_LABEL => {
                    let (row, column) = at()?;
                    cells.push(row, column, &self.version.counted(data, 6)?)?;
                }
                kind::STRING_CELL => {
                    let (row, column) = at()?;
                    let index = u32::from_le_bytes(array(data, 6)?) as usize;
                    cells.push(row, column, self.strings.get(index).ok_or_else(damaged)?)?;
                }
                kind::TRUTH if part(data, 7, 1)? == [0] => {
                    let (row, column) = at()?;
                    cells.push(row, column, if part(data, 6, 1)? == [0] { "false" } else { "true" })?;
                }
                _ => {}
            }
        }
        Ok(cells)
    }
}

/// How texts are written.
#[derive(Clone, Copy)]
enum Version {
    /// Excel 5 and 95: one byte a character.
    Five,
    /// Excel 97 to 2003: a byte of flags, then one or two bytes a character.
    Eight,
}

impl Version {
    fn of(number: u16) -> Result<Version> {
        match number {
            0x0500 => Ok(Version::Five),
            0x0600 => Ok(Version::Eight),
            _ => Err(other()),
        }
    }

    /// The text of so many characters.
    fn text(self, data: &[u8], at: usize, length: usize) -> Result<String> {
        match self {
            Version::Five => Ok(text(part(data, at, length)?, false)),
            Version::Eight => {
                let wide = part(data, at, 1)?[0] & 1 == 1;
                Ok(text(part(data, at + 1, length << u8::from(wide))?, wide))
            }
        }
    }

    /// A text after the two bytes of its length.
    fn counted(self, data: &[u8], at: usize) -> Result<String> {
        self.text(data, at + 2, usize::from(two(data, at)?))
    }
}

fn other() -> CurveError {
    fault("is no spreadsheet of Excel 5 to 2003 (.xls); save it again as .xlsx or text (csv)")
}

/// The records of a stream: two bytes of kind, two of length, the data.
fn records(mut stream: &[u8]) -> impl Iterator<Item = (u16, &[u8])> {
    std::iter::from_fn(move || {
        let (kind, length) = (two(stream, 0).ok()?, usize::from(two(stream, 2).ok()?));
        let data = part(stream, 4, length).ok()?;
        stream = &stream[4 + length..];
        Some((kind, data))
    })
}

fn part(data: &[u8], at: usize, length: usize) -> Result<&[u8]> {
    data.get(at..).and_then(|rest| rest.get(..length)).ok_or_else(damaged)
}

fn array<const N: usize>(data: &[u8], at: usize) -> Result<[u8; N]> {
    part(data, at, N)?.try_into().map_err(|_| damaged())
}

fn two(data: &[u8], at: usize) -> Result<u16> {
    Ok(u16::from_le_bytes(array(data, at)?))
}

/// A number in four bytes (\[MS-XLS\] 2.5.217): the upper half of a double or an integer, times 1 or 1/100.
fn rk(bytes: [u8; 4]) -> f64 {
    let word = u32::from_le_bytes(bytes);
    let value = match word & 2 {
        0 => f64::from_bits(u64::from(word & !3) << 32),
        _ => f64::from(word.cast_signed() >> 2),
    };
    if word & 1 == 1 { value / 100.0 } else { value }
}

/// The first characters of a text in Latin-1, or in UTF-16 where it is wide.
fn text(bytes: &[u8], wide: bool) -> String {
    match wide {
        false => bytes.iter().take(MOST_CHARACTERS).map(|byte| char::from(*byte)).collect(),
        true => {
            let units = bytes.as_chunks().0.iter().take(MOST_CHARACTERS).map(|two| u16::from_le_bytes(*two));
            String::from_utf16_lossy(&units.collect::<Vec<u16>>())
        }
    }
}

/// The table of shared texts (\[MS-XLS\] 2.4.265), which goes on in further records.
struct Strings<'a> {
    parts: Vec<&'a [u8]>,
    /// Place in the first of the parts that are left.
    at: usize,
}

impl<'a> Strings<'a> {
    fn read(mut self) -> Result<Vec<String>> {
        self.parts.reverse();
        let mut strings = Vec::new();
        while self.rest().is_some() {
            strings.push(self.one()?);
        }
        Ok(strings)
    }

    /// The rest of the current part, or the next part if nothing is left.
    fn rest(&mut self) -> Option<&'a [u8]> {
        while let Some(rest) = self.parts.last().map(|part| part.get(self.at..).unwrap_or_default()) {
            if !rest.is_empty() {
                return Some(rest);
            }
            self.parts.pop();
            self.at = 0;
        }
        None
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let bytes = array(self.rest().unwrap_or_default(), 0)?;
        self.at += N;
        Ok(bytes)
    }

    /// A text with its formats (four bytes each) and phonetic signs (\[MS-XLS\] 2.5.293).
    fn one(&mut self) -> Result<String> {
        let mut left = usize::from(u16::from_le_bytes(self.take()?));
        let [flags] = self.take()?;
        let formats = if flags & 8 == 0 { 0 } else { 4 * usize::from(u16::from_le_bytes(self.take()?)) };
        let signs = if flags & 4 == 0 { 0 } else { u32::from_le_bytes(self.take()?) as usize };
        let mut wide = flags & 1 == 1;
        let mut found = String::new();
        while left > 0 {
            let before = self.parts.len();
            let rest = self.rest().ok_or_else(damaged)?;
            if self.parts.len() < before {
                // Each further part states its own width of characters.
                wide = self.take::<1>()?[0] & 1 == 1;
                continue;
            }
            let count = left.min(rest.len() >> u8::from(wide)).max(1);
            let bytes = part(rest, 0, count << u8::from(wide))?;
            if found.len() < MOST_CHARACTERS {
                found += &text(bytes, wide);
            }
            (left, self.at) = (left - count, self.at + bytes.len());
        }
        self.skip(formats + signs)?;
        Ok(found)
    }

    fn skip(&mut self, mut bytes: usize) -> Result<()> {
        while bytes > 0 {
            let step = self.rest().ok_or_else(damaged)?.len().min(bytes);
            (bytes, self.at) = (bytes - step, self.at + step);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Write};

    use super::*;

    fn record(kind: u16, data: &[u8]) -> Vec<u8> {
        [&kind.to_le_bytes()[..], &(data.len() as u16).to_le_bytes(), data].concat()
    }

    fn at(row: u16, column: u16, rest: &[u8]) -> Vec<u8> {
        // The two bytes between are the number of a format.
        [&row.to_le_bytes()[..], &column.to_le_bytes(), &[0, 0], rest].concat()
    }

    /// A compound document with a workbook of one sheet "S", hidden, with these cells.
    fn document(version: u16, head: &[Vec<u8>], cells: &[Vec<u8>]) -> Vec<u8> {
        let begin = record(kind::BEGIN, &version.to_le_bytes());
        let end = record(kind::END, &[]);
        let (stream, name): (_, &[u8]) = match version {
            0x0500 => ("/Book", b"S"),
            _ => ("/Workbook", b"\0S"),
        };
        let sheet = |start: u32| record(kind::SHEET, &[&start.to_le_bytes()[..], &[1, 0, 1], name].concat());
        let start = [&begin[..], &sheet(0), &head.concat(), &end].concat().len() as u32;
        let parts = [&begin[..], &sheet(start), &head.concat(), &end, &begin, &cells.concat(), &end];
        let mut file =
            cfb::CompoundFile::create_with_version(cfb::Version::V3, Cursor::new(Vec::new())).unwrap();
        file.create_stream(stream).unwrap().write_all(&parts.concat()).unwrap();
        file.into_inner().into_inner()
    }

    fn rows(bytes: &[u8]) -> Result<super::super::Rows, CurveError> {
        let mut book = Excel::open(bytes)?;
        assert!(book.sheets()[0].name == "S" && book.sheets()[0].hidden);
        book.cells("S")?.rows(&mut 1000)
    }

    #[test]
    fn each_kind_of_cell_is_read() {
        // "f" in Latin-1; "°C µm" in two bytes a character, with one format, cut after "°" and continued in Latin-1.
        let strings = [&[2, 0, 0, 0, 2, 0, 0, 0][..], &[1, 0, 0, b'f'], &[5, 0, 9, 1, 0, 0xb0, 0]];
        let head = [
            record(kind::STRINGS, &strings.concat()),
            record(kind::CONTINUE, &[&[0, b'C', b' ', 0xb5, b'm'][..], &[0; 4]].concat()),
        ];
        let half = 0.5_f64.to_le_bytes();
        let of_text = [0, 0, 0, 0, 0, 0, 0xff, 0xff];
        let chart =
            [record(kind::BEGIN, &[0, 6]), record(kind::NUMBER, &at(9, 9, &half)), record(kind::END, &[])];
        let cells = [
            record(kind::STRING_CELL, &at(0, 1, &[0, 0, 0, 0])),
            record(kind::STRING_CELL, &at(0, 2, &[1, 0, 0, 0])),
            record(kind::NUMBER, &at(1, 1, &half)),
            // -300 as an integer times 1/100; 3.0 as the upper half of a double.
            record(
                kind::SEVERAL_RK,
                &[
                    &at(1, 2, &((-300_i32 << 2) as u32 | 3).to_le_bytes())[..],
                    &[0, 0, 0, 0, 8, 0x40],
                    &[3, 0],
                ]
                .concat(),
            ),
            chart.concat(),
            record(kind::FORMULA, &at(2, 1, &[&half[..], &[0; 6]].concat())),
            record(kind::FORMULA, &at(2, 2, &[&of_text[..], &[0; 6]].concat())),
            record(kind::FORMULA_STRING, &[2, 0, 0, b'o', b'k']),
            record(kind::TRUTH, &at(2, 3, &[1, 0])),
            record(kind::LABEL, &at(2, 4, &[1, 0, 1, 0xb1, 0x03])),
        ];
        let text = |row: &[&str]| row.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>();
        assert_eq!(
            rows(&document(0x0600, &head, &cells)).unwrap(),
            [
                text(&["f", "°C µm", "", ""]),
                text(&["0.5", "-3.0", "3.0", ""]),
                text(&["0.5", "ok", "true", "α"])
            ]
        );
        let old = [
            record(kind::LABEL, &at(0, 0, &[2, 0, 0xb0, b'C'])),
            record(kind::RK, &at(1, 0, &[4 * 7 + 2, 0, 0, 0])),
        ];
        assert_eq!(rows(&document(0x0500, &[], &old)).unwrap(), [text(&["°C"]), text(&["7.0"])]);
        assert!(
            rows(&document(0x0400, &[], &old)).is_err_and(|fault| fault.message.contains("Excel 5 to 2003"))
        );
    }

    #[test]
    fn damage_is_refused_without_harm() {
        let strings = record(kind::STRINGS, &[&[0; 8][..], &[3, 0, 0, b'a', b'b', b'c']].concat());
        let cells = [record(kind::STRING_CELL, &at(0, 0, &[0; 4])), record(kind::NUMBER, &at(5, 7, &[0; 8]))];
        let whole = document(0x0600, &[strings], &cells);
        assert!(rows(&whole).is_ok());
        for place in (0..whole.len()).step_by(3) {
            let mut changed = whole.clone();
            changed[place] ^= 0xff;
            let _ = Excel::open(&changed).map(|mut book| book.cells("S").map(|cells| cells.rows(&mut 1000)));
        }
        // In the table of sectors, whose place the header tells, the first one follows each.
        let mut looped = whole;
        let table = 512 * (1 + u32::from_le_bytes(array(&looped, 76).unwrap()) as usize);
        looped[table..table + 512].fill(0);
        assert!(Excel::open(&looped).is_err());
    }
}
