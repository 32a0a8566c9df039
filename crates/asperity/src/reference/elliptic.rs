//! Complete elliptic integrals by the arithmetic-geometric mean.
//!
//! ```text
//! K(k) = int_0^(pi/2) dphi / sqrt(1 - k^2 sin^2 phi),   E(k) = int_0^(pi/2) sqrt(1 - k^2 sin^2 phi) dphi
//! ```
//!
//! With a_0 = 1, b_0 = k', c_0 = k and a_(n+1) = (a_n + b_n)/2, b_(n+1) = sqrt(a_n b_n), c_(n+1) = (a_n - b_n)/2: K = pi / (2 a),
//! E = K (1 - sum_n 2^(n-1) c_n^2) (M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions (1964), section 17.6). The
//! complementary modulus k' = sqrt(1 - k^2) is the argument, so K keeps its digits if it is large.

use std::f64::consts::FRAC_PI_2;

/// The complete elliptic integrals of one modulus, with the two combinations that cancel in K and E
/// for small k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elliptic {
    /// K, first kind.
    pub k: f64,
    /// E, second kind.
    pub e: f64,
    /// D = (K - E) / k^2.
    pub d: f64,
    /// B = (E - k'^2 K) / k^2; K = B + D.
    pub b: f64,
}

/// K, E, D and B at the complementary modulus k' = sqrt(1 - k^2), 0 < k' <= 1.
///
/// At k' = 0 (k = 1) K and D are infinite, E = B = 1. Outside \[0, 1\] the result is NaN.
///
/// ```
/// use asperity::reference::elliptic;
/// let circle = elliptic(1.0); // k = 0
/// assert_eq!(circle.k, std::f64::consts::FRAC_PI_2);
/// assert!((elliptic(0.5f64.sqrt()).e - 1.350_643_881_047_675_5).abs() < 1e-15);
/// ```
pub fn elliptic(complementary: f64) -> Elliptic {
    if !(0.0..=1.0).contains(&complementary) {
        return Elliptic { k: f64::NAN, e: f64::NAN, d: f64::NAN, b: f64::NAN };
    }
    if complementary == 0.0 {
        return Elliptic { k: f64::INFINITY, e: 1.0, d: f64::INFINITY, b: 1.0 };
    }
    let m = (1.0 - complementary) * (1.0 + complementary);
    let (mut a, mut b) = (1.0, complementary);
    // sum over n >= 1 of 2^(n-1) c_n^2 divided by m; c_1 = m / (2 (1 + k')) keeps it finite at m = 0.
    let (mut sum, mut power) = (0.0, 1.0);
    let mut c_over_m = 0.5 / (1.0 + complementary);
    loop {
        let c = m * c_over_m;
        sum += power * c * c_over_m;
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        if c <= 1e-17 * a {
            break;
        }
        // c_(n+1) = c_n^2 / (4 a_(n+1)), without the cancellation in a_n - b_n.
        c_over_m = c_over_m * c / (2.0 * (a + b));
        power *= 2.0;
    }
    let k = FRAC_PI_2 / a;
    Elliptic { k, e: k * (1.0 - m * (0.5 + sum)), d: k * (0.5 + sum), b: k * (0.5 - sum) }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;

    #[test]
    fn they_are_the_defining_integrals() {
        for complementary in [1.0, 0.999_999, 0.9, 0.5, 0.1, 1e-2] {
            let m = 1.0 - complementary * complementary;
            let root = |phi: f64| (1.0 - m * phi.sin().powi(2)).sqrt();
            let of = |f: &dyn Fn(f64) -> f64| integrate(0.0, FRAC_PI_2, f);
            let got = elliptic(complementary);
            let pairs = [
                (got.k, of(&|p| 1.0 / root(p))),
                (got.e, of(&root)),
                (got.d, of(&|p| p.sin().powi(2) / root(p))),
                (got.b, of(&|p| p.cos().powi(2) / root(p))),
            ];
            for (a, b) in pairs {
                // The quadrature loses digits if the root nearly vanishes.
                assert!((a / b - 1.0).abs() < 1e-13, "k' = {complementary}: {a} {b}");
            }
        }
    }

    #[test]
    fn near_k_equal_one_k_is_logarithmic() {
        for c in [1e-6, 1e-100, 1e-300] {
            // K = ln(4/k') + O(k'^2 ln k')
            assert!((elliptic(c).k / (4.0 / c).ln() - 1.0).abs() < 1e-11);
            assert!((elliptic(c).e - 1.0).abs() < 1e-10);
        }
        assert!(elliptic(1.5).k.is_nan() && elliptic(f64::NAN).e.is_nan());
    }
}
