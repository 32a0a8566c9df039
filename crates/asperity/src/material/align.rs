//! How far two curves at neighbouring temperatures lie apart along the logarithm of time, and how well that is known.
//!
//! Both curves, as ln value over ln x, are described by one polynomial; the second curve is moved by d, and on wish raised
//! by v along the ordinate. Several quantities (storage and loss modulus) have polynomials of their own and share d and v:
//!
//! ```text
//! S(d) = min over v and the coefficients of  sum over both curves of (y - P(x))^2,   d = argmin S
//! variance of d = max of s^2 / (S''/2)  and  the mean of (d' - d)^2 with the weights (1 + (S(d') - S)/(n s^2))^(-n/2)
//!                 + (|ln(T2/T1)| / slope)^2  +  gap^2
//! ```
//!
//! The first part of the variance is that of the scatter s: from the curvature of S (the Gauss-Newton value of one unknown)
//! or, where other distances describe the curves about as well, from the likelihood of all of them (Student's distribution of n
//! degrees of freedom). The scatter is what the polynomial leaves, or what parabolas through each curve alone leave: a
//! distance that is chosen among many describes the scatter of a few points by chance. The second one is what a
//! change of the moduli with temperature does where v is not free: the modulus of a rubber grows as T, and a curve that is
//! higher for this reason looks shifted by the change over its slope. The third one is the distance between curves that do
//! not overlap, in which the polynomial is an extrapolation. The degree of the polynomial is that of the least Bayesian
//! information criterion.

use super::shift::minimise;

/// A curve as (ln x, ln value), x increasing.
pub(super) type Logs = Vec<(f64, f64)>;

/// A distance along ln x and its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distance {
    pub value: f64,
    /// Infinite where the curves do not tell it.
    pub deviation: f64,
    /// The distances at which the curves touch with one end or the other; they overlap in between.
    pub touching: [f64; 2],
}

impl Distance {
    /// Length of ln x without data between the curves.
    pub(super) fn gap(&self) -> f64 {
        (self.touching[0] - self.value).max(self.value - self.touching[1]).max(0.0)
    }
}

/// What the second curve does along the ordinate.
#[derive(Clone, Copy)]
pub(super) enum Ordinate {
    /// It stays; the logarithm of its values may be off by this.
    Held(f64),
    /// It is raised by whatever brings it closest to the first.
    Free,
}

/// Highest degree of the polynomial.
const MOST_DEGREE: usize = 14;
/// Relative scatter below which values do not differ: the digits of a file.
const DIGITS: f64 = 1e-5;
/// Farthest gap between the curves that is tried \[ln x\]: two decades.
const FARTHEST_GAP: f64 = 4.6;
/// Places at which S(d) is evaluated first, per unit of ln x.
const PLACES: f64 = 10.0;
/// Likelihood of the ends of the range of distances, over that of the best, above which the curves do not tell it.
const LIKELY_END: f64 = 0.02;

