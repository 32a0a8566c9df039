//! The times at which the steps of a stage must end, and the rows of a run as far as they are known before it.

use super::{Instant, SAME, TimeGrid};
use crate::load::{Control, Course, History, Programme};

/// When the control switches, values that agree to this fraction are equal: the solver does not know the value reached more
/// accurately.
const AGREE: f64 = 1e-5;

/// A time at which a step must end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stop {
    /// In the time of the run \[s\].
    pub time: f64,
    /// The prescribed value, before a jump.
    pub before: f64,
    /// The value after a jump.
    pub after: Option<f64>,
    /// The prescribed value or the temperature has a kink here.
    pub bend: bool,
}

/// The stops of a stage that starts at `start` and lasts to `end`, of a run that lasts to `run_end` \[s\].
pub(crate) struct Span<'a> {
    pub history: &'a History,
    pub start: f64,
    pub end: f64,
    pub run_end: f64,
    /// Times of the run and additional times, in the time of the run.
    pub include: &'a [f64],
    /// Times at which the temperature has a kink.
    pub kinks: &'a [f64],
    /// Whether the extrema of the history are stops too: otherwise an event between two steps could be missed.
    pub turns: bool,
}

/// A time in the run, the time in the stage, and its kind.
#[derive(Clone, Copy)]
struct Mark {
    time: f64,
    inside: f64,
    is_break: bool,
    bend: bool,
}

/// The times at which the steps of a stage must end, in order. `own` is the grid of the stage, in the time of the stage.
pub(crate) fn stops(span: &Span<'_>, own: Option<&TimeGrid>, grid: &TimeGrid) -> Vec<Stop> {
    let Span { history, start, end, run_end, .. } = *span;
    let same = SAME * run_end;
    let breaks = history.breaks((end - start) * (1.0 + SAME));
    let mut marks: Vec<Mark> = Vec::new();
    marks.extend(breaks.iter().map(|b| Mark { time: start + b, inside: *b, is_break: true, bend: true }));
    let outer = |time: f64, bend: bool| Mark { time, inside: time - start, is_break: false, bend };
    if span.turns {
        marks.extend(history.extremes(end - start).into_iter().map(|t| outer(start + t, false)));
    }
    marks.extend(span.kinks.iter().map(|t| outer(*t, true)));
    marks.extend(span.include.iter().map(|t| outer(*t, false)));
    match own {
        Some(own) => marks.extend(own.times().into_iter().map(|t| outer(start + t, false))),
        None => marks.extend(grid.times().into_iter().map(|t| outer(t, false))),
    }
    let first = if start > 0.0 { start + same } else { 0.0 };
    marks.retain(|m| m.time > first && (m.is_break || m.time <= end));
    marks.push(outer(end, false));
    // Stable: if a grid time coincides with a kink or jump, the latter comes first and is kept.
    marks.sort_by(|a, b| a.time.total_cmp(&b.time));
    let mut merged: Vec<Mark> = Vec::with_capacity(marks.len());
    for mark in marks {
        match merged.last_mut() {
            Some(last) if mark.time - last.time <= same => {
                let bend = last.bend || mark.bend;
                if mark.is_break {
                    *last = mark;
                }
                last.bend = bend;
            }
            _ => merged.push(mark),
        }
    }
    let stop = |mark: Mark| {
        let (before, after) = (history.before(mark.inside), history.after(mark.inside));
        let jumps = (after - before).abs() > 1e-12 * after.abs().max(before.abs());
        // A stage has no jump at its end: the next stage determines the value after it.
        let after = (jumps && mark.time < end - same.min(0.5 * (end - start))).then_some(after);
        Stop { time: mark.time, before, after, bend: mark.bend }
    };
    merged.into_iter().map(stop).collect()
}

/// Whether a quantity with the value `reached` can follow a history that begins at `value` without a jump.
pub(crate) fn agree(value: f64, reached: f64) -> bool {
    (value - reached).abs() <= AGREE * value.abs().max(reached.abs())
}

/// The rows of a run before it is solved.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The rows. If they are not [`exact`](Self::exact), they assume that every stage has its full length and that an event
    /// occurs immediately for the stages after it, and contain only the first adaptive step after each kink or jump; their times
    /// may decrease.
    pub instants: Vec<Instant>,
    /// Whether the run has exactly these rows. (A value is NaN if it only becomes known during the run.)
    pub exact: bool,
}

impl Plan {
    /// Length of the shortest step, and the last time \[s\].
    pub fn window(&self) -> [f64; 2] {
        let steps = self.instants.iter().map(|i| i.dt).filter(|dt| *dt > 0.0);
        let ends = self.instants.iter().map(|i| i.time);
        [steps.fold(f64::INFINITY, f64::min), ends.fold(0.0, f64::max)]
    }
}

