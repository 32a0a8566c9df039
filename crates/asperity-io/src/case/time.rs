//! `[time]`: the instants of the solution.

use asperity::load::Course;
use asperity::{Scheme, TimeGrid};

use super::keys::*;
use super::words;

/// Tolerance of adaptive steps, where none is given.
const TOLERANCE: f64 = 1e-3;
/// The first of adaptive steps is no longer than this share of the end, where nothing is said.
const FIRST: f64 = 1e-3;
/// Adaptive steps of a usual run (docs/verification.md).
pub const USUAL_STEPS: usize = 100;

/// The times of the solution.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Instants")]
pub struct Times {
    /// End of the run; with `steps`, spacing = "adaptive", or stages that have steps of their own.
    #[schemars(example = "500 s")]
    pub end: Option<Time<Positive>>,
    /// Number of steps from 0 to `end`; breaks and jumps of the history are additional steps.
    #[schemars(example = 100)]
    pub steps: Option<Whole<1>>,
    /// Spacing of the steps; "uniform" if not given.
    pub spacing: Option<Spacing>,
    /// First time after 0 if the spacing is "log"; if not given, a tenth of the shortest retardation time (of fractional
    /// models and fitted curves: 1e-4 of the end), but not later than a uniform step or a twentieth of the first ramp of the
    /// history. If the spacing is "adaptive", the largest first step after 0 and after each break or jump; if not given, a thousandth of the end.
    #[schemars(example = "0.1 s")]
    pub first: Option<Time<Positive>>,
    /// If the spacing is "adaptive": the largest error that the steps may leave, relative to the stress; 1e-3 if not
    /// given.
    #[schemars(example = 1e-3)]
    pub tolerance: Option<Number<Positive>>,
    /// List of the times after 0, instead of `end` and `steps`.
    #[schemars(example = ("1 s", "10 s", "100 s"))]
    pub times: Option<Vec<Time<Positive>>>,
    /// How the pressure varies over a step; "linear" if not given.
    #[serde(default)]
    pub scheme: Scheme,
}

/// Spacing of the steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// Equal steps.
    Uniform,
    /// Steps that grow by a constant factor.
    Log,
    /// The length of each step follows its error.
    Adaptive,
}

/// The first step of a logarithmic grid, where none is given \[s\]: a tenth of the shortest time of the material, and a twentieth
/// of what comes before the first break of the history.
pub fn first_step(material: f64, course: Option<&Course>) -> f64 {
    (0.1 * material).min(0.05 * course.and_then(Course::first_break).unwrap_or(f64::INFINITY))
}

/// Steps of the grid, without the breaks of the history; of an adaptive one about.
pub fn steps(grid: &TimeGrid) -> usize {
    match grid {
        TimeGrid::Uniform { steps, .. } | TimeGrid::Logarithmic { steps, .. } => *steps,
        TimeGrid::List(times) => times.len(),
        TimeGrid::Adaptive { .. } => USUAL_STEPS,
    }
}

impl Times {
    /// Whether nothing says how long the steps are.
    pub fn has_no_steps(&self) -> bool {
        self.steps.is_none() && self.spacing.is_none() && self.first.is_none() && self.tolerance.is_none()
    }

    /// The instants of the run or stage whose keys are at `at`; `own` where every stage of the load has its own.
    pub fn grid(&self, at: &Place<'_>, own: bool, first_step: impl Fn(f64) -> f64) -> Option<TimeGrid> {
        if let Some(times) = &self.times {
            let keys = ["end", "steps", "first", "spacing", "tolerance"];
            let why = "cannot be combined with `times`, which lists every time";
            let alone = at.without(&keys, why, "one of the two", "leave one of them out");
            let at = at.key("times");
            if times.is_empty() {
                return at.wrong("a list of at least one time", "");
            }
            let times = at.increasing(times.iter().map(|time| time.get()));
            return alone.and(times).map(TimeGrid::List);
        }
        let unspecified = own && self.has_no_steps();
        let end = self.end.or_else(|| at.missing("end", ""));
        if self.spacing != Some(Spacing::Adaptive) && self.steps.is_none() && !unspecified {
            return at.missing("steps", "");
        }
        let end = end?.get();
        if unspecified { Some(TimeGrid::List(vec![end])) } else { self.steps(at, end, first_step) }
    }

    /// The steps to `end`, of the keys of the table at `at`.
    fn steps(&self, at: &Place<'_>, end: f64, first_step: impl Fn(f64) -> f64) -> Option<TimeGrid> {
        let spacing = self.spacing.unwrap_or(Spacing::Uniform);
        let first = self.first.map(Time::get);
        if spacing == Spacing::Adaptive {
            let why = "cannot be combined with spacing = \"adaptive\", which determines their number";
            // --set cannot take a key away.
            let help = format!(
                "delete `steps` in the case and set `tolerance`; with --set write the whole table: \
                 --set 'time={{ end = \"{} s\", spacing = \"adaptive\" }}'",
                words::number(end)
            );
            at.without(&["steps"], why, "one of the two", &help)?;
            self.before_end(at, end, 2)?;
            let tolerance = self.tolerance.map_or(TOLERANCE, Number::get);
            let grid = TimeGrid::Adaptive { end, tolerance, first: first.unwrap_or(FIRST * end) };
            return at.core(grid.validate().map(|()| grid));
        }
        let help = "add spacing = \"adaptive\" in place of `steps`, or leave it out";
        at.without(&["tolerance"], "belongs to spacing = \"adaptive\"", "no such key", help)?;
        let steps = self.steps?.count();
        let grid = match spacing {
            Spacing::Log => {
                self.before_end(at, end, steps)?;
                let first = first.unwrap_or_else(|| first_step(end).min(end / steps as f64));
                TimeGrid::Logarithmic { end, steps, first }
            }
            Spacing::Uniform | Spacing::Adaptive => {
                let why = "belongs to spacing = \"log\" or \"adaptive\"";
                at.without(&["first"], why, "no such key", "add spacing = \"log\" or leave it out")?;
                TimeGrid::Uniform { end, steps }
            }
        };
        at.core(grid.validate().map(|()| grid))
    }

    /// Whether `first` lies before the end.
    fn before_end(&self, at: &Place<'_>, end: f64, steps: usize) -> Option<()> {
        match self.first.map(Time::get) {
            Some(first) if !(first < end || (steps == 1 && first <= end)) => {
                at.key("first").wrong(format!("a time before the end, {} s", words::number(end)), "")
            }
            _ => Some(()),
        }
    }
}
