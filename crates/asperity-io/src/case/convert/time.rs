//! The instants of the solution.

use std::ops::Range;

use asperity::History;

use super::Checks;
use super::body::Pair;
use crate::case::march::{Scheme, TimeGrid};
use crate::case::plan::{Output, Rows, SAME};
use crate::case::quantity::Time as Duration;
use crate::case::quantity::range::Positive;
use crate::case::raw::{self, At, Spacing};
use crate::case::words;

/// The instants of the solution.
pub struct Times {
    pub grid: TimeGrid,
    pub end: f64,
}

impl Times {
    /// Steps of the grid, without the breaks of the history.
    pub fn steps(&self) -> usize {
        match &self.grid {
            TimeGrid::Uniform { steps, .. } | TimeGrid::Logarithmic { steps, .. } => *steps,
            TimeGrid::List(times) => times.len(),
        }
    }
}

/// More steps than this are a slip of the pen: one solve a millisecond takes three hours.
pub const MOST_STEPS: usize = 10_000_000;

pub fn times(checks: &mut Checks<'_, '_>, time: &At<raw::Time>, pair: Option<&Pair>) -> Option<Times> {
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
    let grid = match raw.spacing.as_ref().map_or(Spacing::Uniform, |at| at.value) {
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
                None => first_instant(end, count, pair?),
            };
            TimeGrid::Logarithmic { end, steps: count, first }
        }
    };
    Some(Times { grid, end })
}

/// A tenth of the shortest retardation time, but not later than a uniform step.
fn first_instant(end: f64, steps: usize, pair: &Pair) -> f64 {
    let uniform = end / steps as f64;
    pair.creep.terms.iter().map(|term| 0.1 * term.retardation_time).fold(uniform, f64::min)
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

fn list(checks: &mut Checks<'_, '_>, times: &At<Vec<At<Duration<Positive>>>>) -> Option<Times> {
    let Some(last) = times.value.last() else {
        checks.wrong(&times.span, "a list of one time at least", None);
        return None;
    };
    let instants = increasing(checks, &times.value, |time| time.get())?;
    Some(Times { grid: TimeGrid::List(instants), end: last.value.get() })
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

/// The times, with those at which fields are stored among them.
pub fn with(times: Times, output: Option<&Output>) -> Times {
    let Some(Rows::At(stored)) = output.map(|output| &output.rows) else { return times };
    let mut instants = instants(&times.grid);
    let there = |t: f64| {
        let after = instants.partition_point(|i| *i < t * (1.0 - SAME));
        t == 0.0 || instants.get(after).is_some_and(|i| *i <= t * (1.0 + SAME))
    };
    let more: Vec<f64> = stored.iter().copied().filter(|t| !there(*t)).collect();
    if more.is_empty() {
        return times;
    }
    instants.extend(more);
    instants.sort_by(f64::total_cmp);
    Times { grid: TimeGrid::List(instants), end: times.end }
}

/// The rows of the result: 0+, one per step, one more per jump.
pub fn rows(times: &Times, history: &History) -> usize {
    let breaks = history.breaks(times.end);
    let extra = breaks.iter().filter(|t| !is_instant(&times.grid, **t)).count();
    let jump = |t: &&f64| history.before(**t) != history.after(**t);
    let jumps = breaks.iter().chain([&times.end]).filter(jump).count();
    1 + times.steps() + extra + jumps
}

/// Whether the grid has an instant at t, 0 < t < end.
fn is_instant(grid: &TimeGrid, t: f64) -> bool {
    let near = |instant: f64| (instant - t).abs() <= SAME * t;
    match grid {
        TimeGrid::Uniform { end, steps } => {
            let step = end / *steps as f64;
            near((t / step).round() * step)
        }
        TimeGrid::Logarithmic { .. } => instants(grid).into_iter().any(near),
        TimeGrid::List(times) => {
            let after = times.partition_point(|instant| *instant < t * (1.0 - SAME));
            times.get(after).is_some_and(|instant| near(*instant))
        }
    }
}

fn instants(grid: &TimeGrid) -> Vec<f64> {
    match grid {
        TimeGrid::Uniform { end, steps } => {
            (1..=*steps).map(|n| if n == *steps { *end } else { end * n as f64 / *steps as f64 }).collect()
        }
        TimeGrid::Logarithmic { end, steps, first } => {
            let ratio = end / first;
            let power = |n: usize| n as f64 / (*steps - 1).max(1) as f64;
            (0..*steps).map(|n| if n + 1 == *steps { *end } else { first * ratio.powf(power(n)) }).collect()
        }
        TimeGrid::List(times) => times.clone(),
    }
}
