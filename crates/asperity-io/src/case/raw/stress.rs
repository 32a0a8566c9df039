//! `[stress]`: the stress below the surface.

use std::borrow::Cow;
use std::fmt;

use asperity::stress::{Rolling, StressQuantity};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::{At, StoredTimes};
use crate::case::quantity::range::{NonNegative, Positive};
use crate::case::quantity::{Length, Pressure, Whole};

/// The stress below the surface, from the stored pressures.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stress {
    /// Depths below the surface, each 0 or at least a quarter of a cell; "auto" if not given.
    #[schemars(example = &"auto", example = ("0 um", "5 um", "10 um"))]
    #[schemars(example = serde_json::json!({ "from": "1 um", "to": "200 um", "count": 24, "spacing": "log" }))]
    pub depths: Option<At<Depths>>,
    /// The body whose stress is computed: its name, or its number counted from 0; the first if not given.
    #[schemars(example = &"PMMA")]
    pub body: Option<At<Which>>,
    /// Stress fields that are stored at each depth; none if not given (the largest values and the profile over depth are
    /// always stored).
    #[schemars(example = ("mises",))]
    pub components: Option<Vec<At<StressQuantity>>>,
    /// The volume in which the von Mises stress is above this threshold is measured.
    #[schemars(example = "100 MPa")]
    pub threshold: Option<Pressure<Positive>>,
    /// Yield stress of the body, in tension: first yield is reported where the von Mises stress reaches it. (The hardness
    /// limits the pressure, and is about 2.8 times the yield stress of a metal.)
    #[schemars(example = "110 MPa")]
    pub yield_stress: Option<Pressure<Positive>>,
    /// Direction in which the contact rolls: the range of the orthogonal shear stress along it is found.
    pub rolling: Option<At<Rolling>>,
    /// Times at which the stress is computed: "fields", as the fields are stored; "all", which needs output.every = 1; or a
    /// list of times that are stored. "fields" if not given.
    #[schemars(example = &"fields", example = ("1 s", "10 s"))]
    pub times: Option<At<StoredTimes>>,
}

/// Depths below the surface.
#[derive(Debug)]
pub enum Depths {
    /// 0, and 24 depths from half a cell to the width of the contact (periodic: to half the shorter side).
    Auto,
    /// A list, rising.
    List(Vec<At<Length<NonNegative>>>),
    /// A row of depths.
    Row(Row),
}

/// A row of depths; the surface itself is added.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "RowOfDepths")]
pub struct Row {
    /// First depth below the surface.
    #[schemars(example = "1 um")]
    pub from: At<Length<Positive>>,
    /// Last depth.
    #[schemars(example = "200 um")]
    pub to: At<Length<Positive>>,
    /// Number of depths.
    #[schemars(example = 24)]
    pub count: At<Whole<2>>,
    /// "log" for a constant ratio of neighbouring depths, "uniform" for a constant distance; "log" if not given.
    pub spacing: Option<Progression>,
}

/// How depths follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Progression {
    /// Constant ratio.
    Log,
    /// Constant distance.
    Uniform,
}

/// A body by its name or number.
#[derive(Clone, Debug, PartialEq)]
pub enum Which {
    Name(String),
    Number(u64),
}

const DEPTHS: &str = "\"auto\", a list of lengths, or a table { from, to, count, spacing }";
const WHICH: &str = "the name of a body, or its number counted from 0";

impl<'de> Deserialize<'de> for Depths {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Words;

        impl<'de> Visitor<'de> for Words {
            type Value = Depths;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(DEPTHS)
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Depths, E> {
                if word == "auto" { Ok(Depths::Auto) } else { Err(E::custom(DEPTHS)) }
            }

            fn visit_seq<S: SeqAccess<'de>>(self, list: S) -> Result<Depths, S::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Depths::List)
            }

            fn visit_map<M: MapAccess<'de>>(self, table: M) -> Result<Depths, M::Error> {
                Row::deserialize(MapAccessDeserializer::new(table)).map(Depths::Row)
            }
        }

        deserializer.deserialize_any(Words)
    }
}

impl JsonSchema for Depths {
    fn schema_name() -> Cow<'static, str> {
        "Depths".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                {
                    "type": "string", "const": "auto",
                    "description": "0, and 24 depths from half a cell to the width of the contact (periodic: to half the shorter side)."
                },
                { "type": "array", "minItems": 1, "items": generator.subschema_for::<Length<NonNegative>>() },
                generator.subschema_for::<Row>(),
            ],
        })
    }
}

impl<'de> Deserialize<'de> for Which {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NameOrNumber;

        impl Visitor<'_> for NameOrNumber {
            type Value = Which;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(WHICH)
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<Which, E> {
                Ok(Which::Name(name.to_owned()))
            }

            fn visit_u64<E: Error>(self, number: u64) -> Result<Which, E> {
                Ok(Which::Number(number))
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Which, E> {
                u64::try_from(number).map(Which::Number).map_err(|_| E::custom(WHICH))
            }
        }

        deserializer.deserialize_any(NameOrNumber)
    }
}

impl JsonSchema for Which {
    fn schema_name() -> Cow<'static, str> {
        "NameOrNumber".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "string" }, { "type": "integer", "minimum": 0 }] })
    }
}
