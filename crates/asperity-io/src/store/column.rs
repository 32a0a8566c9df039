//! A per-step array that grows by one row at a time, of one number or of several.
//!
//! Its chunks are not compressed: row n is the eight bytes of each of its numbers at their place in its chunk, and is
//! written there. A number becomes visible when the group's document counts it (see [`super::document`]).

use std::fs::{self, File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::checksum::Sums;
use super::chunks::Chunks;
use super::error::{Result, corrupt, io};
use super::layout::{ArraySpec, DataType};

/// The writing end of a per-step array.
pub(super) struct Column {
    chunks: Chunks,
    layout: Layout,
    open: Option<(u64, PathBuf, File)>,
    name: &'static str,
    data_type: DataType,
    /// Rows that readers see, and their checksum.
    rows: usize,
    sum: u32,
    /// The checksum after each row written beyond them.
    later: Vec<u32>,
}

/// How the rows lie in the chunks.
#[derive(Clone, Copy)]
struct Layout {
    /// Rows of a chunk.
    rows: usize,
    /// Numbers of a row, and whether they have a dimension of their own.
    width: usize,
    wide: bool,
}

impl Layout {
    fn of(spec: &ArraySpec) -> Self {
        let chunk = spec.chunk();
        Layout { rows: chunk[0], width: chunk[1..].iter().product(), wide: chunk.len() > 1 }
    }

    fn bytes(self) -> u64 {
        8 * (self.rows * self.width) as u64
    }

    /// Index of a chunk.
    fn index(self, chunk: u64) -> Vec<u64> {
        if self.wide { vec![chunk, 0] } else { vec![chunk] }
    }
}

impl Column {
    /// After the first `rows` rows, whose checksum is in `sums`.
    pub(super) fn new(root: &Path, spec: &ArraySpec, rows: usize, sums: &Sums) -> Self {
        Column {
            chunks: Chunks::new(root, spec),
            layout: Layout::of(spec),
            open: None,
            name: spec.name(),
            data_type: spec.data_type,
            rows,
            sum: sums.get(spec.name()).copied().unwrap_or(0),
            later: Vec::new(),
        }
    }

    /// Numbers of a row.
    pub(super) fn width(&self) -> usize {
        self.layout.width
    }

    /// The checksum of the first `rows` rows, set in `sums`.
    pub(super) fn sum(&self, rows: usize, sums: &mut Sums) {
        let later = rows.checked_sub(self.rows + 1).and_then(|n| self.later.get(n));
        sums.insert(self.name.to_owned(), later.copied().unwrap_or(self.sum));
    }

    /// Readers see the first `rows` rows now.
    pub(super) fn commit(&mut self, rows: usize) {
        let new = rows.saturating_sub(self.rows).min(self.later.len());
        self.sum = self.later.drain(..new).next_back().unwrap_or(self.sum);
        self.rows += new;
    }

    /// Writes row `index`, all of its numbers.
    pub(super) fn put(&mut self, index: usize, numbers: &[f64]) -> Result<()> {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| self.data_type.to_bytes(*number)).collect();
        let layout = self.layout;
        let chunk = (index / layout.rows) as u64;
        if self.open.as_ref().is_none_or(|(open, ..)| *open != chunk) {
            let path = self.chunks.path(&layout.index(chunk));
            let directory = path.parent().unwrap_or(&path);
            fs::create_dir_all(directory).map_err(io("make", directory))?;
            let file = OpenOptions::new().write(true).create(true).truncate(false).open(&path);
            let file = file.map_err(io("open", &path))?;
            file.set_len(layout.bytes()).map_err(io("write", &path))?;
            self.open = Some((chunk, path, file));
        }
        if let Some((_, path, file)) = &mut self.open {
            let offset = 8 * (index % layout.rows * layout.width) as u64;
            file.seek(SeekFrom::Start(offset))
                .and_then(|_| file.write_all(&bytes))
                .map_err(io("write", path))?;
        }
        // A row that could not be committed may be written again.
        self.later.truncate(index.saturating_sub(self.rows));
        let before = self.later.last().copied().unwrap_or(self.sum);
        self.later.push(crc32c::crc32c_append(before, &bytes));
        Ok(())
    }
}

/// The checksum of rows.
pub(super) fn sum(numbers: &[[u8; 8]]) -> u32 {
    crc32c::crc32c(numbers.as_flattened())
}

/// All rows of a per-step array as the bytes of their numbers; compared with their checksum where `sums` has one.
pub(super) fn read(root: &Path, spec: &ArraySpec, sums: &Sums) -> Result<Vec<[u8; 8]>> {
    let numbers = read_unchecked(root, spec)?;
    match sums.get(spec.name()) {
        Some(stored) if *stored != sum(&numbers) => {
            Err(corrupt(&root.join(spec.name()), "its rows do not have the checksum in zarr.json"))
        }
        _ => Ok(numbers),
    }
}

fn read_unchecked(root: &Path, spec: &ArraySpec) -> Result<Vec<[u8; 8]>> {
    let chunks = Chunks::new(root, spec);
    let (layout, length) = (Layout::of(spec), spec.dimensions[0].1);
    let mut numbers = Vec::new();
    // A length beyond what the files hold ends at the first missing chunk, not at the memory's end.
    for chunk in 0..length.div_ceil(layout.rows) {
        let index = layout.index(chunk as u64);
        let bytes = chunks.bytes(&index)?;
        if bytes.len() as u64 != layout.bytes() {
            let what = format_args!("{} bytes instead of {}", bytes.len(), layout.bytes());
            return Err(corrupt(&chunks.path(&index), what));
        }
        let wanted = layout.width * layout.rows.min(length - chunk * layout.rows);
        numbers.extend(bytes.as_chunks::<8>().0.iter().take(wanted));
    }
    Ok(numbers)
}
