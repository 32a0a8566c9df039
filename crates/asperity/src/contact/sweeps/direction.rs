//! Kernels of the search direction, all on the working set: products of the preconditioned residual, the conjugate direction,
//! and the steepest descent over all cells that can touch.

use asperity_sweep::simd::Mask;

use asperity_sweep::{Set, SetMut, kernel};

kernel! {
    /// r becomes (r - mean) / `unit` on the set.
    pub(in crate::contact) struct Centre<'a> {
        cells { r: &'a mut [f32], set: Set<'a> }
        numbers { mean: f64, unit: f64 }
    }
    fn run<V>(self) {
        let (mean, per) = (V::splat(self.mean), V::splat(1.0 / self.unit));
        for (n, set) in (0..).step_by(8).zip(self.set.0).filter(|(_, set)| **set != 0) {
            let r = (V::load(self.r, n, 0.0) - mean) * per;
            r.only(V::Mask::from_bits(*set)).store(self.r, n);
        }
    }
}

kernel! {
    /// Over the set: sum z, <z, r>, <z, r_old>, sum r_old, sum d_old.
    pub(in crate::contact) struct Products<'a> {
        cells { z: &'a [f32], r: &'a [f32], r_old: &'a [f32], d_old: &'a [f32], set: Set<'a> }
    }
    fn run<V>(self) -> [f64; 5] {
        let zero = V::splat(0.0);
        let (mut sum_z, mut zr, mut zr_old, mut sum_r_old, mut sum_d_old) = (zero, zero, zero, zero, zero);
        for (n, set) in (0..).step_by(8).zip(self.set.0).filter(|(_, set)| **set != 0) {
            let on = V::Mask::from_bits(*set);
            let z = V::load(self.z, n, 0.0).only(on);
            let r_old = V::load(self.r_old, n, 0.0).only(on);
            sum_z = sum_z + z;
            zr = zr + z * V::load(self.r, n, 0.0);
            zr_old = zr_old + z * r_old;
            sum_r_old = sum_r_old + r_old;
            sum_d_old = sum_d_old + V::load(self.d_old, n, 0.0).only(on);
        }
        [sum_z, zr, zr_old, sum_r_old, sum_d_old].map(V::sum)
    }
}

kernel! {
    /// d = z + beta d - mean on the set, 0 elsewhere. The direction that was there is zero outside of `set_old`.
    pub(in crate::contact) struct Conjugate<'a> {
        cells { d: &'a mut [f32], z: &'a [f32], set: Set<'a>, set_old: Set<'a> }
        numbers { beta: f64, mean: f64 }
    }
    fn run<V>(self) {
        let (beta, mean) = (V::splat(self.beta), V::splat(self.mean));
        for ((n, set), old) in (0..).step_by(8).zip(self.set.0).zip(self.set_old.0) {
            if *set | *old == 0 {
                continue;
            }
            let d = V::load(self.z, n, 0.0) + beta * V::load(self.d, n, 0.0) - mean;
            d.only(V::Mask::from_bits(*set)).store(self.d, n);
        }
    }
}

kernel! {
    /// d = r = (c U + h - w) / `unit` on all cells that can touch, 0 elsewhere; they become the set.
    pub(in crate::contact) struct Steepest<'a> {
        cells {
            u: &'a [f64], gap: &'a [f64],
            d: &'a mut [f32], r: &'a mut [f32], set: SetMut<'a>,
        }
        numbers { compliance: f64, w: f64, unit: f64 }
    }
    fn run<V>(self) {
        let (c, w, per) = (V::splat(self.compliance), V::splat(self.w), V::splat(1.0 / self.unit));
        for (n, set) in (0..).step_by(8).zip(self.set.0) {
            let g = c * V::load(self.u, n, 0.0) + V::load(self.gap, n, f64::INFINITY);
            let can_touch = g.less(V::splat(f64::INFINITY));
            let r = ((g - w) * per).only(can_touch);
            r.store(self.d, n);
            r.store(self.r, n);
            *set = can_touch.bits();
        }
    }
}
