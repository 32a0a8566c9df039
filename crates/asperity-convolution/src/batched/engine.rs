//! The three passes: rows forward, columns forward and back, rows back.

use std::sync::{Mutex, PoisonError};

use ndarray::ArrayView2;
use rayon::prelude::*;

use super::Spectrum;
use super::complex::Complex;
use super::factors::Factors;
use super::leaf::Energy;
use super::prefetch::PrefetchAhead;
use super::rows::{ForwardRows, InverseRows, Rows};
use super::transform::Transform;
use super::vector::{Kernel, Scalar, Vector};
use super::work::{Scratch, SharedTiles, block_stride};

/// A planned convolution in vectors of one kind.
pub struct Engine<V: Vector> {
    /// nx.
    rows: usize,
    row_plan: Rows<V::Scalar>,
    column_plan: Transform<V::Scalar>,
    /// The multipliers of every block of columns, digit-reversed along x.
    spectra: Vec<Vec<V>>,
    /// The half spectrum, see `work`.
    work: Vec<Complex<V>>,
    stride: usize,
    /// One buffer per thread. A lock is held while a block is processed, and is never contended.
    scratch: Vec<Mutex<Scratch<V>>>,
    /// The energy of every column, block by block.
    energies: Vec<V>,
    /// Position of the column of each frequency ky.
    columns: Vec<usize>,
}

/// Number of rows that a caller modifies together: that of the lanes of the widest vectors, so that a group starts at a multiple
/// of eight cells.
fn group<V: Vector>() -> usize {
    V::LANES.max(64 / size_of::<V::Scalar>())
}

impl<V: Vector> Engine<V> {
    /// See [`super::BatchedFft::with_spectra`]; the factors are those of mx and my/2.
    pub fn new(
        cells: [usize; 2],
        lengths: [usize; 2],
        [along_x, along_y]: [&Factors; 2],
        spectra: Vec<Spectrum<'_>>,
    ) -> Self {
        let [nx, ny] = cells;
        let [mx, my] = lengths;
        let row_plan = Rows::new(ny, Transform::new(along_y, 2 * ny <= my), V::LANES);
        let column_plan = Transform::new(along_x, 2 * nx <= mx);
        // An array that was handed over is given back before the other memory is taken.
        let blocked =
            |spectrum: Spectrum| blocked_spectrum(lengths, &row_plan, &column_plan, spectrum.view());
        let spectra: Vec<Vec<V>> = spectra.into_iter().map(blocked).collect();
        let frequencies = row_plan.frequencies(V::LANES);
        let mut columns = vec![0; my / 2 + 1];
        frequencies.iter().enumerate().for_each(|(column, ky)| columns[*ky] = column);
        let blocks = frequencies.len() / V::LANES;
        let stride = block_stride::<V>(nx);
        let [packed, half] = row_plan.scratch(V::LANES);
        let scratch =
            || Scratch::new(packed.max(column_plan.signal_length()), half.max(mx), group::<V>() * ny);
        Engine {
            rows: nx,
            spectra,
            work: vec![Complex::zero(); blocks * stride],
            stride,
            scratch: (0..rayon::current_num_threads()).map(|_| Mutex::new(scratch())).collect(),
            energies: vec![V::splat(V::Scalar::default()); blocks],
            columns,
            row_plan,
            column_plan,
        }
    }

    /// Cells of a group of rows.
    fn group_cells(&self) -> usize {
        group::<V>() * self.row_plan.cells()
    }

