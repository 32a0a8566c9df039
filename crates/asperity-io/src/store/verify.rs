//! Comparing every file of a result with its checksum.

use std::path::{Path, PathBuf};

use asperity::step::Row;
use ndarray::Dimension;
use serde_json::Value;

use super::checkpoint;
use super::chunks::Chunks;
use super::document::{NAME, read_json};
use super::error::{Result, StoreError, corrupt};
use super::field_kind::FieldKind;
use super::header::Status;
use super::layout::{ArraySpec, Storage};
use super::reader::{At, Reader};

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

/// A file that is missing, does not have its checksum, or is not the one that was written there.
#[derive(Clone, Debug, PartialEq)]
pub struct Damage {
    /// The file, or the directory of an array whose rows are damaged.
    pub path: PathBuf,
    /// What is wrong with it.
    pub what: String,
}

/// Reads the result at `path` whole and compares all numbers, the documents and the checkpoint with their checksums; the documents
/// of the arrays with that of the group; and the fields with their rows, for a file that belongs elsewhere has its own checksum.
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
    let (_, group) = read_json(path)?;
    for array in reader.document().arrays() {
        found.arrays += 1;
        found.note(documents_agree(&reader, &group, &array))?;
        if array.storage == Storage::Rows {
            found.note(has_sum(&reader, &array))?;
            found.chunks += array.dimensions[0].1.div_ceil(array.chunk()[0]) as u64;
            found.note(reader.column(&array).map(drop))?;
            continue;
        }
        let chunks = Chunks::new(path, &array);
        for index in indices(&array).filter(|index| reader.has_map(array.name(), index)) {
            found.chunks += 1;
            found.note(chunks.verify(&index))?;
        }
    }
    if found.damage.is_empty() {
        // A complete result says of its rows what no checksum does: their order.
        match reader.rows() {
            Ok(rows) => {
                for (index, row) in reader.field_steps().iter().map(|step| rows.get(*step)).enumerate() {
                    let row = row
                        .ok_or_else(|| corrupt(&path.join("field_step"), "it names a row that is not there"));
                    found.note(row.and_then(|row| is_of_its_row(&reader, index, row)))?;
                }
            }
            Err(error) => found.note(Err(error))?,
        }
    }
    match checkpoint::read(path, reader.header(), reader.len()) {
        // Not of this version, yet no damage.
        Err(StoreError::FormerCheckpoint { .. }) => {}
        read => found.note(read.map(drop))?,
    }
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

/// Whether the group's document holds the checksum of an array of rows. Results of form 1 and those without rows have none.
fn has_sum(reader: &Reader, array: &ArraySpec) -> Result<()> {
    let document = reader.document();
    if document.form < 2 || reader.is_empty() || document.progress.sums.contains_key(array.name()) {
        return Ok(());
    }
    let what = format!("its list of checksums lacks the array `{}`", array.name());
    Err(corrupt(&reader.path().join(NAME), what))
}

/// Compares the document of an array with what the group's document says of it. Until the run is complete, it may count fewer
/// rows.
fn documents_agree(reader: &Reader, group: &Value, array: &ArraySpec) -> Result<()> {
    let root = reader.path();
    let path = root.join(array.name()).join(NAME);
    let Ok((_, mut own)) = read_json(&root.join(array.name())) else {
        return Err(corrupt(&path, "it is missing or no document of an array"));
    };
    let of_group = &group["consolidated_metadata"]["metadata"][array.name()];
    let grows = reader.document().progress.length_of(array.dimensions[0].0).is_some();
    if grows
        && reader.status() != Status::Complete
        && let Some(length) = own.pointer_mut("/shape/0")
        && length.as_u64() <= of_group["shape"][0].as_u64()
    {
        *length = of_group["shape"][0].clone();
    }
    if own != *of_group {
        return Err(corrupt(&path, format_args!("it is not what {NAME} of the result says of the array")));
    }
    if of_group["attributes"]["units"] != array.series.units {
        let what = format!("it says another unit of `{}` than was written", array.name());
        return Err(corrupt(&root.join(NAME), what));
    }
    Ok(())
}

/// Compares the fields of a stored instant with the numbers of its row.
fn is_of_its_row(reader: &Reader, index: usize, row: &Row) -> Result<()> {
    /// The numbers of a row are sums in another order; surfaces that adhere are in contact up to the tolerance of their solver.
    const ROUNDING: f64 = 1e-9;
    const OF_GAP: f64 = 1e-6;
    let at = At::Index(index);
    if row.coordinate.value() != reader.field_times()[index] {
        return Ok(());
    }
    let close = |a: f64, b: f64, size: f64| (a - b).abs() <= ROUNDING * size.abs();
    for kind in &reader.header().fields {
        let holds = match kind {
            FieldKind::Pressure => {
                let largest = reader.field(*kind, at)?.into_iter().fold(0.0, f64::max);
                close(largest, row.max_pressure, row.max_pressure)
            }
            FieldKind::Gap => {
                let gap = reader.field(*kind, at)?;
                // Beyond the ends of a free track nothing is known.
                if gap.iter().any(|gap| gap.is_nan()) {
                    continue;
                }
                let finite = || gap.iter().filter(|gap| gap.is_finite());
                let mean = finite().sum::<f64>() / finite().count().max(1) as f64;
                let initial = reader.initial_gap()?;
                let open = initial.iter().filter(|gap| gap.is_finite());
                let size = finite().chain(open).fold(row.approach.abs(), |most, gap| most.max(gap.abs()));
                (mean - row.mean_gap).abs() <= OF_GAP * size
            }
            FieldKind::Contact => {
                let cells = reader.contact(at)?.into_iter().filter(|state| *state > 0).count() as f64;
                close(cells, row.contact_fraction * reader.header().grid.len() as f64, cells + 1.0)
            }
            _ => true,
        };
        if !holds {
            let what =
                format!("field number {index} is not that of its row: it comes from another time or result");
            return Err(corrupt(&reader.path().join(kind.name()), what));
        }
    }
    Ok(())
}

/// The indices of the chunks of an array, the last one fastest.
fn indices(array: &ArraySpec) -> impl Iterator<Item = Vec<u64>> + use<> {
    let counts = array.shape().into_iter().zip(array.chunk()).map(|(cells, side)| cells.div_ceil(side));
    let counts: Vec<usize> = counts.collect();
    let index = |place: ndarray::IxDyn| place.slice().iter().map(|n| *n as u64).collect();
    ndarray::indices(counts).into_iter().map(index)
}

#[cfg(test)]
mod tests {
    use super::super::layout::Series;
    use super::*;

    #[test]
    fn every_chunk_has_one_index() {
        let series = Series::new("pressure", "Pa", "");
        let dimensions = [("field_time", 2), ("x", 300), ("y", 250)];
        let array = ArraySpec::new(series, Storage::Maps, &dimensions);
        let all: Vec<_> = indices(&array).collect();
        assert_eq!(all, [[0, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0]]);
    }
}
