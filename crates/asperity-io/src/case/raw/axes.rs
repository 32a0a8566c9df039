//! A value along each direction in which fields vary: `["1 mm", "2 mm"]` on a plane, `["1 mm"]` on a line.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// A list of one value for a line, or of two for a plane: along x and y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axes<A> {
    /// Along x, of a line.
    Line(A),
    /// Along x and y.
    Plane(A, A),
}

impl<A> Axes<A> {
    /// Whether it has one value.
    pub fn is_line(&self) -> bool {
        matches!(self, Axes::Line(_))
    }

    /// Both values, converted; `along_y` stands for the second of a line.
    pub fn map<T>(self, along_y: T, convert: impl Fn(A) -> T) -> [T; 2] {
        match self {
            Axes::Line(x) => [convert(x), along_y],
            Axes::Plane(x, y) => [convert(x), convert(y)],
        }
    }
}

const EXPECTED: &str = "a list of two values in brackets, along x and y, or of one value on a line of cells";

impl<'de, A: Deserialize<'de>> Deserialize<'de> for Axes<A> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AxesVisitor<A>(PhantomData<fn() -> A>);

        impl<'de, A: Deserialize<'de>> Visitor<'de> for AxesVisitor<A> {
            type Value = Axes<A>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }

            fn visit_seq<S: SeqAccess<'de>>(self, mut values: S) -> Result<Axes<A>, S::Error> {
                let wrong = |n| S::Error::invalid_length(n, &EXPECTED);
                let x = values.next_element()?.ok_or_else(|| wrong(0))?;
                let Some(y) = values.next_element()? else { return Ok(Axes::Line(x)) };
                match values.next_element::<IgnoredAny>()? {
                    None => Ok(Axes::Plane(x, y)),
                    Some(_) => Err(wrong(3)),
                }
            }
        }

        deserializer.deserialize_seq(AxesVisitor(PhantomData))
    }
}

impl<A: JsonSchema> JsonSchema for Axes<A> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("AxesOf{}", A::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let item = generator.subschema_for::<A>();
        json_schema!({ "type": "array", "items": item, "minItems": 1, "maxItems": 2 })
    }
}
