//! The measured files of asperity: topographies and curves of materials from the files of instruments and programs, quantities
//! with their units, and what every reader and writer of files needs.

pub mod choice;
pub mod classic;
mod code;
pub mod curve;
pub mod digest;
pub mod npz;
pub mod output;
pub mod quantity;
pub mod readable;
pub mod resources;
pub mod topography;
mod xml;

pub use code::Code;
