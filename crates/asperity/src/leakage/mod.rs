//! Flow of a fluid through the gap between two bodies in contact: does the seal leak, and how much?
//!
//! The gap h is narrow, so the flow obeys Reynolds' equation for a thin film,
//!
//! ```text
//! div(h^3/(12 mu) grad P) = 0 if the bodies do not touch; no flow into the contact
//! P = P_in at one border of the domain, P_out at the opposite one
//! ```
//!
//! for a Newtonian liquid of viscosity mu, and for an isothermal gas with P^2/2 in place of P and a factor for the rarefaction
//! ([`gas`]). The pressure of the fluid does not load the bodies: this is valid while it is small compared with the contact
//! pressure. The flow at a time therefore follows only from gap and contact at that time, and can be computed from any stored
//! gap.
//!
//! For a liquid one length determines everything, the hydraulic gap T^(1/3), with
//!
//! ```text
//! T = 12 mu Q L/(dP W) [m^3]      Q: leak rate, L: length of the domain along the flow, W: its width
//! ```
//!
//! that is, the gap of parallel plates with the same leak.
//!
//! | file | content |
//! |---|---|
//! | `opening` | the open cells, turned so that the flow runs along axis 0 |
//! | `passages` | which cells are connected to inlet and outlet; the critical constriction; pockets |
//! | `network` | finite volumes: conductances between neighbouring cells |
//! | `cholesky`, `multigrid`, `solve` | the linear system |
//! | `flow` | pressure and leak of a liquid |
//! | `gas`, `gas_flow` | viscosity, rarefaction; pressure and leak of a gas |
//! | `tensor` | effective conductance of a periodic gap |
//! | `estimate` | Bruggeman's effective medium |
//!
//! ```
//! use asperity::{Grid, leakage::{Direction, Opening, Passages, Sides, liquid}};
//! // A groove with a parabolic cross-section, 20 um wide and 1 um deep, along x: T = 32/35 h0^3 b/W, b half its width.
//! let grid = Grid::new([8, 256], [1e-4, 4e-5])?;
//! let gap = ndarray::Array2::from_shape_fn(grid.shape(), |(_, j)| {
//!     1e-6 * (1.0 - ((grid.y(j) - 2e-5) / 1e-5).powi(2)).max(0.0)
//! });
//! let opening = Opening::new(&grid, gap.view(), None, Direction::X, Sides::Closed, 0.0)?;
//! let passages = Passages::of(&opening);
//! assert!(passages.percolates());
//! let flow = liquid(&opening, &passages, &Default::default())?;
//! let exact = 32.0 / 35.0 * 1e-18 * 1e-5 / 4e-5;
//! assert!((flow.transmissivity / exact - 1.0).abs() < 1e-3);
//! // Water, 2 bar: m^3/s.
//! let leak = flow.leak_rate(&opening, 2e5, 1e-3)?;
//! assert!((leak / (exact * 2e5 * 4e-5 / (12.0 * 1e-3 * 1e-4)) - 1.0).abs() < 1e-3);
//! # Ok::<(), asperity::Error>(())
//! ```

mod cholesky;
mod estimate;
mod flow;
pub mod gas;
mod gas_flow;
mod multigrid;
mod network;
mod opening;
mod passages;
mod solve;
mod tensor;

pub use cholesky::factor_bytes;
pub use estimate::effective_medium;
pub use flow::{Flow, flux, leak_rate, liquid};
pub use gas::{Gas, Rarefaction, Species};
pub use gas_flow::{GasFlow, gas_flow, plate, standard};
pub use opening::{Direction, Opening, Sides};
pub use passages::{CellKind, Constriction, Passages};
pub use solve::FlowOptions;
pub use tensor::conductance;

pub(crate) use flow::liquid_after;
pub(crate) use gas_flow::gas_flow_after;
pub(crate) use solve::Previous;

#[cfg(test)]
mod tests;
