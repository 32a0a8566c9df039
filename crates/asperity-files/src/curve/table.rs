//! A text table: names and units of its columns, and its cells with the lines that they stand on.
//!
//! ```text
//! # any remarks
//! f [Hz];  E' [MPa];  E'' [MPa]      one line of names with units, or a line of names and one of units
//! 0,1;     12,5;      1,25           separator and decimal mark are found from the whole of the file
//! ```

use std::ops::Range;

use super::below::{self, Labels};
use super::error::{CurveError, Result, fault};
use super::heading::{self, Dialect};
use super::names::{is_unit, split_unit, unquoted};
use super::{role, wide};
use crate::readable::counted;
use crate::topography::{dialect, is_numbers, to_text};

/// Columns of a file and its rows of cells.
#[derive(Debug)]
pub(super) struct Table {
    /// One for each column.
    pub headings: Vec<Heading>,
    /// A line before the points that is not understood: in place of names, or below them. It may hold units.
    pub unread: Option<String>,
    pub rows: Vec<Row>,
    /// Lines between the points or below them that are not read, although they hold numbers.
    pub notes: Vec<String>,
    text: String,
    pub separator: Option<char>,
    pub decimal_comma: bool,
}

/// What the header says of a column.
#[derive(Debug)]
pub(super) struct Heading {
    /// The cell as it is written; empty if the file names no columns.
    pub header: String,
    /// The name without its unit.
    pub name: String,
    /// The unit as it is written; empty if the file names none.
    pub unit: String,
    /// The base if the column holds logarithms.
    pub base: Option<f64>,
}

/// A line of numbers: its cells are cut out when they are asked for.
#[derive(Debug)]
pub(super) struct Row {
    /// Line of the file, from 1.
    pub line: usize,
    /// Bytes of the text.
    span: Range<usize>,
}

/// Longer tables are no curves.
pub(super) const MOST_ROWS: usize = 2_000_000;
const MOST_COLUMNS: usize = 1000;
/// A table may have a blank line after each point.
const MOST_LINES: usize = 2 * MOST_ROWS;
const LONGEST_LINE: usize = 1 << 20;

impl Table {
    /// From the bytes of a text file.
    pub(super) fn parse(bytes: &[u8]) -> Result<Table> {
        if bytes.iter().all(u8::is_ascii_whitespace) {
            return Err(fault("the file is empty"));
        }
        let mut text = to_text(bytes).ok_or_else(|| {
            fault("the file is binary, not a text table and not a spreadsheet (.xls, .xlsx); export the measured columns as text (csv)")
        })?;
        // Lines that end in a carriage return alone.
        if text.contains('\r') && !text.contains('\n') {
            text = text.replace('\r', "\n");
        }
        if text.lines().nth(MOST_LINES).is_some() {
            return Err(fault(format!("the file has more than {MOST_LINES} lines")));
        }
        if let Some(n) = text.lines().position(|line| line.len() > LONGEST_LINE) {
            return Err(fault(format!("the line is longer than {LONGEST_LINE} bytes")).at(n + 1));
        }
        let lines: Vec<&str> = text.lines().map(trim).collect();
        let numeric = lines.iter().copied().filter(|line| !is_comment(line) && is_numbers(line));
        let (separator, decimal_comma) = match numeric.clone().next() {
            Some(_) if are_grouped_between_tabs(numeric.clone()) => (None, false),
            Some(_) => dialect(numeric).map_err(|problem| fault(problem.to_string()))?,
            // Columns of text beside the numbers, or numbers between quotes.
            None => guess(&lines),
        };
        if decimal_comma && let Some(cell) = thousands(&lines, separator) {
            return Err(doubtful(cell));
        }
        drop(lines);
        Table::split(text, separator, decimal_comma)
    }

