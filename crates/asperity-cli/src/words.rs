//! Numbers as a person reads and writes them.

use asperity::march::Row;
pub use asperity_io::readable::{bytes, counted, duration, quantity};

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
