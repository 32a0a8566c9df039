//! All statistics of a surface, from one pass over its heights and one Fourier transform.

use std::f64::consts::TAU;

use super::super::Surface;
use super::power::MOST_FILLED;
use super::{
    Extent, HeightStatistics, PowerSpectrum, RadialSpectrum, Rings, SelfAffineFit, SlopeStatistics,
    SpectralLay, SpectralMoments,
};
use crate::error::Result;

/// Rings per decade of wave numbers in the spectrum of a [`Summary`].
const RINGS: u32 = 20;

/// Statistics of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Height parameters of the heights as given.
    pub heights: HeightStatistics,
    /// Slope parameters of the heights as given; `None` if no point has neighbours.
    pub slopes: Option<SlopeStatistics>,
    /// Statistics from the waves; `None` if more than a quarter of the points are undefined.
    pub waves: Option<Waves>,
}

/// Statistics from the waves of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Waves {
    /// Spectral moments.
    pub moments: SpectralMoments,
    /// The lay; only scatter if it is not [clear](SpectralLay::is_clear).
    pub lay: SpectralLay,
    /// Radially averaged power spectrum. For a surface with a clear lay it is averaged over ellipses along its axes, as a
    /// function of the wave number across it.
    pub spectrum: RadialSpectrum,
    /// Self-affine spectrum fitted over the whole range, up to the cut-off of the spectrum; `None` if there are too few rings.
    pub fit: Option<SelfAffineFit>,
}

impl Summary {
    /// From the defined points; the waves as by [`PowerSpectrum::within`].
    ///
    /// ```
    /// use asperity::{Grid, surface::{Roughness, SelfAffine, Surface}};
    /// use asperity::surface::statistics::{Extent, Summary};
    /// let grid = Grid::new([128, 128], [1e-3, 1e-3])?;
    /// let roughness = SelfAffine {
    ///     hurst: 0.7,
    ///     roughness: Roughness::RmsGradient(0.1),
    ///     longest: 1e-3,
    ///     shortest: 2e-5,
    ///     roll_off: 1e-3,
    ///     seed: 1,
    /// };
    /// let surface = Surface::new(grid, roughness.heights(&grid)?)?;
    /// let summary = Summary::of(&surface, Extent::Periodic)?;
    /// let waves = summary.waves.expect("every point is defined");
    /// assert!(((2.0 * waves.moments.m2).sqrt() - 0.1).abs() < 1e-12); // the rms gradient
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if no point is defined.
    pub fn of(surface: &Surface, extent: Extent) -> Result<Self> {
        let heights = HeightStatistics::of(surface)?;
        // The only possible error is a missing slope, for example of a single point.
        let slopes = SlopeStatistics::of(surface).ok();
        let points = surface.grid().len();
        let undefined = points - heights.defined;
        let waves = match undefined as f64 <= MOST_FILLED * points as f64 {
            true => Some(Waves::of(surface, extent)?),
            false => None,
        };
        Ok(Summary { heights, slopes, waves })
    }
}

impl Waves {
    fn of(surface: &Surface, extent: Extent) -> Result<Self> {
        let power = PowerSpectrum::within(surface, extent)?;
        let lay = power.lay();
        let rings = Rings::PerDecade(RINGS);
        let spectrum = if lay.is_clear() { power.along(&lay, rings)? } else { power.radial(rings)? };
        let fit = SelfAffineFit::of(&spectrum, f64::INFINITY, cut_off(&spectrum)).ok();
        Ok(Waves { moments: power.moments(), lay, spectrum, fit })
    }
}

