//! Fourier amplitudes of a height map and back.
//!
//! ```text
//! z(x, y) = sum over k of A_k exp(i q.x),    A_k = (1 / N) sum over cells of z exp(-i q.x)
//! ```
//!
//! with N = nx ny, so that the mean of z^2 is the sum of |A_k|^2 (Parseval). Real heights need half
//! of the amplitudes: arrays here have shape (nx, ny/2 + 1), kx from 0 up and negative ones from the
//! end, ky from 0 up.

use std::f64::consts::TAU;

use asperity_convolution::fft;
use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, Axis};
use rustfft::num_complex::Complex64;

use crate::error::{Error, Result};
use crate::grid::Grid;

/// Amplitudes A_k of the heights.
pub(super) fn transform(grid: &Grid, heights: ArrayView2<f64>) -> Result<Array2<Complex64>> {
    check_shape(grid, heights)?;
    check_defined(heights)?;
    let [nx, ny] = grid.cells();
    let along_y = fft::real_forward(ny);
    let mut amplitudes = Array2::<Complex64>::zeros((nx, ny / 2 + 1));
    let scale = 1.0 / grid.len() as f64;
    amplitudes.outer_iter_mut().into_par_iter().zip(heights.outer_iter()).for_each_init(
        || (vec![0.0; ny], along_y.make_output_vec(), along_y.make_scratch_vec()),
        |(input, output, scratch), (mut row, z)| {
            input.iter_mut().zip(z).for_each(|(a, z)| *a = z * scale);
            // The lengths come from the plan itself, so the call cannot fail.
            let _ = along_y.process_with_scratch(input, output, scratch);
            row.iter_mut().zip(output.iter()).for_each(|(a, b)| *a = *b);
        },
    );
    let along_x = fft::forward(nx);
    transform_columns(&mut amplitudes, along_x.as_ref());
    Ok(amplitudes)
}

/// The heights of given amplitudes.
pub(super) fn inverse(grid: &Grid, mut amplitudes: Array2<Complex64>) -> Array2<f64> {
    let [nx, ny] = grid.cells();
    let along_x = fft::inverse(nx);
    transform_columns(&mut amplitudes, along_x.as_ref());
    let along_y = fft::real_inverse(ny);
    let mut heights = Array2::zeros((nx, ny));
    heights.outer_iter_mut().into_par_iter().zip(amplitudes.outer_iter()).for_each_init(
        || (along_y.make_input_vec(), vec![0.0; ny], along_y.make_scratch_vec()),
        |(input, output, scratch), (mut z, row)| {
            input.iter_mut().zip(row).for_each(|(a, b)| *a = *b);
            // Real but for rounding, as those of every real row.
            input[0].im = 0.0;
            if ny.is_multiple_of(2) {
                input[ny / 2].im = 0.0;
            }
            // The lengths come from the plan itself, so the call cannot fail.
            let _ = along_y.process_with_scratch(input, output, scratch);
            z.iter_mut().zip(output.iter()).for_each(|(a, b)| *a = *b);
        },
    );
    heights
}

/// Columns transformed together: one cache line holds four numbers of a row.
const COLUMNS: usize = 8;

fn transform_columns(amplitudes: &mut Array2<Complex64>, plan: &dyn rustfft::Fft<f64>) {
    let n = plan.len();
    amplitudes.axis_chunks_iter_mut(Axis(1), COLUMNS).into_par_iter().for_each_init(
        || (vec![Complex64::ZERO; COLUMNS * n], vec![Complex64::ZERO; plan.get_inplace_scratch_len()]),
        |(work, scratch), mut columns| {
            for (i, row) in columns.outer_iter().enumerate() {
                row.iter().enumerate().for_each(|(c, a)| work[c * n + i] = *a);
            }
            plan.process_with_scratch(&mut work[..columns.ncols() * n], scratch);
            for (i, mut row) in columns.outer_iter_mut().enumerate() {
                row.iter_mut().enumerate().for_each(|(c, a)| *a = work[c * n + i]);
            }
        },
    );
}

/// (qx, qy) of the amplitude at (i, j) \[1/m\]; a Nyquist wave has its positive one.
pub(super) fn wave_vector(grid: &Grid, (i, j): (usize, usize)) -> [f64; 2] {
    let ([nx, _], [lx, ly]) = (grid.cells(), grid.size());
    let kx = if 2 * i <= nx { i as f64 } else { i as f64 - nx as f64 };
    [TAU * kx / lx, TAU * j as f64 / ly]
}

/// How many waves the amplitude at (., j) stands for: itself, or itself and its conjugate.
pub(super) fn count(grid: &Grid, j: usize) -> f64 {
    if j == 0 || 2 * j == grid.cells()[1] { 1.0 } else { 2.0 }
}

/// Refuses heights that do not have the shape of the grid.
pub(super) fn check_shape(grid: &Grid, heights: ArrayView2<f64>) -> Result<()> {
    let ((mx, my), (nx, ny)) = (heights.dim(), grid.shape());
    if (mx, my) == (nx, ny) {
        return Ok(());
    }
    Err(Error::invalid(
        "shape of the heights",
        format!("{mx} x {my}"),
        format!("that of the grid, {nx} x {ny}"),
    ))
}

/// Refuses undefined heights.
pub(super) fn check_defined(heights: ArrayView2<f64>) -> Result<()> {
    let undefined = heights.iter().filter(|z| !z.is_finite()).count();
    if undefined == 0 {
        return Ok(());
    }
    Err(Error::invalid(
        "number of undefined heights",
        format!("{undefined} of {}", heights.len()),
        "0 here; fill the undefined points first",
    ))
}
