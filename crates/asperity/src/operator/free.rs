//! The free domain: no pressure outside, by influence coefficients and zero-padded convolution (DC-FFT: Liu, Wang & Liu, Wear
//! 243, 2000).

use std::sync::Arc;

use ndarray::{Array1, Array2};

use super::backend::{Backend, ConvolutionPlan};
use super::{ApproximateInverse, Operator, default_backend, mean};
use crate::convolution::{Convolution, even_spectrum};
use crate::error::{Error, Result};
use crate::grid::{Boundary, Grid};
use crate::kernel::{HalfSpace, Kernel, strip};

/// u(i, j) = sum K(i - i', j - j') p(i', j'), with no pressure outside the domain.
pub struct Free {
    grid: Grid,
    backend: Arc<dyn Backend>,
    kernel: Arc<dyn Kernel>,
    convolution: Box<dyn ConvolutionPlan>,
    self_influence: f64,
}

impl Free {
    /// Plans the operator; the influence coefficients are computed here.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the kernel cannot be computed on the grid, or is not positive definite there.
    pub fn new(backend: Arc<dyn Backend>, grid: Grid, kernel: Arc<dyn Kernel>) -> Result<Self> {
        let influence = influence(&grid, &*kernel)?;
        let spectrum = even_spectrum(&influence, padded(&grid));
        Ok(Free::planned(backend, grid, kernel, influence[(0, 0)], &spectrum))
    }

    pub(super) fn eigenvalues(grid: &Grid, kernel: &dyn Kernel) -> Result<Array2<f64>> {
        Ok(even_spectrum(&influence(grid, kernel)?, padded(grid)))
    }

    pub(super) fn of_eigenvalues(
        backend: Arc<dyn Backend>,
        grid: Grid,
        kernel: Arc<dyn Kernel>,
        eigenvalues: &Array2<f64>,
    ) -> Self {
        Free::planned(backend, grid, kernel, mean(padded(&grid), eigenvalues.view()), eigenvalues)
    }

    /// The operator of the elastic half-space.
    pub fn half_space(backend: Arc<dyn Backend>, grid: Grid) -> Self {
        let influence = match grid.is_line() {
            true => of_strips(strip(grid.spacing()[0], computed(&grid)[0]), padded(&grid)[1]),
            false => HalfSpace.coefficients(grid.spacing(), computed(&grid)),
        };
        let spectrum = even_spectrum(&influence, padded(&grid));
        debug_assert!(spectrum.iter().all(|s| *s > 0.0), "the kernel is positive definite");
        Free::planned(backend, grid, Arc::new(HalfSpace), influence[(0, 0)], &spectrum)
    }

    fn planned(
        backend: Arc<dyn Backend>,
        grid: Grid,
        kernel: Arc<dyn Kernel>,
        self_influence: f64,
        spectrum: &Array2<f64>,
    ) -> Self {
        let convolution = backend.plan(grid.cells(), padded(&grid), spectrum.view());
        Free { grid, backend, kernel, convolution, self_influence }
    }

    /// Bytes that the operator takes on that grid.
    pub(super) fn bytes(grid: &Grid) -> usize {
        default_backend().bytes(grid.cells(), padded(grid))
    }
}

/// The influence coefficients on the quadrant of the padded torus.
fn influence(grid: &Grid, kernel: &dyn Kernel) -> Result<Array2<f64>> {
    kernel.check(grid.longest_cell())?;
    let influence = match grid.is_line() {
        true => of_strips(kernel.strip(grid.spacing()[0], computed(grid)[0])?, padded(grid)[1]),
        false => kernel.influence(grid.spacing(), computed(grid))?,
    };
    plausible(&influence)?;
    Ok(influence)
}

/// The coefficients of a line as those of a grid with one cell along y, on a torus that is so long along y.
pub(super) fn of_strips(strips: Vec<f64>, across: usize) -> Array2<f64> {
    let mut influence = Array2::zeros((strips.len(), across / 2 + 1));
    influence.column_mut(0).assign(&Array1::from(strips));
    influence
}

/// Lengths of the transforms.
pub(super) fn padded(grid: &Grid) -> [usize; 2] {
    grid.cells().map(|n| Convolution::good_length(2 * n - 1))
}

/// Coefficients along x and y: the quadrant of the padded torus. Beyond the domain the true coefficients go on: no output
/// of the domain reads them, and the kernel stays smooth and its spectrum positive.
pub(super) fn computed(grid: &Grid) -> [usize; 2] {
    padded(grid).map(|length| length / 2 + 1)
}

/// A positive definite kernel is largest at its centre.
///
/// The spectrum on the padded torus may be negative in places, where the response reaches beyond the domain: the torus is not
/// the body. On the domain K is positive as long as the symbol of the body is.
pub(super) fn plausible(influence: &Array2<f64>) -> Result<()> {
    let most =
        influence.iter().fold(0.0, |most: f64, k| if k.is_nan() { f64::NAN } else { most.max(k.abs()) });
    let own = influence[(0, 0)];
    match own > 0.0 && own.is_finite() && most <= own {
        true => Ok(()),
        false => Err(Error::invalid(
            "largest influence of a cell on another over that on itself",
            format!("{:e}", most / own),
            "less than 1: the cells are too coarse for the body; take smaller ones, or a periodic domain",
        )),
    }
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
        ApproximateInverse::new(self.backend.clone(), self.grid, Boundary::Free, self.kernel.clone())
    }

    fn on_grid(&self, grid: Grid) -> Option<Box<dyn Operator>> {
        Some(Box::new(Free::new(self.backend.clone(), grid, self.kernel.clone()).ok()?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let spectrum =
                even_spectrum(&HalfSpace.coefficients(grid.spacing(), computed(&grid)), padded(&grid));
            assert!(spectrum.iter().all(|s| *s > 0.0), "{cells:?} {size:?}");
        }
        for cells in [2, 3, 17, 64, 1000] {
            let grid = Grid::line(cells, 1e-3).unwrap();
            let strips = of_strips(strip(grid.spacing()[0], computed(&grid)[0]), padded(&grid)[1]);
            let spectrum = even_spectrum(&strips, padded(&grid));
            assert!(spectrum.iter().all(|s| *s > 0.0), "a line of {cells}");
        }
    }
}
