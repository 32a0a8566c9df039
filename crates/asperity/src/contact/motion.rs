//! What moves in an iteration: the step s on its way through its convolution, with its curvature <s, K s>, and the
//! advance p += t s, U += t K s, which rates the new state and finds its working set on the way.
//!
//! The step is written nowhere: what the convolution takes and what meets its image is computed where it is needed, as f64
//! or as f32, in a unit of its own that keeps f32 far from its limits; the advance computes it again, in f64.

use std::sync::atomic::{AtomicU64, Ordering};

use asperity_convolution::eights::{Cell, Eight, Mask, Work, vectorize};
use asperity_convolution::lanes::Sums;

use super::residual::{Gauge, Rating};
use super::scalar::Scalar;
use super::shift::{Mover, Shift, Trial};
use super::{ContactState, Hardness, Problem};
use crate::field::{Set, SetMut, sweep};
use crate::operator::Operator;

/// What a step and its image show. "Inside" are the cells of the set that the full step leaves between the bounds: there
/// the residual will vanish.
#[derive(Clone, Copy)]
pub(super) struct Passage {
    /// <r, s>, in units of r.
    pub slope: f64,
    /// What the step that was convolved is a multiple of \[Pa\], a power of two: the unit of what follows.
    pub unit: f64,
    /// <s, K s>
    pub curvature: f64,
    /// <s, s>
    pub length: f64,
    /// Largest |K s| on the set, which is the largest anywhere.
    pub largest: f64,
    /// sum of r, sum of K s, and number of cells, inside.
    pub inside: [f64; 3],
    /// The largest multiple of s that stays within the bounds.
    pub reach: f64,
}

/// The power of two below x: units that change no digit.
fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let power = f64::from_bits(x.to_bits() & EXPONENT);
    if power.is_normal() { power } else { 1.0 }
}

/// `image` = K s, s = q - p, q the trial point shifted and clipped.
pub(super) fn pass<T: Scalar>(
    operator: &mut dyn Operator,
    trial: &Trial,
    shift: Shift,
    residual: &[f32],
    image: &mut [T],
) -> Passage {
    let unit = power_of_two(trial.length);
    let per = 1.0 / unit;
    // Numbers that are not negative have the order of their bits.
    let [nearest, largest] = [f64::INFINITY, 0.0].map(|x| AtomicU64::new(x.to_bits()));
    let make = |first: usize, s: &mut [T]| {
        let (trial, r) = (trial.part(first, s.len()), &residual[first..][..s.len()]);
        let ([slope, r, cells], reach) = vectorize(LayOut { s, trial, r, shift, per });
        nearest.fetch_min(reach.to_bits(), Ordering::Relaxed);
        [slope, r, cells, 0.0, 0.0]
    };
    let visit = |first: usize, k: &[T]| {
        let trial = trial.part(first, k.len());
        let ([curvature, length, change], most) = vectorize(Curvature { k, trial, shift, per });
        largest.fetch_max(most.to_bits(), Ordering::Relaxed);
        [curvature, length, change, 0.0, 0.0]
    };
    let [[slope, r, cells, ..], [curvature, length, change, ..]]: [Sums; 2] =
        T::apply(operator, &make, image, &visit);
    let [reach, largest] = [nearest, largest].map(|x| f64::from_bits(x.into_inner()));
    Passage { slope, unit, curvature, length, largest, inside: [r, change, cells], reach }
}

/// s in its unit, of some cells; <r, s>, sum of r and number of cells inside, and the reach.
struct LayOut<'a, T> {
    s: &'a mut [T],
    trial: Trial<'a>,
    r: &'a [f32],
    shift: Shift,
    per: f64,
}

impl<T: Cell> Work for LayOut<'_, T> {
    type Yield = ([f64; 3], f64);

    #[inline(always)]
    fn run<V: Eight>(self) -> ([f64; 3], f64) {
        let trial = self.trial;
        let d = trial.direction.unwrap_or_default();
        let mover = Mover::<V>::new(trial.length, self.shift);
        let (zero, per) = (V::splat(0.0), V::splat(self.per));
        let [mut slope, mut sum, mut cells] = [zero; 3];
        let far = V::splat(f64::INFINITY);
        let mut reach = far;
        for (n, set) in (0..).step_by(8).zip(trial.set) {
            if *set == 0 {
                zero.store(self.s, n);
                continue;
            }
            let on = V::Mask::from_bits(*set);
            let p = V::load(trial.pressure, n, 0.0);
            let r = V::load(self.r, n, 0.0);
            let hardness: V = trial.hardness.eight(n);
            let q = mover.target(p, V::load(d, n, 0.0), hardness);
            let s = (q - p).only(on);
            (s * per).store(self.s, n);
            slope = slope + r * s;
            let stays = Mover::inside(q, hardness) & on;
            sum = sum + r.only(stays);
            cells = cells + V::count(stays);
            let room = V::select(s.less(zero), p, hardness - p);
            let moves = s.less(zero) | zero.less(s);
            reach = V::select(moves, room / s.abs(), far).smaller(reach);
        }
        ([slope, sum, cells].map(V::sum), reach.least())
    }
}

/// <s, K s>, <s, s> and the sum of K s inside, of some cells, and their largest |K s|; s as it was convolved and `k` its image.
struct Curvature<'a, T> {
    k: &'a [T],
    trial: Trial<'a>,
    shift: Shift,
    per: f64,
}

