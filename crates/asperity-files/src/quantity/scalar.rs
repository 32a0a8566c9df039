//! Values that are a text or a number in a file: one visitor for all of them.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserializer, Error, Visitor};

use super::QuantityError;
use crate::Code;

/// A type that serde reads from a text or a number.
pub trait Scalar: Sized {
    /// What is accepted, for errors.
    fn expected() -> String;

    /// The value of a text.
    ///
    /// # Errors
    /// What is accepted, and what is wrong with the text.
    fn from_text(_: &str) -> Result<Self, QuantityError> {
        Err(Self::error())
    }

    /// The value of a number.
    ///
    /// # Errors
    /// As [`from_text`](Self::from_text).
    fn from_number(_: f64) -> Result<Self, QuantityError> {
        Err(Self::error())
    }

    /// The value of a whole number.
    ///
    /// # Errors
    /// As [`from_text`](Self::from_text).
    fn from_whole(value: i64) -> Result<Self, QuantityError> {
        Self::from_number(value as f64)
    }

    /// A value of another type, or none of the words.
    fn error() -> QuantityError {
        QuantityError { code: Code::WrongType, expected: Self::expected(), help: None }
    }

    /// A number outside the range.
    fn out_of_range() -> QuantityError {
        QuantityError { code: Code::OutOfRange, ..Self::error() }
    }
}

/// Reads a scalar.
///
/// # Errors
/// What is accepted, what is wrong with the value, and the [`Code`].
pub fn scalar<'de, T: Scalar, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    deserializer.deserialize_any(ScalarVisitor(PhantomData))
}

struct ScalarVisitor<T>(PhantomData<fn() -> T>);

impl<T: Scalar> Visitor<'_> for ScalarVisitor<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&T::expected())
    }

    fn visit_str<E: Error>(self, text: &str) -> Result<T, E> {
        T::from_text(text).map_err(custom)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<T, E> {
        T::from_number(value).map_err(custom)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<T, E> {
        T::from_whole(value).map_err(custom)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<T, E> {
        self.visit_i64(i64::try_from(value).unwrap_or(i64::MAX))
    }
}

/// The error as serde carries it: its lines are what was expected, what is wrong with the value, and the code.
fn custom<E: Error>(QuantityError { code, expected, help }: QuantityError) -> E {
    E::custom(format_args!("{expected}\n{}\n{code}", help.unwrap_or_default()))
}

/// serde's `Deserialize` of scalars.
#[doc(hidden)]
#[macro_export]
macro_rules! deserialize_scalar {
    ($type:ty $(, $($generics:tt)*)?) => {
        impl<'de, $($($generics)*)?> serde::Deserialize<'de> for $type {
            fn deserialize<S: serde::Deserializer<'de>>(deserializer: S) -> Result<Self, S::Error> {
                $crate::quantity::scalar::scalar(deserializer)
            }
        }
    };
}
pub use deserialize_scalar as deserialize;

/// The JSON Schema of a type, under its name.
#[doc(hidden)]
#[macro_export]
macro_rules! schema_of_scalar {
    ($type:ty, $name:expr, $schema:tt $(, $($generics:tt)*)?) => {
        impl<$($($generics)*)?> schemars::JsonSchema for $type {
            fn schema_name() -> std::borrow::Cow<'static, str> {
                $name.into()
            }

            fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
                schemars::json_schema!($schema)
            }
        }
    };
}
pub use schema_of_scalar as schema;
