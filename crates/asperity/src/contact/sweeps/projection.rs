//! Kernels of the projection that keeps the load: the sum of clip(p - a d + lambda) over a set, and where it bends.

use asperity_sweep::simd::Mask;

use crate::contact::Hardness;
use asperity_sweep::{Max, Min, Set, kernel};

kernel! {
    /// Over the cells of a set: the sum of clip(y + lambda), y = p - a d, and the number of cells strictly inside the bounds,
    /// which is its slope in lambda. Without a direction d is zero.
    pub(in crate::contact) struct ClippedSum<'a> {
        cells { p: &'a [f64], d: Option<&'a [f32]>, set: Set<'a>, hardness: Hardness<'a> }
        numbers { length: f64, lambda: f64 }
    }
    fn run<V>(self) -> [f64; 2] {
        let (mut sum, mut inside) = (V::splat(0.0), V::splat(0.0));
        let (length, lambda) = (V::splat(self.length), V::splat(self.lambda));
        for (n, set) in (0..).step_by(8).zip(self.set.0).filter(|(_, set)| **set != 0) {
            let on = V::Mask::from_bits(*set);
            let bounds = self.hardness.interval::<V>(n);
            let d = self.d.map_or(V::splat(0.0), |d| V::load(d, n, 0.0));
            let y = V::load(self.p, n, 0.0) - length * d + lambda;
            sum = sum + bounds.project(y).only(on);
            inside = inside + V::count(bounds.is_free(y) & on);
        }
        [sum.sum(), inside.sum()]
    }
}

kernel! {
    /// The lambda nearest above (yield: least) and below (largest) at which a cell that is on a bound at `lambda` leaves it, and
    /// the largest H of those on the upper bound.
    pub(in crate::contact) struct Bends<'a> {
        cells { p: &'a [f64], d: Option<&'a [f32]>, set: Set<'a>, hardness: Hardness<'a> }
        numbers { length: f64, lambda: f64 }
    }
    fn run<V>(self) -> (Min, Max, Max) {
        let [zero, up, down] = [0.0, f64::INFINITY, f64::NEG_INFINITY].map(V::splat);
        let (mut above, mut below, mut capped) = (up, down, zero);
        let (length, lambda) = (V::splat(self.length), V::splat(self.lambda));
        for (n, set) in (0..).step_by(8).zip(self.set.0).filter(|(_, set)| **set != 0) {
            let on = V::Mask::from_bits(*set);
            let top: V = self.hardness.load(n);
            let d = self.d.map_or(zero, |d| V::load(d, n, 0.0));
            let y = V::load(self.p, n, 0.0) - length * d;
            let finite = y.abs().less(up) & on;
            let empty = (y + lambda).at_most(zero) & finite;
            let full = top.at_most(y + lambda) & !empty & finite;
            above = V::select(empty, zero - y, up).smaller(above);
            below = V::select(full, top - y, down).larger(below);
            capped = top.only(full).larger(capped);
        }
        (Min(above.least()), Max(below.largest()), Max(capped.largest()))
    }
}
