//! What is wrong with a file of measured curves.

use std::path::PathBuf;

use thiserror::Error;

/// A file of measured curves that cannot be used, with the line.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{}{}: {message}", path.display(), line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct CurveError {
    /// The file.
    pub path: PathBuf,
    /// Line of the file, from 1, where one is to blame.
    pub line: Option<usize>,
    /// What is wrong, what was expected, what to do.
    pub message: String,
}

/// A fault before its file is known.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Fault {
    pub line: Option<usize>,
    pub message: String,
}

pub(super) fn fault(message: impl Into<String>) -> Fault {
    Fault { line: None, message: message.into() }
}

impl Fault {
    pub(super) fn at(self, line: usize) -> Fault {
        Fault { line: Some(line), ..self }
    }

    pub(super) fn of(self, path: &std::path::Path) -> CurveError {
        CurveError { path: path.to_owned(), line: self.line, message: self.message }
    }
}
