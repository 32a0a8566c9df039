//! The power spectrum of a profile, and that of the corresponding isotropic surface.
//!
//! ```text
//! C1(q) = L |A_k|^2,  A_k = (1/n) sum z exp(-i q x),  q = 2 pi k / L       <z^2> = (1/2 pi) integral of C1 over all q
//! C1(q) = (1/pi) integral from q of C(k) k / sqrt(k^2 - q^2) dk            isotropic surface of spectrum C
//! ```
//!
//! with <z^2> = integral of C d^2q/(2 pi)^2. The second line is an Abel transform (P. R. Nayak, Wear 26 (1973) 165; T. D. B.
//! Jacobs, T. Junge & L. Pastewka, Surf. Topogr. 5 (2017) 013001). C is taken as constant on the rings of the averaged spectrum
//! and computed ring by ring, starting from the shortest wave; values that are negative because of scatter are set to 0. Waves
//! shorter than the shortest of the profile are missing: their contribution to C1 is attributed to the last ring.

use std::f64::consts::{PI, TAU};

use asperity_convolution::fft;
use ndarray::Array2;

use super::super::waves::Waves;
use super::parameters::check;
use crate::error::{Result, positive, require};
use crate::grid::Grid;

/// Power spectrum of a profile, averaged over rings of wave numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileSpectrum {
    /// Ends of the rings \[1/m\], one more than there are rings.
    pub edges: Vec<f64>,
    /// Mean of C1 on each ring \[m^3\].
    pub power: Vec<f64>,
    /// Waves of each ring: numbers of the first and of the one after the last.
    waves: Vec<[usize; 2]>,
    /// 2 pi / L.
    fundamental: f64,
}

impl ProfileSpectrum {
    /// From evenly spaced heights \[m\], with about this number of rings per decade. A profile that is not periodic is levelled
    /// by a straight line and multiplied by Hann's window.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for fewer than eight or undefined heights, or a spacing that is not positive.
    pub fn of(heights: &[f64], spacing: f64, periodic: bool, per_decade: u32) -> Result<ProfileSpectrum> {
        positive("spacing of the profile", spacing, "m")?;
        check(heights, 8)?;
        let n = heights.len();
        let mut z = if periodic { heights.to_vec() } else { faded(heights) };
        let plan = fft::real_forward(n);
        let mut amplitudes = plan.make_output_vec();
        // The lengths come from the plan itself, so the call cannot fail.
        let _ = plan.process(&mut z, &mut amplitudes);
        let length = spacing * n as f64;
        let power = |k: usize| amplitudes[k].norm_sqr() / (n * n) as f64 * length;
        let last = (n - 1) / 2; // below Nyquist
        let step = 10f64.powf(1.0 / f64::from(per_decade.max(1)));
        let fundamental = TAU / length;
        let mut found =
            ProfileSpectrum { edges: vec![0.5 * fundamental], power: vec![], waves: vec![], fundamental };
        let mut first = 1;
        while first <= last {
            let end = ((first as f64 * step).ceil() as usize).clamp(first + 1, last + 1);
            found.power.push((first..end).map(power).sum::<f64>() / (end - first) as f64);
            found.waves.push([first, end]);
            found.edges.push((end as f64 - 0.5) * fundamental);
            first = end;
        }
        Ok(found)
    }

    /// Middles of the rings \[1/m\].
    pub fn wave_numbers(&self) -> Vec<f64> {
        self.edges.windows(2).map(|pair| (pair[0] * pair[1]).sqrt()).collect()
    }

