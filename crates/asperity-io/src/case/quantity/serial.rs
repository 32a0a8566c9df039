//! Quantities to and from text files: serde and JSON Schema.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer, Visitor};

use super::range::Range;
use super::{Dimension, Quantity, QuantityError};

impl<'de, D: Dimension, R: Range> Deserialize<'de> for Quantity<D, R> {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        struct QuantityVisitor<D, R>(PhantomData<fn() -> (D, R)>);

        impl<D: Dimension, R: Range> Visitor<'_> for QuantityVisitor<D, R> {
            type Value = Quantity<D, R>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{}", Quantity::<D, R>::expected())
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
                text.parse().map_err(E::custom)
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Self::Value, E> {
                Quantity::new(value).map_err(E::custom)
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Self::Value, E> {
                self.visit_f64(value as f64)
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Self::Value, E> {
                self.visit_f64(value as f64)
            }
        }

        deserializer.deserialize_any(QuantityVisitor(PhantomData))
    }
}

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
            }),
        }
    }
}

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

const PRESCRIBED: &str = "a load (\"0.5 N\", on a line \"2 N/mm\"), a pressure (\"2 MPa\") or an approach (\"1 um\"), as load.control says";

impl<'de> Deserialize<'de> for Prescribed {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        struct PrescribedVisitor;

        impl Visitor<'_> for PrescribedVisitor {
            type Value = Prescribed;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(PRESCRIBED)
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Prescribed, E> {
                Ok(Prescribed::Text(text.to_owned()))
            }

            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Prescribed, E> {
                Ok(Prescribed::Number(value))
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Prescribed, E> {
                Ok(Prescribed::Number(value as f64))
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Prescribed, E> {
                Ok(Prescribed::Number(value as f64))
            }
        }

        deserializer.deserialize_any(PrescribedVisitor)
    }
}

impl JsonSchema for Prescribed {
    fn schema_name() -> Cow<'static, str> {
        "Prescribed".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A force (on a line a force per length), a pressure or a length with its unit, as load.control says; or a bare number in SI.",
            "anyOf": [{ "type": "string", "pattern": NUMBER_WITH_UNIT }, { "type": "number" }],
            "examples": ["0.5 N", "2 MPa", "1 um"],
        })
    }
}

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

impl<'de, const LEAST: u64> Deserialize<'de> for Whole<LEAST> {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        struct WholeVisitor<const LEAST: u64>;

        impl<const LEAST: u64> Visitor<'_> for WholeVisitor<LEAST> {
            type Value = Whole<LEAST>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a whole number, {LEAST} or more")
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Self::Value, E> {
                match value >= LEAST {
                    true => Ok(Whole(value)),
                    false => Err(E::custom(format!("a whole number, {LEAST} or more"))),
                }
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Self::Value, E> {
                match u64::try_from(value) {
                    Ok(value) => self.visit_u64(value),
                    Err(_) => Err(E::custom(format!("a whole number, {LEAST} or more"))),
                }
            }
        }

        deserializer.deserialize_any(WholeVisitor)
    }
}

impl<const LEAST: u64> JsonSchema for Whole<LEAST> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("WholeFrom{LEAST}").into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": LEAST })
    }
}

/// A whole number of either sign.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signed(i32);

impl Signed {
    /// The number.
    pub fn get(self) -> i32 {
        self.0
    }
}

impl<'de> Deserialize<'de> for Signed {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        struct SignedVisitor;

        impl Visitor<'_> for SignedVisitor {
            type Value = Signed;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a whole number")
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Signed, E> {
                i32::try_from(value)
                    .map(Signed)
                    .map_err(|_| E::custom("a whole number between -2147483648 and 2147483647"))
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Signed, E> {
                self.visit_i64(i64::try_from(value).unwrap_or(i64::MAX))
            }
        }

        deserializer.deserialize_any(SignedVisitor)
    }
}

impl JsonSchema for Signed {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "WholeNumber".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer" })
    }
}

/// A name or a number that stands for one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label(String);

impl Label {
    /// The name, or the number in digits.
    pub fn get(&self) -> &str {
        &self.0
    }
}

impl<'de> Deserialize<'de> for Label {
    fn deserialize<S: Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
        struct LabelVisitor;

        impl Visitor<'_> for LabelVisitor {
            type Value = Label;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a name in quotes or a number from 0")
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Label, E> {
                Ok(Label(text.to_owned()))
            }

            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Label, E> {
                Ok(Label(value.to_string()))
            }

            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Label, E> {
                match u64::try_from(value) {
                    Ok(value) => self.visit_u64(value),
                    Err(_) => Err(E::custom("a name in quotes or a number from 0")),
                }
            }
        }

        deserializer.deserialize_any(LabelVisitor)
    }
}

impl JsonSchema for Label {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Label".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, { "type": "integer", "minimum": 0 }] })
    }
}
