//! The Hurst exponent of a surface, from its radially averaged power spectrum.
//!
//! Least squares of ln C over ln q for the self-affine spectrum with a roll-off,
//!
//! ```text
//! ln C = ln C0                                  q <= q_r
//! ln C = ln C0 - 2 (1 + H) ln(q / q_r)          q >  q_r
//! ```
//!
//! each ring weighted by its number of waves (the variance of the logarithm of a mean of n random powers
//! is about 1/n). q_r is tried at every ring. (B. N. J. Persson et al., J. Phys.: Condens. Matter 17
//! (2005) R1; T. D. B. Jacobs et al., Surf. Topogr.: Metrol. Prop. 5 (2017) 013001.)

use std::f64::consts::TAU;

use super::RadialSpectrum;
use crate::error::{Error, Result, require};

/// A self-affine spectrum fitted to a measured one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfAffineFit {
    /// Hurst exponent H; outside (0, 1] the surface is not self-affine over the range.
    pub hurst: f64,
    /// Standard error of H: it covers all slopes, for every position of the roll-off, that fit within one standard deviation of
    /// the scatter. For synthetic surfaces the errors are 0.8 to 1.3 times as large on average.
    pub error: f64,
    /// Wavelength at which the flat part ends \[m\]; the longest of the range if there is no flat part.
    pub roll_off: f64,
    /// Power C0 on the flat part \[m^4\].
    pub plateau: f64,
    /// Weighted rms of ln C about the fit.
    pub misfit: f64,
    /// Rms of ln C about the slope, with equal weight per ln q, in excess of the scatter of rings of few waves. It is large if
    /// the many short waves fit and the few long ones do not: the spectrum is then not a power law.
    pub stray: f64,
}

impl SelfAffineFit {
    /// Fit over the rings between the wavelengths `longest` and `shortest` \[m\] (infinite and 0: all).
    ///
    /// ```
    /// use asperity::{Grid, surface::{Roughness, SelfAffine, Surface}};
    /// use asperity::surface::statistics::{RadialSpectrum, Rings, SelfAffineFit};
    /// let grid = Grid::new([256, 256], [1e-3, 1e-3])?;
    /// let surface = SelfAffine {
    ///     hurst: 0.75,
    ///     roughness: Roughness::RmsGradient(0.1),
    ///     longest: 1e-3,
    ///     shortest: 1e-5,
    ///     roll_off: 2e-4,
    ///     seed: 1,
    /// };
    /// let surface = Surface::new(grid, surface.heights(&grid)?)?;
    /// let spectrum = RadialSpectrum::of(&surface, Rings::Linear)?;
    /// let fit = SelfAffineFit::of(&spectrum, f64::INFINITY, 1.02e-5)?;
    /// assert!((fit.hurst - 0.75).abs() < 0.03 && (fit.roll_off / 2e-4 - 1.0).abs() < 0.2);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if fewer than five rings with power lie in the range.
    pub fn of(spectrum: &RadialSpectrum, longest: f64, shortest: f64) -> Result<Self> {
        // Powers of rounding size are beyond a cut-off of the surface.
        let largest = spectrum.power.iter().copied().fold(0.0, f64::max);
        let points: Vec<Point> = (0..spectrum.power.len())
            .filter(|n| {
                let wavelength = TAU / spectrum.wave_number[*n];
                wavelength <= longest && wavelength >= shortest && spectrum.power[*n] > 1e-24 * largest
            })
            .map(|n| Point {
                x: spectrum.wave_number[n].ln(),
                y: spectrum.power[n].ln(),
                weight: spectrum.waves[n] as f64,
            })
            .collect();
        require(
            points.len() >= 5,
            "number of rings of the spectrum between the longest and the shortest wavelength",
            points.len(),
            "5 at least; widen the range",
        )?;
        // At least three rings determine the slope. Of equal fits, the one with the shortest flat part is taken.
        let fits: Vec<Bend> = points[..points.len() - 3].iter().map(|p| bend(&points, p.x)).collect();
        let best = fits.iter().reduce(|best, fit| if fit.squares < best.squares { fit } else { best });
        let Some(best) = best.filter(|fit| fit.squares.is_finite()) else {
            return Err(Error::invalid("power spectrum", "not finite", "finite"));
        };
        let total: f64 = points.iter().map(|p| p.weight).sum();
        let variance = best.squares / total;
        // The scatter per ring, of a unit weight.
        let scatter = ALIKE * best.squares / (points.len() - 3) as f64;
        let allowed = best.squares + scatter;
        let furthest = fits
            .iter()
            .filter(|fit| fit.squares <= allowed)
            .map(|fit| (fit.slope - best.slope).abs() + ((allowed - fit.squares) / fit.spread).sqrt());
        Ok(SelfAffineFit {
            hurst: 0.5 * best.slope - 1.0,
            error: 0.5 * furthest.fold(0.0, f64::max),
            roll_off: TAU / best.bend.exp(),
            plateau: best.level.exp(),
            misfit: variance.sqrt(),
            stray: stray(&points, best),
        })
    }
}

