//! Comparing every file of a result with its checksum.

use std::path::{Path, PathBuf};

use super::checkpoint;
use super::chunks::Chunks;
use super::error::{Result, StoreError};
use super::layout::ArraySpec;
use super::reader::Reader;

/// What was found in a result.
#[derive(Debug)]
pub struct Verification {
    /// Arrays that were read.
    pub arrays: usize,
    /// Chunks that were read.
    pub chunks: u64,
    /// Whether every number has a checksum. Results of format version 1 have one for compressed fields only.
    pub has_checksums: bool,
    /// What is damaged, in the order of the arrays.
    pub damage: Vec<Damage>,
}

/// A file that is missing or does not have its checksum.
#[derive(Clone, Debug, PartialEq)]
pub struct Damage {
    /// The file, or the directory of an array whose rows are damaged.
    pub path: PathBuf,
    /// What is wrong with it.
    pub what: String,
}

/// Reads the result at `path` whole and compares all numbers, the documents and the checkpoint with their checksums.
///
/// # Errors
/// [`StoreError::NotAResult`] and [`StoreError::Newer`] where it cannot be judged, [`StoreError::Io`] where the system
/// refuses. Damage is no error but part of the answer.
pub fn verify(path: &Path) -> Result<Verification> {
    let mut found = Verification { arrays: 0, chunks: 0, has_checksums: true, damage: vec![] };
    let reader = match Reader::open(path) {
        Ok(reader) => reader,
        Err(error) => {
            found.note(Err(error))?;
            return Ok(found);
        }
    };
    found.has_checksums = reader.document().form > 1;
    for array in reader.document().arrays() {
        found.arrays += 1;
        if array.grows() {
            let rows = if super::layout::is_of_rows(array.dimensions[0]) {
                reader.len()
            } else {
                reader.field_times().len()
            };
            found.chunks += rows.div_ceil(array.chunk[0].max(1)) as u64;
            found.note(reader.column(array.name, rows).map(drop))?;
            continue;
        }
        let chunks = Chunks::new(path, &array)?;
        for index in indices(&array) {
            // The stress may be stored for some of the instants only.
            let of_stress = reader.stress().filter(|_| array.name.starts_with("stress_"));
            if of_stress.is_some_and(|set| !set.instants.contains(&(index[0] as usize))) {
                continue;
            }
            found.chunks += 1;
            found.note(chunks.verify(&index))?;
        }
    }
    // A complete result says of its rows what no checksum does: their order.
    if found.damage.is_empty() {
        found.note(reader.rows().map(drop))?;
    }
    found.note(checkpoint::read(path).map(drop))?;
    Ok(found)
}

impl Verification {
    fn note(&mut self, read: Result<()>) -> Result<()> {
        match read {
            Err(StoreError::Corrupt { path, what, .. }) => self.damage.push(Damage { path, what }),
            other => other?,
        }
        Ok(())
    }
}

/// The indices of the chunks of an array, the last one fastest.
fn indices(array: &ArraySpec) -> impl Iterator<Item = Vec<u64>> + use<> {
    let counts: Vec<u64> =
        array.shape.iter().zip(&array.chunk).map(|(cells, side)| cells.div_ceil(*side) as u64).collect();
    (0..counts.iter().product()).map(move |mut rest: u64| {
        let mut index: Vec<u64> = counts
            .iter()
            .rev()
            .map(|count| {
                let digit = rest % count;
                rest /= count;
                digit
            })
            .collect();
        index.reverse();
        index
    })
}

#[cfg(test)]
mod tests {
    use super::super::layout::{ArraySpec, Series};
    use super::*;

    #[test]
    fn every_chunk_has_one_index() {
        let series = Series { name: "pressure", units: "Pa", long_name: "" };
        let mut array = ArraySpec::coordinate_of(&series, &["field_time", "x", "y"], 1);
        (array.shape, array.chunk) = (vec![2, 300, 250], vec![1, 150, 250]);
        let all: Vec<_> = indices(&array).collect();
        assert_eq!(all, [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]);
    }
}
