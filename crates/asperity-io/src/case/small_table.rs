//! Small tables of quantities in text files: columns between semicolons, commas or tabs, otherwise between blanks. Units stand in a first
//! line of names or in the cells; what follows a `#` is a remark.

use super::place::Place;
use crate::digest::md5;
use crate::quantity::{Prescribed, QuantityError};
use crate::resources::text;

/// A larger file is no such table.
const MOST_BYTES: u64 = 64 << 20;

/// What is read from the text of the file that the key at `at` names.
pub(super) fn of_key<T>(
    at: &Place<'_>,
    path: &str,
    expected: &str,
    read: impl FnOnce(&str) -> Result<T, String>,
) -> Option<T> {
    let full = at.file(path)?;
    let read = text(&full, MOST_BYTES).and_then(|text| Ok((read(&text)?, md5(text.as_bytes()))));
    let read = read.map_err(|reason| format!("{}: {reason}", full.display()));
    let (read, digest) = at.data(read, expected)?;
    at.note_file(path, digest);
    Some(read)
}

/// A row of a table.
pub(super) struct Row<'r> {
    pub cells: &'r [&'r str],
    /// Those of the line of names; empty where it has none.
    units: &'r [&'r str],
}

impl Row<'_> {
    /// The quantity in a column, which an error calls `what`.
    pub fn quantity<T>(
        &self,
        column: usize,
        what: &str,
        resolve: impl FnOnce(&Prescribed) -> Result<T, QuantityError>,
    ) -> Result<T, String> {
        let cell = self.cells[column];
        // A cell may have a unit of its own.
        let written = match cell.parse::<f64>() {
            Ok(_) => format!("{cell} {}", self.units[column]),
            Err(_) => cell.to_owned(),
        };
        resolve(&Prescribed::Text(written)).map_err(|error| {
            let help = error.help.map(|help| format!(" ({help})")).unwrap_or_default();
            let cell: String = cell.chars().take(40).collect();
            format!("the {what} is {cell:?}, but must be {}{help}", error.expected)
        })
    }
}

/// Hands on the rows of a table whose lines `fit`, one after the other; an error begins with the number of its line.
pub(super) fn rows(
    text: &str,
    mut fit: impl FnMut(&[&str]) -> Result<(), String>,
    mut take: impl FnMut(Row<'_>) -> Result<(), String>,
) -> Result<(), String> {
    let mut units: Option<Vec<&str>> = None;
    for (n, line) in text.strip_prefix('\u{feff}').unwrap_or(text).lines().enumerate() {
        let cells = cells(line.split('#').next().unwrap_or_default().trim());
        if cells.is_empty() {
            continue;
        }
        let mut taken = || {
            fit(&cells)?;
            let names = units.is_none() && cells.iter().all(|cell| !begins_with_number(cell));
            let units = units.get_or_insert_with(|| match names {
                true => cells.iter().map(|cell| header_unit(cell)).collect(),
                false => vec![""; cells.len()],
            });
            if names { Ok(()) } else { take(Row { cells: &cells, units }) }
        };
        taken().map_err(|reason| format!("line {}: {reason}", n + 1))?;
    }
    Ok(())
}

/// The cells of a line; a separator may end it.
fn cells(line: &str) -> Vec<&str> {
    let separator = [';', ',', '\t'].into_iter().find(|separator| line.contains(*separator));
    let mut cells: Vec<&str> = match separator {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    };
    cells.pop_if(|last| last.is_empty());
    cells
}

fn begins_with_number(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'))
}

/// "mN" of "load [mN]" or "load (mN)" or "load/mN"; empty where the header names no unit.
fn header_unit(cell: &str) -> &str {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((_, rest)) = cell.split_once(open) {
            return rest.rsplit_once(close).map_or(rest, |(unit, _)| unit).trim();
        }
    }
    cell.split_once('/').map_or("", |(_, unit)| unit.trim())
}
