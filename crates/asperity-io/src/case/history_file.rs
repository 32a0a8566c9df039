//! A history from a file: one point per line, time and value.
//!
//! ```text
//! time [s], load [mN]     optional header with units
//! 0, 0
//! 10, 500                 or with units in the cells: 10 s; 0.5 N
//! ```

use super::place::Place;
use super::words::number;
use crate::digest::md5;
use crate::quantity::range::NonNegative;
use crate::quantity::{Prescribed, QuantityError, Time};
use crate::resources::text;

/// A file larger than this is no history.
const MOST_BYTES: u64 = 64 << 20;
const MOST_POINTS: usize = 10_000_000;

/// Path of a file as the case writes it, and its MD5.
pub type Origin = (String, String);

/// The points (time \[s\], value in SI) of the file that the key at `at` names, and where they come from.
pub fn of_key(
    at: &Place<'_>,
    path: &str,
    value: &str,
    resolve: impl Fn(&Prescribed) -> Result<f64, QuantityError>,
) -> Option<(Vec<(f64, f64)>, Origin)> {
    let full = at.file(path)?;
    let read = text(&full, MOST_BYTES).and_then(|text| Ok((parse(&text, resolve)?, md5(text.as_bytes()))));
    let read = read.map_err(|reason| format!("{}: {reason}", full.display()));
    let (points, digest) = at.data(read, &format!("a file of two columns, time and {value}"))?;
    Some((points, (path.to_owned(), digest)))
}

/// Refuses points of a table that do not begin at 0 or run back in time.
pub fn in_order(at: &Place<'_>, points: &[(f64, f64)], value: &str) -> Option<()> {
    if let Some(n) = points.windows(2).position(|pair| pair[1].0 < pair[0].0) {
        let expected = format!("a point at {} s or later, as the point before it", number(points[n].0));
        return at.item(n + 1).wrong(expected, "list the points in order of time");
    }
    match points.first() {
        Some((time, _)) if *time != 0.0 => {
            at.item(0).wrong("a point at 0 s", &format!("give the {value} at the start"))
        }
        _ => Some(()),
    }
}

fn parse(
    text: &str,
    resolve: impl Fn(&Prescribed) -> Result<f64, QuantityError>,
) -> Result<Vec<(f64, f64)>, String> {
    let mut units = [String::new(), String::new()];
    let mut header_allowed = true;
    let mut points: Vec<(f64, f64)> = Vec::new();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    for (n, line) in text.lines().enumerate() {
        let at = |reason: String| format!("line {}: {reason}", n + 1);
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        let cells = cells(line).ok_or_else(|| {
            at("two columns are expected, time and value, as in \"10 s, 0.5 N\"".to_owned())
        })?;
        if header_allowed && cells.iter().all(|cell| !begins_with_number(cell)) {
            units = cells.map(|cell| header_unit(cell).to_owned());
            header_allowed = false;
            continue;
        }
        header_allowed = false;
        let [time, value] =
            [(cells[0], &units[0]), (cells[1], &units[1])].map(|(cell, unit)| with_unit(cell, unit));
        let time = Prescribed::Text(time).resolve::<crate::quantity::dimension::Time, NonNegative>();
        let time: Time<NonNegative> = time.map_err(|error| at(sentence("time", cells[0], &error)))?;
        let value =
            resolve(&Prescribed::Text(value)).map_err(|error| at(sentence("value", cells[1], &error)))?;
        let time = time.get();
        match points.last() {
            None if time != 0.0 => {
                return Err(at(format!("the first time is {time} s; the history must begin at 0 s")));
            }
            Some((before, _)) if time < *before => {
                return Err(at(format!(
                    "the time {time} s comes after {before} s; list the points in order"
                )));
            }
            _ if points.len() == MOST_POINTS => {
                return Err(at(format!("there are more than {MOST_POINTS} points")));
            }
            _ => points.push((time, value)),
        }
    }
    match points.is_empty() {
        true => Err("there is no point in the file".to_owned()),
        false => Ok(points),
    }
}

/// The two columns: separated by semicolons, commas or tabs if the line has any, otherwise by blanks.
fn cells(line: &str) -> Option<[&str; 2]> {
    let separator = [';', ',', '\t'].into_iter().find(|separator| line.contains(*separator));
    let mut cells: Vec<&str> = match separator {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    };
    if cells.len() == 3 && cells[2].is_empty() {
        cells.pop(); // a separator ends the line
    }
    <[&str; 2]>::try_from(cells).ok().filter(|cells| cells.iter().all(|cell| !cell.is_empty()))
}

pub(super) fn begins_with_number(cell: &str) -> bool {
    cell.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'))
}

/// "mN" of "load [mN]" or "load (mN)" or "load/mN"; empty where the header names no unit.
pub(super) fn header_unit(cell: &str) -> &str {
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((_, rest)) = cell.split_once(open) {
            return rest.rsplit_once(close).map_or(rest, |(unit, _)| unit).trim();
        }
    }
    cell.split_once('/').map_or("", |(_, unit)| unit.trim())
}

/// The cell with the column's unit, where it has none of its own.
pub(super) fn with_unit(cell: &str, unit: &str) -> String {
    match cell.parse::<f64>() {
        Ok(_) => format!("{cell} {unit}"),
        Err(_) => cell.to_owned(),
    }
}

pub(super) fn sentence(what: &str, cell: &str, error: &QuantityError) -> String {
    let help = error.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
    let cell: String = cell.chars().take(40).collect();
    format!("the {what} is {cell:?}, but must be {}{help}", error.expected)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::dimension::Force;

    fn points(text: &str) -> Result<Vec<(f64, f64)>, String> {
        parse(text, |value| value.resolve::<Force, NonNegative>().map(|v| v.get()))
    }

    #[test]
    fn separators_headers_and_units() {
        let wanted = Ok(vec![(0.0, 0.0), (10.0, 0.5), (10.0, 0.25)]);
        for text in [
            "0 0\n10 0.5\n10 0.25\n",
            "# a comment\n0,0\n10,0.5 # jump\n\n10,0.25",
            "time [s]; load [mN]\r\n0; 0\r\n10; 500\r\n10; 250;\r\n",
            "t/s\tW/N\n0\t0\n10\t0.5\n10\t0.25",
            "\u{feff}time, load (N)\n0 s, 0 N\n10000 ms, 500 mN\n10, 0.25",
        ] {
            assert_eq!(points(text), wanted, "{text}");
        }
    }

    #[test]
    fn faults_are_named_with_their_line() {
        for (text, words) in [
            ("", "no point"),
            ("time, load\n", "no point"),
            ("1 0\n", "line 1: the first time is 1 s"),
            ("0 0\n2 1\n1 0\n", "line 3: the time 1 s comes after 2 s"),
            ("0 0\n1 2 3\n", "line 2: two columns"),
            ("0\n", "line 1: two columns"),
            ("0, x\n", "the value is \"x\", but must be a force not less than 0"),
            ("0, 1\nheader, again\n", "line 2: the time is \"header\""),
            ("0, nan\n", "line 1: the value is \"nan\""),
            ("0, -1\n", "not less than 0"),
            ("time [m], load [N]\n0, 1\n", "is the unit of a length"),
            ("0, 1e999\n", "too large"),
        ] {
            let message = points(text).unwrap_err();
            assert!(message.contains(words), "{text:?}: {message}");
        }
    }
}
