//! Sweeps of an iteration that move: the step s laid out for its convolution, its curvature <s, K s>, and the
//! advance p += t s, U += t K s, which rates the new state and finds its working set on the way.
//!
//! The step is laid out only for the convolution, as f64 or as f32, in a unit of its own that keeps f32 far from its
//! limits: the advance computes it again, in f64.

use asperity_convolution::eights::{Cell, Eight, Mask, Work, vectorize};

use super::Hardness;
use super::fields::{Fields, Scalar, as_stored, undeformed};
use super::residual::{Gauge, Rating};
use super::shift::{Mover, Shift, Trial};
use crate::field::{Min, Set, SetMut, sweep};

/// What laying out a step finds. "Inside" are the cells of the set that the full step leaves between the bounds: there
/// the residual will vanish.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    /// <r, s>, in units of r.
    pub slope: f64,
    /// What the step that was laid out is a multiple of \[Pa\], a power of two.
    pub unit: f64,
    /// sum of r, and number of cells, inside.
    pub inside: [f64; 2],
    /// The largest multiple of s that stays within the bounds.
    pub reach: f64,
}

/// The power of two below x: units that change no digit.
fn power_of_two(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff << 52;
    let power = f64::from_bits(x.to_bits() & EXPONENT);
    if power.is_normal() { power } else { 1.0 }
}

/// s = q - p, q the trial point shifted and clipped, and the cells inside. `laid` is the set of the step that was laid
/// out before: other cells are zero already, and writing costs more than anything else here.
pub(super) fn lay_out<T: Cell, P: Cell>(
    trial: &Trial<P>,
    shift: Shift,
    residual: &[f32],
    step: &mut [T],
    laid: &mut [u8],
    inside: &mut [u8],
) -> Layout {
    let length = trial.length;
    let unit = power_of_two(length);
    let ([slope, sum, cells], Min(reach)) = sweep(
        (
            (step, SetMut(laid), SetMut(inside)),
            trial.pressure,
            trial.direction,
            residual,
            Set(trial.set),
            trial.hardness,
        ),
        &|((s, SetMut(laid), SetMut(inside)), p, d, r, Set(set), hardness): (
            (&mut [T], SetMut, SetMut),
            &[P],
            Option<&[f32]>,
            &[f32],
            Set,
            Hardness,
        )| {
            let d = d.unwrap_or_default();
            vectorize(LayOut { s, laid, inside, p, d, r, set, length, shift, hardness, per: 1.0 / unit })
        },
    );
    Layout { slope, unit, inside: [sum, cells], reach }
}

struct LayOut<'a, T, P> {
    s: &'a mut [T],
    laid: &'a mut [u8],
    inside: &'a mut [u8],
    p: &'a [P],
    d: &'a [f32],
    r: &'a [f32],
    set: &'a [u8],
    length: f64,
    shift: Shift,
    hardness: Hardness<'a>,
    per: f64,
}

impl<T: Cell, P: Cell> Work for LayOut<'_, T, P> {
    type Yield = ([f64; 3], Min);

    #[inline(always)]
    fn run<V: Eight>(self) -> ([f64; 3], Min) {
        let mover = Mover::<V>::new(self.length, self.shift);
        let (zero, per) = (V::splat(0.0), V::splat(self.per));
        let [mut slope, mut sum, mut cells] = [zero; 3];
        let far = V::splat(f64::INFINITY);
        let mut reach = far;
        for (((n, set), laid), inside) in (0..).step_by(8).zip(self.set).zip(self.laid).zip(self.inside) {
            let before = std::mem::replace(laid, *set);
            if *set == 0 {
                if before != 0 {
                    zero.store(self.s, n);
                }
                *inside = 0;
                continue;
            }
            let on = V::Mask::from_bits(*set);
            let p = V::load(self.p, n, 0.0);
            let r = V::load(self.r, n, 0.0);
            let hardness: V = self.hardness.stored::<P, V>(n);
            let q = mover.target(p, V::load(self.d, n, 0.0), hardness);
            let s = (q - p).only(on);
            (s * per).store(self.s, n);
            slope = slope + r * s;
            let stays = Mover::inside(q, hardness) & on;
            *inside = stays.bits();
            sum = sum + r.only(stays);
            cells = cells + V::count(stays);
            let room = V::select(s.less(zero), p, hardness - p);
            let moves = s.less(zero) | zero.less(s);
            reach = V::select(moves, room / s.abs(), far).smaller(reach);
        }
        ([slope, sum, cells].map(V::sum), Min(reach.least()))
    }
}

/// The terms of <s, K s>, <s, s> and the sum of K s inside, of some cells from number `first` on: their `image` K s, and of
/// all cells s in its unit, the set `laid` on which it is not zero, and those inside.
pub(super) fn curvature<T: Cell>(
    first: usize,
    image: &[T],
    step: &[T],
    [laid, inside]: [&[u8]; 2],
) -> [f64; 5] {
    let cells = first..first + image.len();
    let bytes = first / 8..cells.end.div_ceil(8);
    let (s, laid, inside) = (&step[cells], &laid[bytes.clone()], &inside[bytes]);
    let [curvature, length, change] = vectorize(Curvature { s, k: image, laid, inside });
    [curvature, length, change, 0.0, 0.0]
}