impl<T: Cell> Work for Curvature<'_, T> {
    type Yield = ([f64; 3], f64);

    #[inline(always)]
    fn run<V: Eight>(self) -> ([f64; 3], f64) {
        let trial = self.trial;
        let d = trial.direction.unwrap_or_default();
        let mover = Mover::<V>::new(trial.length, self.shift);
        let per = V::splat(self.per);
        let [mut sk, mut ss, mut sum, mut most] = [V::splat(0.0); 4];
        for (n, set) in (0..).step_by(8).zip(trial.set).filter(|(_, set)| **set != 0) {
            let on = V::Mask::from_bits(*set);
            let p = V::load(trial.pressure, n, 0.0);
            let hardness: V = trial.hardness.eight(n);
            let q = mover.target(p, V::load(d, n, 0.0), hardness);
            let s: V = T::widen(T::narrow((q - p).only(on) * per));
            let k = V::load(self.k, n, 0.0);
            sk = sk + s * k;
            ss = ss + s * s;
            most = k.abs().only(on).larger(most);
            sum = sum + k.only(Mover::inside(q, hardness) & on);
        }
        ([sk, ss, sum].map(V::sum), most.largest())
    }
}

/// t s, K s: how far to go along which step.
pub(super) struct Motion<'a, T> {
    pub t: f64,
    /// Unit of `image`.
    pub unit: f64,
    /// a and the shift of the step.
    pub length: f64,
    pub shift: Shift,
    pub direction: &'a [f32],
    pub set: &'a [u8],
    pub image: &'a [T],
}

/// p += t s, U += t K s where there is a `motion`, on the set of its step; then rates the state with the guess `w`, and
/// writes r / `scale` on the working set S, 0 elsewhere, and S over the set of the residual that was there.
///
/// A cell that lands within rounding of a bound is put on it. Without a motion p may lie beyond its bounds: such cells are
/// of the set, for the step to lead them back.
pub(super) fn advance<T: Cell>(
    problem: &Problem,
    state: &mut ContactState,
    motion: Option<Motion<T>>,
    w: f64,
    scale: f64,
    (residual, set): (&mut [f32], &mut [u8]),
) -> Rating {
    let (numbers, moving) =
        motion.map(|m| ((m.t, m.unit, m.length, m.shift), (m.direction, Set(m.set), m.image))).unzip();
    let (t, unit, length, shift) = numbers.unwrap_or_default();
    let compliance = problem.compliance;
    let (p, u) = (&mut state.pressure[..], &mut state.unit_displacement[..]);
    sweep(((p, u, residual, SetMut(set)), problem.gap, moving, problem.hardness), &|(
        (p, u, r, SetMut(set)),
        h,
        moving,
        hardness,
    ): (
        (&mut [f64], &mut [f64], &mut [f32], SetMut),
        &[f64],
        Option<(&[f32], Set, &[T])>,
        Hardness,
    )| {
        let motion = moving.map(|(direction, Set(set), image)| Motion {
            t,
            unit,
            length,
            shift,
            direction,
            set,
            image,
        });
        vectorize(Advance { compliance, motion, w, scale, p, u, r, set, h, hardness })
    })
}

struct Advance<'a, T> {
    compliance: f64,
    motion: Option<Motion<'a, T>>,
    w: f64,
    scale: f64,
    p: &'a mut [f64],
    u: &'a mut [f64],
    r: &'a mut [f32],
    set: &'a mut [u8],
    h: &'a [f64],
    hardness: Hardness<'a>,
}

impl<T: Cell> Advance<'_, T> {
    /// The new p of eight cells.
    #[inline(always)]
    fn moved<V: Eight>(&self, motion: &Motion<T>, mover: &Mover<V>, n: usize, p: V, top: V) -> V {
        let (zero, t) = (V::splat(0.0), V::splat(motion.t));
        let on = V::Mask::from_bits(motion.set[n / 8]);
        let s = (mover.target(p, V::load(motion.direction, n, 0.0), top) - p).only(on);
        let new = p + t * s;
        let floor = V::splat(4.0 * f64::EPSILON) * p;
        let new = V::select(s.less(zero) & new.at_most(floor), zero, new);
        let below = new.less(top * V::splat(1.0 - 4.0 * f64::EPSILON));
        V::select(below, new, top)
    }
}

impl<T: Cell> Work for Advance<'_, T> {
    type Yield = Rating;

    #[inline(always)]
    fn run<V: Eight>(self) -> Rating {
        let mut gauge = Gauge::<V>::new(self.compliance, self.w);
        let per = V::splat(1.0 / self.scale);
        let mover = self.motion.as_ref().map(|m| Mover::<V>::new(m.length, m.shift));
        for n in (0..self.p.len()).step_by(8) {
            let top: V = self.hardness.eight(n);
            let h = V::load(self.h, n, f64::INFINITY);
            let mut u = V::load(self.u, n, 0.0);
            if let Some(motion) = &self.motion {
                u = u + V::splat(motion.t * motion.unit) * V::load(motion.image, n, 0.0);
                u.store(self.u, n);
            }
            let mut p = V::load(self.p, n, 0.0);
            match (&self.motion, &mover) {
                (Some(motion), Some(mover)) if motion.set[n / 8] != 0 => {
                    p = self.moved(motion, mover, n, p, top);
                    p.store(self.p, n);
                }
                // Most other cells are apart.
                (Some(_), _) if gauge.pass(p, u, h) => {
                    if std::mem::replace(&mut self.set[n / 8], 0) != 0 {
                        V::splat(0.0).store(self.r, n);
                    }
                    continue;
                }
                _ => {}
            }
            let (r, works) = gauge.meet(p, u, h, top);
            let of_set = match &self.motion {
                Some(_) => works,
                None => works | p.less(V::splat(0.0)) | top.less(p),
            };
            let works_before = std::mem::replace(&mut self.set[n / 8], of_set.bits());
            if works_before | of_set.bits() != 0 {
                (r * per).only(works).store(self.r, n);
            }
        }
        gauge.rating()
    }
}
