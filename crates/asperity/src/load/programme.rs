//! Stages: the prescribed quantity changes at a time or at an event.
//!
//! Press under load, hold the approach reached, retract until contact is lost, wait, touch again: each of these is a stage with a
//! control, a history of its value with a separate time, and an end.

use super::{Control, History, Loading, TimeGrid};
use crate::error::{Error, Result, positive, require};
use crate::quantities::{Quantity, RowNumber};

/// The consecutive stages of a run. The run ends with the last stage or at the end of its time grid, whichever comes first.
///
/// ```
/// use asperity::load::{Control, Course, Event, History, Programme, Stage};
/// // Press with 1 N until 2 um deep, hold that approach for 10 s, then retract at 1 um/s until contact is lost.
/// let press = Stage { until: Some(Event::Approach(2e-6)), ..Stage::new(Control::Load, History::Step { value: 1.0 }) };
/// let hold = Stage { duration: Some(10.0), ..Stage::new(Control::Approach, Course::Hold) };
/// let retract = Stage {
///     until: Some(Event::ContactLost),
///     ..Stage::new(Control::Approach, Course::RampTo { value: -8e-6, duration: 10.0 })
/// };
/// let programme = Programme::new(vec![press, hold, retract]);
/// assert!(programme.validate().is_ok());
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Programme {
    /// In order; at least one.
    pub stages: Vec<Stage>,
}

/// A part of the run under one control.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// The prescribed quantity of the stage.
    pub control: Control,
    /// Its value; the time of this history starts with the stage.
    pub course: Course,
    /// Longest duration of the stage \[s\].
    pub duration: Option<f64>,
    /// The stage ends at this event. Without `duration` the event must occur before the run ends. With `duration` the stage ends
    /// after it at the latest, which is not an error.
    pub until: Option<Event>,
    /// The event only counts after the jump at the beginning of the stage: not even where the jump ends at the value itself.
    pub after_jump: bool,
    /// Times of the stage, counted from its start, in place of those of the run.
    pub times: Option<TimeGrid>,
}

/// The prescribed value over a stage.
#[derive(Clone, Debug, PartialEq)]
pub enum Course {
    /// A given history, from the start of the stage on.
    Given(History),
    /// The value that the quantity has when the stage starts.
    Hold,
    /// Linear from the value that the quantity has when the stage starts to `value` during `duration`, then
    /// held.
    RampTo {
        /// Value reached.
        value: f64,
        /// Time to reach it \[s\].
        duration: f64,
    },
}

/// The event that ends a stage. A value is reached when the quantity crosses it, from the side on which it is when the stage starts; if
/// it starts at the value, it must leave it first. A jump reaches the value at which it ends, not those that it only passes: after it the
/// value is waited for from the side on which the quantity is then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event {
    /// The approach reaches a value \[m\].
    Approach(f64),
    /// The load reaches a value \[N\].
    Load(f64),
    /// The mean pressure reaches a value \[Pa\].
    Pressure(f64),
    /// Another number of a row reaches a value, in its SI unit.
    Number(RowNumber, f64),
    /// Bodies in contact lose contact.
    ContactLost,
}

impl std::fmt::Display for Event {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Event::Approach(value) => write!(f, "approach {value:e} m"),
            Event::Load(value) => write!(f, "load {value:e} N"),
            Event::Pressure(value) => write!(f, "mean pressure {value:e} Pa"),
            Event::Number(number, value) => match number.units() {
                "1" => write!(f, "{} {value}", number.name()),
                units => write!(f, "{} {value:e} {units}", number.name()),
            },
            Event::ContactLost => f.write_str("loss of contact"),
        }
    }
}

impl From<History> for Course {
    fn from(history: History) -> Self {
        Course::Given(history)
    }
}

impl From<Loading> for Programme {
    fn from(loading: Loading) -> Self {
        Programme::new(vec![Stage::new(loading.control, loading.history)])
    }
}

impl Stage {
    /// A stage that lasts to the end of the run, with the times of the run.
    pub fn new(control: Control, course: impl Into<Course>) -> Self {
        Stage { control, course: course.into(), duration: None, until: None, after_jump: false, times: None }
    }

    /// The quantity of the rows that the stage waits for.
    pub(crate) fn awaited(&self) -> Option<Quantity> {
        match self.until {
            Some(Event::Number(RowNumber::Quantity(quantity), _)) => Some(quantity),
            _ => None,
        }
    }
}

