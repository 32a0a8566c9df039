//! Chunks: the files that hold the numbers, encoded and decoded by zarrs.

use std::fs;
use std::io::Read;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use flate2::read::GzDecoder;
use ndarray::{Array2, ArrayView2, s};
use rayon::prelude::*;
use zarrs::array::{
    Array, ArrayBytes, ArrayToBytesCodecTraits, CodecOptions, Element, ElementOwned, FromArrayBytes,
};

use super::error::{Result, StoreError, corrupt, io};
use super::layout::{ArraySpec, LEVEL};
use crate::resources;

/// The chunks of one array.
pub(super) struct Chunks {
    root: PathBuf,
    chunk: Vec<usize>,
    sides: Vec<NonZeroU64>,
    /// Codecs that squeeze, and those of the same format that only wrap.
    deflated: Array<()>,
    wrapped: Array<()>,
    /// The codec of the numbers alone.
    plain: Array<()>,
    /// Bytes of the numbers of a chunk.
    length: u64,
    compressed: bool,
    summed: bool,
}

impl Chunks {
    pub(super) fn new(root: &Path, spec: &ArraySpec) -> Result<Self> {
        let array = |spec: &ArraySpec, level| {
            let path = format!("/{}", spec.name);
            let malformed = |error: &dyn std::fmt::Display| corrupt(&root.join(spec.name), error);
            let metadata = serde_json::from_value(spec.document(level)).map_err(|e| malformed(&e))?;
            Array::new_with_metadata(Arc::new(()), &path, metadata).map_err(|e| malformed(&e))
        };
        Ok(Chunks {
            root: root.to_owned(),
            chunk: spec.chunk.clone(),
            sides: spec.chunk.iter().filter_map(|side| NonZeroU64::new(*side as u64)).collect(),
            deflated: array(spec, LEVEL)?,
            wrapped: array(spec, 0)?,
            plain: array(&ArraySpec { compressed: false, summed: false, ..spec.clone() }, 0)?,
            length: (spec.chunk.iter().product::<usize>() * spec.data_type.width()) as u64,
            compressed: spec.compressed,
            summed: spec.summed,
        })
    }

    /// The file of a chunk.
    pub(super) fn path(&self, index: &[u64]) -> PathBuf {
        self.root.join(self.deflated.chunk_key(index).as_str())
    }

    /// Writes one chunk. Numbers that differ from cell to cell do not deflate: they are wrapped only,
    /// thirty times as fast. Repeated ones (no pressure, pressure at the hardness, no contact) do.
    pub(super) fn write<T: Element + PartialEq>(&self, index: &[u64], cells: &[T]) -> Result<()> {
        let repeats = cells.windows(2).filter(|pair| pair[0] == pair[1]).count();
        let array = if repeats >= cells.len() / 8 { &self.deflated } else { &self.wrapped };
        let path = self.path(index);
        let encode = || {
            let bytes = T::to_array_bytes(array.data_type(), cells)?;
            let options = CodecOptions::default().with_concurrent_target(1);
            let encoded =
                array.codecs().encode(bytes, &self.sides, array.data_type(), array.fill_value(), &options);
            Ok::<_, zarrs::array::ArrayError>(encoded?.into_owned())
        };
        let bytes = encode().map_err(|error| corrupt(&path, error))?;
        fs::write(&path, bytes).map_err(io("write", &path))
    }

    /// Reads one chunk; a lost or damaged one is an error.
    pub(super) fn read<T: ElementOwned>(&self, index: &[u64]) -> Result<Vec<T>> {
        let path = self.path(index);
        let bytes = self.unpacked(&path, self.verified(index)?)?;
        let array = &self.plain;
        let decode = || {
            let sides: Vec<u64> = self.sides.iter().map(|side| side.get()).collect();
            let options = CodecOptions::default().with_concurrent_target(1);
            let codecs = array.codecs();
            let decoded: ArrayBytes<'_> =
                codecs.decode(bytes.into(), &self.sides, array.data_type(), array.fill_value(), &options)?;
            Vec::<T>::from_array_bytes(decoded.into_owned(), &sides, array.data_type())
        };
        decode().map_err(|error| corrupt(&path, error))
    }

    /// Compares a chunk with its checksum and its length; in results of form 1, with the checksum of its compression.
    pub(super) fn verify(&self, index: &[u64]) -> Result<()> {
        self.unpacked(&self.path(index), self.verified(index)?).map(drop)
    }

