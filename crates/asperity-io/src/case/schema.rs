//! The JSON Schema of the case file, and look-ups in it.
//!
//! The schema is made from the structs of the tables, so it cannot differ from what is read.

use std::sync::OnceLock;

use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Map, Value};

use super::document::Document;
use crate::quantity::UNIT;

/// The JSON Schema (draft 2020-12) of a case file: every key with description, unit and example.
pub fn schema() -> Value {
    generated().clone()
}

fn generated() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| {
        let settings = SchemaSettings::draft2020_12()
            .with_transform(RecursiveTransform(without_null))
            .with_transform(RecursiveTransform(shared_keys))
            .with_transform(RecursiveTransform(first_paragraph));
        let generator = settings.into_generator();
        let mut schema = Value::from(generator.into_root_schema_for::<Document>());
        if let Some(root) = schema.as_object_mut() {
            root.insert("title".into(), "asperity case file".into());
        }
        schema
    })
}

/// TOML has no null: a key that may be left out is not listed among the required ones, that is all.
fn without_null(schema: &mut Schema) {
    let null = serde_json::json!({ "type": "null" });
    let Some(object) = schema.as_object_mut() else { return };
    if let Some(Value::Array(types)) = object.get_mut("type") {
        types.retain(|name| name != "null");
        if let [one] = types.as_slice() {
            let one = one.clone();
            object.insert("type".into(), one);
        }
    }
    let Some(Value::Array(union)) = object.get_mut("anyOf") else { return };
    union.retain(|member| *member != null);
    if let [Value::Object(one)] = union.as_slice() {
        let one = one.clone();
        object.remove("anyOf");
        for (key, value) in one {
            object.entry(key).or_insert(value);
        }
    }
}

/// Keys that the members of a union share stand in each of them: then each lists all its keys.
fn shared_keys(schema: &mut Schema) {
    let Some(object) = schema.as_object_mut() else { return };
    let (Some(Value::Object(shared)), true) =
        (object.get("properties").cloned(), object.contains_key("oneOf"))
    else {
        return;
    };
    for key in ["properties", "unevaluatedProperties", "additionalProperties", "type"] {
        object.remove(key);
    }
    for member in object.get_mut("oneOf").and_then(Value::as_array_mut).into_iter().flatten() {
        if let Some(Value::Object(own)) = member.get_mut("properties") {
            own.extend(shared.clone());
        }
        if let Some(member) = member.as_object_mut() {
            member.insert("additionalProperties".into(), false.into());
        }
    }
}

/// The types of the solver are documented for programmers: the first paragraph says what a word means.
fn first_paragraph(schema: &mut Schema) {
    let Some(Value::String(text)) = schema.get_mut("description") else { return };
    if let Some((first, _)) = text.split_once("\n\n") {
        *text = first.to_owned();
    }
}

/// The keys of the root.
pub fn sections() -> Vec<&'static str> {
    generated()["properties"].as_object().into_iter().flatten().map(|(key, _)| key.as_str()).collect()
}

/// The schemas of the key at `path` ("body[0].poisson"), more than one where a union's members share it.
pub fn find(path: &str) -> Vec<Value> {
    let mut schemas = vec![];
    for (depth, name) in path.split('.').enumerate() {
        let mut parts = name.split('[');
        let name = parts.next().unwrap_or_default();
        schemas = match depth {
            0 => property(generated(), name).into_iter().collect(),
            _ => schemas.iter().flat_map(members).filter_map(|schema| property(&schema, name)).collect(),
        };
        for part in parts {
            let n = part.trim_end_matches(']').parse().unwrap_or(0);
            schemas = schemas.iter().flat_map(members).filter_map(|schema| items(&schema, n)).collect();
        }
    }
    schemas
}

/// Whether the key at `path` takes a table and nothing else.
pub fn is_table(path: &str) -> bool {
    let found: Vec<Value> = find(path).iter().flat_map(members).collect();
    !found.is_empty() && found.iter().all(|schema| schema["type"] == "object")
}

/// Whether the key at `path` takes a quantity with a unit, also where it is one of several things that the key takes.
pub fn has_unit(path: &str) -> bool {
    fn of(schema: &Value) -> bool {
        let schema = resolve(schema);
        let union = ["oneOf", "anyOf"].iter().find_map(|key| schema.get(key)?.as_array());
        schema.get(UNIT).is_some() || union.is_some_and(|union| union.iter().any(of))
    }
    find(path).iter().any(of)
}

/// The words that the key at `path` takes, where it takes words.
pub fn choices(path: &str) -> Vec<String> {
    let mut words = Vec::new();
    for schema in find(path).iter().flat_map(members) {
        let listed = schema.get("enum").and_then(Value::as_array).into_iter().flatten();
        for word in listed.chain(schema.get("const")).filter_map(Value::as_str) {
            if !words.iter().any(|known| known == word) {
                words.push(word.to_owned());
            }
        }
    }
    words
}

/// The schema itself with its reference followed, or the members of its union.
fn members(schema: &Value) -> Vec<Value> {
    let schema = resolve(schema);
    let union = ["oneOf", "anyOf"].iter().find_map(|key| schema.get(key)?.as_array());
    match union {
        Some(union) => union.iter().flat_map(members).collect(),
        None => vec![schema],
    }
}

