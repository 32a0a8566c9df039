//! A result as a directory of pictures: the maps at every stored instant in the same colours, and the evolution.

use std::fs;
use std::path::Path;

use asperity_io::output::{PartialDirectory, WriteError};
use asperity_io::store::{At, FieldKind, Reader, StoreError};
use asperity_io::stress::StressError;

use crate::figure::{Figure, FigureError, extent};
use crate::result::line::{curve, over_time};
use crate::result::{Options, Plot, PlotError, figure};

/// Writes pictures of a result into a new directory: `evolution.png`, `pressure_0000.png` and so on; `stress.png` and
/// `leak.png` where these were computed. The directory
/// appears whole or not at all; with `force` one that holds pictures only is replaced.
///
/// # Errors
/// [`PlotError`]; [`PlotError::Refused`] where the directory is there already.
pub fn pictures(
    reader: &Reader,
    fields: Option<&[FieldKind]>,
    directory: &Path,
    force: bool,
) -> Result<(), PlotError> {
    check(directory, force)?;
    let failed = |source| FigureError::from(WriteError::at(directory, source));
    let partial = PartialDirectory::new(directory).map_err(failed)?;
    let place = |name: String| partial.place().join(name);
    // Messages name the directory asked for.
    let write = |picture: &Figure, name: &str| match picture.write(&place(name.into()), false) {
        Err(FigureError::Write(WriteError::Io { source, .. })) => Err(failed(source)),
        other => other,
    };
    write(&figure(reader, Plot::Evolution, &Options::default())?, "evolution.png")?;
    if reader.stress().is_some_and(|set| !set.instants.is_empty()) {
        match figure(reader, Plot::Stress, &Options::default()) {
            Ok(picture) => write(&picture, "stress.png")?,
            // Nothing touches.
            Err(PlotError::Stress(StressError::NoContact { .. })) => {}
            Err(error) => return Err(error),
        }
    }
    if reader.leaks().is_some() {
        write(&figure(reader, Plot::Leak, &Options::default())?, "leak.png")?;
    }
    for kind in fields.unwrap_or(&reader.header().fields) {
        let plot = Plot::Map(*kind);
        let limits = range(reader, *kind)?;
        let line = reader.header().grid.is_line();
        if line && let Some(map) = over_time(reader, *kind)? {
            let picture = Figure::new("").with(map).panel_size([430.0, 260.0]);
            fs::write(place(format!("{}_over_time.png", kind.name())), picture.to_png(150.0)?)
                .map_err(failed)?;
        }
        for n in 0..reader.field_times().len() {
            let at = At::Index(n);
            let mut picture = figure(reader, plot, &Options { at, limits, ..Options::default() })?;
            if line {
                let mut curve = curve(reader, *kind, at)?;
                curve.y.range = limits.or(curve.y.range);
                picture.panels = vec![curve.into()];
            }
            let name = place(format!("{}_{n:04}.png", kind.name()));
            fs::write(name, picture.to_png(150.0)?).map_err(failed)?;
        }
    }
    Ok(partial.finish().map_err(failed)?)
}

/// Ends of the colours at all instants: zero to the largest value of any, or the least where that is below.
fn range(reader: &Reader, kind: FieldKind) -> Result<Option<[f64; 2]>, StoreError> {
    if kind == FieldKind::Contact {
        return Ok(None);
    }
    let mut ends = [0.0, 0.0];
    for n in 0..reader.field_times().len() {
        ends = extent(reader.field(kind, At::Index(n))?.into_iter().chain(ends));
    }
    Ok((ends[0] < ends[1]).then_some(ends))
}

fn check(directory: &Path, force: bool) -> Result<(), PlotError> {
    let Ok(found) = fs::symlink_metadata(directory) else { return Ok(()) };
    let taken = |found: &str, more: &str| {
        let path = directory.display();
        PlotError::Refused(format!("{path} {found}; name another directory{more}"))
    };
    if !found.is_dir() {
        return Err(taken("is not a directory", ""));
    }
    let failed = |source| FigureError::from(WriteError::at(directory, source));
    for entry in fs::read_dir(directory).map_err(failed)? {
        let name = entry.map_err(failed)?.file_name();
        if !name.to_str().is_some_and(|name| name.ends_with(".png")) {
            return Err(taken(&format!("holds other files ({})", name.display()), ""));
        }
    }
    if force { Ok(()) } else { Err(taken("is there already", " or give --force")) }
}
