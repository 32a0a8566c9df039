//! Kernels of a projected-gradient step in double precision: the trial point, and the step to its projection.

use asperity_sweep::simd::Mask;

use crate::contact::Hardness;
use crate::contact::projection::Shift;
use asperity_sweep::{Set, kernel};

kernel! {
    /// r = c U + h - w and y = p - b r on the set; 0 and p elsewhere.
    pub(in crate::contact) struct GradientTrial<'a> {
        cells {
            y: &'a mut [f64], r: &'a mut [f64], p: &'a [f64], u: &'a [f64], gap: &'a [f64], set: Set<'a>,
        }
        numbers { compliance: f64, w: f64, length: f64 }
    }
    fn run<V>(self) {
        let [compliance, w, length] = [self.compliance, self.w, self.length].map(V::splat);
        for (n, set) in (0..).step_by(8).zip(self.set.0) {
            let r = compliance * V::load(self.u, n, 0.0) + V::load(self.gap, n, 0.0) - w;
            let r = r.only(V::Mask::from_bits(*set));
            r.store(self.r, n);
            (V::load(self.p, n, 0.0) - length * r).store(self.y, n);
        }
    }
}

kernel! {
    /// s = clip(y + lambda) - p on the set, 0 elsewhere, in the place of y; yields <r, s> and <s, s>.
    pub(in crate::contact) struct GradientStep<'a> {
        cells { y: &'a mut [f64], r: &'a [f64], p: &'a [f64], set: Set<'a>, hardness: Hardness<'a> }
        numbers { shift: Shift }
    }
    fn run<V>(self) -> [f64; 2] {
        let [mut slope, mut square] = [V::splat(0.0); 2];
        for (n, set) in (0..).step_by(8).zip(self.set.0) {
            let q = self.shift.project(V::load(self.y, n, 0.0), self.hardness.interval(n));
            let s = (q - V::load(self.p, n, 0.0)).only(V::Mask::from_bits(*set));
            s.store(self.y, n);
            slope = slope + V::load(self.r, n, 0.0) * s;
            square = square + s * s;
        }
        [slope.sum(), square.sum()]
    }
}
