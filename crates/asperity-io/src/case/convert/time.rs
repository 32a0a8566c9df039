//! The instants of the solution.

use std::ops::Range;

use asperity::TimeGrid;
use asperity::load::Course;

use super::Checks;
use crate::case::quantity::range::Positive;
use crate::case::quantity::{Number, Time as Duration, Whole};
use crate::case::raw::{self, At, Spacing};
use crate::case::words;

/// Tolerance of adaptive steps, where none is given.
const TOLERANCE: f64 = 1e-3;
/// The first of adaptive steps is no longer than this share of the end, where nothing is said.
const FIRST: f64 = 1e-3;
/// Adaptive steps of a usual run (docs/verification.md).
pub const USUAL_STEPS: usize = 100;

/// More steps than this are a slip of the pen (and more than a time grid takes).
pub const MOST_STEPS: usize = 10_000_000;

/// The first step of a logarithmic grid, where none is given \[s\]: a tenth of the shortest time of the material, and a twentieth
/// of what comes before the first break of the history.
pub fn first_step(material: f64, course: Option<&Course>) -> f64 {
    (0.1 * material).min(0.05 * course.and_then(Course::first_break).unwrap_or(f64::INFINITY))
}

/// The instants of the run; `own` where every stage of the load has its own.
pub fn times(
    checks: &mut Checks<'_, '_>,
    time: &At<raw::Time>,
    own: bool,
    first_step: impl Fn(f64) -> f64,
) -> Option<TimeGrid> {
    let raw = &time.value;
    if let Some(times) = &raw.times {
        let mut alone = true;
        let beside = [
            ("end", raw.end.as_ref().map(|at| &at.span)),
            ("steps", raw.steps.as_ref().map(|at| &at.span)),
            ("first", raw.first.as_ref().map(|at| &at.span)),
            ("spacing", raw.spacing.as_ref().map(|at| &at.span)),
            ("tolerance", raw.tolerance.as_ref().map(|at| &at.span)),
        ];
        for (key, span) in beside {
            if let Some(span) = span {
                alone = false;
                let message = format!("`{key}` cannot be combined with `times`, which lists every time");
                checks.fault(span, message, "one of the two", Some("leave one of them out"));
            }
        }
        return list(checks, times).filter(|_| alone);
    }
    let steps = Steps {
        end: "time.end",
        steps: raw.steps.as_ref(),
        spacing: raw.spacing.as_ref(),
        first: raw.first.as_ref(),
        tolerance: raw.tolerance.as_ref(),
    };
    let unspecified = own && steps.none();
    let missing_steps = !steps.adaptive() && raw.steps.is_none() && !unspecified;
    for (key, missing) in [("end", raw.end.is_none()), ("steps", missing_steps)] {
        if missing {
            checks.push(|text| words::missing_key(text, &time.span, key));
        }
    }
    let end = raw.end.as_ref()?.value.get();
    if unspecified { Some(TimeGrid::List(vec![end])) } else { steps.grid(checks, end, first_step) }
}

/// The instants of a stage, on its clock; the inner `None` where it has none of its own.
pub fn of_stage(
    checks: &mut Checks<'_, '_>,
    stage: &At<raw::Stage>,
    first_step: impl Fn(f64) -> f64,
) -> Option<Option<TimeGrid>> {
    let raw = &stage.value;
    let steps = Steps {
        end: "the duration of the stage",
        steps: raw.steps.as_ref(),
        spacing: raw.spacing.as_ref(),
        first: raw.first.as_ref(),
        tolerance: raw.tolerance.as_ref(),
    };
    if let Some(time) = &raw.time {
        if !steps.none() || time.value.scheme.is_some() {
            let message = "`time` has all keys of the steps of a stage, and no `scheme`".to_owned();
            checks.fault(&time.span, message, "one of the two", Some("leave the others out"));
            return None;
        }
        return times(checks, time, false, first_step).map(Some);
    }
    if steps.none() {
        return Some(None);
    }
    if !steps.adaptive() && raw.steps.is_none() {
        checks.push(|text| words::missing_key(text, &stage.span, "steps"));
        return None;
    }
    let Some(duration) = &raw.duration else {
        let message = "steps of a stage need its `duration` (with `until`, the latest end)".to_owned();
        checks.fault(
            &stage.span,
            message,
            "a duration",
            Some("add duration = \"10 s\", or leave the steps to [time]"),
        );
        return None;
    };
    steps.grid(checks, duration.value.get(), first_step).map(Some)
}

/// Keys that say how long the steps are.
#[derive(Clone, Copy)]
struct Steps<'a> {
    /// The key of the end.
    end: &'static str,
    steps: Option<&'a At<Whole<1>>>,
    spacing: Option<&'a At<Spacing>>,
    first: Option<&'a At<Duration<Positive>>>,
    tolerance: Option<&'a At<Number<Positive>>>,
}

