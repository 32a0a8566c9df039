//! Maps of the fields.

use asperity_io::store::{At, FieldKind, Reader, StoreError};
use ndarray::Array2;

use super::{Options, PlotError, caption, colours, line, no_contact};
use crate::figure::{Colours, Figure, Map, OPEN, State};

/// Names and colours of the contact states.
const CONTACT_STATES: &[State] = &[("open", OPEN), ("contact", [0, 114, 178]), ("at hardness", [213, 94, 0])];

/// The same with friction.
const SLIP_STATES: &[State] = &[
    ("open", OPEN),
    ("sticking", [0, 114, 178]),
    ("sticking at hardness", [213, 94, 0]),
    ("slipping", [230, 159, 0]),
];

/// The states that cells of a result may have: slipping only with friction.
pub(super) fn contact_states(reader: &Reader) -> &'static [State] {
    if reader.header().slips() { SLIP_STATES } else { CONTACT_STATES }
}

/// The state of a cell whose pressure is the hardness.
const AT_HARDNESS: u8 = 2;

/// Gaps below this share of the largest undeformed gap or displacement are closed but for rounding errors.
const ROUNDING: f64 = 1e-12;

/// Words for captions of the gap where cells are at the hardness.
pub(super) const OVERLAP: &str = " Negative: the surfaces overlap at the hardness, where the pressure is cut off; the overlap is plastic flattening.";

/// The gap at an instant, 0 in contact, where rounding errors remain; at the hardness the overlap, which is negative.
pub(super) fn gap(reader: &Reader, at: At) -> Result<Array2<f64>, StoreError> {
    let mut gap = reader.field(FieldKind::Gap, at)?;
    let states = reader.contact_states(at)?;
    let approach = super::at_instant(reader, reader.index(at)?, "approach")?;
    let finite = |values: Array2<f64>| values.into_iter().filter(|v| v.is_finite());
    let largest = finite(reader.initial_gap()?).fold(approach.abs(), |most, v| most.max(v.abs()));
    gap.zip_mut_with(&states, |gap, state| {
        let overlaps = *state == AT_HARDNESS && *gap < 0.0;
        if (*state > 0 && !overlaps) || gap.abs() < ROUNDING * largest {
            *gap = 0.0;
        }
    });
    Ok(gap)
}

/// The gap between the undeformed surfaces at an instant; where they move, wear or flatten from the fields of that instant, `None` where
/// these are not kept.
pub(super) fn undeformed_gap(reader: &Reader, at: At) -> Result<Option<Array2<f64>>, StoreError> {
    let header = reader.header();
    let keeps = |kind| header.fields.contains(&kind);
    if keeps(FieldKind::UndeformedGap) {
        return Ok(Some(reader.field(FieldKind::UndeformedGap, at)?));
    }
    if !header.changes_shape() && !header.moves_in_time() {
        return Ok(Some(reader.initial_gap()?));
    }
    if !keeps(FieldKind::Gap) || !keeps(FieldKind::Displacement) {
        return Ok(None);
    }
    // h = h0 - w + u
    let approach = super::at_instant(reader, reader.index(at)?, "approach")?;
    let rise = reader.field(FieldKind::Displacement, at)?;
    Ok(Some(reader.field(FieldKind::Gap, at)? + approach - rise))
}

/// The map of a field at an instant.
pub(super) fn map(reader: &Reader, kind: FieldKind, at: At) -> Result<Figure, PlotError> {
    if reader.header().grid.is_line() {
        return Ok(line::field(reader, kind, at)?);
    }
    let Some(colours) = colours(kind) else { return states(reader, at) };
    let label = kind.short_name();
    let is_tension = kind == FieldKind::Pressure && reader.header().adhesion().is_some();
    let colours = if is_tension { Colours::Diverging } else { colours };
    let values = if kind == FieldKind::Gap { gap(reader, at)? } else { reader.field(kind, at)? };
    let index = reader.index(at)?;
    let touches = |value: &f64| *value == 0.0;
    let (heading, light) = match kind {
        FieldKind::Gap if values.iter().all(touches) => (
            format!("The bodies touch everywhere at {}", super::moment(reader, reader.field_times()[index])),
            "",
        ),
        FieldKind::Gap if values.iter().any(touches) => (String::new(), " Light: contact."),
        FieldKind::Pressure if is_tension => (String::new(), " Negative: the surfaces pull at each other."),
        FieldKind::Pressure | FieldKind::ContactPressure
            if values.iter().any(|pressure| *pressure <= 0.0) =>
        {
            (no_contact(reader, index)?, " Light: no contact.")
        }
        FieldKind::FlashTemperature => (no_contact(reader, index)?, " Above the surroundings."),
        FieldKind::SliderFlashTemperature => {
            (no_contact(reader, index)?, " Of the slider, above the surroundings.")
        }
        _ if values.iter().all(touches) => {
            (format!("0 everywhere at {}: {label}", super::moment(reader, reader.field_times()[index])), "")
        }
        _ => (no_contact(reader, index)?, ""),
    };
    let size = reader.header().grid.size();
    let map = Map::new(heading, [label, kind.units()], colours, values.view(), size);
    let overlap = if kind == FieldKind::Gap && values.iter().any(|gap| *gap < 0.0) { OVERLAP } else { "" };
    let unknown = if values.iter().any(|value| value.is_nan()) { " Grey: beyond the domain." } else { "" };
    Ok(single(map, caption(reader, index)? + light + unknown + overlap))
}

/// The map of the contact states.
fn states(reader: &Reader, at: At) -> Result<Figure, PlotError> {
    let states = reader.contact_states(at)?;
    let index = reader.index(at)?;
    let title = no_contact(reader, index)?;
    let names = contact_states(reader);
    let map = Map::states(title, names, states.mapv(f64::from).view(), reader.header().grid.size());
    Ok(single(map, caption(reader, index)?))
}

pub(super) fn initial_gap(reader: &Reader, _: &Options) -> Result<Figure, PlotError> {
    if reader.header().grid.is_line() {
        return Ok(line::initial_gap(reader)?);
    }
    let values = reader.initial_gap()?;
    let size = reader.header().grid.size();
    let map = Map::new("", ["undeformed gap", "m"], Colours::Sequential, values.view(), size);
    Ok(single(map, String::new()))
}

fn single(map: Map, caption: String) -> Figure {
    Figure::new("").with(map).panel_size([345.0, 280.0]).caption(caption)
}
