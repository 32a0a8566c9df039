//! Checksums of what is written step by step.
//!
//! Chunks that are written once end with their CRC-32C (the codec `crc32c` of Zarr). Per-step arrays grow within their
//! chunks, where a process that is killed between a number and its checksum would leave both at odds. So their
//! checksums stand in the group's document, which is replaced as a whole: the attribute `checksums`, the JSON text
//!
//! {"document": s, "time": s_1, "load": s_2, ...}
//!
//! holds the CRC-32C s_k of the bytes of all rows of array k, and that of the attributes that numbers depend on,
//! followed by the numbers of rows and fields.

use serde_json::{Map, Value, json};

use super::header::Progress;
pub(super) use super::header::Sums;

const ATTRIBUTE: &str = "checksums";
const DOCUMENT: &str = "document";
/// The attributes that numbers depend on. The others, as the title, may be edited.
const GUARDED: [&str; 11] = [
    "format",
    "schema",
    "version",
    "case",
    "setup",
    "cells",
    "size",
    "fields",
    "quantities",
    "rows_expected",
    "stress",
];

/// Sets the attribute, given the checksum of the [`guarded`] attributes. Results of form 1 have none.
pub(super) fn put(attributes: &mut Map<String, Value>, guarded: u32, progress: &Progress) {
    if form(attributes) > 1 {
        let mut all = json!(progress.sums);
        all[DOCUMENT] = json!(document(guarded, progress));
        attributes.insert(ATTRIBUTE.to_owned(), json!(all.to_string()));
    }
}

/// The checksums of the arrays as the attribute holds them.
///
/// # Errors
/// What is wrong with it, as the rest of a sentence.
pub(super) fn of(attributes: &Map<String, Value>) -> Result<Sums, String> {
    let Some(all) = parsed(attributes)? else { return Ok(Sums::new()) };
    Ok(all.into_iter().filter(|(name, _)| name != DOCUMENT).collect())
}

/// Compares the attributes with their checksum.
///
/// # Errors
/// What is wrong, as the rest of a sentence.
pub(super) fn check(attributes: &Map<String, Value>, progress: &Progress) -> Result<(), String> {
    match parsed(attributes)? {
        Some(all) if all.get(DOCUMENT) != Some(&document(guarded(attributes), progress)) => {
            Err("its attributes do not have the checksum that it states".to_owned())
        }
        _ => Ok(()),
    }
}

fn parsed(attributes: &Map<String, Value>) -> Result<Option<Sums>, String> {
    if form(attributes) < 2 {
        return Ok(None);
    }
    let text = attributes.get(ATTRIBUTE).and_then(Value::as_str);
    let sums = text.and_then(|text| serde_json::from_str(text).ok());
    sums.map(Some).ok_or_else(|| format!("the attribute `{ATTRIBUTE}` is missing or malformed"))
}

fn form(attributes: &Map<String, Value>) -> u64 {
    attributes.get("schema").and_then(Value::as_u64).unwrap_or(1)
}

/// The checksum of the attributes that numbers depend on and that do not change from step to step.
pub(super) fn guarded(attributes: &Map<String, Value>) -> u32 {
    let guarded = GUARDED.iter().filter_map(|name| Some((name, attributes.get(*name)?)));
    guarded.fold(0, |sum, (name, value)| crc32c::crc32c_append(sum, format!("{name}: {value}\n").as_bytes()))
}

fn document(guarded: u32, progress: &Progress) -> u32 {
    crc32c::crc32c_append(guarded, format!("{} {}", progress.rows, progress.maps).as_bytes())
}