/// Variance of a slope over that from the scatter of independent rings, calibrated on synthetic surfaces: a window spreads each
/// wave over neighbouring rings, so that they are correlated.
const ALIKE: f64 = 2.0;

/// Rms distance of the points on the slope from a fit, each weighted with its length of ln q, minus its own variance.
fn stray(points: &[Point], fit: &Bend) -> f64 {
    let slope: Vec<&Point> = points.iter().filter(|p| p.x >= fit.bend).collect();
    let (mut squares, mut length) = (0.0, 0.0);
    for (n, p) in slope.iter().enumerate() {
        let own = 0.5 * (slope[(n + 1).min(slope.len() - 1)].x - slope[n.saturating_sub(1)].x);
        let distance = p.y - fit.level + fit.slope * (p.x - fit.bend);
        squares += own * (distance * distance - ALIKE / p.weight).max(0.0);
        length += own;
    }
    if length > 0.0 { (squares / length).sqrt() } else { 0.0 }
}

struct Point {
    x: f64,
    y: f64,
    weight: f64,
}

/// y = level - slope max(0, x - bend).
struct Bend {
    bend: f64,
    level: f64,
    slope: f64,
    /// Weighted sum of squares about the fit, and of the regressor about its mean.
    squares: f64,
    spread: f64,
}

fn bend(points: &[Point], bend: f64) -> Bend {
    let beyond = |p: &Point| (p.x - bend).max(0.0);
    let sum = |f: &dyn Fn(&Point) -> f64| points.iter().map(|p| p.weight * f(p)).sum::<f64>();
    let total = sum(&|_| 1.0);
    let (mean_x, mean_y) = (sum(&beyond) / total, sum(&|p| p.y) / total);
    let spread = sum(&|p| (beyond(p) - mean_x).powi(2));
    let slope = -sum(&|p| (beyond(p) - mean_x) * (p.y - mean_y)) / spread;
    let level = mean_y + slope * mean_x;
    let squares = sum(&|p| (p.y - level + slope * beyond(p)).powi(2));
    Bend { bend, level, slope, squares, spread }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(hurst: f64, roll_off: f64) -> RadialSpectrum {
        let wave_number: Vec<f64> = (1..200).map(|n| TAU * f64::from(n)).collect();
        let bend = TAU / roll_off;
        let power =
            wave_number.iter().map(|q| 3.0 * (q / bend).max(1.0).powf(-2.0 * (1.0 + hurst))).collect();
        RadialSpectrum { power, waves: (1..200).map(|n| 6 * n).collect(), wave_number }
    }

    #[test]
    fn an_exact_spectrum_is_found_again() {
        for (hurst, roll_off) in [(0.8, 0.1), (0.3, 0.02), (1.0, 1.0)] {
            let fit = SelfAffineFit::of(&exact(hurst, roll_off), f64::INFINITY, 0.0).unwrap();
            assert!(
                (fit.hurst - hurst).abs() < 1e-10 && (fit.roll_off / roll_off - 1.0).abs() < 1e-10,
                "{fit:?}"
            );
            assert!((fit.plateau / 3.0 - 1.0).abs() < 1e-9 && fit.misfit < 1e-10 && fit.error < 1e-10);
            assert!(fit.stray < 1e-10);
        }
    }

    #[test]
    fn a_floor_of_noise_takes_the_slope_and_is_told() {
        let mut spectrum = exact(0.8, 1.0);
        // Spikes, a few to a thousand points, have the same power at all waves; here that of the hundredth ring.
        let floor = spectrum.power[99];
        spectrum.power.iter_mut().for_each(|power| *power += 10.0 * floor);
        let fit = SelfAffineFit::of(&spectrum, f64::INFINITY, 0.0).unwrap();
        assert!(fit.hurst < 0.3 && fit.misfit < 0.5 && fit.stray > 0.7, "{fit:?}");
    }

    #[test]
    fn the_range_is_kept_and_too_short_a_one_refused() {
        let spectrum = exact(0.6, 0.1);
        let fit = SelfAffineFit::of(&spectrum, 0.05, 0.01).unwrap();
        assert!((fit.hurst - 0.6).abs() < 1e-10 && fit.roll_off <= 0.05);
        let message = SelfAffineFit::of(&spectrum, 0.05, 0.045).unwrap_err().to_string();
        assert!(message.contains("rings"), "{message}");
    }
}
