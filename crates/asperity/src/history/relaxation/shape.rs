//! How the driver of the memory runs over a step, from its value at the start (0) to that at the end (1).
//!
//! Under approach control u runs linearly in time. Under load control it runs linearly in L(t) = int C(t - s) dW(s), the
//! load of the elastic contact of unit modulus that has the same contact area while the contact grows. With the
//! load W linear over the step, Wd = dW/ds and the strains l_j of L at the start,
//!
//! ```text
//! L(s) - L(0) = a1 s + a2 s² + Σ A_j (1 - exp(-s/λ_j)),    A_j = C_j W - l_j - C_j Wd λ_j
//! a1 = C0 Wd + Σ C_j Wd + W/η,    a2 = Wd/(2η)
//! ```
//!
//! A state q_i takes the share γ_i = ∫ exp(-(x - s)/τ_i) r(s) ds/τ_i of the change of u in a step of length x, with
//! r(s) = [L(s) - L(0)]/[L(x) - L(0)]. Where L does not run one way through the step, or does not change, r = s/x.

use super::rules::Share;
use crate::material::Dual;

/// A change of L below this share of L is rounding.
const STILL: f64 = 1e-9;
/// A slope of L of the other sign below this share of the largest is rounding.
const LEVEL: f64 = 1e-12;
/// Below this x/λ a retarded term is expanded in powers of it.
const SHORT: f64 = 0.05;

/// The course of L over a step under load.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shape {
    /// a1 and a2.
    linear: f64,
    square: f64,
    /// A_j.
    fading: Vec<f64>,
}

impl Shape {
    /// For as many retarded terms.
    pub(crate) fn new(terms: usize) -> Self {
        Shape { linear: 0.0, square: 0.0, fading: vec![0.0; terms] }
    }

    /// The course of L while the load goes from `load` at the rate `slope`; `strains` are those of L at the start.
    pub(crate) fn set(&mut self, dual: &Dual, load: f64, slope: f64, strains: &[f64]) {
        let creep = &dual.creep;
        let retarded: f64 = creep.terms.iter().map(|term| term.compliance).sum();
        self.linear = (creep.instantaneous + retarded) * slope + creep.fluidity * load;
        self.square = 0.5 * creep.fluidity * slope;
        for ((a, term), l) in self.fading.iter_mut().zip(&creep.terms).zip(strains) {
            *a = term.compliance * (load - slope * term.retardation_time) - l;
        }
    }

    /// L(s) - L(0).
    pub(crate) fn change(&self, dual: &Dual, s: f64) -> f64 {
        let terms = self.fading.iter().zip(&dual.creep.terms);
        let fading: f64 = terms.map(|(a, term)| -a * libm::expm1(-s / term.retardation_time)).sum();
        (self.linear + self.square * s) * s + fading
    }

    /// dL/ds.
    pub(crate) fn slope(&self, dual: &Dual, s: f64) -> f64 {
        let terms = self.fading.iter().zip(&dual.creep.terms);
        let fading: f64 =
            terms.map(|(a, c)| a / c.retardation_time * libm::exp(-s / c.retardation_time)).sum();
        self.linear + 2.0 * self.square * s + fading
    }

    /// Whether L, at the value `start` first, runs one way through a step of length `x` and changes at all.
    pub(crate) fn runs_one_way(&self, dual: &Dual, start: f64, x: f64) -> bool {
        let slopes = [0.0, 0.25, 0.5, 1.0].map(|part| self.slope(dual, part * x));
        let largest = slopes.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
        let tolerance = LEVEL * largest;
        let rises = slopes.iter().any(|s| *s > tolerance);
        let falls = slopes.iter().any(|s| *s < -tolerance);
        rises != falls && self.change(dual, x).abs() > STILL * start.abs()
    }

    /// γ of the state `i` over a step of length `x`, in which L changes by `change`, and 1 - γ.
    pub(crate) fn share(&self, dual: &Dual, i: usize, x: f64, change: f64) -> Share {
        let tau = dual.relaxation.terms[i].relaxation_time;
        self.share_of(dual, tau, |j| dual.gaps(j)[i] / tau, x, change)
    }

