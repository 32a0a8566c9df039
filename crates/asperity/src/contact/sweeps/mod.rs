//! The vector kernels of the contact solvers: one formula per cell, sums in a fixed order, nothing of the algorithm.
//!
//! Fields of the state are f64. Residual and direction are f32: they say where to go, relative to the largest violation at
//! the start of the solve, and the exact line search along the step corrects their rounding error. Sets of cells are bits,
//! eight in a byte; kernels that only concern a set skip the bytes that are zero.

pub(super) mod direction;
pub(super) mod feasible;
pub(super) mod projection;
pub(super) mod residual;
pub(super) mod step;
