//! The state from which a run goes on: one file, replaced as a whole.
//!
//! `checkpoint/state.bin`: eight bytes of magic, the length of a JSON header (u64), the header
//! `{rows, numbers: [{name, count}], fields: [{name, shape}]}`, then the numbers as little-endian doubles, then the
//! CRC-32 of all before it. Form 1 had its numbers without names and is not read. The file lies in a group of its own, so that the
//! directory stays a valid Zarr hierarchy.

use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use asperity::step::Checkpoint;
use flate2::{CrcReader, CrcWriter};
use ndarray::Array2;
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::document;
use super::error::{Result, StoreError, io};
use super::header::Header;
use super::replace::Way;
use super::sync;

/// Directory of the checkpoint in a result.
pub(super) const DIRECTORY: &str = "checkpoint";
const FILE: &str = "state.bin";
const PARTIAL: &str = "state.bin.partial";
/// Copy of the group's document as it was when all was brought to the medium, for results whose own a loss of power cut.
pub(super) const GROUP: &str = "group.json";
pub(super) const GROUP_PARTIAL: &str = "group.json.partial";
/// Names of the files in the directory.
pub(super) const FILES: [&str; 4] = [FILE, PARTIAL, GROUP, GROUP_PARTIAL];
const MAGIC: &[u8; 7] = b"ASPCHK\0";
/// Number of the form, after the magic.
const FORM: u8 = 2;
const LONGEST_HEADER: u64 = 1 << 20;
const BUFFER: usize = 1 << 18;

#[derive(Serialize, Deserialize)]
struct Contents {
    rows: usize,
    numbers: Vec<Count>,
    fields: Vec<FieldShape>,
}

#[derive(Serialize, Deserialize)]
struct Count {
    name: String,
    count: usize,
}

#[derive(Serialize, Deserialize)]
struct FieldShape {
    name: String,
    shape: (usize, usize),
}

/// Replaces the checkpoint of the result at `root`; with `is_synced` it is on the medium when this returns.
pub(super) fn write(root: &Path, checkpoint: &Checkpoint, is_synced: bool) -> Result<()> {
    let directory = directory(root)?;
    let (path, partial) = (directory.join(FILE), directory.join(PARTIAL));
    let written = write_file(&partial, checkpoint, is_synced).and_then(|()| fs::rename(&partial, &path));
    written.map_err(|source| {
        let _ = fs::remove_file(&partial);
        StoreError::Io { path, action: "write", source }
    })?;
    if is_synced {
        sync::directory(&directory);
        sync::directory(root);
    }
    Ok(())
}

/// The directory of the checkpoint, made where it is missing.
pub(super) fn directory(root: &Path) -> Result<PathBuf> {
    let directory = root.join(DIRECTORY);
    if !directory.is_dir() {
        let attributes = json!({"long_name": "state from which the run goes on"});
        let group = json!({"zarr_format": 3, "node_type": "group", "attributes": attributes});
        document::write(&directory, &group, Way::Safe)?;
    }
    Ok(directory)
}

fn write_file(path: &Path, checkpoint: &Checkpoint, is_synced: bool) -> std::io::Result<()> {
    let (numbers, fields) = (checkpoint.numbers.iter(), checkpoint.fields.iter());
    let contents = Contents {
        rows: checkpoint.step,
        numbers: numbers.map(|(name, n)| Count { name: name.clone(), count: n.len() }).collect(),
        fields: fields.map(|(name, f)| FieldShape { name: name.clone(), shape: f.dim() }).collect(),
    };
    let header = serde_json::to_vec(&contents)?;
    let mut file = BufWriter::with_capacity(BUFFER, CrcWriter::new(File::create(path)?));
    file.write_all(MAGIC)?;
    file.write_all(&[FORM])?;
    file.write_all(&(header.len() as u64).to_le_bytes())?;
    file.write_all(&header)?;
    let numbers = checkpoint.numbers.iter().flat_map(|(_, numbers)| numbers.iter());
    for number in numbers.chain(checkpoint.fields.iter().flat_map(|(_, field)| field.iter())) {
        file.write_all(&number.to_le_bytes())?;
    }
    file.flush()?;
    let sum = file.get_ref().crc().sum();
    file.write_all(&sum.to_le_bytes())?;
    file.flush()?;
    if is_synced { file.get_ref().get_ref().sync_data() } else { Ok(()) }
}

