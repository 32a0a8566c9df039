//! Times of the stored fields, of which stress and leakage are computed.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::At;
use crate::case::quantity::Time;
use crate::case::quantity::range::NonNegative;

/// Stored times at which something is computed from the fields.
#[derive(Debug)]
pub enum StoredTimes {
    /// Those of the stored fields.
    Fields,
    /// All rows, which must have stored fields.
    All,
    /// These.
    List(Vec<At<Time<NonNegative>>>),
}

const TIMES: &str = "\"fields\", \"all\" or a list of times";

impl<'de> Deserialize<'de> for StoredTimes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;

        impl<'de> Visitor<'de> for Words {
            type Value = StoredTimes;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(TIMES)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<StoredTimes, E> {
                match word {
                    "fields" => Ok(StoredTimes::Fields),
                    "all" => Ok(StoredTimes::All),
                    _ => Err(E::custom(TIMES)),
                }
            }

            fn visit_seq<S: SeqAccess<'de>>(self, list: S) -> Result<StoredTimes, S::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(StoredTimes::List)
            }
        }

        deserializer.deserialize_any(Words)
    }
}

impl JsonSchema for StoredTimes {
    fn schema_name() -> Cow<'static, str> {
        "StoredTimes".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                { "type": "string", "const": "fields", "description": "The times of the stored fields." },
                { "type": "string", "const": "all", "description": "All rows; needs output.every = 1." },
                { "type": "array", "minItems": 1, "items": generator.subschema_for::<Time<NonNegative>>() },
            ],
        })
    }
}
