//! What moves in an iteration: the step s on its way through its convolution, and p += t s, U += t K s.
//!
//! <s, K s> is known from the spectrum before any of K s is there: t follows from it, and each row of the image moves p and U
//! as it comes out of the convolution. Neither step nor image is ever a field in memory. What is convolved is f64 or f32, in a
//! unit of its own that keeps f32 far from its limits; the step is computed again, in f64, where it moves p.

use std::sync::atomic::{AtomicU64, Ordering};

use asperity_convolution::eights::{Cell, Eight, Mask, Work, vectorize};
use asperity_convolution::lanes::{Fields, Journey, Sums};

use super::scalar::Scalar;
use super::shift::{Mover, Shift};
use super::{ContactState, Hardness, Problem};
use crate::field::Cells;
use crate::operator::Operator;

/// Where a step leads: s = clip(p - a d + lambda, 0, H) - p on a set of cells.
#[derive(Clone, Copy)]
pub(super) struct Course<'a> {
    pub direction: &'a [f32],
    pub set: &'a [u8],
    pub hardness: Hardness<'a>,
    /// a
    pub length: f64,
    pub shift: Shift,
    /// Whether the step may be taken further than its end, as far as the bounds.
    pub beyond_end: bool,
}

impl Course<'_> {
    /// The same of some cells, from a multiple of eight on.
    fn part(&self, first: usize, cells: usize) -> Self {
        let range = first..first + cells;
        Course {
            direction: &self.direction[range.clone()],
            set: &self.set[first / 8..range.end.div_ceil(8)],
            hardness: self.hardness.split(first).1,
            ..*self
        }
    }
}

/// What is known of a step before it is taken.
#[derive(Clone, Copy)]
pub(super) struct Passage {
    /// <r, s>, in units of r.
    pub slope: f64,
    /// <s, s>
    pub square: f64,
    /// <s, K s>
    pub curvature: f64,
    /// The largest multiple of s that stays within the bounds, for a course that may go on beyond its end.
    pub reach: f64,
}

/// What is known of it afterwards.
#[derive(Clone, Copy)]
pub(super) struct Landing {
    /// Largest |t K s| on the set, which is the largest anywhere.
    pub change: f64,
    /// The mean gap over the cells that are now between the bounds, where there are any \[m\].
    pub free_gap: Option<f64>,
}

/// The power of two below x: units that change no digit.
fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let power = f64::from_bits(x.to_bits() & EXPONENT);
    if power.is_normal() { power } else { 1.0 }
}

/// Convolves a step, and takes it as far as `settle` says; nowhere where it says nothing. The gap is measured from the approach
/// `w` on.
///
/// A cell that lands within rounding of a bound is put on it.
pub(super) fn travel<T: Scalar>(
    operator: &mut dyn Operator,
    problem: &Problem,
    state: &mut ContactState,
    (course, residual): (Course, &[f32]),
    w: f64,
    settle: &mut dyn FnMut(Passage) -> Option<f64>,
) -> Option<Landing> {
    let unit = power_of_two(course.length);
    let per = 1.0 / unit;
    // Numbers that are not negative have the order of their bits.
    let [nearest, largest] = [f64::INFINITY, 0.0].map(|x| AtomicU64::new(x.to_bits()));
    let make = |first: usize, s: &mut [T], [p, _]: Fields| {
        let (course, r) = (course.part(first, s.len()), &residual[first..][..s.len()]);
        let ([slope, square], reach) = vectorize(LayOut { s, p, course, r, per });
        nearest.fetch_min(reach.to_bits(), Ordering::Relaxed);
        [slope, square, 0.0, 0.0, 0.0]
    };
    let mut settle = |[slope, square, ..]: Sums, energy: f64| {
        let reach = f64::from_bits(nearest.load(Ordering::Relaxed));
        settle(Passage { slope, square, curvature: unit * unit * energy, reach })
    };
    let compliance = problem.compliance;
    let meet = |t: f64, first: usize, k: &[T], [p, u]: Fields| {
        let (course, h) = (course.part(first, k.len()), &problem.gap[first..][..k.len()]);
        let ([gap, cells], most) = vectorize(Land { k, p, u, h, course, t, unit, compliance, w });
        largest.fetch_max(most.to_bits(), Ordering::Relaxed);
        [gap, cells, 0.0, 0.0, 0.0]
    };
    let fields = [&mut state.pressure[..], &mut state.unit_displacement[..]];
    let journey = Journey { make: &make, settle: &mut settle, fields, meet: &meet };
    let [gap, cells, ..] = T::carry(operator, journey)?;
    let change = f64::from_bits(largest.into_inner());
    Some(Landing { change, free_gap: (cells > 0.0).then(|| w + gap / cells) })
}

