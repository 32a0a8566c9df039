//! Chunks: the files that hold the numbers of an array.

use std::fs;
use std::path::{Path, PathBuf};

use ndarray::{Array2, ArrayView2, s};
use rayon::prelude::*;

use super::codec::{Codec, Number};
use super::error::{Result, StoreError, corrupt, io};
use super::layout::{ArraySpec, DataType};
use crate::resources;

/// The chunks of one array.
pub(super) struct Chunks {
    /// The directory of the array.
    root: PathBuf,
    /// Cells of a chunk along each dimension.
    chunk: Vec<usize>,
    data_type: DataType,
    codec: Codec,
}

impl Chunks {
    pub(super) fn new(root: &Path, spec: &ArraySpec) -> Self {
        let (root, chunk) = (root.join(spec.name()), spec.chunk());
        Chunks { root, chunk, data_type: spec.data_type, codec: Codec::of(spec) }
    }

    /// The file of a chunk: `c/1/0` of the array.
    pub(super) fn path(&self, index: &[u64]) -> PathBuf {
        index.iter().fold(self.root.join("c"), |path, n| path.join(n.to_string()))
    }

    /// Writes the numbers of an array of one chunk, and makes its directory.
    pub(super) fn write_whole(&self, numbers: &[f64]) -> Result<()> {
        let index = vec![0; self.chunk.len()];
        let bytes = numbers.iter().flat_map(|number| self.data_type.to_bytes(*number)).collect();
        self.make_directory(&index)?;
        self.put(&index, self.codec.encode_bytes(bytes, 0))
    }

    /// Reads the numbers of an array of one chunk.
    pub(super) fn read_whole(&self) -> Result<Vec<f64>> {
        let bytes = self.decoded(&vec![0; self.chunk.len()])?;
        Ok(bytes.as_chunks().0.iter().map(|bytes| self.data_type.number(*bytes)).collect())
    }

    fn make_directory(&self, index: &[u64]) -> Result<()> {
        let path = self.path(index);
        let directory = path.parent().unwrap_or(&self.root);
        fs::create_dir_all(directory).map_err(io("make", directory))
    }

    fn put(&self, index: &[u64], encoded: std::io::Result<Vec<u8>>) -> Result<()> {
        let path = self.path(index);
        encoded.and_then(|bytes| fs::write(&path, bytes)).map_err(io("write", &path))
    }

    /// Compares a chunk with its checksum and its length; in results of form 1, with the checksum of its compression.
    pub(super) fn verify(&self, index: &[u64]) -> Result<()> {
        self.decoded(index).map(drop)
    }

    /// The bytes of the numbers of a chunk; a missing or damaged one is an error.
    fn decoded(&self, index: &[u64]) -> Result<Vec<u8>> {
        let bytes = self.bytes(index)?;
        self.codec.decode(bytes).map_err(|what| corrupt(&self.path(index), what))
    }

    /// The file of a chunk as it is.
    pub(super) fn bytes(&self, index: &[u64]) -> Result<Vec<u8>> {
        self.find(index)?;
        let path = self.path(index);
        resources::read(&path).map_err(io("read", &path))
    }

    /// Checks that a chunk exists and is not larger than its numbers can be, before memory is allocated.
    fn find(&self, index: &[u64]) -> Result<()> {
        let path = self.path(index);
        let length = match fs::metadata(&path) {
            Ok(file) if !file.is_file() => return Err(corrupt(&path, resources::no_file(file.file_type()))),
            Ok(file) => file.len(),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                return Err(corrupt(&path, "the chunk is missing"));
            }
            Err(source) => return Err(StoreError::Io { path, action: "read", source }),
        };
        if length > self.codec.longest() {
            return Err(corrupt(
                &path,
                format_args!("the chunk has {length} bytes, more than its numbers need"),
            ));
        }
        Ok(())
    }

    /// Writes a map over the last two dimensions, or the last one of a line; `lead` holds the index of the dimensions before.
    pub(super) fn write_map<T: Number>(&self, lead: &[u64], map: ArrayView2<'_, T>) -> Result<()> {
        let (blocks, [side_x, side_y]) = self.blocks(lead, map.dim());
        for block in &blocks {
            if block.y.start == 0 {
                self.make_directory(&block.index)?;
            }
        }
        blocks.par_iter().try_for_each(|block| {
            let part = map.slice(s![block.x.clone(), block.y.clone()]);
            let Some(&first) = part.first() else { return Ok(()) };
            // Chunks at the far edges are padded to full size with a value that deflates.
            let mut cells = vec![first; side_x * side_y];
            for (row, cells) in part.rows().into_iter().zip(cells.chunks_mut(side_y)) {
                cells.iter_mut().zip(row).for_each(|(cell, value)| *cell = *value);
            }
            self.put(&block.index, self.codec.encode(&cells))
        })
    }

    /// Compares all chunks of a map with their checksums.
    pub(super) fn verify_map(&self, lead: &[u64], shape: (usize, usize)) -> Result<()> {
        self.blocks(lead, shape).0.par_iter().try_for_each(|block| self.verify(&block.index))
    }

    /// The inverse of [`write_map`](Self::write_map).
    pub(super) fn read_map<T: Number>(&self, lead: &[u64], shape: (usize, usize)) -> Result<Array2<T>> {
        let (blocks, [_, side_y]) = self.blocks(lead, shape);
        blocks.iter().try_for_each(|block| self.find(&block.index))?;
        let mut map = Array2::<T>::default(shape);
        // A few chunks at a time, so that little more than the map itself is held.
        for batch in blocks.chunks(4 * rayon::current_num_threads()) {
            let read = |block: &Block| self.decoded(&block.index).map(|bytes| T::from_bytes(&bytes));
            let parts: Vec<Vec<T>> = batch.par_iter().map(read).collect::<Result<_>>()?;
            for (block, cells) in batch.iter().zip(parts) {
                let mut part = map.slice_mut(s![block.x.clone(), block.y.clone()]);
                for (mut row, cells) in part.rows_mut().into_iter().zip(cells.chunks(side_y)) {
                    row.iter_mut().zip(cells).for_each(|(value, cell)| *value = *cell);
                }
            }
        }
        Ok(map)
    }

    /// The chunks that cover a map, and the sides of a chunk. After the dimensions of `lead`, the maps of a line have one dimension.
    fn blocks(&self, lead: &[u64], (nx, ny): (usize, usize)) -> (Vec<Block>, [usize; 2]) {
        let own = self.chunk.get(lead.len()..).unwrap_or_default();
        let (line, sides) = match *own {
            [side] => (true, [side, 1]),
            [side_x, side_y] => (false, [side_x, side_y]),
            _ => (false, [nx, ny]),
        };
        let pieces = |cells: usize, side: usize| {
            (0..cells.div_ceil(side)).map(move |k| (k as u64, k * side..cells.min((k + 1) * side)))
        };
        let mut blocks = Vec::new();
        for (i, x) in pieces(nx, sides[0]) {
            for (j, y) in pieces(ny, sides[1]) {
                let place = [i, j].into_iter().take(if line { 1 } else { 2 });
                let index = lead.iter().copied().chain(place).collect();
                blocks.push(Block { index, x: x.clone(), y });
            }
        }
        (blocks, sides)
    }
}

/// One chunk of a map: its index and the cells it covers.
struct Block {
    index: Vec<u64>,
    x: std::ops::Range<usize>,
    y: std::ops::Range<usize>,
}
