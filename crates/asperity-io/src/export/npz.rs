//! Numpy's `.npz`.
//!
//! `attributes` holds the attributes of the result and, under `units`, the unit of each array, as JSON text:
//! `json.loads(file["attributes"].item())`.

use serde_json::{Value, json};

use super::contents::{Contents, Data, DataType, Map};
use super::error::Result;
use crate::npz::Npz;
use crate::output::Output;

pub(super) fn write(contents: &Contents<'_>, file: &mut Output<'_>) -> Result<()> {
    let mut npz = Npz::new(file);
    if let Err(error) = members(contents, &mut npz) {
        npz.abandon();
        return Err(error);
    }
    npz.finish()?;
    Ok(())
}

fn members(contents: &Contents<'_>, npz: &mut Npz<&mut Output<'_>>) -> Result<()> {
    for variable in &contents.variables {
        let kind = match variable.data {
            Data::Counts(_) => "<i8",
            Data::Maps(DataType::UInt8) => "|u1",
            _ => "<f8",
        };
        npz.begin(variable.name, kind, &variable.shape(contents))?;
        match &variable.data {
            Data::Reals(reals) => npz.put_reals(reals.iter().copied())?,
            Data::Counts(counts) => {
                let bytes: Vec<u8> = counts.iter().flat_map(|n| n.to_le_bytes()).collect();
                npz.put(&bytes)?;
            }
            Data::Maps(_) => {
                for n in 0..contents.lead(variable).iter().product() {
                    match contents.map(variable, n)? {
                        Map::Real(map) => npz.put_reals(map)?,
                        Map::Byte(map) => npz.put(map.as_slice().unwrap_or_default())?,
                    }
                }
            }
        }
    }
    let units: serde_json::Map<_, _> =
        contents.variables.iter().map(|v| (v.name.to_owned(), json!(v.units))).collect();
    let mut attributes = contents.reader.attributes();
    attributes.insert("units".into(), Value::Object(units));
    Ok(npz.text("attributes", &Value::Object(attributes).to_string())?)
}
