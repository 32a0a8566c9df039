//! Height distributions: the required ordered heights of a surface of n points.

use std::f64::consts::{SQRT_2, TAU};

use crate::error::{Error, Result, require};

/// The distribution of the heights of a synthetic surface; the roughness determines mean and rms.
#[derive(Clone, Debug, PartialEq, Default)]
pub enum HeightDistribution {
    /// Normal, like the sum of many waves.
    #[default]
    Gaussian,
    /// Skewness Ssk and kurtosis Sku (3: Gaussian), by a cubic of a normal variable (A. I. Fleishman,
    /// Psychometrika 43 (1978) 521). It reaches about Sku > 1.9 + 1.6 Ssk^2.
    Moments {
        /// Ssk, negative for plateaus with valleys.
        skewness: f64,
        /// Sku.
        kurtosis: f64,
    },
    /// The distribution of the given samples (for example of a measured surface), linear between them.
    Samples(Vec<f64>),
}

impl HeightDistribution {
    /// Whether there is such a distribution.
    pub(super) fn validate(&self) -> Result<()> {
        match self {
            HeightDistribution::Gaussian => Ok(()),
            HeightDistribution::Moments { skewness, kurtosis } => cubic(*skewness, *kurtosis).map(drop),
            HeightDistribution::Samples(samples) => check_samples(samples),
        }
    }

    /// n heights in increasing order with mean 0 and rms 1: the quantiles at (i + 1/2) / n.
    pub(super) fn values(&self, n: usize) -> Result<Vec<f64>> {
        let shares = (0..n).map(|i| (i as f64 + 0.5) / n as f64);
        let mut values: Vec<f64> = match self {
            HeightDistribution::Gaussian => shares.map(normal_quantile).collect(),
            HeightDistribution::Moments { skewness, kurtosis } => {
                let [b, c, d] = cubic(*skewness, *kurtosis)?;
                shares.map(normal_quantile).map(|z| z * (b + z * (c + z * d))).collect()
            }
            HeightDistribution::Samples(samples) => {
                let sorted = sorted_samples(samples)?;
                shares.map(|share| quantile(&sorted, share)).collect()
            }
        };
        // A cubic may be non-monotone at its ends.
        values.sort_by(f64::total_cmp);
        let mean = values.iter().sum::<f64>() / n as f64;
        values.iter_mut().for_each(|z| *z -= mean);
        let rms = (values.iter().map(|z| z * z).sum::<f64>() / n as f64).sqrt();
        require(
            rms.is_finite() && rms > 0.0,
            "spread of the height distribution",
            rms,
            "finite and greater than 0",
        )?;
        values.iter_mut().for_each(|z| *z /= rms);
        Ok(values)
    }
}

fn check_samples(samples: &[f64]) -> Result<()> {
    require(samples.len() >= 2, "number of samples of the height distribution", samples.len(), "2 at least")?;
    if let Some(bad) = samples.iter().find(|z| !z.is_finite()) {
        return Err(Error::invalid("sample of the height distribution", bad, "finite"));
    }
    Ok(())
}

fn sorted_samples(samples: &[f64]) -> Result<Vec<f64>> {
    check_samples(samples)?;
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    // In units of their range: no overflow of squares.
    let (low, range) = (sorted[0], sorted[sorted.len() - 1] - sorted[0]);
    require(
        range.is_finite() && range > 0.0,
        "range of the samples of the height distribution",
        range,
        "finite and greater than 0",
    )?;
    sorted.iter_mut().for_each(|z| *z = (*z - low) / range);
    Ok(sorted)
}

/// Linear between the samples, sample i at the fraction (i + 1/2) / m; constant beyond the ends.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let last = sorted.len() - 1;
    let at = (share * sorted.len() as f64 - 0.5).clamp(0.0, last as f64);
    let k = (at as usize).min(last - 1);
    sorted[k] + (at - k as f64) * (sorted[k + 1] - sorted[k])
}

