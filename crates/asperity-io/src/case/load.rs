//! `[load]`: what is prescribed over time.

use asperity::{Control, Course, Event, Programme, TimeGrid};

use super::history::{Bodies, From, History, Kind};
use super::keys::*;
use super::time::{Spacing, Times};
use super::until::{self, Until};

/// What presses the bodies together.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// The prescribed quantity; with `history`. "approach" if not given in a case with [adhesion].
    pub control: Option<Control>,
    /// Its value over time, 0 before t = 0; with `control`.
    #[schemars(example = serde_json::json!({ "kind": "step", "value": "0.5 N" }))]
    history: Option<History>,
    /// The stages of the run, one after the other, in place of `control` and `history`. The run ends with the last of
    /// them or at `time.end`, whichever comes first.
    #[schemars(length(min = 1))]
    #[schemars(example = serde_json::json!([
        { "control": "load", "history": { "kind": "step", "value": "0.5 N" }, "duration": "10 s" },
        { "control": "approach", "history": { "kind": "hold" } },
    ]))]
    stages: Option<Vec<Stage>>,
}

/// A part of the run under one control.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// The prescribed quantity.
    control: Control,
    /// Its value; the time of the history starts with the stage.
    #[schemars(example = serde_json::json!({ "kind": "hold" }))]
    history: History,
    /// Longest duration of the stage. Every stage but the last needs `duration` or `until`.
    duration: Option<Time<Positive>>,
    /// The stage ends when this happens: a number of the rows crosses a value, from either side, or the contact is lost. A jump
    /// reaches only the value at which it ends; what it passes is waited for from where the number is after it. Without `duration`
    /// the event must happen before `time.end`.
    #[schemars(example = "contact-lost", example = serde_json::json!({ "approach": "2 um" }), example = serde_json::json!({ "contact_fraction": 0.1 }))]
    until: Option<Until>,
    /// The event of `until` counts only after the jump with which the stage begins, even where the jump ends at the value
    /// itself; false if not given.
    #[serde(default)]
    #[schemars(example = true)]
    after_jump: bool,
    /// Number of steps of the stage, instead of the times of `[time]`; with `duration`.
    #[schemars(example = 50)]
    steps: Option<Whole<1>>,
    /// Spacing of these steps, or "adaptive" instead of `steps`; "uniform" if not given.
    spacing: Option<Spacing>,
    /// First time of the stage after its start, if the spacing is "log" or "adaptive"; as in `[time]` if not
    /// given.
    #[schemars(example = "0.1 s")]
    first: Option<Time<Positive>>,
    /// If the spacing is "adaptive": as in `[time]`.
    #[schemars(example = 1e-3)]
    tolerance: Option<Number<Positive>>,
    /// The times of the stage after its start, with the keys of `[time]` but `scheme`; instead of the four keys above, and without
    /// a need of `duration`.
    #[schemars(example = serde_json::json!({ "times": ["1 s", "10 s"] }))]
    time: Option<Times>,
}

impl Load {
    /// What is prescribed. `first_step` is the first step of
    /// logarithmic steps to a time under a course, where the case does not say it.
    pub fn programme(
        &self,
        at: &Place<'_>,
        bodies: Bodies,
        first_step: &dyn Fn(f64, Option<&Course>) -> f64,
    ) -> Option<Programme> {
        let (at, stages) = match &self.stages {
            Some(stages) => {
                let why = "cannot be combined with `stages`; each stage has its own";
                at.without(&["control", "history"], why, "one of the two", "leave one of them out")?;
                let at = at.key("stages");
                if stages.is_empty() {
                    return at.wrong("a list of one stage at least", "");
                }
                let last = stages.len() - 1;
                let made: Vec<_> = (stages.iter().enumerate())
                    .map(|(n, stage)| stage.stage(&at.item(n), bodies, n == last, first_step))
                    .collect();
                (at, made.into_iter().collect::<Option<Vec<_>>>()?)
            }
            None => {
                let control = self
                    .control
                    .or(bodies.adhere.then_some(Control::Approach))
                    .or_else(|| at.missing("control", ""));
                let history = self.history.as_ref().or_else(|| at.missing("history", ""));
                let (control, history, at) = (control?, history?, at.key("history"));
                if let History::Hold {} = history {
                    let help = "kind = \"hold\" is only possible in a stage; to apply a load from the start use kind = \"step\"";
                    history.read(&at, Kind::of(control, bodies), help)?;
                }
                let stage = of_history(&at, control, bodies, history)?;
                (at, vec![stage])
            }
        };
        let programme = Programme::new(stages);
        at.core(programme.validate())?;
        Some(programme)
    }