struct Curvature<'a, T> {
    s: &'a [T],
    k: &'a [T],
    laid: &'a [u8],
    inside: &'a [u8],
}

impl<T: Cell> Work for Curvature<'_, T> {
    type Yield = [f64; 3];

    #[inline(always)]
    fn run<V: Eight>(self) -> [f64; 3] {
        let [mut sk, mut ss, mut sum] = [V::splat(0.0); 3];
        for ((n, inside), laid) in (0..).step_by(8).zip(self.inside).zip(self.laid) {
            if *laid == 0 {
                continue;
            }
            let s = V::load(self.s, n, 0.0);
            let k = V::load(self.k, n, 0.0);
            sk = sk + s * k;
            ss = ss + s * s;
            sum = sum + k.only(V::Mask::from_bits(*inside));
        }
        [sk, ss, sum].map(V::sum)
    }
}

/// t s, K s: how far to go along which step.
pub(super) struct Motion<'a, T> {
    pub t: f64,
    /// Unit of `image`, in that of the displacement.
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
/// A cell that lands within rounding of a bound is put on it.
pub(super) fn advance<T: Cell, P: Scalar>(
    fields: &mut Fields<P>,
    hardness: Hardness,
    motion: Option<Motion<T>>,
    w: f64,
    scale: f64,
    (residual, set): (&mut [f32], &mut [u8]),
) -> Rating {
    let (numbers, moving) =
        motion.map(|m| ((m.t, m.unit, m.length, m.shift), (m.direction, Set(m.set), m.image))).unzip();
    let (t, unit, length, shift) = numbers.unwrap_or_default();
    let compliance = fields.compliance;
    sweep(
        (
            (&mut *fields.pressure, &mut *fields.displacement, residual, SetMut(set)),
            fields.gap,
            moving,
            hardness,
        ),
        &|((p, u, r, SetMut(set)), h, moving, hardness): (
            (&mut [P], &mut [P], &mut [f32], SetMut),
            Option<&[f64]>,
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
        },
    )
}

struct Advance<'a, T, P> {
    compliance: f64,
    motion: Option<Motion<'a, T>>,
    w: f64,
    scale: f64,
    p: &'a mut [P],
    u: &'a mut [P],
    r: &'a mut [f32],
    set: &'a mut [u8],
    h: Option<&'a [f64]>,
    hardness: Hardness<'a>,
}

impl<T: Cell, P: Scalar> Advance<'_, T, P> {
    /// The new p of eight cells.
    #[inline(always)]
    fn moved<V: Eight>(&self, motion: &Motion<T>, mover: &Mover<V>, n: usize, p: V, top: V) -> V {
        let (zero, t) = (V::splat(0.0), V::splat(motion.t));
        let on = V::Mask::from_bits(motion.set[n / 8]);
        let s = (mover.target(p, V::load(motion.direction, n, 0.0), top) - p).only(on);
        let new = p + t * s;
        let floor = V::splat(4.0 * P::EPSILON) * p;
        let new = V::select(s.less(zero) & new.at_most(floor), zero, new);
        let below = new.less(top * V::splat(1.0 - 4.0 * P::EPSILON));
        as_stored::<P, V>(V::select(below, new, top))
    }
}

impl<T: Cell, P: Scalar> Work for Advance<'_, T, P> {
    type Yield = Rating;

    #[inline(always)]
    fn run<V: Eight>(self) -> Rating {
        let mut gauge = Gauge::<V>::new(self.compliance, self.w);
        let per = V::splat(1.0 / self.scale);
        let mover = self.motion.as_ref().map(|m| Mover::<V>::new(m.length, m.shift));
        for n in (0..self.p.len()).step_by(8) {
            let top = self.hardness.stored::<P, V>(n);
            let h = undeformed::<V>(self.h, n);
            let mut u = V::load(self.u, n, f64::INFINITY);
            if let Some(motion) = &self.motion {
                u = as_stored::<P, V>(u + V::splat(motion.t * motion.unit) * V::load(motion.image, n, 0.0));
                u.store(self.u, n);
            }
            let mut p = V::load(self.p, n, 0.0);
            match (&self.motion, &mover) {
                (Some(motion), Some(mover)) if motion.set[n / 8] != 0 => {
                    p = self.moved(motion, mover, n, p, top);
                    p.store(self.p, n);
                }
                // Most other cells are apart.
                _ if gauge.pass(p, u, h) => {
                    if std::mem::replace(&mut self.set[n / 8], 0) != 0 {
                        V::splat(0.0).store(self.r, n);
                    }
                    continue;
                }
                _ => {}
            }
            let (r, works) = gauge.meet(p, u, h, top, !P::ROUGH);
            let works_before = std::mem::replace(&mut self.set[n / 8], works.bits());
            if works_before | works.bits() != 0 {
                (r * per).only(works).store(self.r, n);
            }
        }
        gauge.rating()
    }
}
