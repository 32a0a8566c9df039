//! The power spectrum of a profile, and an isotropic surface that corresponds to it.
//!
//! ```text
//! C1(q) = L |A_k|^2,  A_k = (1/n) sum z exp(-i q x),  q = 2 pi k / L       <z^2> = (1/2 pi) integral of C1 over all q
//! C1(q) = (1/pi) integral from q of C(k) k / sqrt(k^2 - q^2) dk            isotropic surface of spectrum C
//! ```
//!
//! with <z^2> = integral of C d^2q/(2 pi)^2. The second line is an Abel transform (P. R. Nayak, Wear 26 (1973) 165; T. D. B.
//! Jacobs, T. Junge & L. Pastewka, Surf. Topogr. 5 (2017) 013001). C is constant on the rings of the averaged spectrum. The C1 of
//! one profile scatters. An inverse ring by ring turns the scatter into negative C, and cutting these off makes the surface too high.
//! C is therefore iterated from a positive start by factors (W. H. Richardson, J. Opt. Soc. Am. 62 (1972) 55; L. B. Lucy, Astron. J.
//! 79 (1974) 745),
//!
//! ```text
//! M = A C      C_j <- C_j sum_r w_r A_rj P_r/M_r / sum_r w_r A_rj      w = n q^2
//! ```
//!
//! with the measured P of rings of n waves. Each iteration keeps sum w M = sum w P, so that the surface has the slope of the profile
//! along each direction.
//!
//! Waves shorter than the shortest of the profile are missing: their contribution to C1 is attributed to the last rings.
//!
//! **Height.** A profile shows no waves along y: a wave with the vector (0, q) has the same height at each of its points, and is
//! removed with the mean. An isotropic surface of spectrum C is therefore higher than its profiles, by the C1 between 0 and
//! 2 pi / L, and no profile tells how much. [`ProfileSpectrum::surface`] gives the surface the rms height of the profile. It does so
//! by its longest waves, of which the profile says least: C is multiplied by 1/(1 + (a/q)^4), or by 1 + (a/q)^4 if C is too low.

use std::f64::consts::{PI, TAU};

use asperity_convolution::fft;
use ndarray::Array2;

use super::super::waves::Waves;
use super::parameters::check;
use crate::error::{Result, positive, require};
use crate::grid::Grid;
use crate::numbers::bisect;

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
    /// Mean square of the heights without their mean or straight line \[m^2\].
    square: f64,
}

/// An isotropic surface made from the spectrum of a profile.
#[derive(Clone, Debug, PartialEq)]
pub struct ProfileSurface {
    /// Heights \[m\].
    pub heights: Array2<f64>,
    /// Rms height of the profile \[m\]: of its waves that the grid holds, and of all.
    pub rms_height: [f64; 2],
    /// Rms slope of the profile: of its waves that the grid holds, and of all.
    pub rms_slope: [f64; 2],
    /// Rms slope of the surface along a direction, the mean over all directions: (sum of q^2 <z^2>/2 over its waves)^(1/2).
    pub slope: f64,
    /// Rms height \[m\] and slope of the isotropic surface of the profile's spectrum on this grid, before it was given the height of the
    /// profile.
    pub isotropic: [f64; 2],
    /// Longest and shortest wave of the surface \[m\].
    pub waves: [f64; 2],
    /// Waves longer than this \[m\] have less than half the power that the profile's spectrum gives them (or more than twice, where it
    /// gives too little).
    pub changed_beyond: f64,
}

