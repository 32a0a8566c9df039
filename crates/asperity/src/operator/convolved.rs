//! An operator that is a convolution on a torus.

use std::sync::Arc;

use ndarray::Array2;

use super::backend::{Backend, ConvolutionPlan};
use super::{ApproximateInverse, Operator, mean, plan_on};
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;

/// u = F^-1 \[ K^ F p \] on a torus that holds the domain. Where the kernel leaves a uniform displacement undetermined, u has zero mean.
pub(crate) struct Convolved {
    pub(crate) body: Body,
    convolution: Box<dyn ConvolutionPlan>,
    self_influence: f64,
    determines_mean: bool,
}

/// What an operator stands for.
#[derive(Clone)]
pub(crate) struct Body {
    pub(crate) grid: Grid,
    pub(crate) boundary: Boundary,
    pub(crate) backend: Arc<dyn Backend>,
    /// What it is made of; at least what an approximate inverse is made of.
    pub(crate) kernel: Arc<dyn Kernel>,
    /// Whether the same kernel gives the operator of coarser grids.
    pub(crate) has_coarser: bool,
}

impl Convolved {
    /// With these eigenvalues on a torus of `lengths`, those of a quarter of the waves.
    pub(crate) fn new(body: Body, lengths: [usize; 2], eigenvalues: &Array2<f64>) -> Box<Self> {
        let self_influence = mean(lengths, eigenvalues.view());
        let convolution = body.backend.plan(body.grid.cells(), lengths, eigenvalues.view());
        let determines_mean = body.boundary == Boundary::Free || eigenvalues[(0, 0)] > 0.0;
        Box::new(Convolved { body, convolution, self_influence, determines_mean })
    }
}

impl Operator for Convolved {
    fn grid(&self) -> &Grid {
        &self.body.grid
    }

    fn boundary(&self) -> Boundary {
        self.body.boundary
    }

    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        self.convolution.apply_into(p, u);
    }

    fn apply_in_place(&mut self, x: &mut [f64]) {
        self.convolution.apply_in_place(x);
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }

    fn determines_mean(&self) -> bool {
        self.determines_mean
    }

    fn approximate_inverse(&self) -> ApproximateInverse {
        let Body { grid, boundary, backend, kernel, .. } = self.body.clone();
        ApproximateInverse::new(backend, grid, boundary, kernel)
    }

    fn on_grid(&self, grid: Grid) -> Option<Box<dyn Operator>> {
        let Body { boundary, backend, kernel, has_coarser, .. } = self.body.clone();
        has_coarser.then(|| plan_on(backend, grid, boundary, kernel).ok()).flatten()
    }
}

#[cfg(test)]
mod tests {
    use crate::grid::{Boundary, Grid};
    use crate::operator::half_space;

    #[test]
    fn the_self_influence_is_what_the_convolution_says() {
        for cells in [[16, 16], [9, 14], [1, 7], [20, 33]] {
            let grid = Grid::new(cells, [1.0, 2.0]).unwrap();
            let mut operator = half_space(grid, Boundary::Periodic);
            let (mut unit, mut response) = (vec![0.0; cells[0] * cells[1]], vec![0.0; cells[0] * cells[1]]);
            unit[0] = 1.0;
            operator.apply_into(&unit, &mut response);
            // Roundings of a transform, and of a sum of a few hundred terms.
            assert!((operator.self_influence() / response[0] - 1.0).abs() < 1e-13, "{cells:?}");
        }
    }
}
