//! A power spectrum divided into shells of the wave number |q|, and the contribution of each to the stress below full contact and
//! to the friction.
//!
//! With q_e the component of q along the motion, and |A|^2 the power of the waves,
//!
//! ```text
//! square = (1/8) sum |q|^2 |A|^2 |E*(q_e v)|^2 [Pa^2],   stress = (1/2) sum |q| q_e |A|^2 E''(q_e v) [Pa]
//! ```
//!
//! The sums are over the waves of a grid, or are integrals over an isotropic spectrum C(q) = (2 pi)^2 |A|^2 / d2q, which is a
//! power law between its points. Around the circle q_e = q sech t, dphi = sech t dt turns the integrals into ones over the whole
//! line, where the trapezoidal rule converges as exp(-pi^2/step): the nearest poles of E* are at |Im t| = pi/2.

use std::f64::consts::TAU;

use crate::error::{Error, Result, increasing, positive, require};
use crate::material::Creep;
use crate::sliding::Direction;
use crate::surface::Surface;
use crate::surface::statistics::{PowerSpectrum, Wave};

/// The contribution of the waves of one |q|.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shell {
    /// Largest |q| \[1/m\].
    pub(super) wave_number: f64,
    /// Added to G times the square of the nominal pressure \[Pa^2\].
    pub(super) square: f64,
    /// Friction stress in full contact \[Pa\].
    pub(super) stress: f64,
}

/// A spectrum divided into shells.
pub(super) trait Shells: std::fmt::Debug + Send + Sync {
    /// Visits the shells at a speed, starting from the longest waves.
    fn each(&self, creep: &Creep, speed: f64, visit: &mut dyn FnMut(Shell));
}

/// The waves of a periodic grid, in order of |q|.
#[derive(Debug)]
pub(super) struct Waves {
    /// The different q_e \[1/m\].
    along: Vec<f64>,
    /// The waves: number of their q_e, |q|^2 |A|^2 / 8 and |q| q_e |A|^2 / 2.
    waves: Vec<(usize, f64, f64)>,
    /// |q| of each shell and the number of waves up to its end.
    shells: Vec<(f64, usize)>,
}

/// Wave numbers closer than this (relative) are equal: they differ by rounding.
const SAME: f64 = 1e-12;

/// Waves with a smaller fraction of the mean square height are rounding errors of the transform.
const NOISE: f64 = 1e-26;

impl Waves {
    /// From a surface that slides in a direction.
    pub(super) fn of(surface: &Surface, direction: Direction) -> Result<Self> {
        let [cos, sin] = direction.unit();
        require(
            cos.is_finite() && sin.is_finite(),
            "direction",
            format!("{direction:?}"),
            "of a finite angle in rad",
        )?;
        let along = |wave: &Wave| (wave.wave_vector[0] * cos + wave.wave_vector[1] * sin).abs();
        let spectrum = PowerSpectrum::of(surface)?;
        let power: f64 = spectrum.waves().map(|wave| wave.power).sum();
        let highest = surface.heights().iter().fold(0.0f64, |most, z| most.max(z.abs()));
        // The transform of a constant height leaves its rounding error.
        if power.sqrt() <= 1e-14 * highest {
            return Err(no_roughness());
        }
        let mut waves: Vec<Wave> = spectrum.waves().filter(|wave| wave.power > NOISE * power).collect();
        waves.sort_by(|a, b| a.wave_number.total_cmp(&b.wave_number));
        let mut different: Vec<f64> = waves.iter().map(along).collect();
        different.sort_by(f64::total_cmp);
        different.dedup();
        let mut shells: Vec<(f64, usize)> = vec![];
        for (n, wave) in waves.iter().enumerate() {
            match shells.last_mut() {
                Some((q, end)) if wave.wave_number <= *q * (1.0 + SAME) => *end = n + 1,
                _ => shells.push((wave.wave_number, n + 1)),
            }
        }
        let weighed = waves.iter().map(|wave| {
            let (q, q_e) = (wave.wave_number, along(wave));
            let number = different.partition_point(|other| *other < q_e);
            (number, 0.125 * q * q * wave.power, 0.5 * q * q_e * wave.power)
        });
        Ok(Waves { waves: weighed.collect(), along: different, shells })
    }
}

impl Shells for Waves {
    fn each(&self, creep: &Creep, speed: f64, visit: &mut dyn FnMut(Shell)) {
        let moduli: Vec<(f64, f64)> = self.along.iter().map(|q| square_and_loss(creep, q * speed)).collect();
        let mut start = 0;
        for &(wave_number, end) in &self.shells {
            let mut shell = Shell { wave_number, square: 0.0, stress: 0.0 };
            for &(number, for_square, for_stress) in &self.waves[start..end] {
                let (square, loss) = moduli[number];
                shell.square += for_square * square;
                shell.stress += for_stress * loss;
            }
            visit(shell);
            start = end;
        }
    }
}

/// An isotropic spectrum.
#[derive(Debug)]
pub(super) struct Isotropic {
    panels: Vec<Panel>,
    /// Nodes around the circle: q_e/|q| and the weight of the node.
    circle: Vec<(f64, f64)>,
}