/// s in its unit, of some cells; <r, s>, <s, s>, and the reach.
struct LayOut<'a, T> {
    s: &'a mut [T],
    p: &'a [f64],
    course: Course<'a>,
    r: &'a [f32],
    per: f64,
}

impl<T: Cell> Work for LayOut<'_, T> {
    type Yield = ([f64; 2], f64);

    #[inline(always)]
    fn run<V: Eight>(self) -> ([f64; 2], f64) {
        let course = self.course;
        let mover = Mover::<V>::new(course.length, course.shift);
        let (zero, per) = (V::splat(0.0), V::splat(self.per));
        let [mut slope, mut square] = [zero; 2];
        let far = V::splat(f64::INFINITY);
        let mut reach = far;
        for (n, set) in (0..).step_by(8).zip(course.set) {
            if *set == 0 {
                zero.store(self.s, n);
                continue;
            }
            let p = V::load(self.p, n, 0.0);
            let hardness: V = course.hardness.eight(n);
            let q = mover.target(p, V::load(course.direction, n, 0.0), hardness);
            let s = (q - p).only(V::Mask::from_bits(*set));
            (s * per).store(self.s, n);
            slope = slope + V::load(self.r, n, 0.0) * s;
            square = square + s * s;
            if course.beyond_end {
                let room = V::select(s.less(zero), p, hardness - p);
                let moves = s.less(zero) | zero.less(s);
                reach = V::select(moves, room / s.abs(), far).smaller(reach);
            }
        }
        ([slope, square].map(V::sum), reach.least())
    }
}

/// p += t s, U += t K s of some cells, `k` the image in its unit; yields the sum of g - w over the cells that are now between
/// the bounds, their number, and the largest |t K s| on the set.
struct Land<'a, T> {
    k: &'a [T],
    p: &'a mut [f64],
    u: &'a mut [f64],
    h: &'a [f64],
    course: Course<'a>,
    t: f64,
    unit: f64,
    compliance: f64,
    w: f64,
}

impl<T: Cell> Work for Land<'_, T> {
    type Yield = ([f64; 2], f64);

    #[inline(always)]
    fn run<V: Eight>(self) -> ([f64; 2], f64) {
        let course = self.course;
        let mover = Mover::<V>::new(course.length, course.shift);
        let (zero, t, along) = (V::splat(0.0), V::splat(self.t), V::splat(self.t * self.unit));
        let (compliance, w) = (V::splat(self.compliance), V::splat(self.w));
        let [mut sum, mut cells, mut most] = [zero; 3];
        for (n, set) in (0..).step_by(8).zip(course.set) {
            let change = along * V::load(self.k, n, 0.0);
            let u = V::load(self.u, n, 0.0) + change;
            u.store(self.u, n);
            if *set == 0 {
                continue;
            }
            let on = V::Mask::from_bits(*set);
            let p = V::load(self.p, n, 0.0);
            let top: V = course.hardness.eight(n);
            let s = (mover.target(p, V::load(course.direction, n, 0.0), top) - p).only(on);
            let new = p + t * s;
            let floor = V::splat(4.0 * f64::EPSILON) * p;
            let new = V::select(s.less(zero) & new.at_most(floor), zero, new);
            let below = new.less(top * V::splat(1.0 - 4.0 * f64::EPSILON));
            V::select(below, new, top).store(self.p, n);
            let free = zero.less(new) & below & on;
            let g = compliance * u + V::load(self.h, n, f64::INFINITY) - w;
            sum = sum + g.only(free);
            cells = cells + V::count(free);
            most = change.abs().only(on).larger(most);
        }
        ([sum, cells].map(V::sum), most.largest())
    }
}
