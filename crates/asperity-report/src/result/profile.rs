//! Pressure and gap along a line.

use asperity_io::readable::quantity;
use asperity_io::store::{FieldKind, Reader};
use ndarray::{ArrayView1, ArrayView2, Axis as Side};

use super::{Line, Options, PlotError, caption, nameless, no_contact};
use crate::figure::{Axis, Curves, Figure, Series, Style};

pub(super) fn profile(reader: &Reader, options: &Options) -> Result<Figure, PlotError> {
    let grid = &reader.header().grid;
    let index = reader.index(options.at)?;
    let (along, across, name) = match options.line {
        Line::AlongX(at) => (0, at, ['x', 'y']),
        Line::AlongY(at) => (1, at, ['y', 'x']),
    };
    let (length, cells) = (grid.size()[1 - along], grid.cells()[1 - along]);
    let at = across.unwrap_or(0.5 * length);
    if !(0.0..=length).contains(&at) {
        return Err(PlotError::Outside { axis: name[1], at, length });
    }
    let row = ((at / length * cells as f64) as usize).min(cells - 1);
    let place: Vec<f64> =
        (0..grid.cells()[along]).map(|i| (i as f64 + 0.5) * grid.spacing()[along]).collect();
    let axis = || Axis::linear(name[0].to_string(), "m");

    let kept = &reader.header().fields;
    let mut figure = Figure::new("").columns(1);
    figure.panel = [430.0, 180.0];
    let title = no_contact(reader, index)?;
    if kept.contains(&FieldKind::Pressure) {
        let pressure = reader.field(FieldKind::Pressure, options.at)?;
        let panel = Curves::new(title.as_str(), axis(), Axis::linear("pressure", "Pa"));
        figure = figure.with(nameless(panel, &place, line(pressure.view(), along, row).to_vec()));
    }
    if kept.contains(&FieldKind::Gap) {
        let gap = super::fields::gap(reader, options.at)?;
        let before = reader.initial_gap()?;
        let start = line(before.view(), along, row).to_vec();
        let panel = Curves::new(title.as_str(), axis(), Axis::linear("gap", "m"))
            .with(Series::new("now", Style::Line, place.clone(), line(gap.view(), along, row).to_vec()))
            .with(Series::new("undeformed", Style::Dashed, place.clone(), start));
        figure = figure.with(panel);
        if grid.is_line() {
            figure = figure.with(super::line::surfaces(reader, index, &gap)?);
        }
    }
    if kept.contains(&FieldKind::Displacement) {
        let displacement = reader.field(FieldKind::Displacement, options.at)?;
        let panel = Curves::new(title.as_str(), axis(), Axis::linear("displacement", "m"));
        figure = figure.with(nameless(panel, &place, line(displacement.view(), along, row).to_vec()));
    }
    if figure.panels.is_empty() {
        return Err(reader.no_field(FieldKind::Pressure).into());
    }
    if grid.is_line() {
        return Ok(figure.caption(caption(reader, index)?));
    }
    let exact = (row as f64 + 0.5) * grid.spacing()[1 - along];
    Ok(figure.caption(format!(
        "Along {} at {} = {}. {}",
        name[0],
        name[1],
        quantity(exact, "m"),
        caption(reader, index)?
    )))
}

fn line(values: ArrayView2<f64>, along: usize, row: usize) -> ArrayView1<f64> {
    values.index_axis_move(Side(1 - along), row)
}
