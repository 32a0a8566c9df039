//! Case files and reports.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use asperity_io::case::{Case, CaseErrors};
use asperity_io::converge::{ConvergeError, ConvergeOptions};
use asperity_io::session::{self, RunOptions};
use asperity_io::store::Reader;
use asperity_report::page;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Answer, Failure};
use crate::given::{Dict, table};
use crate::march::fill;
use crate::wait::{detached, without_python};

/// A case from its file; or from its text, whose relative paths begin at `path`.
fn read(path: &Path, text: Option<&str>, overrides: &[String]) -> Result<Case, CaseErrors> {
    match text {
        Some(text) => Case::parse(text, path, overrides),
        None => Case::read(path, overrides),
    }
}

/// A case given as keys, as the text of a case file.
#[pyfunction]
pub fn case_text(keys: Dict<'_>) -> Answer<String> {
    toml::to_string(&table(&keys)?).map_err(Failure::file)
}

/// Runs a case; `told` is called with (row, done, total) after each row. Returns the path of its result.
#[pyfunction]
pub fn run(
    py: Python<'_>,
    path: PathBuf,
    text: Option<String>,
    overrides: Vec<String>,
    output: Option<PathBuf>,
    force: bool,
    resume: bool,
    told: Option<Py<PyAny>>,
) -> Answer<PathBuf> {
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
        return Err(error.into());
    }
    Ok(ran?.result)
}

/// The answers of a case with their errors, as JSON.
#[pyfunction]
pub fn converge(
    py: Python<'_>,
    path: PathBuf,
    text: Option<String>,
    overrides: Vec<String>,
    refine: bool,
) -> Answer<String> {
    let interrupt = Arc::new(AtomicBool::new(false));
    let options = ConvergeOptions { refine, interrupt: interrupt.clone() };
    let of = |more: &[String]| read(&path, text.as_deref(), &[&overrides, more].concat());
    let found =
        without_python(py, &interrupt, || asperity_io::converge::converge(&of, None, &options, &mut |_| {}))?;
    let found = found.map_err(|failed| match failed {
        ConvergeError::Case(errors) => errors.into(),
        ConvergeError::Run { source, .. } => (*source).into(),
        other => Failure::file(other),
    })?;
    Ok(serde_json::to_string(&found.bars)?)
}

/// What a case will do, and what was found about it, as JSON.
#[pyfunction]
pub fn check(py: Python<'_>, path: PathBuf, text: Option<String>, overrides: Vec<String>) -> Answer<String> {
    let case = read(&path, text.as_deref(), &overrides)?;
    let examined = detached(py, || case.examine())??;
    Ok(serde_json::to_string(&examined)?)
}

/// Writes the report of a stored result.
#[pyfunction]
pub fn report(py: Python<'_>, result: PathBuf, output: PathBuf, force: bool, bytes: usize) -> Answer<()> {
    detached(py, || {
        let reader = Reader::open(&result)?;
        let options = page::Options { force, bytes, ..page::Options::default() };
        page::write(&reader, &output, &options).map_err(Failure::file)
    })?
}