/// Follows `$ref`; what stands beside it (description, examples) wins.
fn resolve(schema: &Value) -> Value {
    let target = schema
        .get("$ref")
        .and_then(Value::as_str)
        .and_then(|reference| generated().pointer(reference.strip_prefix('#')?));
    let (Some(Value::Object(target)), Some(own)) = (target, schema.as_object()) else {
        return schema.clone();
    };
    let mut merged = target.clone();
    merged.extend(
        own.iter().filter(|(key, _)| *key != "$ref").map(|(key, value)| (key.clone(), value.clone())),
    );
    Value::Object(merged)
}

fn property(schema: &Value, name: &str) -> Option<Value> {
    let properties: &Map<String, Value> = schema.get("properties")?.as_object()?;
    properties.get(name).map(resolve)
}

/// The schema of element `n` of a list.
fn items(schema: &Value, n: usize) -> Option<Value> {
    let tuple = schema.get("prefixItems").and_then(|items| items.get(n));
    schema.get("items").filter(|items| items.is_object()).or(tuple).map(resolve)
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_examples::TEMPLATES;
    use toml::Value as Toml;

    /// Every key of a table and below, as a path.
    fn keys(value: &Toml, path: &str, paths: &mut Vec<String>) {
        match value {
            Toml::Table(table) => {
                for (key, value) in table {
                    let path = crate::case::text::join(path, key);
                    paths.push(path.clone());
                    keys(value, &path, paths);
                }
            }
            Toml::Array(array) => {
                for (n, value) in array.iter().enumerate() {
                    keys(value, &format!("{path}[{n}]"), paths);
                }
            }
            _ => {}
        }
    }

    #[test]
    fn every_key_of_the_starter_cases_is_in_the_schema() {
        for template in TEMPLATES {
            let mut paths = Vec::new();
            keys(&Toml::Table(template.text.parse().unwrap()), "", &mut paths);
            assert!(paths.len() > 15, "{}", template.name);
            for path in paths {
                assert!(!find(&path).is_empty(), "{}: {path}", template.name);
            }
        }
        for path in
            ["domian", "body[0].poison", "surface[0].kind.x", "time[0].end", "body[0].material[0].model"]
        {
            assert!(find(path).is_empty(), "{path}");
        }
    }

    /// Calls `check` with the name and the schema of every key.
    fn every_property(schema: &Value, check: &mut dyn FnMut(&str, &Value)) {
        match schema {
            Value::Object(object) => {
                for (name, property) in
                    object.get("properties").and_then(Value::as_object).into_iter().flatten()
                {
                    check(name, property);
                }
                object.values().for_each(|value| every_property(value, check));
            }
            Value::Array(array) => array.iter().for_each(|value| every_property(value, check)),
            _ => {}
        }
    }

    #[test]
    fn every_key_has_a_description_and_shows_how_it_is_written() {
        let mut count = 0;
        every_property(generated(), &mut |name, property| {
            if property.get("const").is_some() {
                return; // the tag of a union's member, which is described as a whole
            }
            count += 1;
            let resolved = resolve(property);
            assert!(description_of(&resolved).len() > 5, "{name} has no description");
            let shown = resolved.get("examples").is_some()
                || members(&resolved).iter().any(|m| m.get("const").is_some() || m.get("enum").is_some())
                || ["domain", "surface", "body", "layer", "load", "time", "solver", "output"].contains(&name);
            assert!(shown, "{name} has no example: {resolved}");
        });
        assert!(count > 80, "{count}");
    }

    fn description_of(schema: &Value) -> &str {
        schema.get("description").and_then(Value::as_str).unwrap_or_default()
    }

    #[test]
    fn no_key_is_null_and_every_reference_leads_somewhere() {
        let text = generated().to_string();
        assert!(!text.contains("\"null\""));
        for reference in text.split("\"$ref\":\"#").skip(1) {
            let pointer = reference.split('"').next().unwrap();
            assert!(generated().pointer(pointer).is_some(), "{pointer}");
        }
    }

    #[test]
    fn choices_are_the_words_of_a_key() {
        assert_eq!(choices("domain.boundary"), ["free", "periodic"]);
        assert_eq!(choices("solver.method"), ["projected-cg", "polonsky-keer"]);
        assert_eq!(choices("surface[3].kind").len(), 9);
        assert_eq!(choices("time.spacing"), ["uniform", "log", "adaptive"]);
        assert!(choices("domain.cells").is_empty());
    }

    #[test]
    fn the_schema_beside_the_examples_is_this_one() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/case.schema.json");
        if std::env::var("ASPERITY_SCHEMA").is_ok_and(|word| word == "write") {
            std::fs::write(path, serde_json::to_string_pretty(generated()).unwrap() + "\n").unwrap();
        }
        let stored: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
        assert!(
            stored == schema(),
            "regenerate it: cargo run --release -- schema > examples/case.schema.json, or ASPERITY_SCHEMA=write cargo test \
             schema"
        );
    }
}
