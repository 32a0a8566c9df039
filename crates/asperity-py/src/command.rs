//! The command `asperity`, run in the process of Python: a wheel carries it so, without a second copy of the numerics.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command with these words and returns its exit code.
#[pyfunction]
pub fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| asperity_cli::command(words))
}
