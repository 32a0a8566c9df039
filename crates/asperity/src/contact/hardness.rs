//! The cut-off H of the pressure: one for all cells, or one for each.

use asperity_convolution::eights::Eight;

use super::Problem;
use crate::field::{Cells, minimum, strands, sweep};

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
        let [touchable, most] = sweep((self.gap, self.hardness), &|(h, hardness): (&[f64], Hardness)| {
            strands(h.len(), |i| {
                let can_touch = h[i] < f64::INFINITY;
                [f64::from(u8::from(can_touch)), if can_touch { hardness.at(i) } else { 0.0 }]
            })
        });
        let most = match self.hardness {
            Hardness::Uniform(hardness) => hardness * touchable,
            Hardness::Cells(_) => most,
        };
        (minimum(self.gap), touchable, most)
    }
}
