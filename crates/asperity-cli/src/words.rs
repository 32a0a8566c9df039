//! Numbers as a person reads and writes them.

pub use asperity_io::readable::{bytes, counted, duration, quantity};

use crate::failure::Failure;

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
