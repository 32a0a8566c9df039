//! Kernels that make a pressure feasible: within its bounds, zero where nothing can touch, with a given sum.

use asperity_sweep::simd::Mask;

use crate::contact::Hardness;
use asperity_sweep::{Min, SetMut, kernel};

kernel! {
    /// Number of cells that can touch, the sum of H over them, and the least gap.
    pub(in crate::contact) struct Limits<'a> {
        cells { gap: &'a [f64], hardness: Hardness<'a> }
    }
    fn run<V>(self) -> ([f64; 2], Min) {
        let [mut touchable, mut most] = [V::splat(0.0); 2];
        let mut least = V::splat(f64::INFINITY);
        for n in (0..self.gap.len()).step_by(8) {
            let h = V::load(self.gap, n, f64::INFINITY);
            let can_touch = h.less(V::splat(f64::INFINITY));
            touchable = touchable + V::count(can_touch);
            most = most + self.hardness.load::<V>(n).only(can_touch);
            least = h.smaller(least);
        }
        ([touchable, most].map(V::sum), Min(least.least()))
    }
}

kernel! {
    /// p projected onto its bounds, zero where nothing can touch; yields its sum and the number of cells that can touch, which
    /// become the set.
    pub(in crate::contact) struct Clip<'a> {
        cells { p: &'a mut [f64], gap: &'a [f64], touchable: SetMut<'a>, hardness: Hardness<'a> }
    }
    fn run<V>(self) -> [f64; 2] {
        let (mut sum, mut cells) = (V::splat(0.0), V::splat(0.0));
        for (n, set) in (0..).step_by(8).zip(self.touchable.0) {
            let can_touch = V::load(self.gap, n, f64::INFINITY).less(V::splat(f64::INFINITY));
            let p = self.hardness.interval(n).project(V::load(self.p, n, 0.0)).only(can_touch);
            p.store(self.p, n);
            *set = can_touch.bits();
            sum = sum + p;
            cells = cells + V::count(can_touch);
        }
        [sum.sum(), cells.sum()]
    }
}
