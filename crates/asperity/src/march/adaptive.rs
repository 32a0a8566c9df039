//! Steps as long as their error allows: theory section 4.
//!
//! Over a step of length dt the linear scheme takes U as linear. What that leaves out of a branch strain,
//! integral of (U - its chord) against C exp(-(t - s)/lambda)/lambda, is to leading order
//!
//! ```text
//! eps = U'' dt^2 sum C_i b(dt/lambda_i),   b(x) = [x - 2 + (x + 2) exp(-x)] / (2 x^2),   b = dt/(12 eta) for flow
//! ```
//!
//! with U'' from the last three states: free of charge. The constant scheme leaves out the slope,
//! eps = (U_(n+1) - U_n) sum C_i (phi_i - E_i). The error of the step is the pressure-weighted mean of |eps|, over
//! the largest approach so far. Steps follow it by a proportional-integral controller (K. Gustafsson, ACM Trans. Math.
//! Softw. 17 (1991) 533), grow at most twofold, and start afresh, short, after each break and jump.

use crate::field::{strands, sweep};
use crate::time::SHORTEST;

/// What the scheme of a step leaves out, per U'' or per change of U; see the module.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Defect {
    /// eps = value times U''.
    Curvature(f64),
    /// eps = value times (U_(n+1) - U_n).
    Change(f64),
}

/// Steps grow at most, and shrink at least, by these factors.
const GROWTH: f64 = 2.0;
const SHRINK: f64 = 0.2;
/// Share of the step that the tolerance would allow.
const SAFETY: f64 = 0.9;
/// Errors of single steps add up while the material remembers them: each may take this share.
const SHARE: f64 = 0.25;
/// Errors below this share of the allowed one are alike: where nothing happens they are rounding, whose ups and downs
/// must not move the steps.
const QUIET: f64 = 1e-4;

/// How long the next step is.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pace {
    tolerance: f64,
    first: f64,
    shortest: f64,
    /// No step is longer \[s\]: a share of the period of a cyclic course.
    longest: f64,
    /// Length of the next step \[s\].
    pub(super) dt: f64,
    /// Error of the last step over what it may have; 0 after a restart.
    last: f64,
}

impl Pace {
    pub(super) fn new(tolerance: f64, first: f64, end: f64, longest: f64) -> Self {
        let first = first.min(longest);
        Pace { tolerance: SHARE * tolerance, first, shortest: SHORTEST * end, longest, dt: first, last: 0.0 }
    }

    /// A break: the past says nothing of the steps to come.
    pub(super) fn restart(&mut self) {
        self.dt = self.first;
        self.last = 0.0;
    }

    /// The length to try instead of `dt`, where the error is too large.
    pub(super) fn rejects(&self, dt: f64, error: Option<f64>) -> Option<f64> {
        let excess = error? / self.tolerance;
        if excess <= 1.0 || dt <= self.shortest {
            return None;
        }
        Some((dt * (SAFETY / libm::cbrt(excess)).clamp(SHRINK, SAFETY)).max(self.shortest))
    }

    /// Takes the step `dt`, which may have ended early at a stop, and plans the next.
    pub(super) fn accept(&mut self, dt: f64, error: Option<f64>) {
        let excess = error.map_or(0.0, |error| (error / self.tolerance).max(QUIET));
        let factor = if excess > 0.0 {
            let integral = libm::pow(excess, -0.7 / 3.0);
            let proportional = if self.last > 0.0 { libm::pow(self.last, 0.4 / 3.0) } else { 1.0 };
            (SAFETY * integral * proportional).clamp(SHRINK, GROWTH)
        } else {
            GROWTH
        };
        // A step that a stop cut short says little of a longer one.
        let cut = dt < 0.999 * self.dt && factor >= 1.0;
        let next = if cut { self.dt.max(factor * dt) } else { factor * dt };
        self.dt = next.clamp(self.shortest, self.longest);
        self.last = excess;
    }

    /// dt and last, for a checkpoint.
    pub(super) fn save(&self) -> [f64; 2] {
        [self.dt, self.last]
    }

    pub(super) fn load(&mut self, [dt, last]: [f64; 2]) {
        self.dt = dt;
        self.last = last;
    }
}

/// Three states of U in time: the lengths of the step before and of this one.
pub(super) struct Three<'a> {
    pub(super) older: &'a [f64],
    pub(super) before: &'a [f64],
    pub(super) now: &'a [f64],
    pub(super) lengths: [f64; 2],
}

/// Pressure-weighted mean of |U''| \[m Pa/s^2\]; weights are the pressures at both ends of the step.
pub(super) fn curvature(states: &Three<'_>, pressures: [&[f64]; 2]) -> f64 {
    let [h0, h1] = states.lengths;
    // Divided differences.
    let (a, b) = (2.0 / (h1 * (h0 + h1)), 2.0 / (h0 * (h0 + h1)));
    let fields = (states.now, states.before, states.older, pressures[0], pressures[1]);
    let [sum, weight] =
        sweep(fields, &|(now, before, older, p, q): (&[f64], &[f64], &[f64], &[f64], &[f64])| {
            let n = now.len();
            let (before, older, p, q) = (&before[..n], &older[..n], &p[..n], &q[..n]);
            strands(n, |i| {
                let second = a * (now[i] - before[i]) - b * (before[i] - older[i]);
                let weight = p[i] + q[i];
                [weight * second.abs(), weight]
            })
        });
    if weight > 0.0 { sum / weight } else { 0.0 }
}