/// The checkpoint of the result at `root`, whose header and number of rows are given; `None` if none was written.
pub(super) fn read(root: &Path, header: &Header, rows: usize) -> Result<Option<Checkpoint<'static>>> {
    let path = path(root);
    let file = match crate::resources::open(&path) {
        Ok(file) => file,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(None),
        Err(source) => return Err(StoreError::Io { path, action: "read", source }),
    };
    let length = file.metadata().map_err(io("read", &path))?.len();
    let former =
        || StoreError::FormerCheckpoint { path: path.clone(), version: header.version.clone(), rows };
    read_file(&path, file, length, former).map(Some)
}

/// The error of a checkpoint that cannot be used.
pub(super) fn damaged(path: &Path, what: &str) -> StoreError {
    let hint = "remove it, then --resume starts from the beginning";
    StoreError::Corrupt { path: path.to_owned(), what: what.to_owned(), hint }
}

/// The file of the checkpoint.
pub(super) fn path(root: &Path) -> PathBuf {
    root.join(DIRECTORY).join(FILE)
}

/// Reads a checkpoint of this form; the error of an earlier one is `former`.
fn read_file(
    path: &Path,
    file: File,
    length: u64,
    former: impl Fn() -> StoreError,
) -> Result<Checkpoint<'static>> {
    let damaged = |what: &str| damaged(path, what);
    let unreadable = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::UnexpectedEof => damaged("it ends too early"),
        _ => io("read", path)(error),
    };
    let mut file = CrcReader::new(BufReader::with_capacity(BUFFER, file));
    let mut prefix = [0; 16];
    file.read_exact(&mut prefix).map_err(unreadable)?;
    let (magic, size) = prefix.split_at(8);
    match magic.split_last() {
        Some((&FORM, magic)) if magic == MAGIC => {}
        Some((form, magic)) if magic == MAGIC && (1..FORM).contains(form) => return Err(former()),
        _ => return Err(damaged("it does not begin as a checkpoint of this version")),
    }
    let size = size.try_into().map_or(u64::MAX, u64::from_le_bytes);
    if size > LONGEST_HEADER.min(length) {
        return Err(damaged("its header is too long"));
    }
    let mut header = vec![0; size as usize];
    file.read_exact(&mut header).map_err(unreadable)?;
    let contents: Contents =
        serde_json::from_slice(&header).map_err(|error| damaged(&format!("its header: {error}")))?;
    // The length of the file has to be that of the header's numbers before memory is asked for.
    let cells = contents.fields.iter().map(|field| field.shape.0.checked_mul(field.shape.1));
    let mut counts = contents.numbers.iter().map(|numbers| Some(numbers.count)).chain(cells);
    let numbers = counts.try_fold(0_usize, |sum, count| sum.checked_add(count?));
    let expected = numbers.and_then(|n| (n as u64).checked_mul(8)).and_then(|n| n.checked_add(16 + size + 4));
    if expected != Some(length) {
        return Err(damaged("its length is not that of its contents"));
    }
    let mut read = |count: usize| -> Result<Vec<f64>> {
        let mut bytes = vec![0; 8 * count];
        file.read_exact(&mut bytes).map_err(unreadable)?;
        Ok(bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect())
    };
    let mut numbers = Vec::with_capacity(contents.numbers.len());
    for Count { name, count } in contents.numbers {
        numbers.push((name, read(count)?));
    }
    let mut fields = Vec::with_capacity(contents.fields.len());
    for FieldShape { name, shape } in contents.fields {
        let field = Array2::from_shape_vec(shape, read(shape.0 * shape.1)?);
        let field = field.map_err(|error| damaged(&error.to_string()))?;
        fields.push((name, field.into()));
    }
    let (found, mut stated) = (file.crc().sum(), [0; 4]);
    file.read_exact(&mut stated).map_err(unreadable)?;
    if u32::from_le_bytes(stated) != found {
        return Err(damaged("its checksum is wrong"));
    }
    Ok(Checkpoint { step: contents.rows, numbers, fields })
}
