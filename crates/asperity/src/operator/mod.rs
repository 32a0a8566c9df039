//! The operator K of a body: u = K p for unit contact modulus.
//!
//! Everything elastic and geometric is in K; the material enters as the scalar compliance that
//! multiplies it (theory: space and time separate). An operator is planned from a [`Kernel`]: by its influence coefficients on
//! a free domain, by its symbol on a periodic one. Nothing above this module knows either, nor the length of a transform. The
//! convolutions of an operator and of its approximate inverse are planned on one [`Backend`].

mod backend;
mod bed;
mod convolved;
mod cpu;
mod free;
mod inverse;
pub(crate) mod wide;

pub use backend::{Backend, ConvolutionPlan, InversePlan};
pub(crate) use bed::{Bed, Bedded};
pub(crate) use convolved::{Body, Convolved};
pub use cpu::Cpu;
pub use inverse::ApproximateInverse;

use std::sync::Arc;

use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView1, ArrayView2};

use crate::convolution::even_spectrum;
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::kernel::{HalfSpace, Kernel};

/// u = K p: symmetric, positive (semi)definite, in metres times the pressure's unit.
pub trait Operator: Send {
    /// The grid that the operator works on.
    fn grid(&self) -> &Grid;

    /// Free or periodic.
    fn boundary(&self) -> Boundary;

    /// u = K p; both C-order of nx ny cells.
    fn apply_into(&mut self, p: &[f64], u: &mut [f64]);

    /// x becomes K x.
    fn apply_in_place(&mut self, x: &mut [f64]);

    /// Displacement of a cell under its own unit pressure, K00 \[m\].
    fn self_influence(&self) -> f64;

    /// Whether a uniform pressure has a displacement. On a periodic half-space it has none: displacements are measured
    /// from their mean, and full contact under a given approach leaves the load undetermined.
    fn determines_mean(&self) -> bool;

    /// An approximate inverse of K, for preconditioning, on the operator's own back end.
    fn approximate_inverse(&self) -> ApproximateInverse;

    /// K of the same body on another grid, for a start from coarser grids; `None` where there is none.
    fn on_grid(&self, grid: Grid) -> Option<Box<dyn Operator>>;
}

/// The back end of operators that are planned without one.
pub fn default_backend() -> Arc<dyn Backend> {
    Arc::new(Cpu)
}

/// The operator of a body with that kernel, on a grid.
///
/// ```
/// use std::sync::Arc;
/// use asperity::{Boundary, Grid, kernel::HalfSpace, operator::plan};
/// // A wave of pressure of unit amplitude displaces a half-space by 2/|q|.
/// let grid = Grid::new([8, 8], [1.0, 1.0])?;
/// let mut operator = plan(grid, Boundary::Periodic, Arc::new(HalfSpace))?;
/// let q = std::f64::consts::TAU;
/// let p: Vec<f64> = (0..64).map(|n| (q * grid.x(n / 8)).cos()).collect();
/// let mut u = vec![0.0; 64];
/// operator.apply_into(&p, &mut u);
/// assert!((u[0] - 2.0 / q * p[0]).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) where the grid of a free domain does not resolve the body.
pub fn plan(grid: Grid, boundary: Boundary, kernel: Arc<dyn Kernel>) -> Result<Box<dyn Operator>> {
    plan_on(default_backend(), grid, boundary, kernel)
}

/// The same on a chosen back end.
///
/// # Errors
/// As [`plan`].
pub fn plan_on(
    backend: Arc<dyn Backend>,
    grid: Grid,
    boundary: Boundary,
    kernel: Arc<dyn Kernel>,
) -> Result<Box<dyn Operator>> {
    let eigenvalues = eigenvalues(&grid, boundary, &*kernel)?;
    Ok(of_eigenvalues(Body { grid, boundary, backend, kernel, has_coarser: true }, &eigenvalues))
}

/// The operator of the elastic half-space.
pub fn half_space(grid: Grid, boundary: Boundary) -> Box<dyn Operator> {
    plan(grid, boundary, Arc::new(HalfSpace)).expect("any grid resolves a half-space")
}

/// The eigenvalues of K on the torus that its convolution works on, those of a quarter of the waves, \[kx\]\[ky\] \[m\].
///
/// # Errors
/// As [`plan`].
pub(crate) fn eigenvalues(grid: &Grid, boundary: Boundary, kernel: &dyn Kernel) -> Result<Array2<f64>> {
    match boundary {
        Boundary::Free => Ok(even_spectrum(&free::influence(grid, kernel)?, free::padded(grid))),
        // The symbol of the kernel on the waves of the domain (Stanley & Kato, J. Tribol. 119, 1997).
        Boundary::Periodic => {
            let uniform = kernel.uniform().unwrap_or(0.0);
            Ok(wave_spectrum(grid.cells(), grid.size(), uniform, |qx, qy| kernel.symbol(qx, qy)))
        }
    }
}

/// Lengths of the torus of [`eigenvalues`].
pub(crate) fn torus(grid: &Grid, boundary: Boundary) -> [usize; 2] {
    match boundary {
        Boundary::Free => free::padded(grid),
        Boundary::Periodic => grid.cells(),
    }
}

/// The operator with these [`eigenvalues`]; the kernel of the body stands for it where an approximate inverse is asked for.
pub(crate) fn of_eigenvalues(body: Body, eigenvalues: &Array2<f64>) -> Box<dyn Operator> {
    let lengths = torus(&body.grid, body.boundary);
    Convolved::new(body, lengths, eigenvalues)
}

/// The mean of an even spectrum over all waves, of which the array has those of a quarter: the response to a unit where it is.
pub(crate) fn mean([nx, ny]: [usize; 2], spectrum: ArrayView2<f64>) -> f64 {
    let times = |k: usize, n: usize| if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
    let row = |row: ArrayView1<f64>| -> f64 { row.iter().enumerate().map(|(ky, s)| times(ky, ny) * s).sum() };
    let sum: f64 = spectrum.outer_iter().enumerate().map(|(kx, s)| times(kx, nx) * row(s)).sum();
    sum / (nx as f64 * ny as f64)
}

/// Bytes that the operator of a grid takes.
pub fn bytes(grid: &Grid, boundary: Boundary) -> usize {
    default_backend().bytes(grid.cells(), torus(grid, boundary))
}

/// `symbol`(qx, qy) on the wave vectors of a torus of `cells` and `size`, `uniform` for q = 0.
fn wave_spectrum(
    [nx, ny]: [usize; 2],
    [lx, ly]: [f64; 2],
    uniform: f64,
    symbol: impl Fn(f64, f64) -> f64 + Sync,
) -> Array2<f64> {
    let tau = std::f64::consts::TAU;
    let mut spectrum = Array2::zeros((nx / 2 + 1, ny / 2 + 1));
    spectrum.outer_iter_mut().into_par_iter().enumerate().for_each(|(kx, mut row)| {
        let qx = tau * kx as f64 / lx;
        row.iter_mut().enumerate().for_each(|(ky, s)| *s = symbol(qx, tau * ky as f64 / ly));
    });
    spectrum[(0, 0)] = uniform;
    spectrum
}
