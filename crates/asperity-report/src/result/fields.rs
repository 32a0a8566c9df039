//! Maps of the fields.

use asperity_io::store::{At, FieldKind, Reader, StoreError};
use ndarray::Array2;
use serde_json::Value;

use super::caption;
use crate::figure::{Colours, Figure, Map, Panel};

/// Names and colours of the contact states.
pub(super) const CONTACT_STATES: [(&str, [u8; 3]); 3] =
    [("open", [240, 240, 238]), ("contact", [0, 114, 178]), ("at hardness", [213, 94, 0])];

pub(super) fn map(reader: &Reader, kind: FieldKind, at: At) -> Result<Figure, StoreError> {
    let values = reader.field(kind, at)?;
    let index = reader.index(at)?;
    let (title, colours) = match kind {
        FieldKind::Pressure => ("Pressure", Colours::Heat),
        FieldKind::Gap => ("Gap", Colours::Sequential),
        FieldKind::Displacement => ("Displacement", Colours::Sequential),
        FieldKind::Flattening => ("Permanent flattening", Colours::Sequential),
        FieldKind::Contact => return contact(reader, at),
    };
    let size = reader.header().grid.size();
    let map = Map::new("", [&title.to_lowercase(), kind.units()], colours, values.view(), size);
    single(map, caption(reader, index)?)
}

pub(super) fn contact(reader: &Reader, at: At) -> Result<Figure, StoreError> {
    let states = contact_states(reader, at)?;
    let names = CONTACT_STATES.map(|(name, colour)| (name.to_owned(), colour)).to_vec();
    let map = Map::states("", names, states.mapv(f64::from).view(), reader.header().grid.size());
    single(map, caption(reader, reader.index(at)?)?)
}

pub(super) fn initial_gap(reader: &Reader) -> Result<Figure, StoreError> {
    let values = reader.initial_gap()?;
    let size = reader.header().grid.size();
    let map = Map::new("", ["undeformed gap", "m"], Colours::Sequential, values.view(), size);
    single(map, String::new())
}

fn single(map: Map, caption: String) -> Result<Figure, StoreError> {
    let figure = Figure { panel: [345.0, 280.0], panels: vec![Panel::Map(map)], ..Figure::new("") };
    Ok(figure.caption(caption))
}

/// The field that tells contact: the states where they were kept, else the pressure, else the gap.
pub(super) fn contact_kind(reader: &Reader) -> Option<FieldKind> {
    let kept = &reader.header().fields;
    [FieldKind::Contact, FieldKind::Pressure, FieldKind::Gap].into_iter().find(|kind| kept.contains(kind))
}

/// The contact states at an instant, from whatever field tells them. (The gap of a cell in contact is zero to
/// rounding, and below zero at the hardness.)
pub(crate) fn contact_states(reader: &Reader, at: At) -> Result<Array2<u8>, StoreError> {
    let hardness = reader.header().setup.get("hardness").and_then(Value::as_f64).unwrap_or(f64::INFINITY);
    Ok(match contact_kind(reader) {
        Some(FieldKind::Contact) | None => reader.contact(at)?,
        Some(FieldKind::Pressure) => reader
            .field(FieldKind::Pressure, at)?
            .mapv(|p| u8::from(p > 0.0) + u8::from(p > 0.0 && p >= hardness * (1.0 - 1e-12))),
        Some(kind) => {
            let gap = reader.field(kind, at)?;
            let deepest = gap.iter().copied().filter(|h| h.is_finite()).fold(0.0, |a: f64, h| a.max(h.abs()));
            gap.mapv(|h| u8::from(h <= 1e-9 * deepest))
        }
    })
}
