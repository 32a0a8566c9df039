//! A step to be taken: when it starts and ends, and what is prescribed at its end.

use std::sync::Arc;

use crate::contact::Prescribed;
use crate::load::{Control, History};
use crate::time::Instant;

/// A step in time, or a jump in none.
#[derive(Clone, Debug)]
pub(crate) struct Interval {
    /// The row that it leads to.
    pub(crate) instant: Instant,
    /// When it starts \[s\].
    pub(crate) start: f64,
    /// Whether it goes on smoothly from the step before: no jump, bend, stage or touch in between.
    pub(crate) is_smooth: bool,
    /// Whether its length is chosen by its error.
    pub(crate) is_adaptive: bool,
    /// The prescribed value at the start of the step, where it is what the row before reached.
    pub(crate) held_from: f64,
    pub(crate) course: Course,
    pub(crate) load: Load,
}

/// What is known of the pressure over a step before it is solved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Load {
    /// There is no pressure at either end.
    Apart,
    /// The approach is prescribed, or the gap moves: u runs in time.
    #[default]
    Approach,
    /// The approach is that of the row before.
    Held,
    /// The load at the end \[N\].
    Total(f64),
}

/// The prescribed value over a stage.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    pub(crate) history: Arc<History>,
    /// When the stage began \[s\].
    pub(crate) start: f64,
    /// The largest size of the value.
    pub(crate) scale: f64,
}

/// A smooth piece of the course that begins with the next step.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// On the clock of the run, and how long it is as far as is known \[s\].
    pub(crate) start: f64,
    pub(crate) length: f64,
    pub(crate) is_after_jump: bool,
    pub(crate) control: Control,
    /// Area of the domain \[m²\].
    pub(crate) area: f64,
    pub(crate) course: Course,
}

impl Interval {
    /// Length \[s\]; 0 of a jump.
    pub(crate) fn length(&self) -> f64 {
        self.instant.dt
    }

    /// The step from the same start that is `dt` long.
    pub(crate) fn of_length(&self, dt: f64) -> Interval {
        let time = self.start + dt;
        let value = self.course.history.after(time - self.course.start);
        Interval { instant: Instant { time, dt, value, jump: false, ..self.instant }, ..self.clone() }
    }

    /// The share of the step from the same start; the step itself where it is all of it.
    pub(crate) fn share(&self, share: f64) -> Interval {
        if share == 1.0 { self.clone() } else { self.of_length(share * self.length()) }
    }

    /// The same step, of whose load this is known.
    pub(crate) fn under(&self, load: Load) -> Interval {
        Interval { load, ..self.clone() }
    }

    /// What the contact is to meet on a domain of this area \[m²\]. A load that is rounding of the largest one is none.
    pub(crate) fn prescribed(&self, area: f64) -> Prescribed {
        let value = self.instant.value;
        let is_rounding = value.abs() <= 16.0 * f64::EPSILON * self.course.scale;
        let is_none = is_rounding && self.instant.control != Control::Approach;
        prescribed(self.instant.control, if is_none { 0.0 } else { value }, area)
    }
}

/// What a contact is to meet on a domain of this area \[m²\].
pub(crate) fn prescribed(control: Control, value: f64, area: f64) -> Prescribed {
    match control {
        Control::Approach => Prescribed::Approach(value),
        Control::Load => Prescribed::Load(value),
        Control::Pressure => Prescribed::Load(value * area),
    }
}

impl Piece {
    /// Rate of the prescribed load at its start, over a time `dt` \[N/s\]; `None` where the approach is prescribed.
    pub(crate) fn load_rate(&self, dt: f64) -> Option<f64> {
        let inside = self.start - self.course.start;
        let history = &self.course.history;
        let rate = (history.after(inside + dt) - history.after(inside)) / dt;
        match self.control {
            Control::Approach => None,
            Control::Load => Some(rate),
            Control::Pressure => Some(rate * self.area),
        }
    }
}
