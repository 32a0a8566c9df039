//! Least-squares polynomials through two curves, of which the second is moved and raised.

use super::Logs;
use crate::material::dot;
use crate::numbers::extent;

/// The polynomials of all quantities, with the second curves moved by d and, if v is free, raised by the best v.
pub(super) struct Joint {
    pub squares: f64,
    /// Largest root of the mean square of the slope of a polynomial.
    pub slope: f64,
    /// The best v.
    pub raised: f64,
    /// Half of the second derivative of the squares with respect to v; 0 if they do not depend on it.
    pub curvature: f64,
}

impl Joint {
    pub(super) fn fit(pairs: &[[Logs; 2]], d: f64, degree: usize, free: bool) -> Joint {
        let mut joint = Joint { squares: 0.0, slope: 0.0, raised: 0.0, curvature: 0.0 };
        let (mut along, mut points) = (0.0, 0);
        for [first, second] in pairs {
            let fit = Polynomial::fit(first, second, d, degree, free);
            joint.squares += fit.squares;
            joint.slope = joint.slope.max(fit.slope);
            joint.curvature += fit.curvature;
            along += fit.along;
            points += first.len() + second.len();
        }
        if !free || joint.curvature < 1e-9 * points as f64 {
            return Joint { curvature: 0.0, ..joint };
        }
        let squares = (joint.squares - along * along / joint.curvature).max(0.0);
        Joint { squares, raised: -along / joint.curvature, ..joint }
    }
}

/// The least-squares polynomial through both curves, with the second one moved.
struct Polynomial {
    /// Sum of the squares of its residuals.
    squares: f64,
    /// Root mean square of its slope where both curves overlap, or over all points if they do not.
    slope: f64,
    /// The part of a step between the two curves that is orthogonal to the polynomials, squared, and its product with the
    /// residuals of the values.
    curvature: f64,
    along: f64,
}

impl Polynomial {
    fn fit(first: &Logs, second: &Logs, d: f64, degree: usize, free: bool) -> Polynomial {
        let points: Vec<(f64, f64)> =
            first.iter().copied().chain(second.iter().map(|(x, y)| (x + d, *y))).collect();
        let mut rest: Vec<f64> = points.iter().map(|(_, y)| *y).collect();
        let values = rest.clone();
        let mut step: Vec<f64> = match free {
            true => (0..points.len()).map(|n| if n < first.len() { 0.0 } else { 1.0 }).collect(),
            false => Vec::new(),
        };
        // The remainder of the values is their distance from the polynomial.
        for column in orthonormal(&points, degree) {
            remove(&mut rest, &column);
            remove(&mut step, &column);
        }
        let fitted: Vec<f64> = values.iter().zip(&rest).map(|(value, rest)| value - rest).collect();
        Polynomial {
            squares: dot(&rest, &rest),
            slope: slope(&points, &fitted, first.len()),
            curvature: dot(&step, &step),
            along: dot(&step, &rest),
        }
    }
}

/// Polynomials up to a degree at the given points: Chebyshev polynomials, orthogonalised one after the other (modified
/// Gram-Schmidt).
pub(super) fn orthonormal(points: &[(f64, f64)], degree: usize) -> Vec<Vec<f64>> {
    let ends = extent(points.iter().map(|point| point.0));
    let unit = 2.0 / (ends[1] - ends[0]).max(f64::MIN_POSITIVE);
    let places: Vec<f64> = points.iter().map(|(x, _)| unit * (x - ends[0]) - 1.0).collect();
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(degree + 1);
    for n in 0..=degree {
        let mut column: Vec<f64> = places.iter().map(|u| chebyshev(n, *u)).collect();
        for other in &basis {
            remove(&mut column, other);
        }
        let norm = dot(&column, &column).sqrt();
        if norm > 1e-9 * (column.len() as f64).sqrt() {
            column.iter_mut().for_each(|value| *value /= norm);
            basis.push(column);
        }
    }
    basis
}

/// Root mean square of the slope of the fitted values between neighbours of either curve, where the curves overlap.
fn slope(points: &[(f64, f64)], fitted: &[f64], split: usize) -> f64 {
    let (first, second) = points.split_at(split);
    let low = first[0].0.max(second[0].0);
    let high = first[first.len() - 1].0.min(second[second.len() - 1].0);
    let pairs = |all: bool| {
        let (mut squares, mut length) = (0.0, 0.0);
        for k in (1..points.len()).filter(|k| *k != split) {
            let [from, to] = [points[k - 1].0, points[k].0];
            if all || (to >= low && from <= high) {
                squares += (fitted[k] - fitted[k - 1]).powi(2) / (to - from);
                length += to - from;
            }
        }
        (length > 0.0).then(|| f64::sqrt(squares / length))
    };
    let overlapping = if high > low { pairs(false) } else { None };
    overlapping.or_else(|| pairs(true)).unwrap_or(0.0)
}

/// T_n(u) on \[-1, 1\].
fn chebyshev(n: usize, u: f64) -> f64 {
    let (mut before, mut now) = (1.0, u);
    for _ in 1..n {
        (before, now) = (now, 2.0 * u * now - before);
    }
    if n == 0 { 1.0 } else { now }
}

/// Removes the part along a unit vector.
pub(super) fn remove(vector: &mut [f64], unit: &[f64]) {
    let along = dot(vector, unit);
    vector.iter_mut().zip(unit).for_each(|(value, unit)| *value -= along * unit);
}
