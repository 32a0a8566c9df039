//! Panels of curves over the rows: which numbers share one, and what it is called. Figures and pages draw the same.

use asperity::quantities::{Column, Panel, Quantity, ROW_COLUMNS, RowFigure};
use asperity_io::store::{Reader, StoreError};

use super::rows::Rows;
use super::{Options, PlotError, temperature};
use crate::figure::{Axis, Curves, Figure, Series, Style, extent};

/// A panel of numbers over the rows.
pub(crate) struct RowPanel {
    pub(crate) title: &'static str,
    pub(crate) label: &'static str,
    /// Name in the legend and name of the series, see [`values`].
    pub(crate) lines: Vec<(&'static str, &'static str)>,
    /// Names of the values 0, 1, 2 ... of a quantity that is a state; empty for a number.
    pub(crate) states: &'static [&'static str],
}

/// The mean pressure over the contact, which no column holds.
pub(crate) const CONTACT_PRESSURE: &str = "contact_pressure";

/// The numbers of a series at the rows.
pub(crate) fn values(reader: &Reader, name: &str) -> Result<Vec<f64>, StoreError> {
    if name == Quantity::PocketPressureMax.name() {
        // Without pockets there is none.
        let rows = reader.series(name)?.into_iter().zip(reader.series(Quantity::PocketArea.name())?);
        return Ok(rows.map(|(p, area)| if area > 0.0 { p } else { f64::NAN }).collect());
    }
    if name == CONTACT_PRESSURE { reader.contact_pressures() } else { reader.series(name) }
}

