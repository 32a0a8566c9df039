//! Other cells over the same rectangle.
//!
//! - band-limited: the trigonometric interpolation of the (periodic) surface, sampled at the new cell centres; waves that the new
//!   grid cannot hold are dropped. Exact for a surface that is smooth on its grid. Steps and spikes cause oscillations, and so do
//!   the edges of a surface that is not periodic.
//! - bilinear: linear in x and y between the old cell centres, constant beyond the outermost. It makes no new extremes and works
//!   around undefined points, but does not filter: apply a low-pass filter before coarsening.

use std::f64::consts::PI;

use asperity_convolution::fft;
use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, Axis};
use rustfft::num_complex::Complex64;

use super::super::spectrum::check_defined;
use super::Surface;
use crate::error::Result;

/// The interpolation of heights at new points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Resampling {
    /// By waves: exact for a periodic surface that is smooth on its grid; needs every point.
    #[default]
    BandLimited,
    /// Linear between neighbours: no new extremes.
    Bilinear,
}

/// The surface on `cells` = \[nx, ny\] cells of the same rectangle.
///
/// ```
/// use asperity::{Grid, surface::{Surface, process::{Resampling, resample}}};
/// let wave = |x: f64| (std::f64::consts::TAU * 3.0 * x).sin();
/// let coarse = Grid::new([8, 1], [1.0, 1.0])?;
/// let heights = ndarray::Array2::from_shape_fn((8, 1), |(i, _)| wave(coarse.x(i)));
/// let fine = resample(&Surface::new(coarse, heights)?, [50, 1], Resampling::BandLimited)?;
/// assert!((fine.heights()[[17, 0]] - wave(fine.grid().x(17))).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if a count is 0 or absurd, or (band-limited) a height is undefined.
pub fn resample(surface: &Surface, cells: [usize; 2], method: Resampling) -> Result<Surface> {
    let cells = if surface.grid().is_line() { [cells[0], 1] } else { cells };
    let grid = surface.grid().with_cells(cells)?;
    let heights = surface.heights();
    let along = |heights: ArrayView2<f64>, n: usize| match method {
        Resampling::BandLimited => rows_by_waves(heights, n),
        Resampling::Bilinear => rows_linear(heights, n),
    };
    if method == Resampling::BandLimited {
        check_defined(heights.iter())?;
    }
    // Both methods are products of one along y and one along x.
    let first = along(heights, cells[1]);
    let second = along(first.t(), cells[0]);
    Surface::new(grid, second.reversed_axes().as_standard_layout().into_owned())
}

/// Every row resampled to n points.
fn rows_linear(heights: ArrayView2<f64>, n: usize) -> Array2<f64> {
    let old = heights.ncols();
    let mut resampled = Array2::zeros((heights.nrows(), n));
    resampled.outer_iter_mut().into_par_iter().zip(heights.outer_iter()).for_each(|(mut out, row)| {
        for (j, z) in out.iter_mut().enumerate() {
            let at = ((j as f64 + 0.5) * old as f64 / n as f64 - 0.5).clamp(0.0, (old - 1) as f64);
            let (k, share) = (at as usize, at.fract());
            // A neighbour of no weight may be undefined or beyond the end.
            *z = if share > 0.0 { (1.0 - share) * row[k] + share * row[k + 1] } else { row[k] };
        }
    });
    resampled
}

fn rows_by_waves(heights: ArrayView2<f64>, n: usize) -> Array2<f64> {
    let old = heights.ncols();
    if old == n {
        return heights.to_owned();
    }
    let (forward, inverse) = (fft::real_forward(old), fft::real_inverse(n));
    let mut resampled = Array2::zeros((heights.nrows(), n));
    resampled.axis_iter_mut(Axis(0)).into_par_iter().zip(heights.outer_iter()).for_each_init(
        || {
            let scratch = [forward.make_scratch_vec(), inverse.make_scratch_vec()];
            let waves = [forward.make_output_vec(), inverse.make_input_vec()];
            (forward.make_input_vec(), waves, inverse.make_output_vec(), scratch)
        },
        |(input, [waves, new_waves], output, [scratch, new_scratch]), (mut out, z)| {
            input.iter_mut().zip(z).for_each(|(a, b)| *a = *b);
            // The lengths come from the plans themselves, so the calls cannot fail.
            let _ = forward.process_with_scratch(input, waves, scratch);
            resample_waves(waves, old, new_waves, n);
            let _ = inverse.process_with_scratch(new_waves, output, new_scratch);
            out.iter_mut().zip(output).for_each(|(a, b)| *a = *b);
        },
    );
    resampled
}

