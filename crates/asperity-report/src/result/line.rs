//! Figures of a line contact: where a plane has maps, curves over x at an instant and pictures over x and time.

use asperity_io::store::{At, FieldKind, Reader, StoreError};
use ndarray::Array2;

use super::fields::contact_states;
use super::{caption, colours, nameless, no_contact};
use crate::figure::{Axes, Axis, COLOURS, Curves, Figure, INK, Map, Series, Style, extent, means, states};

/// Width and height of a panel \[points\].
pub(super) const PANEL: [f64; 2] = [430.0, 180.0];
/// Rows of a picture over time, and most columns.
const ROWS: usize = 256;
const COLUMNS: usize = 1024;
/// Curves of a sweep in one panel, at most.
const MOST_CURVES: usize = 6;

/// A field over x at an instant, and over x and time where several instants are stored.
pub(super) fn field(reader: &Reader, kind: FieldKind, at: At) -> Result<Figure, StoreError> {
    let index = reader.index(at)?;
    let over_velocities = reader.header().axis() == asperity::Axis::Velocity;
    let panel = match over_velocities {
        true => of_velocities(reader, kind, index)?,
        false => curve(reader, kind, At::Index(index))?,
    };
    let mut figure = Figure::new("").columns(1).panel_size(PANEL).with(panel);
    let mut words = caption(reader, index)?;
    if kind == FieldKind::Gap && one(reader, kind, At::Index(index))?.iter().any(|gap| *gap < 0.0) {
        words += super::fields::OVERLAP;
    }
    if over_velocities && reader.field_times().len() > 1 {
        words += " Solid: this velocity.";
    }
    if let Some(map) = over_time(reader, kind)? {
        figure = figure.with(Map { line: Some(reader.field_times()[index]), ..map });
        words += " The map: over x and time, at each time the nearest stored instant; its line: this time.";
    }
    Ok(figure.caption(words))
}

/// A field over x at some of the stored velocities of a sweep, that of number `index` as a solid line among dashed ones.
fn of_velocities(reader: &Reader, kind: FieldKind, index: usize) -> Result<Curves, StoreError> {
    let count = reader.field_times().len();
    let every = count.div_ceil(MOST_CURVES).max(1);
    let mut panel = Curves::new("", along(reader), axis(reader, kind));
    for n in (0..count).filter(|n| n % every == 0 || *n == index) {
        let name = super::moment(reader, reader.field_times()[n]);
        let values = one(reader, kind, At::Index(n))?.into_raw_vec_and_offset().0;
        let style = if n == index { Style::Line } else { Style::Dashed };
        // A velocity keeps its colour whichever one is shown.
        let colour = if n % every == 0 { COLOURS[n / every % COLOURS.len()] } else { INK };
        panel = panel.with(Series::new(name, style, places(reader), values).in_colour(colour));
    }
    Ok(panel)
}

/// The undeformed gap over x.
pub(super) fn initial_gap(reader: &Reader) -> Result<Figure, StoreError> {
    let panel = Curves::new("", Axis::linear("x", "m"), Axis::linear("undeformed gap", "m"));
    let gap = reader.initial_gap()?.into_raw_vec_and_offset().0;
    Ok(Figure::new("").panel_size(PANEL).with(nameless(panel, &places(reader), gap)))
}

/// Both surfaces in the contact, the deformed one and the other, which stays as it is: z = -u and z = h0 - w, so that their
/// distance is the gap h = h0 - w + u. `gap` is h, `before` h0.
pub(super) fn surfaces(
    reader: &Reader,
    index: usize,
    gap: &Array2<f64>,
    before: &Array2<f64>,
) -> Result<Curves, StoreError> {
    let approach = super::at_instant(reader, index, "approach")?;
    let other: Vec<f64> = before.iter().map(|h0| h0 - approach).collect();
    let deformed: Vec<f64> = other.iter().zip(gap).map(|(z, h)| z - h).collect();
    // Far from the contact the other body rises out of sight: twice the depth of the contact shows what happens.
    let [lowest, highest] = extent(deformed.iter().copied());
    let top = highest + (highest - lowest).max(f64::MIN_POSITIVE);
    let seen = other.into_iter().map(|z| if z <= top { z } else { f64::NAN }).collect::<Vec<_>>();
    let x = places(reader);
    Ok(Curves::new("", Axis::linear("x", "m"), Axis::linear("height", "m"))
        .with(Series::new("deformed surface", Style::Line, &x, deformed))
        .with(Series::new("other surface", Style::Dashed, x, seen)))
}