/// How far the second curve of each pair moves along ln x to continue the first one. All pairs have the same abscissae.
pub(super) fn distance(pairs: &[[Logs; 2]], ordinate: Ordinate) -> Distance {
    let Some(range) = Range::of(pairs) else {
        return Distance { value: 0.0, deviation: f64::INFINITY, touching: [0.0; 2] };
    };
    let unknown = Distance { value: 0.0, deviation: f64::INFINITY, touching: range.touching };
    let [low, high] = [range.touching[0] - FARTHEST_GAP, range.touching[1] + FARTHEST_GAP];
    let steps = ((high - low) * PLACES).ceil().clamp(50.0, 2000.0) as usize;
    let count = range.count(pairs);
    let free = matches!(ordinate, Ordinate::Free);
    let mut best: Option<(f64, usize, f64)> = None;
    for degree in 1..=range.highest_degree(free) {
        let squares = |d: f64| match degree <= most_degree(range.overlap(d)) {
            true => Joint::fit(pairs, d, degree, free).squares,
            false => f64::INFINITY,
        };
        let d = minimise(low, high, steps, squares);
        if !squares(d).is_finite() {
            break;
        }
        let information = information(squares(d), count, unknowns(pairs, degree, free) + 1.0);
        if best.is_none_or(|(least, ..)| information < least) {
            best = Some((information, degree, d));
        }
    }
    let Some((_, degree, value)) = best else { return unknown };
    let at = |d: f64| Joint::fit(pairs, d, degree.min(most_degree(range.overlap(d))), free);
    let (step, here) = (0.05, at(value));
    let bend = (at(value + step).squares - 2.0 * here.squares + at(value - step).squares) / (step * step);
    let degrees = (count - unknowns(pairs, degree, free) - 1.0).max(1.0);
    let per_point = variance(here.squares, degrees).max(own_variance(pairs));
    let scatter = per_point / (0.5 * bend).max(f64::MIN_POSITIVE);
    // Other distances that describe the curves about as well.
    let width = (high - low) / steps as f64;
    let likelihood = |d: f64| {
        let worse = (at(d).squares - here.squares).max(0.0) / (degrees * per_point);
        libm::pow(1.0 + worse, -0.5 * degrees)
    };
    let places = (0..=steps).map(|k| low + width * k as f64);
    let (mut weights, mut moments) = (libm::sqrt(std::f64::consts::TAU * scatter).min(high - low), 0.0);
    for d in places {
        let weight = width * likelihood(d);
        weights += weight;
        moments += weight * (d - value) * (d - value);
    }
    if likelihood(low).max(likelihood(high)) > LIKELY_END {
        return Distance { value, ..unknown };
    }
    let change = match ordinate {
        Ordinate::Held(change) => (change / here.slope.max(f64::MIN_POSITIVE)).powi(2),
        Ordinate::Free => 0.0,
    };
    let found = Distance { value, ..unknown };
    let deviation = (scatter.max(moments / weights) + change + found.gap().powi(2)).sqrt();
    Distance { deviation: if deviation.is_finite() { deviation } else { f64::INFINITY }, ..found }
}

/// How far curves are from one polynomial at a distance that others tell, as the root of the mean square of the logarithm.
pub(super) fn apart(pairs: &[[Logs; 2]], d: f64) -> f64 {
    let Some(range) = Range::of(pairs) else { return 0.0 };
    let degree = most_degree(range.overlap(d)).min(range.highest_degree(false)).max(1);
    (Joint::fit(pairs, d, degree, false).squares / range.count(pairs)).sqrt()
}

/// How far the second curve of each pair is raised to continue the first one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Raised {
    pub value: f64,
    /// Standard deviation at this distance; infinite where the curves do not tell it.
    pub deviation: f64,
    /// Change of the value with the distance.
    pub slope: f64,
}

/// How far the second curve of each pair, moved along ln x by a known distance, is raised to continue the first one.
pub(super) fn raised(pairs: &[[Logs; 2]], d: f64) -> Raised {
    let unknown = Raised { value: 0.0, deviation: f64::INFINITY, slope: 0.0 };
    let Some(range) = Range::of(pairs) else { return unknown };
    let count = range.count(pairs);
    let most = most_degree(range.overlap(d)).min(range.highest_degree(true));
    let judged = (1..=most).map(|degree| {
        let squares = Joint::fit(pairs, d, degree, true).squares;
        (degree, squares, information(squares, count, unknowns(pairs, degree, true)))
    });
    let Some((degree, squares, _)) = judged.min_by(|a, b| a.2.total_cmp(&b.2)) else { return unknown };
    let at = |d: f64| Joint::fit(pairs, d, degree, true);
    let (here, step) = (at(d), 0.05);
    let gap = Distance { value: d, deviation: 0.0, touching: range.touching }.gap();
    let scatter = variance(squares, count - unknowns(pairs, degree, true)) / here.told;
    Raised {
        value: here.raised,
        deviation: if here.told > 0.0 { (scatter + (gap * here.slope).powi(2)).sqrt() } else { f64::INFINITY },
        slope: (at(d + step).raised - at(d - step).raised) / (2.0 * step),
    }
}

/// Bayesian information criterion of so many values with this sum of squares.
fn information(squares: f64, count: f64, unknowns: f64) -> f64 {
    count * (squares + count * DIGITS * DIGITS).ln() + unknowns * count.ln()
}

