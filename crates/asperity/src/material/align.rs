//! How far two curves at neighbouring temperatures lie apart along the logarithm of time, and how well that is known.
//!
//! Both curves, as ln value over ln x, are described by one polynomial; the second curve is moved by d:
//!
//! ```text
//! S(d) = min over the coefficients of  sum over both curves of (y - P(x))^2,   d = argmin S
//! variance of d = (S/free) / (S''/2)  +  (|ln(T2/T1)| / slope)^2  +  gap^2
//! ```
//!
//! The first part of the variance is that of the scatter, from the curvature of S (the Gauss-Newton value of one
//! unknown). The second one is what a change of the moduli with temperature itself does: the modulus of a rubber grows as
//! T, and a curve that is higher for this reason looks shifted by the change over its slope. The third one is the
//! distance between curves that do not overlap, in which the polynomial is an extrapolation. The degree of the polynomial
//! is that of the least Bayesian information criterion.

use super::shift::minimise;

/// A curve as (ln x, ln value), x increasing.
pub(super) type Logs = Vec<(f64, f64)>;

/// A distance along ln x and its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distance {
    pub value: f64,
    /// Infinite where the curves do not tell it.
    pub deviation: f64,
}

/// Highest degree of the polynomial.
const MOST_DEGREE: usize = 14;
/// Relative scatter below which values do not differ: the digits of a file.
const DIGITS: f64 = 1e-5;
/// Farthest gap between the curves that is tried \[ln x\]: two decades.
const FARTHEST_GAP: f64 = 4.6;
/// Places at which S(d) is evaluated first, per unit of ln x.
const PLACES: f64 = 10.0;

/// How far `second` moves along ln x to continue `first`; `change` is |ln(T2/T1)|.
pub(super) fn distance(first: &Logs, second: &Logs, change: f64) -> Distance {
    let unknown = Distance { value: 0.0, deviation: f64::INFINITY };
    let (Some([a0, a1]), Some([b0, b1])) = (ends(first), ends(second)) else { return unknown };
    let [low, high] = [a0 - b1 - FARTHEST_GAP, a1 - b0 + FARTHEST_GAP];
    let steps = ((high - low) * PLACES).ceil().clamp(50.0, 2000.0) as usize;
    let count = (first.len() + second.len()) as f64;
    let mut best: Option<(f64, usize, f64)> = None;
    for degree in 1..=MOST_DEGREE {
        // One more for d; a polynomial through all points describes everything.
        if degree + 4 > first.len() + second.len() {
            break;
        }
        let squares = |d: f64| match degree <= most_degree(a1.min(b1 + d) - a0.max(b0 + d)) {
            true => Polynomial::fit(first, second, d, degree).squares,
            false => f64::INFINITY,
        };
        let d = minimise(low, high, steps, squares);
        if !squares(d).is_finite() {
            break;
        }
        let floor = count * DIGITS * DIGITS;
        let information = count * (squares(d) + floor).ln() + (degree + 2) as f64 * count.ln();
        if best.is_none_or(|(least, ..)| information < least) {
            best = Some((information, degree, d));
        }
    }
    let Some((_, degree, value)) = best else { return unknown };
    let at = |d: f64| Polynomial::fit(first, second, d, degree);
    let (step, here) = (0.05, at(value));
    let bend = (at(value + step).squares - 2.0 * here.squares + at(value - step).squares) / (step * step);
    let free = (count - (degree + 2) as f64).max(1.0);
    let scatter = (here.squares / free).max(DIGITS * DIGITS) / (0.5 * bend).max(f64::MIN_POSITIVE);
    let modulus = (change / here.slope.max(f64::MIN_POSITIVE)).powi(2);
    let gap = (a0.max(b0 + value) - a1.min(b1 + value)).max(0.0);
    let deviation = (scatter + modulus + gap * gap).sqrt();
    Distance { value, deviation: if deviation.is_finite() { deviation } else { f64::INFINITY } }
}

/// Highest degree of a polynomial through two curves that overlap by this much of ln x: a parabola where they do not, one more
/// for each third of a decade. A polynomial that bends more often would describe two separate curves by itself.
fn most_degree(overlap: f64) -> usize {
    2 + (overlap.max(0.0) / 0.77) as usize
}