    /// For every group of rows: the inverse transform, then `modify(first, rows, kept)`, and if `forward` is set the forward
    /// transform.
    fn modify_rows<K: Send>(
        &mut self,
        kept: impl IndexedParallelIterator<Item = K>,
        modify: impl Fn(usize, &mut [V::Scalar], K) + Sync,
        forward: bool,
    ) {
        let (nx, ny, plan, scratch) = (self.rows, self.row_plan.cells(), &self.row_plan, &self.scratch);
        let group = group::<V>();
        assert_eq!(kept.len(), nx.div_ceil(group));
        let tiles = SharedTiles::new(&mut self.work, self.stride);
        kept.enumerate().for_each(|(n, kept)| {
            let rows = n * group..nx.min((n + 1) * group);
            // SAFETY: every group of rows is visited once; its blocks have no row in common, and are read before they are
            // written.
            let tiles = |first: usize, cells: &[V::Scalar]| unsafe { tiles.of_rows(first, cells.len() / ny) };
            with_scratch(scratch, |scratch| {
                let mut buffer = std::mem::take(&mut scratch.rows);
                let cells = &mut buffer[..rows.len() * ny];
                for (rows, first) in cells.chunks_mut(V::LANES * ny).zip(rows.clone().step_by(V::LANES)) {
                    let tiles = tiles(first, rows);
                    V::vectorize(InverseRows { plan, tiles, rows, scratch });
                }
                modify(rows.start * ny, cells, kept);
                if forward {
                    for (rows, first) in cells.chunks(V::LANES * ny).zip(rows.step_by(V::LANES)) {
                        let tiles = tiles(first, rows);
                        V::vectorize(ForwardRows { plan, rows, tiles, scratch });
                    }
                }
                scratch.rows = buffer;
            });
        });
    }
}

/// The multiplier in the order in which the columns use it.
///
/// Both passes over rows return twice the result, and both transforms omit the factor 1/m.
fn blocked_spectrum<V: Vector>(
    [mx, my]: [usize; 2],
    row_plan: &Rows<V::Scalar>,
    column_plan: &Transform<V::Scalar>,
    spectrum: ArrayView2<f64>,
) -> Vec<V> {
    let scale = 0.5 / (mx as f64 * my as f64);
    let stored = column_plan.mirrored_length();
    let mut frequencies = vec![0; mx];
    for (kx, position) in column_plan.positions().into_iter().enumerate() {
        frequencies[position] = kx.min(mx - kx);
    }
    let columns = row_plan.frequencies(V::LANES);
    let mut blocked = vec![V::splat(V::Scalar::default()); columns.len() / V::LANES * stored];
    blocked.par_chunks_mut(stored).zip(columns.par_chunks(V::LANES)).for_each(|(blocked, columns)| {
        for (lanes, kx) in blocked.iter_mut().zip(&frequencies) {
            for (s, ky) in lanes.scalars_mut().iter_mut().zip(columns) {
                *s = V::Scalar::nearest(spectrum[(*kx, *ky)] * scale);
            }
        }
    });
    blocked
}

/// Transforms one block of columns, multiplies it, and transforms it back.
struct Columns<'a, V: Vector> {
    plan: &'a Transform<V::Scalar>,
    columns: &'a mut [Complex<V>],
    stride: usize,
    spectrum: &'a [V],
    energy: &'a mut Energy<V>,
    scratch: &'a mut Scratch<V>,
}

impl<V: Vector> Kernel for Columns<'_, V> {
    #[inline(always)]
    fn run(self) {
        let (margin, transform) = self.scratch.buffers(self.plan.signal_length(), self.plan.length());
        // A vector on the stack aligns the stack, and with it the values that the butterflies spill.
        std::hint::black_box(&Complex::<V>::zero());
        // The following block is likely the next of this thread.
        let following = self.columns.as_ptr().wrapping_add(self.stride);
        let mut ahead = PrefetchAhead::of(following, self.columns.len(), self.plan.steps());
        self.plan.convolve(self.columns, margin, transform, self.spectrum, self.energy, &mut ahead);
    }
}

/// The operation of a caller on a group of rows: its arguments are the number of the first cell, the convolved rows, and the same
/// cells of a field of the caller (empty if there is none).
pub type Modify<'a, T> = dyn Fn(usize, &mut [T], &mut [T]) + Sync + 'a;

/// The passes of a convolution, for any kind of vector.
pub trait Convolve<T>: Send {
    /// The rows of the input, forward.
    fn forward(&mut self, input: &[T]);

