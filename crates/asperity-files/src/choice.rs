//! Choices: enums whose variants are words in case files, results and commands.
//!
//! `Boundary` is "free" or "periodic". serde derives the words from the variants, so each enum is written once, in the
//! crate that it belongs to; the functions here give the words to whoever reads or prints one without a case file.
//!
//! ```
//! use asperity::{Boundary, Method};
//! use asperity_files::choice;
//!
//! assert_eq!(choice::words::<Boundary>(), ["free", "periodic"]);
//! assert_eq!(choice::parse("polonsky-keer"), Some(Method::PolonskyKeer));
//! assert_eq!(choice::parse::<Method>("newton"), None);
//! assert_eq!(choice::word(&Boundary::Periodic), "periodic");
//! ```

use serde::de::value::{Error, StrDeserializer};
use serde::de::{DeserializeOwned, Deserializer, Error as _, IntoDeserializer, Visitor};
use serde::forward_to_deserialize_any;

/// An enum whose variants hold nothing, with serde's derived `Deserialize`.
pub trait Choice: DeserializeOwned + PartialEq {}

impl<T: DeserializeOwned + PartialEq> Choice for T {}

/// The words of a choice, in the order of its variants.
pub fn words<T: Choice>() -> &'static [&'static str] {
    let mut words: &'static [&'static str] = &[];
    // The derived code hands its words to the deserializer, which keeps them and has no value to give.
    let _ = T::deserialize(Words(&mut words));
    words
}

/// The choice of a word.
pub fn parse<T: Choice>(word: &str) -> Option<T> {
    let deserializer: StrDeserializer<'_, Error> = word.into_deserializer();
    T::deserialize(deserializer).ok()
}

/// The word of a choice.
pub fn word<T: Choice>(choice: &T) -> &'static str {
    words::<T>().iter().find(|word| parse::<T>(word).as_ref() == Some(choice)).copied().unwrap_or_default()
}

/// Takes the words of an enum's derived `Deserialize`.
struct Words<'w>(&'w mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Words<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(Error::custom("no choice of words"))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Error> {
        *self.0 = words;
        Err(Error::custom("the words were taken"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity::quantities::Quantity;

    #[test]
    fn case_files_name_quantities_as_results_do() {
        assert_eq!(words::<Quantity>(), Quantity::ALL.map(Quantity::name));
    }
}
