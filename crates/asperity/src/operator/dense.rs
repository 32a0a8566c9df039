//! The slow truth: the influence matrix written out. O(N^2) memory and time, for checks.

use std::sync::Arc;

use ndarray::Array2;

use super::{ApproximateInverse, Operator};
use crate::grid::{Boundary, Grid};
use crate::kernel::{HalfSpace, love, wave_kernel};

/// u = K p with the full matrix K.
pub struct Dense {
    grid: Grid,
    boundary: Boundary,
    matrix: Array2<f64>,
}

impl Dense {
    /// The matrix of a small grid, summed coefficient by coefficient.
    pub fn new(grid: Grid, boundary: Boundary) -> Self {
        let [dx, dy] = grid.spacing();
        let ny = grid.cells()[1];
        let matrix = Array2::from_shape_fn((grid.len(), grid.len()), |(m, n)| {
            let i = (m / ny).abs_diff(n / ny);
            let j = (m % ny).abs_diff(n % ny);
            match boundary {
                Boundary::Free => love(i as f64 * dx, j as f64 * dy, [dx, dy]),
                Boundary::Periodic => wave_sum(&grid, i, j),
            }
        });
        Dense { grid, boundary, matrix }
    }
}

/// (1/N) sum over the waves of 2/|q| cos(q.x).
fn wave_sum(grid: &Grid, i: usize, j: usize) -> f64 {
    let [nx, ny] = grid.cells();
    let [lx, ly] = grid.size();
    let tau = std::f64::consts::TAU;
    let signed = |k: usize, n: usize| k.min(n - k) as f64;
    let mut sum = 0.0;
    for kx in 0..nx {
        for ky in 0..ny {
            let phase = tau * (((kx * i) % nx) as f64 / nx as f64 + ((ky * j) % ny) as f64 / ny as f64);
            sum += wave_kernel(tau * signed(kx, nx) / lx, tau * signed(ky, ny) / ly) * phase.cos();
        }
    }
    sum / grid.len() as f64
}

impl Operator for Dense {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn boundary(&self) -> Boundary {
        self.boundary
    }

    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        for (u, row) in u.iter_mut().zip(self.matrix.outer_iter()) {
            *u = row.iter().zip(p).map(|(k, p)| k * p).sum();
        }
    }

    fn self_influence(&self) -> f64 {
        self.matrix[(0, 0)]
    }

    fn determines_mean(&self) -> bool {
        self.boundary == Boundary::Free
    }

    fn approximate_inverse(&self) -> ApproximateInverse {
        ApproximateInverse::new(self.grid, self.boundary, Arc::new(HalfSpace))
    }

    fn on_grid(&self, _: Grid) -> Option<Box<dyn Operator>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::super::half_space;
    use super::*;

    #[test]
    fn the_convolution_equals_the_matrix_on_any_grid() {
        for boundary in [Boundary::Free, Boundary::Periodic] {
            for (cells, size) in [
                ([1, 1], [1.0, 1.0]),
                ([2, 9], [1.0, 3.0]),
                ([7, 5], [1e-3, 4e-3]),
                ([16, 12], [2.0, 1.0]),
                ([11, 13], [1.0, 1.0]),
            ] {
                let grid = Grid::new(cells, size).unwrap();
                let p: Vec<f64> = (0..grid.len()).map(|n| ((n * 29 % 13) as f64) / 13.0).collect();
                let mut fast = vec![0.0; p.len()];
                let mut slow = vec![0.0; p.len()];
                let mut operator = half_space(grid, boundary);
                operator.apply_into(&p, &mut fast);
                Dense::new(grid, boundary).apply_into(&p, &mut slow);
                let scale = slow.iter().fold(size[0] * 1e-3, |m, u| u.abs().max(m));
                for (f, s) in fast.iter().zip(&slow) {
                    // one rounding for each of the ~150 terms
                    assert!((f - s).abs() < 2e-14 * scale, "{boundary:?} {cells:?}: {f} against {s}");
                }
            }
        }
    }
}
