//! Leakage of a result: how it changes over time, and where the fluid flows at an instant.

use asperity_io::answer::{Units, Validity};
use asperity_io::leakage::settings;
use asperity_io::store::{At, FieldKind, Reader};

use super::{Options, PlotError, Rows};
use crate::figure::{Axis, Curves, Figure, Map, Series, Style, extent};
use crate::leak::{heading, maps, words};

/// The leaks of a result as they are stored, over time.
fn curves(reader: &Reader, options: &Options) -> Result<Vec<Curves>, PlotError> {
    let (units, log, along) = (Units::of(reader, &options.units), options.log, reader.header().axis());
    let time = reader.leak("leak_time")?;
    let steps = reader.leak("leak_step")?;
    // A leak that is taken back is not drawn, nor that it is tight.
    let holds: Vec<bool> = steps.iter().map(|step| validity(reader, *step as usize).is_valid()).collect();
    let kept = |values: Vec<f64>| -> Vec<f64> {
        values.into_iter().zip(&holds).map(|(value, holds)| if *holds { value } else { f64::NAN }).collect()
    };
    let percolates = kept(reader.leak("percolates")?);
    // A logarithmic axis has no place for t = 0: without being asked for it is of use where the seal leaks later too.
    let leaks_later = time.iter().zip(&percolates).any(|(time, open)| *time > 0.0 && *open > 0.0);
    let log_time = log.unwrap_or(Rows::of(reader)?.log && leaks_later);
    // All of the run, also where the seal is tight.
    let first = time.iter().copied().find(|time| *time > 0.0 || !log_time).unwrap_or(0.0);
    let last = time.last().copied().unwrap_or(0.0);
    let axis = || {
        let (name, unit) = (along.name(), along.unit());
        let axis = if log_time { Axis::log(name, unit) } else { Axis::linear(name, unit) };
        let axis = if along == asperity::Axis::Time { axis.shown_in(units.shown("time")) } else { axis };
        if last > first { axis.spanning(first, last) } else { axis }
    };
    let line = |name: &str, style: Style, column: &str| -> Result<Series, PlotError> {
        // A tight seal has no place on a logarithmic axis.
        let positive = |v: f64| if v > 0.0 { v } else { f64::NAN };
        let values: Vec<f64> = kept(reader.leak(column)?).into_iter().map(positive).collect();
        Ok(Series::new(name, style, &time, values))
    };
    let mut all = vec![];
    let gas = reader.leak("leak_rate_standard").is_ok();
    let opening = opening(reader, axis(), &time)?;
    if !percolates.contains(&1.0) {
        // Logarithmic axes have no place for any of it.
        all.extend(opening);
        return Ok(all);
    }
    if reader.leak("leak_rate").is_ok() {
        let shown = units.shown_leak(gas);
        let label = match gas {
            true => Axis::log("leak rate, at 0 °C", "Pa m3/s"),
            false => Axis::log("leak rate", "m3/s"),
        }
        .shown_in(Some(shown));
        let standard = if gas { reader.leak("leak_rate_standard")? } else { vec![] };
        let rate = reader.leak("leak_rate")?;
        // Of a gas every rate in kg/s has the same factor to its standard rate.
        let mut ratios = standard.iter().zip(&rate).map(|(standard, rate)| standard / rate);
        let factor = ratios.rfind(|ratio| ratio.is_finite()).unwrap_or(1.0);
        let scaled = |name: &str, style: Style, column: &str| -> Result<Series, PlotError> {
            let mut series = line(name, style, column)?;
            series.y.iter_mut().for_each(|rate| *rate *= factor);
            Ok(series)
        };
        let mut panel = Curves::new("Leak rate", axis(), label)
            .with(scaled("solved on the grid", Style::Line, "leak_rate")?)
            .with(scaled("estimate from the critical constriction", Style::Dashed, "leak_estimate_junction")?)
            .with(scaled(
                "estimate from all gaps (effective medium)",
                Style::DashDotted,
                "leak_estimate_medium",
            )?);
        if let Ok(rates) = reader.leak(ONE_WAY) {
            let leaks = rates.iter().any(|rate| *rate > 0.0);
            let name = if leaks { WITHOUT } else { "if the fluid did not act on the surfaces: tight" };
            panel = panel.with(scaled(name, Style::Line, ONE_WAY)?);
        }
        all.push(sealing(panel, &time, &percolates));
    }
    let gaps = Curves::new("Gaps", axis(), Axis::log("gap", "m"))
        .with(line("hydraulic: even gap, same leak", Style::Line, "hydraulic_gap")?)
        .with(line("critical: narrowest on best path", Style::Dashed, "critical_gap")?);
    all.push(sealing(gaps, &time, &percolates));
    all.extend(opening);
    Ok(all)
}

/// The leak of a fluid that does not act on the surfaces.
const ONE_WAY: &str = "leak_rate_one_way";
const WITHOUT: &str = "if the fluid did not act on the surfaces";

