//! Kernels of a step: the step s to the projected trial point, its curvature, and the state moved along it.
//!
//! s is stored only until K s takes its place. Where both are needed, it is computed again from the direction, with the same bits.

use asperity_sweep::simd::{F64x8, Mask};

use crate::contact::Hardness;
use crate::contact::bounds::Interval;
use crate::contact::step::Step;
use asperity_sweep::{Min, Set, kernel};

impl Step {
    /// s = clip(p - a d + lambda) - p of eight cells, on those of the set.
    #[inline(always)]
    fn of_cells<V: F64x8>(self, p: V, d: V, bounds: Interval<V>, set: u8) -> V {
        let q = self.shift.project(p - V::splat(self.length) * d, bounds);
        (q - p).only(V::Mask::from_bits(set))
    }
}

kernel! {
    /// s on the set, 0 elsewhere; yields <r, s> and <s, s>, and the largest t for which p + t s is feasible.
    pub(in crate::contact) struct FindStep<'a> {
        cells {
            p: &'a [f64], d: &'a [f32], r: &'a [f32], set: Set<'a>, hardness: Hardness<'a>, s: &'a mut [f64],
        }
        numbers { step: Step }
    }
    fn run<V>(self) -> ([f64; 2], Min) {
        let zero = V::splat(0.0);
        let [mut slope, mut square] = [zero; 2];
        let mut reach = V::splat(f64::INFINITY);
        for (n, set) in (0..).step_by(8).zip(self.set.0) {
            if *set == 0 {
                zero.store(self.s, n);
                continue;
            }
            let (p, bounds) = (V::load(self.p, n, 0.0), self.hardness.interval::<V>(n));
            let s = self.step.of_cells(p, V::load(self.d, n, 0.0), bounds, *set);
            s.store(self.s, n);
            slope = slope + V::load(self.r, n, 0.0) * s;
            square = square + s * s;
            reach = bounds.reach(p, s).smaller(reach);
        }
        ([slope, square].map(V::sum), Min(reach.least()))
    }
}

kernel! {
    /// <s, K s> over the set.
    pub(in crate::contact) struct Curvature<'a> {
        cells { p: &'a [f64], d: &'a [f32], image: &'a [f64], set: Set<'a>, hardness: Hardness<'a> }
        numbers { step: Step }
    }
    fn run<V>(self) -> f64 {
        let mut sum = V::splat(0.0);
        for (n, set) in (0..).step_by(8).zip(self.set.0).filter(|(_, set)| **set != 0) {
            let (p, bounds) = (V::load(self.p, n, 0.0), self.hardness.interval::<V>(n));
            let s = self.step.of_cells(p, V::load(self.d, n, 0.0), bounds, *set);
            sum = sum + s * V::load(self.image, n, 0.0);
        }
        sum.sum()
    }
}

kernel! {
    /// p += t s on the set, U += t K s everywhere. A cell that ends within rounding error of a bound is put on it. Yields the
    /// sum of g = c U + h over the cells of the set that are free then, and their number.
    pub(in crate::contact) struct Advance<'a> {
        cells {
            p: &'a mut [f64], u: &'a mut [f64], d: &'a [f32], image: &'a [f64], gap: &'a [f64], set: Set<'a>,
            hardness: Hardness<'a>,
        }
        numbers { step: Step, t: f64, compliance: f64 }
    }
    fn run<V>(self) -> [f64; 2] {
        let (t, c) = (V::splat(self.t), V::splat(self.compliance));
        let (mut sum, mut cells) = (V::splat(0.0), V::splat(0.0));
        for (n, set) in (0..).step_by(8).zip(self.set.0) {
            let u = V::load(self.u, n, 0.0) + t * V::load(self.image, n, 0.0);
            u.store(self.u, n);
            if *set != 0 {
                let (p, bounds) = (V::load(self.p, n, 0.0), self.hardness.interval::<V>(n));
                let s = self.step.of_cells(p, V::load(self.d, n, 0.0), bounds, *set);
                let on = V::Mask::from_bits(*set);
                let new = bounds.snap(p, s, p + t * s);
                V::select(on, new, p).store(self.p, n);
                let free = bounds.is_free(new) & on;
                let g = c * u + V::load(self.gap, n, f64::INFINITY);
                sum = sum + g.only(free);
                cells = cells + V::count(free);
            }
        }
        [sum.sum(), cells.sum()]
    }
}
