//! A small picture of a result for lists: colours alone, without axes.

use asperity_io::store::{At, FieldKind, Reader};

use crate::figure::{Figure, Panel};
use crate::result::{Options, Plot, PlotError, figure};

/// Cells of a side at most.
const SIDE: usize = 128;
/// Width and height of curves \[points\], and dots per inch.
const CURVE: [f64; 2] = [190.0, 150.0];
const DOTS: f64 = 72.0;

/// The pressure, or another stored field, at the instant with the largest load, as PNG; of a line contact its curve; where no field
/// is stored, what changes over the rows.
///
/// # Errors
/// [`PlotError`] where the result has no row yet or is damaged.
pub fn thumbnail(reader: &Reader) -> Result<Vec<u8>, PlotError> {
    let fields = &reader.header().fields;
    let field = fields.iter().find(|kind| **kind == FieldKind::Pressure).or(fields.first());
    let plot = field.map(|kind| Plot::Map(*kind)).filter(|_| !reader.field_times().is_empty());
    let whole = match plot {
        Some(plot) => figure(reader, plot, &Options { at: largest_load(reader)?, ..Options::default() })?,
        None => figure(reader, Plot::Evolution, &Options::default())?,
    };
    match whole.panels.into_iter().next() {
        Some(Panel::Map(map)) => Ok(map.icon(SIDE)?),
        Some(Panel::Curves(mut curves)) => {
            curves.title = String::new();
            Ok(Figure::new("").with(curves).panel_size(CURVE).to_png(DOTS)?)
        }
        None => Err(reader.no_rows().into()),
    }
}

/// The stored instant with the largest load.
fn largest_load(reader: &Reader) -> Result<At, PlotError> {
    let loads = reader.series("load")?;
    let load =
        |n: &usize| reader.field_steps().get(*n).and_then(|row| loads.get(*row)).copied().unwrap_or(0.0);
    let instants = 0..reader.field_times().len();
    Ok(instants.rev().max_by(|a, b| load(a).total_cmp(&load(b))).map_or(At::Last, At::Index))
}
