//! The lines above the points of a table: names of the columns, units, remarks, and points of which numbers are missing.
//!
//! ```text
//! any remarks
//! Time;   Modulus        the nearest line above the complete points that names two columns, or their units
//! min;    MPa
//! 0;      -              points that lack numbers are no heading
//! 0,01;   3,95           the first point with two numbers
//! ```

use super::names::{bare_unit, is_unit, split_unit, unquoted};
use super::role::{self, Role};
use super::table::{cells, is_blank, is_comment, is_missing, parse_number};

/// Lines above the first complete point among which the heading is looked for.
const MOST: usize = 50;

/// What stands above the points.
pub(super) struct Heading {
    /// The cells that name the columns; empty ones if the file names none.
    pub names: Vec<String>,
    /// The units of a line of their own.
    pub units: Option<Vec<String>>,
    /// The first point.
    pub first: usize,
    /// A line between the names and the points that is neither.
    pub unread: Option<usize>,
}

/// How the cells of a table are written.
#[derive(Clone, Copy)]
pub(super) struct Dialect {
    pub separator: Option<char>,
    pub decimal_comma: bool,
}

impl Dialect {
    /// The heading of a table whose first complete point follows `above`.
    pub(super) fn heading(self, above: &[&str], columns: usize) -> Heading {
        let (mut first, mut adjacent, mut unread) = (above.len(), above.len(), None);
        let written: Vec<usize> =
            (0..above.len()).rev().filter(|n| !is_blank(above[*n], self.separator)).take(MOST).collect();
        for (k, n) in written.iter().copied().enumerate() {
            let line = above[n];
            let counts = || counted(above[*written.get(k + 1)?], line, columns);
            if let (None, Some((names, units))) = (self.separator, counts()) {
                return Heading { names, units, first, unread };
            }
            if self.is_point(line, columns) {
                first = n;
                adjacent = if unread.is_none() { n } else { adjacent };
            } else if self.names(line, columns) {
                let (names, units) = header(&above[..=n], self.separator, columns);
                return Heading { names, units, first, unread };
            } else if !is_comment(line) && !cells(line, self.separator).iter().all(|cell| is_missing(cell)) {
                unread = unread.or(Some(n));
            }
        }
        // No line names what is known here: the last one names it in other words.
        let (names, units) = header(&above[..adjacent], self.separator, columns);
        Heading { names, units, first: adjacent, unread: None }
    }

    /// Whether a line names two columns of a table of so many, or their units.
    pub(super) fn names(self, line: &str, columns: usize) -> bool {
        let Some(cells) = header_cells(line, self.separator, columns) else { return false };
        let written = cells.iter().filter(|cell| !cell.is_empty()).count();
        let named = cells.iter().filter(|cell| is_name(cell)).count();
        (named >= 2 && 2 * named >= written) || are_units(&[], &cells) || only_units(&cells)
    }

    /// Whether a line is a point, although numbers of it may be missing.
    fn is_point(self, line: &str, columns: usize) -> bool {
        let cells = cells(line, self.separator);
        let number = |cell: &&&str| parse_number(cell, self.decimal_comma).is_some();
        let numbers = cells.iter().filter(number).count();
        let named = cells.iter().filter(|cell| is_name(cell)).count();
        let fits = cells.len() == columns
            || (cells.len() == columns + 1 && cells.last().is_some_and(|cell| cell.is_empty()))
            || (cells.len() < columns && cells.iter().all(|cell| number(&cell) || is_missing(cell)));
        let units = || {
            header_cells(line, self.separator, columns)
                .is_some_and(|cells| are_units(&[], &cells) || only_units(&cells))
        };
        !is_comment(line) && fits && numbers >= 1 && named <= 1 && named <= numbers && !units()
    }
}

/// Whether a cell names a quantity, or something with a unit.
fn is_name(cell: &str) -> bool {
    let cell = unquoted(cell);
    let name = split_unit(role::logarithm(cell).1).0;
    let known = || matches!(name, "t" | "T") || Role::ALL.iter().any(|role| role.is_called(name));
    let with_unit = || {
        let bracketed = cell.ends_with([']', ')']) && cell.contains(['[', '(']);
        let unit = split_unit(cell).1;
        bracketed && !matches!(unit, "" | "-" | "1") && is_unit(unit)
    };
    !is_missing(cell) && (known() || with_unit())
}

/// The header cells of the columns, and the units where a line of their own names them, below or above the names.
fn header(lines: &[&str], separator: Option<char>, columns: usize) -> (Vec<String>, Option<Vec<String>>) {
    let written: Vec<&str> =
        lines.iter().rev().copied().filter(|line| !is_blank(line, separator)).take(2).collect();
    let none = || vec![String::new(); columns];
    let mut found = written.into_iter().map_while(|line| header_cells(line, separator, columns));
    let Some(last) = found.next() else { return (none(), None) };
    let before = found.next();
    let bare = |cells: &[String]| Some(cells.iter().map(|cell| bare_unit(cell).to_owned()).collect());
    match before {
        Some(names) if only_units(&last) || are_units(&names, &last) => (names, bare(&last)),
        None if only_units(&last) => (none(), bare(&last)),
        Some(units) if only_units(&units) && !last.iter().any(|cell| has_unit(cell)) => (last, bare(&units)),
        _ => (last, None),
    }
}

