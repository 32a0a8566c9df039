//! Integrals and roots for the reference solutions.
//!
//! The integrands here are smooth inside their interval and may have square-root, cube-root or logarithmic singularities at the
//! ends. The double exponential rule (H. Takahasi and M. Mori, Publ. RIMS Kyoto Univ. 9 (1974) 721) integrates them to rounding:
//!
//! ```text
//! int_a^b f dx = h sum_k f(x_k) x'(t_k),   x = (a+b)/2 + (b-a)/2 tanh(pi/2 sinh t),   t_k = k h
//! ```

use std::f64::consts::{FRAC_PI_2, PI};

/// A point of an interval with its distances from both ends, which keep their digits close to them.
#[derive(Clone, Copy)]
pub(super) struct Point {
    /// Its position.
    pub(super) x: f64,
    /// Distance from the lower end.
    pub(super) above: f64,
    /// Distance from the upper end.
    pub(super) below: f64,
}

/// Integral of f from a to b, to rounding; 0 if b <= a.
pub(super) fn integrate(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    integrate_to(1e-14, a, b, |p| f(p.x))
}

/// Integral of f from a to b until halving the step changes it by less than `tolerance` of the integral
/// of |f|. The rule doubles its digits with each halving: 1e-7 here means nearly full precision.
pub(super) fn integrate_to(tolerance: f64, a: f64, b: f64, f: impl Fn(Point) -> f64) -> f64 {
    if b <= a {
        return 0.0;
    }
    let term = |t: f64| {
        let (point, weight) = node(a, b, t);
        // An end itself may be singular, and its weight has underflown.
        let usable = point.above > 0.0 && point.below > 0.0 && weight > 0.0;
        let value = if usable { f(point) * weight } else { 0.0 };
        (value, value.abs())
    };
    let add = |sum: (f64, f64), new: (f64, f64)| (sum.0 + new.0, sum.1 + new.1);
    let mut h = 0.5;
    let count = (REACH / h) as i32;
    let mut sum = (-count..=count).map(|k| term(f64::from(k) * h)).fold((0.0, 0.0), add);
    for _ in 0..8 {
        let previous = sum.0 * h;
        h *= 0.5;
        let count = (REACH / h) as i32;
        let odd = (-count..=count).filter(|k| k % 2 != 0);
        sum = odd.map(|k| term(f64::from(k) * h)).fold(sum, add);
        if (sum.0 * h - previous).abs() <= tolerance * sum.1 * h {
            break;
        }
    }
    sum.0 * h
}

/// Points and weights for one integral from a to b of functions with at most logarithmic ends: full precision if they are
/// analytic on a few interval lengths around.
pub(super) fn fixed_rule(a: f64, b: f64) -> impl Iterator<Item = (Point, f64)> {
    // Beyond |t| = 3.6 the weights are below 1e-21.
    const STEPS: i32 = 16;
    let count = (3.6 * f64::from(STEPS)) as i32;
    (-count..=count).map(move |k| {
        let (point, weight) = node(a, b, f64::from(k) / f64::from(STEPS));
        (point, weight / f64::from(STEPS))
    })
}

/// Beyond this |t| the weights underflow for the strongest end singularity that occurs here.
const REACH: f64 = 6.1;

/// x(t) and x'(t).
fn node(a: f64, b: f64, t: f64) -> (Point, f64) {
    let s = FRAC_PI_2 * t.sinh();
    // (1 +- tanh s) / 2 without cancellation.
    let share = |s: f64| 1.0 / (1.0 + (2.0 * s).exp());
    let (above, below) = ((b - a) * share(-s), (b - a) * share(s));
    let x = if above < below { a + above } else { b - below };
    (Point { x, above, below }, PI * t.cosh() * above * (below / (b - a)))
}

/// The root of an increasing function between `low` and `high`, to rounding: inverse quadratic interpolation if it is reliable,
/// otherwise bisection (T. R. Chandrupatla, Adv. Engng Softw. 28 (1997) 145). If f does not change sign, the result is one of the
/// ends.
pub(super) fn root(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    // b is the newest point, a brackets the root together with b, and c is the previous point.
    let (mut a, mut fa, mut b, mut fb) = (low, f(low), high, f(high));
    if fa >= 0.0 {
        return low;
    }
    if fb <= 0.0 {
        return high;
    }
    let mut share = 0.5;
    for _ in 0..200 {
        let x = a + share * (b - a);
        let fx = f(x);
        let (c, fc);
        if (fx > 0.0) == (fa > 0.0) {
            (c, fc) = (a, fa);
        } else {
            (c, fc, b, fb) = (b, fb, a, fa);
        }
        (a, fa) = (x, fx);
        let (best, value) = if fa.abs() < fb.abs() { (a, fa) } else { (b, fb) };
        let smallest = f64::EPSILON * best.abs() / (b - a).abs();
        if value == 0.0 || smallest >= 0.5 || a == b {
            return best;
        }
        let (xi, phi) = ((a - b) / (c - b), (fa - fb) / (fc - fb));
        let trusted = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        let inverse_quadratic =
            fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb);
        let wanted = if trusted { inverse_quadratic } else { 0.5 };
        share = wanted.clamp(smallest, 1.0 - smallest);
    }
    if fa.abs() < fb.abs() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    // A few roundings of the sum of a hundred terms.
    const ROUNDING: f64 = 5e-15;

    #[test]
    fn smooth_and_singular_ends_are_integrated_to_rounding() {
        assert!((integrate(0.0, 2.0, |x| x * x) - 8.0 / 3.0).abs() < ROUNDING);
        assert!((integrate(0.0, 1.0, |x| (1.0 - x * x).sqrt()) - FRAC_PI_2 / 2.0).abs() < ROUNDING);
        assert!((integrate(0.0, 1.0, f64::ln) + 1.0).abs() < ROUNDING);
        assert!((integrate_to(1e-14, 0.0, 1.0, |p| p.below.powf(-0.5)) - 2.0).abs() < ROUNDING);
        assert!((integrate(0.0, 1.0, |x| x.powf(-2.0 / 3.0)) - 3.0).abs() < 1e-13);
        assert!((integrate(-3.0, 200.0, |x| (x - 200.0).exp()) - 1.0).abs() < ROUNDING);
        assert_eq!(integrate(1.0, 1.0, |x| x), 0.0);
        let fixed = |f: &dyn Fn(Point) -> f64| fixed_rule(0.0, 2.0).map(|(p, w)| f(p) * w).sum::<f64>();
        assert!((fixed(&|p| p.above.ln() * p.x.cos()) - fixed_by_parts()).abs() < ROUNDING);
        assert!((fixed(&|p| p.below.sqrt() * p.above) - 4.0 / 15.0 * 4.0 * 2f64.sqrt()).abs() < ROUNDING);
    }

    /// int_0^2 ln x cos x dx = ln 2 sin 2 - int_0^2 sin x / x dx.
    fn fixed_by_parts() -> f64 {
        let sine_integral = integrate(0.0, 2.0, |x| x.sin() / x);
        2f64.ln() * 2f64.sin() - sine_integral
    }

    #[test]
    fn roots_are_found_to_the_last_bit() {
        assert!((root(0.0, 2.0, |x| x * x - 2.0) - 2f64.sqrt()).abs() <= f64::EPSILON);
        assert!((root(0.0, 1e6, |x| x.powi(9) - 1e-9) - 0.1).abs() < 1e-16);
        assert_eq!(root(1.0, 2.0, |x| x), 1.0);
        assert_eq!(root(-2.0, -1.0, |x| x), -1.0);
    }
}
