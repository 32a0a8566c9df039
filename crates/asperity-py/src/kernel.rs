//! Kernels that Python gives as numbers.

use std::f64::consts::TAU;

use asperity::kernel::{Kernel, wave_kernel};
use asperity::{Boundary, Error, Grid, Result};
use ndarray::Array2;

/// The kernel of one grid: of a periodic domain its symbol on the wave vectors (2 pi k / Lx, 2 pi l / Ly) of k <= nx/2 and
/// l <= ny/2, of a free domain its influence coefficients K(i dx, j dy) of i < nx and j < ny; \[m\].
#[derive(Debug)]
pub struct Table {
    pub boundary: Boundary,
    pub grid: Grid,
    pub values: Array2<f64>,
}

impl Table {
    /// The table, if it has the numbers that the grid needs.
    ///
    /// # Errors
    /// [`Error::Invalid`].
    pub fn new(grid: Grid, boundary: Boundary, values: Array2<f64>) -> Result<Table> {
        let (nx, ny) = grid.shape();
        let expected = match boundary {
            Boundary::Periodic => (nx / 2 + 1, ny / 2 + 1),
            Boundary::Free => (nx, ny),
        };
        if values.dim() != expected {
            return Err(Error::invalid(
                "shape of the kernel",
                format!("{:?}", values.dim()),
                format!("{expected:?}"),
            ));
        }
        let first = match boundary {
            Boundary::Periodic => 1, // that of the uniform pressure may be undetermined
            Boundary::Free => 0,
        };
        let positive = |k: &f64| boundary == Boundary::Free || *k > 0.0;
        if let Some(wrong) = values.iter().skip(first).find(|k| !k.is_finite() || !positive(k)) {
            let expected = match boundary {
                Boundary::Periodic => "finite and greater than 0 at every wave vector but 0",
                Boundary::Free => "finite everywhere",
            };
            return Err(Error::invalid("kernel", wrong, expected));
        }
        Ok(Table { boundary, grid, values })
    }
}

impl Kernel for Table {
    /// Beyond the domain 0: no displacement of the domain depends on what is there.
    fn influence(&self, cell: [f64; 2], count: [usize; 2]) -> Result<Array2<f64>> {
        let same = self.grid.spacing().iter().zip(cell).all(|(own, other)| (own / other - 1.0).abs() < 1e-12);
        if self.boundary == Boundary::Periodic || !same {
            // A coarser grid only serves for a start, and is left out without its coefficients.
            return Err(Error::invalid("kernel", "of another grid", "influence coefficients of this grid"));
        }
        let known = |i: usize, j: usize| self.values.get((i, j)).copied().unwrap_or(0.0);
        Ok(Array2::from_shape_fn((count[0], count[1]), |(i, j)| known(i, j)))
    }

    fn strip(&self, dx: f64, count: usize) -> Result<Vec<f64>> {
        Ok(self.influence([dx, self.grid.spacing()[1]], [count, 1])?.into_iter().collect())
    }

    /// Of a free domain that of a half-space, which serves for preconditioning alone.
    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        if self.boundary == Boundary::Free {
            return wave_kernel(qx, qy);
        }
        let [lx, ly] = self.grid.size();
        let (nx, ny) = self.values.dim();
        let number = |q: f64, length: f64, most: usize| ((q * length / TAU).round() as usize).min(most - 1);
        self.values[(number(qx, lx, nx), number(qy, ly, ny))]
    }

    fn uniform(&self) -> Option<f64> {
        let uniform = self.values[(0, 0)];
        (self.boundary == Boundary::Periodic && uniform.is_finite()).then_some(uniform)
    }
}
