//! Figures of leakage: where the fluid flows, what is trapped, and how the leak changes over time.

use asperity::leakage::{CellKind, flux};
use asperity_io::leakage::words::{MBAR_LITRE, rate};
use asperity_io::leakage::{Leak, Leakage, settings};
use asperity_io::readable::quantity;
use asperity_io::store::{At, FieldKind, Reader};
use ndarray::{Array2, ArrayView2, Zip};

use crate::figure::{Axis, Colours, Curves, Figure, Map, Series, Style, typeset};
use crate::result::{Options, PlotError, Rows};

/// Names and colours of the cells where the seal leaks.
const LEAKING: [(&str, [u8; 3]); 4] = [
    ("closed", CLOSED),
    ("through passage", [86, 180, 233]),
    ("dead end", [230, 159, 0]),
    ("closed pocket", POCKET),
];
/// And where it is tight.
const TIGHT: [(&str, [u8; 3]); 4] = [
    ("closed", CLOSED),
    ("open to the inlet", [86, 180, 233]),
    ("open to the outlet", [0, 158, 115]),
    ("closed pocket", POCKET),
];
const CLOSED: [u8; 3] = [110, 110, 108];
const POCKET: [u8; 3] = [213, 94, 0];
/// Decades of the flux that a map shows.
const DECADES: f64 = 4.0;