impl Steps<'_> {
    fn none(&self) -> bool {
        self.steps.is_none() && self.spacing.is_none() && self.first.is_none() && self.tolerance.is_none()
    }

    fn adaptive(&self) -> bool {
        self.spacing.is_some_and(|at| at.value == Spacing::Adaptive)
    }

    /// The grid to `end`.
    fn grid(
        self,
        checks: &mut Checks<'_, '_>,
        end: f64,
        first_step: impl Fn(f64) -> f64,
    ) -> Option<TimeGrid> {
        if self.adaptive() {
            return self.adaptive_grid(checks, end);
        }
        if let Some(tolerance) = self.tolerance {
            let message = "`tolerance` belongs to spacing = \"adaptive\"".to_owned();
            let help = "add spacing = \"adaptive\" in place of steps, or leave it out";
            checks.fault(&tolerance.span, message, "no such key", Some(help));
            return None;
        }
        let steps = self.steps?;
        let count = steps.value.count();
        if count > MOST_STEPS {
            let expected = format!("{MOST_STEPS} at most");
            let help = "one step is one contact problem; use fewer, or spacing = \"log\"";
            checks.wrong(&steps.span, &expected, Some(help));
            return None;
        }
        Some(match self.spacing.map_or(Spacing::Uniform, |at| at.value) {
            Spacing::Log => {
                let first = match self.first {
                    Some(first) => before_end(checks, first, self.end, end, count)?,
                    None => first_step(end).min(end / count as f64),
                };
                TimeGrid::Logarithmic { end, steps: count, first }
            }
            Spacing::Uniform | Spacing::Adaptive => {
                if let Some(first) = self.first {
                    let message = "`first` belongs to spacing = \"log\" or \"adaptive\"".to_owned();
                    let help = "add spacing = \"log\" or leave it out";
                    checks.fault(&first.span, message, "no such key", Some(help));
                    return None;
                }
                TimeGrid::Uniform { end, steps: count }
            }
        })
    }

    fn adaptive_grid(self, checks: &mut Checks<'_, '_>, end: f64) -> Option<TimeGrid> {
        if let Some(steps) = self.steps {
            let message =
                "`steps` cannot be combined with spacing = \"adaptive\", which determines their number"
                    .to_owned();
            let help = "omit `steps` and set `tolerance`";
            checks.fault(&steps.span, message, "one of the two", Some(help));
            return None;
        }
        let first = match self.first {
            Some(first) => before_end(checks, first, self.end, end, 2)?,
            None => FIRST * end,
        };
        let tolerance = self.tolerance.map_or(TOLERANCE, |at| at.value.get());
        let grid = TimeGrid::Adaptive { end, tolerance, first };
        let place = self.tolerance.map(|at| &at.span).or(self.spacing.map(|at| &at.span))?;
        checks.core(place, grid.validate().map(|()| grid))
    }
}

fn before_end(
    checks: &mut Checks<'_, '_>,
    first: &At<Duration<Positive>>,
    key: &str,
    end: f64,
    steps: usize,
) -> Option<f64> {
    let value = first.value.get();
    if value < end || (steps == 1 && value <= end) {
        return Some(value);
    }
    checks.wrong(&first.span, &format!("a time before {key}, {} s", words::number(end)), None);
    None
}

fn list(checks: &mut Checks<'_, '_>, times: &At<Vec<At<Duration<Positive>>>>) -> Option<TimeGrid> {
    if times.value.is_empty() {
        checks.wrong(&times.span, "a list of one time at least", None);
        return None;
    }
    increasing(checks, &times.value, |time| time.get()).map(TimeGrid::List)
}

/// The values, where each is larger than the one before.
pub fn increasing<T>(
    checks: &mut Checks<'_, '_>,
    times: &[At<T>],
    value: impl Fn(&T) -> f64,
) -> Option<Vec<f64>> {
    let instants: Vec<f64> = times.iter().map(|at| value(&at.value)).collect();
    let disorder = instants.windows(2).position(|pair| pair[1] <= pair[0]);
    let Some(n) = disorder else { return Some(instants) };
    let span: &Range<usize> = &times.get(n + 1)?.span;
    let expected = format!("later than the time before it, {} s", words::number(instants[n]));
    checks.wrong(span, &expected, Some("list the times in increasing order, each once"));
    None
}

/// Steps of the grid, without the breaks of the history; of an adaptive one about.
pub fn steps(grid: &TimeGrid) -> usize {
    match grid {
        TimeGrid::Uniform { steps, .. } | TimeGrid::Logarithmic { steps, .. } => *steps,
        TimeGrid::List(times) => times.len(),
        TimeGrid::Adaptive { .. } => USUAL_STEPS,
    }
}
