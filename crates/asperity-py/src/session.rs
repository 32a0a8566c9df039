//! Case files and reports.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity_io::case::Case;
use asperity_io::converge::{ConvergeError, ConvergeOptions};
use asperity_io::session::{self, RunOptions};
use asperity_io::store::Reader;
use asperity_report::page;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error;
use crate::given::{entries, table};
use crate::march::fill;
use crate::wait::{detached, without_python};

/// A case from its file; or from its text, whose relative paths begin at `path`.
fn read(path: &Path, text: Option<&str>, overrides: &[String]) -> PyResult<Case> {
    match text {
        Some(text) => Case::parse(text, path, overrides),
        None => Case::read(path, overrides),
    }
    .map_err(error::case)
}

/// A case given as keys, as the text of a case file.
#[pyfunction]
pub fn case_text(keys: Bound<'_, PyDict>) -> PyResult<String> {
    toml::to_string(&table(&keys)?).map_err(error::file)
}

/// Runs a case; `told` is called with (row, done, total) after each row. Returns a summary.
#[pyfunction]
#[pyo3(signature = (path, text, overrides, output, force, resume, told))]
#[allow(clippy::too_many_arguments)]
pub fn run<'py>(
    py: Python<'py>,
    path: PathBuf,
    text: Option<String>,
    overrides: Vec<String>,
    output: Option<PathBuf>,
    force: bool,
    resume: bool,
    told: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let case = read(&path, text.as_deref(), &overrides)?;
    let interrupt = Arc::new(AtomicBool::new(false));
    let options = RunOptions { output, force, resume, interrupt: interrupt.clone() };
    let mut unheard = None;
    let observe = |progress: session::Progress| {
        // The callback is told the rows, and the stress below the surface comes after the last one.
        let Some(told) = told.as_ref().filter(|_| progress.stress.is_none()) else { return };
        let heard = Python::attach(|py| {
            let row = PyDict::new(py);
            fill(&row, progress.row)?;
            // Where rows are found as the run goes there are as many as so far.
            told.call1(py, (row, progress.done, progress.total.unwrap_or(progress.done))).map(drop)
        });
        if let Err(error) = heard {
            // What the caller raises ends the run after this row.
            interrupt.store(true, std::sync::atomic::Ordering::Relaxed);
            unheard.get_or_insert(error);
        }
    };
    let ran = without_python(py, &interrupt, || session::run(&case, &options, observe))?;
    if let Some(error) = unheard {
        return Err(error);
    }
    let summary = ran.map_err(|failed| error::run(py, failed))?;
    let out = PyDict::new(py);
    out.set_item("status", summary.status.as_str())?;
    out.set_item("steps", summary.rows)?;
    entries!(out, summary; wall_s convolutions iterations peak_memory_bytes result);
    Ok(out)
}

/// The answers of a case with their errors, as JSON.
#[pyfunction]
#[pyo3(signature = (path, text, overrides, refine))]
pub fn converge(
    py: Python<'_>,
    path: PathBuf,
    text: Option<String>,
    overrides: Vec<String>,
    refine: bool,
) -> PyResult<String> {
    let interrupt = Arc::new(AtomicBool::new(false));
    let options = ConvergeOptions { refine, interrupt: interrupt.clone() };
    let of = |more: &[String]| {
        let keys = [&overrides, more].concat();
        match &text {
            Some(text) => Case::parse(text, &path, &keys),
            None => Case::read(&path, &keys),
        }
    };
    let found =
        without_python(py, &interrupt, || asperity_io::converge::converge(&of, None, &options, &mut |_| {}))?;
    let found = found.map_err(|failed| match failed {
        ConvergeError::Case(errors) => error::case(errors),
        ConvergeError::Run { source, .. } => error::run(py, *source),
        other => error::file(other),
    })?;
    serde_json::to_string(&found.bars).map_err(error::file)
}

/// What a case will do, and what was found about it, as JSON.
#[pyfunction]
#[pyo3(signature = (path, text, overrides))]
pub fn check(
    py: Python<'_>,
    path: PathBuf,
    text: Option<String>,
    overrides: Vec<String>,
) -> PyResult<String> {
    let case = read(&path, text.as_deref(), &overrides)?;
    let examined = detached(py, || case.examine())?.map_err(error::case)?;
    serde_json::to_string(&examined).map_err(error::file)
}

/// Writes the report of a stored result.
#[pyfunction]
#[pyo3(signature = (result, output, force, bytes))]
pub fn report(py: Python<'_>, result: PathBuf, output: PathBuf, force: bool, bytes: usize) -> PyResult<()> {
    detached(py, || {
        let reader = Reader::open(&result).map_err(error::file)?;
        let options = page::Options { force, bytes, ..page::Options::default() };
        page::write(&reader, &output, &options).map_err(error::file)
    })?
}
