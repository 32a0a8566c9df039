//! The bounds of the pressure, 0 <= p <= H: what is projected, what is free, and what a residual may move.

use asperity_sweep::simd::F64x8;

use asperity_sweep::{Cells, Fields};

/// Cut-off H of the pressure \[Pa\].
///
/// ```
/// use asperity::contact::Hardness;
/// let (soft, mixed) = (Hardness::from(2e6), Hardness::Cells(&[1e6, 3e6]));
/// assert_eq!((soft.at(1), mixed.at(1)), (2e6, 3e6));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hardness<'a> {
    /// The same in every cell; infinite for none.
    Uniform(f64),
    /// That of each cell, nx ny of them, all finite.
    Cells(&'a [f64]),
}

impl From<f64> for Hardness<'_> {
    fn from(hardness: f64) -> Self {
        Hardness::Uniform(hardness)
    }
}

impl Hardness<'_> {
    /// H of a cell.
    #[inline(always)]
    pub fn at(&self, cell: usize) -> f64 {
        match self {
            Hardness::Uniform(hardness) => *hardness,
            Hardness::Cells(cells) => cells[cell],
        }
    }

    /// True where the pressure has no upper bound.
    pub fn is_infinite(&self) -> bool {
        *self == Hardness::Uniform(f64::INFINITY)
    }

    /// H of eight cells, from `cell` on.
    #[inline(always)]
    pub(crate) fn load<V: F64x8>(&self, cell: usize) -> V {
        match self {
            Hardness::Uniform(hardness) => V::splat(*hardness),
            Hardness::Cells(cells) => V::load(cells, cell, f64::INFINITY),
        }
    }

    /// The bounds of eight cells.
    #[inline(always)]
    pub(crate) fn interval<V: F64x8>(&self, cell: usize) -> Interval<V> {
        Interval { top: self.load(cell) }
    }
}

impl Cells for Hardness<'_> {
    fn cells(&self) -> usize {
        match self {
            Hardness::Uniform(_) => 0,
            Hardness::Cells(cells) => cells.len(),
        }
    }

    fn split(self, mid: usize) -> (Self, Self) {
        match self {
            Hardness::Uniform(_) => (self, self),
            Hardness::Cells(cells) => {
                let (first, second) = cells.split_at(mid);
                (Hardness::Cells(first), Hardness::Cells(second))
            }
        }
    }
}

impl Fields for Hardness<'_> {
    type Cell = f64;
    #[inline(always)]
    fn at(&self, cell: usize) -> f64 {
        Hardness::at(self, cell)
    }
}

/// y projected onto \[0, H\].
#[inline(always)]
pub(super) fn clip(y: f64, hardness: f64) -> f64 {
    let y = if y > 0.0 { y } else { 0.0 };
    if y < hardness { y } else { hardness }
}

/// \[0, H\] of eight cells.
#[derive(Clone, Copy)]
pub(crate) struct Interval<V> {
    pub top: V,
}

impl<V: F64x8> Interval<V> {
    /// The nearest feasible pressure.
    #[inline(always)]
    pub fn project(self, y: V) -> V {
        y.clip(self.top)
    }

    /// 0 < p < H.
    #[inline(always)]
    pub fn is_free(self, p: V) -> V::Mask {
        V::splat(0.0).less(p) & p.less(self.top)
    }

    /// p < 0 or p > H.
    #[inline(always)]
    pub fn is_outside(self, p: V) -> V::Mask {
        p.less(V::splat(0.0)) | self.top.less(p)
    }

    /// The working set S: every cell but those at a bound that the residual r presses against it.
    #[inline(always)]
    pub fn is_working(self, p: V, r: V) -> V::Mask {
        let zero = V::splat(0.0);
        self.is_free(p)
            | self.is_outside(p)
            | (p.at_most(zero) & r.less(zero))
            | (self.top.at_most(p) & zero.less(r))
    }

    /// The largest t for which p + t s is feasible; infinite where s is zero.
    #[inline(always)]
    pub fn reach(self, p: V, s: V) -> V {
        let zero = V::splat(0.0);
        let room = V::select(s.less(zero), p, self.top - p);
        let moves = s.less(zero) | zero.less(s);
        V::select(moves, room / s.abs(), V::splat(f64::INFINITY))
    }

    /// `new` = p + t s, put on a bound that it is within rounding error of.
    #[inline(always)]
    pub fn snap(self, p: V, s: V, new: V) -> V {
        let zero = V::splat(0.0);
        let rounding = V::splat(4.0 * f64::EPSILON) * p;
        let new = V::select(s.less(zero) & new.at_most(rounding), zero, new);
        let below = new.less(self.top * V::splat(1.0 - 4.0 * f64::EPSILON));
        V::select(below, new, self.top)
    }
}

#[cfg(test)]
mod tests {
    use asperity_sweep::simd::{Mask, Work, vectorize};

    use super::*;

    /// p and r of eight cells with H = 2, and which cells work.
    struct Working([f64; 8], [f64; 8]);

    impl Work for Working {
        type Yield = u8;
        #[inline(always)]
        fn run<V: F64x8>(self) -> u8 {
            Interval { top: V::splat(2.0) }.is_working(V::from_array(self.0), V::from_array(self.1)).bits()
        }
    }

    #[test]
    fn cells_work_unless_the_residual_presses_them_against_their_bound() {
        let p = [0.0, 0.0, 1.0, 1.0, 2.0, 2.0, -0.1, 2.1];
        let r = [1.0, -1.0, 1.0, 0.0, 1.0, -1.0, 1.0, -1.0];
        assert_eq!(vectorize(Working(p, r)), 0b1101_1110);
    }
}
