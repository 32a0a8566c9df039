//! Pictures of asperity: numbers in, figures out. It computes no physics.
//!
//! [`page`] writes the report, one HTML file; [`result`] makes the figures of a result, by name;
//! [`pictures`] a directory of them;
//! [`paper`] the figures of the paper that the method comes from; [`figure`] draws panels of curves and maps with units, scale bars and colour bars, as SVG or PNG.

pub mod figure;
mod file;
pub mod page;
pub mod paper;
pub mod pictures;
pub mod result;
