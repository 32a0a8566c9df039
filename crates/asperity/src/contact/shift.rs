//! The trial step of an iteration, s = clip(p - a d + lambda, 0, H) - p on a set of cells, and the
//! projection that keeps the load: the lambda that gives clip(p - a d + lambda) its sum.
//!
//! The sum is a piecewise linear, non-decreasing function of lambda; Newton's method with a bracket finds
//! its root in a few sweeps. Neither the trial point nor the step is stored for it.

use asperity_convolution::eights::{Eight, Mask, Work, vectorize};

use super::Hardness;
use crate::field::{Max, Min, Set, sweep};

/// A sum is met when it misses by this share: the cells inside take the rest back, and so few of them cross a bound
/// by it that nothing is left.
const CLOSE: f64 = 1e-13;

/// A shift that misses the sum by more than this share is none: the trial point is so far away that its rounding hides the sum.
const MISSED: f64 = 1e-3;

/// A trial point p - a d of a set of cells; the other cells keep their pressure.
#[derive(Clone, Copy)]
pub(super) struct Trial<'a> {
    pub pressure: &'a [f64],
    /// d; none is zero.
    pub direction: Option<&'a [f32]>,
    pub set: &'a [u8],
    /// a
    pub length: f64,
    pub hardness: Hardness<'a>,
}

/// What moves a trial point: q = clip(y + lambda), less `rest` inside the bounds.
///
/// A shift that cancels most of y leaves the rounding of y in the sum: the cells inside take it back.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Shift {
    pub lambda: f64,
    pub rest: f64,
}

/// The numbers of a step, eight times each.
#[derive(Clone, Copy)]
pub(super) struct Mover<V> {
    length: V,
    lambda: V,
    rest: V,
}

impl<V: Eight> Mover<V> {
    #[inline(always)]
    pub(super) fn new(length: f64, shift: Shift) -> Self {
        Mover { length: V::splat(length), lambda: V::splat(shift.lambda), rest: V::splat(shift.rest) }
    }

    /// 0 < p < H
    #[inline(always)]
    fn inside(p: V, hardness: V) -> V::Mask {
        V::splat(0.0).less(p) & p.less(hardness)
    }

    /// q, where a step of full length leads.
    #[inline(always)]
    pub(super) fn target(&self, p: V, d: V, hardness: V) -> V {
        let moved = (p - self.length * d + self.lambda).clip(hardness);
        V::select(Self::inside(moved, hardness), (moved - self.rest).clip(hardness), moved)
    }
}

/// y clipped to \[0, H\].
#[inline(always)]
pub(super) fn clip(y: f64, hardness: f64) -> f64 {
    let y = if y > 0.0 { y } else { 0.0 };
    if y < hardness { y } else { hardness }
}

/// Sum of clip(y + lambda), and the cells strictly inside: its slope.
#[derive(Clone, Copy)]
pub(super) struct ClippedSum {
    pub sum: f64,
    pub slope: f64,
}

