//! Pressure and gap along a line.

use asperity_io::readable::quantity;
use asperity_io::store::{FieldKind, Reader};
use ndarray::{Array2, Axis as Side};

use super::{Line, Options, PlotError, caption, no_contact};
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
        let [at, length] = [at, length].map(|length| quantity(length, "m"));
        let words =
            format!("the line at {} = {at} is outside of the area, which goes from 0 to {length}", name[1]);
        return Err(PlotError::Refused(words));
    }
    let row = ((at / length * cells as f64) as usize).min(cells - 1);
    let place: Vec<f64> =
        (0..grid.cells()[along]).map(|i| (i as f64 + 0.5) * grid.spacing()[along]).collect();
    let end = grid.size()[along];
    let kept = &reader.header().fields;
    let mut figure = Figure::new("").columns(1).panel_size(super::line::PANEL);
    let title = no_contact(reader, index)?;
    let panel = |quantity: &str, unit: &str| {
        Curves::new(
            title.as_str(),
            Axis::linear(name[0].to_string(), "m").between(0.0, end),
            Axis::linear(quantity, unit),
        )
    };
    let of = |values: &Array2<f64>| values.index_axis(Side(1 - along), row).to_vec();
    let fields = |quantity: &str, unit: &str, kinds: &[(FieldKind, &str)]| -> Result<_, PlotError> {
        let mut curves = panel(quantity, unit);
        for (kind, name) in kinds.iter().filter(|(kind, _)| kept.contains(kind)) {
            let values = of(&reader.field(*kind, options.at)?);
            curves = curves.with(Series::new(*name, Style::Line, &place, values));
        }
        Ok((!curves.series.is_empty()).then_some(curves))
    };
    figure = figure.with_all(fields("pressure", "Pa", &[(FieldKind::Pressure, "")])?);
    if kept.contains(&FieldKind::Gap) {
        let gap = super::fields::gap(reader, options.at)?;
        let undeformed = super::fields::undeformed_gap(reader, options.at)?;
        let mut curves =
            panel("gap", "m").with(Series::new("between the bodies", Style::Line, &place, of(&gap)));
        if let Some(undeformed) = &undeformed {
            curves = curves.with(Series::new("undeformed", Style::Dashed, &place, of(undeformed)));
        }
        if reader.header().changes_shape() {
            let start = of(&reader.initial_gap()?);
            curves = curves.with(Series::new("undeformed at the start", Style::Dotted, &place, start));
        }
        figure = figure.with(curves);
        if let Some(undeformed) = undeformed.filter(|_| grid.is_line()) {
            figure = figure.with(super::line::surfaces(reader, index, &gap, &undeformed)?);
        }
    }
    let worn = [(FieldKind::WearDepth, "body"), (FieldKind::CounterbodyWearDepth, "counterbody")];
    let warm = [(FieldKind::FlashTemperature, "track"), (FieldKind::SliderFlashTemperature, "slider")];
    figure = figure
        .with_all(fields("worn depth", "m", &worn)?)
        .with_all(fields("temperature rise", "K", &warm)?)
        .with_all(fields("displacement", "m", &[(FieldKind::Displacement, "")])?);
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