/// Iterations of the likelihood: later ones follow the scatter.
const ITERATIONS: usize = 300;
/// A profile whose rms height is less than this share of its largest height is straight: the rest is rounding.
const STRAIGHT: f64 = 1e-10;

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
        let mut z = if periodic { heights.to_vec() } else { levelled(heights) };
        let mean = z.iter().sum::<f64>() / n as f64;
        let largest = heights.iter().fold(0.0, |most: f64, z| most.max(z.abs()));
        let square = z.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / n as f64;
        let square = if square.sqrt() > STRAIGHT * largest { square } else { 0.0 };
        if !periodic {
            fade(&mut z);
        }
        let plan = fft::real_forward(n);
        let mut amplitudes = plan.make_output_vec();
        // The lengths come from the plan itself, so the call cannot fail.
        let _ = plan.process(&mut z, &mut amplitudes);
        let length = spacing * n as f64;
        let power = |k: usize| amplitudes[k].norm_sqr() / (n * n) as f64 * length;
        let last = (n - 1) / 2; // below Nyquist
        let step = 10f64.powf(1.0 / f64::from(per_decade.max(1)));
        let fundamental = TAU / length;
        let mut found = ProfileSpectrum {
            edges: vec![0.5 * fundamental],
            power: vec![],
            waves: vec![],
            fundamental,
            square,
        };
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
        let n = self.power.len();
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
        let matrix: Vec<Vec<f64>> = (0..n)
            .map(|ring| (0..n).map(|of| if of < ring { 0.0 } else { adds(ring, of) }).collect())
            .collect();
        // From C of a flat C1: any positive start will do, this one is near.
        let mut found: Vec<f64> = (0..n).map(|ring| self.power[ring] / matrix[ring][ring]).collect();
        let weight = |ring: usize| {
            let [first, end] = self.waves[ring];
            (end - first) as f64 * self.edges[ring] * self.edges[ring + 1]
                / (self.fundamental * self.fundamental)
        };
        for _ in 0..ITERATIONS {
            let model = |row: &[f64]| row.iter().zip(&found).map(|(a, c)| a * c).sum::<f64>();
            let models: Vec<f64> = matrix.iter().map(|row| model(row)).collect();
            for (of, c) in found.iter_mut().enumerate() {
                // The rings up to this one; one without power takes it away.
                let (mut up, mut down) = (0.0, 0.0);
                for ring in 0..=of {
                    let add = weight(ring) * matrix[ring][of];
                    up += if models[ring] > 0.0 { add * (self.power[ring] / models[ring]) } else { 0.0 };
                    down += add;
                }
                *c *= up / down;
            }
        }
        found
    }

    /// Share of the rings within a band in the integral of C1 q^(2 order) dq.
    fn share(&self, within: impl Fn(usize) -> bool, order: i32) -> f64 {
        let part = |ring: usize| {
            let [low, high] = [self.edges[ring], self.edges[ring + 1]];
            self.power[ring] * (low * high).powi(order) * (high - low)
        };
        let rings = || 0..self.power.len();
        let whole: f64 = rings().map(part).sum();
        rings().filter(|ring| within(*ring)).map(part).sum::<f64>() / whole
    }

    /// An isotropic surface of this spectrum with random phases, periodic on the grid; the same bits on every machine for one seed.
    ///
    /// The waves of the grid within a ring share the mean square of the ring. A ring without a wave of the grid leaves its part to the
    /// next one. The surface has the rms height of those waves of the profile that
    /// the grid holds: up to its longer side, and down to two of its wider cells.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for a line of cells, a profile without roughness, and a grid without any of the waves.
    pub fn surface(&self, grid: &Grid, seed: u64) -> Result<ProfileSurface> {
        require(!grid.is_line(), "grid of the surface", "a line of cells", "a plane")?;
        require(
            self.square > 0.0,
            "rms height of the profile about its straight line",
            "0 m",
            "greater than 0: a straight profile has no waves to make a surface of; check the column of the heights and their unit",
        )?;
        let sides = grid.size().map(|length| TAU / length);
        let longest = sides[0].min(sides[1]);
        let nyquist = grid.spacing().map(|cell| PI / cell);
        let shortest = nyquist[0].min(nyquist[1]);
        let rings = self.power.len();
        // A wave of the grid stands for those from half to one and a half of its number.
        let held = |ring: usize| self.edges[ring + 1] > 0.5 * longest && self.edges[ring] < shortest;
        let (wave_numbers, power) = (self.wave_numbers(), self.isotropic());
        let (lowest, highest) = (self.edges[0], self.edges[rings].min(shortest));

        let waves = Waves::new(grid, highest);
        let ring_of = |q: f64| {
            (lowest..=highest)
                .contains(&q)
                .then(|| self.edges.partition_point(|edge| *edge <= q).clamp(1, rings) - 1)
        };
        let (mut columns, _) = waves.amplitudes(seed, |_, _| 1.0);
        // Waves of the grid in each ring, both of each pair.
        let reach = waves.reach(0, highest) as i64;
        let mut counts = vec![0.0; rings];
        let vectors = |columns: &[_]| {
            (0..columns.len()).flat_map(move |ky| {
                (-reach..=reach).filter(move |kx| ky > 0 || *kx > 0).map(move |kx| (ky, kx))
            })
        };
        let length = |ky: usize, kx: i64| {
            let [x, y] = [sides[0] * kx as f64, sides[1] * ky as f64];
            (x * x + y * y).sqrt()
        };
        for (ky, kx) in vectors(&columns) {
            let q = length(ky, kx);
            if let Some(ring) = ring_of(q) {
                counts[ring] += 2.0;
            }
        }
        // Mean square of each ring, moved to the next one that has a wave of the grid.
        let mut squares: Vec<f64> = (0..rings)
            .map(|ring| {
                let [low, high] = [self.edges[ring], self.edges[ring + 1]];
                if held(ring) { power[ring] * (high * high - low * low) / (4.0 * PI) } else { 0.0 }
            })
            .collect();
        for ring in 0..rings - 1 {
            if counts[ring] == 0.0 {
                squares[ring + 1] += std::mem::take(&mut squares[ring]);
            }
        }
        let [height, slope] = [0, 1].map(|order| self.share(held, order));
        let target = height * self.square;
        let there: f64 =
            squares.iter().zip(&counts).filter(|(_, count)| **count > 0.0).map(|(square, _)| square).sum();
        require(
            there > 0.0 && target > 0.0,
            "grid of the surface",
            format!("{:e} m x {:e} m", grid.size()[0], grid.size()[1]),
            format!("one that holds waves of {:e} m to {:e} m", TAU / highest, TAU / lowest),
        )?;
        let lower = there > target;
        let factor = |q: f64, a: f64| {
            let more = 1.0 + (a / q).powi(4);
            if lower { 1.0 / more } else { more }
        };
        let total = |a: f64| -> f64 {
            (0..rings)
                .filter(|ring| counts[*ring] > 0.0)
                .map(|ring| squares[ring] * factor(wave_numbers[ring], a))
                .sum()
        };
        let a = root(|a| (total(a) > target) == lower, lowest, 1e3 * highest);
        let scale = target / total(a);
        let (mut slope_square, mut isotropic_square) = (0.0, 0.0);
        for (ky, kx) in vectors(&columns) {
            let wave = &mut columns[ky][kx.rem_euclid(grid.cells()[0] as i64) as usize];
            let q = length(ky, kx);
            let (isotropic, square) = match ring_of(q) {
                Some(ring) if counts[ring] > 0.0 => {
                    let isotropic = squares[ring] / counts[ring];
                    (isotropic, scale * isotropic * factor(wave_numbers[ring], a))
                }
                _ => (0.0, 0.0),
            };
            // The phase of the wave is random, its mean square is not.
            let size = wave.norm();
            // Both waves of the pair.
            slope_square += q * q * square;
            isotropic_square += q * q * isotropic;
            *wave *= if size > 0.0 { square.sqrt() / size } else { 0.0 };
        }
        let all: f64 =
            self.edges.windows(2).zip(&self.power).map(|(e, p)| p * e[0] * e[1] * (e[1] - e[0]) / PI).sum();
        Ok(ProfileSurface {
            heights: waves.sum(&mut columns, 1.0),
            rms_height: [target.sqrt(), self.square.sqrt()],
            rms_slope: [(slope * all).sqrt(), all.sqrt()],
            slope: slope_square.sqrt(),
            isotropic: [there.sqrt(), isotropic_square.sqrt()],
            waves: [TAU / lowest.max(longest), TAU / highest],
            changed_beyond: TAU / a,
        })
    }
}

