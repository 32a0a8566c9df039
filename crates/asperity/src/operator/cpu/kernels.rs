//! Kernels of the approximate inverse on a set, on the rows of its convolutions (see [`super::inverse`]).

use asperity_sweep::simd::Mask;
use asperity_sweep::{Set, kernel};

/// D of an open cell that is adjacent to one of S by a side or a corner.
const ADJACENT: f64 = 0.67;

kernel! {
    /// z = x on the groups of cells with one of the set.
    pub(super) struct Keep<'a> {
        cells { z: &'a mut [f32], x: &'a [f32], set: Set<'a> }
    }
    fn run<V>(self) {
        for (n, _) in (0..).step_by(8).zip(self.set.0).filter(|(_, set)| **set != 0) {
            V::load(self.x, n, 0.0).store(self.z, n);
        }
    }
}

kernel! {
    /// x becomes D x on the open cells, 0 on the set.
    pub(super) struct Weigh<'a> {
        cells { x: &'a mut [f32], set: Set<'a>, adjacent: Set<'a> }
    }
    fn run<V>(self) {
        for ((n, set), adjacent) in (0..).step_by(8).zip(self.set.0).zip(self.adjacent.0) {
            let (adjacent, open) = (V::Mask::from_bits(*adjacent), V::Mask::from_bits(!set));
            let weights = V::select(adjacent, V::splat(ADJACENT), V::splat(1.0)).only(open);
            (V::load(self.x, n, 0.0) * weights).store(self.x, n);
        }
    }
}

kernel! {
    /// z += t x on the groups of cells with one of the set.
    pub(super) struct Add<'a> {
        cells { z: &'a mut [f32], x: &'a [f32], set: Set<'a> }
        numbers { t: f64 }
    }
    fn run<V>(self) {
        let t = V::splat(self.t);
        for (n, _) in (0..).step_by(8).zip(self.set.0).filter(|(_, set)| **set != 0) {
            (V::load(self.z, n, 0.0) + t * V::load(self.x, n, 0.0)).store(self.z, n);
        }
    }
}
