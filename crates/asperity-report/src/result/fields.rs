//! Maps of the fields.

use asperity_io::store::{At, FieldKind, Reader, StoreError};

use super::{caption, line, no_contact};
use crate::figure::{Colours, Figure, Map, OPEN, Panel};

/// Names and colours of the contact states.
pub(super) const CONTACT_STATES: [(&str, [u8; 3]); 3] =
    [("open", OPEN), ("contact", [0, 114, 178]), ("at hardness", [213, 94, 0])];

/// The map of a field at an instant, for colours by the logarithm where `log`.
pub(super) fn map(reader: &Reader, kind: FieldKind, at: At, log: bool) -> Result<Figure, StoreError> {
    if reader.header().grid.is_line() {
        return line::field(reader, kind, at);
    }
    let mut values = reader.field(kind, at)?;
    if kind == FieldKind::Gap && log && reader.contact_kind().is_some() {
        // In contact the gap is closed to rounding errors, which have decades of their own.
        let states = reader.contact_states(at)?;
        values.zip_mut_with(&states, |gap, state| *gap = if *state > 0 { 0.0 } else { *gap });
    }
    let index = reader.index(at)?;
    let (title, colours) = match kind {
        FieldKind::Pressure => ("Pressure", Colours::Pressure),
        FieldKind::Gap => ("Gap", Colours::Sequential),
        FieldKind::Displacement => ("Displacement", Colours::Sequential),
        FieldKind::Flattening => ("Permanent flattening", Colours::Sequential),
        FieldKind::Contact => return contact(reader, at),
    };
    let size = reader.header().grid.size();
    let label = [&title.to_lowercase(), kind.units()];
    let map = Map::new(no_contact(reader, index)?, label, colours, values.view(), size);
    let open = if kind == FieldKind::Pressure { " Light: no contact." } else { "" };
    single(map, caption(reader, index)? + open)
}

pub(super) fn contact(reader: &Reader, at: At) -> Result<Figure, StoreError> {
    if reader.header().grid.is_line() {
        return line::field(reader, FieldKind::Contact, at);
    }
    let states = reader.contact_states(at)?;
    let index = reader.index(at)?;
    let names = CONTACT_STATES.map(|(name, colour)| (name.to_owned(), colour)).to_vec();
    let title = no_contact(reader, index)?;
    let map = Map::states(title, names, states.mapv(f64::from).view(), reader.header().grid.size());
    single(map, caption(reader, index)?)
}

pub(super) fn initial_gap(reader: &Reader) -> Result<Figure, StoreError> {
    if reader.header().grid.is_line() {
        return line::initial_gap(reader);
    }
    let values = reader.initial_gap()?;
    let size = reader.header().grid.size();
    let map = Map::new("", ["undeformed gap", "m"], Colours::Sequential, values.view(), size);
    single(map, String::new())
}

fn single(map: Map, caption: String) -> Result<Figure, StoreError> {
    let figure = Figure { panel: [345.0, 280.0], panels: vec![Panel::Map(map)], ..Figure::new("") };
    Ok(figure.caption(caption))
}
