//! Sums over the cells at the end of a step, from which its error is estimated (see [`super::estimate`]).

use asperity_sweep::simd::Mask;
use asperity_sweep::{Max, kernel};

use super::estimate::{LATE, ROUNDING};
use crate::contact::Hardness;

kernel! {
    /// See [`Found`], whose fields these sums are in order. A cell presses where a traction acts on it at either end of the step; it counts with
    /// its weight: the size of its tractions where such act on open cells too, else 1.
    pub(super) struct Sums<'a> {
        cells {
            u: &'a [f64], third: &'a [f64], rigid_before: &'a [f64],
            traction: &'a [f64], traction_now: &'a [f64], p: &'a [f64], p_now: &'a [f64],
            unit: &'a [f64], unit_now: &'a [f64], gap: &'a [f64], rigid: &'a [f64], hardness: Hardness<'a>,
        }
        numbers { compliance: f64, approaches: [f64; 2], shifts: [f64; 2], is_weighted: bool, is_line: bool, clock: Clock }
    }
    fn run<V>(self) -> ([f64; 12], (Max, Max)) {
        let mut sums = [V::splat(0.0); 12];
        let [mut peak, mut largest] = [V::splat(0.0); 2];
        let (zero, one, infinite) = (V::splat(0.0), V::splat(1.0), V::splat(f64::INFINITY));
        let [w_before, w] = self.approaches.map(V::splat);
        let [shift_third, shift] = self.shifts.map(V::splat);
        let Clock { step, third, spread, left, in_time, lasts } = self.clock;
        let [step, third, spread, left] = [step, third, spread, left].map(V::splat);
        for n in (0..self.u.len()).step_by(8) {
            let (t, t_now) = (V::load(self.traction, n, 0.0).abs(), V::load(self.traction_now, n, 0.0).abs());
            let rigid = V::load(self.rigid, n, f64::INFINITY);
            let presses = zero.less(t) | zero.less(t_now);
            let seen = presses | rigid.less(w);
            if seen.bits() == 0 {
                continue;
            }
            let (p, p_now) = (V::load(self.p, n, 0.0), V::load(self.p_now, n, 0.0));
            let weight = if self.is_weighted { t + t_now } else { one };
            let (unit, unit_now) = (V::load(self.unit, n, 0.0), V::load(self.unit_now, n, 0.0));
            let u = V::load(self.u, n, 0.0);
            let u_now = V::splat(self.compliance) * unit_now + (V::load(self.gap, n, f64::INFINITY) - rigid);
            let (before, now) = (V::load(self.third, n, 0.0) - u - shift_third, u_now - u - shift);
            let second = ((before / third - now / step) / (third - step)).abs();
            // What rounding errors of u make of it.
            let rounding = V::splat(ROUNDING) * u.abs().larger(u_now.abs()) * spread;
            let curved = (second * step * step).only(rounding.less(second) & seen);
            // A cell that comes into contact had this gap before.
            let late = (V::load(self.rigid_before, n, f64::INFINITY) + u - w_before).larger(zero);
            let comes = zero.less(p_now) & !zero.less(p) & late.less(infinite);
            let late = if lasts { late.only(comes) } else { zero };
            let bends = if in_time { curved.larger(V::splat(LATE) * late) } else { curved };
            // At the hardness the pressure is known.
            let most = self.hardness.load::<V>(n);
            let is_free = zero.less(t_now) & p_now.less(most);
            let own = curved.only((left * spread).less(second) & is_free);
            let cells = [
                weight * bends,
                (weight * bends).only(!comes),
                unit_now.only(presses),
                unit.only(presses),
                u_now.abs().only(presses),
                (weight * own).only(!comes),
                (late.larger(own) * if self.is_line { one } else { weight }).only(comes & is_free),
                weight.only(presses),
                V::count(zero.less(t_now)),
                most.only(is_free),
                V::count(zero.less(t)),
                V::count(zero.less(t) & zero.less(t_now)),
            ];
            sums = std::array::from_fn(|k| sums[k] + cells[k]);
            peak = peak.larger((t_now * late.larger(own)).only(is_free));
            largest = largest.larger(t_now);
        }
        (sums.map(V::sum), (Max(peak.largest()), Max(largest.largest())))
    }
}

/// Sums over cells, of U for unit compliance and of what bends the course of u, |u\[z0, z1, z2\]| Δz² or the gap before.
pub(super) struct Found {
    /// Of what bends it in the cells that press and in those apart that would overlap; the same without cells that come into contact.
    pub(super) bends: f64,
    pub(super) bends_of_old: f64,
    /// U', U and |u'| of the cells that press.
    pub(super) now: f64,
    pub(super) before: f64,
    pub(super) displaced: f64,
    /// Of what bends it in the cells with a traction at the end, below the hardness: in those that do not come into contact, with their
    /// weights, and in those that do.
    pub(super) own_of_old: f64,
    pub(super) own_of_new: f64,
    pub(super) weight: f64,
    /// Cells with a traction at the end, the hardness of those below it, cells with one at the start, and at both ends.
    pub(super) touching: f64,
    pub(super) most: f64,
    pub(super) touched: f64,
    pub(super) stay: f64,
    /// The largest traction, and the largest product of a traction and what bends the course of u in its cell.
    pub(super) largest: f64,
    pub(super) peak: f64,
}

impl From<([f64; 12], (Max, Max))> for Found {
    fn from((sums, (Max(peak), Max(largest))): ([f64; 12], (Max, Max))) -> Self {
        let [bends, bends_of_old, now, before, displaced, own_of_old, own_of_new, weight, ..] = sums;
        let [.., touching, most, touched, stay] = sums;
        Found {
            bends,
            bends_of_old,
            now,
            before,
            displaced,
            own_of_old,
            own_of_new,
            weight,
            touching,
            most,
            touched,
            stay,
            largest,
            peak,
        }
    }
}

/// The step and the third state on one clock, and what the solver leaves in u.
#[derive(Clone, Copy)]
pub(super) struct Clock {
    pub(super) step: f64,
    pub(super) third: f64,
    /// The second difference of errors of size 1.
    pub(super) spread: f64,
    pub(super) left: f64,
    /// Whether u runs linearly in time, and whether the step has a length.
    pub(super) in_time: bool,
    pub(super) lasts: bool,
}
