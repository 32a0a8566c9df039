//! Influence functions of the half-space, for unit contact modulus E* = 1.
//!
//! Pure functions of geometry: no grid, no material.

mod boussinesq;
mod periodic;

pub use boussinesq::love;
pub use periodic::{inverse_kernel, wave_kernel};
