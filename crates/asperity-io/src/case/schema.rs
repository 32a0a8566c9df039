//! The JSON Schema of the case file, and look-ups in it.
//!
//! The schema is made from the structs in `raw`, so it cannot differ from what is read.

use std::sync::OnceLock;

use schemars::Schema;
use schemars::generate::SchemaSettings;
use schemars::transform::RecursiveTransform;
use serde_json::{Map, Value};

use super::raw::Document;

/// The JSON Schema (draft 2020-12) of a case file: every key with description, unit and example.
pub fn schema() -> Value {
    generated().clone()
}

fn generated() -> &'static Value {
    static SCHEMA: OnceLock<Value> = OnceLock::new();
    SCHEMA.get_or_init(|| {
        let settings = SchemaSettings::draft2020_12().with_transform(RecursiveTransform(without_null));
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

/// The schemas of the key at `path` ("body[0].poisson"), more than one where a union's members share it.
pub fn find(path: &str) -> Vec<Value> {
    let mut schemas = vec![generated().clone()];
    for name in path.split('.') {
        let (name, indices) = match name.split_once('[') {
            Some((name, rest)) => (name, 1 + rest.matches('[').count()),
            None => (name, 0),
        };
        schemas = schemas.iter().flat_map(members).filter_map(|schema| property(&schema, name)).collect();
        for _ in 0..indices {
            schemas = schemas.iter().flat_map(members).filter_map(|schema| items(&schema)).collect();
        }
    }
    schemas
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

fn items(schema: &Value) -> Option<Value> {
    let tuple = schema.get("prefixItems").and_then(|items| items.get(0));
    schema.get("items").filter(|items| items.is_object()).or(tuple).map(resolve)
}
