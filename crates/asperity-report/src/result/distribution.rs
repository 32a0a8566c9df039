//! Distributions over the area: pressure, gap, sizes of contact spots.

use asperity::spots::Spots;
use asperity_io::readable::{counted, quantity};
use asperity_io::store::{At, FieldKind, Reader, StoreError};

use super::{boundary, caption};
use crate::figure::{Axis, Curves, Figure, Series, Style};
use crate::histogram;

const BINS: usize = 60;

pub(super) fn histogram(reader: &Reader, at: At) -> Result<Figure, StoreError> {
    let kept = &reader.header().fields;
    let index = reader.index(at)?;
    let mut figure = Figure::new("");
    if kept.contains(&FieldKind::Pressure) {
        let pressure = reader.field(FieldKind::Pressure, at)?;
        let inside: Vec<f64> = pressure.iter().copied().filter(|p| *p > 0.0).collect();
        figure = figure.with(density("Pressure in contact", ["pressure", "Pa"], &inside, "nothing touches"));
    }
    if kept.contains(&FieldKind::Gap) {
        let gap = reader.field(FieldKind::Gap, at)?;
        let states = reader.contact_states(at)?;
        let open: Vec<f64> =
            gap.iter().zip(&states).filter(|(h, s)| **s == 0 && h.is_finite()).map(|(h, _)| *h).collect();
        figure = figure.with(density("Gap out of contact", ["gap", "m"], &open, "no open cell"));
    }
    if figure.panels.is_empty() {
        return Err(reader.no_field(FieldKind::Pressure));
    }
    Ok(figure.caption(format!("Probability densities. {}", caption(reader, index)?)))
}

/// The share of values per unit, over bins from the least (or zero) to the greatest.
fn density(title: &str, [label, unit]: [&str; 2], values: &[f64], none: &str) -> Curves {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min).min(0.0);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let panel = Curves::new(title, Axis::linear(label, unit), Axis::linear("density", format!("1/{unit}")));
    histogram::bars(panel.or_say(none), histogram::density(values, low..=high, BINS))
}

pub(super) fn spots(reader: &Reader, at: At) -> Result<Figure, StoreError> {
    let states = reader.contact_states(at)?;
    let spots = Spots::of(&reader.header().grid, boundary(reader), states.view(), |state| *state > 0);
    // How many spots are at least as large: a straight line for a power law, with no bins to choose.
    let number: Vec<f64> = (1..=spots.len()).map(|n| n as f64).collect();
    let grid = &reader.header().grid;
    let (size, units) = if grid.is_line() { ("length", "m") } else { ("area", "m2") };
    let panel = Curves::new(
        "",
        Axis::log(format!("{size} of a spot"), units),
        Axis::log("spots at least as large", ""),
    )
    .or_say("nothing touches")
    .with(Series::new("", Style::Points, spots.areas.clone(), number));
    let largest = spots.areas.first().copied().unwrap_or(0.0);
    let sizes = format!(
        "{}, mean {size} {}, largest {}. {}",
        counted(spots.len(), "spot"),
        quantity(spots.mean_area(), units),
        quantity(largest, units),
        caption(reader, reader.index(at)?)?
    );
    let mut figure = Figure::new("").with(panel).caption(sizes);
    figure.panel = [345.0, 260.0];
    Ok(figure)
}