impl Programme {
    /// The rows of a run with this grid: t = 0+, then every time of the grid, every kink or jump of a history, every time of
    /// `include`, and the ends of the stages. A jump adds a row of zero length after the row just before it.
    pub fn plan(&self, grid: &TimeGrid, include: &[f64]) -> Plan {
        let run_end = grid.end();
        let mut plan = Plan { instants: vec![], exact: true };
        let (mut start, mut end_value): (f64, Option<(Control, f64)>) = (0.0, None);
        for (n, stage) in self.stages.iter().enumerate() {
            if n > 0 && start >= run_end * (1.0 - SAME) {
                break;
            }
            let reached = match end_value {
                _ if n == 0 => 0.0,
                Some((control, value)) if control == stage.control => value,
                _ => f64::NAN,
            };
            let history = stage.course.resolve(reached);
            let first = history.after(0.0);
            let instant =
                |time, dt, value, jump| Instant { time, dt, value, jump, control: stage.control, stage: n };
            let given = matches!(stage.course, Course::Given(_));
            if n == 0 || (given && !agree(first, reached)) {
                plan.exact &= n == 0 || !reached.is_nan();
                plan.instants.push(instant(start, 0.0, first, true));
            }
            let own = stage.times.as_ref();
            let end = stage.duration.map_or(run_end, |duration| (start + duration).min(run_end));
            let turns = stage.until.is_some();
            let span = Span { history: &history, start, end, run_end, include, kinks: &[], turns };
            let mut last = start;
            for (k, stop) in stops(&span, own, grid).into_iter().enumerate() {
                if let TimeGrid::Adaptive { first, .. } = own.unwrap_or(grid)
                    && (k == 0 || stop.bend)
                    && last + first < stop.time
                {
                    // Steps may be shorter than the largest first step.
                    let soon = 0.1 * first;
                    plan.instants.push(instant(last + soon, soon, f64::NAN, false));
                }
                plan.instants.push(instant(stop.time, stop.time - last, stop.before, false));
                if let Some(after) = stop.after {
                    plan.instants.push(instant(stop.time, 0.0, after, true));
                }
                last = stop.time;
            }
            plan.exact &= stage.until.is_none() && !own.unwrap_or(grid).is_adaptive();
            end_value = stage.until.is_none().then(|| (stage.control, history.before(end - start)));
            start = if stage.until.is_some() { start } else { end };
        }
        plan
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::{Event, Loading, Stage};

    fn rows(history: History, grid: TimeGrid, include: &[f64]) -> Vec<Instant> {
        let plan = Programme::from(Loading { control: Control::Load, history }).plan(&grid, include);
        assert!(plan.exact);
        plan.instants
    }

    #[test]
    fn breaks_and_jumps_are_rows() {
        let history = History::Table { points: vec![(0.0, 1.0), (2.5, 1.0), (2.5, 3.0), (4.0, 0.0)] };
        let rows = rows(history, TimeGrid::Uniform { end: 5.0, steps: 5 }, &[0.5]);
        let shown: Vec<_> = rows.iter().map(|r| (r.time, r.value, r.jump)).collect();
        assert_eq!(
            shown,
            [
                (0.0, 1.0, true),
                (0.5, 1.0, false),
                (1.0, 1.0, false),
                (2.0, 1.0, false),
                (2.5, 1.0, false),
                (2.5, 3.0, true),
                (3.0, 2.0, false),
                (4.0, 0.0, false),
                (5.0, 0.0, false),
            ]
        );
    }

    #[test]
    fn a_break_on_the_grid_is_one_row() {
        let history = History::Triangle { peak: 1.0, rise: 0.3, fall: 0.7 };
        let rows = rows(history, TimeGrid::Uniform { end: 1.0, steps: 10 }, &[]);
        assert_eq!(rows.len(), 11);
        assert_eq!(rows[3].time, 0.3);
        assert_eq!(rows[10].value, 0.0);
    }

    #[test]
    fn stages_follow_each_other() {
        // Pressed to 1 in 1 s, held for 1.5 s with its own times, then a jump to 3 until the end of the run.
        let ramp = Stage {
            duration: Some(1.0),
            ..Stage::new(Control::Load, History::Ramp { value: 1.0, duration: 1.0 })
        };
        let hold = Stage {
            duration: Some(1.5),
            times: Some(TimeGrid::Logarithmic { end: 1.5, steps: 2, first: 0.1 }),
            ..Stage::new(Control::Load, Course::Hold)
        };
        let jump = Stage::new(Control::Load, History::Step { value: 3.0 });
        let programme = Programme::new(vec![ramp.clone(), hold.clone(), jump]);
        let grid = TimeGrid::Uniform { end: 4.0, steps: 8 };
        let plan = programme.plan(&grid, &[]);
        assert!(plan.exact);
        let shown: Vec<_> = plan.instants.iter().map(|r| (r.time, r.value, r.stage)).collect();
        let wanted = [
            (0.0, 0.0, 0),
            (0.5, 0.5, 0),
            (1.0, 1.0, 0),
            (1.1, 1.0, 1),
            (2.5, 1.0, 1),
            (2.5, 3.0, 2),
            (3.0, 3.0, 2),
            (3.5, 3.0, 2),
            (4.0, 3.0, 2),
        ];
        assert_eq!(shown, wanted);
        // When the control switches, the value only becomes known during the run; its rows are known.
        let approach = Stage { control: Control::Approach, ..hold.clone() };
        let plan = Programme::new(vec![ramp.clone(), approach]).plan(&grid, &[]);
        assert!(plan.exact && plan.instants[4].value.is_nan());
        assert_eq!(plan.instants.last().map(|i| i.time), Some(2.5));
        // This does not hold with an event, or if a history may begin with a jump.
        let event = Stage { until: Some(Event::ContactLost), ..ramp.clone() };
        assert!(!Programme::new(vec![event, hold.clone()]).plan(&grid, &[]).exact);
        let other = Stage::new(Control::Approach, History::Step { value: 1.0 });
        assert!(!Programme::new(vec![ramp, other]).plan(&grid, &[]).exact);
    }

    #[test]
    fn the_window_of_adaptive_steps_begins_with_a_tenth_of_the_longest_first() {
        let history = History::Ramp { value: 1.0, duration: 1.0 };
        let grid = TimeGrid::Adaptive { end: 8.0, tolerance: 1e-3, first: 1e-4 };
        let plan = Programme::from(Loading { control: Control::Load, history }).plan(&grid, &[]);
        assert!(!plan.exact);
        assert_eq!(plan.window(), [0.1 * 1e-4, 8.0]);
    }
}
