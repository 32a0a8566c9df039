//! The power spectrum and its moments.
//!
//! With the amplitudes A_q of z(x) = sum A_q exp(i q.x) the (two-dimensional) power spectral density is
//!
//! ```text
//! C(q) = Lx Ly |A_q|^2   [m^4],      <z^2> = int C(q) d^2q / (2 pi)^2
//! ```
//!
//! (T. D. B. Jacobs, T. Junge and L. Pastewka, Surf. Topogr.: Metrol. Prop. 5 (2017) 013001, eqs 3 and 6: "C^2D"), and its radial
//! average is the mean over the waves of a ring ("C^iso"). The spectral moments are those of a profile through an isotropic
//! surface (P. R. Nayak, J. Lubr. Technol. 93 (1971) 398):
//!
//! ```text
//! m0 = <z^2>,   m2 = <|grad z|^2> / 2,   m4 = (3/8) <(laplace z)^2>,   alpha = m0 m4 / m2^2
//! ```
//!
//! The surface is taken as periodic. One that does not repeat is levelled, and Hann's window makes it so without changing the power
//! of its waves on average: [`Extent::Finite`].

use std::f64::consts::{FRAC_PI_2, TAU};

use ndarray::{Array2, ArrayView2, Zip};
use rayon::prelude::*;

use super::super::process::window_for_spectrum;
use super::super::spectrum::{count, transform, wave_vector};
use super::super::{Fill, Level, Surface, fill, level};
use super::Extent;
use crate::error::{Error, Result};
use crate::grid::Grid;

/// Largest share of undefined points that are filled for a spectrum.
pub const MOST_FILLED: f64 = 0.25;

/// The rings over which a spectrum is averaged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rings {
    /// Rings as wide as the larger of 2 pi / Lx and 2 pi / Ly.
    Linear,
    /// This many per decade of wave numbers, 1 to 1000.
    PerDecade(u32),
}

/// Radially averaged power spectrum; only rings entirely inside the Nyquist limit of the grid.
#[derive(Clone, Debug, PartialEq)]
pub struct RadialSpectrum {
    /// Mean wave number of each non-empty ring \[1/m\].
    pub wave_number: Vec<f64>,
    /// Mean of C over the ring \[m^4\].
    pub power: Vec<f64>,
    /// Number of waves in the ring.
    pub waves: Vec<usize>,
}

impl RadialSpectrum {
    /// The spectrum of a surface whose points are all defined.
    ///
    /// ```
    /// use asperity::{Grid, surface::{Surface, statistics::{RadialSpectrum, Rings}}};
    /// let grid = Grid::new([16, 16], [1.0, 1.0])?;
    /// let wave = |(i, _): (usize, usize)| (std::f64::consts::TAU * 3.0 * grid.x(i)).cos();
    /// let surface = Surface::new(grid, ndarray::Array2::from_shape_fn((16, 16), wave))?;
    /// let spectrum = RadialSpectrum::of(&surface, Rings::Linear)?;
    /// // |A|^2 = 1/4 at +-3, among the waves of the third ring.
    /// assert!((spectrum.power[2] * spectrum.waves[2] as f64 - 0.5).abs() < 1e-14);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if a point is undefined or the rings are not between 1 and 1000 to a decade.
    pub fn of(surface: &Surface, rings: Rings) -> Result<Self> {
        PowerSpectrum::of(surface)?.radial(rings)
    }
}

/// The power of every wave of a surface: one Fourier transform. All other quantities are sums of these.
#[derive(Clone, Debug)]
pub struct PowerSpectrum {
    grid: Grid,
    /// |A_q|^2 \[m^2\] of the half plane ky >= 0, shape (nx, ny/2 + 1).
    power: Array2<f64>,
}

impl PowerSpectrum {
    /// The spectrum of a surface whose points are all defined.
    ///
    /// # Errors
    /// [`Error::Invalid`] if a point is undefined.
    pub fn of(surface: &Surface) -> Result<Self> {
        PowerSpectrum::of_heights(surface.grid(), surface.heights())
    }

    /// The spectrum of a surface that repeats beyond its edges, or not: then it is levelled by its plane, and multiplied by Hann's
    /// window of mean square 1, so that its edges do not count as roughness. Undefined points are filled (harmonic).
    ///
    /// # Errors
    /// [`Error::Invalid`] if more than a quarter of the points are undefined.
    pub fn within(surface: &Surface, extent: Extent) -> Result<Self> {
        let grid = *surface.grid();
        let flat = match extent {
            Extent::Periodic => surface.clone(),
            Extent::Finite => Surface::new(grid, level(surface.heights(), Level::Plane)?)?,
        };
        let whole = match flat.undefined() {
            0 => flat,
            _ => Surface::new(grid, fill(&grid, flat.heights(), Fill::Harmonic, MOST_FILLED)?)?,
        };
        match extent {
            Extent::Periodic => PowerSpectrum::of(&whole),
            Extent::Finite => PowerSpectrum::of(&window_for_spectrum(&whole)),
        }
    }

