//! The files of asperity: case files in, measured topographies in, results out.

pub mod case;
pub mod export;
pub mod session;
pub mod store;
pub mod topography;
