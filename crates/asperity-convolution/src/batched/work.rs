//! The memory that the passes share.
//!
//! The half spectrum between them: complex numbers in blocks of LANES columns, each block the
//! nx rows of its columns one after the other. The pass over columns takes one block after the other; a block of rows writes a tile, its rows,
//! into every block of columns.

use std::marker::PhantomData;

use super::complex::Complex;
use super::prefetch::{Purpose, prefetch};
use super::vector::Vector;

/// Bytes that keep what is used together apart modulo the page of 4096 bytes. Powers of two would
/// otherwise put it into the same sets of the cache, where it displaces itself, and a load would wait
/// for a store of which it knows the last twelve bits of the address only.
const STAGGER: usize = 1088;

/// From block to block, in complex numbers.
pub fn block_stride<V>(rows: usize) -> usize {
    rows + STAGGER.div_ceil(size_of::<Complex<V>>())
}

/// The buffers of one thread.
pub struct Scratch<V: Vector> {
    /// Rows that a caller visits.
    pub rows: Vec<V::Scalar>,
    numbers: Vec<Complex<V>>,
    /// Where the second buffer starts.
    second: usize,
}

impl<V: Vector> Scratch<V> {
    /// A buffer for a signal and one for its transform, and room for rows of so many cells.
    pub fn new(signal: usize, transform: usize, cells: usize) -> Self {
        let size = size_of::<Complex<V>>();
        let second = ((signal * size).next_multiple_of(4096) + STAGGER).div_ceil(size);
        let rows = vec![V::Scalar::default(); cells];
        Scratch { rows, numbers: vec![Complex::zero(); second + transform], second }
    }

    /// The two, in these lengths.
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

// SAFETY: what is shared is the right to call `of_rows`, whose caller keeps the rows apart.
unsafe impl<V: Send> Sync for SharedTiles<'_, V> {}

/// The tiles of one block of rows, one in every block of columns.
pub struct Tiles<'a, V> {
    start: *mut Complex<V>,
    length: usize,
    stride: usize,
    first: usize,
    count: usize,
    work: PhantomData<&'a mut [Complex<V>]>,
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
        Tiles { start: self.start, length: self.length, stride: self.stride, first, count, work: PhantomData }
    }
}

impl<V> Tiles<'_, V> {
    /// The rows of a block of columns.
    #[inline(always)]
    pub fn tile(&mut self, block: usize) -> &mut [Complex<V>] {
        let offset = block * self.stride + self.first;
        assert!(offset + self.count <= self.length);
        // SAFETY: inside of the borrowed work array; these rows are this value's alone.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(offset), self.count) }
    }

    /// Asks for a tile that will be wanted soon.
    #[inline(always)]
    pub fn prefetch(&self, what: Purpose, block: usize) {
        let offset = block * self.stride + self.first;
        prefetch(what, self.start.wrapping_add(offset), self.count);
    }
}
