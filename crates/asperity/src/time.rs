//! The times at which the state is computed: the time grid, combined with the kinks and jumps of the history.

mod plan;

pub use plan::Plan;
pub(crate) use plan::{Span, Stop, agree, stops};

use crate::load::Control;
pub(crate) use crate::load::SHORTEST;
pub use crate::load::TimeGrid;

/// One row of the result: a step in time, or a jump at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// t \[s\].
    pub time: f64,
    /// Length of the step that ends here \[s\]; 0 at t = 0+ and for a jump.
    pub dt: f64,
    /// The prescribed value.
    pub value: f64,
    /// True at t = 0+ and at jumps of the history.
    pub jump: bool,
    /// The prescribed quantity.
    pub control: Control,
    /// Number of the stage, from 0.
    pub stage: usize,
}

/// Fraction of the last time below which two times are equal.
pub(crate) const SAME: f64 = 1e-12;
