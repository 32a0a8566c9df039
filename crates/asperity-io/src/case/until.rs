//! `load.stages[].until`: what ends a stage.

use std::borrow::Cow;
use std::fmt;
use std::sync::LazyLock;

use asperity::Grid;
use asperity::quantities::RowNumber;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::{self, EnumAccess, VariantAccess};
use serde_json::{Value, json};

use super::keys::*;

/// What ends a stage.
#[derive(Debug)]
pub enum Until {
    /// The contact is lost.
    ContactLost,
    /// The approach crosses a value.
    Approach(Length),
    /// The load crosses a value.
    Load(Prescribed),
    /// The mean pressure crosses a value.
    Pressure(Pressure<Finite>),
    /// Another number of the rows crosses a value.
    Number(RowNumber, Prescribed),
}

/// The names of a case file.
static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| {
    let own = ["contact-lost", "approach", "load", "pressure"];
    let others = RowNumber::all().map(RowNumber::name).filter(|name| !own.contains(name));
    own.into_iter().chain(others).collect()
});

impl<'de> Deserialize<'de> for Until {
    fn deserialize<D: de::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_enum("Until", &NAMES, Visitor)
    }
}

struct Visitor;

impl<'de> de::Visitor<'de> for Visitor {
    type Value = Until;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"contact-lost\", or a number of the rows with its value")
    }

    fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<Until, A::Error> {
        let (name, value): (String, _) = data.variant()?;
        match name.as_str() {
            "contact-lost" => value.unit_variant().map(|()| Until::ContactLost),
            "approach" => value.newtype_variant().map(Until::Approach),
            "load" => value.newtype_variant().map(Until::Load),
            "pressure" => value.newtype_variant().map(Until::Pressure),
            name => match RowNumber::from_name(name) {
                Some(number) => value.newtype_variant().map(|value| Until::Number(number, value)),
                None => Err(de::Error::unknown_variant(name, &NAMES)),
            },
        }
    }
}

/// The value in SI, in the unit that the number has in results; on a `line` forces are per length, areas lengths.
pub fn resolve(number: RowNumber, value: &Prescribed, line: bool) -> Result<f64, QuantityError> {
    let units = match Grid::line(1, 1.0) {
        Ok(grid) if line => number.units_on(&grid),
        _ => number.units(),
    };
    let known = match units {
        "N/m2" => "Pa",
        "J/m" => "N",
        units => units,
    };
    dimension::resolve::<Finite>(known, value)
}

impl JsonSchema for Until {
    fn schema_name() -> Cow<'static, str> {
        "Until".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let own = [
            ("approach", "The approach crosses a value.", generator.subschema_for::<Length>()),
            ("load", "The load crosses a value.", generator.subschema_for::<Prescribed>()),
            ("pressure", "The mean pressure crosses a value.", generator.subschema_for::<Pressure<Finite>>()),
        ]
        .map(|(name, words, schema)| member(name, words.to_owned(), schema.into()));
        let others =
            RowNumber::all().filter(|number| !["approach", "load"].contains(&number.name())).map(|number| {
                let unit =
                    if number.units() == "1" { String::new() } else { format!(" [{}]", number.units()) };
                let words = format!("The number \"{}\"{unit} crosses a value.", number.long_name());
                member(number.name(), words.clone(), json!({ "description": words, "type": ["string", "number"], "examples": [example(number)] }))
            });
        let lost =
            json!({ "type": "string", "const": "contact-lost", "description": "The contact is lost." });
        let all: Vec<Value> = std::iter::once(lost).chain(own).chain(others).collect();
        json_schema!({ "description": "What ends a stage.", "oneOf": all })
    }
}

fn example(number: RowNumber) -> Value {
    match number.units() {
        "1" => json!(0.1),
        units => json!(format!("1 {units}")),
    }
}

fn member(name: &str, words: String, schema: Value) -> Value {
    json!({
        "type": "object",
        "description": words,
        "properties": { name: schema },
        "required": [name],
        "additionalProperties": false,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_the_rows_takes_a_value_in_its_own_unit() {
        for number in RowNumber::all() {
            let value = match number.units() {
                "1" | "1/m" => Prescribed::Number(2.0),
                unit => Prescribed::Text(format!("2 {unit}")),
            };
            assert_eq!(resolve(number, &value, false), Ok(2.0), "{}", number.name());
        }
    }
}
