//! The memory that the passes share.
//!
//! It holds the half spectrum: complex numbers in blocks of LANES columns. Each block has the nx rows of its columns one after
//! the other. The pass over columns processes one block after the other. A block of rows writes its rows, a tile, into every
//! block of columns.

use std::marker::PhantomData;

use super::complex::Complex;
use super::prefetch::{Purpose, prefetch};
use super::vector::Vector;

/// Bytes of padding, so that data used together have different addresses modulo the page of 4096 bytes. With powers of two they
/// would otherwise use the same sets of the cache and evict each other, and a load would wait for a store whose address agrees in
/// the last twelve bits.
const STAGGER: usize = 1088;

/// Distance from block to block, in complex numbers.
pub fn block_stride<V>(rows: usize) -> usize {
    rows + STAGGER.div_ceil(size_of::<Complex<V>>())
}

/// The buffers of one thread.
pub struct Scratch<V: Vector> {
    /// Rows for use by a caller.
    pub rows: Vec<V::Scalar>,
    numbers: Vec<Complex<V>>,
    /// Start of the second buffer.
    second: usize,
}

impl<V: Vector> Scratch<V> {
    /// Allocates a buffer for a signal, one for its transform, and one for rows of this number of cells.
    pub fn new(signal: usize, transform: usize, cells: usize) -> Self {
        let size = size_of::<Complex<V>>();
        let second = ((signal * size).next_multiple_of(4096) + STAGGER).div_ceil(size);
        let rows = vec![V::Scalar::default(); cells];
        Scratch { rows, numbers: vec![Complex::zero(); second + transform], second }
    }

    /// The first two buffers, with these lengths.
    #[inline(always)]
    pub fn buffers(&mut self, signal: usize, transform: usize) -> (&mut [Complex<V>], &mut [Complex<V>]) {
        let (first, second) = self.numbers.split_at_mut(self.second);
        (&mut first[..signal], &mut second[..transform])
    }
}

/// The tiles of all blocks of rows, to be used by several threads.
pub struct SharedTiles<'a, V> {
    start: *mut Complex<V>,
    length: usize,
    stride: usize,
    work: PhantomData<&'a mut [Complex<V>]>,
}

// SAFETY: threads share only the right to call `of_rows`, whose caller ensures that rows do not overlap.
unsafe impl<V: Send> Sync for SharedTiles<'_, V> {}

/// The tiles of one block of rows, one in every block of columns.
pub struct Tiles<'a, V> {
    all: SharedTiles<'a, V>,
    first: usize,
    count: usize,
}

impl<'a, V> SharedTiles<'a, V> {
    pub fn new(work: &'a mut [Complex<V>], stride: usize) -> Self {
        SharedTiles { start: work.as_mut_ptr(), length: work.len(), stride, work: PhantomData }
    }

    /// The tiles of rows `first`..`first + count`.
    ///
    /// # Safety
    /// No row may belong to two values that are alive at the same time.
    pub unsafe fn of_rows(&self, first: usize, count: usize) -> Tiles<'a, V> {
        assert!(first + count <= self.stride);
        Tiles { all: SharedTiles { ..*self }, first, count }
    }
}

impl<V> Tiles<'_, V> {
    /// The rows of a block of columns.
    #[inline(always)]
    pub fn tile(&mut self, block: usize) -> &mut [Complex<V>] {
        let offset = block * self.all.stride + self.first;
        assert!(offset + self.count <= self.all.length);
        // SAFETY: inside the borrowed work array; these rows belong only to this value.
        unsafe { std::slice::from_raw_parts_mut(self.all.start.add(offset), self.count) }
    }

    /// Prefetches a tile that will be needed soon.
    #[inline(always)]
    pub fn prefetch(&self, what: Purpose, block: usize) {
        let offset = block * self.all.stride + self.first;
        prefetch(what, self.all.start.wrapping_add(offset), self.count);
    }
}
