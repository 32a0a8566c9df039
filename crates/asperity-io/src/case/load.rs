//! `[load]`: what is prescribed over time, and whether bodies and times can follow it.

use asperity::{Control, Course, Event, Grid, Programme, TimeGrid};

use super::history::{From, History, Kind};
use super::keys::*;
use super::pair::Pair;
use super::time::{Spacing, Steps, Times};
use super::words::number;

/// What presses the bodies together.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// The prescribed quantity; with `history`.
    control: Option<Control>,
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
    /// The stage ends when this happens: a value is crossed, from either side, or the contact is lost. Without
    /// `duration` it must happen before `time.end`.
    #[schemars(example = "contact-lost", example = serde_json::json!({ "approach": "2 um" }))]
    until: Option<Until>,
    /// The event of `until` counts only after the jump with which the stage begins (as a load that relaxes after a step of
    /// the approach); false if not given.
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

/// What ends a stage.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Until {
    /// The contact is lost.
    ContactLost,
    /// The approach crosses a value.
    #[schemars(example = "2 um")]
    Approach(Length),
    /// The load crosses a value.
    #[schemars(example = "0.1 N")]
    Load(Prescribed),
    /// The mean pressure crosses a value.
    #[schemars(example = "1 MPa")]
    Pressure(Pressure<NonNegative>),
}

/// What is prescribed, and where in the case it stands.
pub struct Prescription<'c> {
    pub programme: Programme,
    /// Of each stage: its history, and the largest value of that.
    places: Vec<(Place<'c>, Place<'c>)>,
    /// Path as written and MD5 of the files that hold histories.
    pub files: Vec<(String, String)>,
    /// Where the load is described.
    pub at: Place<'c>,
}

/// A stage in SI, with the places of its history and its largest value, and the file that holds it.
type Made<'c> = (asperity::Stage, (Place<'c>, Place<'c>), Option<(String, String)>);

impl Load {
    /// What is prescribed. On a `line` loads are per length. `first_step` is the first step of logarithmic steps to a time under a
    /// course, where the case does not say it.
    pub fn prescription<'c>(
        &self,
        at: &Place<'c>,
        line: bool,
        first_step: &dyn Fn(f64, Option<&Course>) -> f64,
    ) -> Option<Prescription<'c>> {
        let (at, made) = match &self.stages {
            Some(stages) => {
                let why = "cannot be combined with `stages`; each stage has its own";
                at.without(&["control", "history"], why, "one of the two", "leave one of them out")?;
                let at = at.key("stages");
                if stages.is_empty() {
                    return at.wrong("a list of one stage at least", "");
                }
                let last = stages.len() - 1;
                let made: Vec<_> = (stages.iter().enumerate())
                    .map(|(n, stage)| stage.stage(&at.item(n), line, n == last, first_step))
                    .collect();
                (at, made.into_iter().collect::<Option<Vec<_>>>()?)
            }
            None => {
                let control = self.control.or_else(|| at.missing("control", ""));
                let history = self.history.as_ref().or_else(|| at.missing("history", ""));
                let (control, history, at) = (control?, history?, at.key("history"));
                if let History::Hold {} = history {
                    let help = "kind = \"hold\" is only possible in a stage; to apply a load from the start use kind = \"step\"";
                    history.read(&at, Kind::of(control, line), help)?;
                }
                (at.clone(), vec![of_history(&at, control, line, history)?])
            }
        };
        let mut files = vec![];
        let (stages, places) = (made.into_iter())
            .map(|(stage, place, file)| {
                files.extend(file);
                (stage, place)
            })
            .unzip();
        let programme = Programme::new(stages);
        at.core(programme.validate())?;
        Some(Prescription { programme, places, files, at })
    }

    /// Whether every stage has steps of its own.
    pub fn has_own_steps(&self) -> bool {
        let own = |stage: &Stage| stage.steps.is_some() || stage.spacing.is_some() || stage.time.is_some();
        self.stages.as_ref().is_some_and(|stages| stages.iter().all(own))
    }
}

