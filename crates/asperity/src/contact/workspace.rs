//! The working memory of projected conjugate gradients.

use crate::grid::{Boundary, Grid};
use crate::operator::{ApproximateInverse, Operator};
use asperity_sweep::zeros;

/// Preconditioned projected conjugate gradients: the preconditioner, 32 bytes per cell, and two sets.
pub struct ProjectedCg {
    pub(super) preconditioner: ApproximateInverse,
    /// Residual on S over `unit`, now and one iteration ago.
    pub(super) residual: Vec<f32>,
    pub(super) residual_old: Vec<f32>,
    /// Preconditioned residual z and direction d.
    pub(super) preconditioned: Vec<f32>,
    pub(super) direction: Vec<f32>,
    /// Step s and its image K s.
    pub(super) step: Vec<f64>,
    pub(super) image: Vec<f64>,
    /// S, now and one iteration ago.
    pub(super) working: Vec<u8>,
    pub(super) working_old: Vec<u8>,
}

impl ProjectedCg {
    /// Plans the method for an operator.
    pub fn new(operator: &dyn Operator) -> Self {
        let n = operator.grid().len();
        ProjectedCg {
            preconditioner: operator.approximate_inverse(),
            residual: zeros(n),
            residual_old: zeros(n),
            preconditioned: zeros(n),
            direction: zeros(n),
            step: zeros(n),
            image: zeros(n),
            working: zeros(n.div_ceil(8)),
            working_old: zeros(n.div_ceil(8)),
        }
    }

    /// Bytes that the method takes at most, without the operator.
    pub(crate) fn bytes(grid: &Grid, boundary: Boundary) -> usize {
        ApproximateInverse::bytes(grid, boundary) + 32 * grid.len() + grid.len() / 4
    }
}
