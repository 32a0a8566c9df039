//! Nested sampling: the probability of a model and of its parameters (J. Skilling, Bayesian Analysis 1 (2006) 833).
//!
//! Parameters are points of a unit cube of uniform prior probability. Of `LIVE` points, the one with the smallest likelihood L_i
//! is removed and replaced by another with a larger likelihood. This is repeated; the remaining part of the cube shrinks by
//! exp(-1/LIVE) each time. Therefore
//!
//! ```text
//! Z = ∫ L dX ≈ Σ L_i (X_(i-1) - X_i),   X_i = exp(-i/LIVE)
//! ```
//!
//! is the probability of the record under the model, and the points taken out, with the weights of this sum, are draws from the
//! probability of the parameters. New points come from a random walk along differences of living points (C. J. F. ter Braak,
//! Stat. Comput. 16 (2006) 239), which follows the directions in which the parameters are correlated.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Number of live points.
const LIVE: usize = 200;
/// Steps of a random walk per parameter.
const STEPS: usize = 5;
/// Fraction of the sum that may be left out.
const LEFT: f64 = 1e-2;
/// Largest number of iterations, in units of [`LIVE`]: no record shrinks the cube by exp(-150).
const LONGEST: usize = 150;

/// Points of the unit cube with the logarithms of their weights L_i (X_(i-1) - X_i), which add up to Z. `ordered`: the number of
/// first coordinates that must increase.
pub(super) fn sample(
    dimensions: usize,
    ordered: usize,
    seed: u64,
    likelihood: impl Fn(&[f64]) -> f64,
) -> Vec<(f64, Vec<f64>)> {
    let mut random = Random(ChaCha8Rng::seed_from_u64(seed));
    let mut living: Vec<(f64, Vec<f64>)> = (0..LIVE)
        .map(|_| {
            let mut point: Vec<f64> = (0..dimensions).map(|_| random.uniform()).collect();
            point[..ordered].sort_by(f64::total_cmp);
            (likelihood(&point), point)
        })
        .collect();
    let mut draws: Vec<(f64, Vec<f64>)> = vec![];
    let shrinkage = (-1.0 / LIVE as f64).exp();
    // ln of the sum so far, and of the remaining part.
    let (mut evidence, mut volume) = (f64::NEG_INFINITY, 0.0_f64);
    for _ in 0..LONGEST * LIVE {
        let order = |a: &usize, b: &usize| living[*a].0.total_cmp(&living[*b].0);
        let (Some(worst), Some(best)) = ((0..LIVE).min_by(order), (0..LIVE).max_by(order)) else { break };
        // The largest possible contribution of the live points.
        if living[best].0 + volume < evidence + LEFT.ln() {
            break;
        }
        let weight = living[worst].0 + volume + (1.0 - shrinkage).ln();
        evidence = add_logarithms(evidence, weight);
        volume -= 1.0 / LIVE as f64;
        let level = living[worst].0;
        let new = walk(&living, worst, level, ordered, &mut random, &likelihood);
        let (_, old) = std::mem::replace(&mut living[worst], new);
        draws.push((weight, old));
    }
    for (value, point) in living {
        draws.push((value + volume - (LIVE as f64).ln(), point));
    }
    draws
}

/// A point with a likelihood above `level`, by a walk from one of the other live points.
fn walk(
    living: &[(f64, Vec<f64>)],
    worst: usize,
    level: f64,
    ordered: usize,
    random: &mut Random,
    likelihood: &impl Fn(&[f64]) -> f64,
) -> (f64, Vec<f64>) {
    let other = |random: &mut Random| (worst + 1 + random.below(LIVE - 1)) % LIVE;
    let start = other(random);
    let (mut value, mut at) = living[start].clone();
    let dimensions = at.len();
    let usual = 1.68 / (dimensions as f64).sqrt();
    for step in 0..STEPS * dimensions.max(4) {
        let (a, b) = (other(random), other(random));
        // Occasionally a full difference, to pass from one mode to another.
        let length = if step % 10 == 9 { 1.0 } else { usual * 2.0 * random.uniform() };
        let differences = living[a].1.iter().zip(&living[b].1);
        let trial: Vec<f64> = at.iter().zip(differences).map(|(x, (a, b))| x + length * (a - b)).collect();
        let inside = trial.iter().all(|x| (0.0..=1.0).contains(x));
        if !inside || trial[..ordered].windows(2).any(|pair| pair[1] < pair[0]) {
            continue;
        }
        let there = likelihood(&trial);
        if there > level {
            (value, at) = (there, trial);
        }
    }
    (value, at)
}

/// ln(exp a + exp b).
pub(super) fn add_logarithms(a: f64, b: f64) -> f64 {
    let (high, low) = if a > b { (a, b) } else { (b, a) };
    if low == f64::NEG_INFINITY { high } else { high + (low - high).exp().ln_1p() }
}

struct Random(ChaCha8Rng);

impl Random {
    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        ((self.uniform() * n as f64) as usize).min(n - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gaussian_has_its_evidence_and_moments() {
        // Two parameters about 0.4 and 0.7, correlated: Z = 2 pi s1 s2 sqrt(1 - c^2).
        let (s, c) = ([0.01, 0.003], 0.9);
        let likelihood = |x: &[f64]| {
            let (a, b) = ((x[0] - 0.4) / s[0], (x[1] - 0.7) / s[1]);
            -0.5 * (a * a - 2.0 * c * a * b + b * b) / (1.0 - c * c)
        };
        let found = sample(2, 0, 1, likelihood);
        let evidence = found.iter().fold(f64::NEG_INFINITY, |sum, draw| add_logarithms(sum, draw.0));
        let exact = (std::f64::consts::TAU * s[0] * s[1] * (1.0 - c * c).sqrt()).ln();
        // The shrinkage is known to sqrt(H / LIVE) with the information H = 10, which is 0.2; the tolerance is four times that.
        assert!((evidence - exact).abs() < 0.9, "{evidence} {exact}");
        let mean = |f: &dyn Fn(&[f64]) -> f64| -> f64 {
            found.iter().map(|(w, x)| (w - evidence).exp() * f(x)).sum()
        };
        // There are about 600 independent draws: means to s/25, variances to 6 %; the tolerance is four times that.
        let (m0, m1) = (mean(&|x| x[0]), mean(&|x| x[1]));
        assert!((m0 - 0.4).abs() < 0.16 * s[0] && (m1 - 0.7).abs() < 0.16 * s[1], "{m0} {m1}");
        let spread = mean(&|x| (x[0] - 0.4).powi(2)).sqrt();
        assert!((spread / s[0] - 1.0).abs() < 0.15, "{spread}");
    }

    #[test]
    fn the_same_seed_gives_the_same_draws() {
        let found = || sample(3, 2, 5, |x| -100.0 * (x[0] * x[1] - x[2]).powi(2));
        let (one, other) = (found(), found());
        assert!(one == other);
        assert!(one.iter().all(|(_, x)| x[0] <= x[1]));
    }
}
