//! Levenberg-Marquardt on the parameters of a record (D. W. Marquardt, J. SIAM 11 (1963) 431), and their standard deviations to
//! first order.

use rayon::prelude::*;

use super::model::Model;
use super::parameters::{Law, Parameters};
use crate::error::{Result, require};
use crate::material::{Relaxation, dot};

/// Steps of the central differences, in logarithms: the model's own steps are 1e-5 of its values.
const STEP: f64 = 1e-2;
/// Steps of the one-sided differences during the search.
const SIDESTEP: f64 = 3e-3;
/// A decrease of the sum of squares below this is slow; this number of consecutive slow decreases ends the search.
const SLOW: f64 = 1e-4;
const PATIENCE: usize = 3;
/// Largest change of a parameter: a factor of e.
const LONGEST: f64 = 1.0;
const MOST_ITERATIONS: usize = 60;

/// The parameters that fit best.
pub(super) struct Solution<L = Parameters> {
    pub(super) parameters: L,
    pub(super) at: Vec<f64>,
    /// Weighted, over the largest measured value.
    pub(super) residuals: Vec<f64>,
    /// Standard deviations of the parameters to first order; infinite if the record does not determine a parameter.
    pub(super) deviations: Vec<f64>,
}

impl Solution {
    pub(super) fn relaxation(&self) -> Relaxation {
        self.parameters.relaxation(&self.at)
    }
}

impl<L: Law> Solution<L> {
    pub(super) fn rms(&self) -> f64 {
        (squares(&self.residuals) / self.residuals.len() as f64).sqrt()
    }

    /// The depth of first touch over the largest depth.
    pub(super) fn touch(&self) -> f64 {
        self.parameters.touch(&self.at)
    }
}

/// Minimises the residuals from `start`.
pub(super) fn solve<L: Law>(model: &Model, parameters: L, start: Vec<f64>) -> Result<Solution<L>> {
    require(
        model.compared() >= 2 * parameters.len() + 2,
        "number of rows of the record",
        format!("{} with load", model.compared()),
        format!("at least {} to fit {} numbers", 2 * parameters.len() + 2, parameters.len()),
    )?;
    let mut at = start;
    let mut residuals = model.residuals(parameters, &at)?;
    let mut columns = slopes(model, parameters, &at, &residuals)?;
    let (mut damping, mut slow) = (1e-3, 0);
    for _ in 0..MOST_ITERATIONS {
        let Some(step) = damped_step(&columns, &residuals, damping) else {
            damping *= 10.0;
            if damping > 1e10 {
                break;
            }
            continue;
        };
        let longest = step.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
        let share = if longest > LONGEST { LONGEST / longest } else { 1.0 };
        let trial: Vec<f64> = at.iter().zip(&step).map(|(x, s)| x + share * s).collect();
        // Parameters for which the model fails (a contact that opens from within) are no improvement.
        let moved = model.residuals(parameters, &trial).ok();
        let better = moved.filter(|moved| squares(moved) < squares(&residuals));
        match better {
            Some(moved) => {
                let gain = 1.0 - squares(&moved) / squares(&residuals);
                (at, residuals) = (trial, moved);
                damping = (damping * 0.2).max(1e-12);
                slow = if gain < SLOW { slow + 1 } else { 0 };
                if slow == PATIENCE || (gain < 1e-7 && longest < 1e-3) {
                    break;
                }
                columns = slopes(model, parameters, &at, &residuals)?;
            }
            None => {
                damping *= 8.0;
                if damping > 1e10 || longest < 1e-9 {
                    break;
                }
            }
        }
    }
    let columns = jacobian(model, parameters, &at)?;
    let variance = squares(&residuals) / (residuals.len() - columns.len()) as f64;
    let deviations = match covariance(&columns, variance) {
        Some(covariance) => (0..at.len()).map(|k| covariance[k][k].max(0.0).sqrt()).collect(),
        None => vec![f64::INFINITY; at.len()],
    };
    Ok(Solution { parameters, at, residuals, deviations })
}

/// Columns of dr/dx by one-sided differences, for the search.
fn slopes<L: Law>(model: &Model, parameters: L, at: &[f64], residuals: &[f64]) -> Result<Vec<Vec<f64>>> {
    let column = |k: usize| {
        let moved = |by: f64| moved(model, parameters, at, k, by).map(|there| (there, by));
        let (there, by) = moved(SIDESTEP).or_else(|_| moved(-SIDESTEP))?;
        Ok(there.iter().zip(residuals).map(|(there, here)| (there - here) / by).collect())
    };
    (0..at.len()).into_par_iter().map(column).collect()
}

