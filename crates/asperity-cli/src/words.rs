//! Numbers as a person reads and writes them.

use asperity::march::Row;
pub use asperity_io::readable::{bytes, coordinate, counted, duration, quantity};

use crate::failure::Failure;

/// The mean pressure over the contact [Pa]; 0 where nothing touches.
pub fn in_contact(row: &Row) -> f64 {
    if row.contact_fraction > 0.0 { row.mean_pressure / row.contact_fraction } else { 0.0 }
}

/// A quantity of the command line; `example` shows how the flag is used.
pub fn read<Q: std::str::FromStr<Err: std::fmt::Display>>(
    flag: &str,
    text: &str,
    example: &str,
) -> Result<Q, Failure> {
    let told =
        |error| Failure::input(format!("{flag} is \"{text}\": {error}; write e.g. {flag} '{example}'"));
    text.trim().parse().map_err(told)
}

/// " (did you mean "pressure"?)" of a misspelt name; empty where none of the known ones is near.
pub fn meant(name: &str, known: &[&str]) -> String {
    asperity_io::case::nearest(name, known)
        .map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)"))
}

/// The mean gap \[m\] of a row, 0 where it is the rounding error of a full contact.
pub fn mean_gap(row: &Row) -> f64 {
    const ROUNDING: f64 = 1e-12;
    if row.mean_gap.abs() < ROUNDING * row.approach.abs() { 0.0 } else { row.mean_gap }
}
