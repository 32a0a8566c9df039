//! Quantities to and from text files: serde and JSON Schema.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};

use super::range::Range;
use super::scalar::{Scalar, deserialize, schema};
use super::{Dimension, Quantity, QuantityError};

impl<D: Dimension, R: Range> Scalar for Quantity<D, R> {
    fn expected() -> String {
        Quantity::<D, R>::expected()
    }

    fn from_text(text: &str) -> Result<Self, QuantityError> {
        text.parse()
    }

    fn from_number(value: f64) -> Result<Self, QuantityError> {
        Quantity::new(value)
    }
}

deserialize!(Quantity<D, R>, D: Dimension, R: Range);

impl<D: Dimension, R: Range> JsonSchema for Quantity<D, R> {
    fn schema_name() -> Cow<'static, str> {
        match D::SI.is_empty() && !R::TITLE.is_empty() {
            true => format!("{}Number", R::TITLE).into(),
            false => format!("{}{}", R::TITLE, D::TITLE).into(),
        }
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut number = json_schema!({ "type": "number" });
        R::limit(&mut number);
        let range = if R::WORDS.is_empty() { String::new() } else { format!(" {}", R::WORDS) };
        let example = R::EXAMPLE.unwrap_or(D::EXAMPLE);
        match D::SI.is_empty() {
            true => json_schema!({
                "description": format!("{}{range}.", capital(D::NAME)),
                "anyOf": [number, { "type": "string", "pattern": NUMBER_WITH_UNIT }],
                "examples": [example.parse::<f64>().unwrap_or_default()],
            }),
            false => json_schema!({
                "description": format!(
                    "{}{range}: text with its unit ({}), or a bare number in {}.",
                    capital(D::NAME), D::UNITS, D::SI
                ),
                "anyOf": [{ "type": "string", "pattern": NUMBER_WITH_UNIT }, number],
                "examples": [example],
                UNIT: D::SI,
            }),
        }
    }
}

/// The key of a schema that says the SI unit of a quantity.
pub const UNIT: &str = "x-unit";

const NUMBER_WITH_UNIT: &str = r"^\s*[+-]?(inf|[0-9]+\.?[0-9]*|\.[0-9]+)";

fn capital(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map(|c| c.to_uppercase().chain(characters).collect()).unwrap_or_default()
}

/// A value whose dimension another key decides: a load \[N\], on a line \[N/m\], a mean pressure \[Pa\] or an approach \[m\].
#[derive(Clone, Debug, PartialEq)]
pub enum Prescribed {
    /// A bare number, in SI.
    Number(f64),
    /// Text with a unit.
    Text(String),
}

impl Prescribed {
    /// The value as a quantity of dimension `D`.
    ///
    /// # Errors
    /// [`QuantityError`] for another dimension, a text that is no quantity or a value outside `R`.
    pub fn resolve<D: Dimension, R: Range>(&self) -> Result<Quantity<D, R>, QuantityError> {
        match self {
            Prescribed::Number(value) => Quantity::new(*value),
            Prescribed::Text(text) => text.parse(),
        }
    }
}

impl Scalar for Prescribed {
    fn expected() -> String {
        "a load (\"0.5 N\", on a line \"2 N/mm\"), a pressure (\"2 MPa\") or an approach (\"1 um\"), as load.control says"
            .to_owned()
    }

    fn from_text(text: &str) -> Result<Self, QuantityError> {
        Ok(Prescribed::Text(text.to_owned()))
    }

    fn from_number(value: f64) -> Result<Self, QuantityError> {
        Ok(Prescribed::Number(value))
    }
}

deserialize!(Prescribed);

schema!(Prescribed, "Prescribed", {
    "description": "A force (on a line a force per length), a pressure or a length with its unit, as load.control says; or a bare number in SI.",
    "anyOf": [{ "type": "string", "pattern": NUMBER_WITH_UNIT }, { "type": "number" }],
    "examples": ["0.5 N", "2 MPa", "1 um"],
    UNIT: "N, N/m, Pa or m",
});

/// A whole number, `LEAST` or more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Whole<const LEAST: u64>(u64);

impl<const LEAST: u64> Whole<LEAST> {
    /// The number.
    pub fn get(self) -> u64 {
        self.0
    }

    /// The number as a count; what no machine can hold becomes the largest count, which the checks refuse.
    pub fn count(self) -> usize {
        usize::try_from(self.0).unwrap_or(usize::MAX)
    }
}

impl<const LEAST: u64> Scalar for Whole<LEAST> {
    fn expected() -> String {
        format!("a whole number, {LEAST} or more")
    }

    fn from_whole(value: i64) -> Result<Self, QuantityError> {
        let value = u64::try_from(value).ok().filter(|value| *value >= LEAST);
        value.map(Whole).ok_or_else(Self::out_of_range)
    }
}

deserialize!(Whole<LEAST>, const LEAST: u64);

schema!(Whole<LEAST>, format!("WholeFrom{LEAST}"), { "type": "integer", "minimum": LEAST }, const LEAST: u64);

/// A whole number of either sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signed(i32);

impl Signed {
    /// The number.
    pub fn get(self) -> i32 {
        self.0
    }
}

impl Scalar for Signed {
    fn expected() -> String {
        "a whole number between -2147483648 and 2147483647".to_owned()
    }

    fn from_whole(value: i64) -> Result<Self, QuantityError> {
        i32::try_from(value).map(Signed).map_err(|_| Self::out_of_range())
    }
}

deserialize!(Signed);

schema!(Signed, "WholeNumber", { "type": "integer" });

/// A name or a number that stands for one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label(String);

impl Label {
    /// The name, or the number in digits.
    pub fn get(&self) -> &str {
        &self.0
    }
}

impl Scalar for Label {
    fn expected() -> String {
        "a name in quotes, or a number counted from 0".to_owned()
    }

    fn from_text(text: &str) -> Result<Self, QuantityError> {
        Ok(Label(text.to_owned()))
    }

    fn from_whole(value: i64) -> Result<Self, QuantityError> {
        u64::try_from(value).map(|value| Label(value.to_string())).map_err(|_| Self::out_of_range())
    }
}

deserialize!(Label);

schema!(Label, "Label", { "anyOf": [{ "type": "string" }, { "type": "integer", "minimum": 0 }] });