/// Wavelength of the cut-off of the spectrum \[m\], 0 if there is none: there the power falls faster than q^-8, twice the
/// exponent of the steepest self-affine spectrum, and does not rise again. Instruments and filters cause such cut-offs.
fn cut_off(spectrum: &RadialSpectrum) -> f64 {
    /// Rings with fewer waves scatter too much: the mean of 100 random powers scatters by a tenth.
    const FEWEST: usize = 100;
    const STEEPEST: f64 = 8.0;
    let (q, power) = (&spectrum.wave_number, &spectrum.power);
    // The largest power that follows a ring.
    let mut later = 0.0_f64;
    let mut wavelength = 0.0;
    for n in (0..power.len().saturating_sub(1)).rev() {
        later = later.max(power[n + 1]);
        let broken = later < power[n] * (q[n] / q[n + 1]).powf(STEEPEST);
        if spectrum.waves[n] >= FEWEST && broken {
            // The ring itself is kept.
            wavelength = TAU / q[n] * (1.0 - 1e-9);
        }
    }
    wavelength
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::surface::{Roughness, SelfAffine};

    fn rough() -> Surface {
        let grid = Grid::new([96, 128], [0.75e-3, 1e-3]).unwrap();
        let roughness = SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsHeight(1e-6),
            longest: 2e-4,
            shortest: 2e-5,
            roll_off: 1e-4,
            seed: 5,
        };
        Surface::new(grid, roughness.heights(&grid).unwrap()).unwrap()
    }

    #[test]
    fn it_holds_what_its_parts_give() {
        let surface = rough();
        let summary = Summary::of(&surface, Extent::Periodic).unwrap();
        let waves = summary.waves.unwrap();
        assert_eq!(summary.heights, HeightStatistics::of(&surface).unwrap());
        assert_eq!(summary.slopes, SlopeStatistics::of(&surface).ok());
        assert_eq!(waves.moments, SpectralMoments::of(&surface).unwrap());
        assert_eq!(waves.spectrum, RadialSpectrum::of(&surface, Rings::PerDecade(20)).unwrap());
        assert!((waves.moments.m0.sqrt() / summary.heights.sq - 1.0).abs() < 1e-12); // Parseval
    }

    #[test]
    fn a_tilt_and_holes_do_not_count_as_waves_of_a_finite_surface() {
        let surface = rough();
        let plain = Summary::of(&surface, Extent::Finite).unwrap().waves.unwrap();
        // The window preserves the power of short waves on average; for one realisation only approximately.
        let true_m2 = SpectralMoments::of(&surface).unwrap().m2;
        assert!((plain.moments.m2 / true_m2 - 1.0).abs() < 0.2, "{} {true_m2}", plain.moments.m2);
        let mut tilted = surface.heights().to_owned();
        tilted.indexed_iter_mut().for_each(|((i, j), z)| *z += 1e-4 * (i as f64 - 2.0 * j as f64));
        let tilted_surface = Surface::new(*surface.grid(), tilted.clone()).unwrap();
        let levelled = Summary::of(&tilted_surface, Extent::Finite).unwrap().waves.unwrap();
        // Heights of 1e-6 on a tilt of 1e-2: 1e4 eps of the amplitude.
        assert!((levelled.moments.m2 / plain.moments.m2 - 1.0).abs() < 1e-9);
        tilted[[40, 50]] = f64::NAN;
        let holed = Summary::of(&Surface::new(*surface.grid(), tilted).unwrap(), Extent::Finite).unwrap();
        // One point of 12288, filled smoothly.
        assert!((holed.waves.unwrap().moments.m2 / plain.moments.m2 - 1.0).abs() < 1e-2);
        assert_eq!(holed.heights.defined, 96 * 128 - 1);
    }

    #[test]
    fn a_surface_with_many_holes_has_no_spectrum() {
        let surface = rough();
        let mut heights = surface.heights().to_owned();
        heights.slice_mut(ndarray::s![..30, ..]).fill(f64::NAN);
        let summary = Summary::of(&Surface::new(*surface.grid(), heights).unwrap(), Extent::Finite).unwrap();
        assert!(summary.waves.is_none() && summary.slopes.is_some());
    }

    #[test]
    fn the_fit_ends_where_the_spectrum_is_cut_off() {
        let grid = Grid::new([256, 256], [1e-3, 1e-3]).unwrap();
        let fitted = |shortest: f64| {
            let roughness = SelfAffine {
                hurst: 0.6,
                roughness: Roughness::RmsHeight(1e-6),
                longest: 1e-3,
                shortest,
                roll_off: 2.5e-4,
                seed: 8,
            };
            let surface = Surface::new(grid, roughness.heights(&grid).unwrap()).unwrap();
            Summary::of(&surface, Extent::Finite).unwrap().waves.unwrap().fit.unwrap()
        };
        // Cut off at twice and at five times the shortest wave of the grid: some thousand waves are left.
        for shortest in [1.6e-5, 4e-5] {
            let fit = fitted(shortest);
            assert!((fit.hurst - 0.6).abs() < 0.12, "{shortest}: {fit:?}");
        }
    }
}
