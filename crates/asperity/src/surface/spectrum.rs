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

use asperity_convolution::plane::RealPlane;
use ndarray::{Array2, ArrayView2};
use rustfft::num_complex::Complex64;

use crate::error::{Result, require};
use crate::grid::Grid;

/// Amplitudes A_k of the heights.
pub(super) fn transform(grid: &Grid, heights: ArrayView2<f64>) -> Result<Array2<Complex64>> {
    check_shape(grid, heights)?;
    check_defined(heights.iter())?;
    let plane = RealPlane::new(grid.cells(), grid.cells());
    let mut columns = Array2::zeros((plane.waves_along_y(), grid.cells()[0]));
    let scale = 1.0 / grid.len() as f64;
    let read =
        |i: usize, row: &mut [f64]| row.iter_mut().zip(heights.row(i)).for_each(|(a, z)| *a = z * scale);
    if let Some(columns) = columns.as_slice_mut() {
        plane.rows_forward_of(read, columns);
        plane
            .each_column(columns, |transforms, _, column| column.copy_from_slice(transforms.forward(column)));
    }
    Ok(columns.reversed_axes())
}

/// The heights of given amplitudes.
pub(super) fn inverse(grid: &Grid, amplitudes: Array2<Complex64>) -> Array2<f64> {
    let plane = RealPlane::new(grid.cells(), grid.cells());
    let mut columns = amplitudes.reversed_axes();
    if !columns.is_standard_layout() {
        columns = columns.as_standard_layout().into_owned();
    }
    let mut heights = Array2::zeros(grid.shape());
    if let (Some(columns), Some(heights)) = (columns.as_slice_mut(), heights.as_slice_mut()) {
        plane.each_column(columns, |transforms, _, column| {
            transforms.waves.copy_from_slice(column);
            column.copy_from_slice(transforms.back());
        });
        plane.rows_back(columns, heights);
    }
    heights
}

/// (qx, qy) of the amplitude at (i, j) \[1/m\]; a Nyquist wave has its positive one.
pub(super) fn wave_vector(grid: &Grid, (i, j): (usize, usize)) -> [f64; 2] {
    let ([nx, _], [lx, ly]) = (grid.cells(), grid.size());
    let kx = if 2 * i <= nx { i as f64 } else { i as f64 - nx as f64 };
    [TAU * kx / lx, TAU * j as f64 / ly]
}

/// Number of waves that the amplitude at (., j) represents: itself, or itself and its conjugate.
pub(super) fn count(grid: &Grid, j: usize) -> f64 {
    if j == 0 || 2 * j == grid.cells()[1] { 1.0 } else { 2.0 }
}

/// Refuses heights that do not have the shape of the grid.
pub(super) fn check_shape(grid: &Grid, heights: ArrayView2<f64>) -> Result<()> {
    let ((mx, my), (nx, ny)) = (heights.dim(), grid.shape());
    require(
        (mx, my) == (nx, ny),
        "shape of the heights",
        format!("{mx} x {my}"),
        format!("that of the grid, {nx} x {ny}"),
    )
}

/// Refuses undefined heights.
pub(super) fn check_defined<'a>(heights: impl ExactSizeIterator<Item = &'a f64>) -> Result<()> {
    let count = heights.len();
    let undefined = heights.filter(|z| !z.is_finite()).count();
    require(
        undefined == 0,
        "number of undefined heights",
        format!("{undefined} of {count}"),
        "0 here; fill the undefined points first",
    )
}
