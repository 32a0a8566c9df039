//! The free domain: no pressure outside, by influence coefficients and zero-padded convolution (DC-FFT: Liu, Wang & Liu, Wear
//! 243, 2000).

use std::sync::Arc;

use ndarray::Array2;

use super::{ApproximateInverse, Operator};
use crate::convolution::{Convolution, even_spectrum};
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;

/// u(i, j) = sum K(i - i', j - j') p(i', j'), with no pressure outside the domain.
pub struct Free {
    grid: Grid,
    kernel: Arc<dyn Kernel>,
    convolution: Convolution,
    self_influence: f64,
}

impl Free {
    /// Plans the operator; the influence coefficients are computed here.
    pub fn new(grid: Grid, kernel: Arc<dyn Kernel>) -> Self {
        let lengths = padded(&grid);
        let influence = influence(&grid, &*kernel);
        let spectrum = even_spectrum(&influence, lengths);
        debug_assert!(spectrum.iter().all(|s| *s > 0.0), "the kernel is positive definite");
        let convolution = Convolution::new(grid.cells(), lengths, spectrum.view());
        Free { grid, kernel, convolution, self_influence: influence[(0, 0)] }
    }

    /// Bytes that the operator takes on that grid.
    pub(super) fn bytes(grid: &Grid) -> usize {
        Convolution::bytes(grid.cells(), padded(grid))
    }
}

/// Lengths of the transforms.
fn padded(grid: &Grid) -> [usize; 2] {
    grid.cells().map(|n| Convolution::good_length(2 * n - 1))
}

/// K on the quadrant of the padded torus. Beyond the domain the true coefficients go on: no output
/// of the domain reads them, and the kernel stays smooth and its spectrum positive.
fn influence(grid: &Grid, kernel: &dyn Kernel) -> Array2<f64> {
    kernel.influence(grid.spacing(), padded(grid).map(|length| length / 2 + 1))
}

impl Operator for Free {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        self.convolution.apply_into(p, u);
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }

    fn determines_mean(&self) -> bool {
        true
    }

    fn approximate_inverse(&self) -> ApproximateInverse {
        ApproximateInverse::new(self.grid, Boundary::Free, self.kernel.clone())
    }

    fn on_grid(&self, grid: Grid) -> Option<Box<dyn Operator>> {
        Some(Box::new(Free::new(grid, self.kernel.clone())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::HalfSpace;

    #[test]
    fn the_spectrum_is_positive_for_any_shape() {
        for (cells, size) in [
            ([1, 1], [1.0, 1.0]),
            ([3, 50], [1.0, 1.0]),
            ([64, 64], [1.0, 1.0]),
            ([33, 17], [1.0, 4.0]),
            ([65, 129], [3.0, 2.0]),
        ] {
            let grid = Grid::new(cells, size).unwrap();
            let spectrum = even_spectrum(&influence(&grid, &HalfSpace), padded(&grid));
            assert!(spectrum.iter().all(|s| *s > 0.0), "{cells:?} {size:?}");
        }
    }
}