    /// From text whose separator and decimal mark are known.
    pub(super) fn split(text: String, separator: Option<char>, decimal_comma: bool) -> Result<Table> {
        let lines: Vec<&str> = text.lines().map(trim).collect();
        let dialect = Dialect { separator, decimal_comma };
        // "NaN" counts as a number; dashes may be anything.
        let number = |cell: &str| parse_number(cell, decimal_comma).is_some() || is_undefined(cell);
        let numbers = |line: &str| cells(line, separator).iter().filter(|cell| number(cell)).count();
        let complete = first_row(&lines, dialect, &numbers).ok_or_else(|| no_points(&lines, dialect))?;
        let columns = columns(&lines[..=complete], &lines[complete + 1..], separator);
        if columns > MOST_COLUMNS {
            return Err(fault(format!("the table has {columns} columns, but may have {MOST_COLUMNS}")));
        }
        let heading::Heading { names: headers, units, first, unread } =
            dialect.heading(&lines[..complete], columns);
        let is_named = units.is_some() || headers.iter().any(|header| !header.is_empty());
        let last_above = || lines[..first].iter().rev().copied().find(|line| !is_blank(line, separator));
        let unread = if is_named { unread.map(|n| lines[n]) } else { last_above() }.map(str::to_owned);
        let lines_of_heading = usize::from(is_named) + usize::from(units.is_some());
        let named = heading(&lines[..first], separator, lines_of_heading);
        let labels = Labels::of(&cells(lines[complete], separator), decimal_comma);
        let is_row = |line: &str| {
            let cells = cells(line, separator);
            let fits = cells.len() == columns || cells.len() == columns + 1;
            fits && numbers(line) >= 2 && !labels.label(&cells)
        };
        let last = lines.iter().rposition(|line| is_row(line)).unwrap_or(first);
        let (mut rows, mut notes) = (Vec::new(), Vec::new());
        let (mut skipped, mut apart, mut blank) = (first, Vec::new(), false);
        for (n, line) in lines.iter().enumerate().skip(first) {
            if n < skipped || is_blank(line, separator) {
                blank |= n >= skipped;
                continue;
            }
            if is_comment(line) {
                let differs = n < last && !lines[..first].contains(line);
                let named = heading::header_cells(line, separator, columns).filter(|_| differs);
                if named.is_some_and(|cells| cells.iter().filter(|cell| names_column(cell)).count() >= 2) {
                    return Err(another_heading(line).at(n + 1));
                }
                continue;
            }
            let mut cells = cells(line, separator);
            // Text below the table: "Mean: 12".
            let is_text = || cells.first().is_none_or(|cell| !number(cell)) && cells.len() < columns;
            if n > last && (labels.label(&cells) || is_text()) {
                notes.extend(text_below(&lines[n..], n, dialect, columns)?);
                break;
            }
            if labels.sums_up(&cells) && numbers(line) > 0 {
                let shown: String = line.chars().take(60).collect();
                notes.push(format!("line {} ({shown:?}) sums up others and is not read", n + 1));
                continue;
            }
            if numbers(line) == 0 || cells.len() != columns || labels.label(&cells) {
                if let Some(next) = repeated_heading(&lines[..=last], n, &named, separator, &is_row) {
                    skipped = next;
                    continue;
                }
                if n < last && numbers(line) == 0 && cells.iter().any(|cell| names_column(cell)) {
                    return Err(another_heading(line).at(n + 1));
                }
            }
            if cells.len() == columns + 1 && cells.last().is_some_and(|cell| cell.is_empty()) {
                cells.pop(); // a separator ends the line
            }
            // The last cells of a line with tabs may be empty.
            let tabs = line.contains('\t') || ends_in_tab(&text, line);
            if separator.is_none() && tabs && cells.len() < columns {
                cells.resize(columns, "");
            }
            if cells.len() != columns {
                let found = cells.len();
                return Err(
                    fault(format!("{}, but {columns} on the lines before", counted(found, "cell"))).at(n + 1)
                );
            }
            if rows.len() == MOST_ROWS {
                return Err(fault(format!("there are more than {MOST_ROWS} points")).at(n + 1));
            }
            if std::mem::take(&mut blank) && !rows.is_empty() {
                apart.push(rows.len());
            }
            // Both are slices of one text.
            let start = line.as_ptr() as usize - text.as_ptr() as usize;
            rows.push(Row { line: n + 1, span: start..start + line.len() });
        }
        let headings = headings(headers, units);
        drop(lines);
        let mut table = Table { headings, unread, rows, notes, text, separator, decimal_comma };
        table.end(&apart)?;
        Ok(table)
    }

    /// Takes out the rows at the end that sum up the others; `apart` are the rows that stand below a blank line.
    fn end(&mut self, apart: &[usize]) -> Result<()> {
        let mut rows = std::mem::take(&mut self.rows);
        let first = |row: &Row| match self.cell(row, 0) {
            "" => Some(false),
            cell => parse_number(cell, self.decimal_comma).map(|_| true),
        };
        let note = below::without_number(&mut rows, first);
        self.notes.extend(note);
        self.rows = rows;
        // Several blank lines part sweeps.
        let [start] = apart else { return Ok(()) };
        let numbers = |column: usize| {
            self.rows.iter().map(|row| parse_number(self.cell(row, column), self.decimal_comma)).collect()
        };
        match *start < self.rows.len() {
            true => below::stand_apart(&self.rows, *start, (0..self.headings.len()).map(numbers)),
            false => Ok(()),
        }
    }

