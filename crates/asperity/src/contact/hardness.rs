//! The cut-off H of the pressure: one for all cells, or one for each.

use asperity_convolution::eights::{Eight, Work, vectorize};

use super::Problem;
use crate::field::{Cells, Min, sweep};

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

    /// True where the pressure has no bound.
    pub fn is_infinite(&self) -> bool {
        *self == Hardness::Uniform(f64::INFINITY)
    }

    /// H of eight cells.
    #[inline(always)]
    pub(crate) fn eight<V: Eight>(&self, cell: usize) -> V {
        match self {
            Hardness::Uniform(hardness) => V::splat(*hardness),
            Hardness::Cells(cells) => V::load(cells, cell, f64::INFINITY),
        }
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

impl Problem<'_> {
    /// Where nothing may touch more: least gap, number of cells that can touch, and the sum of H over them.
    pub(super) fn limits(&self) -> (f64, f64, f64) {
        let ([touchable, most], Min(first_touch)) =
            sweep((self.gap, self.hardness), &|(h, hardness): (&[f64], Hardness)| {
                vectorize(Limits { h, hardness })
            });
        let most = match self.hardness {
            Hardness::Uniform(hardness) => hardness * touchable,
            Hardness::Cells(_) => most,
        };
        (first_touch, touchable, most)
    }
}

struct Limits<'a> {
    h: &'a [f64],
    hardness: Hardness<'a>,
}

impl Work for Limits<'_> {
    type Yield = ([f64; 2], Min);

    #[inline(always)]
    fn run<V: Eight>(self) -> ([f64; 2], Min) {
        let [mut touchable, mut most] = [V::splat(0.0); 2];
        let mut least = V::splat(f64::INFINITY);
        for n in (0..self.h.len()).step_by(8) {
            let h = V::load(self.h, n, f64::INFINITY);
            let can_touch = h.less(V::splat(f64::INFINITY));
            touchable = touchable + V::count(can_touch);
            most = most + self.hardness.eight::<V>(n).only(can_touch);
            least = h.smaller(least);
        }
        ([touchable, most].map(V::sum), Min(least.least()))
    }
}
