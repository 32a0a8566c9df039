//! The projection onto the bounds that keeps the load: the shift lambda for which clip(p - a d + lambda, 0, H) has a given sum
//! over a set of cells.
//!
//! The sum is a piecewise linear, non-decreasing function of lambda; Newton's method with a bracket finds
//! its root in a few sweeps. Neither the trial point nor the projection is stored for it.

use asperity_sweep::simd::F64x8;

use super::Hardness;
use super::bounds::{Interval, clip};
use super::sweeps::projection::{Bends, ClippedSum};
use asperity_sweep::{Max, Min, Set, run};

/// Relative error at which a sum is met: the cells inside the bounds take the rest, and so few of them cross a bound
/// by it that nothing is left.
const SUM_TOLERANCE: f64 = 1e-13;

/// A shift that misses the sum by more than this share is none: the trial point is so far away that its rounding error hides
/// the sum.
const LARGEST_MISS: f64 = 1e-3;

/// Evaluations of the sum at most; Newton's method needs a handful.
const MOST_EVALUATIONS: usize = 200;

/// A trial point p - a d on a set of cells; the other cells keep their pressure.
#[derive(Clone, Copy)]
pub(super) struct Trial<'a> {
    pub pressure: &'a [f64],
    /// d; zero where there is none.
    pub direction: Option<&'a [f32]>,
    pub set: &'a [u8],
    /// a
    pub length: f64,
    pub hardness: Hardness<'a>,
}

/// What moves a trial point y to its projection: clip(y + lambda), less `rest` inside the bounds.
///
/// A shift that cancels most of y leaves the rounding error of y in the sum: the cells inside take it back.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shift {
    pub lambda: f64,
    pub rest: f64,
}

impl Shift {
    /// The projection of a cell with this hardness.
    pub fn project_cell(self, y: f64, hardness: f64) -> f64 {
        let q = clip(y + self.lambda, hardness);
        if q > 0.0 && q < hardness { clip(q - self.rest, hardness) } else { q }
    }

    /// The projection of eight cells.
    #[inline(always)]
    pub fn project<V: F64x8>(self, y: V, bounds: Interval<V>) -> V {
        let q = bounds.project(y + V::splat(self.lambda));
        V::select(bounds.is_free(q), bounds.project(q - V::splat(self.rest)), q)
    }
}

/// The sum of the projected cells, and how many are strictly inside the bounds.
#[derive(Clone, Copy)]
pub(super) struct Sum {
    pub sum: f64,
    pub inside: f64,
}

impl Trial<'_> {
    /// The sum of clip(y + lambda) over the set.
    pub(super) fn clipped_sum(&self, lambda: f64) -> Sum {
        let Trial { pressure: p, direction: d, set, length, hardness } = *self;
        let [sum, inside] = run(ClippedSum { p, d, set: Set(set), hardness, length, lambda });
        Sum { sum, inside }
    }

    /// The shift after which the cells of the set have the sum `target`, or `None` where no shift does it (be it for rounding).
    /// `unshifted` is [`clipped_sum`](Self::clipped_sum)(0).
    pub(super) fn shift_to_sum(&self, target: f64, unshifted: Sum) -> Option<Shift> {
        if target <= 0.0 {
            return None;
        }
        let mut bracket = [f64::NEG_INFINITY, f64::INFINITY];
        let mut best = (0.0, f64::INFINITY, 0.0);
        let (mut lambda, mut found) = (0.0, unshifted);
        for _ in 0..MOST_EVALUATIONS {
            let excess = found.sum - target;
            if excess.abs() < f64::abs(best.1) {
                best = (lambda, excess, found.inside);
            }
            if excess.abs() <= SUM_TOLERANCE * target {
                break;
            }
            bracket[usize::from(excess > 0.0)] = lambda;
            let newton = lambda - excess / found.inside;
            let next = if found.inside > 0.0 && newton > bracket[0] && newton < bracket[1] {
                newton
            } else if bracket[0].is_finite() && bracket[1].is_finite() {
                0.5 * (bracket[0] + bracket[1])
            } else if found.inside > 0.0 {
                break; // Newton's step moves by less than rounding
            } else {
                // A flat piece: go to where the nearest cell starts to move.
                self.nearest_bend(lambda, excess < 0.0)?
            };
            if next == lambda {
                break;
            }
            lambda = next;
            found = self.clipped_sum(lambda);
        }
        let (lambda, excess, inside) = best;
        if excess.abs() > LARGEST_MISS * target {
            return None;
        }
        Some(Shift { lambda, rest: if inside > 0.0 { excess / inside } else { 0.0 } })
    }

    /// A shift beyond the nearest bend of the sum above (or below) `lambda`, where some cell moves.
    fn nearest_bend(&self, lambda: f64, above: bool) -> Option<f64> {
        let Trial { pressure: p, direction: d, set, length, hardness } = *self;
        let (Min(up), Max(down), Max(capped)) = run(Bends { p, d, set: Set(set), hardness, length, lambda });
        let bend = if above { up } else { down };
        // Past the bend by a little of the shift, and by what the pressure there resolves, so that the slope is not zero.
        let least = if above { f64::MIN_POSITIVE } else { 4.0 * f64::EPSILON * capped };
        let past = (1e-3 * bend.abs()).max(least);
        bend.is_finite().then_some(if above { bend + past } else { bend - past })
    }
}

#[cfg(test)]
mod tests {
    use super::super::bounds::clip;
    use super::*;

    fn shift(y: &[f64], set: u8, hardness: f64, target: f64) -> Option<Shift> {
        let trial =
            Trial { pressure: y, direction: None, set: &[set], length: 0.0, hardness: hardness.into() };
        trial.shift_to_sum(target, trial.clipped_sum(0.0))
    }

    fn check(y: &[f64], set: u8, hardness: f64, target: f64) {
        let shift = shift(y, set, hardness, target).unwrap();
        let cells = y.iter().enumerate().filter(|(i, _)| set >> i & 1 == 1);
        let q = |y: f64| {
            let moved = clip(y + shift.lambda, hardness);
            if moved > 0.0 && moved < hardness { clip(moved - shift.rest, hardness) } else { moved }
        };
        let sum: f64 = cells.map(|(_, y)| q(*y)).sum();
        assert!((sum / target - 1.0).abs() < 1e-14, "{y:?} {target}: {sum}");
    }

    #[test]
    fn the_load_is_kept_whatever_is_clipped() {
        check(&[1.0, 2.0, -3.0, 0.5], 0b0111, f64::INFINITY, 4.0);
        check(&[1.0, 2.0, -3.0, 0.5], 0b1111, 1.5, 5.9);
        check(&[-5.0, -7.0], 0b11, f64::INFINITY, 1.0);
        check(&[9.0, 8.0, 7.0], 0b111, 2.0, 1.0);
        check(&[1e-300, 1.0], 0b11, f64::INFINITY, 1e-9);
        check(&[0.15, 0.15, 0.15, 0.0], 0b1111, 0.15, 0.4);
    }

    #[test]
    fn a_sum_that_rounding_hides_is_not_met() {
        // Next to 1e9 there is nothing below 1e-7.
        assert_eq!(shift(&[-1e9, -1e9 - 1.0], 0b11, f64::INFINITY, 1e-8), None);
        check(&[-1e3, -1e3 - 1.0], 0b11, f64::INFINITY, 1e-8);
    }

    #[test]
    fn no_shift_carries_more_than_the_hardness() {
        assert_eq!(shift(&[1.0, 1.0], 0b01, 1.0, 1.5), None);
        assert_eq!(shift(&[1.0], 0, 1.0, 0.5), None);
    }
}
