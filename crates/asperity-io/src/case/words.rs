//! The words of an error about a key: what serde found, said to a user.

use std::ops::Range;

use asperity::finding;
use serde_json::Value;

use super::error::CaseError;
use super::text::{Spot, Text, join};
use super::{read, schema};
use crate::quantity::Temperature;
use crate::{Code, choice};

/// Keys of earlier versions: what became of them, and what to do.
const RETIRED: &[(&str, &str)] =
    &[("solver.precision", "is retired: the solver works in double precision throughout; delete the line")];

/// A fault that serde found while it read the section at `section`.
pub fn translate(text: &Text<'_>, error: &toml::de::Error, section: Range<usize>) -> CaseError {
    let message = error.message();
    let span = error.span().unwrap_or(section);
    let spot = text.at(&span);
    // The user's name stands between the first backtick and the last "`, expected"; the rest is serde's.
    let named = |prefix| {
        let rest = message.strip_prefix(prefix)?;
        rest.rsplit_once("`, expected ").or_else(|| rest.rsplit_once("`, there "))
    };
    // The crate toml hands a date on as a table with a key of its own.
    if message.contains("`$__toml_private_datetime`") {
        let message = format!("{} is a date, and a case has none", text.value(&spot));
        let help = "write texts between quotes";
        return text.fault(Code::WrongType, spot, &message, "another value", help);
    }
    if let Some((name, known)) = named("unknown field `") {
        return unknown_key(text, spot, name, &backticked(known));
    }
    // The same of a member of a union, in the words of the crate toml.
    if let Some((_, known)) = message.rsplit_once(", available keys: ") {
        let (name, known) = (text.value(&spot), known.split(", ").filter(|key| !key.is_empty()));
        return unknown_key(text, spot, &name, &known.collect::<Vec<_>>());
    }
    if let Some((name, known)) = named("unknown variant `") {
        return wrong_choice(text, spot, Some((name, &backticked(known))));
    }
    if let Some(key) = message.strip_prefix("missing field `") {
        return missing_key(text, &span, key.trim_end_matches('`'));
    }
    if message.starts_with("wanted ") || message.starts_with("expected ") {
        return wrong_choice(text, spot, None);
    }
    for prefix in ["invalid type: ", "invalid value: ", "invalid length "] {
        let rest = message.strip_prefix(prefix).and_then(|rest| rest.split_once(", expected "));
        if let Some((found, expected)) = rest {
            let is_table = found == "sequence" && expected.starts_with("struct ");
            let help = match plain(expected) {
                _ if is_table => Some(format!("write the header in single brackets: [{}]", spot.key)),
                "a table" => as_table(&spot.key, &text.value(&spot)),
                _ => None,
            };
            return text.wrong(Code::WrongType, spot, plain(expected), &help.unwrap_or_default());
        }
    }
    // Scalars say what was expected, what is wrong with the value, and the code.
    let mut lines = message.splitn(3, '\n');
    let [expected, help, code] = [(); 3].map(|()| lines.next().unwrap_or_default());
    text.wrong(choice::parse(code).unwrap_or(Code::OutOfRange), spot, expected, help)
}

/// A key that the table at its spot does not have.
pub fn unknown_key(text: &Text<'_>, spot: Spot, name: &str, known: &[&str]) -> CaseError {
    let key = spot.key.clone();
    let table = match key.strip_suffix(name).map(|table| table.trim_end_matches('.')) {
        None | Some("") => "the case file",
        Some(table) => table,
    };
    // `array` names what a program gives beside the case; in a file it is of no use.
    let known: Vec<&str> =
        [known, read::shared(table)].concat().into_iter().filter(|key| *key != "array").collect();
    let names = known.join(", ");
    let expected = if known.is_empty() { "no key".to_owned() } else { format!("one of {names}") };
    if let Some((_, reason)) = RETIRED.iter().find(|retired| retired.0 == key) {
        return text.error(Code::UnknownKey, spot, None, "no such key", "", format!("{key} {reason}"));
    }
    let help = match nearest(name, &known) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "it has none".to_owned(),
        None => deeper(text, table, name, &spot, &known).unwrap_or_else(|| format!("its keys: {names}")),
    };
    text.error(Code::UnknownKey, spot, None, &expected, &help, format!("{table} has no key `{name}`"))
}

