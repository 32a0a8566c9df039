//! What can go wrong with a result, with the path and what to do about it.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::readable::bytes;

/// The error of every call of the result store.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StoreError {
    /// The output exists already and must not be replaced.
    #[error("{} exists already; choose another output, replace it with --force or continue it with --resume", .path.display())]
    Exists {
        /// The output asked for.
        path: PathBuf,
    },
    /// The output exists, but is not a result or holds other files too: it is never removed.
    #[error("{} {found}; it is not overwritten; choose another output or move it away", .path.display())]
    Foreign {
        /// The output asked for.
        path: PathBuf,
        /// What was found there, as the rest of a sentence.
        found: String,
    },
    /// The operating system refused to read or write.
    #[error("cannot {action} {}: {source}{}", .path.display(), hint(.source))]
    Io {
        /// The file or directory.
        path: PathBuf,
        /// What was tried, as a verb.
        action: &'static str,
        /// The system's answer.
        source: io::Error,
    },
    /// There is no result at this path.
    #[error("{} is not a result of asperity: {why}", .path.display())]
    NotAResult {
        /// The path given.
        path: PathBuf,
        /// What is missing.
        why: String,
    },
    /// The result was written by a later version in a form that this one does not know.
    #[error("{} was written by asperity {version} in format version {schema}; this version reads up to {known}; update asperity", .path.display())]
    Newer {
        /// The result.
        path: PathBuf,
        /// Version that wrote it.
        version: String,
        /// Its schema number.
        schema: u64,
        /// The latest schema number known here.
        known: u64,
    },
    /// A file of the result is damaged.
    #[error("{} is damaged: {what}; {hint}", .path.display())]
    Corrupt {
        /// The damaged file.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
        /// What to do.
        hint: &'static str,
    },
    /// This version cannot resume from a checkpoint of this form.
    #[error("{} is a checkpoint of an earlier asperity ({version}), which this version cannot go on from; the rows stored ({rows}) are \
             kept: resume with the earlier version, or run the case again with --force", .path.display())]
    FormerCheckpoint {
        /// The checkpoint.
        path: PathBuf,
        /// Version that wrote the result.
        version: String,
        /// Rows stored.
        rows: usize,
    },
    /// The run cannot resume this result: it belongs to another case.
    #[error("{} belongs to another case: {what} is {stored}, now {given}; restore the case, or start again with another output or --force", .path.display())]
    Mismatch {
        /// The result.
        path: PathBuf,
        /// The quantity that differs.
        what: String,
        /// As stored.
        stored: String,
        /// As given now.
        given: String,
    },
    /// The run that wrote the result is done, nothing is left to resume.
    #[error("{} is complete ({rows} rows); nothing is left to resume", .path.display())]
    Complete {
        /// The result.
        path: PathBuf,
        /// Rows stored.
        rows: usize,
    },
    /// Another process is writing this result.
    #[error("{} is being written by another process; wait for it or choose another output", .path.display())]
    Busy {
        /// The result.
        path: PathBuf,
    },
    /// The result does not hold what was asked for.
    #[error("{} holds no {what}; {instead}", .path.display())]
    Missing {
        /// The result.
        path: PathBuf,
        /// What was asked for.
        what: String,
        /// What it holds instead, or what to do, as a sentence.
        instead: String,
    },
    /// The result would not fit on the disk.
    #[error("{} would take up to {} (numbers that repeat take less), but {} are free on its disk; keep fewer fields (output.fields, output.every) or choose another disk", .path.display(), bytes(*.needed as f64), bytes(*.free as f64))]
    NoSpace {
        /// The output asked for.
        path: PathBuf,
        /// Size of its numbers before compression \[byte\].
        needed: u64,
        /// Free space of the disk \[byte\].
        free: u64,
    },
    /// What was given to the store does not fit the result.
    #[error("{what} is {value}, but must be {expected}")]
    Input {
        /// The quantity.
        what: String,
        /// As given.
        value: String,
        /// What fits.
        expected: String,
    },
}

/// Result of the store.
pub type Result<T, E = StoreError> = std::result::Result<T, E>;

/// What to do about an answer of the operating system; empty where its own text says enough.
fn hint(error: &io::Error) -> &'static str {
    use io::ErrorKind::*;
    match error.kind() {
        StorageFull | QuotaExceeded | FileTooLarge => {
            "; free some space (the finished steps of a run are kept, --resume goes on with it)"
        }
        NotFound => "; create its directory first or correct the path",
        PermissionDenied | ReadOnlyFilesystem => "; choose a place that you may write to",
        _ => "",
    }
}

/// `.map_err(io("write", path))` for calls of the operating system.
pub(crate) fn io<'a>(action: &'static str, path: &'a Path) -> impl Fn(io::Error) -> StoreError + 'a {
    move |source| StoreError::Io { path: path.to_owned(), action, source }
}

pub(super) fn corrupt(path: &Path, what: impl std::fmt::Display) -> StoreError {
    StoreError::Corrupt {
        path: path.to_owned(),
        what: what.to_string(),
        hint: "restore the result from a copy or run the case again",
    }
}

pub(super) fn input(
    what: impl Into<String>,
    value: impl std::fmt::Display,
    expected: impl Into<String>,
) -> StoreError {
    StoreError::Input { what: what.into(), value: value.to_string(), expected: expected.into() }
}
