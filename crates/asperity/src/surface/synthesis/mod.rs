//! Synthetic roughness beyond the isotropic Gaussian one: a lay, and a prescribed height distribution.
//!
//! **Lay.** Ground and turned surfaces are longer along the lay than across it. The spectrum of
//! [`SelfAffine`] is taken at the stretched wave number
//!
//! ```text
//! sqrt(q_across^2 + (ratio q_along)^2)
//! ```
//!
//! so the given wavelengths hold across the lay and are `ratio` times longer along it.
//!
//! **Height distribution.** Worn and plateau-honed surfaces are not Gaussian. The heights of a Gaussian surface are replaced,
//! rank by rank, by those of the distribution, which changes the spectrum. The spectrum is then restored, which changes the
//! distribution, and so on (T. Schreiber and A. Schmitz, Phys. Rev. Lett. 77 (1996) 635). At the end the distribution is exact,
//! and the spectrum is as close as the distribution allows (short waves beyond the cut-off remain, of the order of a per cent of
//! the rms).

mod distribution;
mod exchange;

pub use distribution::HeightDistribution;

use ndarray::Array2;

use super::{Roughness, SelfAffine};
use crate::error::{Error, Result};
use crate::grid::Grid;

/// The direction in which a surface was worked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lay {
    /// Angle of the lay from the x axis \[rad\].
    pub angle: f64,
    /// Length along the lay over length across it, 1 or more.
    pub ratio: f64,
}

/// A random surface with a lay and a height distribution, periodic on the domain.
#[derive(Clone, Debug, PartialEq)]
pub struct Synthesis {
    /// Spectrum, roughness and seed; the wavelengths hold across the lay.
    pub spectrum: SelfAffine,
    /// The lay; `None` is isotropic.
    pub lay: Option<Lay>,
    /// Distribution of the heights.
    pub distribution: HeightDistribution,
}

impl Synthesis {
    /// Heights at the cell centres \[m\], shape (nx, ny), mean zero; the same bits on every machine.
    ///
    /// ```
    /// use asperity::Grid;
    /// use asperity::surface::{HeightDistribution, Lay, Roughness, SelfAffine, Surface, Synthesis, statistics};
    ///
    /// let grid = Grid::new([64, 64], [1e-3, 1e-3])?;
    /// let honed = Synthesis {
    ///     spectrum: SelfAffine {
    ///         hurst: 0.7,
    ///         roughness: Roughness::RmsHeight(1e-6),
    ///         longest: 2.5e-4,
    ///         shortest: 5e-5,
    ///         roll_off: 2.5e-4,
    ///         seed: 3,
    ///     },
    ///     lay: Some(Lay { angle: 0.3, ratio: 4.0 }),
    ///     distribution: HeightDistribution::Moments { skewness: -1.0, kurtosis: 5.0 },
    /// };
    /// let surface = Surface::new(grid, honed.heights(&grid)?)?;
    /// let heights = statistics::HeightStatistics::of(&surface)?;
    /// assert!((heights.sq / 1e-6 - 1.0).abs() < 1e-12);
    /// assert!((heights.ssk + 1.0).abs() < 0.02 && (heights.sku - 5.0).abs() < 0.2);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] as [`SelfAffine::heights`], if the lay is outside its domain, or if no such distribution exists.
    pub fn heights(&self, grid: &Grid) -> Result<Array2<f64>> {
        self.validate()?;
        let Lay { angle, ratio } = self.lay.unwrap_or(Lay { angle: 0.0, ratio: 1.0 });
        let (sin, cos) = libm::sincos(angle);
        let seen = |qx: f64, qy: f64| {
            let (along, across) = (qx * cos + qy * sin, qy * cos - qx * sin);
            (across * across + ratio * ratio * along * along).sqrt()
        };
        if self.distribution == HeightDistribution::Gaussian {
            return self.spectrum.heights_where(grid, seen);
        }
        let gaussian = self.spectrum.heights_where(grid, seen)?;
        let values = self.distribution.values(grid.len())?;
        let (heights, gradient) = exchange::exchange(grid, gaussian, &values);
        // The values have mean 0 and rms 1.
        let scale = match self.spectrum.roughness {
            Roughness::RmsHeight(height) => height,
            Roughness::RmsGradient(wanted) => wanted / gradient,
        };
        Ok(heights * scale)
    }

    /// Checks the lay and the distribution; [`SelfAffine::validate`] checks the spectrum against a grid.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the lay is outside its domain, or if no such distribution exists.
    pub fn validate(&self) -> Result<()> {
        let Lay { angle, ratio } = self.lay.unwrap_or(Lay { angle: 0.0, ratio: 1.0 });
        if !(ratio.is_finite() && ratio >= 1.0) {
            return Err(Error::invalid("ratio of the lay", ratio, "finite, 1 or more").of("lay"));
        }
        if !angle.is_finite() {
            return Err(Error::invalid("angle of the lay", angle, "finite, in rad").of("lay"));
        }
        self.distribution.validate().map_err(|error| error.of("distribution"))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Surface, statistics};
    use super::*;

