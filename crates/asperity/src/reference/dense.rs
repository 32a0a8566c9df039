//! The slow reference for checks: the full influence matrix, with O(N^2) memory and time.
//!
//! It shares no code with the operators that it checks. On a free half-space the displacement of a uniformly loaded
//! rectangle is a sum over its edges,
//!
//! ```text
//! pi K(P) = sum of d ln((R2 + l2)/(R1 + l1))
//! ```
//!
//! with d the distance of P from the line of the edge, positive on the inner side, l1 and l2 the coordinates of the edge's
//! ends along it, seen from P, and R1, R2 their distances from P (Wilton et al., IEEE Trans. Antennas Propag. 32, 1984,
//! eq. 5, for P in the plane). Periodic: (1/N) times the sum over the waves of 2/|q| cos(q.x).

use std::sync::Arc;

use ndarray::{Array2, ArrayView1};

use crate::grid::{Boundary, Grid};
use crate::kernel::HalfSpace;
use crate::operator::{ApproximateInverse, Operator, default_backend};

/// u = K p with the full matrix K.
pub struct Dense {
    grid: Grid,
    boundary: Boundary,
    matrix: Array2<f64>,
}

impl Dense {
    /// The matrix of a small grid.
    pub fn new(grid: Grid, boundary: Boundary) -> Self {
        let [dx, dy] = grid.spacing();
        let [nx, ny] = grid.cells();
        let influence = Array2::from_shape_fn((nx, ny), |(i, j)| match boundary {
            Boundary::Free => rectangle(i as f64 * dx, j as f64 * dy, [dx, dy]),
            Boundary::Periodic => wave_sum(&grid, i, j),
        });
        let matrix = Array2::from_shape_fn((grid.len(), grid.len()), |(m, n)| {
            influence[((m / ny).abs_diff(n / ny), (m % ny).abs_diff(n % ny))]
        });
        Dense { grid, boundary, matrix }
    }

    /// Displacement of a cell under unit pressure on each of all cells.
    pub(crate) fn row(&self, cell: usize) -> ArrayView1<'_, f64> {
        self.matrix.row(cell)
    }
}

/// K(x, y) \[m\] of a rectangle of sides `side` around the origin. Far away the edges cancel, and the relative error of the
/// result is eps (distance/side).
fn rectangle(x: f64, y: f64, [dx, dy]: [f64; 2]) -> f64 {
    let (a, b) = (0.5 * dx, 0.5 * dy);
    let along_x = edge(-a - x, a - x, b - y) + edge(-a - x, a - x, b + y);
    let along_y = edge(-b - y, b - y, a - x) + edge(-b - y, b - y, a + x);
    (along_x + along_y) / std::f64::consts::PI
}

/// d ln((R2 + l2)/(R1 + l1)).
fn edge(l1: f64, l2: f64, d: f64) -> f64 {
    if d == 0.0 {
        return 0.0;
    }
    // An edge in the opposite direction has the same logarithm: take the one with l1 + l2 >= 0.
    let (l1, l2) = if l1 + l2 < 0.0 { (-l2, -l1) } else { (l1, l2) };
    let [r1, r2] = [l1, l2].map(|l: f64| l.hypot(d));
    // 1/(R1 + l1), if this does not cancel.
    let inverse = if l1 < 0.0 { (r1 - l1) / (d * d) } else { 1.0 / (r1 + l1) };
    let less_one = (l2 - l1) * (1.0 + (l1 + l2) / (r1 + r2)) * inverse;
    d * less_one.ln_1p()
}

/// (1/N) sum over the waves of 2/|q| cos(q.x); the mean pressure causes no displacement.
fn wave_sum(grid: &Grid, i: usize, j: usize) -> f64 {
    let [nx, ny] = grid.cells();
    let [lx, ly] = grid.size();
    let tau = std::f64::consts::TAU;
    let signed = |k: usize, n: usize| k.min(n - k) as f64;
    let mut sum = 0.0;
    for kx in 0..nx {
        for ky in 0..ny {
            let waves_per_metre = (signed(kx, nx) / lx).hypot(signed(ky, ny) / ly);
            if waves_per_metre > 0.0 {
                let phase = ((kx * i) % nx) as f64 / nx as f64 + ((ky * j) % ny) as f64 / ny as f64;
                sum += 2.0 / (tau * waves_per_metre) * (tau * phase).cos();
            }
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

    fn apply_in_place(&mut self, x: &mut [f64]) {
        let p = x.to_vec();
        self.apply_into(&p, x);
    }

    fn self_influence(&self) -> f64 {
        self.matrix[(0, 0)]
    }

    fn determines_mean(&self) -> bool {
        self.boundary == Boundary::Free
    }

    fn approximate_inverse(&self) -> ApproximateInverse {
        ApproximateInverse::new(default_backend(), self.grid, self.boundary, Arc::new(HalfSpace))
    }

    fn on_grid(&self, _: Grid) -> Option<Box<dyn Operator>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::half_space;

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
