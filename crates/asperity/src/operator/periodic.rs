//! The periodic domain: the symbol of the kernel on the waves of the domain (Stanley & Kato, J. Tribol. 119, 1997).

use std::sync::Arc;

use ndarray::Array2;

use super::backend::{Backend, ConvolutionPlan};
use super::{ApproximateInverse, Operator, default_backend, mean, wave_spectrum};
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;

/// u = F^-1 \[ K^(q) F p \]. Where the kernel leaves a uniform displacement undetermined, u has zero mean.
pub struct Periodic {
    grid: Grid,
    backend: Arc<dyn Backend>,
    kernel: Arc<dyn Kernel>,
    convolution: Box<dyn ConvolutionPlan>,
    self_influence: f64,
}

impl Periodic {
    /// Plans the operator.
    pub fn new(backend: Arc<dyn Backend>, grid: Grid, kernel: Arc<dyn Kernel>) -> Self {
        let eigenvalues = Periodic::eigenvalues(&grid, &*kernel);
        Periodic::of_eigenvalues(backend, grid, kernel, &eigenvalues)
    }

    pub(super) fn eigenvalues(grid: &Grid, kernel: &dyn Kernel) -> Array2<f64> {
        let symbol = |qx, qy| kernel.symbol(qx, qy);
        wave_spectrum(grid.cells(), grid.size(), kernel.uniform().unwrap_or(0.0), symbol)
    }

    pub(super) fn of_eigenvalues(
        backend: Arc<dyn Backend>,
        grid: Grid,
        kernel: Arc<dyn Kernel>,
        eigenvalues: &Array2<f64>,
    ) -> Self {
        let cells = grid.cells();
        let convolution = backend.plan(cells, cells, eigenvalues.view());
        let self_influence = mean(cells, eigenvalues.view());
        Periodic { grid, backend, kernel, convolution, self_influence }
    }

    /// Bytes that the operator takes on that grid.
    pub(super) fn bytes(grid: &Grid) -> usize {
        default_backend().bytes(grid.cells(), grid.cells())
    }
}

impl Operator for Periodic {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::Periodic
    }

    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        self.convolution.apply_into(p, u);
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }

    fn determines_mean(&self) -> bool {
        self.kernel.uniform().is_some_and(|uniform| uniform > 0.0)
    }

    fn approximate_inverse(&self) -> ApproximateInverse {
        ApproximateInverse::new(self.backend.clone(), self.grid, Boundary::Periodic, self.kernel.clone())
    }

    fn on_grid(&self, grid: Grid) -> Option<Box<dyn Operator>> {
        Some(Box::new(Periodic::new(self.backend.clone(), grid, self.kernel.clone())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::HalfSpace;

    #[test]
    fn the_self_influence_is_what_the_convolution_says() {
        for cells in [[16, 16], [9, 14], [1, 7], [20, 33]] {
            let grid = Grid::new(cells, [1.0, 2.0]).unwrap();
            let mut operator = Periodic::new(default_backend(), grid, Arc::new(HalfSpace));
            let (mut unit, mut response) = (vec![0.0; cells[0] * cells[1]], vec![0.0; cells[0] * cells[1]]);
            unit[0] = 1.0;
            operator.apply_into(&unit, &mut response);
            // Roundings of a transform, and of a sum of a few hundred terms.
            assert!((operator.self_influence() / response[0] - 1.0).abs() < 1e-13, "{cells:?}");
        }
    }
}
