//! Values that are written in one of several forms: a word (or a quantity), a list, or a table.

use std::any::TypeId;
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Unexpected, Visitor};

use super::place::Place;
use crate::quantity::scalar::schema;

/// A word, a list or a table.
#[derive(Clone, Debug)]
pub enum Form<W, L = Never, T = Never> {
    /// A text or a number.
    Word(W),
    /// A list.
    List(L),
    /// A table.
    Table(T),
}

/// What is written as a text or a number where a value has several forms.
pub trait Word {
    /// All forms of the value, for errors.
    const FORMS: &'static str;
    /// Whether its own errors say more.
    const IS_QUANTITY: bool = false;
}

/// A form that a value does not have.
#[derive(Clone, Copy, Debug)]
pub enum Never {}

impl<'de> Deserialize<'de> for Never {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(D::Error::custom("another form"))
    }
}

schema!(Never, "Never", { "not": {} });

impl<W: Copy> Form<W, Vec<W>> {
    /// One value, or those of two `bodies`.
    pub fn one_or_two(&self, at: &Place<'_>, bodies: &str) -> Option<(W, Option<W>)> {
        match self {
            Form::Word(one) => Some((*one, None)),
            Form::List(list) => match list[..] {
                [first, second] => Some((first, Some(second))),
                _ => at.wrong(format!("one value, or a list of two, of {bodies}"), ""),
            },
            Form::Table(never) => match *never {},
        }
    }
}

impl<'de, W, L, T> Deserialize<'de> for Form<W, L, T>
where
    W: Deserialize<'de> + Word,
    L: Deserialize<'de> + 'static,
    T: Deserialize<'de> + 'static,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FormVisitor(PhantomData))
    }
}

struct FormVisitor<W, L, T>(PhantomData<Form<W, L, T>>);

impl<W: Word, L, T> FormVisitor<W, L, T> {
    fn word<E: Error>(&self, word: Result<W, E>, found: Unexpected<'_>) -> Result<Form<W, L, T>, E> {
        word.map(Form::Word).map_err(|error| match W::IS_QUANTITY {
            true => error,
            false => E::invalid_value(found, &W::FORMS),
        })
    }
}

impl<'de, W, L, T> Visitor<'de> for FormVisitor<W, L, T>
where
    W: Deserialize<'de> + Word,
    L: Deserialize<'de> + 'static,
    T: Deserialize<'de> + 'static,
{
    type Value = Form<W, L, T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(W::FORMS)
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
        self.word(W::deserialize(text.into_deserializer()), Unexpected::Str(text))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        self.word(W::deserialize(value.into_deserializer()), Unexpected::Float(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        self.word(W::deserialize(value.into_deserializer()), Unexpected::Signed(value))
    }

    fn visit_seq<S: SeqAccess<'de>>(self, list: S) -> Result<Self::Value, S::Error> {
        match is_never::<L>() {
            true => Err(S::Error::invalid_type(Unexpected::Seq, &self)),
            false => L::deserialize(SeqAccessDeserializer::new(list)).map(Form::List),
        }
    }

    fn visit_map<M: MapAccess<'de>>(self, table: M) -> Result<Self::Value, M::Error> {
        match is_never::<T>() {
            true => Err(M::Error::invalid_type(Unexpected::Map, &self)),
            false => T::deserialize(MapAccessDeserializer::new(table)).map(Form::Table),
        }
    }
}

fn is_never<T: 'static>() -> bool {
    TypeId::of::<T>() == TypeId::of::<Never>()
}

impl<W: JsonSchema + 'static, L: JsonSchema + 'static, T: JsonSchema + 'static> JsonSchema for Form<W, L, T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{}Or{}Or{}", W::schema_name(), L::schema_name(), T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut forms = vec![];
        if !is_never::<W>() {
            forms.push(generator.subschema_for::<W>());
        }
        if !is_never::<L>() {
            let mut list = generator.subschema_for::<L>();
            // An empty list says nothing.
            list.insert("minItems".to_owned(), 1.into());
            forms.push(list);
        }
        if !is_never::<T>() {
            forms.push(generator.subschema_for::<T>());
        }
        json_schema!({ "anyOf": forms })
    }
}
