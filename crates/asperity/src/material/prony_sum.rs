//! Prony sums for exact creep functions, to a stated error in creep and in relaxation.
//!
//! There are two methods, both with positive weights:
//! - by quadrature over y = ln(rate), such as t^a / Gamma(1 + a) = (sin(pi a)/pi) int exp(-a y) (1 - exp(-t exp(y))) dy: the
//!   trapezoidal rule converges exponentially there (L. N. Trefethen & J. A. C. Weideman, SIAM Review 56 (2014) 385). Terms that
//!   are too fast or too slow for the window only contribute through sums, so the two tails have no cost;
//! - by a fit of samples of the relaxation function ([`super::spectrum`]), which needs fewer terms if the spectrum is narrow (a
//!   fractional Zener solid of order near 1). A relative error of the relaxation function bounds that of the creep function, but
//!   not the other way round.

use crate::error::{Error, Result, require};
use crate::material::fit;
use crate::material::fractional::Approximation;
use crate::material::mittag_leffler::{Spread, sine};
use crate::material::spectrum::{Kernel, Problem, Row, times};
use crate::material::{Creep, CreepTerm, Relaxation};
use std::f64::consts::PI;

/// An exact material, sampled over the window.
pub(super) struct Exact<'a> {
    relaxation: &'a dyn Fn(f64) -> f64,
    /// (t, creep, relaxation)
    samples: Vec<(f64, f64, f64)>,
    window: [f64; 2],
    tolerance: f64,
}

/// An integral of exp(-t exp(y)) over y as a trapezoidal sum: some terms, and the tails beyond them.
pub(super) trait Trapezoid {
    /// The creep function with terms of rates exp(y) at the `nodes` (slowest first, `step` apart).
    fn sum(&self, nodes: &[f64], step: f64) -> Result<Creep>;
}

/// Creep: constant + factor (t/time)^order / Gamma(1 + order)
pub(super) struct PowerLaw {
    pub order: f64,
    pub time: f64,
    pub constant: f64,
    pub factor: f64,
}

/// Relaxation: equilibrium + relaxing E_order(-(t/time)^order), of the spectrum that K. S. Cole & R. H.
/// Cole found for dielectrics, H(y) = (sin(pi a) / 2 pi) / (cosh(a y) + cos(pi a)).
pub(super) struct ColeCole {
    pub order: f64,
    pub time: f64,
    pub equilibrium: f64,
    pub relaxing: f64,
}

/// Range of ln(rate) beyond the terms over which weights are summed one by one: the remaining weights are below 1e-17, or so
/// uniform (order below 0.25) that an integral replaces them to 1e-9.
const SUMMED: f64 = 160.0;

/// Widest window.
const MOST_DECADES: f64 = 40.0;

/// The sum of the coarsest grid of times whose fit is good enough; `solid` with an equilibrium modulus.
pub(super) fn by_fit(exact: &Exact, solid: bool) -> Result<Approximation> {
    let row = |x| {
        let value = (exact.relaxation)(x);
        Row { kernel: Kernel::Relaxation, x, value, weight: 1.0 / value, count: 1.0 }
    };
    const WIDEST: f64 = 3.0;
    let rows: Vec<Row> = times(widen(exact.window, WIDEST), 12.0).into_iter().map(row).collect();
    let fit = |quarters: i32, margin: f64| -> Result<Approximation> {
        let range = widen(exact.window, margin);
        let rows = rows.iter().filter(|r| r.x >= range[0] && r.x <= range[1]).copied().collect();
        let problem = Problem { rows, constant: solid, flow: false, range };
        let creep = fit::relaxation(problem.fit_grid(0.25 * f64::from(quarters)))?.to_creep()?;
        let error = exact.distance(&creep)?;
        Ok(Approximation { creep, error, window: exact.window })
    };
    let mut best = f64::INFINITY;
    for quarters in [2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20, 24, 32, 40] {
        // The creep function depends on the relaxation function before the window. Once the grid is known to be fine enough,
        // increasing amounts of it are tried.
        let widest = fit(quarters, WIDEST)?;
        if widest.error > exact.tolerance {
            best = best.min(widest.error);
            continue;
        }
        for margin in [0.5, 1.0, 1.5, 2.0] {
            let narrower = fit(quarters, margin)?;
            if narrower.error <= exact.tolerance {
                return Ok(narrower);
            }
        }
        return Ok(widest);
    }
    Err(exact.too_tight(best))
}

/// The shortest trapezoidal sum.
pub(super) fn by_quadrature(exact: &Exact, law: &dyn Trapezoid) -> Result<Approximation> {
    let range = widen(exact.window, 1.0 - exact.tolerance.log10());
    let mut best = f64::INFINITY;
    for quarters in 4..=60 {
        let step = std::f64::consts::LN_10 / (0.25 * f64::from(quarters));
        let all = nodes(range, step);
        let mut nodes = all.as_slice();
        let mut error = exact.distance(&law.sum(nodes, step)?)?;
        if error > exact.tolerance {
            best = best.min(error);
            continue;
        }
        // Terms that the tails can represent are left to them.
        for from_slow in [true, false] {
            while nodes.len() > 2 {
                let shorter = if from_slow { &nodes[1..] } else { &nodes[..nodes.len() - 1] };
                let next = exact.distance(&law.sum(shorter, step)?)?;
                if next > exact.tolerance {
                    break;
                }
                (nodes, error) = (shorter, next);
            }
        }
        return Ok(Approximation { creep: law.sum(nodes, step)?, error, window: exact.window });
    }
    Err(exact.too_tight(best))
}