/// Where a key belongs that stands one level too high: `[temperature] value = 40`.
fn deeper(text: &Text<'_>, table: &str, name: &str, spot: &Spot, known: &[&str]) -> Option<String> {
    let has = |key: &&&str| !schema::find(&join(&join(table, key), name)).is_empty();
    let key = known.iter().find(has)?;
    let value = text.value(&text.of(&spot.key));
    let help = (name == "value").then(|| as_table(&join(table, key), &value)).flatten();
    Some(help.unwrap_or_else(|| format!("`{name}` is a key of `{key}`")))
}

/// How the value of a table is written, where only its value is given: the example of the schema with this value, which stands in
/// the case as `value`.
pub fn as_table(key: &str, value: &str) -> Option<String> {
    let mut example = schema::find(key).iter().find_map(|schema| schema.get("examples")?.get(0).cloned())?;
    let mut meant = None;
    if let Some(place) = inner_value(&mut example)
        && let Ok(given) = value.parse::<toml::Value>()
    {
        let is_temperature = place.as_str().is_some_and(|text| text.parse::<Temperature>().is_ok());
        *place = match given.as_float().or(given.as_integer().map(|whole| whole as f64)) {
            Some(number) if is_temperature && finding::celsius_meant(number).is_some() => {
                meant = Some(format!(", or \"{value} K\" if kelvin are meant"));
                format!("{value} °C").into()
            }
            Some(_) if is_temperature => format!("{value} K").into(),
            _ => serde_json::to_value(given).ok().filter(|given| !given.is_array() && !given.is_object())?,
        };
    }
    let name = key.rsplit('.').next().unwrap_or(key);
    example.is_object().then(|| format!("write {name} = {}{}", in_toml(&example), meant.unwrap_or_default()))
}

/// The `value` of a table, or of the tables in it.
fn inner_value(table: &mut Value) -> Option<&mut Value> {
    let table = table.as_object_mut()?;
    match table.contains_key("value") {
        true => table.get_mut("value"),
        false => table.values_mut().find_map(inner_value),
    }
}

/// A value that is none of the words that its key takes.
pub fn wrong_choice(text: &Text<'_>, spot: Spot, found: Option<(&str, &[&str])>) -> CaseError {
    let names = match found {
        Some((_, known)) => known.iter().map(|name| (*name).to_owned()).collect(),
        None => schema::choices(&spot.key),
    };
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let expected = match quoted.as_slice() {
        [] => "a word".to_owned(),
        [one] => one.clone(),
        _ => format!("one of {}", quoted.join(", ")),
    };
    let Some((name, known)) = found else { return text.wrong(Code::WrongType, spot, &expected, "") };
    let help = nearest(name, known).map(|near| format!("did you mean \"{near}\"?"));
    text.wrong(Code::UnknownKind, spot, &expected, &help.unwrap_or_default())
}

/// A key that the table at `span` needs and does not have.
pub fn missing_key(text: &Text<'_>, span: &Range<usize>, name: &str) -> CaseError {
    // A header line can stand for several tables; the schema knows which of them has the key.
    let mut paths = text.tables(span).into_iter().map(|table| join(&table, name));
    let key = paths.rfind(|path| !schema::find(path).is_empty());
    let key = key.unwrap_or_else(|| join(&text.at(span).key, name));
    missing(text, Spot { key, span: Some(span.clone()) }, name)
}

/// The key `name`, whose path the spot has, is needed in the table at the spot.
pub fn missing(text: &Text<'_>, spot: Spot, name: &str) -> CaseError {
    let (expected, help) = wanted(&spot.key, name);
    let message = format!("{} is missing", spot.key);
    text.error(Code::MissingKey, spot, None, &expected, &help.unwrap_or_default(), message)
}

/// A section that the file needs and does not have.
pub fn missing_section(text: &Text<'_>, name: &str) -> CaseError {
    let header = match name {
        "surface" | "body" => format!("[[{name}]]"),
        _ => format!("[{name}]"),
    };
    let help = schema::find(name).iter().find_map(description).unwrap_or_default();
    let spot = Spot { key: name.to_owned(), span: None };
    let message = format!("the section {header} is missing");
    text.error(Code::MissingKey, spot, None, &format!("a section {header}"), &help, message)
}

