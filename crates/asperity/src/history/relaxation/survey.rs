//! Sums over the cells at the end of a step, from which its error is estimated (see [`super::estimate`]).

use asperity_sweep::kernel;
use asperity_sweep::simd::Mask;

use super::estimate::{LATE, ROUNDING};
use crate::contact::Hardness;

kernel! {
    /// In this order, over the cells in contact at either end of the step: what bends the course of u (here cells apart that would
    /// overlap count too), U', U, |u'|, what bends it in cells below the hardness; the number of cells in contact at the end; the hardness
    /// of those below it; the number of cells in contact at the start, and at both ends.
    pub(super) struct Sums<'a> {
        cells {
            u: &'a [f64], third: &'a [f64], rigid_before: &'a [f64], p: &'a [f64], unit: &'a [f64],
            p_now: &'a [f64], unit_now: &'a [f64], gap: &'a [f64], rigid: &'a [f64], hardness: Hardness<'a>,
        }
        numbers { compliance: f64, approaches: [f64; 2], clock: Clock }
    }
    fn run<V>(self) -> [f64; 9] {
        let mut sums = [V::splat(0.0); 9];
        let (zero, infinite) = (V::splat(0.0), V::splat(f64::INFINITY));
        let [w_before, w] = self.approaches.map(V::splat);
        let Clock { step, third, spread, left, in_time, lasts } = self.clock;
        let [step, third, spread, left] = [step, third, spread, left].map(V::splat);
        for n in (0..self.u.len()).step_by(8) {
            let (p, p_now) = (V::load(self.p, n, 0.0), V::load(self.p_now, n, 0.0));
            let rigid = V::load(self.rigid, n, f64::INFINITY);
            let presses = zero.less(p) | zero.less(p_now);
            let seen = presses | rigid.less(w);
            if seen.bits() == 0 {
                continue;
            }
            let (unit, unit_now) = (V::load(self.unit, n, 0.0), V::load(self.unit_now, n, 0.0));
            let u = V::load(self.u, n, 0.0);
            let u_now = V::splat(self.compliance) * unit_now + (V::load(self.gap, n, f64::INFINITY) - rigid);
            let (before, now) = (V::load(self.third, n, 0.0) - u, u_now - u);
            let second = ((before / third - now / step) / (third - step)).abs();
            // What rounding errors of u make of it.
            let rounding = V::splat(ROUNDING) * u.abs().larger(u_now.abs()) * spread;
            let curved = (second * step * step).only(rounding.less(second) & seen);
            // A cell that comes into contact had this gap before.
            let late = (V::load(self.rigid_before, n, f64::INFINITY) + u - w_before).larger(zero);
            let comes = presses & !zero.less(p) & late.less(infinite);
            let late = if lasts { late.only(comes) } else { zero };
            let bends = if in_time { curved.larger(V::splat(LATE) * late) } else { curved };
            // At the hardness the pressure is known.
            let most = self.hardness.load::<V>(n);
            let is_free = zero.less(p_now) & p_now.less(most);
            let own = late.larger(curved.only((left * spread).less(second)));
            let cells = [
                bends,
                unit_now.only(presses),
                unit.only(presses),
                u_now.abs().only(presses),
                own.only(is_free),
                V::count(zero.less(p_now)),
                most.only(is_free),
                V::count(zero.less(p)),
                V::count(zero.less(p) & zero.less(p_now)),
            ];
            sums = std::array::from_fn(|k| sums[k] + cells[k]);
        }
        sums.map(V::sum)
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
