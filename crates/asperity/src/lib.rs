//! Contact of rough, linear viscoelastic bodies: pressure, gap, contact area and approach over time.
//!
//! Space and time separate: the displacement is u(x, t) = integral over s of C(t - s) d(Kp)(x, s), with the
//! contact creep compliance C(t) of the pair and the unit half-space operator K. So a time step is one elastic
//! contact with a scalar compliance and a shifted gap, and the code says that:
//!
//! ```text
//! heights -> gap --------.
//! Grid -> operator ------+-> March --advance()--> Step {pressure, gap, area, approach}
//! material -> creep -----|
//! load, times -----------'
//! ```
//!
//! - [`surface`]: shapes, roughness, measured heights to the undeformed gap;
//! - [`material`]: models, conversion between creep and relaxation, contact compliance of a pair;
//! - [`load`], [`time`]: what is prescribed, and when the state is computed;
//! - [`simulation`], [`drive`]: what is simulated, and the loops that make rows; [`mod@step`]: one step in time;
//! - [`history`]: what the bodies remember; [`process`]: motion, flattening, energies; [`tangential`]: friction; [`traction`]: forces on the surfaces;
//! - [`contact`]: the elastic contact inside every step;
//! - [`quantities`], [`spots`]: further numbers of each row, on request;
//! - [`finding`]: where the numbers of a run may be off;
//! - [`sliding`]: bodies that slide and roll; [`flash`]: how warm that makes them;
//! - [`leakage`]: flow of a fluid through the gap;
//! - [`operator`], [`kernel`], [`convolution`]: u = Kp; [`layer`]: K of bodies of layers;
//! - [`mod@reference`]: closed forms and one-dimensional solutions; the crate `asperity-verify` compares the solver with them.
//!
//! The example of [`drive::March`] is a whole simulation. Theory, conventions and verification are in `docs/` of
//! the repository. This crate touches no file and prints nothing.

pub mod contact;
pub mod cycles;
pub mod drive;
pub mod error;
mod extrapolation;
pub mod finding;
pub mod flash;
pub mod force_curve;
pub mod grid;
pub mod history;
pub mod indentation;
pub mod kernel;
pub mod layer;
pub mod leakage;
mod linear;
pub mod load;
pub mod material;
mod numbers;
pub mod operator;
pub mod process;
pub mod quantities;
pub mod reference;
pub mod seal;
mod set;
pub mod simulation;
pub mod sliding;
pub mod spots;
pub mod step;
pub mod stress;
pub mod surface;
pub mod tangential;
pub mod time;
pub mod traction;
pub mod wear;

pub use asperity_convolution as convolution;

pub use contact::{ContactState, Method, Outcome, Prescribed, Problem, Solver, SolverOptions};
pub use drive::{Axis, Coordinate, Drive, March};
pub use error::{Error, NotConverged, Result};
pub use grid::{Boundary, Grid};
pub use load::{Control, Course, Event, History, Loading, Programme, Stage};
pub use simulation::{Plasticity, Scheme, Simulation};
pub use time::TimeGrid;

/// The examples of the READMEs of the repository and of this crate, compiled and run by the tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
#[doc = include_str!("../README.md")]
struct Readme;
