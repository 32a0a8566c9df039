//! The border of the contact, counted along the edges of cells.
//!
//! A contour of a grid runs along x and y only. One of random direction is longer by the mean of |cos| + |sin|, 4/π
//! (V. A. Yastrebov, G. Anciaux & J.-F. Molinari, Tribol. Int. 114 (2017) 161).

use asperity_sweep::simd::{F64x8, Mask, Work, vectorize};
use ndarray::ArrayView2;
use rayon::prelude::*;

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
    let pressure = pressure.as_standard_layout();
    let (nx, ny) = pressure.dim();
    let cells = pressure.as_slice().unwrap_or_default();
    let row = |i: usize| &cells[i * ny..][..ny];
    (0..nx)
        .into_par_iter()
        .map(|i| {
            let here = row(i);
            // The neighbours of the last row and of the last cell of a row.
            let (below, right) = match boundary {
                Boundary::Periodic => (row((i + 1) % nx), here.first()),
                Boundary::Free => (row((i + 1).min(nx - 1)), here.last()),
            };
            vectorize(Row { here, below, right: right.copied().unwrap_or_default() })
        })
        .reduce(Edges::default, |a, b| Edges {
            along_x: a.along_x + b.along_x,
            along_y: a.along_y + b.along_y,
        })
}

/// The edges of a row's cells with the row `below` and with their neighbours to the right.
struct Row<'a> {
    here: &'a [f64],
    below: &'a [f64],
    /// Right of the last.
    right: f64,
}

impl Work for Row<'_> {
    type Yield = Edges;

    #[inline(always)]
    fn run<V: F64x8>(self) -> Edges {
        let zero = V::splat(0.0);
        let mut edges = Edges::default();
        for n in (0..self.here.len()).step_by(8) {
            // Beyond the end all are alike.
            let here = zero.less(V::load(self.here, n, self.right)).bits();
            let below = zero.less(V::load(self.below, n, self.right)).bits();
            let right = zero.less(V::load(self.here, n + 1, self.right)).bits();
            edges.along_x += (here ^ below).count_ones() as usize;
            edges.along_y += (here ^ right).count_ones() as usize;
        }
        edges
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    #[test]
    fn edges_are_those_that_a_walk_from_cell_to_cell_finds() {
        for (nx, ny) in [(1, 1), (1, 7), (2, 8), (5, 1), (7, 9), (6, 24), (11, 31)] {
            let p = Array2::from_shape_fn((nx, ny), |(i, j)| ((i * i * 7 + j * j * 5 + i * j) % 3) as f64);
            for boundary in [Boundary::Free, Boundary::Periodic] {
                let differs =
                    |a: (usize, usize), b: (usize, usize)| usize::from((p[a] > 0.0) != (p[b] > 0.0));
                let mut walked = Edges::default();
                for i in 0..nx {
                    for j in 0..ny {
                        let (below, right) = ((i + 1) % nx, (j + 1) % ny);
                        if below > i || boundary == Boundary::Periodic {
                            walked.along_x += differs((i, j), (below, j));
                        }
                        if right > j || boundary == Boundary::Periodic {
                            walked.along_y += differs((i, j), (i, right));
                        }
                    }
                }
                assert_eq!(contact_edges(p.view(), boundary), walked, "{nx} {ny} {boundary:?}");
                let turned = p.t();
                let found = contact_edges(turned, boundary);
                assert_eq!((found.along_y, found.along_x), (walked.along_x, walked.along_y));
            }
        }
    }
}
