//! Words of the command line: quantities, and names that are misspelt.

use crate::failure::Failure;

/// A quantity of the command line; `example` shows how the flag is used.
pub fn read<Q: std::str::FromStr<Err: std::fmt::Display>>(
    flag: &str,
    text: &str,
    example: &str,
) -> Result<Q, Failure> {
    let failed =
        |error| Failure::input(format!("{flag} is \"{text}\": {error}; write e.g. {flag} '{example}'"));
    text.trim().parse().map_err(failed)
}

/// " (did you mean "pressure"?)" of a misspelt name; empty where none of the known ones is near.
pub fn meant(name: &str, known: &[&str]) -> String {
    asperity_io::case::nearest(name, known)
        .map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)"))
}
