//! Contact of rough, linear viscoelastic bodies.

pub mod error;
pub mod grid;
pub mod load;
pub mod material;
pub mod reference;
pub mod surface;

pub use error::{Error, NotConverged, Result};
pub use grid::{Boundary, Grid};
pub use load::{Control, History, Loading};