/// The place between 0 and `high` up to which `holds` is true, by bisection from `start`.
fn root(holds: impl Fn(f64) -> bool, start: f64, high: f64) -> f64 {
    let (mut low, mut end) = (0.0, start);
    while holds(end) && end < high {
        (low, end) = (end, 2.0 * end);
    }
    bisect([low, end], 60, holds)[0]
}

/// Heights minus their straight line.
fn levelled(heights: &[f64]) -> Vec<f64> {
    let n = heights.len() as f64;
    let place = |i: usize| (2 * i + 1) as f64 / n - 1.0;
    let mean = heights.iter().sum::<f64>() / n;
    let along: f64 = heights.iter().enumerate().map(|(i, z)| place(i) * z).sum();
    let square: f64 = (0..heights.len()).map(|i| place(i).powi(2)).sum();
    heights.iter().enumerate().map(|(i, z)| z - mean - along / square * place(i)).collect()
}

/// Multiplies heights by Hann's window of mean square 1.
fn fade(heights: &mut [f64]) {
    let n = heights.len() as f64;
    let scale = (2.0f64 / 3.0).sqrt();
    for (i, z) in heights.iter_mut().enumerate() {
        *z *= scale * (1.0 + libm::cos(PI * ((2 * i + 1) as f64 / n - 1.0)));
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::{Roughness, SelfAffine, statistics};
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

    /// Mean C1 of every line of a map along x.
    fn lines(z: &Array2<f64>, spacing: f64) -> ProfileSpectrum {
        let mut mean = ProfileSpectrum::of(&z.column(0).to_vec(), spacing, true, 16).unwrap();
        for j in 1..z.ncols() {
            let one = ProfileSpectrum::of(&z.column(j).to_vec(), spacing, true, 16).unwrap();
            mean.power.iter_mut().zip(&one.power).for_each(|(sum, power)| *sum += power);
        }
        mean.power.iter_mut().for_each(|power| *power /= z.ncols() as f64);
        mean
    }

    #[test]
    fn one_line_of_a_map_gives_its_height_slope_and_spectrum_back() {
        let grid = Grid::new([512, 512], [1e-3, 1e-3]).unwrap();
        let spacing = 1e-3 / 512.0;
        // With a roll-off, and without: the longest wave is the map.
        for (longest, roll_off) in [(2.5e-4, 1.2e-4), (1e-3, 1e-3)] {
            let (mut slopes, mut bands) = (vec![], vec![]);
            for (seed, periodic) in [(0, true), (1, false), (2, true), (3, false), (4, true)] {
                let roughness = Roughness::RmsHeight(1e-6);
                let map = SelfAffine { hurst: 0.8, roughness, longest, shortest: 1.6e-5, roll_off, seed };
                let line = map.heights(&grid).unwrap().column(7 * seed as usize).to_vec();
                let spectrum = ProfileSpectrum::of(&line, spacing, periodic, 16).unwrap();
                let made = spectrum.surface(&grid, seed + 100).unwrap();
                let rms = statistics::rms_height(made.heights.view()).unwrap();
                // All waves are held, and the mean square of each is given: only rounding.
                assert!((rms / spectrum.square.sqrt() - 1.0).abs() < 1e-9, "{rms} {}", spectrum.square);
                let gradient = statistics::rms_gradient(&grid, made.heights.view()).unwrap();
                slopes.push(gradient / (2.0_f64.sqrt() * made.rms_slope[0]));
                // Waves of 125 um down to 20 um.
                let band = |of: &ProfileSpectrum| -> f64 {
                    let rings = of.power.iter().zip(&of.waves).filter(|(_, w)| w[0] >= 8 && w[1] <= 50);
                    rings.map(|(p, w)| p * (w[1] - w[0]) as f64 * (w[0] as f64).powi(2)).sum()
                };
                bands.push(band(&lines(&made.heights, spacing)) / band(&spectrum));
            }
            // Rings of a sixteenth of a decade: q is known to 4 %; the slope is that of finite differences, of the window 10 %.
            let mean = |x: &[f64]| x.iter().sum::<f64>() / x.len() as f64;
            assert!(
                (mean(&slopes) - 1.0).abs() < 0.04 && (mean(&bands) - 1.0).abs() < 0.06,
                "{slopes:?} {bands:?}"
            );
            assert!(
                slopes.iter().chain(&bands).all(|ratio| (ratio - 1.0).abs() < 0.12),
                "{slopes:?} {bands:?}"
            );
        }
    }

    #[test]
    fn a_map_that_is_shorter_than_the_profile_has_the_height_of_the_waves_that_it_holds() {
        let (_, z) = map(3);
        let spectrum = ProfileSpectrum::of(&z.column(5).to_vec(), 1e-3 / 512.0, true, 16).unwrap();
        // A quarter of the side: waves of 250 um and less; the profile has waves of 62.5 um to 250 um with most of the height.
        let made = spectrum.surface(&Grid::new([128, 128], [2.5e-4; 2]).unwrap(), 1).unwrap();
        let rms = statistics::rms_height(made.heights.view()).unwrap();
        assert!((rms / made.rms_height[0] - 1.0).abs() < 1e-9 && made.rms_height[0] <= made.rms_height[1]);
        assert!(spectrum.surface(&Grid::new([64, 64], [1e-6; 2]).unwrap(), 1).is_err());
        // A constant, and a straight line: only rounding is left.
        for tilt in [0.0, 1e-3] {
            let straight: Vec<f64> = (0..500).map(|i| 0.1 + tilt * f64::from(i)).collect();
            let spectrum = ProfileSpectrum::of(&straight, 1e-6, false, 16).unwrap();
            let error =
                spectrum.surface(&Grid::new([64, 64], [1e-4; 2]).unwrap(), 1).unwrap_err().to_string();
            assert!(error.contains("rms height of the profile"), "{error}");
        }
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
