//! Fourier amplitudes of a height map and back.
//!
//! ```text
//! z(x, y) = sum over k of A_k exp(i q.x),    A_k = (1 / N) sum over cells of z exp(-i q.x)
//! ```
//!
//! with N = nx ny, so that the mean of z^2 is the sum of |A_k|^2 (Parseval). Real heights need half
//! of the amplitudes: arrays here have shape (nx, ny/2 + 1), kx from 0 up and negative ones from the
//! end, ky from 0 up.

use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, Axis};
use realfft::RealFftPlanner;
use rustfft::FftPlanner;
use rustfft::num_complex::Complex64;

use crate::error::{Error, Result};
use crate::grid::Grid;

/// Amplitudes A_k of the heights.
pub(super) fn transform(grid: &Grid, heights: ArrayView2<f64>) -> Result<Array2<Complex64>> {
    check_shape(grid, heights)?;
    check_defined(heights)?;
    let [nx, ny] = grid.cells();
    let along_y = RealFftPlanner::<f64>::new().plan_fft_forward(ny);
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
    let along_x = FftPlanner::<f64>::new().plan_fft_forward(nx);
    transform_columns(&mut amplitudes, along_x.as_ref());
    Ok(amplitudes)
}

fn transform_columns(amplitudes: &mut Array2<Complex64>, plan: &dyn rustfft::Fft<f64>) {
    amplitudes.axis_iter_mut(Axis(1)).into_par_iter().for_each_init(
        || (vec![Complex64::ZERO; plan.len()], vec![Complex64::ZERO; plan.get_inplace_scratch_len()]),
        |(work, scratch), mut column| {
            work.iter_mut().zip(column.iter()).for_each(|(a, b)| *a = *b);
            plan.process_with_scratch(work, scratch);
            column.iter_mut().zip(work.iter()).for_each(|(a, b)| *a = *b);
        },
    );
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