    /// The same of a state with the relaxation time `tau`; `gap`(j) = (λ_j - τ)/τ.
    pub(crate) fn share_of(
        &self,
        dual: &Dual,
        tau: f64,
        gap: impl Fn(usize) -> f64,
        x: f64,
        change: f64,
    ) -> Share {
        let times = self.fading.iter().zip(&dual.creep.terms).map(|(a, term)| (*a, term.retardation_time));
        share_of([self.linear * x, self.square * x * x], times, gap, [x, tau], change)
    }
}

/// γ and 1 - γ of a state with the relaxation time `tau` over a step of length x > 0 in which u runs as Σ A (1 - exp(-s/t)), all A
/// of one sign; `terms` are the (A, t).
pub(crate) fn fading_share(terms: &[(f64, f64)], tau: f64, x: f64) -> Share {
    let change = terms.iter().map(|(a, time)| a * moment(0, x / time)).sum();
    let gap = |j: usize| terms[j].1 / tau - 1.0;
    share_of([0.0; 2], terms.iter().copied(), gap, [x, tau], change)
}

/// The share of a course linear s/x + square (s/x)² + Σ A (1 - exp(-s/t)) that changes by `change`.
fn share_of(
    [linear, square]: [f64; 2],
    terms: impl Iterator<Item = (f64, f64)>,
    gap: impl Fn(usize) -> f64,
    [x, tau]: [f64; 2],
    change: f64,
) -> Share {
    let y = x / tau;
    let moments: [f64; 7] = std::array::from_fn(|k| moment(k as u32, y));
    let mut taken = linear * moments[1] + square * moments[2];
    let mut left = linear * (moments[0] / y) + square * (1.0 - moments[2]);
    for (j, (a, time)) in terms.enumerate() {
        let z = x / time;
        let part = retarded(z, y, gap(j), &moments);
        taken += a * part;
        left += a * (moment(0, z) - part);
    }
    // Rounding leads out of the range that a course in one direction has.
    let taken = (taken / change).clamp(0.0, moments[0]);
    Share { taken, left: (left / change).clamp(1.0 - moments[0], 1.0) }
}

/// y ∫_0^1 exp(-y (1 - s)) s^k ds.
pub(crate) fn moment(k: u32, y: f64) -> f64 {
    let order = f64::from(k);
    if k == 0 {
        return -libm::expm1(-y);
    }
    if y < 2.0 {
        // sum over n >= 1 of (-1)^(n+1) y^n k!/(n + k)!: thirty terms leave less than 1e-16 of the first.
        let mut term = y / (order + 1.0);
        let mut sum = term;
        for n in 2..30 {
            term *= -y / (order + f64::from(n));
            sum += term;
            if term.abs() < 1e-17 * sum {
                break;
            }
        }
        sum
    } else {
        1.0 - order / y * moment(k - 1, y)
    }
}

/// ∫ exp(-(x - s)/τ) (1 - exp(-s/λ)) ds/τ over a step, with z = x/λ, y = x/τ and `gap` = (λ - τ)/τ.
fn retarded(z: f64, y: f64, gap: f64, moments: &[f64; 7]) -> f64 {
    if z < SHORT {
        // Powers up to the sixth leave less than 1e-12 of the first.
        let mut factor = 1.0;
        let mut sum = 0.0;
        for (k, moment) in moments.iter().enumerate().skip(1) {
            factor *= -z / k as f64;
            sum -= factor * moment;
        }
        return sum;
    }
    // λ/(λ - τ) [exp(-z) - exp(-y)] with y - z = y (λ - τ)/λ, small where the two times agree.
    let difference = z * gap;
    let slower = libm::exp(if difference < 0.0 { -y } else { -z });
    moments[0] - y * slower * mean_decay(difference.abs())
}

