//! Refinement with free times: Levenberg-Marquardt on the logarithms of weights and times.
//!
//! Logarithms keep weights and times positive without constraints, and make their steps relative
//! (D. W. Marquardt, J. SIAM 11 (1963) 431, with his scaling by the diagonal).

use crate::material::spectrum::{Problem, Spectrum};
use crate::material::{dot, series};

/// Improves all weights and times, at most `iterations` times; never worse than `start`.
pub(super) fn refine(problem: &Problem, start: Spectrum, iterations: usize) -> Spectrum {
    let (mut best, mut damping) = (start, 1e-3);
    let mut system = System::of(problem, &best);
    for _ in 0..iterations {
        let Some(step) = system.step(damping) else {
            damping *= 10.0;
            continue;
        };
        let trial = moved(problem, &best, &step);
        let next = System::of(problem, &trial);
        if next.squares < system.squares {
            let gain = 1.0 - next.squares / system.squares;
            (best, system) = (trial, next);
            damping = (damping * 0.2).max(1e-12);
            if gain < 1e-5 {
                break;
            }
        } else {
            damping *= 8.0;
            if damping > 1e8 {
                break;
            }
        }
    }
    best.terms = series::tidy(best.terms);
    best
}

/// Gauss-Newton system J'J step = -J'r of one spectrum.
struct System {
    squares: f64,
    normal: Vec<Vec<f64>>,
    gradient: Vec<f64>,
}

impl System {
    fn of(problem: &Problem, spectrum: &Spectrum) -> Self {
        let n = 2 + 2 * spectrum.terms.len();
        let mut system = System { squares: 0.0, normal: vec![vec![0.0; n]; n], gradient: vec![0.0; n] };
        let mut jacobian = Vec::with_capacity(n);
        for row in &problem.rows {
            let residual = problem.linearise(row, spectrum, &mut jacobian);
            system.squares += residual * residual;
            for (i, ji) in jacobian.iter().enumerate() {
                system.gradient[i] += ji * residual;
                for (entry, jj) in system.normal[i][..=i].iter_mut().zip(&jacobian) {
                    *entry += ji * jj;
                }
            }
        }
        system
    }

    /// Solves (J'J + damping diag(J'J)) step = -J'r by Cholesky; parameters without effect do not change.
    fn step(&self, damping: f64) -> Option<Vec<f64>> {
        let negative: Vec<f64> = self.gradient.iter().map(|g| -g).collect();
        let step = substitute(&self.factor(damping)?, negative);
        step.iter().all(|s| s.is_finite()).then_some(step)
    }

    /// The Cholesky factor of J'J + damping diag(J'J).
    fn factor(&self, damping: f64) -> Option<Vec<Vec<f64>>> {
        let n = self.gradient.len();
        let largest = (0..n).map(|i| self.normal[i][i]).fold(0.0, f64::max);
        let mut l = self.normal.clone();
        for (i, row) in l.iter_mut().enumerate() {
            row[i] += damping * row[i] + 1e-20 * largest + f64::MIN_POSITIVE;
        }
        for i in 0..n {
            for j in 0..=i {
                let value = l[i][j] - dot(&l[i][..j], &l[j][..j]);
                l[i][j] = match j < i {
                    true => value / l[j][j],
                    false if value > 0.0 => value.sqrt(),
                    false => return None,
                };
            }
        }
        Some(l)
    }
}

/// L L' x = b.
fn substitute(l: &[Vec<f64>], mut x: Vec<f64>) -> Vec<f64> {
    let n = x.len();
    for i in 0..n {
        x[i] = (x[i] - dot(&l[i][..i], &x)) / l[i][i];
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - sum) / l[i][i];
    }
    x
}

/// Relative standard deviations of weight and time of each term: the diagonal of s^2 (J'J)^-1 for the logarithms, with the
/// variance s^2 of the residuals (over the number of rows minus that of the parameters).
pub(super) fn uncertainty(problem: &Problem, spectrum: &Spectrum) -> Vec<[f64; 2]> {
    let system = System::of(problem, spectrum);
    let used = (0..system.gradient.len()).filter(|i| system.normal[*i][*i] > 0.0).count();
    let free = problem.rows.len().saturating_sub(used);
    let unknown = vec![[f64::INFINITY; 2]; spectrum.terms.len()];
    let (Some(l), true) = (system.factor(0.0), free > 0) else { return unknown };
    let deviation = |i: usize| {
        let mut unit = vec![0.0; system.gradient.len()];
        unit[i] = 1.0;
        let variance = system.squares / free as f64 * substitute(&l, unit)[i];
        if system.normal[i][i] > 0.0 && variance.is_finite() {
            variance.max(0.0).sqrt()
        } else {
            f64::INFINITY
        }
    };
    (0..spectrum.terms.len()).map(|k| [deviation(2 + 2 * k), deviation(3 + 2 * k)]).collect()
}

/// Applies one step; no number changes by more than a factor e, and times stay in their range.
fn moved(problem: &Problem, spectrum: &Spectrum, step: &[f64]) -> Spectrum {
    let factor = |k: usize| step[k].clamp(-1.0, 1.0).exp();
    let [shortest, longest] = problem.range;
    Spectrum {
        constant: spectrum.constant * factor(0),
        flow: spectrum.flow * factor(1),
        terms: spectrum
            .terms
            .iter()
            .enumerate()
            .map(|(k, (time, weight))| {
                let time = (time * factor(3 + 2 * k)).clamp(shortest, longest);
                (time, weight * factor(2 + 2 * k))
            })
            .collect(),
    }
}
