//! What can go wrong with an export.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::store::StoreError;
use crate::stress::StressError;

/// The error of an export.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The output is there already and may not be replaced.
    #[error("{} exists already; choose another output or replace it with --force", .path.display())]
    Exists {
        /// The output asked for.
        path: PathBuf,
    },
    /// The output is there and is not what this export writes, so that it is never removed.
    #[error("{} {found}; it is not overwritten; choose another output or move it away", .path.display())]
    Foreign {
        /// The output asked for.
        path: PathBuf,
        /// What was found there, as the rest of a sentence.
        found: String,
    },
    /// The operating system refused to write.
    #[error("cannot write {}: {source}", .path.display())]
    Io {
        /// The file or directory.
        path: PathBuf,
        /// The system's answer.
        source: io::Error,
    },
    /// The format cannot hold the result.
    #[error("{format} cannot hold {what}; {hint}")]
    Limit {
        /// The format.
        format: &'static str,
        /// What is too large.
        what: String,
        /// What to do.
        hint: &'static str,
    },
    /// The stress cannot be computed like this.
    #[error(transparent)]
    Stress(#[from] StressError),
    /// The result cannot be read, or does not hold what was asked for.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl From<asperity::Error> for ExportError {
    fn from(error: asperity::Error) -> Self {
        ExportError::Stress(error.into())
    }
}

/// Result of an export.
pub type Result<T, E = ExportError> = std::result::Result<T, E>;

/// An error of writing a file; its path is added later.
impl From<io::Error> for ExportError {
    fn from(source: io::Error) -> Self {
        ExportError::Io { path: PathBuf::new(), source }
    }
}

impl From<rust_hdf5::Hdf5Error> for ExportError {
    fn from(error: rust_hdf5::Hdf5Error) -> Self {
        match error {
            rust_hdf5::Hdf5Error::Io(error) => error.into(),
            other => io::Error::other(other).into(),
        }
    }
}

impl ExportError {
    /// The error with the path of the output, if it names no path yet.
    pub(super) fn at(self, path: &Path) -> ExportError {
        let (path, found) = (path.to_owned(), crate::output::no_file(path));
        match self {
            ExportError::Io { path: known, source, .. } if known.as_os_str().is_empty() => {
                match source.kind() {
                    ErrorKind::AlreadyExists => ExportError::Exists { path },
                    ErrorKind::IsADirectory | ErrorKind::InvalidInput if found.is_some() => {
                        ExportError::Foreign { path, found: found.unwrap_or_default().into() }
                    }
                    _ => ExportError::Io { path, source },
                }
            }
            other => other,
        }
    }
}
