//! The border of the contact, counted along the edges of cells.
//!
//! A contour of a grid runs along x and y only. One of random direction is longer by the mean of |cos| + |sin|, 4/π
//! (V. A. Yastrebov, G. Anciaux & J.-F. Molinari, Tribol. Int. 114 (2017) 161).

use ndarray::parallel::prelude::*;
use ndarray::{ArrayView2, Axis};

use crate::grid::{Boundary, Grid};

/// Edges between a cell in contact and one that is not.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Edges {
    /// Between neighbours along x; each is dy long.
    pub along_x: usize,
    /// Between neighbours along y; each is dx long.
    pub along_y: usize,
}

impl Edges {
    /// All edges.
    pub fn number(self) -> usize {
        self.along_x + self.along_y
    }

    /// Their length \[m\].
    pub fn length(self, grid: &Grid) -> f64 {
        let [dx, dy] = grid.spacing();
        self.along_x as f64 * dy + self.along_y as f64 * dx
    }
}

/// Edges between cells with and without pressure; the border of a free domain is none.
///
/// ```
/// use asperity::{Boundary, Grid, quantities::contact_edges};
/// let grid = Grid::new([3, 2], [3.0, 1.0])?;
/// let p = ndarray::array![[1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
/// let edges = contact_edges(p.view(), Boundary::Free);
/// assert_eq!((edges.along_x, edges.along_y), (2, 1));
/// assert_eq!(edges.length(&grid), 2.0 * 0.5 + 1.0 * 1.0);
/// // Both ends of x and of y meet their opposites; of two cells along y each pair has two edges.
/// assert_eq!(contact_edges(p.view(), Boundary::Periodic).number(), 4 + 2);
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn contact_edges(pressure: ArrayView2<f64>, boundary: Boundary) -> Edges {
    let periodic = boundary == Boundary::Periodic;
    let (nx, ny) = pressure.dim();
    let touches = |i: usize, j: usize| pressure[(i, j)] > 0.0;
    let next = |k: usize, n: usize| if k + 1 < n { Some(k + 1) } else { (periodic && n > 1).then_some(0) };
    pressure
        .axis_iter(Axis(0))
        .into_par_iter()
        .enumerate()
        .map(|(i, row)| {
            let below = next(i, nx);
            let mut edges = Edges::default();
            for (j, p) in row.iter().enumerate() {
                let here = *p > 0.0;
                edges.along_x += usize::from(below.is_some_and(|below| touches(below, j) != here));
                edges.along_y += usize::from(next(j, ny).is_some_and(|right| touches(i, right) != here));
            }
            edges
        })
        .reduce(Edges::default, |a, b| Edges {
            along_x: a.along_x + b.along_x,
            along_y: a.along_y + b.along_y,
        })
}
