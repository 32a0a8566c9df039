//! The distance between two curves at neighbouring temperatures along the logarithm of time, and its uncertainty.
//!
//! One polynomial describes both curves, as ln value over ln x. The second curve is moved by d, and optionally raised by v along
//! the ordinate. Several quantities (storage and loss modulus) have separate polynomials with the same d and v:
//!
//! ```text
//! S(d) = min over v and the coefficients of  sum over both curves of (y - P(x))^2,   d = argmin S
//! variance of d = max of s^2 / (S''/2)  and  the mean of (d' - d)^2 with the weights (1 + (S(d') - S)/(n s^2))^(-n/2)
//!                 + (|ln(T2/T1)| / slope)^2  +  gap^2
//! ```
//!
//! The first part of the variance is that of the scatter s. It follows from the curvature of S (the Gauss-Newton value of one
//! unknown) or, if other distances describe the curves about as well, from the likelihood of all of them (Student's distribution
//! of n degrees of freedom). The scatter is the residual of the polynomial, or that of parabolas through each curve separately,
//! because a distance that is chosen among many may fit the scatter of a few points by chance. The second part is the effect of a
//! change of the moduli with temperature: the modulus of a rubber grows as T, and a curve that is higher for this reason appears
//! shifted by the change over its slope. If v is free, it is the effect of one per cent of the loss factor. The third part is the
//! distance between curves that do not overlap, in which the polynomial extrapolates. The degree of the polynomial is that with
//! the smallest Bayesian information criterion.

mod polynomial;

use super::shift::minimise;
use crate::material::dot;
use polynomial::{Joint, orthonormal, remove};

/// A curve as (ln x, ln value), x increasing.
pub(super) type Logs = Vec<(f64, f64)>;

/// A distance along ln x and its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distance {
    pub value: f64,
    /// Infinite if the curves do not determine it.
    pub deviation: f64,
    /// The distances at which the curves touch at one end or the other; between them they overlap.
    pub touching: [f64; 2],
}

impl Distance {
    /// Length of ln x without data between the curves.
    pub(super) fn gap(&self) -> f64 {
        (self.touching[0] - self.value).max(self.value - self.touching[1]).max(0.0)
    }
}

/// The shift of the second curve along the ordinate.
#[derive(Clone, Copy)]
pub(super) enum Ordinate {
    /// None; the logarithm of its values has this uncertainty.
    Held(f64),
    /// It is raised by the value that brings it closest to the first.
    Free,
}

/// Highest degree of the polynomial.
const MOST_DEGREE: usize = 14;
/// Relative scatter below which values count as equal: the digits of a file.
const DIGITS: f64 = 1e-5;
/// Largest gap between the curves that is tried \[ln x\]: two decades.
const FARTHEST_GAP: f64 = 4.6;
/// Relative error of the ratio of two quantities at two temperatures: instruments do not measure a loss factor more accurately.
const INSTRUMENT: f64 = 0.01;
/// Number of distances at which S(d) is evaluated first, per unit of ln x.
const PLACES: f64 = 10.0;
/// Likelihood of the ends of the range of distances, over that of the best, above which the curves do not determine the distance.
const LIKELY_END: f64 = 0.02;

/// The distance along ln x by which the second curve of each pair continues the first one. All pairs have the same abscissae.
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
        Ordinate::Held(change) => change,
        Ordinate::Free => INSTRUMENT,
    };
    let change = (change / here.slope.max(f64::MIN_POSITIVE)).powi(2);
    let found = Distance { value, ..unknown };
    let deviation = (scatter.max(moments / weights) + change + found.gap().powi(2)).sqrt();
    Distance { deviation: if deviation.is_finite() { deviation } else { f64::INFINITY }, ..found }
}

/// Root mean square deviation (in the logarithm) of curves from one polynomial, at a distance that other curves determine.
pub(super) fn apart(pairs: &[[Logs; 2]], d: f64) -> f64 {
    let Some(range) = Range::of(pairs) else { return 0.0 };
    let degree = most_degree(range.overlap(d)).min(range.highest_degree(false)).max(1);
    (Joint::fit(pairs, d, degree, false).squares / range.count(pairs)).sqrt()
}

