//! A second reader of Zarr v3, which knows an array only by its own document.

use std::fs;
use std::io::Read;
use std::path::Path;

use flate2::read::GzDecoder;
use serde_json::Value;

/// An array with all of its numbers, the last dimension fastest. Counts are exact.
pub(crate) struct Array {
    pub(crate) document: Value,
    pub(crate) shape: Vec<usize>,
    pub(crate) values: Vec<f64>,
}

impl Array {
    /// Reads the array in a directory; `None` where there is none.
    pub(crate) fn read(directory: &Path) -> Option<Array> {
        let text = fs::read_to_string(directory.join("zarr.json")).ok()?;
        let document: Value = serde_json::from_str(&text).unwrap();
        if document["node_type"] != "array" {
            return None;
        }
        let shape = sides(&document["shape"]);
        let chunk = sides(&document["chunk_grid"]["configuration"]["chunk_shape"]);
        let fill = document["fill_value"].as_f64().unwrap_or(f64::NAN);
        let mut values = vec![fill; shape.iter().product()];
        let counts: Vec<usize> =
            shape.iter().zip(&chunk).map(|(cells, side)| cells.div_ceil(*side)).collect();
        for n in 0..counts.iter().product() {
            let place = index(n, &counts);
            let path = place.iter().fold(directory.join("c"), |path, k| path.join(k.to_string()));
            // A chunk that is not there holds the fill value.
            let Ok(bytes) = fs::read(&path) else { continue };
            for (m, number) in decoded(&document, bytes).into_iter().enumerate() {
                let cell =
                    index(m, &chunk).into_iter().zip(&place).zip(&chunk).map(|((k, n), side)| n * side + k);
                let cell: Vec<usize> = cell.collect();
                if cell.iter().zip(&shape).all(|(k, cells)| k < cells) {
                    let flat = cell.iter().zip(&shape).fold(0, |flat, (k, cells)| flat * cells + k);
                    values[flat] = number;
                }
            }
        }
        Some(Array { document, shape, values })
    }

    /// Names of its dimensions.
    pub(crate) fn dimensions(&self) -> Vec<String> {
        let names = self.document["dimension_names"].as_array().unwrap().iter();
        names.map(|name| name.as_str().unwrap().to_owned()).collect()
    }
}

fn sides(list: &Value) -> Vec<usize> {
    list.as_array().unwrap().iter().map(|side| side.as_u64().unwrap() as usize).collect()
}

/// The `n`th index of a block with these sides, the last one fastest.
fn index(mut n: usize, sides: &[usize]) -> Vec<usize> {
    let mut index: Vec<usize> = sides
        .iter()
        .rev()
        .map(|side| {
            let k = n % side;
            n /= side;
            k
        })
        .collect();
    index.reverse();
    index
}

/// The numbers of a chunk: the codecs of the document, undone from the last to the first.
fn decoded(document: &Value, mut bytes: Vec<u8>) -> Vec<f64> {
    for codec in document["codecs"].as_array().unwrap().iter().rev() {
        match codec["name"].as_str().unwrap() {
            "crc32c" => {
                let sum = bytes.split_off(bytes.len() - 4);
                assert_eq!(crc32c::crc32c(&bytes).to_le_bytes(), sum[..]);
            }
            "gzip" => {
                let mut plain = vec![];
                GzDecoder::new(&bytes[..]).read_to_end(&mut plain).unwrap();
                bytes = plain;
            }
            "bytes" => {
                assert!(document["data_type"] == "uint8" || codec["configuration"]["endian"] == "little")
            }
            other => panic!("codec {other}"),
        }
    }
    let numbers = bytes.as_chunks().0.iter();
    match document["data_type"].as_str().unwrap() {
        "float64" => numbers.map(|number| f64::from_le_bytes(*number)).collect(),
        "int64" => numbers.map(|number| i64::from_le_bytes(*number) as f64).collect(),
        "uint8" => bytes.into_iter().map(f64::from).collect(),
        other => panic!("numbers of type {other}"),
    }
}