/// Coefficients of all polynomials, and v.
fn unknowns(pairs: &[[Logs; 2]], degree: usize, free: bool) -> f64 {
    (pairs.len() * (degree + 1) + usize::from(free)) as f64
}

/// Mean variance of the values about a parabola through each curve alone; 0 for curves of fewer points.
fn own_variance(pairs: &[[Logs; 2]]) -> f64 {
    let (mut squares, mut degrees) = (0.0, 0);
    for curve in pairs.iter().flatten().filter(|curve| curve.len() > 3) {
        let mut rest: Vec<f64> = curve.iter().map(|point| point.1).collect();
        orthonormal(curve, 2).iter().for_each(|column| remove(&mut rest, column));
        squares += dot(&rest, &rest);
        degrees += curve.len() - 3;
    }
    if degrees > 0 { squares / degrees as f64 } else { 0.0 }
}

/// Variance of a value from a sum of squares, not below the digits of a file.
fn variance(squares: f64, degrees_of_freedom: f64) -> f64 {
    (squares / degrees_of_freedom.max(1.0)).max(DIGITS * DIGITS)
}

/// Where two curves lie.
struct Range {
    touching: [f64; 2],
    /// Ends of the first and of the second curve.
    ends: [[f64; 2]; 2],
    /// Points of both together.
    points: usize,
}

impl Range {
    fn of(pairs: &[[Logs; 2]]) -> Option<Range> {
        let [first, second] = pairs.first()?;
        let ends = [ends(first)?, ends(second)?];
        let [[a0, a1], [b0, b1]] = ends;
        Some(Range { touching: [a0 - b1, a1 - b0], ends, points: first.len() + second.len() })
    }

    /// Length of ln x on which both lie, negative without.
    fn overlap(&self, d: f64) -> f64 {
        let [[a0, a1], [b0, b1]] = self.ends;
        a1.min(b1 + d) - a0.max(b0 + d)
    }

    fn count(&self, pairs: &[[Logs; 2]]) -> f64 {
        (self.points * pairs.len()) as f64
    }

    /// Highest degree for so many points: a polynomial through all of them describes everything.
    fn highest_degree(&self, free: bool) -> usize {
        self.points.saturating_sub(4 + usize::from(free)).min(MOST_DEGREE)
    }
}

/// The polynomials of all quantities, the second curves moved by d and, where that is free, raised by the best v.
struct Joint {
    squares: f64,
    slope: f64,
    /// The best v.
    raised: f64,
    /// Half of the second derivative of the squares with v; 0 where they do not depend on it.
    told: f64,
}

impl Joint {
    fn fit(pairs: &[[Logs; 2]], d: f64, degree: usize, free: bool) -> Joint {
        let mut joint = Joint { squares: 0.0, slope: 0.0, raised: 0.0, told: 0.0 };
        let (mut along, mut points) = (0.0, 0);
        for [first, second] in pairs {
            let fit = Polynomial::fit(first, second, d, degree, free);
            joint.squares += fit.squares;
            joint.slope = joint.slope.max(fit.slope);
            joint.told += fit.told;
            along += fit.along;
            points += first.len() + second.len();
        }
        if !free || joint.told < 1e-9 * points as f64 {
            return Joint { told: 0.0, ..joint };
        }
        let squares = (joint.squares - along * along / joint.told).max(0.0);
        Joint { squares, raised: -along / joint.told, ..joint }
    }
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
    /// What a step between the two curves leaves of itself beside the polynomial, squared, and its product with the distances of
    /// the values.
    told: f64,
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
        // What is left of the values is their distance from the polynomial.
        for column in orthonormal(&points, degree) {
            remove(&mut rest, &column);
            remove(&mut step, &column);
        }
        let fitted: Vec<f64> = values.iter().zip(&rest).map(|(value, rest)| value - rest).collect();
        Polynomial {
            squares: dot(&rest, &rest),
            slope: slope(&points, &fitted, first.len()),
            told: dot(&step, &step),
            along: dot(&step, &rest),
        }
    }
}