/// The waves of a row of `old` points, for a row of `new` points.
fn resample_waves(waves: &[Complex64], old: usize, new_waves: &mut [Complex64], new: usize) {
    new_waves.fill(Complex64::ZERO);
    for k in 0..=old.min(new) / 2 {
        // From centres of old cells to centres of new ones.
        let shift = PI * k as f64 * (1.0 / new as f64 - 1.0 / old as f64);
        let wave = waves[k] * Complex64::from_polar(1.0 / old as f64, shift);
        // The wave at Nyquist is both k and -k: half of it each if the new grid distinguishes them, their sum otherwise.
        new_waves[k] = if 2 * k == old {
            0.5 * wave
        } else if 2 * k == new {
            Complex64::new(2.0 * wave.re, 0.0)
        } else {
            wave
        };
    }
    // The constant is real except for rounding.
    new_waves[0].im = 0.0;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::surface::{Roughness, SelfAffine};

    fn rough(cells: [usize; 2]) -> Surface {
        let grid = Grid::new(cells, [1e-3, 1e-3]).unwrap();
        let surface = SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsHeight(1.0),
            longest: 1e-3,
            shortest: 1e-4,
            roll_off: 1e-3,
            seed: 5,
        };
        Surface::new(grid, surface.heights(&grid).unwrap()).unwrap()
    }

    fn largest_difference(a: &Surface, b: &Surface) -> f64 {
        a.heights().iter().zip(b.heights()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn a_band_limited_surface_is_the_same_on_any_grid() {
        // The waves end at index 10, below every grid's Nyquist.
        for cells in [[64, 40], [25, 33], [22, 22]] {
            let moved = resample(&rough([32, 27]), cells, Resampling::BandLimited).unwrap();
            assert!(largest_difference(&moved, &rough(cells)) < 1e-12, "{cells:?}");
        }
    }

    #[test]
    fn there_and_back_changes_nothing() {
        // Heights with every wave, Nyquist included.
        let grid = Grid::new([6, 9], [1.0, 2.0]).unwrap();
        let any = Array2::from_shape_fn((6, 9), |(i, j)| ((i * 5 + j * j) % 7) as f64);
        let surface = Surface::new(grid, any).unwrap();
        let fine = resample(&surface, [16, 25], Resampling::BandLimited).unwrap();
        let back = resample(&fine, [6, 9], Resampling::BandLimited).unwrap();
        assert!(largest_difference(&back, &surface) < 1e-13);
    }

    #[test]
    fn bilinear_is_exact_for_planes_and_passes_holes_by() {
        let grid = Grid::new([10, 8], [1.0, 1.0]).unwrap();
        let plane = |g: &Grid| {
            let heights = Array2::from_shape_fn(g.shape(), |(i, j)| 2.0 * g.x(i) - 3.0 * g.y(j));
            Surface::new(*g, heights).unwrap()
        };
        let fine = resample(&plane(&grid), [30, 16], Resampling::Bilinear).unwrap();
        let exact = plane(fine.grid());
        for ((i, j), z) in fine.heights().indexed_iter() {
            // Beyond the outermost centres it is constant.
            if (2..28).contains(&i) && (1..15).contains(&j) {
                assert!((z - exact.heights()[[i, j]]).abs() < 1e-14);
            }
        }
        assert_eq!(resample(&plane(&grid), [10, 8], Resampling::Bilinear).unwrap(), plane(&grid));
        let mut holed = plane(&grid).into_heights();
        holed[[4, 4]] = f64::NAN;
        let holed = Surface::new(grid, holed).unwrap();
        assert_eq!(resample(&holed, [10, 8], Resampling::Bilinear).unwrap().undefined(), 1);
        let message = resample(&holed, [20, 8], Resampling::BandLimited).unwrap_err().to_string();
        assert!(message.contains("undefined"), "{message}");
        assert!(resample(&holed, [0, 8], Resampling::Bilinear).is_err());
    }
}
