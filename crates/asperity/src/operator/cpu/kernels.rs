//! Kernels of the approximate inverse on a set, on the rows of its convolutions (see [`super::inverse`]).

use asperity_sweep::simd::{F64x8, Mask, Work};

/// D of an open cell that is adjacent to one of S by a side or a corner.
const ADJACENT: f64 = 0.67;

/// z = x on the groups of cells with one of the set.
pub(super) struct Keep<'a> {
    pub z: &'a mut [f32],
    pub set: &'a [u8],
    pub x: &'a [f32],
}

impl Work for Keep<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: F64x8>(self) {
        for (n, _) in (0..).step_by(8).zip(self.set).filter(|(_, set)| **set != 0) {
            V::load(self.x, n, 0.0).store(self.z, n);
        }
    }
}

/// x becomes D x on the open cells, 0 on the set.
pub(super) struct Weigh<'a> {
    pub x: &'a mut [f32],
    pub set: &'a [u8],
    pub adjacent: &'a [u8],
}

impl Work for Weigh<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: F64x8>(self) {
        for ((n, set), adjacent) in (0..).step_by(8).zip(self.set).zip(self.adjacent) {
            let (adjacent, open) = (V::Mask::from_bits(*adjacent), V::Mask::from_bits(!set));
            let weights = V::select(adjacent, V::splat(ADJACENT), V::splat(1.0)).only(open);
            (V::load(self.x, n, 0.0) * weights).store(self.x, n);
        }
    }
}

/// z += t x on the groups of cells with one of the set.
pub(super) struct Add<'a> {
    pub z: &'a mut [f32],
    pub set: &'a [u8],
    pub x: &'a [f32],
    pub t: f64,
}

impl Work for Add<'_> {
    type Yield = ();

    #[inline(always)]
    fn run<V: F64x8>(self) {
        let t = V::splat(self.t);
        for (n, _) in (0..).step_by(8).zip(self.set).filter(|(_, set)| **set != 0) {
            (V::load(self.z, n, 0.0) + t * V::load(self.x, n, 0.0)).store(self.z, n);
        }
    }
}