/// What a key means and how it is written, from the schema.
fn wanted(key: &str, name: &str) -> (String, Option<String>) {
    let found = schema::find(key);
    let meaning = found.iter().find_map(description).map(|meaning| inside(&meaning));
    let meaning = meaning.filter(|meaning| meaning != name);
    let expected = meaning.map_or_else(|| format!("`{name}`"), |meaning| format!("`{name}`: {meaning}"));
    let example = found.iter().find_map(|schema| schema.get("examples")?.get(0));
    let help = match example {
        Some(example) => Some(format!("add {name} = {}", in_toml(example))),
        None => match schema::choices(key) {
            choices if choices.is_empty() => None,
            choices => Some(format!("add {name} = \"{}\"", choices.join("\" or \""))),
        },
    };
    (expected, help)
}

/// A sentence as it is written after a colon: "time to reach it".
fn inside(sentence: &str) -> String {
    let sentence = sentence.trim_end_matches('.');
    let mut letters = sentence.chars();
    match (letters.next(), letters.next()) {
        // Not of "DMA" or "R x C".
        (Some(first), Some(second)) if second.is_lowercase() => {
            first.to_lowercase().chain(std::iter::once(second)).chain(letters).collect()
        }
        _ => sentence.to_owned(),
    }
}

/// An example of the schema, as a case file writes it.
fn in_toml(example: &Value) -> String {
    match toml::Value::try_from(example) {
        Ok(value) => value.to_string(),
        Err(_) => example.to_string(),
    }
}

fn description(schema: &Value) -> Option<String> {
    Some(schema.get("description")?.as_str()?.to_owned())
}

/// The known name that a misspelt one is close to.
pub fn nearest<'n>(name: &str, known: &[&'n str]) -> Option<&'n str> {
    if name.len() > 64 {
        return None; // the distance is quadratic in the length
    }
    let distance = |known: &str| strsim::damerau_levenshtein(&name.to_lowercase(), known);
    let near = known.iter().min_by_key(|known| distance(known))?;
    // Two letters of five, at most.
    if 5 * distance(near) <= 2 * near.len().min(name.len()) {
        return Some(near);
    }
    let initials = |known: &&&str| {
        known.contains('-') && known.split('-').filter_map(|word| word.chars().next()).eq(name.chars())
    };
    if let Some(known) = known.iter().find(initials) {
        return Some(known);
    }
    let is_part = |known: &&&str| {
        let mut words = known.split(['-', '_']);
        name.len() > 2 && known.starts_with(name)
            || name.len() > 3 && words.any(|word| word.starts_with(name))
    };
    known.iter().find(is_part).copied()
}

fn backticked(list: &str) -> Vec<&str> {
    list.split('`').skip(1).step_by(2).collect()
}

fn plain(expected: &str) -> &str {
    match expected {
        "a boolean" => "true or false",
        "a string" => "text in quotes",
        "a sequence" => "a list in brackets",
        other if other.starts_with("struct ") => "a table",
        other => other,
    }
}

/// A number of a message: six digits, powers of ten only where they shorten it.
pub fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    match rounded.abs() {
        0.0 => "0".to_owned(),
        size if (1e-3..1e6).contains(&size) => rounded.to_string(),
        _ => format!("{rounded:e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.5, "0.5"),
            (0.1 + 0.2, "0.3"),
            (100.0, "100"),
            (3e8, "3e8"),
            (1e-9, "1e-9"),
            (1.0 / 3.0, "0.333333"),
            (-2e-4, "-2e-4"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        let known = ["poisson", "bulk_modulus", "hardness"];
        assert_eq!(nearest("poison", &known), Some("poisson"));
        assert_eq!(nearest("Hardness", &known), Some("hardness"));
        assert_eq!(nearest("bulk", &known), Some("bulk_modulus"));
        assert_eq!(nearest("modulus", &known), Some("bulk_modulus"));
        assert_eq!(nearest("yield", &known), None);
        // Half of the letters differ, or the word stands inside another.
        assert_eq!(nearest("time", &["size", "tile_count", "meantimes"]), None);
        assert_eq!(nearest("sise", &["size"]), Some("size"));
        assert_eq!(nearest("plain", &["none", "mean", "plane"]), Some("plane"));
        assert_eq!(nearest("sls", &["zener", "standard-linear-solid"]), Some("standard-linear-solid"));
        assert_eq!(nearest(&"x".repeat(100_000), &known), None);
    }
}
