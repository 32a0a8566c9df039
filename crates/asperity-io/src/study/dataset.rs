//! `study.zarr`: the table of a study as a Zarr v3 group that `xarray.open_zarr` reads. Of a study of all combinations each key is
//! a dimension; of values that go together, the one dimension is `run`. Each array is one chunk.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

use super::StudyError;
use super::folder::{Study, failed};
use super::rows::State;
use super::table::Table;
use crate::output::PartialDirectory;
use crate::store::array_document;

pub(super) const NAME: &str = "study.zarr";
/// The attribute by which the group is known as ours.
const MARK: &str = "asperity_study";

/// An array of the group.
struct Array {
    name: String,
    dimensions: Vec<String>,
    shape: Vec<usize>,
    attributes: Value,
    data: Data,
}

enum Data {
    Reals(Vec<f64>),
    Counts(Vec<i64>),
    Texts(Vec<String>),
}

/// Writes the group of a table in place of an older one.
pub(super) fn write(study: &Study, table: &Table) -> Result<(), StudyError> {
    let path = study.folder.join(NAME);
    if path.exists() && !is_dataset(&path) {
        let message = format!(
            "{} was not written by asperity study; move it away, it would be replaced",
            path.display()
        );
        return Err(StudyError::Input(message));
    }
    let arrays = arrays(study, table);
    let fail = || failed("write", &path);
    let partial = PartialDirectory::new(&path).map_err(fail())?;
    for array in &arrays {
        array.write(partial.place()).map_err(fail())?;
    }
    let metadata: serde_json::Map<String, Value> =
        arrays.iter().map(|array| (array.name.clone(), array.document())).collect();
    let group = json!({
        "zarr_format": 3,
        "node_type": "group",
        "attributes": { MARK: 1, "version": env!("CARGO_PKG_VERSION") },
        "consolidated_metadata": { "kind": "inline", "must_understand": false, "metadata": metadata },
    });
    fs::write(partial.place().join("zarr.json"), group.to_string()).map_err(fail())?;
    partial.finish().map_err(fail())
}

/// Whether this is the table of a study.
pub fn is_dataset(path: &Path) -> bool {
    let text = fs::read_to_string(path.join("zarr.json")).unwrap_or_default();
    let document: Value = serde_json::from_str(&text).unwrap_or_default();
    document["attributes"].get(MARK).is_some()
}

fn arrays(study: &Study, table: &Table) -> Vec<Array> {
    let plan = &study.plan;
    let dimensions: Vec<String> = match plan.zip {
        true => vec!["run".to_owned()],
        false => table.keys.iter().map(|key| key.name.clone()).collect(),
    };
    let shape = plan.shape();
    let mut arrays: Vec<Array> = vec![];
    for (n, key) in table.keys.iter().enumerate() {
        let values = &plan.vary[n].values;
        let data = match key.unit {
            Some(_) => Data::Reals(values.iter().filter_map(|value| Some(value.number()?.0)).collect()),
            None => Data::Texts(values.iter().map(super::Value::text).collect()),
        };
        let mut attributes = json!({ "long_name": key.name });
        if let Some(unit) = key.unit.filter(|unit| !unit.is_empty()) {
            attributes["units"] = json!(unit);
        }
        let own = if plan.zip { "run".to_owned() } else { key.name.clone() };
        arrays.push(Array {
            name: key.name.clone(),
            dimensions: vec![own],
            shape: vec![values.len()],
            attributes,
            data,
        });
    }
    let mut add = |name: String, data, attributes| {
        // A key may have the name of an answer, and an answer two units.
        let mut name = name;
        while arrays.iter().any(|array| array.name == name) {
            name += "_answer";
        }
        arrays.push(Array { name, dimensions: dimensions.clone(), shape: shape.clone(), attributes, data });
    };
    for column in &table.answers {
        let attributes = json!({ "units": column.unit, "long_name": column.name.replace('_', " ") });
        add(column.name.clone(), Data::Reals(column.values.clone()), attributes);
        if column.has_errors() {
            let words = format!("error of the {}", column.name.replace('_', " "));
            let attributes = json!({ "units": column.unit, "long_name": words });
            add(format!("{}_error", column.name), Data::Reals(column.errors.clone()), attributes);
        }
    }
    let rows = || table.rows.iter();
    let findings =
        rows().map(|row| if row.state == State::Done { row.findings.len() as i64 } else { -1 }).collect();
    let words = json!({ "long_name": "number of findings, -1 of runs that are not done" });
    add("findings".into(), Data::Counts(findings), words);
    let codes = rows().map(super::Row::codes).collect();
    add("finding_codes".into(), Data::Texts(codes), json!({ "long_name": "codes of the findings" }));
    let taken = rows().map(super::Row::not_valid).collect();
    add(
        "not_valid".into(),
        Data::Texts(taken),
        json!({ "long_name": "answers that the findings take back" }),
    );
    let status = rows().map(|row| row.state.word().to_owned()).collect();
    add("status".into(), Data::Texts(status), json!({ "long_name": "how far the run is" }));
    let error =
        |row: &super::Row| if let State::Failed(why) = &row.state { why.clone() } else { String::new() };
    let errors = rows().map(error).collect();
    add("error".into(), Data::Texts(errors), json!({ "long_name": "why the run failed" }));
    let path = rows().map(|row| row.run.name.clone()).collect();
    let words = json!({ "long_name": "result of the run, in the folder of the study" });
    add("path".into(), Data::Texts(path), words);
    arrays
}

impl Array {
    fn document(&self) -> Value {
        let little = json!({ "name": "bytes", "configuration": { "endian": "little" } });
        let (data_type, fill, codec) = match self.data {
            Data::Reals(_) => ("float64", json!("NaN"), little),
            Data::Counts(_) => ("int64", json!(-1), little),
            Data::Texts(_) => ("string", json!(""), json!({ "name": "vlen-utf8", "configuration": {} })),
        };
        let attributes = self.attributes.clone();
        let lengths = [self.shape.as_slice(); 2];
        array_document(lengths, (data_type, fill), vec![codec], attributes, &self.dimensions)
    }

    fn write(&self, root: &Path) -> std::io::Result<()> {
        let bytes = match &self.data {
            Data::Reals(numbers) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            Data::Counts(numbers) => numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            Data::Texts(texts) => variable(texts),
        };
        let directory = root.join(&self.name);
        let chunk = self.shape.iter().fold(directory.join("c"), |path, _| path.join("0"));
        fs::create_dir_all(chunk.parent().unwrap_or(&directory))?;
        fs::write(chunk, bytes)?;
        fs::write(directory.join("zarr.json"), self.document().to_string())
    }
}

/// The codec vlen-utf8: the number of texts, then each with its length in bytes before it, as 32-bit integers.
fn variable(texts: &[String]) -> Vec<u8> {
    let length = |n: usize| (n as u32).to_le_bytes();
    let one = |text: &String| [&length(text.len()), text.as_bytes()].concat();
    length(texts.len()).into_iter().chain(texts.iter().flat_map(one)).collect()
}