    /// Whether every stage has steps of its own.
    pub fn has_own_steps(&self) -> bool {
        let own = |stage: &Stage| stage.steps.is_some() || stage.spacing.is_some() || stage.time.is_some();
        self.stages.as_ref().is_some_and(|stages| stages.iter().all(own))
    }
}

impl Stage {
    fn stage(
        &self,
        at: &Place<'_>,
        bodies: Bodies,
        last: bool,
        first_step: &dyn Fn(f64, Option<&Course>) -> f64,
    ) -> Option<asperity::Stage> {
        if !last && self.duration.is_none() && self.until.is_none() {
            return at.fault(
                "this stage never ends, so the stages after it never begin",
                "`duration` or `until`",
                "give it duration = \"10 s\", or until = { approach = \"2 um\" }, { load = \"0.1 N\" } or \"contact-lost\"",
            );
        }
        let stage = of_history(&at.key("history"), self.control, bodies, &self.history)?;
        let until = match &self.until {
            None => None,
            Some(Until::ContactLost) => Some(Event::ContactLost),
            Some(Until::Approach(value)) => Some(Event::Approach(value.get())),
            Some(Until::Pressure(value)) => Some(Event::Pressure(value.get())),
            Some(Until::Number(number, value)) => {
                let at = at.key("until").key(number.name());
                Some(Event::Number(*number, at.quantity(until::resolve(*number, value, bodies.line))?))
            }
            Some(Until::Load(value)) => {
                let load = Kind::of(Control::Load, bodies).resolve(value);
                Some(Event::Load(at.key("until").key("load").quantity(load)?))
            }
        };
        let times = self.times(at, |end| first_step(end, Some(&stage.course)))?;
        let duration = self.duration.map(Time::get);
        Some(asperity::Stage { duration, until, after_jump: self.after_jump, times, ..stage })
    }

    /// The instants of the stage, on its clock; the inner `None` where it has none of its own.
    fn times(&self, at: &Place<'_>, first_step: impl Fn(f64) -> f64) -> Option<Option<TimeGrid>> {
        let Stage { duration: end, steps, spacing, first, tolerance, .. } = *self;
        let own = Times { end, steps, spacing, first, tolerance, ..Times::default() };
        if let Some(time) = &self.time {
            let at = at.key("time");
            if !own.has_no_steps() || at.has("scheme") {
                let message = "`time` replaces `steps`, `spacing`, `first` and `tolerance` of the stage, and takes no `scheme`";
                return at.fault(message, "one of the two", "leave the others out");
            }
            return time.grid(&at, false, first_step).map(Some);
        }
        if own.has_no_steps() {
            return Some(None);
        }
        if end.is_none() && (steps.is_some() || spacing == Some(Spacing::Adaptive)) {
            return at.fault(
                "steps of a stage need its `duration` (with `until`, the latest end)",
                "a duration",
                "add duration = \"10 s\", or leave the steps to [time]",
            );
        }
        own.grid(at, false, first_step).map(Some)
    }
}

/// A stage without an end.
fn of_history(
    at: &Place<'_>,
    control: Control,
    bodies: Bodies,
    history: &History,
) -> Option<asperity::Stage> {
    let kind = Kind::of(control, bodies);
    let course = match history {
        History::Hold {} => Course::Hold,
        History::Ramp { value, from: From::Current, duration } => {
            let value = at.key("value").quantity(kind.resolve(value))?;
            Course::RampTo { value, duration: duration.get() }
        }
        _ => {
            let history = history.read(at, kind, "")?;
            at.core(history.validate())?;
            Course::Given(history)
        }
    };
    Some(asperity::Stage::new(control, course))
}
