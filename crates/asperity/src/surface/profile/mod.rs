//! Profiles: heights along a line, as a stylus measures them.
//!
//! - [`ProfileParameters`]: Ra, Rq, Rz, Rt, Rsk, Rku, Rsm and Rdq (ISO 21920-2).
//! - [`roughness`]: the heights minus their Gaussian mean line (ISO 16610-21).
//! - [`remove_circle`]: the heights minus a circle of given or fitted radius.
//! - [`ProfileSpectrum`]: the power spectrum of a profile, that of the corresponding isotropic surface, and such a surface.

mod circle;
mod parameters;
mod spectrum;

pub use circle::remove_circle;
pub use parameters::{ProfileParameters, roughness};
pub use spectrum::{ProfileSpectrum, ProfileSurface};