    /// The numbers of a column.
    pub(super) fn numbers(&self, column: usize) -> Result<Vec<f64>> {
        self.rows.iter().map(|row| self.number(row, column)).collect()
    }

    /// The numbers of a column, and `None` where a cell is empty or says that there is none.
    pub(super) fn sparse(&self, column: usize) -> Result<Vec<Option<f64>>> {
        let sparse = |row: &Row| match is_missing(self.cell(row, column)) {
            true => Ok(None),
            false => self.number(row, column).map(Some),
        };
        self.rows.iter().map(sparse).collect()
    }

    /// A cell as it is written.
    pub(super) fn cell(&self, row: &Row, column: usize) -> &str {
        let line = self.text.get(row.span.clone()).unwrap_or_default();
        cells(line, self.separator).get(column).copied().unwrap_or_default()
    }

    pub(super) fn number(&self, row: &Row, column: usize) -> Result<f64> {
        let cell = self.cell(row, column);
        parse_number(cell, self.decimal_comma).ok_or_else(|| {
                let shown: String = cell.chars().take(40).collect();
                let (why, help) = match cell {
                    "" => ("the cell is empty".to_owned(), "fill it, or take the line out"),
                    _ => (
                        format!("the cell {shown:?} is not a finite number"),
                        "take the line out, or write the number alone; its unit belongs into the header, as in \"modulus [MPa]\"",
                    ),
                };
                fault(format!("{why} (column {}{}); {help}", column + 1, self.quoted(column))).at(row.line)
        })
    }

    /// The entries of a column as numbers from 0, equal where the entries are equal, in the order of the file.
    pub(super) fn labels(&self, column: usize) -> Vec<f64> {
        let mut known = std::collections::HashMap::new();
        let label = |row: &Row| {
            let cell = self.cell(row, column);
            let next = known.len();
            *known.entry(cell.to_owned()).or_insert(next) as f64
        };
        self.rows.iter().map(label).collect()
    }

    /// Whether the file names its columns.
    pub(super) fn is_named(&self) -> bool {
        self.headings.iter().any(|heading| !heading.header.is_empty())
    }

    /// `, "f [Hz]"`, or nothing where the column has no name.
    pub(super) fn quoted(&self, column: usize) -> String {
        match self.headings[column].header.as_str() {
            "" => String::new(),
            header => format!(", {header:?}"),
        }
    }

    /// The lines above the numbers.
    pub(super) fn above(&self) -> impl DoubleEndedIterator<Item = &str> {
        let first = self.rows.first().map_or(0, |row| row.line - 1);
        self.text.lines().take(first).collect::<Vec<_>>().into_iter()
    }

    /// All columns, for messages: `1 "f [Hz]", 2 "E' [MPa]"`.
    pub(super) fn listed(&self) -> String {
        let name = |(n, heading): (usize, &Heading)| match heading.header.as_str() {
            "" => (n + 1).to_string(),
            header => format!("{} {header:?}", n + 1),
        };
        let names = self.headings.iter().enumerate().take(20).map(name).collect::<Vec<_>>().join(", ");
        match self.unread.as_ref().filter(|_| !self.is_named()) {
            Some(line) => {
                let shown: String = line.chars().take(60).collect();
                format!("{names}, which the line above them, {shown:?}, does not name one by one")
            }
            None => names,
        }
    }
}

/// A note on lines below a table that hold numbers, the first of which is line `n` of the file, from 0.
///
/// # Errors
/// Where another table stands there, with more columns: the steps of a measurement may differ in them.
fn text_below(lines: &[&str], n: usize, dialect: Dialect, columns: usize) -> Result<Option<String>> {
    let number = |cell: &&str| parse_number(cell, dialect.decimal_comma).is_some();
    let numbers = |line: &str| cells(line, dialect.separator).iter().filter(|cell| number(cell)).count();
    let is_whole = |line: &str| {
        let cells = cells(line, dialect.separator);
        cells.len() >= 2 && cells.iter().all(|cell| number(cell) || is_missing(cell))
    };
    let whole = || lines.iter().filter(|line| !is_comment(line) && is_whole(line) && numbers(line) >= 2);
    let shown: String = lines[0].chars().take(60).collect();
    if whole().filter(|line| cells(line, dialect.separator).len() > columns).count() >= 2 {
        return Err(another_heading(lines[0]).at(n + 1));
    }
    if whole().count() >= 2 {
        return Ok(Some(format!(
            "another table below, from line {} ({shown:?}) on, is not read; to read it, write it to a file of its own",
            n + 1
        )));
    }
    let held = lines.iter().any(|line| numbers(line) > 0);
    Ok(held.then(|| format!("the text below the points, from line {} ({shown:?}) on, is not read", n + 1)))
}

