//! Sweeps that are defined by the operation on one cell.
//!
//! ```
//! use asperity_sweep::{each, sums};
//! let (mut u, p, k) = ([0.0; 3], [1.0, 2.0, 3.0], [2.0; 3]);
//! each(&mut u, (&p[..], &k[..]), |u, (p, k)| *u += p * k);
//! assert_eq!(u, [2.0, 4.0, 6.0]);
//! assert_eq!(sums((&u[..], &p[..]), |(u, p)| [u, u * p]), [12.0, 28.0]);
//! ```

use std::ops::Range;

use crate::cells::{Cells, Set};
use crate::sweep::{strands, sweep};

/// Fields that are read cell by cell: slices, and tuples of them.
pub trait Fields: Cells {
    /// The value of a cell.
    type Cell;
    /// The value of this cell.
    fn at(&self, cell: usize) -> Self::Cell;
}

impl<T: Copy + Sync> Fields for &[T] {
    type Cell = T;
    #[inline(always)]
    fn at(&self, cell: usize) -> T {
        self[cell]
    }
}

impl Fields for Range<usize> {
    type Cell = usize;
    #[inline(always)]
    fn at(&self, cell: usize) -> usize {
        self.start + cell
    }
}

impl Fields for Set<'_> {
    type Cell = bool;
    #[inline(always)]
    fn at(&self, cell: usize) -> bool {
        self.0[cell / 8] >> (cell % 8) & 1 == 1
    }
}

macro_rules! fields_of_tuple {
    ($($name:ident),+) => {
        impl<$($name: Fields),+> Fields for ($($name,)+) {
            type Cell = ($($name::Cell,)+);
            #[inline(always)]
            #[allow(non_snake_case)]
            fn at(&self, cell: usize) -> Self::Cell {
                let ($($name,)+) = self;
                ($($name.at(cell),)+)
            }
        }
    };
}
fields_of_tuple!(A, B);
fields_of_tuple!(A, B, C);
fields_of_tuple!(A, B, C, D);
fields_of_tuple!(A, B, C, D, E);
fields_of_tuple!(A, B, C, D, E, F);

/// Updates each cell of `to` from those of `fields`.
pub fn each<T: Send, F: Fields>(to: &mut [T], fields: F, change: impl Fn(&mut T, F::Cell) + Sync) {
    sweep((to, fields), &|(to, fields): (&mut [T], F)| {
        // The number of cells is that of `to`: known to the compiler, which then checks no bounds.
        let fields = fields.split(to.len()).0;
        to.iter_mut().enumerate().for_each(|(n, to)| change(to, fields.at(n)));
    });
}

/// y += factor x.
pub fn add(y: &mut [f64], factor: f64, x: &[f64]) {
    each(y, x, |y, x| *y += factor * x);
}

/// The same as [`each`], with sums over the cells.
pub fn each_with_sums<F: Fields, const K: usize>(
    to: &mut [f64],
    fields: F,
    change: impl Fn(&mut f64, F::Cell) -> [f64; K] + Sync,
) -> [f64; K] {
    sweep((to, fields), &|(to, fields): (&mut [f64], F)| {
        let n = to.len();
        let fields = fields.split(n).0;
        strands(n, |n| change(&mut to[n], fields.at(n)))
    })
}

/// Sums over the cells of fields.
pub fn sums<F: Fields, const K: usize>(fields: F, of: impl Fn(F::Cell) -> [f64; K] + Sync) -> [f64; K] {
    sweep(fields, &|fields: F| strands(fields.cells(), |n| of(fields.at(n))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_read_to_their_last_cell() {
        for cells in [1_usize, 7, 8, 13, 8192, 8192 + 9] {
            let set = vec![0xff; cells.div_ceil(8)];
            let mut field = vec![0.0; cells];
            each(&mut field, Set(&set), |to, on| *to = f64::from(u8::from(on)));
            assert_eq!(sums(&field[..], |x| [x]), [cells as f64]);
            assert_eq!(
                each_with_sums(&mut field, Set(&set), |_, on| [f64::from(u8::from(on))]),
                [cells as f64]
            );
        }
    }
}
