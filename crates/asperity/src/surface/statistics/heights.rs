//! Height parameters of ISO 25178-2 (section 4.1): of z about its mean,
//!
//! ```text
//! Sa = <|z|>,   Sq = <z^2>^(1/2),   Ssk = <z^3> / Sq^3,   Sku = <z^4> / Sq^4,   Sz = Sp + Sv
//! ```
//!
//! with Sp the highest and Sv the depth of the lowest point.

use ndarray::ArrayView2;

use super::super::Surface;
use crate::error::{Error, Result};

/// Height parameters; lengths in metres.
///
/// ```
/// use asperity::{Grid, surface::{Surface, statistics::HeightStatistics}};
/// let heights = ndarray::array![[1.0, -1.0], [3.0, 1.0]];
/// let s = HeightStatistics::of(&Surface::new(Grid::new([2, 2], [1.0, 1.0])?, heights)?)?;
/// assert_eq!((s.mean, s.sa, s.sq, s.sz), (1.0, 1.0, 2f64.sqrt(), 4.0));
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightStatistics {
    /// Number of defined points.
    pub defined: usize,
    /// Mean of the heights as given \[m\].
    pub mean: f64,
    /// Lowest height as given \[m\].
    pub min: f64,
    /// Highest height as given \[m\].
    pub max: f64,
    /// Mean deviation from the mean \[m\].
    pub sa: f64,
    /// Root mean square deviation from the mean \[m\].
    pub sq: f64,
    /// Skewness; NaN for a flat surface.
    pub ssk: f64,
    /// Kurtosis, 3 for a Gaussian surface; NaN for a flat surface.
    pub sku: f64,
    /// Highest peak above the mean \[m\].
    pub sp: f64,
    /// Deepest pit below the mean \[m\].
    pub sv: f64,
    /// Highest peak to deepest pit \[m\].
    pub sz: f64,
}

impl HeightStatistics {
    /// The value for the defined points.
    ///
    /// # Errors
    /// [`Error::Invalid`] if no point is defined.
    pub fn of(surface: &Surface) -> Result<Self> {
        let heights = surface.heights();
        let mean = mean(heights)?;
        let (mut count, mut min, mut max) = (0, f64::INFINITY, f64::NEG_INFINITY);
        for z in defined(heights) {
            (count, min, max) = (count + 1, min.min(z), max.max(z));
        }
        // In units of the largest deviation: no power overflows.
        let unit = (max - mean).max(mean - min);
        let scale = if unit > 0.0 { 1.0 / unit } else { 0.0 };
        let mut sums = [0.0; 4];
        for z in defined(heights) {
            let d = (z - mean) * scale;
            let square = d * d;
            [d.abs(), square, square * d, square * square].iter().zip(&mut sums).for_each(|(p, s)| *s += p);
        }
        let [absolute, second, third, fourth] = sums.map(|s| s / count as f64);
        let sq = second.sqrt();
        Ok(HeightStatistics {
            defined: count,
            mean,
            min,
            max,
            sa: absolute * unit,
            sq: sq * unit,
            ssk: third / (second * sq),
            sku: fourth / (second * second),
            sp: max - mean,
            sv: mean - min,
            sz: max - min,
        })
    }
}

/// Mean of the defined heights \[m\].
///
/// # Errors
/// [`Error::Invalid`] if no height is defined.
pub fn mean(heights: ArrayView2<f64>) -> Result<f64> {
    // Relative to the first height, so that a surface far from zero keeps its digits.
    let Some(first) = defined(heights).next() else {
        return Err(Error::invalid("number of defined heights", 0, "1 at least"));
    };
    let (sum, count) = defined(heights).fold((0.0, 0usize), |(sum, n), z| (sum + (z - first), n + 1));
    Ok(first + sum / count as f64)
}

/// Root mean square of the defined heights about their mean \[m\], Sq.
///
/// # Errors
/// [`Error::Invalid`] if no height is defined.
pub fn rms_height(heights: ArrayView2<f64>) -> Result<f64> {
    let mean = mean(heights)?;
    let (sum, count) = defined(heights).fold((0.0, 0usize), |(sum, n), z| (sum + (z - mean).powi(2), n + 1));
    Ok((sum / count as f64).sqrt())
}

pub(super) fn defined<'a>(heights: ArrayView2<'a, f64>) -> impl Iterator<Item = f64> + 'a {
    heights.into_iter().copied().filter(|z| z.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use ndarray::{Array2, array};

    fn of(heights: Array2<f64>) -> HeightStatistics {
        let (nx, ny) = heights.dim();
        let grid = Grid::new([nx, ny], [1.0, 1.0]).unwrap();
        HeightStatistics::of(&Surface::new(grid, heights).unwrap()).unwrap()
    }

    #[test]
    fn undefined_heights_are_left_out() {
        let heights = array![[1.0, f64::NAN], [3.0, f64::INFINITY]];
        assert_eq!(mean(heights.view()).unwrap(), 2.0);
        assert_eq!(rms_height(heights.view()).unwrap(), 1.0);
        assert_eq!(of(heights).defined, 2);
        assert!(rms_height(array![[f64::NAN]].view()).is_err());
    }

    #[test]
    fn a_wave_has_its_closed_forms() {
        // sin: Sa = 2/pi, Sq = 1/sqrt 2, Ssk = 0, Sku = 3/2; the sums over whole waves are exact except for Sa, whose kinks cause
        // an error of (pi/n)^2 / 6.
        let s = of(Array2::from_shape_fn((64, 3), |(i, _)| {
            1e-6 * (std::f64::consts::TAU * (i as f64 + 0.5) / 64.0).sin() + 0.25
        }));
        assert!((s.mean - 0.25).abs() < 1e-16 && (s.sq / (1e-6 / 2f64.sqrt()) - 1.0).abs() < 1e-9);
        assert!(s.ssk.abs() < 1e-9 && (s.sku - 1.5).abs() < 1e-9);
        assert!((s.sa / (2e-6 / std::f64::consts::PI) - 1.0).abs() < 5e-4);
        assert!((s.sz - s.sp - s.sv).abs() < 1e-15 && s.min < s.mean && s.mean < s.max);
    }

    #[test]
    fn a_plateau_with_a_pit_is_skewed_to_the_negative() {
        // n - 1 points at 0 and one at -1: Ssk = -(n-2)/sqrt(n-1), Sku = (n^2 - 3n + 3)/(n-1).
        let mut heights = Array2::zeros((5, 4));
        heights[[2, 2]] = -1.0;
        let s = of(heights);
        assert!((s.ssk + 18.0 / 19f64.sqrt()).abs() < 1e-13);
        assert!((s.sku - (400.0 - 60.0 + 3.0) / 19.0).abs() < 1e-12);
        assert!((s.sv - 0.95).abs() < 1e-15);
        let flat = of(Array2::from_elem((2, 2), 7.0));
        assert!(flat.sq == 0.0 && flat.ssk.is_nan());
    }

    #[test]
    fn extreme_units_do_not_overflow() {
        let tiny = of(array![[1e-200, -1e-200], [3e-200, -3e-200]]);
        assert!((tiny.sq / (5f64.sqrt() * 1e-200) - 1.0).abs() < 1e-14 && tiny.sku.is_finite());
    }
}