/// A field over x at a stored instant.
pub(crate) fn curve(reader: &Reader, kind: FieldKind, at: At) -> Result<Curves, StoreError> {
    let values = one(reader, kind, at)?.into_raw_vec_and_offset().0;
    let title = no_contact(reader, reader.index(at)?)?;
    let panel = Curves::new(title, along(reader), axis(reader, kind));
    Ok(nameless(panel, &places(reader), values))
}

/// The horizontal axis: the whole domain, as maps show it.
fn along(reader: &Reader) -> Axis {
    Axis::linear("x", "m").between(0.0, reader.header().grid.size()[0])
}

/// The vertical axis of a field.
fn axis(reader: &Reader, kind: FieldKind) -> Axis {
    match kind {
        FieldKind::Contact => {
            let names: Vec<&str> = contact_states(reader).iter().map(|(name, _)| *name).collect();
            let is_capped = reader
                .header()
                .setup
                .iter()
                .any(|(key, value)| key.starts_with("hardness") && !value.is_null());
            Axis::states("", if is_capped || names.len() > 3 { &names } else { &names[..2] })
        }
        kind => Axis::linear(kind.short_name(), kind.units()),
    }
}

/// A field over x and time; `None` where fewer than two instants are stored, or velocities.
pub(crate) fn over_time(reader: &Reader, kind: FieldKind) -> Result<Option<Map>, StoreError> {
    let times = reader.field_times();
    let (Some(first), Some(last)) = (times.first().copied(), times.last().copied()) else { return Ok(None) };
    if last <= first || reader.header().axis() != asperity::Axis::Time {
        return Ok(None);
    }
    let block = reader.header().grid.cells()[0].div_ceil(COLUMNS);
    let columns = reader.header().grid.cells()[0].div_ceil(block);
    let mut picture = Array2::zeros((columns, ROWS));
    let mut held: Option<(usize, Array2<f64>)> = None;
    let mut whole = [f64::INFINITY, f64::NEG_INFINITY];
    for k in 0..ROWS {
        let time = first + (k as f64 + 0.5) / ROWS as f64 * (last - first);
        let index = reader.index(At::Time(time))?;
        let values = match held.take() {
            Some((of, values)) if of == index => values,
            _ => {
                let values = one(reader, kind, At::Index(index))?;
                whole = extent(values.iter().copied().chain(whole));
                if kind == FieldKind::Contact {
                    states(values.view(), block)
                } else {
                    means(values.view(), block)
                }
            }
        };
        picture.column_mut(k).assign(&values.column(0));
        held = Some((index, values));
    }
    let size = [reader.header().grid.size()[0], last - first];
    let map = match colours(kind) {
        None => Map::states("", contact_states(reader), picture.view(), size),
        Some(colours) => Map::new("", [kind.short_name(), kind.units()], colours, picture.view(), size),
    };
    Ok(Some(Map { whole, ..map.over(Axes::Times { start: first }) }))
}

/// Centres of the cells \[m\].
pub(super) fn places(reader: &Reader) -> Vec<f64> {
    let grid = &reader.header().grid;
    (0..grid.cells()[0]).map(|i| grid.x(i)).collect()
}

fn one(reader: &Reader, kind: FieldKind, at: At) -> Result<Array2<f64>, StoreError> {
    match kind {
        FieldKind::Contact => Ok(reader.contact_states(at)?.mapv(f64::from)),
        FieldKind::Gap => super::fields::gap(reader, at),
        kind => reader.field(kind, at),
    }
}