/// Polynomials up to a degree at the places of points: Chebyshev polynomials, made orthogonal one after the other (modified
/// Gram-Schmidt).
fn orthonormal(points: &[(f64, f64)], degree: usize) -> Vec<Vec<f64>> {
    let ends = points
        .iter()
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], (x, _)| [low.min(*x), high.max(*x)]);
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
        let found = distance(&[[curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 2.0))]], Ordinate::Held(0.0));
        // The digits of the values, 1e-5, over a slope of 0.2.
        assert!((found.value - 2.0).abs() < 1e-3 && found.deviation < 1e-3, "{found:?}");
        let flat = distance(&[[curve(0.0, 5.0, |_| 1.0), curve(0.0, 5.0, |_| 1.0)]], Ordinate::Held(0.01));
        assert!(flat.deviation > 10.0, "{flat:?}");
    }

    #[test]
    fn a_gap_and_a_change_of_the_modulus_are_uncertain() {
        let bend = |x: f64| -0.1 * x - 0.02 * x * x;
        let apart = distance(&[[curve(0.0, 2.0, bend), curve(0.0, 2.0, |x| bend(x + 4.0))]], Ordinate::Held(0.0));
        // Exact numbers continue each other; the gap of 2 is most of the standard deviation.
        assert!((apart.value - 4.0).abs() < 0.01 && (2.0..2.2).contains(&apart.deviation), "{apart:?}");
        let line = |x: f64| -0.2 * x;
        let changed = distance(&[[curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 1.0))]], Ordinate::Held(0.02));
        assert!(changed.deviation > 0.02, "{changed:?}");
        // On straight lines the distance is still known: the lines have to coincide.
        let lines = distance(&[[curve(0.0, 5.0, line), curve(0.0, 5.0, |x| line(x + 1.0))]], Ordinate::Held(0.02));
        assert!((lines.value - 1.0).abs() < 1e-3 && (lines.deviation - 0.1).abs() < 1e-3, "{lines:?}");
    }

    #[test]
    fn a_curve_that_is_moved_and_raised_is_told_by_its_bend_and_a_power_law_is_not() {
        let bend = |x: f64| -0.1 * x - 0.02 * x * x;
        let pair = [curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 2.0) + 0.3)];
        let found = distance(std::slice::from_ref(&pair), Ordinate::Free);
        // The digits of the values, 1e-5, over the bend of 0.04 and a few units of x.
        assert!((found.value - 2.0).abs() < 2e-3 && found.deviation < 2e-3, "{found:?}");
        let up = raised(&[pair], 2.0);
        // Exact but for the polynomials' rounding; the digits are the deviation.
        assert!((up.value + 0.3).abs() < 1e-9 && up.deviation < 1e-4, "{up:?}");
        // One unit more of distance along a slope of -0.1 - 0.04 x is made up for by raising.
        assert!((0.1..0.4).contains(&up.slope.abs()), "{up:?}");
        // A power law moved along ln x is one that is raised.
        let line = |x: f64| -0.2 * x;
        let lines = [curve(0.0, 5.0, line), curve(0.0, 5.0, |x| line(x + 1.0) + 0.1)];
        let both = distance(&[lines.clone()], Ordinate::Free);
        assert!(both.deviation > 2.3, "a decade: {both:?}");
        // A second quantity with a bend tells the distance of both.
        let tan = [curve(0.0, 5.0, bend), curve(0.0, 5.0, |x| bend(x + 1.0) + 0.1)];
        let both = distance(&[lines, tan], Ordinate::Free);
        assert!((both.value - 1.0).abs() < 1e-2 && both.deviation < 1e-2, "{both:?}");
    }

    #[test]
    fn flat_curves_with_scatter_that_do_not_overlap_are_uncertain_by_more_than_a_decade() {
        // A glass: 1 % per unit of ln x, 0.5 % of scatter, values that do not overlap.
        let mut random = crate::material::series::tests::random(5);
        let mut scatter = move || 0.01 * (random() - 0.5);
        let mut glass = |from: f64| -> Logs {
            (0..8).map(|k| f64::from(k) / 3.0).map(|x| (x, from - 0.01 * x + scatter())).collect()
        };
        let found = distance(&[[glass(0.0), glass(-0.08)]], Ordinate::Held(0.004));
        assert!(found.deviation > 2.3, "{found:?}");
    }
}
