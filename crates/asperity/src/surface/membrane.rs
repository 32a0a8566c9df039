//! Laplace's equation on the undefined points of a map: for each of them
//!
//! ```text
//! sum over the neighbours n of w_n (z - z_n) = 0,   w = dy/dx along x, dx/dy along y,
//! ```
//!
//! by conjugate gradients (M. R. Hestenes and E. Stiefel, J. Res. NBS 49 (1952) 409), preconditioned with a V-cycle over blocks
//! of 2 x 2, 4 x 4, ... points with a common value (D. Braess, Computing 55 (1995) 379): the number of iterations hardly grows
//! with the size of a hole.

use ndarray::{Array2, ArrayView2};

use crate::error::{NotConverged, Result};
use crate::grid::Grid;
use crate::material::dot;

/// The equations, and their levels from fine to coarse.
pub(super) struct Membrane {
    levels: Vec<Level>,
    /// Weighted sum of the defined neighbours.
    right: Vec<f64>,
}

/// Unknowns that are points or blocks of points.
struct Level {
    cells: Vec<(usize, usize)>,
    /// Up to four neighbours as (unknown, weight); `NONE` has weight 0.
    neighbours: Vec<[(usize, f64); 4]>,
    diagonal: Vec<f64>,
    /// The block on the next level.
    parent: Vec<usize>,
}

const NONE: usize = usize::MAX;
/// No coarser level below this many unknowns.
const COARSEST: usize = 16;
/// Largest deviation of a point from the mean of its neighbours, as a fraction of the range of heights.
const TOLERANCE: f64 = 1e-12;

impl Membrane {
    /// For the points of `heights` that are not finite; at least one point must be finite.
    pub(super) fn new(grid: &Grid, heights: ArrayView2<f64>) -> Self {
        let (nx, ny) = heights.dim();
        let [dx, dy] = grid.spacing();
        let (along_x, along_y) = (dy / dx, dx / dy);
        let mut unknown = Array2::from_elem((nx, ny), NONE);
        let cells: Vec<_> =
            heights.indexed_iter().filter(|(_, z)| !z.is_finite()).map(|(at, _)| at).collect();
        for (k, at) in cells.iter().enumerate() {
            unknown[*at] = k;
        }
        let count = cells.len();
        let mut right = vec![0.0; count];
        let mut finest = Level::new(cells);
        for (k, right) in right.iter_mut().enumerate() {
            let (i, j) = finest.cells[k];
            let around = [
                (i.checked_sub(1), Some(j), along_x),
                (Some(i + 1), Some(j), along_x),
                (Some(i), j.checked_sub(1), along_y),
                (Some(i), Some(j + 1), along_y),
            ];
            for (slot, (i, j, weight)) in around.into_iter().enumerate() {
                let (Some(i), Some(j)) = (i, j) else { continue };
                let Some(z) = heights.get((i, j)) else { continue };
                finest.diagonal[k] += weight;
                if z.is_finite() {
                    *right += weight * z;
                } else {
                    finest.neighbours[k][slot] = (unknown[[i, j]], weight);
                }
            }
        }
        let mut levels = vec![finest];
        let mut shape = (nx, ny);
        while let Some(fine) = levels.last_mut()
            && fine.cells.len() > COARSEST
            && shape != (1, 1)
        {
            shape = (shape.0.div_ceil(2), shape.1.div_ceil(2));
            let coarse = fine.coarsen(shape);
            levels.push(coarse);
        }
        Membrane { levels, right }
    }

    /// The undefined points, in the order of the unknowns.
    pub(super) fn cells(&self) -> &[(usize, usize)] {
        &self.levels[0].cells
    }

    /// Solves for heights of range one, starting from `z`; returns the number of iterations.
    pub(super) fn solve(&self, z: &mut [f64]) -> Result<usize> {
        let (finest, n) = (&self.levels[0], z.len());
        // Tens are enough; exact arithmetic would end after n.
        const MOST: usize = 2000;
        let mut out = vec![0.0; n];
        finest.apply(z, &mut out);
        let mut residual: Vec<f64> = self.right.iter().zip(&out).map(|(b, a)| b - a).collect();
        let missed = |residual: &[f64]| {
            residual.iter().zip(&finest.diagonal).map(|(r, d)| (r / d).abs()).fold(0.0, f64::max)
        };
        let mut scaled = self.cycle(0, &residual);
        let mut direction = scaled.clone();
        let mut product = dot(&residual, &scaled);
        for iteration in 0..MOST {
            if missed(&residual) <= TOLERANCE {
                return Ok(iteration);
            }
            finest.apply(&direction, &mut out);
            let step = product / dot(&direction, &out);
            for k in 0..n {
                z[k] += step * direction[k];
                residual[k] -= step * out[k];
            }
            scaled = self.cycle(0, &residual);
            let next = dot(&residual, &scaled);
            let beta = next / product;
            product = next;
            for k in 0..n {
                direction[k] = scaled[k] + beta * direction[k];
            }
        }
        Err(NotConverged::of("harmonic fill", MOST, missed(&residual), TOLERANCE).into())
    }

