//! From shapes and heights to the undeformed gap.
//!
//! Two bodies that face each other across the plane z = 0 have the gap
//!
//! ```text
//! h0(x, y) = sum of the shapes' gaps - sum of the heights + constant
//! ```
//!
//! because a height points out of its body, towards the other one: where a surface is high, the gap is small. The constant sets
//! the smallest sampled value of h0 to zero, so that the approach is zero at first touch. Only [`undeformed_gap`] implements
//! this.
//!
//! - [`Shape`]: smooth shapes.
//! - [`SelfAffine`], [`Synthesis`]: random roughness with a prescribed spectrum, lay and height
//!   distribution.
//! - [`Surface`]: heights on a grid; [`Operation`] prepares measured ones (levelling, filling,
//!   filtering, resampling, ...).
//! - [`statistics`]: statistics of a surface; [`profile`]: parameters of a profile.

pub mod fill;
mod fourier;
mod gap;
pub mod level;
mod map;
mod membrane;
pub mod process;
pub mod profile;
mod self_affine;
mod shape;
mod spectrum;
pub mod statistics;
mod synthesis;
mod waves;

pub use fill::{Fill, fill};
pub(crate) use gap::gap_of;
pub use gap::{Part, undeformed_gap};
pub use level::{Level, level};
pub use map::Surface;
pub use process::Operation;
pub use profile::ProfileParameters;
pub use self_affine::{Roughness, SelfAffine};
pub use shape::{Punch, Shape};
pub use synthesis::{HeightDistribution, Lay, Synthesis};