impl Trapezoid for PowerLaw {
    fn sum(&self, nodes: &[f64], step: f64) -> Result<Creep> {
        let a = self.order;
        let density = self.factor * sine(a) / PI;
        let weight = |y: f64| density * step * (-a * (y + self.time.ln())).exp();
        let [slowest, .., fastest] = nodes else { return Err(too_few(nodes)) };
        // All nodes beyond, to infinity, are geometric series: fast terms are retarded immediately, slow terms flow with the sum
        // of their weights times rates.
        let fast = weight(fastest + step) / -(-a * step).exp_m1();
        let slow = weight(slowest - step) * (slowest - step).exp() / -((a - 1.0) * step).exp_m1();
        let term = |y: &f64| CreepTerm { compliance: weight(*y), retardation_time: (-y).exp() };
        Ok(Creep {
            instantaneous: self.constant + fast,
            terms: nodes.iter().rev().map(term).collect(),
            fluidity: slow,
        })
    }
}

impl Trapezoid for ColeCole {
    fn sum(&self, nodes: &[f64], step: f64) -> Result<Creep> {
        let a = self.order;
        let spread = Spread::new(a);
        let power = |y: f64| a * (y + self.time.ln());
        let weight = |y: f64| self.relaxing * (a * step) * spread.density(power(y));
        let [slowest, .., fastest] = nodes else { return Err(too_few(nodes)) };
        // All nodes beyond become one term of the same weight (so that the modulus at t = 0 and infinity
        // is kept) at their mean time on the fast side, mean rate on the slow side.
        let beyond = |from: f64, direction: f64| {
            let last = (SUMMED / step) as usize;
            let ys = (1..=last).map(|k| from + direction * step * k as f64);
            let near = ys
                .map(|y| (weight(y), weight(y) * (-direction * (y - from)).exp()))
                .fold((0.0, 0.0), |sum, term| (sum.0 + term.0, sum.1 + term.1));
            // The weights further out are an integral, with the first term of Euler and Maclaurin.
            let end = power(from + direction * step * (last as f64 + 0.5));
            let far =
                spread.below(-direction * end) - (a * step).powi(2) / 24.0 * spread.fall(direction * end);
            (near.0 + self.relaxing * far, near.1)
        };
        let (fast, slow) = (beyond(*fastest, 1.0), beyond(*slowest, -1.0));
        let term = |y: &f64| (weight(*y), (-y).exp());
        let terms: Vec<(f64, f64)> = nodes
            .iter()
            .map(term)
            .chain([
                (fast.0, (-fastest).exp() * fast.1 / fast.0),
                (slow.0, (-slowest).exp() * slow.0 / slow.1),
            ])
            .filter(|(weight, time)| *weight > 0.0 && time.is_finite())
            .collect();
        Relaxation::absolute(self.equilibrium, &terms)?.to_creep()
    }
}

fn too_few(nodes: &[f64]) -> Error {
    Error::invalid("number of terms of the Prony sum", nodes.len(), "at least 2")
}

/// ln(rate) of terms over a range of times, slowest first.
fn nodes([first, last]: [f64; 2], step: f64) -> Vec<f64> {
    let (low, high) = (-last.ln(), -first.ln());
    (0..=((high - low) / step) as usize).map(|k| low + step * k as f64).collect()
}

impl<'a> Exact<'a> {
    /// Samples both functions over `window`, in which `tolerance` must be reached.
    pub(super) fn new(
        creep: &dyn Fn(f64) -> f64,
        relaxation: &'a dyn Fn(f64) -> f64,
        window: [f64; 2],
        tolerance: f64,
    ) -> Result<Self> {
        check(window, tolerance)?;
        let samples = times(window, 20.0).into_iter().map(|t| (t, creep(t), relaxation(t))).collect();
        Ok(Exact { relaxation, samples, window, tolerance })
    }

    /// Largest relative error of creep and relaxation over the window.
    fn distance(&self, creep: &Creep) -> Result<f64> {
        let relaxation = creep.to_relaxation()?;
        let distance = |(t, c, e): &(f64, f64, f64)| {
            (creep.value(*t) / c - 1.0).abs().max((relaxation.value(*t) / e - 1.0).abs())
        };
        Ok(self.samples.iter().map(distance).fold(0.0, f64::max))
    }

    fn too_tight(&self, reached: f64) -> Error {
        Error::invalid(
            "error allowed to the Prony sum",
            format!("{:e}", self.tolerance),
            format!("at least {reached:.1e}, the smallest that was reached over this window"),
        )
    }
}

fn widen([first, last]: [f64; 2], decades: f64) -> [f64; 2] {
    [first / 10f64.powf(decades), last * 10f64.powf(decades)]
}

fn check([first, last]: [f64; 2], tolerance: f64) -> Result<()> {
    require(
        first > 0.0 && first < last && last.is_finite() && last.log10() - first.log10() <= MOST_DECADES,
        "time window of the Prony sum",
        format!("{first:e} s to {last:e} s"),
        format!("two positive, increasing times at most {MOST_DECADES} decades apart"),
    )?;

    require(
        (1e-8..=0.5).contains(&tolerance),
        "error allowed to the Prony sum",
        tolerance,
        "from 1e-8 to 0.5",
    )?;
    Ok(())
}
