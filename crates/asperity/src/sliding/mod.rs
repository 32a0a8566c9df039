//! Contacts in motion: friction and rolling resistance of bodies that remember.
//!
//! A rough or curved body moves with velocity v over a viscoelastic one. In the frame of the contact the material streams by,
//! and every wave of the pressure meets the compliance C~ at its own frequency q.v ([`Streaming`]). The pressure moves to the
//! front of each bump, and friction is its component along the slopes, F = Σ p dh/dx.
//!
//! - [`Steady`]: one steady state for each velocity;
//! - motion in time is part of the [march](crate::March): the gap moves over a body that keeps its memory;
//! - [`Persson`](crate::reference::Persson): the estimate of Persson's theory from the power spectrum, for comparison.
//!
//! docs/sliding.md has the theory, what is computed and how it was checked.

mod friction;
mod influence;
mod metric;
mod moving;
mod path;
mod shear;
mod slopes;
mod steady;
mod streaming;

pub(crate) use friction::ContactForces;
pub use friction::{Direction, Friction};
pub use moving::MovingGap;
pub use path::Path;
pub use shear::ShearStress;
pub use slopes::Slopes;
pub use steady::{Steady, SteadyMotion};
pub use streaming::Streaming;