/// (1 - exp(-d))/d.
fn mean_decay(d: f64) -> f64 {
    if d > 0.0 { -libm::expm1(-d) / d } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Creep, CreepTerm};

    /// ∫ over \[0, 1\] by Gauss' rule of three points on panels that grow from both ends.
    fn integral(f: impl Fn(f64) -> f64) -> f64 {
        let node = 0.6f64.sqrt();
        let mut edges = vec![0.0];
        edges.extend((0..400).map(|n| 0.5 * libm::pow(10.0, -20.0 + 0.05 * f64::from(n))));
        let right: Vec<f64> = edges.iter().rev().map(|e| 1.0 - e).collect();
        edges.extend(right);
        let panels = edges.windows(2).map(|e| {
            let (middle, half) = (0.5 * (e[0] + e[1]), 0.5 * (e[1] - e[0]));
            half * (5.0 * f(middle - node * half) + 8.0 * f(middle) + 5.0 * f(middle + node * half)) / 9.0
        });
        panels.sum()
    }

    #[test]
    fn moments_are_their_integrals() {
        for y in [1e-12, 1e-3, 0.7, 1.999, 2.001, 30.0, 1e5] {
            for k in 0..7 {
                let exact = integral(|s| y * libm::exp(-y * (1.0 - s)) * s.powi(k));
                let found = moment(k as u32, y);
                // The quadrature's panels.
                assert!((found / exact - 1.0).abs() < 1e-6, "{k} {y}: {found} {exact}");
            }
        }
    }

    #[test]
    fn a_retarded_term_is_its_integral_however_short_the_step_and_close_the_times() {
        for tau in [1e-6, 1e-2, 1.0, 300.0] {
            for lambda in [1e-5, 1e-2 * (1.0 + 1e-9), 0.9999, 1.0 + 1e-6, 50.0, 1e6] {
                for x in [1e-4, 0.049, 0.051, 1.0, 1e3] {
                    let y = x / tau;
                    let moments = std::array::from_fn(|k| moment(k as u32, y));
                    let found = retarded(x / lambda, y, (lambda - tau) / tau, &moments);
                    let exact = integral(|s| y * libm::exp(-y * (1.0 - s)) * -libm::expm1(-s * x / lambda));
                    assert!((found / exact - 1.0).abs() < 1e-6, "{tau} {lambda} {x}: {found:e} {exact:e}");
                }
            }
        }
    }

    #[test]
    fn the_course_of_the_driver_is_the_hereditary_integral_of_the_load() {
        let term = |compliance, retardation_time| CreepTerm { compliance, retardation_time };
        let creep = Creep { instantaneous: 0.3, terms: vec![term(0.5, 0.2), term(1.5, 4.0)], fluidity: 0.1 };
        let dual = Dual::of(creep.clone()).unwrap();
        let mut shape = Shape::new(2);
        // W = 2 + 3 s from rest: L = 2 C(s) + 3 int C, less the jump 2 C0 at the start.
        shape.set(&dual, 2.0, 3.0, &[0.0, 0.0, 0.0]);
        for s in [1e-3, 0.4, 7.0] {
            let exact = 2.0 * (creep.value(s) - 0.3) + 3.0 * creep.integral(s);
            assert!((shape.change(&dual, s) / exact - 1.0).abs() < 1e-12);
            let slope = 2.0 * creep.rate(s) + 3.0 * creep.value(s);
            assert!((shape.slope(&dual, s) / slope - 1.0).abs() < 1e-12);
        }
        assert!(shape.runs_one_way(&dual, 0.6, 5.0));
        // γ against its integral.
        let (x, change) = (2.0, shape.change(&dual, 2.0));
        for i in 0..dual.states() {
            let y = x / dual.relaxation.terms[i].relaxation_time;
            let exact = integral(|s| y * libm::exp(-y * (1.0 - s)) * shape.change(&dual, s * x) / change);
            let share = shape.share(&dual, i, x, change);
            assert!((share.taken / exact - 1.0).abs() < 1e-6, "{i}");
            assert!((share.taken + share.left - 1.0).abs() < 1e-14, "{i}");
        }
        // A load that falls, of a body that still creeps: up, then down.
        shape.set(&dual, 2.0, -0.5, &[0.0, 0.0, 0.0]);
        assert!(!shape.runs_one_way(&dual, 0.6, 30.0));
        // A body at rest under a held load.
        shape.set(&dual, 0.0, 0.0, &[0.0, 0.0, 0.0]);
        assert!(!shape.runs_one_way(&dual, 0.6, 30.0));
    }
}
