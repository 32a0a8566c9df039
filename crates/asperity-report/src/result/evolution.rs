//! What changes over the rows.

use std::ops::RangeInclusive;

use asperity::quantities::{Panel, Quantity};
use asperity_io::cycles;
use asperity_io::readable::quantity;
use asperity_io::store::{Reader, StoreError};

use super::rows::Rows;
use super::{Options, PlotError, nameless};
use crate::figure::{Axis, Curves, Figure, Series, Style};

pub(super) fn evolution(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let time = times(reader)?;
    let rows = Rows::within(reader, options)?;
    let axis = || rows.axis(options.log);
    let line = |name: &str, series: &str| -> Result<Series, StoreError> {
        Ok(Series::new(name, Style::Line, time.clone(), reader.series(series)?))
    };
    let grid = &reader.header().grid;
    let mut area = match grid.is_line() {
        true => Curves::new("Contact length", axis(), Axis::linear("contact length", "m"))
            .with(line("", "contact_area")?),
        false => Curves::new("Contact area", axis(), Axis::linear("contact area", "m2"))
            .with(line("counted", "contact_area")?)
            .with(line("corrected", "contact_area_corrected")?),
    };
    if reader.series("capped_area")?.iter().any(|area| *area > 0.0) {
        area = area.with(line("at the hardness", "capped_area")?);
    }
    let approach = Curves::new("Approach", axis(), Axis::linear("approach", "m"));
    let load = Curves::new("Load", axis(), Axis::linear("load", grid.units("N")));
    let loads = reader.series("load")?;
    let over_contact: Vec<f64> =
        loads.iter().zip(reader.series("contact_area")?).map(|(load, area)| load / area).collect();
    let pressure = Curves::new("Pressure", axis(), Axis::linear("pressure", "Pa"))
        .with(line("nominal mean", "mean_pressure")?)
        .with(line("largest", "max_pressure")?)
        .with(Series::new("mean over the contact", Style::Line, time.clone(), over_contact));
    let figure = Figure::new("")
        .with(area)
        .with(nameless(approach, &time, reader.series("approach")?))
        .with(nameless(load, &time, reader.series("load")?))
        .with(pressure);
    let temperature = super::temperature::panel(reader, rows, options.log)?;
    Ok(temperature.into_iter().fold(figure, Figure::with))
}

/// A panel of quantities over time.
pub(crate) struct QuantityPanel {
    pub(crate) title: &'static str,
    pub(crate) label: &'static str,
    pub(crate) units: &'static str,
    /// Name in the legend and name of the series.
    pub(crate) lines: Vec<(&'static str, &'static str)>,
    /// Names of the values 0, 1, 2 ... of a quantity that is a state; empty for a number.
    pub(crate) states: &'static [&'static str],
}

/// Directions in which something percolates, by number.
const DIRECTIONS: [&str; 4] = ["none", "x", "y", "x and y"];

/// The quantities with one number per row that were asked for: one panel for all energies, one for the areas of spots,
/// one for each other.
pub(crate) fn quantity_panels(reader: &Reader) -> Vec<QuantityPanel> {
    let mut panels: Vec<QuantityPanel> = vec![];
    let scalars = reader.scalars();
    let line = reader.header().grid.is_line();
    for column in &reader.header().quantities {
        let quantity = column.quantity;
        let Some(Panel { title, label, legend }) = quantity.panel() else { continue };
        // Spots of a line contact have lengths, and its border are points.
        let (title, label) = match (quantity, line) {
            (Quantity::LargestSpot | Quantity::MeanSpot, true) => ("Lengths of contact spots", "length"),
            (Quantity::ContactPerimeter, true) => ("Ends of the contact", "number"),
            _ => (title, label),
        };
        let percolates = matches!(quantity, Quantity::ContactPercolation | Quantity::GapPercolation);
        let states: &'static [&'static str] = if percolates { &DIRECTIONS } else { &[] };
        let line = (legend, quantity.name());
        // The mean gap, which every row has, beside the rms gap.
        let mean = (quantity == Quantity::RmsGap).then_some(("mean", "mean_gap"));
        match panels.iter_mut().find(|panel| panel.title == title) {
            Some(panel) => panel.lines.push(line),
            None => {
                let units =
                    scalars.iter().find(|series| series.name == quantity.name()).map_or("", |s| s.units);
                let units = if units == "1" { "" } else { units };
                panels.push(QuantityPanel {
                    title,
                    label,
                    units,
                    lines: std::iter::once(line).chain(mean).collect(),
                    states,
                });
            }
        }
    }
    panels
}

