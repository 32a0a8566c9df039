//! The files of asperity: case files in, results out, and the readers of measured files of [`asperity_files`].

pub mod answer;
pub mod case;
pub mod compare;
pub mod converge;
pub mod cycles;
pub mod export;
pub mod finding;
mod instants;
pub mod leakage;
pub mod material_export;
pub mod preparation;
pub mod seal;
pub mod session;
pub mod store;
pub mod stress;
pub mod study;

pub use asperity_files::{Code, choice, curve, output, quantity, readable, resources, topography};
use asperity_files::{classic, digest, npz};
