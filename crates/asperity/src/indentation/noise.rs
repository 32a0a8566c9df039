//! The noise of a channel, estimated from its rows.
//!
//! A smooth signal is nearly a parabola through four neighbouring rows; white noise is not. With the coefficients c_i of the
//! third divided difference,
//!
//! ```text
//! e_k = Σ c_i y_(k+i) / (Σ c_i²)^(1/2),   i = 0..3        <e²> = σ²  for white noise
//! ```
//!
//! The variance is the median of e² over that of the chi-squared distribution, so the few rows around a kink of the history have
//! no influence. Rows with small and with large values are evaluated separately, so that noise relative to the value is found as
//! well: σ² = a + b y².

use crate::numbers::median;

/// Median of the chi-squared distribution of one degree of freedom.
const MEDIAN: f64 = 0.454_936;
/// Smallest number of rows for a median.
const FEWEST: usize = 12;

/// Variance of the noise of each row.
pub(crate) fn variances(times: &[f64], values: &[f64]) -> Vec<f64> {
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let (mut small, mut large) = (vec![], vec![]);
    for k in 0..values.len().saturating_sub(3) {
        let (t, y) = (&times[k..k + 4], &values[k..k + 4]);
        let square = third_difference(t, y).powi(2);
        let value = y.iter().map(|y| y * y).sum::<f64>() / 4.0;
        let group = if value < 0.25 * largest * largest { &mut small } else { &mut large };
        group.push((square, value));
    }
    let constant =
        |group: &[(f64, f64)]| median(&mut group.iter().map(|pair| pair.0).collect::<Vec<f64>>()) / MEDIAN;
    let (a, b) = if small.len() < FEWEST || large.len() < FEWEST {
        small.append(&mut large);
        (constant(&small), 0.0)
    } else {
        let mean = |group: &[(f64, f64)]| group.iter().map(|pair| pair.1).sum::<f64>() / group.len() as f64;
        let (low, high) = (constant(&small), constant(&large));
        let (at_low, at_high) = (mean(&small), mean(&large));
        let b = ((high - low) / (at_high - at_low)).max(0.0);
        // If the noise does not grow with the value, all rows are used for the constant.
        match b > 0.0 {
            true => ((low - b * at_low).max(0.0), b),
            false => (constant(&[small, large].concat()), 0.0),
        }
    };
    values.iter().map(|y| a + b * y * y).collect()
}

fn third_difference(t: &[f64], y: &[f64]) -> f64 {
    let (mut sum, mut norm) = (0.0, 0.0);
    for i in 0..4 {
        // Relative to the span of the four rows, so that no product of times underflows.
        let span = t[3] - t[0];
        let others: f64 = (0..4).filter(|j| *j != i).map(|j| (t[i] - t[j]) / span).product();
        sum += y[i] / others;
        norm += 1.0 / (others * others);
    }
    // Rows so close that the products underflow are ignored.
    let difference = sum / norm.sqrt();
    if difference.is_finite() { difference } else { 0.0 }
}

/// Standard deviation of the noise, over all rows.
pub(crate) fn deviation(times: &[f64], values: &[f64]) -> f64 {
    let variances = variances(times, values);
    (variances.iter().sum::<f64>() / variances.len() as f64).sqrt()
}

/// The variance of the rows with the least noise.
pub(super) fn smallest(variances: &[f64]) -> f64 {
    variances.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Root of the mean variance over the largest value.
pub(super) fn relative(variances: &[f64], values: &[f64]) -> f64 {
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    (variances.iter().sum::<f64>() / variances.len() as f64).sqrt() / largest
}

#[cfg(test)]
mod tests {
    use super::super::tests::Noise;
    use super::*;

    #[test]
    fn constant_and_relative_noise_are_found_and_kinks_are_none() {
        let mut noise = Noise(3);
        let times: Vec<f64> = (0..1000).map(|k| 0.02 * f64::from(k)).collect();
        // Up within 5 s, held, down within 2 s.
        let clean: Vec<f64> = times.iter().map(|t| (t / 5.0).min(1.0).min((20.0 - t) / 2.0)).collect();
        let exact = variances(&times, &clean);
        assert!(exact.iter().all(|v| *v < 1e-20), "{}", exact[0]);
        let sd = |values: &[f64], row: usize| variances(&times, values)[row].sqrt();
        let constant: Vec<f64> = clean.iter().map(|y| y + 0.01 * noise.normal()).collect();
        let relative: Vec<f64> = clean.iter().map(|y| y * (1.0 + 0.01 * noise.normal())).collect();
        // Row 25 is at 0.1, row 600 at 1. A median of some 800 squares, four of which share a row, is known to 10 %.
        assert!(
            (sd(&constant, 25) / 0.01 - 1.0).abs() < 0.15 && (sd(&constant, 600) / 0.01 - 1.0).abs() < 0.15
        );
        assert!((sd(&relative, 600) / 0.01 - 1.0).abs() < 0.15, "{}", sd(&relative, 600));
        assert!(sd(&relative, 25) < 0.004, "{}", sd(&relative, 25));
    }
}