    /// Multiplies the columns by a spectrum S. Returns x'S x of the field x.
    fn multiply(&mut self, spectrum: usize) -> f64;

    /// The rows back into `output`.
    fn back(&mut self, output: &mut [T]);

    /// The rows back, through `modify`, and forward again if requested. `kept` is empty or a field.
    fn modify(&mut self, kept: &mut [T], modify: &Modify<T>, forward: bool);
}

impl<V: Vector> Convolve<V::Scalar> for Engine<V> {
    fn forward(&mut self, input: &[V::Scalar]) {
        let (ny, plan, scratch) = (self.row_plan.cells(), &self.row_plan, &self.scratch);
        assert_eq!(input.len(), self.rows * ny);
        let tiles = SharedTiles::new(&mut self.work, self.stride);
        input.par_chunks(V::LANES * ny).enumerate().for_each(|(n, rows)| {
            // SAFETY: every block of rows is visited once, and blocks have no row in common.
            let tiles = unsafe { tiles.of_rows(n * V::LANES, rows.len() / ny) };
            with_scratch(scratch, |scratch| V::vectorize(ForwardRows { plan, rows, tiles, scratch }));
        });
    }

    fn multiply(&mut self, spectrum: usize) -> f64 {
        let (nx, stride, scratch, plan) = (self.rows, self.stride, &self.scratch, &self.column_plan);
        let spectrum = self.spectra[spectrum].par_chunks(plan.mirrored_length());
        let blocks = self.work.par_chunks_mut(stride).zip(spectrum).zip(&mut self.energies);
        blocks.for_each(|((columns, spectrum), total)| {
            let columns = &mut columns[..nx];
            let mut energy = Energy::zero();
            with_scratch(scratch, |scratch| {
                V::vectorize(Columns { plan, columns, stride, spectrum, energy: &mut energy, scratch });
            });
            *total = energy.total();
        });
        let last = self.columns.len() - 1;
        let mut sum = 0.0;
        for (ky, column) in self.columns.iter().enumerate() {
            let energy = self.energies[column / V::LANES].scalars_mut()[column % V::LANES].widened();
            // The columns 0 < ky < my/2 also represent -ky. Their values are twice those of the field, the spectrum half of it.
            sum += if ky == 0 || ky == last { 0.5 * energy } else { energy };
        }
        sum
    }

    fn back(&mut self, output: &mut [V::Scalar]) {
        let (ny, plan, scratch) = (self.row_plan.cells(), &self.row_plan, &self.scratch);
        assert_eq!(output.len(), self.rows * ny);
        let tiles = SharedTiles::new(&mut self.work, self.stride);
        output.par_chunks_mut(V::LANES * ny).enumerate().for_each(|(n, rows)| {
            // SAFETY: every block of rows is visited once, and blocks have no row in common.
            let tiles = unsafe { tiles.of_rows(n * V::LANES, rows.len() / ny) };
            with_scratch(scratch, |scratch| V::vectorize(InverseRows { plan, tiles, rows, scratch }));
        });
    }

    fn modify(&mut self, kept: &mut [V::Scalar], modify: &Modify<V::Scalar>, forward: bool) {
        assert!(kept.is_empty() || kept.len() == self.rows * self.row_plan.cells());
        if kept.is_empty() {
            let nothing = (0..self.rows.div_ceil(group::<V>())).into_par_iter();
            self.modify_rows(nothing, |first, rows, _| modify(first, rows, &mut []), forward);
        } else {
            let kept = kept.par_chunks_mut(self.group_cells());
            self.modify_rows(kept, modify, forward);
        }
    }
}

/// Runs `work` with the buffers of this thread. `work` must not wait for another thread, which could need the same buffers.
fn with_scratch<V: Vector>(scratch: &[Mutex<Scratch<V>>], work: impl FnOnce(&mut Scratch<V>)) {
    let mine = rayon::current_thread_index().unwrap_or(0) % scratch.len();
    work(&mut scratch[mine].lock().unwrap_or_else(PoisonError::into_inner));
}
