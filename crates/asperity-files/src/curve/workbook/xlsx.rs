//! Sheets of .xlsx files: XML in a zip archive (ECMA-376, Office Open XML, SpreadsheetML). Numbers, texts, truth values and
//! stored results of formulas are read; formatting is ignored.

use std::collections::HashMap;
use std::io::{Cursor, Read};

use quick_xml::XmlVersion;
use quick_xml::events::BytesStart;
use zip::ZipArchive;

use super::cells::Cells;
use super::{Book, MOST_CHARACTERS, Named, damaged};
use crate::curve::error::{Result, fault};
use crate::xml::{self, Piece};

/// Most bytes that are unpacked: far above what a table of measurements needs.
const MOST_UNPACKED: u64 = 128 << 20;
/// Most rows and columns of a sheet, by the format.
const MOST_PLACES: [u32; 2] = [1 << 20, 1 << 14];

/// A workbook whose sheets are read one by one.
pub(super) struct OfficeOpen<'a> {
    parts: Parts<'a>,
    sheets: Vec<(Named, String)>,
    strings: Vec<String>,
}

impl<'a> OfficeOpen<'a> {
    pub(super) fn open(bytes: &'a [u8]) -> Result<Self> {
        let zip = ZipArchive::new(Cursor::new(bytes)).map_err(|_| damaged())?;
        let mut parts = Parts { zip, left: MOST_UNPACKED };
        let root = parts.relations("_rels/.rels", "")?;
        let workbook = root.into_iter().find(|relation| relation.kind.ends_with("/officeDocument"));
        let workbook = workbook.map_or("xl/workbook.xml".to_owned(), |relation| relation.target);
        let Some(xml) = parts.text(&workbook)? else {
            return Err(fault(
                "is no spreadsheet of a kind that is read (.xls, .xlsx); save it as .xlsx or text (csv)",
            ));
        };
        let (folder, name) = workbook.rsplit_once('/').unwrap_or(("", &workbook));
        let relations = parts.relations(&format!("{folder}/_rels/{name}.rels"), folder)?;
        let paths: HashMap<&str, &str> =
            relations.iter().map(|relation| (relation.id.as_str(), relation.target.as_str())).collect();
        let mut sheets = Vec::new();
        walk(&xml, |piece| {
            if let Piece::Open("sheet", element) = piece
                && let [Some(name), state, Some(id)] = attributes(element, ["name", "state", "id"])?
                && let Some(path) = paths.get(id.as_str())
            {
                let hidden = state.is_some_and(|state| state != "visible");
                sheets.push((Named { name, hidden }, (*path).to_owned()));
            }
            Ok(())
        })?;
        let strings = match relations.iter().find(|relation| relation.kind.ends_with("/sharedStrings")) {
            Some(relation) => strings(&parts.text(&relation.target)?.unwrap_or_default())?,
            None => Vec::new(),
        };
        Ok(OfficeOpen { parts, sheets, strings })
    }
}

impl Book for OfficeOpen<'_> {
    fn sheets(&self) -> Vec<Named> {
        self.sheets.iter().map(|(named, _)| named.clone()).collect()
    }

    fn cells(&mut self, name: &str) -> Result<Cells> {
        let path = self.sheets.iter().find(|(named, _)| named.name == name).map(|(_, path)| path);
        // A sheet of a chart has no cells.
        let xml = self.parts.text(path.ok_or_else(damaged)?)?.unwrap_or_default();
        let mut cells = Cells::default();
        // Row and column of the cell, which may not say them.
        let (mut row, mut column) = (0, 0);
        let (mut kind, mut content) = (String::new(), Content::default());
        walk(&xml, |piece| {
            match piece {
                Piece::Open("row", element) => {
                    let [number] = attributes(element, ["r"])?;
                    row = number.map_or(Ok(row + 1), |number| number.parse().map_err(|_| damaged()))?;
                    column = 0;
                }
                Piece::Open("c", element) => {
                    let [reference, of] = attributes(element, ["r", "t"])?;
                    (row, column) = reference.map_or(Ok((row, column + 1)), |text| place(&text))?;
                    (kind, content) = (of.unwrap_or_default(), Content::default());
                }
                Piece::Close("c") if content.text.is_empty() => {}
                Piece::Close("c") => {
                    let [rows, columns] = MOST_PLACES;
                    if !(1..=rows).contains(&row) || !(1..=columns).contains(&column) {
                        return Err(damaged());
                    }
                    let text = content.text.trim();
                    let text = match kind.as_str() {
                        "" | "n" => {
                            let value: f64 = text.parse().map_err(|_| damaged())?;
                            format!("{value:?}")
                        }
                        "s" => {
                            let shared = text.parse().ok().and_then(|n: usize| self.strings.get(n));
                            shared.ok_or_else(damaged)?.clone()
                        }
                        "b" => (text != "0").to_string(),
                        "e" => String::new(),
                        _ => text.to_owned(),
                    };
                    cells.push(row - 1, column - 1, &text)?;
                }
                piece => content.add(&piece, &["v", "t"]),
            }
            Ok(())
        })?;
        Ok(cells)
    }
}

