//! Sheets of spreadsheets (.xls, .xlsx) as tables of text, one line per row.

mod cells;
mod xls;
mod xlsx;

use self::cells::{Cells, MOST_CELLS};
use self::xls::Excel;
use self::xlsx::OfficeOpen;
use super::error::{CurveError, Remedy, Result, fault};
use super::table::{Table, doubtful, is_grouped};
use super::wide;
use crate::topography::compound::is_compound;

/// A table of a file.
pub(super) struct Sheet {
    /// Its name in a spreadsheet; `None` for a text file.
    pub name: Option<String>,
    /// Its cells by rows, in a spreadsheet.
    pub cells: Vec<Vec<String>>,
    /// The table in it, or why there is none.
    pub table: Result<Table>,
}

/// A sheet by name.
#[derive(Clone)]
struct Named {
    name: String,
    hidden: bool,
}

/// A spreadsheet of any format.
trait Book {
    /// Its sheets, in order.
    fn sheets(&self) -> Vec<Named>;
    /// The cells of the sheet of this name.
    fn cells(&mut self, name: &str) -> Result<Cells>;
}

/// Larger spreadsheets are no curves.
const MOST_BYTES: usize = 32 << 20;
const MOST_SHEETS: usize = 100;
/// Characters of a text that are kept: longer ones are no names or numbers, and many cells may share one.
const MOST_CHARACTERS: usize = 1000;

impl From<crate::xml::Malformed> for CurveError {
    fn from(_: crate::xml::Malformed) -> CurveError {
        damaged()
    }
}

fn damaged() -> CurveError {
    fault("the spreadsheet is damaged; save it again or as text (csv)")
}

/// The tables of a file: the one of a text file; of a spreadsheet those of all sheets, or of the `wanted` one.
pub(super) fn sheets(bytes: &[u8], wanted: Option<&str>) -> Result<Vec<Sheet>> {
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
    Ok(rows(bytes, wanted)?
        .into_iter()
        .map(|(name, cells)| Sheet { table: table(&cells), name: Some(name), cells })
        .collect())
}

/// A compound document (.xls) or a zip archive (.xlsx).
fn is_workbook(bytes: &[u8]) -> bool {
    is_compound(bytes) || bytes.starts_with(b"PK\x03\x04")
}

type Rows = Vec<Vec<String>>;

fn rows(bytes: &[u8], wanted: Option<&str>) -> Result<Vec<(String, Rows)>> {
    let mut book: Box<dyn Book + '_> = match is_compound(bytes) {
        true => Box::new(Excel::open(bytes)?),
        false => Box::new(OfficeOpen::open(bytes)?),
    };
    // Hidden sheets come last.
    let mut sheets = book.sheets();
    sheets.sort_by_key(|sheet| sheet.hidden);
    let names: Vec<String> = sheets.into_iter().map(|sheet| sheet.name).collect();
    if let Some(name) = wanted
        && !names.iter().any(|known| known == name)
    {
        return Err(fault(format!("there is no sheet \"{name}\"")).remedy(Remedy::Sheet(listed(&names))));
    }
    let wanted = names.iter().filter(|name| wanted.is_none_or(|wanted| wanted == *name));
    let mut left = MOST_CELLS;
    wanted.take(MOST_SHEETS).map(|name| Ok((name.clone(), book.cells(name)?.rows(&mut left)?))).collect()
}

/// Names of sheets, for messages.
pub(super) fn listed(names: &[String]) -> String {
    names.iter().take(20).map(|name| format!("\"{name}\"")).collect::<Vec<String>>().join(", ")
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

fn table(cells: &Rows) -> Result<Table> {
    if let Some(cell) = thousands(cells) {
        return Err(doubtful(cell));
    }
    let plain = |cell: &String| decimal(cell).unwrap_or_else(|| cell.clone());
    let line = |row: &Vec<String>| row.iter().map(plain).collect::<Vec<String>>().join(";");
    let lines: Vec<String> = cells.iter().map(line).collect();
    Table::split(lines.join("\n"), Some(';'), false).and_then(wide::long)
}