/// Columns of dr/dx by central differences; one-sided if the model fails on one side.
fn jacobian<L: Law>(model: &Model, parameters: L, at: &[f64]) -> Result<Vec<Vec<f64>>> {
    let column = |k: usize| {
        let moved = |by: f64| moved(model, parameters, at, k, by);
        let (ends, length) = match (moved(STEP), moved(-STEP)) {
            (Ok(up), Ok(down)) => ((up, down), 2.0 * STEP),
            (Ok(up), Err(_)) => ((up, moved(0.0)?), STEP),
            (Err(_), Ok(down)) => ((moved(0.0)?, down), STEP),
            (Err(error), Err(_)) => return Err(error),
        };
        Ok(ends.0.iter().zip(&ends.1).map(|(up, down)| (up - down) / length).collect())
    };
    (0..at.len()).into_par_iter().map(column).collect()
}

/// The residuals with parameter `k` changed by `by`.
fn moved<L: Law>(model: &Model, parameters: L, at: &[f64], k: usize, by: f64) -> Result<Vec<f64>> {
    let mut there = at.to_vec();
    there[k] += by;
    model.residuals(parameters, &there)
}

/// J'J.
pub(crate) fn normal<C: AsRef<[f64]>>(columns: &[C]) -> Vec<Vec<f64>> {
    let row = |a: &C| columns.iter().map(|b| dot(a.as_ref(), b.as_ref())).collect();
    columns.iter().map(row).collect()
}

/// (J'J + damping diag J'J) step = -J'r.
pub(crate) fn damped_step(columns: &[Vec<f64>], residuals: &[f64], damping: f64) -> Option<Vec<f64>> {
    let mut damped = normal(columns);
    let largest = (0..damped.len()).map(|k| damped[k][k]).fold(0.0, f64::max);
    for (k, row) in damped.iter_mut().enumerate() {
        row[k] += damping * row[k] + 1e-14 * largest;
    }
    let gradient: Vec<f64> = columns.iter().map(|column| dot(column, residuals)).collect();
    let inverse = invert(damped)?;
    let step: Vec<f64> = inverse.iter().map(|row| -dot(row, &gradient)).collect();
    step.iter().all(|s| s.is_finite()).then_some(step)
}

/// (J'J)⁻¹ `variance`; `None` if J'J is singular.
pub(crate) fn covariance(columns: &[Vec<f64>], variance: f64) -> Option<Vec<Vec<f64>>> {
    let inverse = invert(normal(columns))?;
    Some(inverse.into_iter().map(|line| line.into_iter().map(|x| variance * x).collect()).collect())
}

/// The inverse of a symmetric, positive definite matrix by Gauss-Jordan elimination on its scaled form; `None` if it is singular.
pub(crate) fn invert(mut matrix: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let n = matrix.len();
    let scale: Vec<f64> = (0..n).map(|k| matrix[k][k].sqrt()).collect();
    if scale.iter().any(|s| !(*s > 0.0 && s.is_finite())) {
        return None;
    }
    for (i, row) in matrix.iter_mut().enumerate() {
        row.iter_mut().enumerate().for_each(|(j, m)| *m /= scale[i] * scale[j]);
        row.extend((0..n).map(|j| if i == j { 1.0 } else { 0.0 }));
    }
    for k in 0..n {
        // The pivots of a scaled positive definite matrix lie between 0 and 1.
        if matrix[k][k].is_nan() || matrix[k][k] < 1e-13 {
            return None;
        }
        let pivot = matrix[k][k];
        matrix[k].iter_mut().for_each(|m| *m /= pivot);
        let line = matrix[k].clone();
        for (i, row) in matrix.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let factor = row[k];
            debug_assert!(i != k);
            row.iter_mut().zip(&line).for_each(|(m, l)| *m -= factor * l);
        }
    }
    Some(
        matrix
            .iter()
            .enumerate()
            .map(|(i, row)| (0..n).map(|j| row[n + j] / (scale[i] * scale[j])).collect())
            .collect(),
    )
}

fn squares(r: &[f64]) -> f64 {
    dot(r, r)
}