    fn of_heights(grid: &Grid, heights: ArrayView2<f64>) -> Result<Self> {
        let amplitudes = transform(grid, heights)?;
        let mut power = Array2::zeros(amplitudes.dim());
        Zip::from(&mut power).and(&amplitudes).par_for_each(|p, a| *p = a.norm_sqr());
        Ok(PowerSpectrum { grid: *grid, power })
    }

    /// All waves except the mean.
    ///
    /// ```
    /// use asperity::{Grid, surface::{Surface, statistics::PowerSpectrum}};
    /// let grid = Grid::new([16, 16], [1.0, 1.0])?;
    /// let wave = |(i, _): (usize, usize)| (std::f64::consts::TAU * 3.0 * grid.x(i)).cos();
    /// let surface = Surface::new(grid, ndarray::Array2::from_shape_fn((16, 16), wave))?;
    /// let spectrum = PowerSpectrum::of(&surface)?;
    /// // The powers add up to the mean square height.
    /// assert!((spectrum.waves().map(|wave| wave.power).sum::<f64>() - 0.5).abs() < 1e-14);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn waves(&self) -> impl Iterator<Item = Wave> {
        self.power.indexed_iter().skip(1).map(|(at, power)| {
            let [qx, qy] = wave_vector(&self.grid, at);
            Wave {
                wave_number: libm::hypot(qx, qy),
                wave_vector: self.slope_vector(at),
                power: count(&self.grid, at.1) * power,
            }
        })
    }

    /// Radially averaged spectrum.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the rings are not between 1 and 1000 to a decade.
    pub fn radial(&self, rings: Rings) -> Result<RadialSpectrum> {
        self.averaged(rings, [[1.0, 0.0], [0.0, 1.0]])
    }

    /// Spectrum averaged over ellipses along the axes of a lay, as a function of the wave number across it: the spectrum of the
    /// isotropic surface from which the surface is obtained by stretching along the lay.
    ///
    /// # Errors
    /// As [`radial`](Self::radial).
    pub fn along(&self, lay: &SpectralLay, rings: Rings) -> Result<RadialSpectrum> {
        let (sin, cos) = libm::sincos(lay.angle);
        // Wave vectors along the lay are stretched by its ratio.
        let [a, b] = [lay.ratio * lay.ratio, 1.0];
        let mixed = (a - b) * sin * cos;
        self.averaged(rings, [[a * cos * cos + b * sin * sin, mixed], [mixed, a * sin * sin + b * cos * cos]])
    }

    /// Averaged over rings of (q.M q)^(1/2).
    fn averaged(&self, rings: Rings, m: [[f64; 2]; 2]) -> Result<RadialSpectrum> {
        if let Rings::PerDecade(n) = rings
            && !(1..=1000).contains(&n)
        {
            return Err(Error::invalid("number of rings to a decade", n, "between 1 and 1000"));
        }
        let grid = &self.grid;
        let ([nx, ny], [lx, ly]) = (grid.cells(), grid.size());
        let width = (TAU / lx).max(TAU / ly);
        let smallest = (TAU / lx).min(TAU / ly);
        // The ellipse of q reaches q (M^-1)_xx^(1/2) along x.
        let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        let reach = [m[1][1], m[0][0]].map(|minor| (minor / determinant).sqrt());
        let nyquist = (TAU * nx as f64 / (2.0 * lx) / reach[0]).min(TAU * ny as f64 / (2.0 * ly) / reach[1]);
        // The ring of a wave number; rings per decade start at the longest wave of the domain.
        let ring = |q: f64| match rings {
            Rings::Linear => (q / width).round() as usize,
            Rings::PerDecade(n) => ((q / smallest * (1.0 + 1e-9)).log10() * f64::from(n)) as usize,
        };
        let last = ring(nyquist);
        // Blocks of rows are summed separately, then added in order: the same bits for any number of threads.
        let blocks: Vec<Vec<[f64; 3]>> = (0..nx.div_ceil(ROWS))
            .into_par_iter()
            .map(|block| {
                let mut sums = vec![[0.0; 3]; last + 1];
                let rows = (block * ROWS..nx.min((block + 1) * ROWS)).flat_map(|i| {
                    self.power.row(i).into_iter().enumerate().map(move |(j, power)| (i, j, power))
                });
                for (i, j, power) in rows {
                    let [qx, qy] = wave_vector(grid, (i, j));
                    let q = (m[0][0] * qx * qx + 2.0 * m[0][1] * qx * qy + m[1][1] * qy * qy).sqrt();
                    if q > 0.0 && q <= nyquist * (1.0 + 1e-9) {
                        let times = count(grid, j);
                        add(&mut sums[ring(q).min(last)], [times * q, times * power, times]);
                    }
                }
                sums
            })
            .collect();
        let mut sums = vec![[0.0; 3]; last + 1];
        for block in blocks {
            sums.iter_mut().zip(block).for_each(|(sum, part)| add(sum, part));
        }
        let mut spectrum = RadialSpectrum { wave_number: vec![], power: vec![], waves: vec![] };
        // The linear ring around 0 is not used.
        for [wave_number, power, waves] in sums.into_iter().filter(|[.., waves]| *waves > 0.0) {
            spectrum.wave_number.push(wave_number / waves);
            spectrum.power.push(grid.area() * power / waves);
            spectrum.waves.push(waves as usize);
        }
        Ok(spectrum)
    }

    /// Spectral moments. Waves on the Nyquist frequency of an axis have no slope along it.
    pub fn moments(&self) -> SpectralMoments {
        let [m0, gradient, laplace] = self.even_moments();
        SpectralMoments { m0, m2: 0.5 * gradient, m4: 0.375 * laplace }
    }

    /// The lay, from the mean products of slopes <z_x^2>, <z_x z_y>, <z_y^2>: their principal axes. `None` for a strip of fewer
    /// than eight lines of points.
    pub fn lay(&self) -> SpectralLay {
        /// Smallest number of lines of points that distinguishes two directions.
        const FEWEST: usize = 8;
        let [nx, ny] = self.grid.cells();
        if nx.min(ny) < FEWEST {
            return SpectralLay { ratio: 1.0, angle: 0.0 };
        }
        let [xx, xy, yy] = self.sums(|[qx, qy], power| [qx * qx, qx * qy, qy * qy].map(|q| q * power));
        let (mean, half) = (0.5 * (xx + yy), (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt());
        // The steepest direction is across the lay.
        let across = 0.5 * libm::atan2(2.0 * xy, xx - yy);
        let along = if across > 0.0 { across - FRAC_PI_2 } else { across + FRAC_PI_2 };
        let ratio = ((mean + half) / (mean - half).max(2e-6 * mean)).sqrt();
        SpectralLay { ratio: if ratio.is_finite() { ratio } else { 1.0 }, angle: along }
    }

    /// Sums of |A|^2, |q|^2 |A|^2 and |q|^4 |A|^2, without the mean.
    fn even_moments(&self) -> [f64; 3] {
        self.sums(|[qx, qy], power| {
            let q2 = qx * qx + qy * qy;
            [power, q2 * power, q2 * q2 * power]
        })
    }

    /// Sums over all waves except the mean of functions of the wave vector and the power.
    fn sums(&self, of: impl Fn([f64; 2], f64) -> [f64; 3] + Sync) -> [f64; 3] {
        let row = |i: usize| {
            let mut sums = [0.0; 3];
            for (j, power) in self.power.row(i).iter().enumerate().skip(usize::from(i == 0)) {
                add(&mut sums, of(self.slope_vector((i, j)), count(&self.grid, j) * power));
            }
            sums
        };
        let rows: Vec<[f64; 3]> = (0..self.power.nrows()).into_par_iter().map(row).collect();
        rows.iter().fold([0.0; 3], |sum, row| std::array::from_fn(|n| sum[n] + row[n]))
    }

    /// The wave vector, 0 along an axis on whose Nyquist frequency the wave lies, as it has no slope there.
    fn slope_vector(&self, (i, j): (usize, usize)) -> [f64; 2] {
        let ([nx, ny], [qx, qy]) = (self.grid.cells(), wave_vector(&self.grid, (i, j)));
        [if 2 * i == nx { 0.0 } else { qx }, if 2 * j == ny { 0.0 } else { qy }]
    }
}