/// The z with P(Z < z) = share for a normal variable: a rational start (M. Abramowitz and I. A. Stegun,
/// Handbook of Mathematical Functions (1964), 26.2.23), then Halley's steps on the error function.
fn normal_quantile(share: f64) -> f64 {
    let tail = share.min(1.0 - share);
    let t = (-2.0 * libm::log(tail)).sqrt();
    let start = t
        - (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
    let mut z = start; // upper tail: P(Z > z) = tail
    for _ in 0..2 {
        let density = libm::exp(-0.5 * z * z) / TAU.sqrt();
        let step = (0.5 * libm::erfc(z / SQRT_2) - tail) / density;
        z += step / (1.0 - 0.5 * z * step);
    }
    if share < 0.5 { -z } else { z }
}

/// b, c, d of Y = b Z + c (Z^2 - 1) + d Z^3 with variance 1 and the given skewness and kurtosis, by Newton's method with
/// continuation from the Gaussian.
fn cubic(skewness: f64, kurtosis: f64) -> Result<[f64; 3]> {
    let refuse = || {
        Error::invalid(
            "skewness and kurtosis of the heights",
            format!("{skewness} and {kurtosis}"),
            "finite, with a kurtosis well above 1 + skewness^2 (about 1.9 + 1.6 skewness^2 and more)",
        )
    };
    if !(skewness.is_finite() && kurtosis.is_finite() && kurtosis > 1.0 + skewness * skewness) {
        return Err(refuse());
    }
    const STAGES: usize = 64;
    let mut x = [1.0, 0.0, 0.0];
    for stage in 1..=STAGES {
        let share = stage as f64 / STAGES as f64;
        let wanted = [1.0, share * skewness, share * (kurtosis - 3.0)];
        for _ in 0..20 {
            let miss: [f64; 3] = std::array::from_fn(|m| moments(x)[m] - wanted[m]);
            let step = solve3(jacobian(x), miss).ok_or_else(refuse)?;
            (0..3).for_each(|m| x[m] -= step[m]);
        }
        let worst = (0..3).map(|m| (moments(x)[m] - wanted[m]).abs()).fold(0.0, f64::max);
        // `contains` is false for NaN. b < 0 would be the mirrored branch.
        if !(0.0..1e-9).contains(&worst) || x[0] <= 0.0 {
            return Err(refuse());
        }
    }
    Ok(x)
}

/// Variance, skewness and excess kurtosis of the cubic (Fleishman 1978, eqs 11, 17 and 18).
fn moments([b, c, d]: [f64; 3]) -> [f64; 3] {
    [
        b * b + 6.0 * b * d + 2.0 * c * c + 15.0 * d * d,
        2.0 * c * (b * b + 24.0 * b * d + 105.0 * d * d + 2.0),
        24.0 * (b * d
            + c * c * (1.0 + b * b + 28.0 * b * d)
            + d * d * (12.0 + 48.0 * b * d + 141.0 * c * c + 225.0 * d * d)),
    ]
}

/// Derivatives of the moments by b, c and d.
fn jacobian([b, c, d]: [f64; 3]) -> [[f64; 3]; 3] {
    [
        [2.0 * b + 6.0 * d, 4.0 * c, 6.0 * b + 30.0 * d],
        [
            2.0 * c * (2.0 * b + 24.0 * d),
            2.0 * (b * b + 24.0 * b * d + 105.0 * d * d + 2.0),
            2.0 * c * (24.0 * b + 210.0 * d),
        ],
        [
            24.0 * (d + c * c * (2.0 * b + 28.0 * d) + 48.0 * d * d * d),
            24.0 * (2.0 * c * (1.0 + b * b + 28.0 * b * d) + 282.0 * c * d * d),
            24.0 * (b
                + 28.0 * b * c * c
                + 2.0 * d * (12.0 + 48.0 * b * d + 141.0 * c * c + 225.0 * d * d)
                + d * d * (48.0 * b + 450.0 * d)),
        ],
    ]
}

/// Cramer's rule; `None` if the determinant vanishes.
fn solve3(m: [[f64; 3]; 3], r: [f64; 3]) -> Option<[f64; 3]> {
    let det = |m: [[f64; 3]; 3]| {
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
            + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    };
    let whole = det(m);
    let replaced = |column: usize| {
        let mut m = m;
        (0..3).for_each(|row| m[row][column] = r[row]);
        det(m) / whole
    };
    (whole != 0.0).then(|| std::array::from_fn(replaced))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_quantiles_invert_the_error_function() {
        for share in [1e-12, 1e-4, 0.02, 0.3, 0.5, 0.9, 0.999] {
            let back = 0.5 * libm::erfc(-normal_quantile(share) / SQRT_2);
            assert!((back / share - 1.0).abs() < 1e-12, "{share}: {back}");
        }
        assert!((normal_quantile(0.975) - 1.959_963_984_540_054).abs() < 1e-13);
    }

    #[test]
    fn the_cubic_has_the_moments_asked_for() {
        for (skewness, kurtosis) in [(0.0, 3.0), (-1.0, 5.0), (1.5, 7.0), (0.0, 2.0), (0.3, 12.0)] {
            let values = HeightDistribution::Moments { skewness, kurtosis }.values(200_000).unwrap();
            let moment = |n: i32| values.iter().map(|z| z.powi(n)).sum::<f64>() / values.len() as f64;
            // The quantiles cut off the tails at 1 in 400,000, which reduces high moments slightly.
            assert!((moment(3) - skewness).abs() < 0.02, "{skewness} {kurtosis}: {}", moment(3));
            assert!((moment(4) / kurtosis - 1.0).abs() < 0.04, "{skewness} {kurtosis}: {}", moment(4));
            assert!(moment(1).abs() < 1e-12 && (moment(2) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn samples_are_interpolated_in_order() {
        let values = HeightDistribution::Samples(vec![3.0, 1.0, 2.0]).values(6).unwrap();
        let steps: Vec<f64> = values.windows(2).map(|w| w[1] - w[0]).collect();
        // 1, 1.25, 1.75, 2.25, 2.75, 3 in units of the rms
        let unit = steps[1];
        for (step, wanted) in steps.iter().zip([0.5, 1.0, 1.0, 1.0, 0.5]) {
            assert!((step / unit - wanted).abs() < 1e-12, "{values:?}");
        }
        for bad in [vec![1.0, f64::NAN], vec![2.0, 2.0], vec![]] {
            assert!(HeightDistribution::Samples(bad).values(10).is_err());
        }
    }
}
