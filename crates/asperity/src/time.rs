//! When the state is computed: the time grid, joined with the breaks and jumps of the history.

mod plan;

pub use plan::Plan;
pub(crate) use plan::{Span, Stop, agree, stops};

use crate::load::Control;
pub(crate) use crate::load::SHORTEST;
pub use crate::load::TimeGrid;

/// One row of the result: a step in time, or a jump in none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// t \[s\].
    pub time: f64,
    /// Length of the step that leads here \[s\]; 0 at t = 0+ and for a jump.
    pub dt: f64,
    /// The prescribed value.
    pub value: f64,
    /// True at t = 0+ and where the history jumps.
    pub jump: bool,
    /// What is prescribed.
    pub control: Control,
    /// Number of the stage, from 0.
    pub stage: usize,
}

/// Share of the last time below which two instants are one.
pub(crate) const SAME: f64 = 1e-12;
