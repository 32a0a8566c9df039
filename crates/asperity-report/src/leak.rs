//! Figures of leakage: where the fluid flows, what is trapped, and how the leak changes over time.

use asperity::leakage::{CellKind, flux};
use asperity_io::leakage::{Leakage, settings};
use asperity_io::readable::quantity;
use asperity_io::store::{At, FieldKind, Reader};
use ndarray::{Array2, ArrayView2, Zip};

use crate::figure::{Axis, Colours, Curves, Figure, Map, Series, Style};
use crate::result::{Options, PlotError};

/// Names and colours of the cells.
const KINDS: [(&str, [u8; 3]); 4] = [
    ("closed", [110, 110, 108]),
    ("through", [86, 180, 233]),
    ("dead end", [230, 159, 0]),
    ("pocket", [213, 94, 0]),
];
/// Decades of the flux that a map shows.
const DECADES: f64 = 4.0;

/// The leak of one state: passages and pockets, and the flow with its critical constriction.
pub fn state(leak: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Figure {
    let [passages, flow] = maps(leak, gap, size);
    let mut figure = Figure::new("").with(passages).with(flow).caption(words(leak));
    figure.panel = [300.0, 260.0];
    figure
}

fn maps(leak: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> [Map; 2] {
    let number = |kind: &CellKind| match kind {
        CellKind::Closed => 0.0,
        CellKind::Through => 1.0,
        CellKind::AtInlet | CellKind::AtOutlet => 2.0,
        CellKind::Pocket => 3.0,
    };
    let kinds = leak.cells.map(number);
    let names = KINDS.map(|(name, colour)| (name.to_owned(), colour)).to_vec();
    let passages = Map::states("", names, kinds.view(), size);
    let flow = flow(leak, gap, size);
    let marked = |map: Map| if leak.percolates { map.marked(leak.critical) } else { map };
    [marked(passages), marked(flow)]
}

/// The flux in decades below its largest; blank in contact, the lowest colour where the fluid rests.
fn flow(leak: &Leakage, gap: ArrayView2<'_, f64>, size: [f64; 2]) -> Map {
    let flux = flux(size, gap, leak.pressure.view());
    let largest = flux.iter().copied().filter(|q| q.is_finite()).fold(0.0, f64::max);
    let mut decades = Array2::from_elem(flux.dim(), f64::NAN);
    Zip::from(&mut decades).and(&flux).and(&leak.cells).for_each(|decades, q, kind| {
        if *kind != CellKind::Closed {
            *decades = if largest > 0.0 { (q / largest).log10().max(-DECADES) } else { -DECADES };
        }
    });
    let map =
        Map::new("Flow", ["flux over the largest, decades", ""], Colours::Sequential, decades.view(), size);
    map.between([-DECADES, 0.0])
}

fn words(leak: &Leakage) -> String {
    let open = format!("{:.1} % of the cells are open", 100.0 * leak.open_fraction);
    let trapped = match leak.trapped_area {
        0.0 => String::new(),
        area => format!(", {} of them in pockets", quantity(area, "m2")),
    };
    if !leak.percolates {
        return format!("Tight: inlet and outlet are not connected. {open}{trapped}.");
    }
    let rate = match (leak.leak_rate, leak.leak_rate_standard) {
        (_, Some(standard)) => format!("Leak {:.3e} mbar l/s. ", 10.0 * standard),
        (Some(rate), None) => format!("Leak {rate:.3e} m3/s. "),
        (None, None) => String::new(),
    };
    format!(
        "{rate}Hydraulic gap {}, critical gap {} (circle). {open}{trapped}.",
        quantity(leak.hydraulic_gap, "m"),
        quantity(leak.critical_gap, "m")
    )
}

/// The leaks of a result as they are stored, over time.
pub(crate) fn curves(reader: &Reader, log_time: bool) -> Result<Vec<Curves>, PlotError> {
    let time = reader.leak("leak_time")?;
    let axis = || if log_time { Axis::log("time", "s") } else { Axis::linear("time", "s") };
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
    if reader.leak("leak_rate").is_ok() {
        let label = if gas { Axis::log("leak rate", "kg/s") } else { Axis::log("leak rate", "m3/s") };
        all.push(
            Curves::new("Leak rate", axis(), label)
                .with(line("computed", Style::Line, "leak_rate")?)
                .with(line("one junction", Style::Dashed, "leak_estimate_junction")?)
                .with(line("effective medium", Style::Dashed, "leak_estimate_medium")?),
        );
    }
    all.push(
        Curves::new("Gaps", axis(), Axis::log("gap", "m"))
            .with(line("hydraulic", Style::Line, "hydraulic_gap")?)
            .with(line("critical", Style::Line, "critical_gap")?),
    );
    Ok(all)
}

/// Leak rate and gaps over time, and the flow at an instant.
pub(crate) fn over_time(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let mut figure = Figure::new("");
    for panel in curves(reader, options.log_time)? {
        figure = figure.with(panel);
    }
    let (maps, caption) = at(reader, options.at)?;
    for map in maps {
        figure = figure.with(map);
    }
    figure.panel = [300.0, 240.0];
    Ok(figure.caption(caption))
}

/// The flow at an instant alone, for pages.
pub(crate) fn map_of(reader: &Reader, at_instant: At) -> Result<Figure, PlotError> {
    let (maps, caption) = at(reader, at_instant)?;
    let [passages, flow] = maps;
    let mut figure = Figure::new("").with(passages).with(flow).caption(caption);
    figure.panel = [300.0, 260.0];
    Ok(figure)
}

/// The maps at an instant, computed as the stored leaks were.
fn at(reader: &Reader, at: At) -> Result<([Map; 2], String), PlotError> {
    let Some(leak) = settings(reader) else {
        return Err(reader.no_leaks().into());
    };
    let index = reader.index(at)?;
    let time = reader.field_times()[index];
    let gap = reader.field(FieldKind::Gap, at)?;
    let contact = reader.contact_states(at)?;
    let grid = &reader.header().grid;
    let found = leak.of_gap(grid, gap.view(), Some(contact.view()), time)?;
    let caption = format!("t = {}: {}", quantity(time, "s"), words(&found));
    Ok((maps(&found, gap.view(), grid.size()), caption))
}

/// The last stored instant at which the seal leaks, else the last.
pub(crate) fn last_leak(reader: &Reader) -> At {
    let open = reader.leak("percolates").unwrap_or_default();
    open.iter().rposition(|open| *open > 0.0).map_or(At::Last, At::Index)
}