/// Row and column, from 1, of a reference such as "AB12".
fn place(reference: &str) -> Result<(u32, u32)> {
    let digits = reference.find(|c: char| c.is_ascii_digit()).ok_or_else(damaged)?;
    let (letters, digits) = reference.split_at(digits);
    let row = digits.parse().map_err(|_| damaged())?;
    let column = letters.bytes().try_fold(0_u32, |column, letter| match letter.to_ascii_uppercase() {
        letter @ b'A'..=b'Z' => column.checked_mul(26)?.checked_add(u32::from(letter - b'A') + 1),
        _ => None,
    });
    Ok((row, column.ok_or_else(damaged)?))
}

/// The shared texts, without the phonetic signs beside them.
fn strings(xml: &str) -> Result<Vec<String>> {
    let (mut found, mut content) = (Vec::new(), Content::default());
    walk(xml, |piece| {
        match piece {
            Piece::Close("si") => found.push(std::mem::take(&mut content).text),
            piece => content.add(&piece, &["t"]),
        }
        Ok(())
    })?;
    Ok(found)
}

/// The first characters of the text of a cell.
#[derive(Default)]
struct Content {
    text: String,
    /// Inside of an element that holds text.
    inside: bool,
    phonetic: bool,
}

impl Content {
    fn add(&mut self, piece: &Piece<'_>, holders: &[&str]) {
        match piece {
            Piece::Open("rPh", _) => self.phonetic = true,
            Piece::Close("rPh") => self.phonetic = false,
            Piece::Open(name, _) if holders.contains(name) => self.inside = true,
            Piece::Close(name) if holders.contains(name) => self.inside = false,
            Piece::Text(text) if self.inside && !self.phonetic && self.text.len() < MOST_CHARACTERS => {
                self.text.extend(text.chars().take(MOST_CHARACTERS));
            }
            _ => {}
        }
    }
}

/// A relation of a part to another.
struct Relation {
    id: String,
    kind: String,
    /// Path of the other part.
    target: String,
}

/// The parts of the archive.
struct Parts<'a> {
    zip: ZipArchive<Cursor<&'a [u8]>>,
    /// Bytes that may still be unpacked.
    left: u64,
}

impl Parts<'_> {
    /// The text of a part, or `None` where there is no such part.
    fn text(&mut self, path: &str) -> Result<Option<String>> {
        let Ok(member) = self.zip.by_name(path) else { return Ok(None) };
        let mut bytes = Vec::new();
        member.take(self.left + 1).read_to_end(&mut bytes).map_err(|_| damaged())?;
        self.left = self.left.checked_sub(bytes.len() as u64).ok_or_else(|| {
            fault(format!(
                "the spreadsheet unpacks to more than {} MB; save the sheet with the measured numbers as text (csv)",
                MOST_UNPACKED >> 20
            ))
        })?;
        String::from_utf8(bytes).map(Some).map_err(|_| damaged())
    }

    /// The relations in the part `path`, whose targets are below `folder`.
    fn relations(&mut self, path: &str, folder: &str) -> Result<Vec<Relation>> {
        let xml = self.text(path.trim_start_matches('/'))?.unwrap_or_default();
        let mut found = Vec::new();
        walk(&xml, |piece| {
            if let Piece::Open("Relationship", element) = piece
                && let [Some(id), Some(kind), Some(target)] = attributes(element, ["Id", "Type", "Target"])?
            {
                let target = match target.strip_prefix('/') {
                    Some(whole) => whole.to_owned(),
                    None if folder.is_empty() => target,
                    None => format!("{folder}/{target}"),
                };
                found.push(Relation { id, kind, target });
            }
            Ok(())
        })?;
        Ok(found)
    }
}

/// Calls `on` for each piece of a part.
fn walk(part: &str, on: impl FnMut(Piece<'_>) -> Result<()>) -> Result<()> {
    xml::walk(part, on)
}

/// The attributes of these names, without their namespace.
fn attributes<const N: usize>(element: &BytesStart<'_>, names: [&str; N]) -> Result<[Option<String>; N]> {
    let mut found = [const { None }; N];
    for attribute in element.attributes().with_checks(false) {
        let attribute = attribute.map_err(|_| damaged())?;
        if let Some(n) = names.iter().position(|name| attribute.key.local_name().as_ref() == *name) {
            let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|_| damaged())?;
            found[n] = Some(value.chars().take(MOST_CHARACTERS).collect());
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_row_and_column() {
        for (text, found) in
            [("A1", (1, 1)), ("Z9", (9, 26)), ("AA10", (10, 27)), ("XFD1048576", (1 << 20, 1 << 14))]
        {
            assert_eq!(place(text).unwrap(), found);
        }
        for text in ["", "A", "1A", "é1", "AAAAAAAAAA1", "A99999999999"] {
            assert!(place(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_document_that_ends_within_an_element_is_damaged() {
        assert_eq!(strings("<sst><si><t>a</t></si></sst>").unwrap(), ["a"]);
        assert!(strings("<sst><si><t>a</t></si>").is_err());
    }

    #[test]
    fn shared_texts_are_joined_from_their_runs() {
        let xml = "<sst uniqueCount=\"4000000000\"><si><t>a &amp; b&#176;</t></si><si><r><rPr/><t>E</t></r><r><t xml:space=\"preserve\"> '</t></r>\
                   <rPh><t>no</t></rPh></si><si/></sst>";
        assert_eq!(strings(xml).unwrap(), ["a & b°", "E '", ""]);
    }
}
