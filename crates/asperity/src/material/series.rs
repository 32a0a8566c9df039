//! The common part of creep and relaxation: a sum of weights at times, checked, sorted and merged.
//!
//! Two terms w1, w2 at nearly the same time are replaced by one term w1 + w2 at their weighted mean time. The first-order
//! difference cancels, so for times within a relative distance g the relative change of the sum is less than g^2.

use crate::error::{Error, Result, non_negative, positive};

/// Times closer than this (relative) are one time; its square is below the rounding of a double.
const SAME_TIME: f64 = 1e-9;

/// Checks one weight and its time, naming term `n` (counted from 1).
pub(super) fn validate_term(n: usize, weight: (&str, f64, &str), time: (&str, f64)) -> Result<()> {
    non_negative(&format!("{} of term {n}", weight.0), weight.1, weight.2)?;
    positive(&format!("{} of term {n}", time.0), time.1, "s")?;
    if time.1 < f64::MIN_POSITIVE {
        return Err(Error::invalid(format!("{} of term {n}", time.0), time.1, "at least 1e-300 s"));
    }
    Ok(())
}

/// (time, weight) pairs in order of time, without zero weights, (nearly) equal times merged.
pub(super) fn tidy(pairs: impl IntoIterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut sorted: Vec<(f64, f64)> = pairs.into_iter().filter(|(_, weight)| *weight > 0.0).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<(f64, f64)> = Vec::with_capacity(sorted.len());
    let mut first_of_group = 0.0;
    for (time, weight) in sorted {
        match merged.last_mut() {
            Some((mean, sum)) if time - first_of_group <= SAME_TIME * first_of_group => {
                *mean += (time - *mean) * (weight / (*sum + weight));
                *sum += weight;
            }
            _ => {
                first_of_group = time;
                merged.push((time, weight));
            }
        }
    }
    merged
}

/// The real and imaginary part of 1/(1 - i x), which are 1/(1 + x^2) and x/(1 + x^2), without overflow.
pub(super) fn debye(x: f64) -> (f64, f64) {
    if x <= 1.0 {
        let q = 1.0 / (1.0 + x * x);
        (q, x * q)
    } else {
        let y = 1.0 / x;
        let q = 1.0 / (1.0 + y * y);
        (y * y * q, y * q)
    }
}

/// x - 1 + exp(-x), for x >= 0, to full relative accuracy.
pub(super) fn exponential_remainder(x: f64) -> f64 {
    if x > 0.5 {
        return x + libm::expm1(-x);
    }
    // x^2/2! - x^3/3! + ...: at x = 1/2 the 14th term is below 1e-17 of the first.
    let mut sum = 0.0;
    for k in (2..=16).rev() {
        sum = (1.0 - x * sum) / k as f64;
    }
    x * x * sum
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Deterministic numbers in \[0, 1) (splitmix64).
    pub fn random(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn equal_times_merge_and_zero_weights_vanish() {
        let merged = tidy([(2.0, 1.0), (1.0, 0.25), (2.0, 3.0), (5.0, 0.0), (1.0, 0.5)]);
        assert_eq!(merged, vec![(1.0, 0.75), (2.0, 4.0)]);
    }

    #[test]
    fn a_chain_of_close_times_does_not_collapse() {
        // Neighbours are closer than SAME_TIME, the ends are not.
        let chain: Vec<_> = (0..40).map(|k| (1.0 + 0.4e-9 * k as f64, 1.0)).collect();
        let merged = tidy(chain);
        assert!(merged.len() >= 13, "{}", merged.len());
        assert!((merged.iter().map(|m| m.1).sum::<f64>() - 40.0).abs() < 1e-12);
    }

    #[test]
    fn the_remainder_of_the_exponential_keeps_its_digits() {
        // 50-digit values of x - 1 + exp(-x).
        for (x, exact) in [
            (1e-12, 4.999_999_999_998_333e-25),
            (1e-3, 4.998_333_749_916_681e-7),
            (0.1, 4.837_418_035_959_573_7e-3),
            (0.5, 0.106_530_659_712_633_42),
            (0.500_001, 0.106_531_053_182_276_99),
            (3.0, 2.049_787_068_367_864),
        ] {
            let error = exponential_remainder(x) / exact - 1.0;
            // One or two roundings of the result, and 1/x of them from exp_m1 beyond 1/2.
            assert!(error.abs() < 1e-15, "{x}: {error:e}");
        }
    }
}
