//! Sheets of spreadsheets (.xls, .xlsx, .xlsb, .ods) as tables of text, one line per row.

use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};

use calamine::{Data, Reader, SheetVisible, Sheets, open_workbook_auto_from_rs};

use super::error::{Fault, Remedy, fault};
use super::table::{Table, doubtful, is_grouped};
use super::wide;

/// A table of a file.
pub(super) struct Sheet {
    /// Its name in a spreadsheet; `None` for a text file.
    pub name: Option<String>,
    /// Its cells by rows, in a spreadsheet.
    pub cells: Vec<Vec<String>>,
    /// The table in it, or why there is none.
    pub table: Result<Table, Fault>,
}

/// Larger spreadsheets are no curves: a sheet of a few bytes can span all cells of a spreadsheet.
const MOST_BYTES: usize = 32 << 20;
/// Most cells of a sheet.
const MOST_CELLS: usize = 4_000_000;
const MOST_SHEETS: usize = 100;

/// The tables of a file: one of a text file, those of all sheets of a spreadsheet, or of the one that is named.
pub(super) fn sheets(bytes: &[u8], wanted: Option<&str>) -> Result<Vec<Sheet>, Fault> {
    if !is_workbook(bytes) {
        if let Some(name) = wanted {
            return Err(fault(format!("the file is no spreadsheet, and has no sheet \"{name}\"")));
        }
        return Ok(vec![Sheet {
            name: None,
            cells: Vec::new(),
            table: Ok(wide::long(Table::parse(bytes)?)?),
        }]);
    }
    if bytes.len() > MOST_BYTES {
        return Err(fault(format!("the spreadsheet is larger than {} MB", MOST_BYTES >> 20)));
    }
    // A damaged spreadsheet must not end the program, whatever the reader makes of it.
    let read = catch_unwind(AssertUnwindSafe(|| rows(bytes, wanted)));
    let rows =
        read.unwrap_or_else(|_| Err(fault("the spreadsheet is damaged; save it again or as text (csv)")))?;
    Ok(rows
        .into_iter()
        .map(|(name, cells)| Sheet { table: table(&cells), name: Some(name), cells })
        .collect())
}

/// A compound document (.xls) or a zip archive (.xlsx, .ods).
fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0xd0, 0xcf, 0x11, 0xe0]) || bytes.starts_with(b"PK\x03\x04")
}

type Rows = Vec<Vec<String>>;

fn rows(bytes: &[u8], wanted: Option<&str>) -> Result<Vec<(String, Rows)>, Fault> {
    let unreadable = |error: calamine::Error| fault(format!("cannot be read as a spreadsheet: {error}"));
    let mut book: Sheets<Cursor<&[u8]>> =
        open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(unreadable)?;
    // Hidden sheets come last.
    let mut listed: Vec<_> = book.sheets_metadata().to_vec();
    listed.sort_by_key(|sheet| sheet.visible != SheetVisible::Visible);
    let names: Vec<String> = listed.into_iter().map(|sheet| sheet.name).collect();
    let listed =
        || names.iter().take(20).map(|name| format!("\"{name}\"")).collect::<Vec<String>>().join(", ");
    if let Some(name) = wanted
        && !names.iter().any(|known| known == name)
    {
        return Err(fault(format!("there is no sheet \"{name}\"")).remedy(Remedy::Sheet(listed())));
    }
    let mut found = Vec::new();
    for name in names.iter().filter(|name| wanted.is_none_or(|wanted| wanted == *name)).take(MOST_SHEETS) {
        let range = book.worksheet_range(name).map_err(unreadable)?;
        let (height, width) = range.get_size();
        if height.saturating_mul(width) > MOST_CELLS {
            return Err(fault(format!("the sheet \"{name}\" has more than {MOST_CELLS} cells")));
        }
        // Rows are counted from the first of the sheet, as the program that made it does.
        let above = range.start().map_or(0, |start| start.0 as usize).min(MOST_CELLS);
        let rows = range.rows().map(|row| row.iter().map(cell).collect());
        found.push((name.clone(), std::iter::repeat_n(Vec::new(), above).chain(rows).collect()));
    }
    Ok(found)
}

fn cell(data: &Data) -> String {
    let text = match data {
        Data::Empty | Data::Error(_) => String::new(),
        Data::Float(value) => format!("{value:?}"),
        Data::String(text) => text.trim().to_owned(),
        other => other.to_string(),
    };
    text.replace([';', '\n', '\r'], " ")
}

/// A number that was entered as text with a decimal comma, with a point.
fn decimal(text: &str) -> Option<String> {
    let point = text.replacen(',', ".", 1);
    (text.contains(',') && point.parse::<f64>().is_ok()).then_some(point)
}

/// A number of the rows that was entered as text with a comma, where all of them look like thousands: "24,070".
fn thousands(cells: &Rows) -> Option<&str> {
    let is_number = |cell: &&String| cell.parse::<f64>().is_ok() || decimal(cell).is_some();
    let points = cells.iter().filter(|row| row.iter().filter(is_number).count() >= 2);
    let mut commas = points.flatten().filter(|cell| decimal(cell).is_some()).peekable();
    let first = commas.peek().copied()?;
    commas.all(|cell| is_grouped(cell)).then_some(first)
}

fn table(cells: &Rows) -> Result<Table, Fault> {
    if let Some(cell) = thousands(cells) {
        return Err(doubtful(cell));
    }
    let plain = |cell: &String| decimal(cell).unwrap_or_else(|| cell.clone());
    let line = |row: &Vec<String>| row.iter().map(plain).collect::<Vec<String>>().join(";");
    let lines: Vec<String> = cells.iter().map(line).collect();
    Table::split(lines.join("\n"), Some(';'), false).and_then(wide::long)
}