impl Stage {
    fn stage<'c>(
        &self,
        at: &Place<'c>,
        line: bool,
        last: bool,
        first_step: &dyn Fn(f64, Option<&Course>) -> f64,
    ) -> Option<Made<'c>> {
        if !last && self.duration.is_none() && self.until.is_none() {
            return at.fault(
                "this stage never ends, so the stages after it never begin",
                "`duration` or `until`",
                "give it duration = \"10 s\", or until = { approach = \"2 um\" }, { load = \"0.1 N\" } or \"contact-lost\"",
            );
        }
        let (stage, places, file) = of_history(&at.key("history"), self.control, line, &self.history)?;
        let until = match &self.until {
            None => None,
            Some(Until::ContactLost) => Some(Event::ContactLost),
            Some(Until::Approach(value)) => Some(Event::Approach(value.get())),
            Some(Until::Pressure(value)) => Some(Event::Pressure(value.get())),
            Some(Until::Load(value)) => {
                let load = Kind::of(Control::Load, line).resolve(value);
                Some(Event::Load(at.key("until").key("load").quantity(load)?))
            }
        };
        let times = self.times(at, |end| first_step(end, Some(&stage.course)))?;
        let duration = self.duration.map(Time::get);
        let stage = asperity::Stage { duration, until, after_jump: self.after_jump, times, ..stage };
        Some((stage, places, file))
    }

    /// The instants of the stage, on its clock; the inner `None` where it has none of its own.
    fn times(&self, at: &Place<'_>, first_step: impl Fn(f64) -> f64) -> Option<Option<TimeGrid>> {
        let Stage { steps, spacing, first, tolerance, .. } = *self;
        let steps = Steps { end: "the duration of the stage", steps, spacing, first, tolerance };
        if let Some(time) = &self.time {
            let at = at.key("time");
            if !steps.none() || at.has("scheme") {
                let message = "has all keys of the steps of a stage, and no `scheme`";
                return at.fault(message, "one of the two", "leave the others out");
            }
            return time.grid(&at, false, first_step).map(Some);
        }
        if steps.none() {
            return Some(None);
        }
        if steps.are_missing() {
            return at.missing("steps", "");
        }
        let Some(duration) = self.duration else {
            return at.fault(
                "steps of a stage need its `duration` (with `until`, the latest end)",
                "a duration",
                "add duration = \"10 s\", or leave the steps to [time]",
            );
        };
        steps.grid(at, duration.get(), first_step).map(Some)
    }
}

/// A stage without an end.
fn of_history<'c>(at: &Place<'c>, control: Control, line: bool, history: &History) -> Option<Made<'c>> {
    let kind = Kind::of(control, line);
    let (course, largest, file) = match history {
        History::Hold {} => (Course::Hold, at.clone(), None),
        History::Ramp { value, from: From::Current, duration } => {
            let largest = at.key("value");
            let value = largest.quantity(kind.resolve(value))?;
            (Course::RampTo { value, duration: duration.get() }, largest, None)
        }
        _ => {
            let read = history.read(at, kind, "")?;
            at.core(read.history.validate())?;
            (Course::Given(read.history), read.largest, read.file)
        }
    };
    Some((asperity::Stage::new(control, course), (at.clone(), largest), file))
}

impl Prescription<'_> {
    /// Refuses what the bodies cannot follow.
    pub fn possible(&self, times: &TimeGrid, grid: Option<&Grid>, pair: &Pair) {
        for (n, (stage, (history, largest))) in self.programme.stages.iter().zip(&self.places).enumerate() {
            let end = stage.duration.unwrap_or(times.end()).min(times.end());
            if let Some(grid) = grid {
                bearable(largest, stage, end, grid, pair);
            }
            let unit = Kind::of(stage.control, grid.is_some_and(Grid::is_line)).unit();
            jumps(history, stage, unit, n == 0, end, pair);
        }
    }
}

/// No solution exists above hardness times area.
fn bearable(at: &Place<'_>, stage: &asperity::Stage, end: f64, grid: &Grid, pair: &Pair) -> Option<()> {
    let limit = match stage.control {
        Control::Load => pair.hardness * grid.area(),
        Control::Pressure => pair.hardness,
        Control::Approach => return None,
    };
    let largest = match &stage.course {
        Course::Given(history) => history.range(end)[1],
        Course::RampTo { value, .. } => *value,
        Course::Hold => return None,
    };
    // Equality within rounding is the limit itself, which has a solution.
    if largest <= limit * (1.0 + 1e-12) {
        return None;
    }
    let unit = Kind::of(stage.control, grid.is_line()).unit();
    let [reached, limit, hardness] = [largest, limit, pair.hardness].map(number);
    let area = match stage.control {
        Control::Load if grid.is_line() => format!(" times the length {} m", number(grid.area())),
        Control::Load => format!(" times the area {} m^2", number(grid.area())),
        _ => String::new(),
    };
    let message = format!(
        "the history reaches {reached} {unit}, but the bodies can carry at most {limit} {unit}, the hardness \
         {hardness} Pa{area}"
    );
    let help = "lower the load, raise the hardness or enlarge the domain";
    at.fault(message, &format!("{limit} {unit} at most"), help)
}

/// Without instantaneous compliance there is no solution right after a jump.
fn jumps(
    at: &Place<'_>,
    stage: &asperity::Stage,
    unit: &str,
    first: bool,
    end: f64,
    pair: &Pair,
) -> Option<()> {
    let (Course::Given(history), false) = (&stage.course, pair.instantaneous() > 0.0) else { return None };
    // What a later stage starts from is known only as the run goes.
    let instants = first.then_some(0.0).into_iter().chain(history.breaks(end));
    let jump = instants.map(|t| (t, history.before(t), history.after(t))).find(|(_, b, a)| a != b);
    let (t, before, after) = jump?;
    let [t, before, after] = [t, before, after].map(number);
    let message = format!(
        "the history jumps from {before} to {after} {unit} at t = {t} s, but the bodies have no instantaneous \
         compliance (Kelvin-Voigt), so there is no solution right after the jump"
    );
    let help = "use a ramp, or a material with an instantaneous modulus (zener, prony)";
    at.fault(message, "a history without jumps", help)
}
