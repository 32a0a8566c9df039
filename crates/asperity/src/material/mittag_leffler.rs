//! The Mittag-Leffler function of fractional relaxation, E_a(-x^a) for 0 < a <= 1 and x >= 0.
//!
//! It is the mean of exp(-x s) over rates s whose logarithm y = ln s has the Cole-Cole distribution (R. Gorenflo & F. Mainardi,
//! Fractional calculus, 1997, eq. 3.24), with the density and distribution
//!
//! H(y) = (sin(pi a) / 2 pi) / (cosh(a y) + cos(pi a)),
//! P(y) = atan2(sin(pi a), exp(-a y) + cos(pi a)) / (pi a).
//!
//! Integrated by parts, E = int P(y) k(y + ln x) dy with k(z) = exp(z - exp(z)), a bell-shaped function. The integrand is smooth
//! except for P near y = 0, which has a step over a width of about (1 - a)/a. The Gauss-Legendre panels become smaller towards
//! this step.

use crate::material::quadrature::integrate;
use std::f64::consts::PI;

/// Smaller orders are replaced by this one: the limit of order 0 is reached to the last digit, and products with an order keep
/// their digits.
pub(super) const LEAST_ORDER: f64 = 1e-100;

/// (E, 1 - E) with E = E_a(-x^a), each to nearly full relative accuracy, given ln(x^a): x itself, for example t/tau
/// (G_inf/G_0)^(1/a), may be out of the range of doubles for small a.
pub(super) fn mittag_leffler(a: f64, ln_power: f64) -> (f64, f64) {
    let ln_x = ln_power / a;
    if ln_power == f64::NEG_INFINITY {
        return (1.0, 0.0);
    }
    if a >= 1.0 {
        let x = ln_x.exp();
        return ((-x).exp(), -(-x).exp_m1());
    }
    // z = y + ln x: the bell k(z) is below 1e-18 of its maximum outside. If ln x < 0 it is also weighted with 1 - P, which falls
    // as exp(-a y) from y = 0 on: the product with k(z) rises as exp((1 - a) z).
    let low = (-42.0_f64).min(ln_x - 42.0).max(-42.0 / (1.0 - a));
    let spread = Spread::new(a);
    let bell = |z: f64| (z - z.exp()).exp();
    let (mut kept, mut lost) = (0.0, 0.0);
    for panel in panels(low, 4.0, ln_x, PI * (1.0 - a) / a).windows(2) {
        kept += integrate(panel[0], panel[1], |z| spread.below(a * z - ln_power) * bell(z));
        lost += integrate(panel[0], panel[1], |z| spread.below(ln_power - a * z) * bell(z));
    }
    (kept, lost)
}

/// sin(pi a); for a near 1, where the angle is near pi, from the difference.
pub(super) fn sine(a: f64) -> f64 {
    if a > 0.5 { (PI * (1.0 - a)).sin() } else { (PI * a).sin() }
}

/// The distribution P; the density is even, so that P(-y) = 1 - P(y).
pub(super) struct Spread {
    angle: f64,
    sine: f64,
    cosine: f64,
}

impl Spread {
    pub(super) fn new(a: f64) -> Self {
        let a = a.max(LEAST_ORDER);
        Spread { angle: PI * a, sine: sine(a), cosine: (PI * a).cos() }
    }

    /// P at a y
    pub(super) fn below(&self, ay: f64) -> f64 {
        self.sine.atan2((-ay).exp() + self.cosine) / self.angle
    }

    /// H/a at a y
    pub(super) fn density(&self, ay: f64) -> f64 {
        0.5 * self.sine / self.angle / (ay.cosh() + self.cosine)
    }

    /// -d(H/a)/d(a y) at a y
    pub(super) fn fall(&self, ay: f64) -> f64 {
        // Both ends are zero to the last digit; further out cosh is infinite.
        let ay = ay.clamp(-300.0, 300.0);
        self.density(ay) * ay.sinh() / (ay.cosh() + self.cosine)
    }
}

/// Ends of panels of length at most 1 that become as small as `width` towards the step of P at `step`.
fn panels(low: f64, high: f64, step: f64, width: f64) -> Vec<f64> {
    let mut ends = vec![low];
    let mut z = low;
    while z < high {
        let y = z - step;
        let least = (0.5 * width).max(1e-13 * z.abs());
        let length = if y >= 0.0 { y } else { -0.5 * y }.max(least).min(1.0);
        let next = if y < 0.0 && y + length > 0.0 { step } else { z + length };
        z = next.min(high);
        ends.push(z);
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_half_is_the_scaled_error_function() {
        for x in [1e-8_f64, 1e-3, 0.1, 1.0, 4.0, 20.0] {
            // E_(1/2)(-sqrt x) = exp(x) erfc(sqrt x); erfc of libm is good to an ulp, exp(20) to 20.
            let exact = x.exp() * libm::erfc(x.sqrt());
            let (value, rest) = mittag_leffler(0.5, 0.5 * x.ln());
            assert!((value / exact - 1.0).abs() < 1e-13, "{x} {}", value / exact - 1.0);
            assert!((rest + value - 1.0).abs() < 1e-14);
        }
    }

    const REFERENCE: [(f64, f64, f64); 8] = [
        (0.1, 1.0, 0.485_564_464_311_082_1),
        (0.3, 0.01, 0.777_237_715_088_371_4),
        (0.8, 1.0, 0.386_948_578_618_976_85),
        (0.95, 3.0, 0.076_028_237_681_889_77),
        (0.95, 50.0, 0.001_309_076_539_769_026_6),
        (0.99, 30.0, 0.000_373_188_563_844_554_8),
        (0.3, 1000.0, 0.090_085_099_179_551_3),
        (0.999, 2.0, 0.135_811_391_256_023_93),
    ];

    #[test]
    fn other_orders_meet_their_power_series_and_tail() {
        // 30-digit values: the power series for x = 1, the integral of the spectrum for the others.
        for (a, x, exact) in REFERENCE {
            let value = mittag_leffler(a, a * x.ln()).0;
            assert!((value / exact - 1.0).abs() < 1e-12, "{a} {x} {}", value / exact - 1.0);
        }
        // Small x: 1 - E = x^a / Gamma(1 + a) (1 - O(x^a)).
        let (a, x) = (0.7, 1e-20_f64);
        assert!((mittag_leffler(a, a * x.ln()).1 / (x.powf(a) / libm::tgamma(1.0 + a)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_limits_of_the_order_are_an_algebraic_law_and_an_exponential() {
        // a -> 0 at fixed x^a: 1/(1 + x^a), the next term being of order a.
        for power in [1e-9_f64, 0.3, 1.0, 1e12] {
            for a in [1e-308, 1e-100, 1e-9] {
                let (kept, lost) = mittag_leffler(a, power.ln());
                assert!((kept * (1.0 + power) - 1.0).abs() < 1e-8, "{a:e} {power} {kept}");
                assert!((lost * (1.0 + power) / power - 1.0).abs() < 1e-8, "{a:e} {power} {lost}");
            }
        }
        // a -> 1: exp(-x), the next term being of order (1 - a)/x where x is small.
        for ln_x in [-700.0_f64, -3.0, 0.0, 2.0] {
            let lost = mittag_leffler(1.0 - f64::EPSILON, ln_x).1;
            let exact = -(-ln_x.exp()).exp_m1();
            assert!((lost / exact - 1.0).abs() < 1e-10, "{ln_x} {}", lost / exact - 1.0);
        }
    }
}
