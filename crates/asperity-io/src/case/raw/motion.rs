//! `[motion]`: a contact that slides or rolls.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{
    Error, MapAccess, SeqAccess, Visitor, value::MapAccessDeserializer, value::SeqAccessDeserializer,
};
use serde::{Deserialize, Deserializer};

use super::{At, History};
use crate::case::quantity::range::{NonNegative, Positive};
use crate::case::quantity::{Angle, Number, Pressure, Time, Velocity, Whole};

/// How the contact moves over the bodies.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Velocity of the contact over the body: a constant, or a history as in `[load]`. This, `path` or `steady`.
    #[schemars(example = "10 mm/s")]
    pub velocity: Option<At<Speed>>,
    /// Position of the contact over time, as a history that begins with 0. This, `velocity` or `steady`.
    #[schemars(example = serde_json::json!({ "kind": "table", "points": [["0 s", "0 mm"], ["2 s", "1 mm"]] }))]
    pub path: Option<At<History>>,
    /// One steady state for each of some velocities, without `[time]`. This, `velocity` or `path`.
    #[schemars(example = serde_json::json!({ "velocities": ["1 mm/s", "10 mm/s"] }))]
    pub steady: Option<At<Steady>>,
    /// "slide" (the contact moves over the body `over`) or "roll" (over both bodies); "slide" if not given.
    #[serde(default)]
    pub kind: MotionKind,
    /// Name of the body that the contact slides over, and that the grid is fixed to; the first viscoelastic one if not given.
    #[schemars(example = &"rubber")]
    pub over: Option<At<String>>,
    /// Direction of the velocity: "x", "y", or an angle from x towards y on periodic domains; "x" if not given.
    #[schemars(example = "30 deg")]
    pub direction: Option<At<Heading>>,
    /// The motion begins at this time; 0 if not given.
    #[schemars(example = "1 s")]
    pub start: Option<At<Time<NonNegative>>>,
    /// Cells that the contact moves in a time step, at most; 1 if not given.
    #[schemars(example = 1)]
    pub cells_per_step: Option<At<Number<Positive>>>,
    /// Shear stress on the area in contact: its share is added in `friction_coefficient_total`.
    #[schemars(example = "0.2 MPa")]
    pub shear_stress: Option<Pressure<NonNegative>>,
}

/// What the contact moves over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MotionKind {
    /// One of the bodies.
    #[default]
    Slide,
    /// Both bodies.
    Roll,
}

/// Steady states.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Steady {
    /// The velocities: a list, or a range.
    #[schemars(example = serde_json::json!({ "from": "1 um/s", "to": "1 m/s", "count": 31, "spacing": "log" }))]
    pub velocities: At<Velocities>,
}

/// A range of velocities.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Range {
    /// The first.
    #[schemars(example = "1 um/s")]
    pub from: Velocity<Positive>,
    /// The last.
    #[schemars(example = "1 m/s")]
    pub to: Velocity<Positive>,
    /// How many.
    #[schemars(example = 31)]
    pub count: At<Whole<1>>,
    /// "log" or "linear"; "log" if not given.
    #[serde(default)]
    pub spacing: RangeSpacing,
}

/// How a range is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum RangeSpacing {
    /// By equal ratios.
    #[default]
    Log,
    /// By equal differences.
    Linear,
}

/// Some velocities.
#[derive(Debug)]
pub enum Velocities {
    List(Vec<At<Velocity<NonNegative>>>),
    Range(Range),
}

impl<'de> Deserialize<'de> for Velocities {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListOrRange;

        impl<'de> Visitor<'de> for ListOrRange {
            type Value = Velocities;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of velocities, or { from, to, count, spacing }")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Velocities, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Velocities::List)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Velocities, A::Error> {
                Range::deserialize(MapAccessDeserializer::new(map)).map(Velocities::Range)
            }
        }

        deserializer.deserialize_any(ListOrRange)
    }
}

impl JsonSchema for Velocities {
    fn schema_name() -> Cow<'static, str> {
        "Velocities".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let list = generator.subschema_for::<Vec<Velocity<NonNegative>>>();
        let range = generator.subschema_for::<Range>();
        json_schema!({ "anyOf": [list, range] })
    }
}

/// A velocity that is constant, or one over time.
#[derive(Debug)]
pub enum Speed {
    Constant(Velocity),
    History(Box<History>),
}

impl<'de> Deserialize<'de> for Speed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TextOrHistory;

        impl<'de> Visitor<'de> for TextOrHistory {
            type Value = Speed;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a velocity such as \"10 mm/s\", or a history such as { kind = \"ramp\", ... }")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Speed, E> {
                Velocity::deserialize(serde::de::value::StrDeserializer::new(text)).map(Speed::Constant)
            }

            fn visit_f64<E: Error>(self, number: f64) -> Result<Speed, E> {
                Velocity::deserialize(serde::de::value::F64Deserializer::new(number)).map(Speed::Constant)
            }

            fn visit_i64<E: Error>(self, number: i64) -> Result<Speed, E> {
                Velocity::deserialize(serde::de::value::I64Deserializer::new(number)).map(Speed::Constant)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Speed, A::Error> {
                History::deserialize(MapAccessDeserializer::new(map))
                    .map(|history| Speed::History(history.into()))
            }
        }

        deserializer.deserialize_any(TextOrHistory)
    }
}

impl JsonSchema for Speed {
    fn schema_name() -> Cow<'static, str> {
        "Speed".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (constant, history) =
            (generator.subschema_for::<Velocity>(), generator.subschema_for::<History>());
        json_schema!({ "anyOf": [constant, history] })
    }
}

/// "x", "y", or an angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Heading {
    X,
    Y,
    Angle(f64),
}

impl<'de> Deserialize<'de> for Heading {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Word;

        impl Visitor<'_> for Word {
            type Value = Heading;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"x\", \"y\", or an angle such as \"30 deg\"")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Heading, E> {
                match word {
                    "x" => Ok(Heading::X),
                    "y" => Ok(Heading::Y),
                    _ => word
                        .parse::<Angle>()
                        .map(|angle| Heading::Angle(angle.get()))
                        .map_err(|_| E::invalid_value(serde::de::Unexpected::Str(word), &self)),
                }
            }

            fn visit_f64<E: Error>(self, angle: f64) -> Result<Heading, E> {
                Ok(Heading::Angle(angle))
            }

            fn visit_i64<E: Error>(self, angle: i64) -> Result<Heading, E> {
                Ok(Heading::Angle(angle as f64))
            }
        }

        deserializer.deserialize_any(Word)
    }
}

impl JsonSchema for Heading {
    fn schema_name() -> Cow<'static, str> {
        "Heading".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let angle = generator.subschema_for::<Angle>();
        json_schema!({ "anyOf": [{ "enum": ["x", "y"] }, angle] })
    }
}
