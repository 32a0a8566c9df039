//! From the TOML tree to the structs of the tables: section by section, so that each can report its own fault.
//!
//! Unions are tagged by a key (`kind`, `model`). serde reads such a union through a buffer that loses the
//! places in the text; so the tag is moved outwards first: `{ kind = "sphere", radius = 1 }` becomes
//! `{ sphere = { radius = 1 } }`, which keeps them. Keys that all members have in common are set beside the tag.

use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue, ValueDeserializer};

use super::error::CaseError;
use super::text::{MOST_ERRORS, Spot, Text, in_order, join};
use super::{schema, words};
use crate::Code;

/// A union: where it stands (`[]` for each element of a list), the key that tags it, and keys that all members share.
struct Union(&'static str, &'static str, &'static [&'static str]);

const SURFACE: &[&str] = &["moves"];
const MATERIAL: &[&str] = &["shift", "temperature", "window"];
const SHIFT: &[&str] = &["vertical"];

/// Inner unions come before those that hold them.
const UNIONS: &[Union] = &[
    Union("surface[].process[]", "op", &[]),
    Union("surface[]", "kind", SURFACE),
    Union("body[].material.shift", "model", SHIFT),
    Union("body[].material", "model", MATERIAL),
    Union("body[].layer[].material.shift", "model", SHIFT),
    Union("body[].layer[].material", "model", MATERIAL),
    Union("load.history", "kind", &[]),
    Union("load.stages[].history", "kind", &[]),
    Union("tangential.x", "kind", &[]),
    Union("tangential.y", "kind", &[]),
    Union("temperature.history", "kind", &[]),
    Union("motion.path", "kind", &[]),
    Union("motion.velocity", "kind", &[]),
    Union("wear.velocity", "kind", &[]),
    Union("leakage.inlet", "kind", &[]),
    // A material of its own file.
    Union("material.shift", "model", SHIFT),
    Union("material", "model", MATERIAL),
    // A shift that stands alone.
    Union("shift", "model", SHIFT),
];

/// Keys that the members of the union at `path` ("body[0].material") share.
pub fn shared(path: &str) -> &'static [&'static str] {
    let digits = |c: char| c.is_ascii_digit();
    let path: String = path.split_inclusive('[').map(|part| part.trim_start_matches(digits)).collect();
    UNIONS.iter().find(|union| union.0 == path).map_or(&[], |union| union.2)
}

/// Reads the sections of a document, and gathers their faults.
pub struct Reader<'r, 't> {
    text: &'r Text<'t>,
    pub errors: Vec<CaseError>,
    /// Sections that are there under a name that is nearly theirs.
    misspelt: Vec<&'static str>,
}

impl<'r, 't> Reader<'r, 't> {
    pub fn new(text: &'r Text<'t>) -> Self {
        Reader { text, errors: Vec::new(), misspelt: Vec::new() }
    }