/// Name, unit and base of each column, from its header and the line of units.
fn headings(headers: Vec<String>, units: Option<Vec<String>>) -> Vec<Heading> {
    let mut units = units.into_iter().flatten();
    let heading = |header: String| {
        let (base, quantity) = role::logarithm(&header);
        let (name, own) = split_unit(quantity);
        // A dash below a name takes nothing from the unit behind it.
        let below = units.next().filter(|unit| !matches!(unit.as_str(), "" | "-" | "1") || own.is_empty());
        let (name, unit) = (name.to_owned(), below.unwrap_or_else(|| own.to_owned()));
        Heading { header, name, unit, base }
    };
    headers.into_iter().map(heading).collect()
}

/// Without blanks at its ends; a tab before other cells stands for an empty cell.
fn trim(line: &str) -> &str {
    let (line, rest) = (line.trim_end(), line.trim());
    // "\t4.5" is the second of two cells.
    let second = || line.starts_with('\t') && !rest.contains(char::is_whitespace);
    match rest.contains('\t') || second() {
        true => line.trim_start_matches([' ', '\u{feff}']),
        false => line.trim_start(),
    }
}

/// The first complete point: the first line with two numbers at least, and with as many cells as the next such line, unless a
/// heading follows it (exports begin with lines of other numbers); without such a pair, the first line with two numbers.
fn first_row(lines: &[&str], dialect: Dialect, numbers: &dyn Fn(&str) -> usize) -> Option<usize> {
    let width = |line: &str| cells(line, dialect.separator).len();
    let rows: Vec<usize> =
        (0..lines.len()).filter(|n| !is_comment(lines[*n]) && numbers(lines[*n]) >= 2).take(200).collect();
    let is_heading = |n: usize| numbers(lines[n]) == 0 && dialect.names(lines[n], width(lines[n]));
    let named = |range: Range<usize>| range.into_iter().any(is_heading);
    let pairs = || rows.windows(2).filter(|pair| width(lines[pair[0]]) == width(lines[pair[1]]));
    let follows = |pair: &&[usize]| named(0..pair[0]) || !named(pair[0]..pair[1]);
    pairs().find(follows).or_else(|| pairs().next()).map(|pair| pair[0]).or_else(|| rows.first().copied())
}

/// The error for a file without a line of two numbers: the first cell that looks like one and is none.
fn no_points(lines: &[&str], dialect: Dialect) -> CurveError {
    let why = "there is no line with two numbers; a curve is a text table with one point per line";
    let begins = |cell: &str| {
        let cell = cell.trim_start_matches(['"', '+', '-', '\u{2212}', '.', ',']);
        cell.starts_with(|c: char| c.is_ascii_digit())
    };
    let is_wrong = |cell: &str| begins(cell) && parse_number(cell, dialect.decimal_comma).is_none();
    let place = |n: usize| {
        let cells = cells(lines[n], dialect.separator);
        let column = cells.iter().position(|cell| is_wrong(cell))?;
        (cells.iter().filter(|cell| begins(cell)).count() >= 2).then(|| (n, column, cells[column]))
    };
    match (0..lines.len()).find_map(place) {
        Some((n, column, cell)) => {
            let shown: String = cell.chars().take(40).collect();
            fault(format!("{why}; the cell {shown:?} (column {}) is none; {ALONE}", column + 1)).at(n + 1)
        }
        None => fault(why),
    }
}

/// How a number is written.
const ALONE: &str = "write numbers alone, as 1234.5 or 1.2345e3, without units and without marks or blanks between thousands; the unit \
                     belongs into the header, as in \"modulus [MPa]\"";

/// The columns of a table, from its first complete point, the last of the lines. An empty last cell belongs to a column that has a name,
/// or numbers on the lines after it; otherwise a separator ends the line.
fn columns(lines: &[&str], after: &[&str], separator: Option<char>) -> usize {
    let Some((line, above)) = lines.split_last() else { return 0 };
    let point = cells(line, separator);
    let ends = |cells: &[&str]| cells.last().is_some_and(|cell| cell.is_empty());
    let named = above.iter().rev().map(|line| cells(line, separator)).find(|cells| {
        cells.len() == point.len() && cells.iter().filter(|cell| names_column(cell)).count() >= 2
    });
    let last_above = || {
        let line = above.iter().rev().find(|line| !is_blank(line, separator))?;
        Some(cells(line, separator)).filter(|named| named.len() == point.len())
    };
    let unnamed = || named.or_else(last_above).is_none_or(|named| ends(&named));
    let empty = || {
        let mut rows = after.iter().filter(|line| !is_comment(line)).map(|line| cells(line, separator));
        rows.all(|row| row.len() != point.len() || ends(&row))
    };
    point.len() - usize::from(ends(&point) && unnamed() && empty())
}