/// Whether the cells are units, or say that there is none, and one of them is a unit.
fn only_units(cells: &[String]) -> bool {
    cells.iter().all(|cell| is_unit(cell))
        && cells.iter().any(|cell| !matches!(bare_unit(cell), "" | "-" | "1"))
}

fn has_unit(cell: &str) -> bool {
    !split_unit(cell).1.is_empty()
}

/// Names and units where the first column counts the points, without a unit below it:
///
/// ```text
///   Index          t          f
///                [s]       [Hz]
/// ```
fn counted(names: &str, units: &str, columns: usize) -> Option<(Vec<String>, Option<Vec<String>>)> {
    let names = header_cells(names, None, columns)?;
    let units = cells(units, None);
    let counts = ["index", "nr", "no", "point", "pt"].contains(&role::bare(&names[0]).as_str());
    let bracketed = units.iter().all(|cell| cell.starts_with('[') && cell.ends_with(']'));
    let units = std::iter::once("").chain(units.iter().map(|cell| bare_unit(cell)));
    let units: Vec<String> = units.map(str::to_owned).collect();
    (counts && bracketed && units.len() == columns).then_some((names, Some(units)))
}

/// Whether a line under a line of names holds their units, which may be single letters or unknown here: two of them at
/// least are units for sure, no cell is a number, and no more than a third of the cells are none; nor is the line above one of units.
fn are_units(names: &[String], cells: &[String]) -> bool {
    let sure = |cell: &&String| !matches!(bare_unit(cell), "" | "1") && is_unit(cell);
    let letter = |cell: &str| {
        matches!(bare_unit(cell), "C" | "N" | "m" | "F" | "%" | "°" | "deg" | "rad" | "C°" | "Grad")
    };
    let other = cells.iter().filter(|cell| !is_unit(cell) && !letter(cell)).count();
    let certain = cells.iter().filter(sure).count() + cells.iter().filter(|cell| letter(cell)).count();
    let real = |cell: &String| letter(cell) || (is_unit(cell) && !matches!(bare_unit(cell), "" | "-" | "1"));
    let number = |cell: &String| cell != "1" && cell.replace(',', ".").parse::<f64>().is_ok();
    certain >= 2
        && 3 * other <= cells.len()
        && cells.iter().any(real)
        && !cells.iter().any(number)
        && names.iter().filter(sure).count() < 2
}

/// The cells of a header line, where it has as many as there are columns. Names may hold blanks: where these part
/// the columns, two of them do.
pub(super) fn header_cells(line: &str, separator: Option<char>, columns: usize) -> Option<Vec<String>> {
    let is_marked = line.starts_with('#');
    let line = line.trim_start_matches(['#', '%', '/']);
    let line = if line.contains('\t') { line.trim_end() } else { line.trim() };
    let clean = |cells: Vec<&str>| -> Vec<String> {
        cells.iter().map(|cell| unquoted(cell.trim()).trim().replace("\"\"", "\"")).collect()
    };
    let blanks = separator.is_none() && !line.contains('\t');
    let mut spaced = clean(line.split("  ").filter(|cell| !cell.trim().is_empty()).collect());
    // "#" may be the name of a counter.
    if blanks
        && is_marked
        && spaced.len() + 1 == columns
        && spaced.iter().filter(|cell| is_name(cell)).count() >= 2
    {
        spaced.insert(0, "#".to_owned());
    }
    let spaced = (separator.is_none() && spaced.len() == columns).then_some(spaced);
    let mut plain = clean(cells(line, separator));
    if plain.len() == columns + 1 && plain.last().is_some_and(String::is_empty) {
        plain.pop();
    }
    if blanks && plain.windows(2).any(is_cut) {
        return spaced;
    }
    if plain.len() > columns {
        if spaced.is_some() {
            return spaced;
        }
        plain = with_units(plain);
    }
    // The last cells of a line with tabs may be empty.
    if separator.is_none() && line.contains('\t') && plain.len() < columns && plain.len() > columns / 2 {
        plain.resize(columns, String::new());
    }
    if plain.len() == columns {
        return Some(plain);
    }
    spaced
}

/// Whether two cells are the words of one name, as in "storage modulus": blanks do not part the columns of their line.
fn is_cut(cells: &[String]) -> bool {
    let whole = cells.join(" ");
    let name = split_unit(&whole).0;
    let is_word = |cell: &String| cell.chars().count() > 2 && cell.starts_with(char::is_alphabetic);
    cells.iter().all(is_word)
        && cells[0].chars().all(char::is_alphabetic)
        && name.contains(' ')
        && Role::ALL.iter().any(|role| role.is_called(name))
}

/// Cells that are nothing but a unit join the name before them: "E, MPa" in a file of commas.
fn with_units(cells: Vec<String>) -> Vec<String> {
    // A line of units alone has no names.
    if cells.first().is_some_and(|cell| !cell.is_empty() && is_unit(cell)) {
        return cells;
    }
    let mut joined: Vec<String> = Vec::with_capacity(cells.len());
    for cell in cells {
        match joined.last_mut() {
            Some(name) if !cell.is_empty() && is_unit(&cell) && split_unit(name).1.is_empty() => {
                *name = format!("{name} [{}]", bare_unit(&cell));
            }
            _ => joined.push(cell),
        }
    }
    joined
}
