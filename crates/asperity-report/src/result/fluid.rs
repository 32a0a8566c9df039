//! A fluid that acts on the surfaces: its pressure in the open cells, the contact and the pockets, at an instant.

use asperity::leakage::{CellKind, Direction};
use asperity_io::leakage::settings;
use asperity_io::readable::quantity;
use asperity_io::store::{At, FieldKind, Reader};
use ndarray::Array2;

use super::{Options, PlotError, at_instant, caption};
use crate::figure::{Colours, Figure, Map, State, extent};
use crate::leak::{CLOSED, POCKET};

/// What hides the pressure of a cell.
const COVER: &[State] = &[
    ("", [0; 3]),
    ("contact", CLOSED),
    ("gap too small", [165, 165, 162]),
    ("edge of a closed pocket", POCKET),
];

/// Sides of a map up to which edges are drawn finer than cells, and how much finer at most.
const FINE: usize = 1024;
const FINEST: usize = 5;

/// The map of the fluid at an instant.
pub(super) fn map(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let leak = settings(reader);
    let Some((leak, coupling)) = leak.as_ref().and_then(|leak| Some((leak, leak.coupling.as_ref()?))) else {
        return Err(PlotError::Refused(format!(
            "no fluid acts on the surfaces of {}; set coupling = \"two-way\" in [leakage] of its case",
            reader.path().display()
        )));
    };
    let index = reader.index(options.at)?;
    let (at, time) = (At::Index(index), reader.field_times()[index]);
    let grid = &reader.header().grid;
    let pressure = reader.field(FieldKind::Pressure, at)? + coupling.reference;
    let (gap, contact) = (reader.field(FieldKind::Gap, at)?, reader.contact_states(at)?);
    let kinds = leak.kinds(grid, gap.view(), contact.view())?;
    let closed = |at: [usize; 2]| kinds[at] == CellKind::Closed;
    // Finer than cells, so that the edge of a pocket leaves its pressure to be seen.
    let [nx, ny] = grid.cells();
    let fine = (FINE / nx.max(ny)).clamp(1, FINEST);
    let (edge, shape) = (fine.div_ceil(3), (fine * nx, fine * ny));
    let shown = Array2::from_shape_fn(shape, |(i, j)| {
        let cell = [i / fine, j / fine];
        if closed(cell) { f64::NAN } else { pressure[cell] }
    });
    let cover = Array2::from_shape_fn(shape, |(i, j)| {
        let cell = [i / fine, j / fine];
        let ends = |k: usize, n: usize, at: usize| {
            [k % fine < edge && at > 0, k % fine + edge >= fine && at + 1 < n]
        };
        let ([left, right], [below, above]) = (ends(i, nx, cell[0]), ends(j, ny, cell[1]));
        let beside = [
            left.then(|| [cell[0] - 1, cell[1]]),
            right.then(|| [cell[0] + 1, cell[1]]),
            below.then(|| [cell[0], cell[1] - 1]),
            above.then(|| [cell[0], cell[1] + 1]),
        ];
        match kinds[cell] {
            CellKind::Closed if contact[cell] > 0 => 1.0,
            CellKind::Closed => 2.0,
            CellKind::Pocket if beside.into_iter().flatten().any(closed) => 3.0,
            _ => 0.0,
        }
    });
    let inlet = coupling.inlet.after(time);
    let ends = extent(shown.iter().copied().chain([inlet, coupling.outlet]));
    let map = Map::new("", ["pressure of the fluid", "Pa"], Colours::Sequential, shown.view(), grid.size())
        .covered(COVER, cover.view())
        .between(Colours::Sequential.ends(ends));
    let [from, to] = if leak.axis() == Direction::X { ["left", "right"] } else { ["bottom", "top"] };
    let number = |name: &str| at_instant(reader, index, name);
    let (fluid, load) = (number("fluid_load")?, number("load")?);
    let carries = match (number("film")? > 0.0, load > 0.0) {
        (true, _) => " It carries all of the load in a film without contact.".to_owned(),
        (false, true) => format!(" It carries {:.1} % of the load.", 100.0 * fluid / load),
        (false, false) => String::new(),
    };
    let pockets: Vec<f64> =
        kinds.iter().zip(&pressure).filter(|(kind, _)| **kind == CellKind::Pocket).map(|(_, p)| *p).collect();
    let trapped = match extent(pockets.iter().copied()) {
        _ if pockets.is_empty() => String::new(),
        [low, high] => {
            let area = quantity(pockets.len() as f64 * grid.cell_area(), "m2");
            let [low, high] = [low, high].map(|p| quantity(p, "Pa"));
            let pressure = if low == high { low } else { format!("{low} to {high}") };
            format!(" Pockets: {area} at {pressure}.")
        }
    };
    let caption = format!(
        "{} Fluid from {} at the {from} to {} at the {to}.{carries}{trapped}",
        caption(reader, index)?,
        quantity(inlet, "Pa"),
        quantity(coupling.outlet, "Pa"),
    );
    Ok(Figure::new("").with(map).panel_size([345.0, 280.0]).caption(caption))
}

/// The map for pages: at the stored instant at which the fluid carries the most.
pub(crate) fn largest_map(reader: &Reader) -> Result<Figure, PlotError> {
    let loads = reader.series("fluid_load")?;
    let of = |row: &usize| loads.get(*row).copied().unwrap_or(f64::NAN);
    let carried: Vec<f64> = reader.field_steps().iter().map(of).collect();
    let [_, most] = extent(carried.iter().copied());
    let at = carried.iter().rposition(|load| *load == most).map_or(At::Last, At::Index);
    let mut figure = map(reader, &Options { at, ..Options::default() })?;
    figure.caption += " This is the stored time at which the fluid carries the most.";
    Ok(figure)
}