/// The leak of one state: passages and pockets, and the flow with its critical constriction; where it is tight the open gap.
pub fn state(leak: &Leak, found: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Figure {
    let caption = format!("{}. {}", sentence(&leak.words()), words(found));
    let maps = maps(found, gap, size);
    let mut figure =
        maps.into_iter().fold(Figure::new(heading(found)), |figure, map| figure.with(map)).caption(caption);
    figure.panel = [300.0, 260.0];
    figure
}

/// Passages, and the flow; where it is tight, the gap of the cells that are open.
fn maps(found: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Vec<Map> {
    let number = |kind: &CellKind| match (kind, found.percolates) {
        (CellKind::Closed, _) => 0.0,
        (CellKind::Through, _) | (CellKind::AtInlet, false) => 1.0,
        (CellKind::AtInlet | CellKind::AtOutlet, _) => 2.0,
        (CellKind::Pocket, _) => 3.0,
    };
    let kinds = found.cells.map(number);
    let names = if found.percolates { LEAKING } else { TIGHT };
    let names = names.map(|(name, colour)| (name.to_owned(), colour)).to_vec();
    let passages = Map::states("", names, kinds.view(), size);
    if found.percolates {
        return vec![passages.marked(found.critical), flow(found, gap, size).marked(found.critical)];
    }
    let open = (found.open_fraction > 0.0).then(|| open_gap(found, gap, size));
    std::iter::once(passages).chain(open).collect()
}

/// The gap of the open cells.
fn open_gap(found: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Map {
    let mut open = gap.to_owned();
    Zip::from(&mut open).and(&found.cells).for_each(|gap, kind| {
        if *kind == CellKind::Closed {
            *gap = f64::NAN;
        }
    });
    Map::new("Tight: gap of the open cells", ["gap", "m"], Colours::Sequential, open.view(), size)
}

/// The flow per width over its largest value; blank in contact, the lowest colour where the fluid rests.
fn flow(found: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Map {
    let flux = flux(size, gap, found.pressure.view());
    let largest = flux.iter().copied().filter(|q| q.is_finite()).fold(0.0, f64::max);
    let least = 10f64.powf(-DECADES);
    let mut share = Array2::from_elem(flux.dim(), f64::NAN);
    Zip::from(&mut share).and(&flux).and(&found.cells).for_each(|share, q, kind| {
        if *kind != CellKind::Closed {
            *share = if largest > 0.0 { (q / largest).max(least) } else { least };
        }
    });
    let map = Map::new("Flow", ["flow over its largest", ""], Colours::Sequential, share.view(), size);
    Map { log: true, ..map.between([least, 1.0]) }
}

/// The same with a capital.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// The leak in a few words.
fn heading(found: &Leakage) -> String {
    match found.leak_rate {
        _ if !found.percolates => "Tight".to_owned(),
        Some(leak_rate) => {
            format!("Leak rate {}", typeset(&rate(leak_rate, found.leak_rate_standard).replace("m3", "m³")))
        }
        None => format!("Hydraulic gap {}", quantity(found.hydraulic_gap, "m")),
    }
}

fn words(found: &Leakage) -> String {
    let open = format!("{:.1} % of the cells are open", 100.0 * found.open_fraction);
    let trapped = match found.trapped_area {
        0.0 => String::new(),
        area => format!(", {} of them in pockets", quantity(area, "m2")),
    };
    if !found.percolates {
        return format!("Inlet and outlet are not connected. {open}{trapped}.");
    }
    format!(
        "Hydraulic gap {}, critical gap {} (circle). {open}{trapped}.",
        quantity(found.hydraulic_gap, "m"),
        quantity(found.critical_gap, "m")
    )
}

/// The leaks of a result as they are stored, over time.
pub(crate) fn curves(reader: &Reader, log: Option<bool>) -> Result<Vec<Curves>, PlotError> {
    let time = reader.leak("leak_time")?;
    let percolates = reader.leak("percolates")?;
    // A logarithmic axis has no place for t = 0: it is of use where the seal leaks later too.
    let leaks_later = time.iter().zip(&percolates).any(|(time, open)| *time > 0.0 && *open > 0.0);
    let log_time = log.unwrap_or(Rows::of(reader)?.log) && leaks_later;
    // All of the run, also where the seal is tight.
    let first = time.iter().copied().find(|time| *time > 0.0 || !log_time).unwrap_or(0.0);
    let last = time.last().copied().unwrap_or(0.0);
    let axis = || {
        let axis = if log_time { Axis::log("time", "s") } else { Axis::linear("time", "s") };
        if last > first { axis.between(first, last) } else { axis }
    };
    let line = |name: &str, style: Style, column: &str| -> Result<Series, PlotError> {
        // A tight seal has no place on a logarithmic axis.
        let positive = |v: f64| if v > 0.0 { v } else { f64::NAN };
        Ok(Series::new(
            name,
            style,
            time.clone(),
            reader.leak(column)?.into_iter().map(positive).collect::<Vec<_>>(),
        ))
    };
    let mut all = vec![];
    let gas = reader.leak("leak_rate_standard").is_ok();
    if !percolates.contains(&1.0) {
        // Logarithmic axes have no place for any of it.
        return Ok(all);
    }
    if reader.leak("leak_rate").is_ok() {
        let label =
            if gas { Axis::log("leak rate, at 0 °C", "mbar l/s") } else { Axis::log("leak rate", "m3/s") };
        let standard = if gas { reader.leak("leak_rate_standard")? } else { vec![] };
        let rate = reader.leak("leak_rate")?;
        // Of a gas every rate in kg/s has the same factor to mbar l/s.
        let mut ratios = standard.iter().zip(&rate).map(|(standard, rate)| MBAR_LITRE * standard / rate);
        let factor = ratios.rfind(|ratio| ratio.is_finite()).unwrap_or(1.0);
        let scaled = |name: &str, style: Style, column: &str| -> Result<Series, PlotError> {
            let mut series = line(name, style, column)?;
            series.y.iter_mut().for_each(|rate| *rate *= factor);
            Ok(series)
        };
        let panel = Curves::new("Leak rate", axis(), label)
            .with(scaled("solved on the grid", Style::Line, "leak_rate")?)
            .with(scaled("estimate from the critical constriction", Style::Dashed, "leak_estimate_junction")?)
            .with(scaled(
                "estimate from all gaps (effective medium)",
                Style::DashDotted,
                "leak_estimate_medium",
            )?);
        all.push(sealing(panel, &time, &percolates));
    }
    let gaps = Curves::new("Gaps", axis(), Axis::log("gap", "m"))
        .with(line("hydraulic: even gap, same leak", Style::Line, "hydraulic_gap")?)
        .with(line("critical: narrowest on best path", Style::Dashed, "critical_gap")?);
    all.push(sealing(gaps, &time, &percolates));
    Ok(all)
}

/// Leaks of up to this many times are marked: a line through one of them cannot be seen.
const FEW: usize = 4;

/// The panel over whole decades, with a vertical line at each time from which on the seal is tight after it has leaked.
fn sealing(mut panel: Curves, time: &[f64], percolates: &[f64]) -> Curves {
    let values = panel.series.iter().flat_map(|series| series.y.iter().copied()).filter(|y| *y > 0.0);
    let [low, high] = values.fold([f64::INFINITY, 0.0], |[a, b], y| [f64::min(a, y), f64::max(b, y)]);
    let ends = [10f64.powf(low.log10().floor()), 10f64.powf(high.log10().ceil())];
    panel.y = panel.y.between(ends[0], ends[1]);
    if percolates.iter().filter(|open| **open > 0.0).count() <= FEW {
        for (series, sign) in panel.series.iter_mut().zip(Style::SIGNS.iter().cycle()) {
            series.style = *sign;
        }
    }
    let moments = (1..time.len()).filter(|n| percolates[n - 1] > 0.0 && percolates[*n] == 0.0);
    moments.enumerate().fold(panel, |panel, (k, n)| {
        let name = if k == 0 { "tight from here" } else { "" };
        panel.with(Series::new(name, Style::Reference, vec![time[n]; 2], ends.to_vec()))
    })
}

/// Leak rate and gaps over time, and the flow at an instant.
pub(crate) fn over_time(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let mut figure = Figure::new("");
    let window = Rows::within(reader, options)?.axis(options.log).range;
    for mut panel in curves(reader, options.log)? {
        panel.x.range = window.or(panel.x.range);
        figure = figure.with(panel);
    }
    // The last state of a seal that has become tight shows no flow.
    let instant = if options.at == At::Last { last_leak(reader) } else { options.at };
    let (maps, mut caption) = at(reader, instant)?;
    if reader.index(instant)? != reader.index(options.at)? {
        caption += " The maps are of the last stored time at which it leaks.";
    }
    for map in maps {
        figure = figure.with(map);
    }
    figure.panel = [300.0, 240.0];
    Ok(figure.caption(caption))
}

/// The flow alone, for pages: at the last instant at which the seal leaks.
pub(crate) fn last_map(reader: &Reader) -> Result<Figure, PlotError> {
    let instant = last_leak(reader);
    let (maps, mut caption) = at(reader, instant)?;
    if reader.index(instant)? != reader.index(At::Last)? {
        caption += " This is the last stored time at which it leaks.";
    }
    let mut figure = maps.into_iter().fold(Figure::new(""), |figure, map| figure.with(map)).caption(caption);
    figure.panel = [300.0, 260.0];
    Ok(figure)
}

/// The maps at an instant, computed as the stored leaks were.
fn at(reader: &Reader, at: At) -> Result<(Vec<Map>, String), PlotError> {
    let Some(leak) = settings(reader) else {
        return Err(reader.no_leaks().into());
    };
    let index = reader.index(at)?;
    let time = reader.field_times()[index];
    let gap = reader.field(FieldKind::Gap, at)?;
    let contact = reader.contact_states(at)?;
    let grid = &reader.header().grid;
    let found = leak.of_gap(grid, gap.view(), Some(contact.view()), time)?;
    let moment = quantity(time, "s");
    let caption = format!("t = {moment}: {}, {}. {}", heading(&found), leak.words(), words(&found));
    Ok((maps(&found, gap.view(), grid.size()), caption))
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
