//! The files of asperity: case files in, measured topographies and curves in, results out.

pub mod answer;
pub mod case;
pub mod choice;
mod classic;
mod code;
pub mod compare;
pub mod converge;
pub mod curve;
pub mod cycles;
mod digest;
pub mod export;
pub mod finding;
mod instants;
pub mod leakage;
pub mod material_export;
mod npz;
pub mod output;
pub mod preparation;
pub mod quantity;
pub mod readable;
pub mod resources;
pub mod seal;
pub mod session;
pub mod store;
pub mod stress;
pub mod study;
pub mod topography;
mod xml;

pub use code::Code;