/// Whether a tab stands behind a line of the text, whose end is trimmed.
fn ends_in_tab(text: &str, line: &str) -> bool {
    let end = line.as_ptr() as usize - text.as_ptr() as usize + line.len();
    text.get(end..).is_some_and(|rest| rest.trim_start_matches(' ').starts_with('\t'))
}

/// The lines that name the columns and their units, the last one first.
fn heading<'a>(before: &[&'a str], separator: Option<char>, count: usize) -> Vec<&'a str> {
    before.iter().rev().filter(|line| !is_blank(line, separator)).take(count).copied().collect()
}

/// Where a file repeats its whole heading before the points of another sweep, the line on which they begin.
fn repeated_heading(
    lines: &[&str],
    from: usize,
    named: &[&str],
    separator: Option<char>,
    is_row: &dyn Fn(&str) -> bool,
) -> Option<usize> {
    /// Lines between two sweeps.
    const MOST: usize = 50;
    let next = (from..lines.len().min(from + MOST)).find(|n| is_row(lines[*n]))?;
    (!named.is_empty() && heading(&lines[from..next], separator, named.len()) == named).then_some(next)
}

/// Whether a cell of a line between the points names a column, a unit or a temperature.
fn names_column(cell: &str) -> bool {
    let cell = unquoted(cell);
    let unit = split_unit(cell).1;
    let is_called =
        || role::Role::ALL.iter().any(|role| role.is_called(role::logarithm(split_unit(cell).0).1));
    !is_missing(cell) && (is_called() || (!unit.is_empty() && is_unit(unit)) || wide::tells_value(cell))
}

/// The error for a line between the points that does not repeat the heading.
fn another_heading(line: &str) -> CurveError {
    let shown: String = line.chars().take(60).collect();
    fault(format!(
        "{shown:?} stands between the points: columns, units or temperatures change there, and all points would be read by the first \
         heading; write the parts to files of their own, or below each other under one heading, with a column of temperatures where \
         these differ"
    ))
}

/// The error for numbers whose comma is ambiguous.
pub(super) fn doubtful(cell: &str) -> CurveError {
    fault(format!(
        "numbers such as {cell:?} may have a decimal comma or a comma between thousands, and the file does not show which; write \
         them with a decimal point, or without commas"
    ))
}

/// Whether a line holds separators only.
pub(super) fn is_blank(line: &str, separator: Option<char>) -> bool {
    line.chars().all(|c| c.is_whitespace() || Some(c) == separator)
}

/// Whether a line is a remark; "#N/A" and "#DIV/0!" of spreadsheets are missing numbers.
pub(super) fn is_comment(line: &str) -> bool {
    let word = line.split([';', ',', '\t', ' ']).next().unwrap_or_default();
    let is_error = word.starts_with('#') && (word.ends_with(['!', '?']) || is_undefined(word));
    !is_error && (line.starts_with(['#', '%']) || line.starts_with("//"))
}

/// A finite number, with the file's decimal mark.
pub(super) fn parse_number(cell: &str, decimal_comma: bool) -> Option<f64> {
    let cell = cell.trim_matches('"');
    // "7,874.1" between quotes; "7,874" may have a decimal comma.
    let grouped = || is_grouped(cell) && (cell.contains('.') || cell.matches(',').count() > 1);
    let read = |cell: &str| match (cell.contains(','), decimal_comma) {
        (true, true) => cell.replacen(',', ".", 1).parse(),
        (true, false) if grouped() => cell.replace(',', "").parse(),
        _ => cell.parse(),
    };
    let number = read(cell).or_else(|error| usual(cell).map_or(Err(error), |cell| read(&cell)));
    number.ok().filter(|value: &f64| value.is_finite())
}

/// A number with the exponent of Fortran ("1.5D-03") or the minus sign of typography in the usual way.
fn usual(cell: &str) -> Option<String> {
    let is_exponent = |at: usize| {
        cell[..at].contains(['.', ',']) && cell[..at].ends_with(|c: char| c.is_ascii_digit() || c == '.')
    };
    let exponent = cell.find(['d', 'D']).filter(|at| is_exponent(*at));
    if exponent.is_none() && !cell.contains('\u{2212}') {
        return None;
    }
    let mut text = cell.to_owned();
    if let Some(at) = exponent {
        text.replace_range(at..=at, "e");
    }
    Some(text.replace('\u{2212}', "-"))
}