impl Trial<'_> {
    /// The shift after which the cells of the set have the sum `target`; `None` where no shift does it, be it for rounding.
    /// `first` is the sum without a shift, where it is known.
    pub(super) fn shift_to_sum(&self, target: f64, first: Option<ClippedSum>) -> Option<Shift> {
        if target <= 0.0 {
            return None;
        }
        let mut bracket = [f64::NEG_INFINITY, f64::INFINITY];
        let mut best = (0.0, f64::INFINITY, 0.0);
        let mut lambda = 0.0;
        let mut known = first;
        for _ in 0..200 {
            let ClippedSum { sum, slope } = known.take().unwrap_or_else(|| self.clipped_sum(lambda));
            let excess = sum - target;
            if excess.abs() < f64::abs(best.1) {
                best = (lambda, excess, slope);
            }
            if excess.abs() <= CLOSE * target {
                break;
            }
            bracket[usize::from(excess > 0.0)] = lambda;
            let newton = lambda - excess / slope;
            let next = if slope > 0.0 && newton > bracket[0] && newton < bracket[1] {
                newton
            } else if bracket[0].is_finite() && bracket[1].is_finite() {
                0.5 * (bracket[0] + bracket[1])
            } else if slope > 0.0 {
                break; // Newton's step moves by less than rounding
            } else {
                // A flat piece: go to where the nearest cell starts to move.
                self.nearest_bend(lambda, excess < 0.0)?
            };
            if next == lambda {
                break;
            }
            lambda = next;
        }
        let (lambda, excess, inside) = best;
        if excess.abs() > MISSED * target {
            return None;
        }
        Some(Shift { lambda, rest: if inside > 0.0 { excess / inside } else { 0.0 } })
    }

    fn clipped_sum(&self, lambda: f64) -> ClippedSum {
        let length = self.length;
        let [sum, slope] = sweep(
            (self.pressure, self.direction, Set(self.set), self.hardness),
            &|(p, d, Set(set), hardness): (&[f64], Option<&[f32]>, Set, Hardness)| {
                vectorize(Clipped { p, d, set, length, lambda, hardness })
            },
        );
        ClippedSum { sum, slope }
    }

    /// A shift beyond the nearest bend of the sum above (or below) `lambda`, where some cell moves.
    fn nearest_bend(&self, lambda: f64, above: bool) -> Option<f64> {
        let length = self.length;
        let cells = (self.pressure, self.direction, Set(self.set), self.hardness);
        let (up, (down, capped)) =
            sweep(cells, &|(p, d, Set(set), hardness): (&[f64], Option<&[f32]>, Set, Hardness)| {
                let (mut up, mut down, mut capped) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
                for (i, p) in p.iter().enumerate().filter(|(i, _)| set[i / 8] >> (i % 8) & 1 == 1) {
                    let hardness = hardness.at(i);
                    let y = p - d.map_or(0.0, |d| length * f64::from(d[i]));
                    if !y.is_finite() {
                    } else if y + lambda <= 0.0 {
                        up = up.min(-y);
                    } else if y + lambda >= hardness {
                        down = down.max(hardness - y);
                        capped = capped.max(hardness);
                    }
                }
                (Min(up), (Max(down), Max(capped)))
            });
        let bend = if above { up.0 } else { down.0 };
        // Past the bend by a little of the shift, and by what the pressure there can tell, so that the slope is not zero.
        let least = if above { f64::MIN_POSITIVE } else { 4.0 * f64::EPSILON * capped.0 };
        let past = (1e-3 * bend.abs()).max(least);
        bend.is_finite().then_some(if above { bend + past } else { bend - past })
    }
}

struct Clipped<'a> {
    p: &'a [f64],
    d: Option<&'a [f32]>,
    set: &'a [u8],
    length: f64,
    lambda: f64,
    hardness: Hardness<'a>,
}

impl Work for Clipped<'_> {
    type Yield = [f64; 2];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 2] {
        let (mut sum, mut slope) = (V::splat(0.0), V::splat(0.0));
        let (length, lambda) = (V::splat(self.length), V::splat(self.lambda));
        for (n, set) in (0..).step_by(8).zip(self.set).filter(|(_, set)| **set != 0) {
            let on = V::Mask::from_bits(*set);
            let top: V = self.hardness.eight(n);
            let d = self.d.map_or(V::splat(0.0), |d| V::load(d, n, 0.0));
            let moved = V::load(self.p, n, 0.0) - length * d + lambda;
            sum = sum + moved.clip(top).only(on);
            slope = slope + V::count(V::splat(0.0).less(moved) & moved.less(top) & on);
        }
        [sum.sum(), slope.sum()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shift(y: &[f64], set: u8, hardness: f64, target: f64) -> Option<Shift> {
        Trial { pressure: y, direction: None, set: &[set], length: 0.0, hardness: hardness.into() }
            .shift_to_sum(target, None)
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
