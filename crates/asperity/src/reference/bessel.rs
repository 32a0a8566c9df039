//! Quotients of modified Bessel functions. They are of order one even if the functions themselves overflow.
//!
//! They are computed from integrals (M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions (1964), 9.6.18 and
//! 9.6.24):
//!
//! ```text
//! I_n(x) = (x/2)^n / (sqrt(pi) Gamma(n + 1/2)) int_0^pi e^(x cos t) sin^(2n) t dt
//! K_n(x) = int_0^inf e^(-x cosh t) cosh(n t) dt
//! ```
//!
//! The largest value of the exponential, e^x or e^(-x), cancels in a quotient.

use std::f64::consts::PI;

use super::quadrature::integrate;

/// Beyond this exponent the integrand is below the rounding of its integral.
const REACH: f64 = 45.0;

/// Outside these arguments, the quotients equal their limits to rounding.
const RANGE: [f64; 2] = [1e-150, 1e17];

/// (I0/I1, I2/I1) at x > 0.
pub(super) fn quotients_i(x: f64) -> (f64, f64) {
    let x = x.clamp(RANGE[0], RANGE[1]);
    let end = if 2.0 * x > REACH { 2.0 * (REACH / (2.0 * x)).sqrt().asin() } else { PI };
    let moment = |n: i32| {
        integrate(0.0, end, |t| {
            let half = (0.5 * t).sin();
            t.sin().powi(2 * n) * (-2.0 * x * half * half).exp()
        })
    };
    let (zeroth, first, second) = (moment(0), moment(1), moment(2));
    (zeroth / (x * first), x * second / (3.0 * first))
}

/// K0/K1 at x > 0.
pub(super) fn quotient_k(x: f64) -> f64 {
    let x = x.clamp(RANGE[0], RANGE[1]);
    let end = 2.0 * (REACH / (2.0 * x)).sqrt().asinh();
    let moment = |f: fn(f64) -> f64| {
        integrate(0.0, end, |t| {
            let half = (0.5 * t).sinh();
            f(t) * (-2.0 * x * half * half).exp()
        })
    };
    moment(|_| 1.0) / moment(f64::cosh)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_agree_with_fifty_digits() {
        // (x, I0/I1, I2/I1, K0/K1)
        #[rustfmt::skip]
        let rows = [
            (1e-6, 2000000.00000025, 2.4999999999998956e-7, 1.3931442073726945e-5),
            (0.01, 200.0024999895834, 0.002499989583398437, 0.04722477574570198),
            (0.5, 4.123717928278321, 0.12371792827832073, 0.5580754184765854),
            (1.0, 2.2401937238700897, 0.24019372387008975, 0.6994839355937723),
            (7.5, 1.0744315296394464, 0.8077648629727797, 0.9392388528150902),
            (22.4, 1.0231042838949873, 0.9338185696092729, 0.9783943944534871),
            (22.6, 1.0228926262258335, 0.9343970510045947, 0.9785795754931329),
            (100.0, 1.0050378800081567, 0.9850378800081568, 0.9950371298393055),
            (10000.0, 1.000050003750375, 0.999850003750375, 0.9999500037496251),
        ];
        for (x, i0, i2, k0) in rows {
            let (got_i0, got_i2) = quotients_i(x);
            // A few roundings of each integral.
            for (got, exact) in [(got_i0, i0), (got_i2, i2), (quotient_k(x), k0)] {
                assert!((got / exact - 1.0).abs() < 2e-14, "x = {x}: {got} {exact}");
            }
        }
    }

    #[test]
    fn the_recurrence_and_the_limits_hold() {
        for x in [1e-9, 1e-3, 1.0, 44.0, 46.0, 1e4, 1e12] {
            let (i0, i2) = quotients_i(x);
            // I0 - I2 = 2 I1 / x
            assert!((i0 - i2 - 2.0 / x).abs() < 2e-14 * i0, "{x}");
        }
        for x in [1e17, f64::INFINITY] {
            assert_eq!((quotients_i(x).0.round(), quotient_k(x).round()), (1.0, 1.0));
            assert!((quotients_i(x).1 - 1.0).abs() < 1e-13 && (quotient_k(x) - 1.0).abs() < 1e-13);
        }
        assert!(quotient_k(0.0) < 1e-140 && quotients_i(0.0).0 > 1e140);
    }
}
