//! The portable back end, on rustfft: pruned rows and fused column blocks.
//!
//! Only the nx rows that hold pressure are transformed along y. Then, for a few columns at a time,
//! the column is gathered, padded, transformed along x, multiplied by the spectrum, transformed back
//! and its first nx entries stored: the padded 2N x 2N array never exists. Work memory is
//! nx (my/2 + 1) complex numbers, about 16 bytes per cell of a free domain.

use std::sync::Arc;

use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, Axis};
use rayon::slice::{ParallelSlice, ParallelSliceMut};
use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;
use rustfft::num_complex::Complex;

use super::{Engine, fft};

/// Columns that are gathered together: their row segments fill whole cache lines.
const COLUMNS: usize = 8;

pub(super) struct Pruned {
    cells: [usize; 2],
    lengths: [usize; 2],
    rows_forward: Arc<dyn RealToComplex<f64>>,
    rows_inverse: Arc<dyn ComplexToReal<f64>>,
    columns_forward: Arc<dyn Fft<f64>>,
    columns_inverse: Arc<dyn Fft<f64>>,
    /// S / (mx my), stored (ky, kx) as the columns read it.
    spectrum: Array2<f64>,
    work: Array2<Complex<f64>>,
    scratch: Vec<Scratch>,
}

/// The buffers of one task.
struct Scratch {
    row: Vec<f64>,
    columns: Vec<Complex<f64>>,
    fft: Vec<Complex<f64>>,
}

impl Pruned {
    pub(super) fn new(cells: [usize; 2], lengths: [usize; 2], spectrum: ArrayView2<f64>) -> Self {
        let (rows_forward, rows_inverse) = (fft::real_forward(lengths[1]), fft::real_inverse(lengths[1]));
        let (columns_forward, columns_inverse) = (fft::forward(lengths[0]), fft::inverse(lengths[0]));
        let fft = rows_forward
            .get_scratch_len()
            .max(rows_inverse.get_scratch_len())
            .max(columns_forward.get_inplace_scratch_len())
            .max(columns_inverse.get_inplace_scratch_len());
        let scratch = (0..4 * rayon::current_num_threads())
            .map(|_| Scratch {
                row: vec![0.0; lengths[1]],
                columns: vec![Complex::ZERO; COLUMNS * lengths[0]],
                fft: vec![Complex::ZERO; fft],
            })
            .collect();
        let normalisation = 1.0 / (lengths[0] as f64 * lengths[1] as f64);
        Pruned {
            cells,
            lengths,
            rows_forward,
            rows_inverse,
            columns_forward,
            columns_inverse,
            spectrum: spectrum.t().mapv(|s| s * normalisation).as_standard_layout().into_owned(),
            work: Array2::zeros((cells[0], lengths[1] / 2 + 1)),
            scratch,
        }
    }

    /// Along y: nx padded rows to their half spectra.
    fn forward_rows(&mut self, input: &[f64]) {
        let ny = self.cells[1];
        let rows = self.cells[0].div_ceil(self.scratch.len());
        let fft = &self.rows_forward;
        self.work
            .axis_chunks_iter_mut(Axis(0), rows)
            .into_par_iter()
            .zip(input.par_chunks(rows * ny))
            .zip(&mut self.scratch)
            .for_each(|((mut work, input), scratch)| {
                for (mut transform, row) in work.outer_iter_mut().zip(input.chunks_exact(ny)) {
                    scratch.row[..ny].copy_from_slice(row);
                    scratch.row[ny..].fill(0.0);
                    if let Some(transform) = transform.as_slice_mut() {
                        let done = fft.process_with_scratch(&mut scratch.row, transform, &mut scratch.fft);
                        debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                    }
                }
            });
    }

    /// Along x: forward, times the spectrum, back; a few columns at a time.
    fn columns(&mut self) {
        let [nx, mx] = [self.cells[0], self.lengths[0]];
        let columns = self.work.ncols().div_ceil(self.scratch.len());
        let (forward, inverse, spectrum) = (&self.columns_forward, &self.columns_inverse, &self.spectrum);
        self.work
            .axis_chunks_iter_mut(Axis(1), columns)
            .into_par_iter()
            .zip(spectrum.axis_chunks_iter(Axis(0), columns).into_par_iter())
            .zip(&mut self.scratch)
            .for_each(|((mut work, spectrum), scratch)| {
                let blocks = work.axis_chunks_iter_mut(Axis(1), COLUMNS);
                for (mut block, spectrum) in blocks.zip(spectrum.axis_chunks_iter(Axis(0), COLUMNS)) {
                    let buffer = &mut scratch.columns[..block.ncols() * mx];
                    for (i, row) in block.outer_iter().enumerate() {
                        row.iter().enumerate().for_each(|(c, value)| buffer[c * mx + i] = *value);
                    }
                    buffer.chunks_exact_mut(mx).for_each(|column| column[nx..].fill(Complex::ZERO));
                    forward.process_with_scratch(buffer, &mut scratch.fft);
                    for (column, spectrum) in buffer.chunks_exact_mut(mx).zip(spectrum.outer_iter()) {
                        multiply_even(column, spectrum.as_slice().unwrap_or_default());
                    }
                    inverse.process_with_scratch(buffer, &mut scratch.fft);
                    for (i, mut row) in block.outer_iter_mut().enumerate() {
                        row.iter_mut().enumerate().for_each(|(c, value)| *value = buffer[c * mx + i]);
                    }
                }
            });
    }

    /// Along y, back: half spectra to the first ny values of each row.
    fn inverse_rows(&mut self, output: &mut [f64]) {
        let [ny, my] = [self.cells[1], self.lengths[1]];
        let rows = self.cells[0].div_ceil(self.scratch.len());
        let fft = &self.rows_inverse;
        self.work
            .axis_chunks_iter_mut(Axis(0), rows)
            .into_par_iter()
            .zip(output.par_chunks_mut(rows * ny))
            .zip(&mut self.scratch)
            .for_each(|((mut work, output), scratch)| {
                for (mut transform, row) in work.outer_iter_mut().zip(output.chunks_exact_mut(ny)) {
                    if let Some(transform) = transform.as_slice_mut() {
                        // The ends of a real signal's spectrum are real; rounding left a trace.
                        transform[0].im = 0.0;
                        if my.is_multiple_of(2) {
                            transform[my / 2].im = 0.0;
                        }
                        let done = fft.process_with_scratch(transform, &mut scratch.row, &mut scratch.fft);
                        debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                    }
                    row.copy_from_slice(&scratch.row[..ny]);
                }
            });
    }
}

/// column(k) *= S(min(k, mx - k)).
fn multiply_even(column: &mut [Complex<f64>], spectrum: &[f64]) {
    let mirrored = column.len() - spectrum.len();
    let (first, last) = column.split_at_mut(spectrum.len());
    first.iter_mut().zip(spectrum).for_each(|(c, s)| *c *= *s);
    last.iter_mut().zip(spectrum[1..=mirrored].iter().rev()).for_each(|(c, s)| *c *= *s);
}

impl Engine for Pruned {
    fn apply_into(&mut self, input: &[f64], output: &mut [f64]) {
        assert_eq!(input.len(), self.cells[0] * self.cells[1]);
        assert_eq!(output.len(), input.len());
        self.forward_rows(input);
        self.columns();
        self.inverse_rows(output);
    }
}
