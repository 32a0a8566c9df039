//! Pictures of asperity: numbers in, figures out. It computes no physics.
//!
//! [`figure`] draws panels of curves and maps with units, scale bars and colour bars, as SVG or PNG.

pub mod figure;
