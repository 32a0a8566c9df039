//! Lists of two values, and of one value for each direction in which fields vary.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::place::Place;

/// A list of two values: along x and y, or time and value.
#[derive(Clone, Copy, Debug)]
pub struct Two<A, B = A>(pub A, pub B);

impl<A> Two<A> {
    /// Both values, converted.
    pub fn map<T>(self, convert: impl Fn(A) -> T) -> [T; 2] {
        [convert(self.0), convert(self.1)]
    }
}

/// A list of one value for a line (`["1 mm"]`), or of two for a plane, along x and y.
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

    /// The same, where the list has the length that the domain asks for: a `line` or a plane.
    pub fn on<T>(self, at: &Place<'_>, line: bool, along_y: T, convert: impl Fn(A) -> T) -> Option<[T; 2]> {
        if self.is_line() != line {
            return wrong_number(at, line);
        }
        Some(self.map(along_y, convert))
    }
}

/// A list has one value where two are expected, or two where one is.
pub fn wrong_number<T>(at: &Place<'_>, line: bool) -> Option<T> {
    match line {
        true => at.wrong(
            "a list of one value",
            "the domain is a line of cells: give the value along x; a plane has two values in domain.cells and domain.size",
        ),
        false => at.wrong(
            "a list of two values, along x and y",
            "one value is for a line contact, which has one value in domain.cells and domain.size too",
        ),
    }
}

const TWO: &str = "a list of two values in brackets";
const AXES: &str = "a list of two values in brackets, along x and y, or of one value on a line of cells";

impl<'de, A: Deserialize<'de>, B: Deserialize<'de>> Deserialize<'de> for Two<A, B> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let make = |first, second: Option<B>| Some(Two(first, second?));
        deserializer.deserialize_seq(Reader { expected: TWO, make, kinds: PhantomData })
    }
}

impl<'de, A: Deserialize<'de>> Deserialize<'de> for Axes<A> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let make = |x, y| match y {
            None => Some(Axes::Line(x)),
            Some(y) => Some(Axes::Plane(x, y)),
        };
        deserializer.deserialize_seq(Reader { expected: AXES, make, kinds: PhantomData })
    }
}

/// How a list of one or two values is read.
struct Reader<F, A, B> {
    expected: &'static str,
    make: F,
    kinds: PhantomData<fn() -> (A, B)>,
}

impl<'de, F, A, B, T> Visitor<'de> for Reader<F, A, B>
where
    F: Fn(A, Option<B>) -> Option<T>,
    A: Deserialize<'de>,
    B: Deserialize<'de>,
{
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.expected)
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut values: S) -> Result<T, S::Error> {
        let wrong = |n| S::Error::invalid_length(n, &self.expected);
        let first = values.next_element()?.ok_or_else(|| wrong(0))?;
        let second = values.next_element()?;
        match values.next_element::<IgnoredAny>()? {
            None => (self.make)(first, second).ok_or_else(|| wrong(1)),
            Some(_) => Err(wrong(3)),
        }
    }
}

impl<A: JsonSchema, B: JsonSchema> JsonSchema for Two<A, B> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{}And{}", A::schema_name(), B::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let items = [generator.subschema_for::<A>(), generator.subschema_for::<B>()];
        json_schema!({ "type": "array", "prefixItems": items, "minItems": 2, "maxItems": 2 })
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