    /// C of the isotropic surface on each ring \[m^4\].
    pub fn isotropic(&self) -> Vec<f64> {
        let mut found = vec![0.0; self.power.len()];
        // Mean over the waves of a ring of the contribution of a ring with C = 1 to C1.
        let adds = |ring: usize, of: usize| {
            let [first, end] = self.waves[ring];
            let one = |k: usize| {
                let q = k as f64 * self.fundamental;
                let root = |edge: f64| (edge * edge - q * q).max(0.0).sqrt();
                (root(self.edges[of + 1]) - root(self.edges[of])) / PI
            };
            (first..end).map(one).sum::<f64>() / (end - first) as f64
        };
        for ring in (0..self.power.len()).rev() {
            let farther: f64 = (ring + 1..self.power.len()).map(|of| found[of] * adds(ring, of)).sum();
            found[ring] = ((self.power[ring] - farther) / adds(ring, ring)).max(0.0);
        }
        found
    }

    /// Heights \[m\] of an isotropic surface of this spectrum with random phases, periodic on the grid; the same bits on every
    /// machine for one seed. Waves outside the rings are 0; between ring centres ln C is linear in ln q.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for a line of cells, and for a grid without any of the waves.
    pub fn surface(&self, grid: &Grid, seed: u64) -> Result<Array2<f64>> {
        require(!grid.is_line(), "grid of the surface", "a line of cells", "a plane")?;
        let (wave_numbers, power) = (self.wave_numbers(), self.isotropic());
        let at = interpolation(&wave_numbers, &power);
        let (lowest, highest) = (self.edges[0], self.edges[self.edges.len() - 1]);
        let area = grid.area();
        let amplitude = |qx: f64, qy: f64| {
            let q = (qx * qx + qy * qy).sqrt();
            // The mean square of a complex normal number is 2.
            if (lowest..=highest).contains(&q) { (at(q) / (2.0 * area)).sqrt() } else { 0.0 }
        };
        let waves = Waves::new(grid, highest);
        let (mut columns, moments) = waves.amplitudes(seed, amplitude);
        let mut expected = 0.0;
        for ky in 0..=waves.reach(1, highest) {
            for kx in -(waves.reach(0, highest) as i64)..=waves.reach(0, highest) as i64 {
                if ky > 0 || kx > 0 {
                    let [fx, fy] = grid.size().map(|length| TAU / length);
                    expected += 4.0 * amplitude(fx * kx as f64, fy * ky as f64).powi(2);
                }
            }
        }
        require(
            moments.height > 0.0 && expected > 0.0,
            "grid of the surface",
            format!("{:e} m x {:e} m", grid.size()[0], grid.size()[1]),
            format!("one that holds waves of {:e} m to {:e} m", TAU / highest, TAU / lowest),
        )?;
        Ok(waves.sum(&mut columns, (expected / moments.height).sqrt()))
    }
}

/// Heights minus their straight line, multiplied by Hann's window of mean square 1.
fn faded(heights: &[f64]) -> Vec<f64> {
    let n = heights.len() as f64;
    let place = |i: usize| (2 * i + 1) as f64 / n - 1.0;
    let mean = heights.iter().sum::<f64>() / n;
    let along: f64 = heights.iter().enumerate().map(|(i, z)| place(i) * z).sum();
    let square: f64 = (0..heights.len()).map(|i| place(i).powi(2)).sum();
    let scale = (2.0f64 / 3.0).sqrt();
    let one = |(i, z): (usize, &f64)| {
        let window = scale * (1.0 + libm::cos(PI * place(i)));
        (z - mean - along / square * place(i)) * window
    };
    heights.iter().enumerate().map(one).collect()
}