/// A narrow shell, integrated by Gauss's rule with two points.
#[derive(Clone, Copy, Debug)]
struct Panel {
    end: f64,
    /// q and q^4 C dln(q) / (2 pi)^2 of its points.
    points: [(f64, f64); 2],
}

/// The resolution of an isotropic spectrum.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fineness {
    /// Largest width of a shell in ln q.
    pub(super) shell: f64,
    /// Step of the trapezoidal rule around the circle.
    pub(super) circle: f64,
}

impl Default for Fineness {
    /// Errors of about 1e-7 from the shells and 2e-8 from the circle.
    fn default() -> Self {
        Fineness { shell: 0.005, circle: 0.4 }
    }
}

impl Isotropic {
    /// From the points (q \[1/m\], C \[m^4\]) in order of q.
    pub(super) fn new(wave_numbers: &[f64], power: &[f64], fineness: Fineness) -> Result<Self> {
        check(wave_numbers, power)?;
        let mut panels = vec![];
        for (q, c) in wave_numbers.windows(2).zip(power.windows(2)) {
            let [q0, q1, c0, c1] = [q[0], q[1], c[0], c[1]];
            if c0 == 0.0 && c1 == 0.0 {
                continue;
            }
            let width = libm::log(q1 / q0);
            let exponent = libm::log(c1 / c0) / width;
            // A power law; if it starts or ends at 0, a straight line.
            let law = |q: f64| {
                if exponent.is_finite() {
                    c0 * libm::exp(exponent * libm::log(q / q0))
                } else {
                    c0 + (c1 - c0) * ((q - q0) / (q1 - q0))
                }
            };
            let bend = if exponent.is_finite() { (exponent.abs() / 20.0).max(1.0) } else { 1.0 };
            let number = (width * bend / fineness.shell).ceil().max(1.0);
            let step = width / number;
            let at = |share: f64| q0 * libm::exp(share * step);
            for n in 0..number as usize {
                let point = |offset: f64| {
                    let q = at(n as f64 + 0.5 + offset);
                    (q, 0.5 * step * law(q) * (q * q / TAU) * (q * q / TAU))
                };
                let offset = 0.5 / 3f64.sqrt();
                let end = if n + 1 == number as usize { q1 } else { at((n + 1) as f64) };
                panels.push(Panel { end, points: [point(-offset), point(offset)] });
            }
        }
        // Beyond t = 24 only 1e-10 of the length of the circle remains, where |E*| is smallest.
        let count = (24.0 / fineness.circle) as usize;
        let node = |n: usize| {
            let share = 1.0 / libm::cosh(n as f64 * fineness.circle);
            // Four quarters, each with half of the node at 0.
            (share, fineness.circle * share * if n == 0 { 2.0 } else { 4.0 })
        };
        Ok(Isotropic { panels, circle: (0..=count).map(node).collect() })
    }
}

impl Shells for Isotropic {
    fn each(&self, creep: &Creep, speed: f64, visit: &mut dyn FnMut(Shell)) {
        for panel in &self.panels {
            let mut shell = Shell { wave_number: panel.end, square: 0.0, stress: 0.0 };
            for (q, power) in panel.points {
                let (mut squares, mut losses) = (0.0, 0.0);
                for (share, weight) in &self.circle {
                    let (square, loss) = square_and_loss(creep, q * share * speed);
                    squares += weight * square;
                    losses += weight * share * loss;
                }
                shell.square += 0.125 * power * squares;
                shell.stress += 0.5 * power * losses;
            }
            visit(shell);
        }
    }
}

/// |E*|^2 and E'' at an angular frequency.
fn square_and_loss(creep: &Creep, omega: f64) -> (f64, f64) {
    let (storage, loss) = creep.complex(omega);
    // E* = 1/(J' - i J'')
    let square = 1.0 / (storage * storage + loss * loss);
    (square, loss * square)
}

fn no_roughness() -> Error {
    Error::invalid(
        "rms roughness of the surface",
        0,
        "greater than 0 m: a flat surface is in contact everywhere",
    )
}

fn check(wave_numbers: &[f64], power: &[f64]) -> Result<()> {
    require(
        wave_numbers.len() == power.len() && power.len() >= 2,
        "number of points of the spectrum",
        format!("{} wave numbers and {} values of C", wave_numbers.len(), power.len()),
        "the same for both, 2 at least",
    )?;
    for q in wave_numbers {
        positive("wave number of the spectrum", *q, "1/m")?;
    }
    let name = |_| "wave number of the spectrum".to_owned();
    increasing(wave_numbers.iter().copied(), name, |q| q.to_string())?;
    if let Some(c) = power.iter().find(|c| !(c.is_finite() && **c >= 0.0)) {
        return Err(Error::invalid("value of the spectrum", c, "finite and not less than 0 m^4"));
    }
    if power.iter().all(|c| *c == 0.0) {
        return Err(no_roughness());
    }
    Ok(())
}