/// A wave A exp(i q.x) of a surface, alone or together with its conjugate: the powers of all waves add up to the mean
/// square height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Length of the wave vector |q| \[1/m\].
    pub wave_number: f64,
    /// Wave vector q \[1/m\]; 0 along an axis on whose Nyquist frequency the wave lies, as it has no slope there.
    pub wave_vector: [f64; 2],
    /// Mean square height: |A|^2 of a wave, twice that of a wave and its conjugate \[m^2\].
    pub power: f64,
}

/// The lay: the direction in which a surface is smoothest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralLay {
    /// Rms slope across the lay over that along it: 1 for an isotropic surface, the ratio of lengths along and across the lay
    /// for one that is stretched; 1000 at most.
    pub ratio: f64,
    /// Angle of the lay from the x axis, between -pi/2 and pi/2 \[rad\].
    pub angle: f64,
}

impl SpectralLay {
    /// Whether the surface has a lay: isotropic surfaces of some hundred waves have ratios up to 1.3.
    pub fn is_clear(&self) -> bool {
        self.ratio > 1.5
    }
}

/// Rows of a block that is summed separately.
const ROWS: usize = 64;

/// Adds to the sums over some waves: of wave numbers, powers, or 1.
fn add(sum: &mut [f64; 3], terms: [f64; 3]) {
    sum.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
}