pub(super) fn quantities(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let time = times(reader)?;
    let rows = Rows::within(reader, options)?;
    let panels = quantity_panels(reader);
    if panels.is_empty() {
        return Err(reader.no_quantities().into());
    }
    let mut figure = Figure::new("");
    for panel in panels {
        let (up, steps) = match panel.states {
            [] if panel.label == "number" => (Axis::linear("number", "").counting(), false),
            [] => (Axis::linear(panel.label, panel.units), false),
            names => (Axis::states(panel.label, names), true),
        };
        let mut curves = Curves::new(panel.title, rows.axis(options.log), up);
        for (name, series) in panel.lines {
            let line = Series::new(name, Style::Line, time.clone(), reader.series(series)?);
            curves = curves.with(if steps { line.stepped() } else { line });
        }
        figure = figure.with(curves);
    }
    Ok(figure)
}

pub(super) fn load_displacement(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let kept = shown(reader, options)?;
    let panel =
        Curves::new("", Axis::linear("approach", "m"), Axis::linear("load", reader.header().grid.units("N")));
    let pick = |name: &str| -> Result<Vec<f64>, StoreError> {
        let values = reader.series(name)?;
        Ok(kept.iter().filter_map(|row| values.get(*row).copied()).collect())
    };
    let figure = Figure::new("").with(nameless(panel.clone(), &pick("approach")?, pick("load")?));
    let Some(cycle) = last_cycle(reader, options)? else { return Ok(figure) };
    let ends = [*cycle.start(), *cycle.end()].map(|row| reader.series("time").map(|times| times[row]));
    let [from, to] = ends;
    let title = format!("Last cycle, {} to {}", super::moment(reader, from?), quantity(to?, "s"));
    let [x, y] = ["approach", "load"].map(|name| reader.series(name));
    Ok(figure.with(nameless(Curves { title, ..panel }, &x?[cycle.clone()], y?[cycle].to_vec())))
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
    let ends = course.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], v| [a.min(*v), b.max(*v)]);
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
    let row: Vec<f64> = kept.iter().map(|row| *row as f64).collect();
    let points = |name: &str, series: &str| -> Result<Series, StoreError> {
        let values = reader.series(series)?;
        let picked: Vec<f64> = kept.iter().filter_map(|row| values.get(*row).copied()).collect();
        Ok(Series::new(name, Style::Points, row.clone(), picked))
    };
    let counts = Curves::new(
        "Work of each row",
        Axis::linear("row", "").counting(),
        Axis::linear("number", "").counting(),
    )
    .with(points("iterations", "iterations")?)
    .with(points("convolutions", "convolutions")?);
    let errors =
        Curves::new("Error of each row", Axis::linear("row", "").counting(), Axis::log("relative error", ""))
            .with(points("contact conditions (residual)", "residual")?)
            .with(points("pressure (certificate)", "certificate")?);
    Ok(Figure::new("").with(counts).with(errors))
}

/// Numbers of the rows in the window.
fn shown(reader: &Reader, options: &Options) -> Result<Vec<usize>, PlotError> {
    let times = times(reader)?;
    Rows::within(reader, options)?;
    Ok((0..times.len()).filter(|row| options.shows(times[*row])).collect())
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
