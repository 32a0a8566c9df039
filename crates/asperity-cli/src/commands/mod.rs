//! One file per command.

pub mod answers;
pub mod app;
pub mod check;
pub mod compare;
pub mod completions;
pub mod converge;
pub mod export;
pub mod findings;
pub mod fit_indentation;
pub mod force_curve;
mod force_file;
pub mod labels;
pub mod leak;
pub mod material;
pub mod new;
pub mod picture;
pub mod plot;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod schema;
pub mod seal;
pub mod show;
pub mod stress;
pub mod study;
pub mod surface;
pub mod verify;
pub mod verify_result;
pub mod view;

use std::path::Path;

use asperity::Axis;
use asperity_io::quantity::range::NonNegative;
use asperity_io::quantity::{Time, Velocity};
use asperity_io::store::{At, Reader};

use crate::failure::Failure;
use crate::format::coordinate;
use crate::input::read;

/// The instant of an option --time: a time, of a sweep a velocity; the last one where the option is not given.
pub fn instant(reader: &Reader, text: Option<&str>) -> Result<At, Failure> {
    let Some(wanted) = moment(reader, "--time", text)? else { return Ok(At::Last) };
    let taken = reader.field_times()[reader.index(At::Time(wanted))?];
    if (taken - wanted).abs() > NEAR * wanted.abs() {
        let [wanted, taken] = [wanted, taken].map(|value| coordinate(reader.header().axis().at(value)));
        crate::messages::message!("note: no map is stored at {wanted}; this is the nearest one, at {taken}");
    }
    Ok(At::Time(wanted))
}

/// A stored map is that of the time asked for if it is as near as this share.
const NEAR: f64 = 1e-2;

/// An option that names a time \[s\], of a sweep a velocity \[m/s\].
fn moment(reader: &Reader, option: &str, text: Option<&str>) -> Result<Option<f64>, Failure> {
    let Some(text) = text else { return Ok(None) };
    Ok(Some(match reader.header().axis() {
        Axis::Velocity => read::<Velocity>(option, text)?.get(),
        Axis::Time | Axis::None => read::<Time>(option, text)?.get(),
    }))
}

/// The times \[s\] of an option --times; `None` for all that are stored.
pub fn times(list: &str) -> Result<Option<Vec<f64>>, Failure> {
    if ["fields", "all"].contains(&list.trim()) {
        return Ok(None);
    }
    let time = |text: &str| Ok(read::<Time<NonNegative>>("--times", text)?.get());
    list.split(',').map(time).collect::<Result<_, Failure>>().map(Some)
}

/// The name of a file, as the title of a figure.
fn title(path: &Path) -> String {
    path.file_name().map_or(String::new(), |name| name.to_string_lossy().into_owned())
}