    /// One V-cycle from zero: sweep down, correct by blocks, sweep up; symmetric, as conjugate gradients
    /// need it.
    fn cycle(&self, level: usize, right: &[f64]) -> Vec<f64> {
        let this = &self.levels[level];
        let mut z = vec![0.0; right.len()];
        this.sweep(right, &mut z, 0..right.len());
        if level + 1 < self.levels.len() {
            let mut out = vec![0.0; right.len()];
            this.apply(&z, &mut out);
            let mut coarse = vec![0.0; self.levels[level + 1].cells.len()];
            for (k, parent) in this.parent.iter().enumerate() {
                coarse[*parent] += right[k] - out[k];
            }
            let correction = self.cycle(level + 1, &coarse);
            z.iter_mut().zip(&this.parent).for_each(|(z, parent)| *z += correction[*parent]);
        }
        this.sweep(right, &mut z, (0..right.len()).rev());
        z
    }
}

impl Level {
    fn new(cells: Vec<(usize, usize)>) -> Self {
        let n = cells.len();
        Level { cells, neighbours: vec![[(NONE, 0.0); 4]; n], diagonal: vec![0.0; n], parent: vec![] }
    }

    /// The level of blocks of 2 x 2; its equations are the sums of theirs.
    fn coarsen(&mut self, shape: (usize, usize)) -> Level {
        let mut block = Array2::from_elem(shape, NONE);
        let mut cells = vec![];
        self.parent = Vec::with_capacity(self.cells.len());
        for (i, j) in &self.cells {
            let at = (i / 2, j / 2);
            if block[at] == NONE {
                block[at] = cells.len();
                cells.push(at);
            }
            self.parent.push(block[at]);
        }
        let mut coarse = Level::new(cells);
        for (k, parent) in self.parent.iter().enumerate() {
            coarse.diagonal[*parent] += self.diagonal[k];
            for (slot, (n, weight)) in self.neighbours[k].iter().enumerate().filter(|(_, (n, _))| *n != NONE)
            {
                let other = self.parent[*n];
                if other == *parent {
                    // Points with a common value have no effect on each other.
                    coarse.diagonal[*parent] -= weight;
                } else {
                    let neighbour = &mut coarse.neighbours[*parent][slot];
                    *neighbour = (other, neighbour.1 + weight);
                }
            }
        }
        coarse
    }

    fn pulled(&self, k: usize, z: &[f64]) -> f64 {
        self.neighbours[k].iter().filter(|(n, _)| *n != NONE).map(|(n, w)| w * z[*n]).sum()
    }

    fn apply(&self, z: &[f64], out: &mut [f64]) {
        for (k, out) in out.iter_mut().enumerate() {
            *out = self.diagonal[k] * z[k] - self.pulled(k, z);
        }
    }

    /// A Gauss-Seidel sweep in the given order.
    fn sweep(&self, right: &[f64], z: &mut [f64], order: impl Iterator<Item = usize>) {
        for k in order {
            z[k] = (right[k] + self.pulled(k, z)) / self.diagonal[k];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn iterations_hardly_grow_with_the_hole() {
        // A hole as wide as the map except for its rim, whose height is x: the membrane is x.
        for n in [10, 40, 160] {
            let grid = Grid::new([n, n], [1.0, 1.0]).unwrap();
            let edge = |i: usize| i == 0 || i == n - 1;
            let heights = Array2::from_shape_fn((n, n), |(i, j)| {
                if edge(i) || edge(j) { i as f64 / (n - 1) as f64 } else { f64::NAN }
            });
            let membrane = Membrane::new(&grid, heights.view());
            let mut z = vec![0.5; membrane.cells().len()];
            let iterations = membrane.solve(&mut z).unwrap();
            // Without the blocks they grow with the width, to several hundred at the widest.
            assert!(iterations <= 60, "{n}: {iterations}");
            for ((i, _), z) in membrane.cells().iter().zip(&z) {
                // The tolerance times the hole's width squared.
                assert!((z - *i as f64 / (n - 1) as f64).abs() < 1e-12 * (n * n) as f64);
            }
        }
    }
}