    /// Refuses keys of the root that are not among these.
    pub fn only(&mut self, known: &[&'static str]) {
        for key in self.text.root.keys().take(MOST_ERRORS) {
            let name = key.get_ref();
            if !known.contains(&name.as_ref()) {
                self.errors.push(words::unknown_key(self.text, self.text.at(&key.span()), name, known));
                self.misspelt.extend(words::nearest(name, known));
            }
        }
    }

    /// What was read, where nothing is wrong.
    pub fn finish<T>(mut self, read: Option<T>) -> Result<T, Vec<CaseError>> {
        in_order(&mut self.errors);
        read.filter(|_| self.errors.is_empty()).ok_or(self.errors)
    }

    pub fn required<T: DeserializeOwned>(&mut self, key: &str) -> Option<T> {
        if !self.text.root.contains_key(key) {
            self.missing(key);
        }
        self.table(key)
    }

    /// A section that is one table. serde would also fill a struct from a list, by the order of its fields.
    pub fn table<T: DeserializeOwned>(&mut self, key: &str) -> Option<T> {
        if let Some(DeValue::Array(_)) = self.text.root.get(key).map(Spanned::get_ref) {
            let help = format!("there is one {key}: begin it with the line [{key}], once");
            let spot = self.text.of(key);
            self.errors.push(self.text.wrong(Code::WrongType, spot, "a table, not a list", &help));
            return None;
        }
        self.optional(key)
    }

    fn missing(&mut self, section: &str) {
        if !self.misspelt.contains(&section) {
            self.errors.push(words::missing_section(self.text, section));
        }
    }

    pub fn optional<T: DeserializeOwned>(&mut self, key: &str) -> Option<T> {
        self.text.root.get(key).and_then(|value| self.read(key, value))
    }

    pub fn list<T: DeserializeOwned>(&mut self, key: &str) -> Vec<T> {
        let Some(value) = self.text.root.get(key) else {
            self.missing(key);
            return Vec::new();
        };
        let array = match value.get_ref() {
            DeValue::Array(array) if !array.is_empty() => array,
            _ => {
                let help = format!("begin each with a line [[{key}]]");
                let expected = "a list of at least one table";
                self.errors.push(self.text.wrong(Code::WrongType, self.text.of(key), expected, &help));
                return Vec::new();
            }
        };
        let mut sections = Vec::new();
        for element in array.iter() {
            // Many alike have one cause.
            if self.errors.len() >= MOST_ERRORS {
                break;
            }
            sections.extend(self.read(&format!("{key}[]"), element));
        }
        sections
    }

    fn read<T: DeserializeOwned>(&mut self, key: &str, value: &Spanned<DeValue<'t>>) -> Option<T> {
        let (mut value, span) = (value.clone(), value.span());
        let mut inside = UNIONS.iter().filter_map(|union| Some((union.0.strip_prefix(key)?, union)));
        let moved = self
            .listed(key, &value)
            .and_then(|()| inside.try_for_each(|(path, union)| self.move_tag(&mut value, path, union)));
        let read = match moved {
            Ok(()) => T::deserialize(ValueDeserializer::from(value))
                .map_err(|error| words::translate(self.text, &error, span)),
            Err(error) => Err(*error),
        };
        read.map_err(|error| self.errors.push(error)).ok()
    }

    /// Refuses a table below `path` that is written as a list: serde would fill it by the order of its fields.
    fn listed(&self, path: &str, value: &Spanned<DeValue<'t>>) -> Result<(), Box<CaseError>> {
        match value.get_ref() {
            DeValue::Table(table) => {
                table.iter().try_for_each(|(key, value)| self.listed(&join(path, key.get_ref()), value))
            }
            DeValue::Array(_) if schema::is_table(path) => {
                let spot = self.text.at(&value.span());
                let key = spot.key.trim_end_matches("[0]").to_owned();
                let help =
                    "write one table in braces, { ... }, or begin it with a line in single brackets, once";
                Err(self
                    .text
                    .wrong(Code::WrongType, Spot { key, ..spot }, "a table, not a list", help)
                    .into())
            }
            DeValue::Array(array) => {
                let mut tables = array.iter().filter(|element| element.get_ref().is_table());
                tables.try_for_each(|element| self.listed(&format!("{path}[]"), element))
            }
            _ => Ok(()),
        }
    }

    /// Moves the tag of the unions at `path` outwards. What is no table or no list where one should be is left to serde.
    fn move_tag(
        &self,
        value: &mut Spanned<DeValue<'t>>,
        path: &str,
        union: &Union,
    ) -> Result<(), Box<CaseError>> {
        if let Some(path) = path.strip_prefix("[]") {
            let DeValue::Array(list) = value.get_mut() else { return Ok(()) };
            return list.iter_mut().try_for_each(|element| self.move_tag(element, path, union));
        }
        if let Some(path) = path.strip_prefix('.') {
            let (name, _) = path.split_at(path.find(['.', '[']).unwrap_or(path.len()));
            let DeValue::Table(table) = value.get_mut() else { return Ok(()) };
            let Some(inner) = table.get_mut(name) else { return Ok(()) };
            return self.move_tag(inner, &path[name.len()..], union);
        }
        self.outwards(value, union)
    }

    /// `{ tag = name, ... }` becomes `{ name = { ... } }`; or `{ tag = { name = { ... } }, shared, ... }`.
    fn outwards(&self, value: &mut Spanned<DeValue<'t>>, union: &Union) -> Result<(), Box<CaseError>> {
        let (text, span, Union(_, tag, shared)) = (self.text, value.span(), union);
        let table = match value.get_mut() {
            DeValue::Table(table) => table,
            _ => {
                let spot = text.at(&span);
                // These may be constant.
                if ["motion.velocity", "wear.velocity", "leakage.inlet"].contains(&spot.key.as_str()) {
                    return Ok(());
                }
                let expected = format!("a table that begins with the key `{tag}`");
                let help = words::as_table(&spot.key, &text.value(&spot)).unwrap_or_default();
                return Err(text.wrong(Code::WrongType, spot, &expected, &help).into());
            }
        };
        let Some(name) = table.remove(*tag) else {
            return Err(words::missing_key(text, &span, tag).into());
        };
        let place = name.span();
        let DeValue::String(name) = name.into_inner() else {
            return Err(words::wrong_choice(text, text.at(&place), None).into());
        };
        if *tag == "kind" && name == "array" && text.arrays.is_none() {
            let message = "\"array\" is for arrays that a Python program passes";
            let (spot, help) = (text.at(&place), "in a case file use kind = \"file\"");
            return Err(text.fault(Code::UnknownKind, spot, message, "another kind", help).into());
        }
        let (common, inner): (DeTable<'t>, DeTable<'t>) =
            std::mem::take(table).into_iter().partition(|(key, _)| shared.contains(&key.get_ref().as_ref()));
        let key: Spanned<DeString<'t>> = Spanned::new(place.clone(), name);
        table.insert(key, Spanned::new(span.clone(), DeValue::Table(inner)));
        if !shared.is_empty() {
            let member = std::mem::replace(table, common);
            table.insert(Spanned::new(place, (*tag).into()), Spanned::new(span, DeValue::Table(member)));
        }
        Ok(())
    }
}