    /// The bytes of a chunk before their checksum.
    fn verified(&self, index: &[u64]) -> Result<Vec<u8>> {
        let mut bytes = self.bytes(index)?;
        if self.summed {
            let sum = bytes.split_last_chunk().map(|(_, sum)| u32::from_le_bytes(*sum));
            bytes.truncate(bytes.len().saturating_sub(4));
            if sum != Some(crc32c::crc32c(&bytes)) {
                return Err(corrupt(&self.path(index), "its checksum is wrong"));
            }
        }
        Ok(bytes)
    }

    /// The bytes of the numbers; what would unpack to more is refused before it does.
    fn unpacked(&self, path: &Path, bytes: Vec<u8>) -> Result<Vec<u8>> {
        let plain = if self.compressed {
            let mut plain = Vec::with_capacity(self.length as usize);
            let unpacked = GzDecoder::new(&bytes[..]).take(self.length + 1).read_to_end(&mut plain);
            unpacked.map_err(|error| corrupt(path, error))?;
            plain
        } else {
            bytes
        };
        if plain.len() as u64 != self.length {
            let more = if plain.len() as u64 > self.length { "more" } else { "fewer" };
            return Err(corrupt(
                path,
                format_args!("it holds {more} than the {} bytes of its numbers", self.length),
            ));
        }
        Ok(plain)
    }

    /// The file of a chunk as it is.
    pub(super) fn bytes(&self, index: &[u64]) -> Result<Vec<u8>> {
        self.find(index)?;
        let path = self.path(index);
        resources::read(&path).map_err(io("read", &path))
    }

    /// Checks that a chunk is there and no larger than its numbers can be, before memory is asked for.
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
        if length > self.length + self.length / 4 + 1024 {
            return Err(corrupt(
                &path,
                format_args!("the chunk has {length} bytes, more than its numbers need"),
            ));
        }
        Ok(())
    }

    /// Writes a map over the last two dimensions, or the last one of a line; `lead` holds the index of the dimensions before.
    pub(super) fn write_map<T>(&self, lead: &[u64], map: ArrayView2<'_, T>) -> Result<()>
    where
        T: Element + PartialEq + Copy + Send + Sync,
    {
        let (blocks, [side_x, side_y]) = self.blocks(lead, map.dim());
        for block in &blocks {
            let path = self.path(&block.index);
            let directory = path.parent().unwrap_or(&self.root);
            if block.y.start == 0 {
                fs::create_dir_all(directory).map_err(io("make", directory))?;
            }
        }
        blocks.par_iter().try_for_each(|block| {
            let part = map.slice(s![block.x.clone(), block.y.clone()]);
            let Some(&first) = part.first() else { return Ok(()) };
            // Chunks at the far edges are padded to full size with a value that deflates.
            let mut cells = vec![first; side_x * side_y];
            for (row, cells) in part.rows().into_iter().zip(cells.chunks_mut(side_y)) {
                for (value, cell) in row.iter().zip(cells) {
                    *cell = *value;
                }
            }
            self.write(&block.index, &cells)
        })
    }

    /// The files of a map.
    pub(super) fn paths(&self, lead: &[u64], shape: (usize, usize)) -> Vec<PathBuf> {
        self.blocks(lead, shape).0.iter().map(|block| self.path(&block.index)).collect()
    }

    /// Compares all chunks of a map with their checksums.
    pub(super) fn verify_map(&self, lead: &[u64], shape: (usize, usize)) -> Result<()> {
        self.blocks(lead, shape).0.par_iter().try_for_each(|block| self.verify(&block.index))
    }

    /// The inverse of [`write_map`](Self::write_map).
    pub(super) fn read_map<T>(&self, lead: &[u64], shape: (usize, usize)) -> Result<Array2<T>>
    where
        T: ElementOwned + Clone + Default + Send + Sync,
    {
        let (blocks, [_, side_y]) = self.blocks(lead, shape);
        blocks.iter().try_for_each(|block| self.find(&block.index))?;
        let mut map = Array2::<T>::default(shape);
        // A few chunks at a time, so that little more than the map itself is held.
        for batch in blocks.chunks(4 * rayon::current_num_threads()) {
            let parts: Vec<Vec<T>> =
                batch.par_iter().map(|block| self.read(&block.index)).collect::<Result<_>>()?;
            for (block, cells) in batch.iter().zip(parts) {
                let mut part = map.slice_mut(s![block.x.clone(), block.y.clone()]);
                for (mut row, cells) in part.rows_mut().into_iter().zip(cells.chunks(side_y)) {
                    for (value, cell) in row.iter_mut().zip(cells) {
                        *value = cell.clone();
                    }
                }
            }
        }
        Ok(map)
    }

    /// The chunks that cover a map, and the sides of a chunk. An array with one dimension after those of `lead` holds a line.
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
