//! Numbers that describe a rough surface.
//!
//! Heights are arrays of shape (nx, ny) in metres; a height that is not finite is an undefined
//! point. Height statistics leave undefined points out; spectral ones need every point and say so.

use std::f64::consts::TAU;

use ndarray::ArrayView2;
use rustfft::num_complex::Complex64;

use super::spectrum::transform;
use crate::error::{Error, Result};
use crate::grid::Grid;

/// Mean of the defined heights \[m\].
///
/// # Errors
/// [`Error::Invalid`] where no height is defined.
pub fn mean(heights: ArrayView2<f64>) -> Result<f64> {
    let (sum, count) = defined(heights).fold((0.0, 0usize), |(sum, n), z| (sum + z, n + 1));
    if count == 0 {
        return Err(Error::invalid("number of defined heights", 0, "1 at least"));
    }
    Ok(sum / count as f64)
}

/// Root mean square of the defined heights about their mean \[m\]: Sq of ISO 25178-2 for a levelled
/// surface.
///
/// # Errors
/// [`Error::Invalid`] where no height is defined.
pub fn rms_height(heights: ArrayView2<f64>) -> Result<f64> {
    let mean = mean(heights)?;
    let (sum, count) = defined(heights).fold((0.0, 0usize), |(sum, n), z| (sum + (z - mean).powi(2), n + 1));
    Ok((sum / count as f64).sqrt())
}

/// Root mean square of |grad z| of the periodic surface through the heights, by its Fourier series:
/// sum of |q|^2 |A_q|^2. Waves on the Nyquist frequency of an axis have no derivative along it.
///
/// # Errors
/// [`Error::Invalid`] where a height is undefined or the shape is not the grid's.
pub fn rms_gradient(grid: &Grid, heights: ArrayView2<f64>) -> Result<f64> {
    let amplitudes = transform(grid, heights)?;
    let [nx, ny] = grid.cells();
    let slope = |k: usize, n: usize, length: f64| match 2 * k {
        twice if twice < n => TAU * k as f64 / length,
        twice if twice == n => 0.0,
        _ => TAU * (n - k) as f64 / length,
    };
    let power = |((i, j), a): ((usize, usize), &Complex64)| {
        let qx = slope(i, nx, grid.size()[0]);
        let qy = slope(j, ny, grid.size()[1]);
        // The transform of a real surface is stored for ky >= 0; the other half is its mirror.
        let mirrored = if j == 0 || 2 * j == ny { 1.0 } else { 2.0 };
        mirrored * (qx * qx + qy * qy) * a.norm_sqr()
    };
    Ok(amplitudes.indexed_iter().map(power).sum::<f64>().sqrt())
}

fn defined<'a>(heights: ArrayView2<'a, f64>) -> impl Iterator<Item = f64> + 'a {
    heights.into_iter().copied().filter(|z| z.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::{Array2, array};

    #[test]
    fn undefined_heights_are_left_out() {
        let heights = array![[1.0, f64::NAN], [3.0, f64::INFINITY]];
        assert_eq!(mean(heights.view()).unwrap(), 2.0);
        assert_eq!(rms_height(heights.view()).unwrap(), 1.0);
        assert!(rms_height(array![[f64::NAN]].view()).is_err());
    }

    #[test]
    fn the_rms_gradient_of_a_wave_is_amplitude_times_wave_number_over_root_two() {
        for cells in [[8, 6], [9, 7], [16, 1]] {
            let grid = Grid::new(cells, [2.0, 3.0]).unwrap();
            let wave = |(i, _)| 0.1 * (TAU * grid.x(i)).sin(); // two waves along x
            let heights = Array2::from_shape_fn(grid.shape(), wave);
            let got = rms_gradient(&grid, heights.view()).unwrap();
            assert!((got - 0.1 * TAU / 2.0f64.sqrt()).abs() < 1e-14, "{got}"); // rounding
        }
    }
}
