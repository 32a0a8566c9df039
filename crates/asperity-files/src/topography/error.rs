//! Why a file cannot be read or written as a topography, and what to do about it.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::{Format, format};

/// Result of reading or writing one.
pub(super) type Result<T, E = Problem> = std::result::Result<T, E>;

/// A file that cannot be read or written as a topography.
#[derive(Debug, Error)]
#[error("{}{problem}", match .path { Some(path) => format!("{}: ", path.display()), None => String::new() })]
pub struct TopographyError {
    /// The file, where the topography came from or goes to one.
    pub path: Option<PathBuf>,
    /// What is wrong.
    #[source]
    pub problem: Problem,
}

/// What is wrong with a topography file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Problem {
    /// The operating system refuses.
    #[error("{}", crate::resources::told(.0))]
    Io(#[from] std::io::Error),
    /// The file takes more memory than there is.
    #[error("{0}; crop or thin it out first")]
    TooLarge(String),
    /// The content is in no known format.
    #[error(
        "the content is in none of the known formats ({}); export it from the instrument's software as x3p, sdf or text",
        format::list(Format::ALL.iter().copied())
    )]
    Unrecognised,
    /// The content belongs to a known format that is not read.
    #[error("this format is not read: {name}; {instead}")]
    Foreign {
        /// Format and instrument.
        name: String,
        /// What to do.
        instead: String,
    },
    /// The file states no physical size, or one without a unit.
    #[error(
        "the {format} file holds no physical size{detail}; give the lengths along x and y (`size`, --size A,B)"
    )]
    MissingSize {
        /// Format of the file.
        format: Format,
        /// What it holds instead.
        detail: String,
    },
    /// The file states neither.
    #[error(
        "the {format} file holds neither its physical size{size} nor a unit of length for its heights{unit}; give both (`size` and \
         `height_unit`; --size A,B --height-unit U), as in --size '100 um, 100 um' --height-unit nm"
    )]
    MissingSizeAndHeightUnit {
        /// Format of the file.
        format: Format,
        /// What it holds in place of a size.
        size: String,
        /// What it holds in place of a unit.
        unit: String,
    },
    /// A profile of so many heights has neither positions nor a length.
    #[error(
        "the file holds {0} heights without their positions; give the length of the profile, {0} times the spacing of its points \
         (`size = [\"4 mm\"]`, --size '4 mm'), or a file with two columns, position and height"
    )]
    MissingLength(usize),
    /// A profile of so many heights has neither positions, a length, nor a unit.
    #[error(
        "the file holds {0} heights without their positions and without a unit; give the length of the profile, {0} times the spacing of its \
         points, and the unit of the heights (`size` and `height_unit`; --size L --height-unit U), as in --size '4 mm' --height-unit um"
    )]
    MissingLengthAndHeightUnit(usize),
    /// The file states no unit of the heights, or a unit that is not a length.
    #[error(
        "the {format} file holds no unit of length for its heights{detail}; give it (`height_unit`, --height-unit U)"
    )]
    MissingHeightUnit {
        /// Format of the file.
        format: Format,
        /// What it holds instead.
        detail: String,
    },
    /// No channel of that name.
    #[error("no channel {wanted:?}; the file holds {}", list(.available))]
    NoChannel {
        /// The name or number asked for.
        wanted: String,
        /// What the file has.
        available: Vec<String>,
    },
    /// The file holds nothing that can be heights over a rectangle.
    #[error("the {format} file holds no map of heights: {detail}")]
    NoHeights {
        /// Format of the file.
        format: Format,
        /// What it holds instead.
        detail: String,
    },
    /// The file ends too early.
    #[error("{what} needs {needed} bytes, but {available} are left; the file is truncated")]
    Truncated {
        /// The part of the file.
        what: String,
        /// Its length.
        needed: u64,
        /// What the file still has.
        available: u64,
    },
    /// A value in the file that the format does not allow.
    #[error("{what} is {value}, but must be {expected}")]
    Malformed {
        /// The part of the file, with the line where it is text.
        what: String,
        /// What the file says.
        value: String,
        /// What it must say.
        expected: String,
    },
    /// Allowed by the format, but not read here.
    #[error("{what} is not supported; {instead}")]
    Unsupported {
        /// The feature.
        what: String,
        /// What to do.
        instead: String,
    },
    /// An option that the caller gave.
    #[error("{what} is {value}, but must be {expected}")]
    Option {
        /// The option.
        what: &'static str,
        /// As given.
        value: String,
        /// What is accepted.
        expected: String,
    },
}

impl TopographyError {
    /// A problem with the file at `path`.
    pub(super) fn at(path: &Path) -> impl Fn(Problem) -> TopographyError {
        move |problem| TopographyError { path: Some(path.to_owned()), problem }
    }
}

/// A problem with bytes that come from no file.
impl From<Problem> for TopographyError {
    fn from(problem: Problem) -> Self {
        TopographyError { path: None, problem }
    }
}

impl Problem {
    /// `what` is `value`, but must be `expected`.
    pub(super) fn malformed(
        what: impl Into<String>,
        value: impl ToString,
        expected: impl Into<String>,
    ) -> Self {
        let mut value = value.to_string();
        // A hostile file must not fill the terminal.
        if value.chars().count() > 80 {
            value = value.chars().take(80).chain(['…']).collect();
        }
        Problem::Malformed { what: what.into(), value, expected: expected.into() }
    }

    /// `what` needs `needed` bytes of `available`.
    pub(super) fn truncated(what: impl Into<String>, needed: u64, available: u64) -> Self {
        Problem::Truncated { what: what.into(), needed, available }
    }

    /// # Errors
    /// Where fewer bytes of the file are left than `what` needs.
    pub(super) fn check_length(what: &str, needed: u64, available: usize) -> Result<()> {
        match needed <= available as u64 {
            true => Ok(()),
            false => Err(Problem::truncated(what, needed, available as u64)),
        }
    }

    /// `what` is not read here; do `instead`.
    pub(super) fn unsupported(what: impl Into<String>, instead: impl Into<String>) -> Self {
        Problem::Unsupported { what: what.into(), instead: instead.into() }
    }
}

fn list(names: &[String]) -> String {
    const SHOWN: usize = 20;
    if names.is_empty() {
        return "one surface without a name; leave the channel out".to_owned();
    }
    let mut text: Vec<String> =
        names.iter().take(SHOWN).enumerate().map(|(i, n)| format!("{i}: {n:?}")).collect();
    if names.len() > SHOWN {
        text.push(format!("and {} more", names.len() - SHOWN));
    }
    text.join(", ")
}