/// Half of the last digit of a number that has a decimal mark or is an integer.
pub(super) fn half_digit(cell: &str) -> f64 {
    let cell = cell.trim_matches('"');
    let (mantissa, exponent) = cell.split_once(['e', 'E', 'd', 'D']).unwrap_or((cell, "0"));
    let decimals = mantissa.rfind(['.', ',']).map_or(0, |at| mantissa.len() - at - 1);
    let exponent: i32 = exponent.parse().unwrap_or(0);
    0.5 * 10f64.powi(exponent.clamp(-400, 400) - decimals.min(400) as i32)
}

/// Whether a cell is a word for an undefined number.
fn is_undefined(cell: &str) -> bool {
    let cell = cell.trim_matches('"');
    ["nan", "na", "n/a", "#n/a", "#nv"].iter().any(|word| cell.eq_ignore_ascii_case(word))
}

/// Whether a cell says that there is no number.
pub(super) fn is_missing(cell: &str) -> bool {
    /// Also those of a range that was exceeded.
    const WORDS: &str = "n.a. null none nil inf -inf +inf infinity -infinity ol o.l. ovl ovfl ovf overflow overload overrange over \
                         err err. error invalid failed fail bad missing void";
    let bare = cell.trim_matches('"').trim();
    is_undefined(bare)
        || bare.starts_with('#')
        || bare.chars().all(|c| matches!(c, '-' | '–' | '—' | '*' | '?' | '.'))
        || WORDS.split_whitespace().any(|word| bare.eq_ignore_ascii_case(word))
}

/// A number with a comma, where all of them look like thousands: "24,070".
fn thousands<'l>(lines: &[&'l str], separator: Option<char>) -> Option<&'l str> {
    let mut found = None;
    let numbers = lines.iter().filter(|line| !is_comment(line)).flat_map(|line| cells(line, separator));
    let numbers = numbers.map(|cell| cell.trim_matches('"'));
    for cell in numbers.filter(|cell| cell.contains(',') && parse_number(cell, true).is_some()) {
        if !is_grouped(cell) {
            return None;
        }
        found = Some(cell);
    }
    found
}

/// Whether all digits of a number stand in groups of three behind commas, as in "7,874" or "1,093,810.6".
pub(super) fn is_grouped(cell: &str) -> bool {
    let whole = cell.split_once('.').map_or(cell, |(whole, _)| whole).trim_start_matches(['+', '-']);
    let mut groups = whole.split(',');
    let first = groups.next().unwrap_or_default();
    let digits = |group: &str, count: std::ops::RangeInclusive<usize>| {
        count.contains(&group.len()) && group.bytes().all(|b| b.is_ascii_digit())
    };
    digits(first, 1..=3) && !first.starts_with('0') && groups.all(|group| digits(group, 3..=3))
}

/// Separator and decimal mark of a file whose lines hold text as well.
fn guess(lines: &[&str]) -> (Option<char>, bool) {
    let written = || lines.iter().filter(|line| !line.is_empty());
    let has = |c: char| written().filter(|line| line.contains(c)).count() * 2 > written().count();
    match (has(';'), has('\t'), has(',')) {
        (true, _, comma) => (Some(';'), comma),
        (_, true, comma) => (None, comma),
        (_, _, true) => (Some(','), has_quoted_decimal_commas(lines)),
        _ => (None, false),
    }
}

/// Whether numbers between quotes have decimal commas, and none has a point: `"0,5","1,25"`.
fn has_quoted_decimal_commas(lines: &[&str]) -> bool {
    let cells = || lines.iter().flat_map(|line| cells(line, Some(','))).filter(|cell| cell.starts_with('"'));
    let number = |cell: &&str| parse_number(cell, true).is_some();
    cells().filter(number).any(|cell| cell.contains(','))
        && !cells().filter(number).any(|cell| cell.contains('.'))
}

/// Whether tabs part the numbers of all lines, and commas only thousands of numbers with decimal points.
fn are_grouped_between_tabs<'l>(lines: impl Iterator<Item = &'l str> + Clone) -> bool {
    let has = |c: char| lines.clone().any(|line| line.contains(c));
    let is_grouped = |cell: &str| !cell.contains(',') || is_grouped(cell.trim());
    has(',')
        && has('.')
        && !has(';')
        && lines.clone().all(|line| line.contains('\t') && line.split('\t').all(is_grouped))
}

