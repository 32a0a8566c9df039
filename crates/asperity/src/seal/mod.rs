//! A whole seal: how much leaks across a contact that is wide against the roughness, and at which inlet pressure it opens.
//!
//! The fluid carries a part of the load, so at a place x across the seal the bodies touch as in the dry contact at the contact pressure
//! less the fluid pressure, p = p0(x) - P(x). A patch of the surface, computed dry over its mean pressure p, gives the conductance
//! sigma(p) (`hydraulic_gap` to the third power), and the flow across the seal is
//!
//! ```text
//! F = -sigma(p0(x) - P) dP/dx,  P = P_in at the inlet, P_out at the outlet;  leak = F C/(12 mu)     C: length along the seal
//! ```
//!
//! | file | content |
//! |---|---|
//! | `conductance`, `curve` | sigma(p) from a sweep |
//! | `gas` | the density and the rarefaction of a gas |
//! | `profile` | the contact pressure p0(x) |
//! | `march` | the pressure of the fluid, the flow, where the seal is choked |
//! | `opening` | the inlet pressure at which the seal opens |
//! | `refine` | the pressure at which sigma would tell most about the flow |
//!
//! ```
//! use asperity::seal::{Conductance, Profile, Shape, flow};
//! // sigma = exp(-p) uniform over the seal: F = (e^P_in - e^P_out)/(e^p0 width).
//! let sweep: Vec<_> = (1..9).map(|n| (0.5 * f64::from(n), (-0.5 * f64::from(n)).exp())).collect();
//! let profile = Profile { shape: Shape::Uniform { peak: 4.0, width: 2.0 }, energising: 0.0 };
//! let state = flow(&Conductance::new(&sweep)?, &profile, [3.0, 0.0])?;
//! let exact = (3f64.exp() - 1.0) / (4f64.exp() * 2.0);
//! assert!((state.flow / exact - 1.0).abs() < 1e-6);
//! # Ok::<(), asperity::Error>(())
//! ```

mod conductance;
mod curve;
mod gas;
mod march;
mod opening;
mod profile;
mod refine;

pub use conductance::Conductance;
pub use gas::{GasPoint, SealGas};
pub use march::{CELLS, Choke, SealFlow, SealState, bounds, flow};
pub use opening::{Opens, opening};
pub use profile::{Profile, Shape, Table};
pub use refine::refinement;

#[cfg(test)]
mod tests;