    fn spectrum() -> SelfAffine {
        SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsGradient(0.2),
            longest: 1e-3,
            shortest: 1e-4,
            roll_off: 3e-4,
            seed: 11,
        }
    }

    fn grid() -> Grid {
        Grid::new([96, 80], [1e-3, 1e-3]).unwrap()
    }

    #[test]
    fn without_lay_and_distribution_it_is_self_affine() {
        let plain = Synthesis { spectrum: spectrum(), lay: None, distribution: HeightDistribution::Gaussian };
        let ratio =
            ((spectrum().heights(&grid()).unwrap() - plain.heights(&grid()).unwrap()) / 1e-6).mapv(f64::abs);
        assert!(ratio.iter().all(|d| *d < 1e-9));
    }

    #[test]
    fn the_lay_stretches_the_correlation() {
        // Along x: the rms slope along y is `ratio` times that along x, except for the waves that are too long for the domain
        // along the lay.
        let lay = Some(Lay { angle: 0.0, ratio: 4.0 });
        let fine = SelfAffine { longest: 2e-4, roll_off: 2e-4, shortest: 5e-5, ..spectrum() };
        let laid = Synthesis { spectrum: fine, lay, distribution: HeightDistribution::Gaussian };
        let z = laid.heights(&grid()).unwrap();
        let slope = |axis: usize| {
            let n = z.dim();
            let step =
                |i: usize, j: usize| if axis == 0 { z[[(i + 1) % n.0, j]] } else { z[[i, (j + 1) % n.1]] };
            let sum: f64 = z.indexed_iter().map(|((i, j), a)| (step(i, j) - a).powi(2)).sum();
            (sum / z.len() as f64).sqrt() / grid().spacing()[axis]
        };
        let ratio = slope(1) / slope(0);
        assert!((3.0..5.0).contains(&ratio), "{ratio}");
        // After rotation by a right angle the axes are exchanged.
        let turned = Synthesis { lay: Some(Lay { angle: std::f64::consts::FRAC_PI_2, ratio: 4.0 }), ..laid };
        assert!(turned.heights(&grid()).is_ok());
    }

    #[test]
    fn the_height_distribution_is_exact_and_the_spectrum_near() {
        let samples: Vec<f64> = (0..500).map(|n| (f64::from(n) / 100.0).exp()).collect();
        let made = Synthesis {
            spectrum: spectrum(),
            lay: None,
            distribution: HeightDistribution::Samples(samples.clone()),
        };
        let z = made.heights(&grid()).unwrap();
        let gradient = statistics::rms_gradient(&grid(), z.view()).unwrap();
        assert!((gradient / 0.2 - 1.0).abs() < 1e-11, "{gradient}");
        // Quantiles of the heights are those of the samples, up to one linear map.
        let mut sorted: Vec<f64> = z.iter().copied().collect();
        sorted.sort_by(f64::total_cmp);
        let quantile = |share: f64| sorted[(share * sorted.len() as f64) as usize];
        let (low, high) = (quantile(0.1), quantile(0.9));
        let of_samples = |share: f64| samples[(share * 500.0) as usize];
        for share in [0.3, 0.5, 0.7] {
            let got = (quantile(share) - low) / (high - low);
            let wanted = (of_samples(share) - of_samples(0.1)) / (of_samples(0.9) - of_samples(0.1));
            assert!((got - wanted).abs() < 0.01, "{share}: {got} {wanted}"); // one sample in 500
        }
        // Waves beyond the cut-off have little power: 5 % of the variance for this strongly skewed case.
        let surface = Surface::new(grid(), z).unwrap();
        let kept = super::super::process::filter(
            &surface,
            super::super::process::Band {
                longest: None,
                shortest: Some(1e-4 * 0.999),
                edge: Default::default(),
            },
        )
        .unwrap();
        let variance = |s: &Surface| statistics::rms_height(s.heights()).unwrap().powi(2);
        let beyond = 1.0 - variance(&kept) / variance(&surface);
        assert!(beyond < 0.05, "{beyond}");
    }

    #[test]
    fn bits_repeat_and_absurd_numbers_are_named() {
        let made = |lay, distribution| Synthesis { spectrum: spectrum(), lay, distribution };
        let skewed = HeightDistribution::Moments { skewness: 0.5, kurtosis: 4.0 };
        let of = || made(None, skewed.clone()).heights(&grid()).unwrap();
        assert_eq!(of(), of());
        let message = |lay, distribution| made(lay, distribution).heights(&grid()).unwrap_err().to_string();
        let gaussian = HeightDistribution::Gaussian;
        assert!(message(Some(Lay { angle: 0.0, ratio: 0.5 }), gaussian.clone()).contains("ratio"));
        assert!(message(Some(Lay { angle: f64::NAN, ratio: 2.0 }), gaussian).contains("angle"));
        let impossible = HeightDistribution::Moments { skewness: 3.0, kurtosis: 4.0 };
        assert!(message(None, impossible).contains("kurtosis"));
        assert!(message(None, HeightDistribution::Samples(vec![1.0])).contains("samples"));
    }
}