fn ends(curve: &Logs) -> Option<[f64; 2]> {
    Some([curve.first()?.0, curve.last()?.0])
}

/// The polynomial of least squares through both curves, the second one moved.
struct Polynomial {
    /// Sum of the squares of its distances.
    squares: f64,
    /// Root of the mean square of its slope where both curves lie, or over all where they do not overlap.
    slope: f64,
}

impl Polynomial {
    fn fit(first: &Logs, second: &Logs, d: f64, degree: usize) -> Polynomial {
        let points: Vec<(f64, f64)> =
            first.iter().copied().chain(second.iter().map(|(x, y)| (x + d, *y))).collect();
        let [low, high] = points
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (x, _)| [low.min(*x), high.max(*x)]);
        let unit = 2.0 / (high - low).max(f64::MIN_POSITIVE);
        let places: Vec<f64> = points.iter().map(|(x, _)| unit * (x - low) - 1.0).collect();
        // Chebyshev polynomials, made orthogonal one after the other (modified Gram-Schmidt); what is left of the values
        // is their distance from the polynomial.
        let mut basis: Vec<Vec<f64>> = Vec::with_capacity(degree + 1);
        let mut rest: Vec<f64> = points.iter().map(|(_, y)| *y).collect();
        let values = rest.clone();
        for n in 0..=degree {
            let mut column: Vec<f64> = places.iter().map(|u| chebyshev(n, *u)).collect();
            for other in &basis {
                remove(&mut column, other);
            }
            let norm = dot(&column, &column).sqrt();
            if norm > 1e-9 * (column.len() as f64).sqrt() {
                column.iter_mut().for_each(|value| *value /= norm);
                remove(&mut rest, &column);
                basis.push(column);
            }
        }
        let fitted: Vec<f64> = values.iter().zip(&rest).map(|(value, rest)| value - rest).collect();
        Polynomial { squares: dot(&rest, &rest), slope: slope(&points, &fitted, first.len()) }
    }
}

/// Root of the mean square of the slope of the fitted values between neighbours of either curve, where the curves overlap.
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

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Takes the part along a unit vector away.
fn remove(vector: &mut [f64], unit: &[f64]) {
    let along = dot(vector, unit);
    vector.iter_mut().zip(unit).for_each(|(value, unit)| *value -= along * unit);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(first: f64, last: f64, y: impl Fn(f64) -> f64) -> Logs {
        (0..=12).map(|k| first + (last - first) * f64::from(k) / 12.0).map(|x| (x, y(x))).collect()
    }

    #[test]
    fn a_moved_curve_is_found_and_a_flat_one_is_not() {
        let bend = |x: f64| -0.1 * x - 0.02 * x * x;
        let found = distance(&curve(0.0, 5.0, bend), &curve(0.0, 5.0, |x| bend(x + 2.0)), 0.0);
        // The digits of the values, 1e-5, over a slope of 0.2.
        assert!((found.value - 2.0).abs() < 1e-3 && found.deviation < 1e-3, "{found:?}");
        let flat = distance(&curve(0.0, 5.0, |_| 1.0), &curve(0.0, 5.0, |_| 1.0), 0.01);
        assert!(flat.deviation > 10.0, "{flat:?}");
    }

    #[test]
    fn a_gap_and_a_change_of_the_modulus_are_uncertain() {
        let bend = |x: f64| -0.1 * x - 0.02 * x * x;
        let apart = distance(&curve(0.0, 2.0, bend), &curve(0.0, 2.0, |x| bend(x + 4.0)), 0.0);
        // Exact numbers continue each other; the gap of 2 is most of the standard deviation.
        assert!((apart.value - 4.0).abs() < 0.01 && (2.0..2.2).contains(&apart.deviation), "{apart:?}");
        let line = |x: f64| -0.2 * x;
        let changed = distance(&curve(0.0, 5.0, bend), &curve(0.0, 5.0, |x| bend(x + 1.0)), 0.02);
        assert!(changed.deviation > 0.02, "{changed:?}");
        // On straight lines the distance is still known: the lines have to coincide.
        let lines = distance(&curve(0.0, 5.0, line), &curve(0.0, 5.0, |x| line(x + 1.0)), 0.02);
        assert!((lines.value - 1.0).abs() < 1e-3 && (lines.deviation - 0.1).abs() < 1e-3, "{lines:?}");
    }
}