/// The cells of a line: at the separator, or at tabs where there are any, else at blanks. A separator between quotes is none; quotes
/// begin with the cell, as that of E" is a double prime.
pub(super) fn cells(line: &str, separator: Option<char>) -> Vec<&str> {
    let Some(separator) = separator else {
        return match line.contains('\t') {
            true => line.split('\t').map(str::trim).collect(),
            false => line.split_whitespace().collect(),
        };
    };
    let (mut quoted, mut begins, mut closed) = (false, true, false);
    let outside = |c: char| {
        let ends = c == separator && !quoted;
        if c == '"' {
            // Inside quotes, two of them stand for one.
            (quoted, closed) = (!quoted && (begins || closed), quoted);
        } else {
            closed = false;
        }
        begins = ends || (begins && c.is_whitespace());
        ends
    };
    line.split(outside).map(str::trim).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_read_in_the_ways_that_people_write_them() {
        for header in ["E, MPa", "E in MPa", "E_MPa", "E MPa", "E / MPa", "E/MPa", "E [MPa]", "E (MPa)"] {
            assert_eq!(split_unit(header), ("E", "MPa"), "{header}");
        }
        assert_eq!(split_unit("frequency rad/s"), ("frequency", "rad/s"));
        assert_eq!(split_unit("time_min"), ("time", "min"));
        // Second words of names are no units.
        for header in ["storage modulus", "tan_delta", "T g", "E min", "E(t)", "E'", "loss factor"] {
            assert_eq!(split_unit(header), (header, ""), "{header}");
        }
        for text in [
            "t, s, E, MPa\n0.5, 2\n1.5, 1\n",
            "\"t, s\",\"E, MPa\"\n0.5,2\n1.5,1\n",
            "t in s;E in MPa\n0,5;2\n1,5;1\n",
            "t_s,E_MPa\n0.5,2\n1.5,1\n",
            "time [s], E, MPa\n0.5,2\n1.5,1\n",
        ] {
            let table = Table::parse(text.as_bytes()).unwrap();
            assert_eq!((names(&table)[1], units(&table)), ("E", vec!["s", "MPa"]), "{text}");
        }
    }

    fn names(table: &Table) -> Vec<&str> {
        table.headings.iter().map(|heading| heading.name.as_str()).collect()
    }

    fn units(table: &Table) -> Vec<&str> {
        table.headings.iter().map(|heading| heading.unit.as_str()).collect()
    }

    #[test]
    fn headers_separators_and_decimal_marks() {
        for text in [
            "t [s], E [MPa]\n0.5, 2\n1.5, 1\n",
            "t [s];E [MPa]\n0,5;2\n1,5;1\n",
            "t/s\tE/MPa\n0,5\t2,0\n1,5\t1,0\n",
            "# made by hand\n# t (s)  E (MPa)\n0.5 2\n1.5 1\n",
            "t,E\ns,MPa\n0.5,2\n\n# half way\n1.5,1\n",
            // A heading that is repeated before the next points.
            "t,E\ns,MPa\n0.5,2\n\nnext step\nt,E\ns,MPa\n1.5,1\n",
            // Text below the table.
            "t;E\ns;MPa\n0,5;2\n1,5;1\nend of data\n12 mg\n",
            // Other numbers before the table.
            "3 samples of 2 mm\nmade 2024 5 17\nt\tE\ns\tMPa\n0.5\t2\n1.5\t1\n",
            "sample A\nt;E;\n[s];[MPa];\n0,5;2;\n1,5;1;\n",
        ] {
            let table = Table::parse(text.as_bytes()).unwrap();
            assert_eq!((names(&table), units(&table)), (vec!["t", "E"], vec!["s", "MPa"]), "{text}");
            assert_eq!(table.numbers(0).unwrap(), [0.5, 1.5], "{text}");
            assert_eq!(table.numbers(1).unwrap(), [2.0, 1.0], "{text}");
        }
        let table = Table::parse(b"0.5 2\n1.5 1\n").unwrap();
        assert_eq!(names(&table), ["", ""]);
        // Other numbers before each heading.
        let block = "Interval and points:\t1\t7\t9\nt\tE\ns\tMPa\n\n0.5\t2\n1.5\t1\n\n";
        let table = Table::parse(block.repeat(2).as_bytes()).unwrap();
        assert_eq!((names(&table)[0], units(&table)[1]), ("t", "MPa"));
        assert_eq!(table.numbers(0).unwrap(), [0.5, 1.5, 0.5, 1.5]);
    }

    #[test]
    fn a_line_of_units_may_hold_single_letters_and_dashes() {
        for (text, names, units) in [
            ("\u{feff}T,log_aT\nC, -\n100,-11.7\n92,-10.92\n", ["T", "aT"], ["C", "-"]),
            ("Zeit;Kraft;\ns;N;\n0,5;2;\n1,5;1;\n", ["Zeit", "Kraft"], ["s", "N"]),
        ] {
            let table = Table::parse(text.as_bytes()).unwrap();
            assert_eq!(
                (self::names(&table), self::units(&table)),
                (names.to_vec(), units.to_vec()),
                "{text}"
            );
        }
        let tabs = Table::parse(b"\tt\tE\n\ts\tMPa\nA\t0.5\t2\nA\t1.5\t1\n").unwrap();
        assert_eq!((names(&tabs)[1], units(&tabs)[2]), ("t", "MPa"));
        let five = "f,E',E'',T,Set\nHz,MPa,MPa,C,-\n1,2,3,4,0\n2,3,4,4,0\n";
        assert_eq!(names(&Table::parse(five.as_bytes()).unwrap()), ["f", "E'", "E''", "T", "Set"]);
    }

    #[test]
    fn columns_of_text_stand_beside_the_numbers() {
        let table = Table::parse(b"sample,f [Hz],tan(delta)\nA1,1,0.5\nA1,2,0.6\n").unwrap();
        assert_eq!(names(&table), ["sample", "f", "tan(delta)"]);
        assert_eq!(units(&table), ["", "Hz", ""]);
        assert_eq!(table.numbers(2).unwrap(), [0.5, 0.6]);
        assert_eq!(table.numbers(0).unwrap_err().line, Some(2));
    }

    #[test]
    fn faults_have_their_line() {
        let says = |text: &str, line: Option<usize>, words: &str| {
            let found =
                Table::parse(text.as_bytes()).and_then(|t| t.numbers(0).and(t.numbers(1))).unwrap_err();
            assert!(found.line == line && found.message.contains(words), "{text:?}: {found:?}");
        };
        says("", None, "the file is empty");
        says("t [s], E [MPa]\n", None, "no line with two numbers");
        says("t,E\n1,2\n2,3,4\n", Some(3), "3 cells, but 2");
        says("t,E\n1,2\n\n2,x\n", Some(4), "\"x\" is not a finite number (column 2, \"E\")");
        says("t,E\n1,2\n2,10 kPa\n", Some(3), "its unit belongs into the header");
        says("t;E\n1;2\n2;\n", Some(3), "empty");
        says("t,E\n1,2\n2,nan\n", Some(3), "not a finite number");
        says("\0\0\x01PNG", None, "binary");
    }

    #[test]
    fn commas_between_thousands_are_told_from_decimal_commas() {
        // All numbers may be thousands.
        for text in ["t [s];E [kPa]\n1;24,070\n2;20,296\n", "t [s]\tE [kPa]\n1\t24,070\n2\t20,296\n"] {
            let error = Table::parse(text.as_bytes()).unwrap_err();
            assert!(error.message.contains("between thousands"), "{text}: {error:?}");
        }
        // One of them is not.
        for text in ["t;E\n0,5;24,070\n2;20,296\n", "t;E\n1;1093,800\n2;20,296\n", "t;E\n1;0,720\n2;20,296\n"]
        {
            assert_eq!(Table::parse(text.as_bytes()).unwrap().numbers(1).unwrap()[1], 20.296, "{text}");
        }
        // Between quotes.
        let quoted = Table::parse(b"f,E\n0.5,\"1,093,810.6\"\n1.5,\"7,874.1\"\n").unwrap();
        assert_eq!(quoted.numbers(1).unwrap(), [1_093_810.6, 7874.1]);
    }

    #[test]
    fn separators_between_quotes_are_none() {
        let table =
            Table::parse(b"Action,f (Hz),E' (Pa)\n\"sweep, first\",1,5\n\"sweep, first\",2,6\n").unwrap();
        assert_eq!(table.numbers(2).unwrap(), [5.0, 6.0]);
    }

    #[test]
    fn a_count_of_points_has_no_unit() {
        let table =
            Table::parse(b"Curve Values:\n Index   t   M'\n        [s]  [MPa]\n 0  0.5  2\n 1  1.5  1\n")
                .unwrap();
        assert_eq!(
            (names(&table).join(" "), units(&table).join(" ")),
            ("Index t M'".into(), " s MPa".into())
        );
    }
}
