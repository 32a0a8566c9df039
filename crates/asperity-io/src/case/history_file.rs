//! A history from a file: one point per line, time and value.
//!
//! ```text
//! time [s], load [mN]     optional header with units
//! 0, 0
//! 10, 500                 or with units in the cells: 10 s; 0.5 N
//! ```

use super::place::Place;
use super::small_table::{of_key as file_of_key, rows};
use super::words::number;
use crate::quantity::range::NonNegative;
use crate::quantity::{Prescribed, QuantityError, Time};

const MOST_POINTS: usize = 10_000_000;

/// The points (time \[s\], value in SI) of the file that the key at `at` names.
pub fn of_key(
    at: &Place<'_>,
    path: &str,
    value: &str,
    resolve: impl Fn(&Prescribed) -> Result<f64, QuantityError>,
) -> Option<Vec<(f64, f64)>> {
    file_of_key(at, path, &format!("a file of two columns, time and {value}"), |text| parse(text, resolve))
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
    let mut points: Vec<(f64, f64)> = Vec::new();
    let two = |cells: &[&str]| match cells {
        [time, value] if !time.is_empty() && !value.is_empty() => Ok(()),
        _ => Err("two columns are expected, time and value, as in \"10 s, 0.5 N\"".to_owned()),
    };
    rows(text, two, |row| {
        let time: Time<NonNegative> = row.quantity(0, "time", Prescribed::resolve)?;
        let (time, value) = (time.get(), row.quantity(1, "value", &resolve)?);
        match points.last() {
            None if time != 0.0 => Err(format!("the first time is {time} s; the history must begin at 0 s")),
            Some((before, _)) if time < *before => {
                Err(format!("the time {time} s comes after {before} s; list the points in order"))
            }
            _ if points.len() == MOST_POINTS => Err(format!("there are more than {MOST_POINTS} points")),
            _ => {
                points.push((time, value));
                Ok(())
            }
        }
    })?;
    match points.is_empty() {
        true => Err("there is no point in the file".to_owned()),
        false => Ok(points),
    }
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