impl Course {
    /// The history that begins at the value `reached`.
    pub fn resolve(&self, reached: f64) -> History {
        match self {
            Course::Given(history) => history.clone(),
            Course::Hold => History::Step { value: reached },
            Course::RampTo { value, duration } => {
                History::Table { points: vec![(0.0, reached), (*duration, *value)] }
            }
        }
    }

    /// The first time at which the history has a kink or a jump, counted from the start of the stage \[s\]; `None` if there is
    /// none.
    pub fn first_break(&self) -> Option<f64> {
        match self {
            Course::Given(history) => history.breaks(f64::INFINITY).first().copied(),
            Course::Hold => None,
            Course::RampTo { duration, .. } => Some(*duration),
        }
    }

    fn validate(&self) -> Result<()> {
        match self {
            Course::Given(history) => history.validate(),
            Course::Hold => Ok(()),
            Course::RampTo { value, duration } => {
                History::Ramp { value: *value, duration: *duration }.validate()
            }
        }
    }
}

impl Programme {
    /// The programme of these stages.
    pub fn new(stages: Vec<Stage>) -> Self {
        Programme { stages }
    }

    /// Checks that values and durations are finite and in order, and that every stage can begin.
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the stage, counted from 1, and the quantity.
    pub fn validate(&self) -> Result<()> {
        require(!self.stages.is_empty(), "list of stages", "empty", "one stage at least")?;
        for (n, stage) in self.stages.iter().enumerate() {
            let result = stage.validate(n + 1 == self.stages.len());
            result.map_err(|error| if self.stages.len() > 1 { of_stage(error, n) } else { error })?;
        }
        Ok(())
    }
}

impl Stage {
    pub(crate) fn validate(&self, last: bool) -> Result<()> {
        self.course.validate()?;
        if let Some(duration) = self.duration {
            positive("duration", duration, "s")?;
        }
        if let Some(times) = &self.times {
            times.validate()?;
        }
        if !last && self.duration.is_none() && self.until.is_none() {
            return Err(Error::invalid(
                "end",
                "missing",
                "a duration or an event (otherwise the stages after it never begin)",
            ));
        }
        match self.until {
            Some(Event::Approach(value)) if !value.is_finite() => {
                Err(Error::invalid("approach of the event", value, "finite"))
            }
            Some(Event::Number(number, value)) if !value.is_finite() => {
                Err(Error::invalid(format!("{} of the event", number.name()), value, "finite"))
            }
            Some(Event::Load(value) | Event::Pressure(value)) if !value.is_finite() => {
                Err(Error::invalid("load of the event", value, "finite"))
            }
            _ => Ok(()),
        }
    }
}

/// The same error, of the `n`th stage from 0.
pub(crate) fn of_stage(error: Error, n: usize) -> Error {
    match error {
        Error::Invalid { parameter, what, value, expected } => {
            Error::Invalid { parameter, what: format!("{what} of stage {}", n + 1), value, expected }
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stage_that_never_ends_keeps_the_next_from_beginning() {
        let hold = Stage::new(Control::Approach, Course::Hold);
        let error = Programme::new(vec![hold.clone(), hold.clone()]).validate().unwrap_err().to_string();
        assert!(error.contains("end of stage 1 is missing"), "{error}");
        let timed = Stage { duration: Some(1.0), ..hold.clone() };
        assert!(Programme::new(vec![timed.clone(), hold]).validate().is_ok());
        let wrong = Stage { duration: Some(-1.0), ..timed.clone() };
        let error = Programme::new(vec![timed.clone(), wrong]).validate().unwrap_err().to_string();
        assert!(error.contains("duration of stage 2 is -1"), "{error}");
        let wrong = Stage { until: Some(Event::Load(f64::NAN)), ..timed };
        assert!(Programme::new(vec![wrong]).validate().is_err());
        assert!(Programme::new(vec![]).validate().is_err());
    }

    #[test]
    fn a_course_starts_at_the_value_reached() {
        assert_eq!(Course::Hold.resolve(3.0).after(7.0), 3.0);
        let ramp = Course::RampTo { value: 1.0, duration: 2.0 }.resolve(3.0);
        assert_eq!([0.0, 1.0, 2.0, 9.0].map(|t| ramp.after(t)), [3.0, 2.0, 1.0, 1.0]);
        assert_eq!(ramp.breaks(9.0), [2.0]);
    }
}
