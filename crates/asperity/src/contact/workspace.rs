//! The working memory of projected conjugate gradients.

use crate::grid::{Boundary, Grid};
use crate::operator::{ApproximateInverse, Operator};
use asperity_sweep::zeros;

/// Preconditioned projected conjugate gradients: the preconditioner, 20 bytes per cell, and two sets.
pub struct ProjectedCg {
    pub(super) preconditioner: ApproximateInverse,
    /// Residual on S over `unit`, now and one iteration ago.
    pub(super) residual: Vec<f32>,
    pub(super) residual_old: Vec<f32>,
    /// Direction d.
    pub(super) direction: Vec<f32>,
    /// One after the other: the preconditioned residual z until it is in d, the step s, its image K s.
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
            direction: zeros(n),
            image: zeros(n),
            working: zeros(n.div_ceil(8)),
            working_old: zeros(n.div_ceil(8)),
        }
    }

    /// Bytes that the method takes at most, without the operator.
    pub(crate) fn bytes(grid: &Grid, boundary: Boundary) -> usize {
        ApproximateInverse::bytes(grid, boundary) + 20 * grid.len() + grid.len() / 4
    }
}

/// z of all cells, in the first half of the memory of the image.
pub(super) fn preconditioned(image: &mut [f64]) -> &mut [f32] {
    let cells = image.len();
    &mut bytemuck::cast_slice_mut(image)[..cells]
}
