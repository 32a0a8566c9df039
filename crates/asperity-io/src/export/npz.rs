//! Numpy's `.npz`: a zip of `.npy` files, stored as they are.
//!
//! `attributes` holds the attributes of the result and, under `units`, the unit of each array, as JSON text:
//! `json.loads(file["attributes"].item())`.

use std::io::Write;

use serde_json::{Value, json};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::contents::{Contents, Data, Map};
use super::error::WriteError;
use crate::output::Output;

pub(super) fn write(contents: &Contents<'_>, file: &mut Output<'_>) -> Result<(), WriteError> {
    let mut zip = ZipWriter::new(file);
    if let Err(error) = members(contents, &mut zip) {
        // Dropped, it would try to write again and print that it cannot.
        std::mem::forget(zip);
        return Err(error);
    }
    zip.finish().map_err(std::io::Error::from)?;
    Ok(())
}

fn members(contents: &Contents<'_>, zip: &mut ZipWriter<&mut Output<'_>>) -> Result<(), WriteError> {
    for variable in &contents.variables {
        let shape = variable.shape(contents);
        let kind = match variable.data {
            Data::Counts(_) => "<i8",
            Data::Field(crate::store::FieldKind::Contact) => "|u1",
            _ => "<f8",
        };
        begin(zip, variable.name, kind, &shape)?;
        match &variable.data {
            Data::Reals(reals) => put_reals(zip, reals)?,
            Data::Counts(counts) => {
                let bytes: Vec<u8> = counts.iter().flat_map(|n| n.to_le_bytes()).collect();
                zip.write_all(&bytes)?;
            }
            data => {
                for n in 0..contents.maps(data) {
                    match contents.map(data, n)? {
                        Some(Map::Real(map)) => put_reals(zip, map.as_slice().unwrap_or_default())?,
                        Some(Map::Byte(map)) => zip.write_all(map.as_slice().unwrap_or_default())?,
                        None => {}
                    }
                }
            }
        }
    }
    let units: serde_json::Map<_, _> =
        contents.variables.iter().map(|v| (v.name.to_owned(), json!(v.units))).collect();
    let mut attributes = contents.reader().attributes();
    attributes.insert("units".into(), Value::Object(units));
    // A scalar of numpy's text type: four bytes per character.
    let text = Value::Object(attributes).to_string();
    begin(zip, "attributes", &format!("<U{}", text.chars().count()), &[])?;
    let bytes: Vec<u8> = text.chars().flat_map(|c| u32::from(c).to_le_bytes()).collect();
    Ok(zip.write_all(&bytes)?)
}

/// Starts a member and writes the header of its `.npy` (version 1.0): padded to 64 bytes.
fn begin(
    zip: &mut ZipWriter<&mut Output<'_>>,
    name: &str,
    kind: &str,
    shape: &[usize],
) -> Result<(), WriteError> {
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored).large_file(true);
    zip.start_file(format!("{name}.npy"), options).map_err(std::io::Error::from)?;
    let lengths: String = shape.iter().map(|n| format!("{n},")).collect();
    let mut header = format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': ({lengths}), }}");
    let length = (10 + header.len() + 1).next_multiple_of(64) - 10;
    header.push_str(&" ".repeat(length - 1 - header.len()));
    header.push('\n');
    zip.write_all(b"\x93NUMPY\x01\x00")?;
    zip.write_all(&(length as u16).to_le_bytes())?;
    Ok(zip.write_all(header.as_bytes())?)
}

fn put_reals(file: &mut impl Write, reals: &[f64]) -> Result<(), WriteError> {
    let mut bytes = Vec::new();
    for part in reals.chunks(1 << 15) {
        bytes.clear();
        bytes.extend(part.iter().flat_map(|x| x.to_le_bytes()));
        file.write_all(&bytes)?;
    }
    Ok(())
}
