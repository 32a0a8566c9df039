//! All numbers of a result, whatever they are.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::common::zarr::Array;

/// One array of a result.
pub(crate) struct Numbers {
    /// Names of its dimensions; the first one of many is that of the rows.
    pub(crate) dimensions: Vec<String>,
    pub(crate) shape: Vec<usize>,
    /// Its numbers, the last dimension fastest. Counts are exact.
    pub(crate) values: Vec<f64>,
}

/// All arrays of a result, by name.
pub(crate) struct Stored(pub(crate) BTreeMap<String, Numbers>);

impl Stored {
    /// Reads a result without this project's reader.
    pub(crate) fn read(result: &Path) -> Stored {
        let mut arrays = BTreeMap::new();
        for entry in fs::read_dir(result).unwrap() {
            let entry = entry.unwrap();
            let Some(array) = Array::read(&entry.path()) else { continue };
            let dimensions = array.dimensions();
            let numbers = Numbers { dimensions, shape: array.shape, values: array.values };
            arrays.insert(entry.file_name().into_string().unwrap(), numbers);
        }
        Stored(arrays)
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> usize {
        self.0["load"].values.len()
    }

    /// What differs from `other`: the array that differs most, relative to its largest number; `None` where every bit is the same.
    pub(crate) fn compare(&self, other: &Stored) -> Option<String> {
        let missing =
            |of: &Stored, from: &Stored| of.0.keys().find(|name| !from.0.contains_key(*name)).cloned();
        if let Some(name) = missing(self, other).or_else(|| missing(other, self)) {
            return Some(format!("only one has {name}"));
        }
        let mut largest: Option<(f64, String)> = None;
        for (name, old) in &self.0 {
            let new = &other.0[name];
            if old.shape != new.shape {
                return Some(format!(
                    "{name} has the shape {:?} in one, {:?} in the other",
                    old.shape, new.shape
                ));
            }
            let Some(difference) = difference(&old.values, &new.values) else { continue };
            if largest.as_ref().is_none_or(|(before, _)| difference > *before) {
                largest = Some((difference, name.clone()));
            }
        }
        largest.map(|(difference, name)| format!("{difference:.1e} of the largest in {name}"))
    }
}

/// Largest difference relative to the largest number, infinite where one is no number; `None` where all bits are the same.
fn difference(old: &[f64], new: &[f64]) -> Option<f64> {
    let same = old.iter().zip(new).all(|(old, new)| old.to_bits() == new.to_bits());
    let size = old.iter().filter(|x| x.is_finite()).fold(f64::MIN_POSITIVE, |size, x| size.max(x.abs()));
    let apart = |(old, new): (&f64, &f64)| match old.to_bits() == new.to_bits() {
        true => 0.0,
        false if (old - new).is_finite() => (old - new).abs() / size,
        false => f64::INFINITY,
    };
    (!same).then(|| old.iter().zip(new).map(apart).fold(0.0, f64::max))
}
