//! Bruggeman's effective medium: an estimate of the leak from only the distribution of gaps.
//!
//! The transmissivity T of a medium that surrounds cells of mobility s = h^3 (0 in contact) without changing the flow in the mean,
//!
//! ```text
//! sum over all cells of (s - T)/(s + T) = 0,
//! ```
//!
//! in two dimensions (D. A. G. Bruggeman, Ann. Phys. 416 (1935) 636). It is 0 if at most half of the cells are open. Rough
//! contacts percolate until about 42 % of the cells are in contact, and near this value the estimate is not reliable.

use super::opening::Opening;
use asperity_sweep::sums;

/// T \[m^3\] of the effective medium.
pub fn effective_medium(opening: &Opening) -> f64 {
    let largest = opening.largest();
    let open: Vec<f64> = opening.gap.iter().filter(|h| **h > 0.0).map(|h| (h / largest).powi(3)).collect();
    let closed = (opening.gap.len() - open.len()) as f64;
    if open.len() as f64 <= closed {
        return 0.0;
    }
    // Sum and its derivative over ln T.
    let at = |t: f64| {
        let [sum, slope] = sums(&open[..], |s| [(s - t) / (s + t), -2.0 * s * t / ((s + t) * (s + t))]);
        (sum - closed, slope)
    };
    let (mut low, mut high) =
        (open.iter().fold(1.0_f64, |least, s| least.min(*s)).max(1e-300).ln() - 1.0, 0.0);
    // If cells are closed, the sum need not be positive below the smallest s.
    while at(f64::exp(low)).0 < 0.0 && low > -600.0 {
        low -= 10.0;
    }
    let mut u = 0.5 * (low + high);
    for _ in 0..200 {
        let (sum, slope) = at(libm::exp(u));
        if sum > 0.0 {
            low = u;
        } else {
            high = u;
        }
        let newton = u - sum / slope;
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        if (next - u).abs() <= 1e-13 {
            u = next;
            break;
        }
        u = next;
    }
    libm::exp(u) * largest.powi(3)
}
