//! The bearing-area (Abbott-Firestone) curve: E. J. Abbott and F. A. Firestone, Mech. Engng 55 (1933) 569;
//! areal material ratio Smr(c) and its inverse Smc(mr) of ISO 25178-2, section 4.4.

use super::super::Surface;
use super::heights::defined;
use crate::error::{Result, require};
use crate::numbers::extent;

/// Fraction of the defined points above each height of a list.
#[derive(Clone, Debug, PartialEq)]
pub struct BearingCurve {
    /// Heights from the lowest to the highest point \[m\], equally spaced.
    pub heights: Vec<f64>,
    /// Fraction of points at or above each height, 1 at the first; exact.
    pub share: Vec<f64>,
}

/// Largest number of levels or bins of a curve.
const MOST: usize = 1 << 24;

impl BearingCurve {
    /// At `levels` heights, at least 2.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if no point is defined or the levels are fewer than 2 or more than 2^24.
    pub fn of(surface: &Surface, levels: usize) -> Result<Self> {
        require(
            (2..=MOST).contains(&levels),
            "number of levels of the bearing curve",
            levels,
            "between 2 and 2^24",
        )?;
        let (low, high) = range(surface)?;
        let heights: Vec<f64> =
            (0..levels)
                .map(|n| {
                    if n + 1 == levels { high } else { low + (high - low) * (n as f64 / (levels - 1) as f64) }
                })
                .collect();
        // Each point counts at the highest level that is not above it.
        let mut at = vec![0usize; levels];
        for z in defined(surface.heights()) {
            let guess = ((z - low) / (high - low) * (levels - 1) as f64) as usize;
            // Rounding may put it one level off; NaN (a flat) becomes 0.
            let mut n = guess.min(levels - 1);
            while n > 0 && heights[n] > z {
                n -= 1;
            }
            while n + 1 < levels && heights[n + 1] <= z {
                n += 1;
            }
            at[n] += 1;
        }
        let total = at.iter().sum::<usize>() as f64;
        let mut above = 0usize;
        let mut share: Vec<f64> = at
            .iter()
            .rev()
            .map(|n| {
                above += n;
                above as f64 / total
            })
            .collect();
        share.reverse();
        Ok(BearingCurve { heights, share })
    }

    /// Smr(c): fraction of the surface at or above the height c \[m\], linear between the levels.
    pub fn share_above(&self, height: f64) -> f64 {
        let n = self.heights.partition_point(|h| *h <= height);
        match n {
            0 => 1.0,
            n if n == self.heights.len() => {
                if height > self.heights[n - 1] {
                    0.0
                } else {
                    self.share[n - 1]
                }
            }
            n => {
                let part = (height - self.heights[n - 1]) / (self.heights[n] - self.heights[n - 1]);
                self.share[n - 1] + part * (self.share[n] - self.share[n - 1])
            }
        }
    }

    /// Smc(mr): height \[m\] that the fraction mr of the surface reaches, linear between the levels.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the share is not in \[0, 1\].
    pub fn height_at(&self, share: f64) -> Result<f64> {
        require((0.0..=1.0).contains(&share), "material ratio", share, "between 0 and 1")?;
        // Fractions decrease with the height: the first level that fewer points reach.
        let n = self.share.partition_point(|s| *s >= share);
        if n == 0 || n == self.share.len() {
            return Ok(self.heights[n.saturating_sub(1)]);
        }
        let part = (self.share[n - 1] - share) / (self.share[n - 1] - self.share[n]);
        Ok(self.heights[n - 1] + part * (self.heights[n] - self.heights[n - 1]))
    }
}

/// Probability density of the heights: (middles of `bins` equal bins \[m\], density \[1/m\]).
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if no point is defined, the surface is flat (its density is infinite), or the
/// bins are none or more than 2^24.
pub fn height_distribution(surface: &Surface, bins: usize) -> Result<(Vec<f64>, Vec<f64>)> {
    require(
        (1..=MOST).contains(&bins),
        "number of bins of the height distribution",
        bins,
        "between 1 and 2^24",
    )?;
    let (low, high) = range(surface)?;
    require(low != high, "range of the heights", "0 m", "more than 0 m, to have a distribution")?;
    let mut counts = vec![0usize; bins];
    let mut total = 0usize;
    for z in defined(surface.heights()) {
        let n = ((z - low) / (high - low) * bins as f64) as usize;
        counts[n.min(bins - 1)] += 1;
        total += 1;
    }
    let width = (high - low) / bins as f64;
    let middles = (0..bins).map(|n| low + (n as f64 + 0.5) * width).collect();
    Ok((middles, counts.iter().map(|c| *c as f64 / (total as f64 * width)).collect()))
}

fn range(surface: &Surface) -> Result<(f64, f64)> {
    let [low, high] = extent(defined(surface.heights()));
    require(low <= high, "number of defined heights", 0, "1 at least")?;
    Ok((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use ndarray::Array2;

    fn ramp() -> Surface {
        let mut heights = Array2::from_shape_fn((10, 10), |(i, j)| (10 * i + j) as f64 / 100.0);
        heights[[0, 1]] = f64::NAN;
        heights[[0, 2]] = 0.0;
        Surface::new(Grid::new([10, 10], [1.0, 1.0]).unwrap(), heights).unwrap()
    }

    #[test]
    fn shares_are_counted_exactly() {
        let curve = BearingCurve::of(&ramp(), 34).unwrap();
        assert_eq!((curve.share[0], curve.heights[33]), (1.0, 0.99));
        for (height, share) in curve.heights.iter().zip(&curve.share) {
            let counted = ramp().heights().iter().filter(|z| **z >= *height).count() as f64 / 99.0;
            assert_eq!(*share, counted, "{height}");
        }
    }

    #[test]
    fn heights_and_shares_are_inverse() {
        let curve = BearingCurve::of(&ramp(), 100).unwrap();
        for share in [0.1, 0.5, 0.93] {
            let height = curve.height_at(share).unwrap();
            assert!((curve.share_above(height) - share).abs() < 1e-12);
            assert!((height - (1.0 - share)).abs() < 0.02); // a ramp
        }
        assert_eq!((curve.share_above(-1.0), curve.share_above(2.0)), (1.0, 0.0));
        assert!(curve.height_at(1.5).is_err());
    }

    #[test]
    fn a_flat_bears_everywhere_and_has_no_density() {
        let flat =
            Surface::new(Grid::new([2, 2], [1.0, 1.0]).unwrap(), Array2::from_elem((2, 2), 3.0)).unwrap();
        let curve = BearingCurve::of(&flat, 3).unwrap();
        assert_eq!(curve.share, [1.0; 3]);
        assert_eq!((curve.share_above(3.0), curve.height_at(0.5).unwrap()), (1.0, 3.0));
        assert!(height_distribution(&flat, 5).is_err());
        assert!(BearingCurve::of(&flat, 1).is_err());
    }

    #[test]
    fn the_density_integrates_to_one() {
        let (middles, density) = height_distribution(&ramp(), 7).unwrap();
        let width = middles[1] - middles[0];
        assert!((density.iter().sum::<f64>() * width - 1.0).abs() < 1e-14);
    }
}