/// Linear interpolation in logarithms; the end values beyond the ends, and the nearer value next to a zero.
fn interpolation<'a>(x: &'a [f64], y: &'a [f64]) -> impl Fn(f64) -> f64 + Sync + 'a {
    move |at| {
        let after = x.partition_point(|x| *x < at);
        if after == 0 || after == x.len() {
            return y[after.min(y.len() - 1)];
        }
        let (x0, x1, y0, y1) = (x[after - 1], x[after], y[after - 1], y[after]);
        let share = libm::log(at / x0) / libm::log(x1 / x0);
        match y0 > 0.0 && y1 > 0.0 {
            true => y0 * libm::exp(share * libm::log(y1 / y0)),
            false => {
                if share < 0.5 {
                    y0
                } else {
                    y1
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Roughness, SelfAffine, Surface, statistics};
    use super::*;

    fn map(seed: u64) -> (Grid, Array2<f64>) {
        let grid = Grid::new([512, 512], [1e-3, 1e-3]).unwrap();
        let surface = SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsHeight(1e-6),
            longest: 2.5e-4,
            shortest: 1.6e-5,
            roll_off: 1.2e-4,
            seed,
        };
        (grid, surface.heights(&grid).unwrap())
    }

    #[test]
    fn the_spectrum_holds_the_mean_square() {
        let (_, z) = map(1);
        let line = z.column(7).to_vec();
        let spectrum = ProfileSpectrum::of(&line, 1e-3 / 512.0, true, 16).unwrap();
        let width = |pair: &[f64]| pair[1] - pair[0];
        // Both signs of q, over 2 pi.
        let sum: f64 = spectrum.edges.windows(2).zip(&spectrum.power).map(|(e, p)| width(e) * p / PI).sum();
        let mean = line.iter().sum::<f64>() / 512.0;
        let square = line.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / 512.0;
        assert!((sum / square - 1.0).abs() < 1e-9, "{sum} {square}"); // nothing at Nyquist
    }

    #[test]
    fn the_lines_of_a_map_give_its_spectrum_back() {
        let (grid, z) = map(2);
        // The mean spectrum of all lines: a profile as long as 512 of them.
        let mut mean = ProfileSpectrum::of(&z.column(0).to_vec(), 1e-3 / 512.0, true, 16).unwrap();
        for j in 1..512 {
            let one = ProfileSpectrum::of(&z.column(j).to_vec(), 1e-3 / 512.0, true, 16).unwrap();
            mean.power.iter_mut().zip(&one.power).for_each(|(sum, power)| *sum += power);
        }
        mean.power.iter_mut().for_each(|power| *power /= 512.0);
        let made = mean.surface(&grid, 5).unwrap();
        let rms = |z: &Array2<f64>| statistics::rms_height(z.view()).unwrap();
        let gradient = |z: &Array2<f64>| statistics::rms_gradient(&grid, z.view()).unwrap();
        // The scatter of one surface in its few longest waves; the gradient has more, and the rings of a sixteenth of a decade.
        assert!((rms(&made) / rms(&z) - 1.0).abs() < 0.2, "{} {}", rms(&made), rms(&z));
        assert!((gradient(&made) / gradient(&z) - 1.0).abs() < 0.1, "{} {}", gradient(&made), gradient(&z));
        // And its own lines have the mean square of the profiles.
        let surface = Surface::new(grid, made).unwrap();
        assert_eq!(surface.undefined(), 0);
    }

    #[test]
    fn an_inverted_power_law_is_a_power_law() {
        // C = q^-3.6 gives C1 = q^-2.6 Gamma(1.3)/(2 sqrt(pi) Gamma(1.8)), up to the missing short waves.
        let heights: Vec<f64> = (0..4096).map(|i| f64::from(i % 7)).collect();
        let mut spectrum = ProfileSpectrum::of(&heights, 1.0, true, 20).unwrap();
        let factor = libm::tgamma(1.3) / (2.0 * PI.sqrt() * libm::tgamma(1.8));
        for (ring, waves) in spectrum.waves.clone().into_iter().enumerate() {
            let one = |k: usize| factor * (k as f64 * spectrum.fundamental).powf(-2.6);
            spectrum.power[ring] = (waves[0]..waves[1]).map(one).sum::<f64>() / (waves[1] - waves[0]) as f64;
        }
        let found = spectrum.isotropic();
        let q = spectrum.wave_numbers();
        for (n, q) in q.iter().enumerate().take(q.len() - 12).skip(12) {
            // Constant on rings over which it falls by a third.
            assert!((found[n] * q.powf(3.6) - 1.0).abs() < 0.1, "{n}: {}", found[n] * q.powf(3.6));
        }
    }
}
