//! One file per command.

pub mod answers;
pub mod check;
pub mod compare;
pub mod completions;
pub mod export;
pub mod findings;
pub mod fit_indentation;
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
use crate::input::read;

/// The instant of an option --time: a time, of a sweep a velocity; the last one where the option is not given.
pub fn instant(reader: &Reader, text: Option<&str>) -> Result<At, Failure> {
    Ok(moment(reader, "--time", text)?.map_or(At::Last, At::Time))
}

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
