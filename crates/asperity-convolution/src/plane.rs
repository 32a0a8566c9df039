//! Two-dimensional transforms of real fields on rustfft, with an operation of the caller on the waves in between.
//!
//! ```text
//! X(kx, ky) = sum over i, j of x(i, j) exp(-2 pi i (kx i/mx + ky j/my))
//! ```
//!
//! The nx rows of a field are padded with zeros and transformed along y; of each row only the waves 0 <= ky <= my/2 are stored,
//! since x is real. They are stored in columns of constant ky: wave ky of row i at `ky * nx + i`. Then one column at a time is
//! padded and transformed along x, and back; the padded plane is never stored. A caller stores the transformed rows of a field if
//! it needs them again, and may multiply the columns by any numbers: complex, odd, or computed on the fly.
//!
//! For real, even spectra [`Convolution`](crate::Convolution) is faster. Forward and back together multiply by mx my.

use std::sync::Arc;

use ndarray::parallel::prelude::*;
use ndarray::{ArrayViewMut2, Axis};
use rayon::slice::ParallelSliceMut;
use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;
use rustfft::num_complex::Complex64;

use crate::fft;

/// Number of rows that are transformed together: their part of a column fills whole cache lines.
const ROWS: usize = 8;

/// Planned transforms of fields of `cells` = \[nx, ny\] on a torus of `lengths` = \[mx, my\]. Bit-identical for any number of
/// threads.
///
/// ```
/// use asperity_convolution::plane::RealPlane;
///
/// // A wave along y, shifted by one cell: times exp(i q dy).
/// let plane = RealPlane::new([4, 8], [4, 8]);
/// let wave = |j: usize| (std::f64::consts::TAU * j as f64 / 8.0).cos();
/// let mut field: Vec<f64> = (0..32).map(|n| wave(n % 8)).collect();
/// let mut columns = plane.columns();
/// plane.rows_forward(&field, &mut columns);
/// plane.each_column(&mut columns, |column, ky, rows| {
///     let phase = std::f64::consts::TAU * ky as f64 / 8.0;
///     column.forward(rows).iter_mut().for_each(|x| *x *= rustfft::num_complex::Complex64::cis(phase) / 32.0);
///     rows.copy_from_slice(column.back());
/// });
/// plane.rows_back(&columns, &mut field);
/// assert!((field[5] - wave(6)).abs() < 1e-15);
/// ```
pub struct RealPlane {
    cells: [usize; 2],
    lengths: [usize; 2],
    rows_forward: Arc<dyn RealToComplex<f64>>,
    rows_back: Arc<dyn ComplexToReal<f64>>,
    columns_forward: Arc<dyn Fft<f64>>,
    columns_back: Arc<dyn Fft<f64>>,
}

impl RealPlane {
    /// Plans the transforms.
    ///
    /// # Panics
    /// If a length is less than the number of cells.
    pub fn new(cells: [usize; 2], lengths: [usize; 2]) -> Self {
        assert!(lengths[0] >= cells[0] && lengths[1] >= cells[1]);
        RealPlane {
            cells,
            lengths,
            rows_forward: fft::real_forward(lengths[1]),
            rows_back: fft::real_inverse(lengths[1]),
            columns_forward: fft::forward(lengths[0]),
            columns_back: fft::inverse(lengths[0]),
        }
    }

    /// mx, my.
    pub fn lengths(&self) -> [usize; 2] {
        self.lengths
    }

    /// Waves along y of a row: my/2 + 1.
    pub fn waves_along_y(&self) -> usize {
        self.lengths[1] / 2 + 1
    }

    /// Allocates the transformed rows of a field: my/2 + 1 columns of nx numbers.
    pub fn columns(&self) -> Vec<Complex64> {
        vec![Complex64::ZERO; self.waves_along_y() * self.cells[0]]
    }

    /// Transforms the rows of a field along y, into columns.
    ///
    /// # Panics
    /// If a length is not that of the plan; this also holds for the functions below.
    pub fn rows_forward(&self, field: &[f64], columns: &mut [Complex64]) {
        let [nx, ny] = self.cells;
        assert_eq!(field.len(), nx * ny);
        self.rows_forward_of(|i, row| row.copy_from_slice(&field[i * ny..][..ny]), columns);
    }

