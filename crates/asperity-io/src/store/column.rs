//! A per-step array that grows by one number at a time.
//!
//! Its chunks are not compressed: number n is the eight bytes at 8 n of its chunk, and is written in
//! place. A number becomes visible when the group's document counts it (see [`super::document`]).

use std::fs::{self, File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use asperity::march::Row;

use super::chunks::Chunks;
use super::error::{Result, corrupt, io};
use super::layout::{ArraySpec, Entry, ROWS_PER_CHUNK};

const CHUNK_BYTES: u64 = 8 * ROWS_PER_CHUNK as u64;

/// The writing end of a per-step array.
pub(super) struct Column {
    chunks: Chunks,
    open: Option<(u64, PathBuf, File)>,
}

impl Column {
    pub(super) fn new(root: &Path, spec: &ArraySpec) -> Result<Self> {
        Ok(Column { chunks: Chunks::new(root, spec)?, open: None })
    }

    /// Writes number `index`.
    pub(super) fn put(&mut self, index: usize, bytes: [u8; 8]) -> Result<()> {
        let chunk = (index / ROWS_PER_CHUNK) as u64;
        if self.open.as_ref().is_none_or(|(open, ..)| *open != chunk) {
            let path = self.chunks.path(&[chunk]);
            let directory = path.parent().unwrap_or(&path);
            fs::create_dir_all(directory).map_err(io("make", directory))?;
            let file = OpenOptions::new().write(true).create(true).truncate(false).open(&path);
            let file = file.map_err(io("open", &path))?;
            file.set_len(CHUNK_BYTES).map_err(io("write", &path))?;
            self.open = Some((chunk, path, file));
        }
        if let Some((_, path, file)) = &mut self.open {
            let offset = 8 * (index % ROWS_PER_CHUNK) as u64;
            file.seek(SeekFrom::Start(offset))
                .and_then(|_| file.write_all(&bytes))
                .map_err(io("write", path))?;
        }
        Ok(())
    }
}

/// The first `length` entries of a per-step array, as bytes.
pub(super) fn read(root: &Path, spec: &ArraySpec, length: usize) -> Result<Vec<[u8; 8]>> {
    let chunks = Chunks::new(root, spec)?;
    let mut numbers = Vec::new();
    // A length beyond what the files hold ends at the first missing chunk, not at the memory's end.
    for chunk in 0..length.div_ceil(ROWS_PER_CHUNK) {
        let path = chunks.path(&[chunk as u64]);
        let bytes = chunks.bytes(&[chunk as u64])?;
        if bytes.len() as u64 != CHUNK_BYTES {
            return Err(corrupt(&path, format_args!("{} bytes instead of {CHUNK_BYTES}", bytes.len())));
        }
        let wanted = ROWS_PER_CHUNK.min(length - chunk * ROWS_PER_CHUNK);
        let (entries, _) = bytes.as_chunks::<8>();
        numbers.extend_from_slice(&entries[..wanted.min(entries.len())]);
    }
    Ok(numbers)
}

/// The scalars of a whole column set into their rows.
pub(super) fn fill(rows: &mut [Row], entry: Entry, numbers: &[[u8; 8]]) -> Option<()> {
    rows.iter_mut().zip(numbers).try_for_each(|(row, bytes)| entry.set(row, *bytes))
}