/// Adds a line to the panel of its title, or to a new one.
fn add(panels: &mut Vec<RowPanel>, shown: Panel, name: &'static str, states: &'static [&'static str]) {
    let Panel { title, label, legend, .. } = shown;
    match panels.iter_mut().find(|panel| panel.title == title) {
        Some(panel) => panel.lines.push((legend, name)),
        None => panels.push(RowPanel { title, label, lines: vec![(legend, name)], states }),
    }
}

/// The panels of every row that a figure shows, by the place of the panel.
fn of_columns(reader: &Reader, is_of: impl Fn(RowFigure) -> Option<u8>) -> Result<Vec<RowPanel>, StoreError> {
    let mut shown: Vec<(u8, Panel, &'static str)> = vec![];
    for column in ROW_COLUMNS {
        let Some((figure, panel)) = column.panel_on(reader.header().grid.is_line()) else { continue };
        let Some(place) = is_of(figure) else { continue };
        let is_zero = || Ok(reader.series(column.name)?.iter().all(|value| *value <= 0.0));
        if !column.is_shown_where_positive() || !is_zero()? {
            shown.push((place, panel, column.name));
        }
    }
    shown.sort_by_key(|(place, ..)| *place);
    let mut panels = vec![];
    shown.into_iter().for_each(|(_, panel, name)| add(&mut panels, panel, name, &[]));
    Ok(panels)
}

/// A number is constant if it varies by less than this share.
const CONSTANT: f64 = 1e-9;

/// Whether a panel shows nothing but what stays the same: a load that is held.
pub(crate) fn is_constant(reader: &Reader, panel: &RowPanel) -> Result<bool, StoreError> {
    for (_, name) in &panel.lines {
        let values = values(reader, name)?;
        let [low, high] = extent(values.iter().copied());
        if high - low > CONSTANT * high.abs().max(low.abs()) {
            return Ok(false);
        }
    }
    Ok(reader.len() > 1)
}

/// How the contact evolves; what stays the same is left out where anything changes.
pub(crate) fn of_evolution(reader: &Reader) -> Result<Vec<RowPanel>, StoreError> {
    let mut panels = of_columns(reader, |figure| match figure {
        RowFigure::Evolution(place) => Some(place),
        _ => None,
    })?;
    if let Some(pressure) = panels.iter_mut().find(|panel| panel.label == "pressure") {
        pressure.lines.push(("mean over the contact", CONTACT_PRESSURE));
    }
    let mut changing = vec![];
    for panel in &panels {
        if !is_constant(reader, panel)? {
            changing.push(panel.title);
        }
    }
    if !changing.is_empty() {
        panels.retain(|panel| changing.contains(&panel.title));
    }
    Ok(panels)
}

/// The work of the solver; where it had to loop over tractions, also how that went.
pub(crate) fn of_work(reader: &Reader) -> Result<Vec<RowPanel>, StoreError> {
    let mut panels = of_columns(reader, |figure| (figure == RowFigure::Work).then_some(0))?;
    let columns = reader.header().quantities.iter().filter(|column| column.quantity.is_of_solver());
    for Column { quantity, .. } in columns {
        let is_zero = reader.series(quantity.name())?.iter().all(|value| *value == 0.0);
        if let Some(panel) = quantity.panel_on(&reader.header().grid).filter(|_| !is_zero) {
            add(&mut panels, panel, quantity.name(), &[]);
        }
    }
    Ok(panels)
}

/// Whether a panel says nothing: a film or a pocket that never is, a pressure that is held.
fn says_nothing(reader: &Reader, panel: &RowPanel) -> Result<bool, StoreError> {
    for (_, name) in &panel.lines {
        if reader.series(name)?.iter().any(|value| *value != 0.0) {
            return is_constant(reader, panel);
        }
    }
    Ok(true)
}

fn has_no_value(reader: &Reader, panel: &RowPanel) -> Result<bool, StoreError> {
    for (_, name) in &panel.lines {
        if reader.series(name)?.iter().any(|value| !value.is_nan()) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The quantities with one number per row: one panel for all energies, one for the areas of spots, one for each other. Of those that
/// nobody has asked for, because every row with a fluid, an attraction, wear or a motion has them, the panels that say something.
pub(crate) fn of_quantities(reader: &Reader) -> Result<Vec<RowPanel>, StoreError> {
    let mut panels: Vec<RowPanel> = vec![];
    let grid = &reader.header().grid;
    for Column { quantity, .. } in &reader.header().quantities {
        let panel = quantity.panel_on(grid).filter(|_| !quantity.is_of_solver());
        match (panel, quantity.components()) {
            (None, _) => {}
            (Some(panel), Some([[x, _], [y, _]])) => {
                add(&mut panels, Panel { legend: "along x", ..panel }, x, &[]);
                add(&mut panels, Panel { legend: "along y", ..panel }, y, &[]);
            }
            (Some(panel), None) => add(&mut panels, panel, quantity.name(), quantity.states()),
        }
    }
    let mut silent = vec![];
    for panel in &panels {
        let all = |is: fn(Quantity) -> bool| {
            panel.lines.iter().all(|(_, name)| Quantity::from_name(name).is_some_and(is))
        };
        let is_given = all(|own| own.is_of_traction() || own.is_of_wear());
        if is_given && says_nothing(reader, panel)?
            || all(Quantity::is_of_motion) && has_no_value(reader, panel)?
        {
            silent.push(panel.title);
        }
    }
    panels.retain(|panel| !silent.contains(&panel.title));
    // Numbers that every row has, beside the quantities of their panel.
    for beside in of_columns(reader, |figure| (figure == RowFigure::Quantities).then_some(0))? {
        if let Some(panel) = panels.iter_mut().find(|panel| panel.title == beside.title) {
            panel.lines.extend(beside.lines);
        }
    }
    Ok(panels)
}

impl RowPanel {
    /// The unit of its axis; empty for none.
    fn units(&self, reader: &Reader) -> &'static str {
        let first = self.lines.first().map_or("", |(_, name)| name);
        let units = reader.scalars().iter().find(|series| series.name == first).map_or("", |s| s.units);
        if units == "1" { "" } else { units }
    }

    /// The panel over these rows.
    pub(super) fn curves(
        &self,
        reader: &Reader,
        rows: &Rows,
        log: Option<bool>,
    ) -> Result<Curves, StoreError> {
        let (up, steps) = match self.states {
            [] if self.label == "number" => (Axis::linear("number", "").counting(), false),
            [] => (Axis::linear(self.label, self.units(reader)), false),
            names => (Axis::states(self.label, names), true),
        };
        let time = reader.series("time")?;
        let mut curves = Curves::new(self.title, rows.axis(log), up);
        for (name, series) in &self.lines {
            let line = Series::new(*name, Style::Line, &time, values(reader, series)?);
            curves = curves.with(if steps { line.stepped() } else { line });
        }
        // The errors of answers stand at the rows that they belong to.
        let mut legend = "error of the answer";
        for bar in
            reader.error_bars().iter().filter(|bar| self.lines.iter().any(|(_, name)| *name == bar.name))
        {
            let (Some(at), Some(value), Some(error)) = (bar.at, bar.value, bar.error) else { continue };
            curves =
                curves.with(Series::new(legend, Style::Reference, [at; 2], [value - error, value + error]));
            legend = "";
        }
        Ok(curves)
    }

    /// The panel over the numbers of these rows, as points.
    pub(super) fn points(&self, reader: &Reader, kept: &[usize]) -> Result<Curves, StoreError> {
        let up = match self.label {
            "number" => Axis::linear(self.label, "").counting(),
            label => Axis::log(label, ""),
        };
        let mut curves = Curves::new(self.title, Axis::linear("row", "").counting(), up);
        for (name, series) in &self.lines {
            let values = values(reader, series)?;
            let points = kept.iter().filter_map(|row| Some([*row as f64, *values.get(*row)?]));
            curves = curves.with(Series::through(*name, Style::Points, points));
        }
        Ok(curves)
    }
}

/// The figure of how the contact evolves.
pub(super) fn evolution(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let figure = over_rows(reader, options, &of_evolution(reader)?)?;
    let temperature = temperature::panel(reader, Rows::within(reader, options)?, options.log)?;
    Ok(figure.with_all(temperature))
}

/// The figure of the quantities that were asked for.
pub(super) fn quantities(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    super::evolution::times(reader)?;
    let panels = of_quantities(reader)?;
    match panels.is_empty() {
        true => Err(reader.no_quantities().into()),
        false => over_rows(reader, options, &panels),
    }
}

fn over_rows(reader: &Reader, options: &Options, panels: &[RowPanel]) -> Result<Figure, PlotError> {
    super::evolution::times(reader)?;
    let rows = Rows::within(reader, options)?;
    let curves = panels.iter().map(|panel| panel.curves(reader, &rows, options.log));
    Ok(Figure::new("").with_all(curves.collect::<Result<Vec<_>, _>>()?))
}
