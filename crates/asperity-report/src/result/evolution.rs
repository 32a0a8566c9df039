//! Load over approach, its last cycle, and the work of each row.

use std::ops::RangeInclusive;

use asperity_io::cycles;
use asperity_io::readable::quantity;
use asperity_io::store::{Reader, StoreError};

use super::rows::Rows;
use super::{Options, PlotError, nameless};
use crate::figure::{Axis, Curves, Figure, Series, Style, extent};

pub(super) fn load_displacement(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let kept = shown(reader, options)?;
    let panel =
        Curves::new("", Axis::linear("approach", "m"), Axis::linear("load", reader.header().grid.units("N")));
    let [approach, load] = ["approach", "load"].map(|name| at_rows(reader, &kept, name));
    let (approach, load) = (approach?, load?);
    let whole = match ForceCurve::of(reader, &approach, &load) {
        Some(curve) => curve.drawn(panel.clone(), &approach),
        None => nameless(panel.clone(), &approach, load),
    };
    let figure = Figure::new("").with(whole);
    let Some(cycle) = last_cycle(reader, options)? else { return Ok(figure) };
    let ends = [*cycle.start(), *cycle.end()].map(|row| reader.series("time").map(|times| times[row]));
    let [from, to] = ends;
    let title = format!("Last cycle, {} to {}", super::moment(reader, from?), quantity(to?, "s"));
    let [x, y] = ["approach", "load"].map(|name| reader.series(name));
    Ok(figure.with(nameless(Curves { title, ..panel }, &x?[cycle.clone()], y?[cycle].to_vec())))
}

/// A component of the displacement that is a smaller share of the other one is none.
const STILL: f64 = 1e-6;

/// Tangential force over tangential displacement, of each component that moves.
pub(super) fn tangential_loop(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let kept = shown(reader, options)?;
    let axis = Axis::linear("tangential displacement", "m");
    let panel = Curves::new("", axis, Axis::linear("tangential force", reader.header().grid.units("N")));
    let mut curves = vec![];
    for name in ["x", "y"] {
        let [displacement, force] =
            ["displacement", "force"].map(|of| at_rows(reader, &kept, &format!("tangential_{of}_{name}")));
        curves.push((name, displacement?, force?));
    }
    let most = |values: &[f64]| values.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let far = curves.iter().map(|(_, displacement, _)| most(displacement)).fold(0.0, f64::max);
    // What moves by rounding only is no curve.
    let moves = |displacement: &[f64]| most(displacement) > STILL * far;
    let shown = curves.into_iter().filter(|(_, displacement, _)| moves(displacement));
    Ok(Figure::new("").with(shown.fold(panel, |panel, (name, displacement, force)| {
        panel.with(Series::new(format!("along {name}"), Style::Line, displacement, force))
    })))
}

/// Load over approach of surfaces that adhere: while they approach and while they part (NaN in between), and the row of the pull-off.
#[derive(serde::Serialize)]
pub(crate) struct ForceCurve {
    approaching: Vec<f64>,
    parting: Vec<f64>,
    pull_off: usize,
}

impl ForceCurve {
    /// `None` where they do not adhere, or nothing pulls.
    pub(crate) fn of(reader: &Reader, approach: &[f64], load: &[f64]) -> Option<ForceCurve> {
        reader.header().adhesion()?;
        let least = (0..load.len()).reduce(|a, b| if load[b] < load[a] { b } else { a })?;
        let mut curve = ForceCurve {
            approaching: vec![f64::NAN; load.len()],
            parting: vec![f64::NAN; load.len()],
            pull_off: least,
        };
        let mut parts = false;
        for n in 1..load.len() {
            parts = if approach[n] == approach[n - 1] { parts } else { approach[n] < approach[n - 1] };
            let branch = if parts { &mut curve.parting } else { &mut curve.approaching };
            branch[n - 1..=n].copy_from_slice(&load[n - 1..=n]);
        }
        (load[least] < 0.0).then_some(curve)
    }

    fn drawn(self, panel: Curves, approach: &[f64]) -> Curves {
        let mut only = vec![f64::NAN; approach.len()];
        let whole = if self.parting[self.pull_off].is_nan() { &self.approaching } else { &self.parting };
        only[self.pull_off] = whole[self.pull_off];
        let branches = [("approaching", self.approaching), ("parting", self.parting)];
        let branches = branches.into_iter().filter(|(_, load)| load.iter().any(|load| load.is_finite()));
        let curves = branches
            .fold(panel, |panel, (name, load)| panel.with(Series::new(name, Style::Line, approach, load)));
        curves.with(Series::new("pull-off", Style::Points, approach, only))
    }
}

