//! Pictures of asperity: numbers in, figures out. It computes no physics.
//!
//! - [`figure`] draws panels of curves and maps with units, scale bars and colour bars, as SVG, PNG or PDF.
//! - [`result`] makes the figures of a result, by name; [`pictures`] a directory of them.
//! - [`animation`] shows one over the stored times.
//! - [`page`] writes the report, one HTML file.
//! - [`leak`] draws the flow through a gap.
//! - [`material`] shows materials and fits.
//! - [`paper`] makes the figures of the paper that the method comes from.
//! - [`seal`] draws the answers about a whole seal.
//! - [`sheet`] writes tables and figures as one page, [`study`] draws the answers of a study.
//! - [`surface`] draws a surface with its statistics, [`thumbnail`] a small picture of a result.

pub mod animation;
pub mod figure;
mod histogram;
pub mod leak;
pub mod material;
pub mod page;
pub mod paper;
pub mod pictures;
pub mod result;
pub mod seal;
pub mod sheet;
pub mod study;
pub mod surface;
mod thumbnail;

pub use thumbnail::thumbnail;
