//! The half-space in plane strain: the displacement due to a strip of pressure.
//!
//! u(x) = -(2/π) ∫ p(s) ln|x - s| ds + a constant, for E* = 1 (Johnson, Contact Mechanics, 1985, eq. 2.24a). The displacement of
//! a half-space under a line load is infinite, so displacements are only known up to a constant. Here they are measured from the
//! point at the distance of the last coefficient.

use std::f64::consts::FRAC_2_PI;

/// Distance in cells from which the series in (half a cell / distance)² is accurate to all digits.
const FAR: f64 = 4.0;
/// Terms of the series: (1/8)^(2 TERMS) is a rounding error.
const TERMS: usize = 9;

/// Displacements \[m\] at the centres of the cells 0, 1, ... `count` - 1 away from a cell of length `dx` \[m\] under unit pressure;
/// the last one is 0.
///
/// ```
/// let k = asperity::kernel::strip(1.0, 3);
/// // -(2/π) ∫ ln|s| ds over the cell, less the same two cells away.
/// let own = 0.5 * 0.5f64.ln() * 2.0 - 1.0;
/// let far = 2.5 * 2.5f64.ln() - 1.5 * 1.5f64.ln() - 1.0;
/// assert!((k[0] - 2.0 / std::f64::consts::PI * (far - own)).abs() < 1e-15 && k[2] == 0.0);
/// ```
pub fn strip(dx: f64, count: usize) -> Vec<f64> {
    let last = mean_logarithm(count.saturating_sub(1));
    (0..count).map(|i| FRAC_2_PI * dx * (last - mean_logarithm(i))).collect()
}

/// The displacement \[m\] at any distance x \[m\] from the middle of a strip of width `dx` \[m\] under unit pressure, up to a constant:
/// -(2/π) ∫ ln(|x - s|/dx) ds over the strip.
pub(crate) fn strip_at(x: f64, dx: f64) -> f64 {
    -FRAC_2_PI * dx * mean_logarithm_at((x / dx).abs())
}

/// Mean of ln|i - s| over -1/2 < s < 1/2.
fn mean_logarithm(i: usize) -> f64 {
    mean_logarithm_at(i as f64)
}

/// The same at any x >= 0.
fn mean_logarithm_at(x: f64) -> f64 {
    if x < FAR {
        let part = |u: f64| if u == 0.0 { 0.0 } else { u * libm::log(u.abs()) };
        return part(x + 0.5) - part(x - 0.5) - 1.0;
    }
    // ln x - Σ (1/2x)^(2k) / (2k (2k + 1))
    let square = 0.25 / (x * x);
    let series = (1..=TERMS).rev().fold(0.0, |sum, k| square * (sum + 1.0 / (2 * k * (2 * k + 1)) as f64));
    libm::log(x) - series
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_series_goes_on_where_the_closed_form_ends() {
        for i in 4..12 {
            let x = i as f64;
            let closed = (x + 0.5) * (x + 0.5).ln() - (x - 0.5) * (x - 0.5).ln() - 1.0;
            // roundings of terms of size x ln x
            assert!((mean_logarithm(i) - closed).abs() < 1e-14 * x, "{i}");
        }
    }

    #[test]
    fn coefficients_fall_and_are_convex() {
        // Therefore their cosine series is positive on any torus (Polya), and the operator is positive definite.
        let k = strip(1e-6, 500);
        assert!(k.windows(2).all(|k| k[0] > k[1]));
        assert!(k.windows(3).all(|k| k[0] + k[2] > 2.0 * k[1]));
    }
}
