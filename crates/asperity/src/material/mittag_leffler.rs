//! The Mittag-Leffler function of fractional relaxation, E_a(-x^a) for 0 < a <= 1 and x >= 0.
//!
//! It is the mean of exp(-x s) over rates s whose logarithm y = ln s is spread as Cole and Cole found
//! (R. Gorenflo & F. Mainardi, Fractional calculus, 1997, eq. 3.24), with the density and distribution
//!
//! H(y) = (sin(pi a) / 2 pi) / (cosh(a y) + cos(pi a)),
//! P(y) = atan2(sin(pi a), exp(-a y) + cos(pi a)) / (pi a).
//!
//! Integrated by parts, E = int P(y) k(y + ln x) dy with k(z) = exp(z - exp(z)), a bell: smooth but for
//! P near y = 0, where it steps over a width of about (1 - a)/a. Gauss-Legendre panels shrink towards it.

use crate::material::quadrature::integrate;
use std::f64::consts::PI;

/// (E, 1 - E) with E = E_a(-x^a), each to nearly full relative accuracy.
pub(super) fn mittag_leffler(a: f64, x: f64) -> (f64, f64) {
    if x <= 0.0 {
        return (1.0, 0.0);
    }
    if a >= 1.0 {
        return ((-x).exp(), -(-x).exp_m1());
    }
    let shift = x.ln();
    // The bell is below 1e-18 of its top outside, also weighed with 1 - P, which decays from y = 0 on.
    let (low, high) = ((-42.0 - shift).min(-42.0), 4.0 - shift);
    let spread = Spread::new(a);
    let bell = |y: f64| (y + shift - (y + shift).exp()).exp();
    let (mut kept, mut lost) = (0.0, 0.0);
    for panel in panels(low, high, PI * (1.0 - a) / a).windows(2) {
        kept += integrate(panel[0], panel[1], |y| spread.below(y) * bell(y));
        lost += integrate(panel[0], panel[1], |y| spread.below(-y) * bell(y));
    }
    (kept, lost)
}

/// P(y); the density is even, so that P(-y) = 1 - P(y).
struct Spread {
    a: f64,
    sine: f64,
    cosine: f64,
}

impl Spread {
    fn new(a: f64) -> Self {
        // For a near 1 the angle pi a is near pi: its sine from the difference.
        let sine = if a > 0.5 { (PI * (1.0 - a)).sin() } else { (PI * a).sin() };
        Spread { a, sine, cosine: (PI * a).cos() }
    }

    fn below(&self, y: f64) -> f64 {
        self.sine.atan2((-self.a * y).exp() + self.cosine) / (PI * self.a)
    }
}

/// Ends of panels of length 1 at most that shrink to `width` towards 0.
fn panels(low: f64, high: f64, width: f64) -> Vec<f64> {
    let mut ends = vec![low];
    let mut y = low;
    while y < high {
        let length = if y >= 0.0 { y } else { -0.5 * y }.max(0.5 * width).min(1.0);
        let next = if y < 0.0 && y + length > 0.0 { 0.0 } else { y + length };
        y = next.min(high);
        ends.push(y);
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
            let (value, rest) = mittag_leffler(0.5, x);
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
            let value = mittag_leffler(a, x).0;
            assert!((value / exact - 1.0).abs() < 1e-12, "{a} {x} {}", value / exact - 1.0);
        }
        // Small x: 1 - E = x^a / Gamma(1 + a) (1 - O(x^a)).
        let (a, x) = (0.7, 1e-20_f64);
        assert!((mittag_leffler(a, x).1 / (x.powf(a) / libm::tgamma(1.0 + a)) - 1.0).abs() < 1e-12);
    }
}