/// Rows of the last cycle within the window: the last full period of a load that is a sine; else from the last but one to the last
/// peak of the load or, where this is held, of the approach. `None` where there is none.
pub(crate) fn last_cycle(
    reader: &Reader,
    options: &Options,
) -> Result<Option<RangeInclusive<usize>>, StoreError> {
    let times = reader.series("time")?;
    let shown = |time: &f64| options.shows(*time);
    let (Some(first), Some(last)) = (times.iter().position(shown), times.iter().rposition(shown)) else {
        return Ok(None);
    };
    if reader.header().axis() != asperity::Axis::Time {
        return Ok(None);
    }
    let sines = cycles::of_result(reader)?;
    let mut spans = sines.iter().rev().flat_map(|part| part.cycles.iter().rev().map(|cycle| cycle.span));
    // Ends of periods and times of rows differ by rounding errors.
    let rounding = |[from, to]: [f64; 2]| 1e-9 * (to - from);
    let whole = |span: &[f64; 2]| {
        span[0] >= times[first] - rounding(*span) && span[1] <= times[last] + rounding(*span)
    };
    if let Some(span) = spans.find(whole) {
        return Ok(Some(rows_of(&times, span, rounding(span))));
    }
    let between = |name: &str| -> Result<_, StoreError> {
        let peaks = between_peaks(&reader.series(name)?[first..=last]);
        Ok(peaks.map(|rows| rows.start() + first..=rows.end() + first))
    };
    Ok(between("load")?.or(between("approach")?))
}

/// Rows within a span of time: of a jump at its start the row after it, of one at its end the row before.
fn rows_of(times: &[f64], [start, end]: [f64; 2], rounding: f64) -> RangeInclusive<usize> {
    let after = times.partition_point(|time| *time <= start + rounding);
    let has_start = after > 0 && times[after - 1] >= start - rounding;
    let first = if has_start { after - 1 } else { after };
    let before = times.partition_point(|time| *time < end - rounding);
    let has_end = times.get(before).is_some_and(|time| *time <= end + rounding);
    first..=if has_end { before } else { before.saturating_sub(1) }
}

/// Rows from the last but one to the last peak of a course that has three of them or more. A peak is higher than the lowest value
/// on both sides, back to the next higher one, by a tenth of the range.
fn between_peaks(course: &[f64]) -> Option<RangeInclusive<usize>> {
    let ends = extent(course.iter().copied());
    // A held load differs from row to row by rounding errors.
    let moves = ends[1] - ends[0] > 1e-6 * ends[0].abs().max(ends[1].abs());
    let least = if moves { 0.1 * (ends[1] - ends[0]) } else { f64::INFINITY };
    let (mut peaks, mut top, mut bottom) = (vec![], 0, 0);
    let mut rising = true;
    for (n, value) in course.iter().enumerate() {
        if rising {
            if *value > course[top] {
                top = n;
            } else if course[top] - value > least {
                peaks.push(top);
                (rising, bottom) = (false, n);
            }
        } else if *value < course[bottom] {
            bottom = n;
        } else if value - course[bottom] > least {
            (rising, top) = (true, n);
        }
    }
    match peaks[..] {
        [.., _, from, to] => Some(from..=to),
        _ => None,
    }
}

pub(super) fn work(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let kept = shown(reader, options)?;
    let panels = super::panels::of_work(reader)?;
    let curves = panels.iter().map(|panel| panel.points(reader, &kept));
    Ok(Figure::new("").with_all(curves.collect::<Result<Vec<_>, _>>()?))
}

/// Numbers of the rows in the window.
pub(super) fn shown(reader: &Reader, options: &Options) -> Result<Vec<usize>, PlotError> {
    let times = times(reader)?;
    Rows::within(reader, options)?;
    Ok((0..times.len()).filter(|row| options.shows(times[*row])).collect())
}

/// The numbers of a series at these rows.
fn at_rows(reader: &Reader, rows: &[usize], name: &str) -> Result<Vec<f64>, StoreError> {
    let values = reader.series(name)?;
    Ok(rows.iter().filter_map(|row| values.get(*row).copied()).collect())
}

/// Times of all rows; an error where there is none yet.
pub(super) fn times(reader: &Reader) -> Result<Vec<f64>, StoreError> {
    let times = reader.series("time")?;
    if times.is_empty() { Err(reader.no_rows()) } else { Ok(times) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_begins_after_a_jump_and_ends_before_the_next() {
        let times = [0.0, 1.0, 1.0, 1.5, 2.0, 2.0, 3.0];
        assert_eq!(rows_of(&times, [1.0, 2.0], 1e-9), 2..=4);
        // No row at its ends: those inside.
        assert_eq!(rows_of(&times, [1.2, 1.8], 1e-9), 3..=3);
        assert_eq!(rows_of(&times, [2.0, 3.0], 1e-9), 5..=6);
    }

    #[test]
    fn of_three_peaks_the_last_two_bound_a_cycle() {
        let course: Vec<f64> =
            (0..=60).map(|n| (f64::from(n) * std::f64::consts::TAU / 20.0).sin()).collect();
        assert_eq!(between_peaks(&course), Some(25..=45));
        assert_eq!(between_peaks(&course[..40]), None, "two peaks");
        assert_eq!(between_peaks(&[1.0; 40]), None);
    }
}