    /// The same for the rows that `read(i, row)` writes.
    pub fn rows_forward_of(&self, read: impl Fn(usize, &mut [f64]) + Sync, columns: &mut [Complex64]) {
        let ([nx, ny], half, fft) = (self.cells, self.waves_along_y(), &self.rows_forward);
        assert_eq!(columns.len(), nx * half);
        if let Ok(mut columns) = ArrayViewMut2::from_shape((half, nx), columns) {
            columns.axis_chunks_iter_mut(Axis(1), ROWS).into_par_iter().enumerate().for_each_init(
                || (fft.make_input_vec(), vec![Complex64::ZERO; ROWS * half], fft.make_scratch_vec()),
                |(input, waves, scratch), (n, mut block)| {
                    for (i, waves) in (0..block.ncols()).zip(waves.chunks_exact_mut(half)) {
                        read(n * ROWS + i, &mut input[..ny]);
                        input[ny..].fill(0.0);
                        let done = fft.process_with_scratch(input, waves, scratch);
                        debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                    }
                    for (ky, mut column) in block.outer_iter_mut().enumerate() {
                        column.iter_mut().enumerate().for_each(|(i, x)| *x = waves[i * half + ky]);
                    }
                },
            );
        }
    }

    /// Computes the first ny numbers of every row from the columns.
    pub fn rows_back(&self, columns: &[Complex64], field: &mut [f64]) {
        let ([nx, ny], my, half, fft) = (self.cells, self.lengths[1], self.waves_along_y(), &self.rows_back);
        assert!(field.len() == nx * ny && columns.len() == nx * half);
        field.par_chunks_mut(ROWS * ny).enumerate().for_each_init(
            || (vec![Complex64::ZERO; ROWS * half], fft.make_output_vec(), fft.make_scratch_vec()),
            |(waves, output, scratch), (block, rows)| {
                for (ky, column) in columns.chunks_exact(nx).enumerate() {
                    let column = &column[ROWS * block..nx.min(ROWS * (block + 1))];
                    column.iter().enumerate().for_each(|(i, x)| waves[i * half + ky] = *x);
                }
                for (row, waves) in rows.chunks_exact_mut(ny).zip(waves.chunks_exact_mut(half)) {
                    // The ends of the spectrum of a real signal are real, except for rounding errors.
                    waves[0].im = 0.0;
                    if my.is_multiple_of(2) {
                        waves[my / 2].im = 0.0;
                    }
                    let done = fft.process_with_scratch(waves, output, scratch);
                    debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                    row.copy_from_slice(&output[..ny]);
                }
            },
        );
    }

    /// The transforms of one column at a time, with separate buffers.
    pub fn column(&self) -> Column<'_> {
        let (forward, back) = (&*self.columns_forward, &*self.columns_back);
        let scratch = forward.get_inplace_scratch_len().max(back.get_inplace_scratch_len());
        Column {
            forward,
            back,
            cells: self.cells[0],
            waves: vec![Complex64::ZERO; self.lengths[0]],
            scratch: vec![Complex64::ZERO; scratch],
        }
    }

    /// Calls `visit(transforms, ky, column)` for every column, on all threads.
    pub fn each_column(
        &self,
        columns: &mut [Complex64],
        visit: impl Fn(&mut Column, usize, &mut [Complex64]) + Sync,
    ) {
        columns
            .par_chunks_mut(self.cells[0])
            .enumerate()
            .for_each_init(|| self.column(), |transforms, (ky, column)| visit(transforms, ky, column));
    }
}

/// The transforms of one column at a time.
pub struct Column<'a> {
    forward: &'a dyn Fft<f64>,
    back: &'a dyn Fft<f64>,
    cells: usize,
    /// X(kx, ky), kx = 0, .., mx - 1: the output of [`forward`](Self::forward) and the input of [`back`](Self::back).
    pub waves: Vec<Complex64>,
    scratch: Vec<Complex64>,
}

impl Column<'_> {
    /// The waves of a column of nx numbers, padded with zeros.
    pub fn forward(&mut self, column: &[Complex64]) -> &mut [Complex64] {
        let mut waves = std::mem::take(&mut self.waves);
        self.forward_into(column, &mut waves);
        self.waves = waves;
        &mut self.waves
    }

    /// The same, into mx numbers of the caller.
    pub fn forward_into(&mut self, column: &[Complex64], waves: &mut [Complex64]) {
        waves[..self.cells].copy_from_slice(column);
        waves[self.cells..].fill(Complex64::ZERO);
        self.forward.process_with_scratch(waves, &mut self.scratch);
    }

    /// The first nx numbers of the column with these waves, multiplied by mx; the waves are overwritten.
    pub fn back(&mut self) -> &[Complex64] {
        self.back.process_with_scratch(&mut self.waves, &mut self.scratch);
        &self.waves[..self.cells]
    }
}