/// Moments of the spectrum of a profile through an isotropic surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralMoments {
    /// m0, mean square height \[m^2\].
    pub m0: f64,
    /// m2, mean square slope of a profile.
    pub m2: f64,
    /// m4, mean square curvature of a profile \[1/m^2\].
    pub m4: f64,
}

impl SpectralMoments {
    /// The moments of a surface whose points are all defined. Waves on the Nyquist frequency of an axis have no
    /// slope along it.
    ///
    /// # Errors
    /// [`Error::Invalid`] if a point is undefined.
    pub fn of(surface: &Surface) -> Result<Self> {
        Ok(PowerSpectrum::of(surface)?.moments())
    }

    /// Nayak's bandwidth parameter m0 m4 / m2^2, at least 1.5.
    pub fn bandwidth(&self) -> f64 {
        self.m0 * self.m4 / (self.m2 * self.m2)
    }
}

/// Root mean square of |grad z| of the periodic surface through the heights, by its Fourier series:
/// sum of |q|^2 |A_q|^2. Waves on the Nyquist frequency of an axis have no derivative along it.
///
/// # Errors
/// [`Error::Invalid`] if a height is undefined or the shape is not the grid's.
pub fn rms_gradient(grid: &Grid, heights: ArrayView2<f64>) -> Result<f64> {
    Ok(PowerSpectrum::of_heights(grid, heights)?.even_moments()[1].sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{Roughness, SelfAffine, statistics::rms_height};
    use ndarray::Array2;

    fn rough() -> Surface {
        let grid = Grid::new([60, 45], [1e-3, 0.9e-3]).unwrap();
        let surface = SelfAffine {
            hurst: 0.7,
            roughness: Roughness::RmsHeight(1e-6),
            longest: 9e-4,
            shortest: 6e-5,
            roll_off: 9e-4,
            seed: 2,
        };
        Surface::new(grid, surface.heights(&grid).unwrap()).unwrap()
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

    #[test]
    fn the_rings_hold_the_mean_square_height() {
        // int C d^2q / (2 pi)^2: each wave represents (2 pi)^2 / (Lx Ly).
        let surface = rough();
        for rings in [Rings::Linear, Rings::PerDecade(10)] {
            let spectrum = RadialSpectrum::of(&surface, rings).unwrap();
            let sum: f64 = spectrum.power.iter().zip(&spectrum.waves).map(|(c, n)| c * *n as f64).sum();
            let variance = rms_height(surface.heights()).unwrap().powi(2);
            assert!((sum / surface.grid().area() / variance - 1.0).abs() < 1e-12);
            assert!(spectrum.wave_number.windows(2).all(|w| w[0] < w[1]));
        }
    }

    #[test]
    fn moments_of_two_crossed_waves_are_closed_forms() {
        // A (cos qx + cos qy): <z^2> = A^2, <|grad|^2> = q^2 A^2, <(laplace)^2> = q^4 A^2.
        let grid = Grid::new([24, 24], [1.0, 1.0]).unwrap();
        let q = 3.0 * TAU;
        let heights = Array2::from_shape_fn((24, 24), |(i, j)| {
            0.2 * ((q * grid.x(i)).cos() + (q * grid.y(j)).cos()) + 7.0
        });
        let m = SpectralMoments::of(&Surface::new(grid, heights).unwrap()).unwrap();
        let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert!(close(m.m0, 0.04) && close(m.m2, 0.02 * q * q) && close(m.m4, 0.015 * q.powi(4)));
        assert!(close(m.bandwidth(), 1.5)); // one wave number alone
    }

    #[test]
    fn undefined_points_and_absurd_rings_are_refused() {
        let mut heights = rough().into_heights();
        heights[[3, 3]] = f64::NAN;
        let holed = Surface::new(*rough().grid(), heights).unwrap();
        assert!(RadialSpectrum::of(&holed, Rings::Linear).unwrap_err().to_string().contains("1 of 2700"));
        assert!(SpectralMoments::of(&holed).is_err());
        assert!(RadialSpectrum::of(&rough(), Rings::PerDecade(0)).is_err());
    }
}
