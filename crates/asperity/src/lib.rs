//! Contact of rough, linear viscoelastic bodies.

pub mod contact;
pub mod error;
mod field;
pub mod grid;
pub mod kernel;
pub mod load;
pub mod march;
pub mod material;
pub mod operator;
pub mod reference;
pub mod surface;
pub mod time;
pub mod verification;

pub use asperity_convolution as convolution;

pub use contact::{ContactState, Method, Outcome, Prescribed, Problem, Solver, SolverOptions};
pub use error::{Error, NotConverged, Result};
pub use grid::{Boundary, Grid};
pub use load::{Control, History, Loading};
pub use march::{March, Scheme, Simulation};
pub use time::TimeGrid;