/// The value by which the second curve of each pair is raised to continue the first one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Raised {
    pub value: f64,
    /// Standard deviation at this distance; infinite if the curves do not determine it.
    pub deviation: f64,
    /// Change of the value with the distance.
    pub slope: f64,
}

/// The value by which the second curve of each pair, moved along ln x by a known distance, is raised to continue the first one.
pub(super) fn raised(pairs: &[[Logs; 2]], d: f64) -> Raised {
    let unknown = Raised { value: 0.0, deviation: f64::INFINITY, slope: 0.0 };
    let Some(range) = Range::of(pairs) else { return unknown };
    let count = range.count(pairs);
    let most = most_degree(range.overlap(d)).min(range.highest_degree(true));
    let information_of = (1..=most).map(|degree| {
        let squares = Joint::fit(pairs, d, degree, true).squares;
        (degree, squares, information(squares, count, unknowns(pairs, degree, true)))
    });
    let Some((degree, squares, _)) = information_of.min_by(|a, b| a.2.total_cmp(&b.2)) else {
        return unknown;
    };
    let at = |d: f64| Joint::fit(pairs, d, degree, true);
    let (here, step) = (at(d), 0.05);
    let gap = Distance { value: d, deviation: 0.0, touching: range.touching }.gap();
    let scatter = variance(squares, count - unknowns(pairs, degree, true)) / here.curvature;
    Raised {
        value: here.raised,
        deviation: if here.curvature > 0.0 {
            (scatter + (gap * here.slope).powi(2)).sqrt()
        } else {
            f64::INFINITY
        },
        slope: (at(d + step).raised - at(d - step).raised) / (2.0 * step),
    }
}

/// Bayesian information criterion of this number of values with this sum of squares.
fn information(squares: f64, count: f64, unknowns: f64) -> f64 {
    count * (squares + count * DIGITS * DIGITS).ln() + unknowns * count.ln()
}

/// Coefficients of all polynomials, and v.
fn unknowns(pairs: &[[Logs; 2]], degree: usize, free: bool) -> f64 {
    (pairs.len() * (degree + 1) + usize::from(free)) as f64
}

/// Mean variance of the values about a parabola through each curve separately; 0 for curves with too few points.
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

/// Variance of a value from a sum of squares, at least that of the digits of a file.
fn variance(squares: f64, degrees_of_freedom: f64) -> f64 {
    (squares / degrees_of_freedom.max(1.0)).max(DIGITS * DIGITS)
}

/// The positions of two curves.
struct Range {
    touching: [f64; 2],
    /// Ends of the first and of the second curve.
    ends: [[f64; 2]; 2],
    /// Total number of points.
    points: usize,
}

impl Range {
    fn of(pairs: &[[Logs; 2]]) -> Option<Range> {
        let [first, second] = pairs.first()?;
        let ends = [ends(first)?, ends(second)?];
        let [[a0, a1], [b0, b1]] = ends;
        Some(Range { touching: [a0 - b1, a1 - b0], ends, points: first.len() + second.len() })
    }

    /// Length of ln x on which both overlap; negative if they do not.
    fn overlap(&self, d: f64) -> f64 {
        let [[a0, a1], [b0, b1]] = self.ends;
        a1.min(b1 + d) - a0.max(b0 + d)
    }

    fn count(&self, pairs: &[[Logs; 2]]) -> f64 {
        (self.points * pairs.len()) as f64
    }

    /// Highest degree for this number of points: a polynomial through all of them would fit any data.
    fn highest_degree(&self, free: bool) -> usize {
        self.points.saturating_sub(4 + usize::from(free)).min(MOST_DEGREE)
    }
}

/// Highest degree of a polynomial through two curves that overlap by this much of ln x: a parabola if they do not, one degree
/// more for each third of a decade. A polynomial of higher degree could describe two separate curves.
fn most_degree(overlap: f64) -> usize {
    2 + (overlap.max(0.0) / 0.77) as usize
}

fn ends(curve: &Logs) -> Option<[f64; 2]> {
    Some([curve.first()?.0, curve.last()?.0])
}

#[cfg(test)]
mod tests;
