//! What stands below the points of a table or between them and is none: text, and rows that sum the points up.
//!
//! ```text
//! 0,1; 12,5; 1,25
//! 0,2; 12,9; 1,31
//! Mittelwert; 12,7; 1,28     the first cell names what the row sums up: never a point
//!                            a blank line
//! ; 12,7; 1,28               a row without the number that every point has
//! 0,15; 12,7; 1,28           a few rows that do not continue the table: nobody says what they are
//! ```

use super::error::{Result, fault};
use super::table::{Row, is_missing, parse_number};

/// Most rows that sum up a table.
const MOST: usize = 4;
/// A table has more rows than those that sum it up.
const LEAST: usize = 10;

/// How a label of a row is told.
#[derive(Clone, Copy)]
pub(super) struct Labels {
    /// Whether the first column holds numbers: then every word in it is a label.
    pub(super) numeric: bool,
    /// Whether the points themselves have names such as "Mean".
    pub(super) usual: bool,
}

impl Labels {
    /// Of a table with this first point.
    pub(super) fn of(first: &[&str], decimal_comma: bool) -> Labels {
        let number = |cell: &&str| is_missing(cell) || parse_number(cell, decimal_comma).is_some();
        Labels { numeric: first.first().is_some_and(number), usual: is_summary(first) }
    }

    /// Whether a row sums up others, or is text.
    pub(super) fn label(self, cells: &[&str]) -> bool {
        let word = cells.iter().find(|cell| !cell.is_empty()).map(|cell| cell.trim_matches('"').trim());
        let is_word = |cell: &str| cell.starts_with(char::is_alphabetic) && !is_missing(cell);
        word.is_some_and(|cell| self.numeric && is_word(cell)) || self.sums_up(cells)
    }

    /// Whether a row sums up others.
    pub(super) fn sums_up(self, cells: &[&str]) -> bool {
        !self.usual && is_summary(cells)
    }
}

/// Whether the first word of a line says that it sums up others.
pub(super) fn is_summary(cells: &[&str]) -> bool {
    const WORDS: &str = "mean average avg mittelwert mittel durchschnitt moyenne media std stdev stddev stdabw stabw sd standard \
                         standardabweichung streuung écart ecart min minimum minimal max maximum maximal median médiane sum summe total \
                         somme rms variance varianz cv rsd sem";
    let Some(cell) = cells.iter().find(|cell| !cell.is_empty()) else { return false };
    let cell = cell.trim_matches('"').to_lowercase();
    let word = cell.split(|c: char| !c.is_alphabetic()).next().unwrap_or_default();
    WORDS.split_whitespace().any(|known| known == word)
}

/// Takes rows from the end that lack the number of the first column, which every other row has, and a note on them.
pub(super) fn without_number(rows: &mut Vec<Row>, first: impl Fn(&Row) -> Option<bool>) -> Option<String> {
    let missing = rows.iter().rev().take(MOST + 1).take_while(|row| first(row) == Some(false)).count();
    let start = rows.len() - missing;
    let is_summary = (1..=MOST).contains(&missing)
        && start >= LEAST
        && rows[..start].iter().all(|row| first(row) == Some(true));
    let taken = is_summary.then(|| rows.split_off(start))?;
    Some(format!(
        "{} no number in the first column, as the points do, and {} not read",
        lines(&taken, "has", "have"),
        is(&taken)
    ))
}

/// # Errors
/// Where a few rows stand apart below a table and do not continue it: they may sum it up. `start` is the first of them, and
/// `columns` gives the numbers of each column.
pub(super) fn stand_apart(
    rows: &[Row],
    start: usize,
    columns: impl Iterator<Item = Vec<Option<f64>>>,
) -> Result<()> {
    let tail = rows.len() - start;
    if start < LEAST || !(1..=MOST).contains(&tail) {
        return Ok(());
    }
    let continues = |numbers: Vec<Option<f64>>| {
        let numbers: Option<Vec<f64>> = numbers.into_iter().collect();
        numbers.is_some_and(|numbers| {
            numbers.windows(2).all(|pair| pair[0] < pair[1])
                || numbers.windows(2).all(|pair| pair[0] > pair[1])
        })
    };
    match columns.into_iter().any(continues) {
        true => Ok(()),
        false => Err(fault(format!(
            "{} apart below the {start} points and {} not continue any of their columns: such rows may sum the points up; take them out, or, if \
             they are points, the blank line above them",
            lines(&rows[start..], "stands", "stand"),
            if tail == 1 { "does" } else { "do" },
        ))
        .at(rows[start].line)),
    }
}

/// "line 42 has" or "lines 42 to 43 have".
fn lines(rows: &[Row], one: &str, several: &str) -> String {
    match rows {
        [row] => format!("line {} {one}", row.line),
        [first, .., last] => format!("lines {} to {} {several}", first.line, last.line),
        [] => String::new(),
    }
}

fn is(rows: &[Row]) -> &'static str {
    if rows.len() == 1 { "is" } else { "are" }
}