/// Pressure-weighted mean of |U_(n+1) - U_n| \[m Pa\].
pub(super) fn change(before: &[f64], now: &[f64], pressures: [&[f64]; 2]) -> f64 {
    let fields = (now, before, pressures[0], pressures[1]);
    let [sum, weight] = sweep(fields, &|(now, before, p, q): (&[f64], &[f64], &[f64], &[f64])| {
        let n = now.len();
        let (before, p, q) = (&before[..n], &p[..n], &q[..n]);
        strands(n, |i| [(p[i] + q[i]) * (now[i] - before[i]).abs(), p[i] + q[i]])
    });
    if weight > 0.0 { sum / weight } else { 0.0 }
}

/// b(x) = \[x - 2 + (x + 2) exp(-x)\] / (2 x^2), x/12 for small x.
pub(super) fn chord_defect(x: f64) -> f64 {
    if x < 0.1 {
        // sum over k >= 3 of (-1)^(k+1) (k - 2)/k! x^k, over 2 x^2: six terms leave less than 1e-10 of the first.
        let mut sum = 0.0;
        let mut power = x;
        let mut factorial = 6.0;
        for k in 3..9_i32 {
            let sign = if k % 2 == 1 { 1.0 } else { -1.0 };
            sum += sign * f64::from(k - 2) / factorial * power;
            power *= x;
            factorial *= f64::from(k + 1);
        }
        0.5 * sum
    } else {
        (x - 2.0 + (x + 2.0) * libm::exp(-x)) / (2.0 * x * x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defect_of_a_chord_is_that_of_a_parabola() {
        // U = t^2 on [0, 1] under its chord t: integral of (t - t^2) exp(-(1 - t) x) x dt, over U'' = 2.
        for x in [1e-6, 0.01, 0.0999999, 0.1, 0.7, 30.0, 1e6] {
            let n = 20_000;
            let f = |k: usize| {
                let t = k as f64 / n as f64;
                // graded towards the end, where the kernel is steep
                let s = 1.0 - (1.0 - t) * (1.0 - t);
                (s - s * s) * (-(1.0 - s) * x).exp() * x * 2.0 * (1.0 - t)
            };
            let sum: f64 = (1..n).map(|k| if k % 2 == 1 { 4.0 * f(k) } else { 2.0 * f(k) }).sum();
            let exact = (sum + f(0) + f(n)) / (3.0 * n as f64) / 2.0;
            // Simpson's rule at x = 1e6 has 14 panels over the kernel's width
            let tolerance = if x > 1e5 { 1e-3 } else { 1e-6 };
            assert!((chord_defect(x) / exact - 1.0).abs() < tolerance, "{x} {} {exact}", chord_defect(x));
        }
    }

    #[test]
    fn the_curvature_of_a_parabola_is_found_from_uneven_steps() {
        // U = (3 t^2, -t^2) at 0, 0.5, 0.6; the second cell weighs three times the first.
        let states =
            Three { older: &[0.0, 0.0], before: &[0.75, -0.25], now: &[1.08, -0.36], lengths: [0.5, 0.1] };
        let found = curvature(&states, [&[1.0, 1.0], &[0.0, 2.0]]);
        assert!((found - (6.0 + 3.0 * 2.0) / 4.0).abs() < 1e-12, "{found}");
        assert_eq!(curvature(&states, [&[0.0, 0.0], &[0.0, 0.0]]), 0.0);
        assert!((change(states.before, states.now, [&[1.0, 0.0], &[0.0, 0.0]]) - 0.33).abs() < 1e-15);
    }

    #[test]
    fn steps_grow_at_most_twofold_shrink_on_error_and_start_afresh() {
        let mut pace = Pace::new(4e-3, 1e-3, 10.0, f64::INFINITY);
        pace.accept(1e-3, None);
        assert_eq!(pace.dt, 2e-3);
        pace.accept(2e-3, Some(1e-12));
        assert_eq!(pace.dt, 4e-3);
        // Rounding that comes and goes holds no step back.
        let mut still = pace.clone();
        for (n, error) in [0.0, 1e-16, 1e-30, 1e-15, 0.0, 1e-18].into_iter().enumerate() {
            let dt = still.dt;
            still.accept(dt, Some(error));
            assert_eq!(still.dt, 2.0 * dt, "{n}");
        }
        // An error 8 times too large: half the step and a margin.
        let shorter = pace.rejects(4e-3, Some(8e-3)).unwrap();
        assert!((shorter - 0.9 * 2e-3).abs() < 1e-12);
        assert_eq!(pace.rejects(4e-3, Some(0.99e-3)), None);
        // Cut short by a stop: the length before is kept.
        pace.accept(1e-5, Some(1e-9));
        assert_eq!(pace.dt, 4e-3);
        pace.restart();
        assert_eq!(pace.dt, 1e-3);
    }
}
