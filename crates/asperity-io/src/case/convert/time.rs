//! The instants of the solution.

use std::ops::Range;

use asperity::{Scheme, TimeGrid};

use super::Checks;
use crate::case::quantity::Time as Duration;
use crate::case::quantity::range::Positive;
use crate::case::raw::{self, At, Spacing};
use crate::case::words;

/// More steps than this are a slip of the pen (and more than a time grid takes).
pub const MOST_STEPS: usize = 10_000_000;

pub fn times(
    checks: &mut Checks<'_, '_>,
    time: &At<raw::Time>,
    shortest: impl Fn(f64) -> f64,
) -> Option<TimeGrid> {
    let raw = &time.value;
    if let Some(times) = &raw.times {
        let mut alone = true;
        let beside = [
            ("end", raw.end.as_ref().map(|at| &at.span)),
            ("steps", raw.steps.as_ref().map(|at| &at.span)),
            ("first", raw.first.as_ref().map(|at| &at.span)),
            ("spacing", raw.spacing.as_ref().map(|at| &at.span)),
        ];
        for (key, span) in beside {
            if let Some(span) = span {
                alone = false;
                let message = format!("`{key}` does not go with `times`, which lists every instant");
                checks.fault(span, message, "one of the two", Some("leave one of them out"));
            }
        }
        return list(checks, times).filter(|_| alone);
    }
    let (end, steps) = (raw.end.as_ref(), raw.steps.as_ref());
    for (key, missing) in [("end", end.is_none()), ("steps", steps.is_none())] {
        if missing {
            checks.push(|text| words::missing_key(text, &time.span, key));
        }
    }
    let (end, steps) = (end?.value.get(), steps?);
    let count = steps.value.count();
    if count > MOST_STEPS {
        let expected = format!("{MOST_STEPS} at most");
        checks.wrong(
            &steps.span,
            &expected,
            Some("one step is one contact problem; take fewer, or spacing = \"log\""),
        );
        return None;
    }
    Some(match raw.spacing.as_ref().map_or(Spacing::Uniform, |at| at.value) {
        Spacing::Uniform => {
            if let Some(first) = &raw.first {
                let message = "`first` belongs to spacing = \"log\"".to_owned();
                checks.fault(
                    &first.span,
                    message,
                    "no such key",
                    Some("add spacing = \"log\" or leave it out"),
                );
                return None;
            }
            TimeGrid::Uniform { end, steps: count }
        }
        Spacing::Log => {
            let first = match &raw.first {
                Some(first) => before_end(checks, first, end, count)?,
                // A tenth of the shortest time of the material, but not later than a uniform step.
                None => (0.1 * shortest(end)).min(end / count as f64),
            };
            TimeGrid::Logarithmic { end, steps: count, first }
        }
    })
}

fn before_end(
    checks: &mut Checks<'_, '_>,
    first: &At<Duration<Positive>>,
    end: f64,
    steps: usize,
) -> Option<f64> {
    let value = first.value.get();
    if value < end || (steps == 1 && value <= end) {
        return Some(value);
    }
    checks.wrong(&first.span, &format!("a time before time.end, {} s", words::number(end)), None);
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

pub fn scheme(scheme: raw::Scheme) -> Scheme {
    match scheme {
        raw::Scheme::Linear => Scheme::Linear,
        raw::Scheme::Constant => Scheme::Constant,
        raw::Scheme::Direct => Scheme::Direct,
    }
}

/// Steps of the grid, without the breaks of the history.
pub fn steps(grid: &TimeGrid) -> usize {
    match grid {
        TimeGrid::Uniform { steps, .. } | TimeGrid::Logarithmic { steps, .. } => *steps,
        TimeGrid::List(times) => times.len(),
    }
}
