//! Values that are written in one of several forms: a word (or a quantity), a list, or a table.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, de};

/// A word, a list or a table.
#[derive(Clone, Debug)]
pub enum Form<W, L = Never, T = Never> {
    Word(W),
    List(L),
    Table(T),
}

/// A form that a value does not have.
#[derive(Clone, Copy, Debug)]
pub enum Never {}

impl<'de> Deserialize<'de> for Never {
    fn deserialize<D: Deserializer<'de>>(_: D) -> Result<Self, D::Error> {
        Err(D::Error::custom("another form"))
    }
}

impl JsonSchema for Never {
    fn schema_name() -> Cow<'static, str> {
        "Never".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        false.into()
    }
}

impl<'de, W, L, T> Deserialize<'de> for Form<W, L, T>
where
    W: Deserialize<'de> + JsonSchema,
    L: Deserialize<'de> + JsonSchema,
    T: Deserialize<'de> + JsonSchema,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(FormVisitor(PhantomData))
    }
}

struct FormVisitor<W, L, T>(PhantomData<fn() -> Form<W, L, T>>);

impl<'de, W, L, T> Visitor<'de> for FormVisitor<W, L, T>
where
    W: Deserialize<'de> + JsonSchema,
    L: Deserialize<'de> + JsonSchema,
    T: Deserialize<'de> + JsonSchema,
{
    type Value = Form<W, L, T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let forms = [
            (W::schema_name(), "a word or quantity in quotes"),
            (L::schema_name(), "a list in brackets"),
            (T::schema_name(), "a table in braces"),
        ];
        let never = Never::schema_name();
        let forms: Vec<&str> = forms.iter().filter(|form| form.0 != never).map(|form| form.1).collect();
        f.write_str(&forms.join(" or "))
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<Self::Value, E> {
        match is_never::<W>() {
            true => Err(E::invalid_type(de::Unexpected::Str(text), &self)),
            false => W::deserialize(text.into_deserializer()).map(Form::Word),
        }
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        W::deserialize(value.into_deserializer()).map(Form::Word)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        W::deserialize(value.into_deserializer()).map(Form::Word)
    }

    fn visit_seq<S: SeqAccess<'de>>(self, list: S) -> Result<Self::Value, S::Error> {
        match is_never::<L>() {
            true => Err(S::Error::invalid_type(de::Unexpected::Seq, &self)),
            false => L::deserialize(SeqAccessDeserializer::new(list)).map(Form::List),
        }
    }

    fn visit_map<M: MapAccess<'de>>(self, table: M) -> Result<Self::Value, M::Error> {
        match is_never::<T>() {
            true => Err(M::Error::invalid_type(de::Unexpected::Map, &self)),
            false => T::deserialize(MapAccessDeserializer::new(table)).map(Form::Table),
        }
    }
}

fn is_never<T: JsonSchema>() -> bool {
    T::schema_name() == Never::schema_name()
}

impl<W: JsonSchema, L: JsonSchema, T: JsonSchema> JsonSchema for Form<W, L, T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{}Or{}Or{}", W::schema_name(), L::schema_name(), T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut forms = vec![];
        for (never, form) in [
            (is_never::<W>(), SchemaGenerator::subschema_for::<W> as fn(&mut SchemaGenerator) -> Schema),
            (is_never::<L>(), SchemaGenerator::subschema_for::<L>),
            (is_never::<T>(), SchemaGenerator::subschema_for::<T>),
        ] {
            if !never {
                forms.push(form(generator));
            }
        }
        json_schema!({ "anyOf": forms })
    }
}
