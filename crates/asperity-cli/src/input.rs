//! Words of the command line: quantities, and names that are misspelt.

use std::ffi::OsStr;
use std::fmt::Display;
use std::marker::PhantomData;
use std::str::FromStr;

use asperity_io::quantity::range::Range;
use asperity_io::quantity::{Angle, Dimension, Quantity, Temperature};
use clap::builder::TypedValueParser;
use clap::error::ErrorKind;
use clap::{Arg, Command};

use crate::failure::Failure;

/// A quantity that an option takes.
pub trait Measured: FromStr<Err: Display> + Clone + Send + Sync + 'static {
    /// The unit of a number without one; empty for a pure number.
    const UNIT: &'static str;
}

impl<D: Dimension + Clone + 'static, R: Range + Clone + 'static> Measured for Quantity<D, R> {
    const UNIT: &'static str = D::SI;
}

impl Measured for Angle {
    // It needs one.
    const UNIT: &'static str = "";
}

impl Measured for Temperature {
    const UNIT: &'static str = "K";
}

/// The parser of an option that takes a quantity.
#[derive(Clone)]
pub struct QuantityParser<Q>(PhantomData<fn() -> Q>);

/// The parser of an option that takes this quantity.
pub fn quantity<Q: Measured>() -> QuantityParser<Q> {
    QuantityParser(PhantomData)
}

impl<Q: Measured> TypedValueParser for QuantityParser<Q> {
    type Value = Q;

    fn parse_ref(&self, _: &Command, arg: Option<&Arg>, text: &OsStr) -> Result<Q, clap::Error> {
        let option = arg.and_then(Arg::get_long).unwrap_or_default();
        parse(&format!("--{option}"), &text.to_string_lossy())
            .map_err(|message| clap::Error::raw(ErrorKind::ValueValidation, message + "\n"))
    }
}

/// The quantity in the text of an option.
pub fn read<Q: Measured>(option: &str, text: &str) -> Result<Q, Failure> {
    parse(option, text).map_err(Failure::Input)
}

fn parse<Q: Measured>(option: &str, text: &str) -> Result<Q, String> {
    let text = text.trim();
    let quantity = text.parse().map_err(|error| format!("{option} is \"{text}\", but must be {error}"))?;
    note_unit(option, text, Q::UNIT);
    Ok(quantity)
}

/// Notes which unit is assumed for a number without a unit.
pub fn note_unit(option: &str, text: &str, unit: &str) {
    let is_bare = text.trim().parse::<f64>().is_ok_and(|number| number != 0.0 && number.is_finite());
    if is_bare && !unit.is_empty() {
        crate::messages::message!("note: {option} {text} has no unit and is taken as {text} {unit}");
    }
}

/// A message about keys of a case with the options that give these keys: `roll_off` becomes --roll-off.
pub fn with_options(message: &str) -> String {
    let parts = message.split('`').enumerate();
    parts.map(|(n, part)| if n % 2 == 1 { option(part) } else { part.to_owned() }).collect()
}

/// The option that gives a key; of an element of a list, "depths[0]", that of the list.
pub fn option(key: &str) -> String {
    format!("--{}", key.split('[').next().unwrap_or(key).replace(['_', '.'], "-"))
}

/// " (did you mean "pressure"?)" of a misspelt name; empty where none of the known ones is near.
pub fn meant(name: &str, known: &[&str]) -> String {
    asperity_io::case::nearest(name, known)
        .map_or(String::new(), |near| format!(" (did you mean \"{near}\"?)"))
}
