//! The three passes: rows forward, columns there and back, rows back.

use std::sync::{Mutex, PoisonError};

use ndarray::ArrayView2;
use rayon::prelude::*;

use super::complex::Complex;
use super::factors::Factors;
use super::lane::{Kernel, Lane, Real};
use super::prefetch::Ahead;
use super::rows::{ForwardRows, InverseRows, Rows};
use super::transform::Transform;
use super::work::{Scratch, SharedTiles, block_stride};

/// A planned convolution in lanes of one kind.
pub struct Engine<V: Lane> {
    /// nx.
    rows: usize,
    row_plan: Rows<V::Scalar>,
    column_plan: Transform<V::Scalar>,
    /// The multiplier of every block of columns, digit-reversed along x.
    spectrum: Vec<V>,
    /// The half spectrum, see `work`.
    work: Vec<Complex<V>>,
    stride: usize,
    /// One for each thread; a lock is held while a block is worked on, and never contended.
    scratch: Vec<Mutex<Scratch<V>>>,
}

impl<V: Lane> Engine<V> {
    /// See [`super::Lanes::new`]; the factors are those of mx and my/2.
    pub fn new(
        cells: [usize; 2],
        lengths: [usize; 2],
        [along_x, along_y]: [&Factors; 2],
        spectrum: ArrayView2<f64>,
    ) -> Self {
        let [nx, ny] = cells;
        let [mx, my] = lengths;
        let row_plan = Rows::new(ny, Transform::new(along_y, 2 * ny <= my), V::LANES);
        let column_plan = Transform::new(along_x, 2 * nx <= mx);
        let spectrum = blocked_spectrum(lengths, &row_plan, &column_plan, spectrum);
        let blocks = spectrum.len() / column_plan.mirrored_length();
        let stride = block_stride::<V>(nx);
        let [packed, half] = row_plan.scratch(V::LANES);
        let scratch = || Scratch::new(packed.max(column_plan.signal_length()), half.max(mx), V::LANES * ny);
        Engine {
            rows: nx,
            spectrum,
            work: vec![Complex::zero(); blocks * stride],
            stride,
            scratch: (0..rayon::current_num_threads()).map(|_| Mutex::new(scratch())).collect(),
            row_plan,
            column_plan,
        }
    }
}

/// The multiplier as the columns meet it.
///
/// Both passes over rows leave their result doubled, and both transforms lack their 1/m.
fn blocked_spectrum<V: Lane>(
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

/// One block of columns: transformed, multiplied, transformed back.
struct Columns<'a, V: Lane> {
    plan: &'a Transform<V::Scalar>,
    columns: &'a mut [Complex<V>],
    stride: usize,
    spectrum: &'a [V],
    scratch: &'a mut Scratch<V>,
}

impl<V: Lane> Kernel for Columns<'_, V> {
    #[inline(always)]
    fn run(self) {
        let (margin, transform) = self.scratch.buffers(self.plan.signal_length(), self.plan.length());
        // A vector on the stack aligns it, and with it whatever the butterflies spill.
        std::hint::black_box(&Complex::<V>::zero());
        // The block that follows is likely the next of this thread.
        let following = self.columns.as_ptr().wrapping_add(self.stride);
        let mut ahead = Ahead::of(following, self.columns.len(), self.plan.steps());
        self.plan.convolve(self.columns, margin, transform, self.spectrum, &mut ahead);
    }
}

/// What is made of a stretch of the input before it is transformed: from its first cell on, into a copy.
pub type Prepare<'a, T> = dyn Fn(usize, &[T], &mut [T]) + Sync + 'a;

/// A convolution, whatever its lanes.
pub trait Convolve<T>: Send {
    /// output = S * what is made of the input.
    fn apply_into(&mut self, input: &[T], prepare: Option<&Prepare<T>>, output: &mut [T]);
}

impl<V: Lane> Convolve<V::Scalar> for Engine<V> {
    fn apply_into(
        &mut self,
        input: &[V::Scalar],
        prepare: Option<&Prepare<V::Scalar>>,
        output: &mut [V::Scalar],
    ) {
        let (nx, ny, stride) = (self.rows, self.row_plan.cells(), self.stride);
        assert!(input.len() == nx * ny && output.len() == nx * ny);
        let block = V::LANES * ny;
        let scratch = &self.scratch;

        let tiles = SharedTiles::new(&mut self.work, stride);
        input.par_chunks(block).enumerate().for_each(|(n, rows)| {
            // SAFETY: every block of rows is visited once, and blocks have no row in common.
            let tiles = unsafe { tiles.of_rows(n * V::LANES, rows.len() / ny) };
            with(scratch, |scratch| {
                let mut prepared = std::mem::take(&mut scratch.prepared);
                let rows = match prepare {
                    Some(prepare) => {
                        let prepared = &mut prepared[..rows.len()];
                        prepare(n * block, rows, prepared);
                        prepared
                    }
                    None => rows,
                };
                V::vectorize(ForwardRows { plan: &self.row_plan, rows, tiles, scratch });
                scratch.prepared = prepared;
            });
        });

        let spectrum = self.spectrum.par_chunks(self.column_plan.mirrored_length());
        self.work.par_chunks_mut(stride).zip(spectrum).for_each(|(columns, spectrum)| {
            let columns = &mut columns[..nx];
            with(scratch, |scratch| {
                V::vectorize(Columns { plan: &self.column_plan, columns, stride, spectrum, scratch });
            });
        });

        output.par_chunks_mut(block).enumerate().for_each(|(n, rows)| {
            with(scratch, |scratch| {
                V::vectorize(InverseRows {
                    plan: &self.row_plan,
                    work: &self.work,
                    stride,
                    start: n * V::LANES,
                    rows,
                    scratch,
                });
            });
        });
    }
}

/// Lends the thread its buffers.
fn with<V: Lane>(scratch: &[Mutex<Scratch<V>>], work: impl FnOnce(&mut Scratch<V>)) {
    let mine = rayon::current_thread_index().unwrap_or(0) % scratch.len();
    work(&mut scratch[mine].lock().unwrap_or_else(PoisonError::into_inner));
}