/// The pressure of the inlet, and the one that opens the contact, over time.
fn opening(reader: &Reader, axis: Axis, time: &[f64]) -> Result<Option<Curves>, PlotError> {
    let Ok(opening) = reader.leak("opening_pressure") else { return Ok(None) };
    let mut panel = Curves::new("Pressure of the inlet", axis, Axis::linear("pressure", "Pa"))
        .with(Series::new("that opens the contact suddenly", Style::Line, time, opening));
    if let Ok(inlet) = reader.series("inlet_pressure") {
        panel = panel.with(Series::new("of the run", Style::Dashed, &reader.series("time")?, inlet));
    }
    Ok(Some(panel))
}

/// The panel over whole decades, with a vertical line at each time from which on the seal is tight after it has leaked.
fn sealing(mut panel: Curves, time: &[f64], percolates: &[f64]) -> Curves {
    let values = panel.series.iter().flat_map(|series| series.y.iter().copied()).filter(|y| *y > 0.0);
    let [low, high] = extent(values);
    let ends = [10f64.powf(low.log10().floor()), 10f64.powf(high.log10().ceil())];
    panel.y = panel.y.spanning(ends[0], ends[1]);
    let moments = (1..time.len()).filter(|n| percolates[n - 1] > 0.0 && percolates[*n] == 0.0);
    moments.enumerate().fold(panel, |panel, (k, n)| {
        let name = if k == 0 { "tight from here" } else { "" };
        panel.with(Series::new(name, Style::Reference, [time[n]; 2], ends))
    })
}

/// Leak rate and gaps over time, and the flow at an instant.
pub(super) fn over_time(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let window = Rows::within(reader, options)?.axis(options.log).range;
    let mut curves = curves(reader, options)?;
    for panel in &mut curves {
        panel.x.range = window.or(panel.x.range);
    }
    let (maps, caption) = flow(reader, options.at, "The maps are of", &options.units)?;
    Ok(Figure::new("").with_all(curves).with_all(maps).panel_size([300.0, 240.0]).caption(caption))
}

/// The flow alone, for pages: at the last instant at which the seal leaks.
pub(crate) fn last_map(reader: &Reader) -> Result<Figure, PlotError> {
    let (maps, caption) = flow(reader, At::Last, "This is", &Units::default())?;
    Ok(Figure::new("").with_all(maps).panel_size([300.0, 260.0]).caption(caption))
}

/// The maps at an instant and their caption. The last state of a seal that has become tight shows no flow: in its place stands the
/// last one at which it leaks, and the caption says so.
fn flow(reader: &Reader, wanted: At, shown: &str, units: &Units) -> Result<(Vec<Map>, String), PlotError> {
    let units = Units::of(reader, units);
    let instant = if wanted == At::Last { last_leak(reader) } else { wanted };
    let (maps, mut caption) = at(reader, instant, &units)?;
    if reader.index(instant)? != reader.index(wanted)? {
        caption += &format!(" {shown} the last stored {} at which it leaks.", reader.header().axis().name());
    }
    Ok((maps, caption))
}

/// The maps at an instant, computed as the stored leaks were.
fn at(reader: &Reader, at: At, units: &Units) -> Result<(Vec<Map>, String), PlotError> {
    let Some(leak) = settings(reader) else {
        return Err(reader.no_leaks().into());
    };
    let index = reader.index(at)?;
    let time = reader.field_times()[index];
    let gap = reader.field(FieldKind::Gap, at)?;
    let contact = reader.contact_states(at)?;
    let grid = &reader.header().grid;
    let found = leak.of_gap(grid, gap.view(), Some(contact.view()), time)?;
    let moment = units.moment(reader.header().axis().at(time));
    let validity = validity(reader, reader.field_steps()[index]);
    let shown = validity.mark(heading(&found, units));
    let caption = format!("{moment}: {shown}, {}. {}", leak.words(), words(&found, &validity));
    Ok((maps(&found, gap.view(), grid.size()), caption))
}

/// What the findings say of the leak at a row.
fn validity(reader: &Reader, row: usize) -> Validity {
    Validity::at_row("leak_rate", row, reader.findings().iter())
}

/// The last instant at which the seal leaks, else the last one with a leakage.
fn last_leak(reader: &Reader) -> At {
    let column = |name: &str| reader.leak(name).unwrap_or_default();
    let (open, times, steps) = (column("percolates"), column("leak_time"), column("leak_step"));
    let Some(n) = open.iter().rposition(|open| *open > 0.0).or(open.len().checked_sub(1)) else {
        return At::Last;
    };
    let same = |index: &usize| {
        reader.field_times()[*index] == times[n] && reader.field_steps()[*index] as f64 == steps[n]
    };
    (0..reader.field_times().len()).rfind(same).map_or(At::Last, At::Index)
}
