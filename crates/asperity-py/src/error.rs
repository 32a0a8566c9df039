//! Errors as Python exceptions, with the same words.

use std::path::Path;

use asperity::Error;
use asperity_io::case::CaseErrors;
use asperity_io::session::RunError;
use asperity_io::topography::{Problem, TopographyError};
use pyo3::create_exception;
use pyo3::exceptions::{PyFileNotFoundError, PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    asperity,
    CaseError,
    PyValueError,
    "The input is wrong: the message names what, its value, and what was expected."
);
create_exception!(
    asperity,
    ConvergenceError,
    PyRuntimeError,
    "A solve stopped before it reached its tolerance. Attributes: residual, tolerance, certificate, iterations, time \
     (seconds, None outside of a march), and best: the best state that was found."
);

create_exception!(
    asperity,
    FormatError,
    PyOSError,
    "The file belongs to a format that is not read; the message names it and says what to do."
);

/// An error of the numerics.
pub fn raised(py: Python<'_>, error: Error) -> PyErr {
    match &error {
        Error::Interrupted => PyKeyboardInterrupt::new_err(()),
        Error::NotConverged(stopped) => {
            let raised = ConvergenceError::new_err(error.to_string());
            let value = raised.value(py);
            // Setting attributes of an exception that was just made cannot fail.
            let _ = value.setattr("residual", stopped.residual);
            let _ = value.setattr("tolerance", stopped.tolerance);
            let _ = value.setattr("certificate", stopped.certificate);
            let _ = value.setattr("iterations", stopped.iterations);
            let _ = value.setattr("time", stopped.time);
            let _ = value.setattr("best", py.None());
            raised
        }
        _ => CaseError::new_err(error.to_string()),
    }
}

/// The faults of a case file, one to a line.
pub fn case(errors: CaseErrors) -> PyErr {
    CaseError::new_err(errors.to_string())
}

/// The faults of keys that Python gave, one to a line: their places in a text that nobody wrote are left out.
pub fn given(errors: &CaseErrors) -> PyErr {
    let said = errors.errors.iter().map(|error| {
        let help = error.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
        spoken(&format!("{}{help}", error.message)).replace('`', "")
    });
    CaseError::new_err(said.collect::<Vec<_>>().join("\n"))
}

/// The faults of tables that stand alone, whose keys are parameters: a message begins with the parameter, or with a word for the table.
pub fn alone(mut errors: CaseErrors) -> PyErr {
    const TABLES: [(&str, &str); 6] = [
        ("body[0].material", "the material"),
        ("body[0]", "the body"),
        ("shift", "the shift"),
        ("load.stages[0]", "what is prescribed"),
        ("surface[0]", "the surface"),
        ("domain", "the domain"),
    ];
    for error in &mut errors.errors {
        let rest = TABLES.iter().find_map(|(table, word)| Some((error.message.strip_prefix(table)?, word)));
        if let Some((rest, word)) = rest {
            error.message = rest.strip_prefix('.').map_or_else(|| format!("{word}{rest}"), str::to_owned);
        }
    }
    given(&errors)
}

/// An error of a run from a case file.
pub fn run(py: Python<'_>, error: RunError) -> PyErr {
    match error {
        RunError::Case(errors) => case(errors),
        RunError::Solve { source, .. } => raised(py, source),
        error => PyOSError::new_err(spoken(&error.to_string())),
    }
}

/// The words of a message with the parameters of Python in place of the options of the command.
fn spoken(message: &str) -> String {
    const WORDS: [(&str, &str); 9] = [
        ("add shift = { model = \"wlf\", ... }", "give shift=asperity.wlf(...)"),
        ("histogram = { pressure = \"...\" }", "give largest_pressure="),
        ("(`size`, --size A,B)", "(size=(Lx, Ly))"),
        ("(`height_unit`, --height-unit U)", "(height_unit= in m)"),
        ("asperity run --resume", "asperity.run(..., resume=True)"),
        ("--resume", "resume=True"),
        ("--force", "force=True"),
        ("--channel", "channel="),
        ("--set", "set="),
    ];
    WORDS.iter().fold(message.to_owned(), |text, (option, parameter)| text.replace(option, parameter))
}

/// A measured surface that cannot be read.
pub fn topography(error: TopographyError) -> PyErr {
    match &error.problem {
        Problem::Unrecognised | Problem::Foreign { .. } => FormatError::new_err(spoken(&error.to_string())),
        _ => match &error.path {
            Some(path) => of_path(path, &error),
            None => file(error),
        },
    }
}

/// Anything that files do.
pub fn file(error: impl std::fmt::Display) -> PyErr {
    PyOSError::new_err(spoken(&error.to_string()))
}

/// An error of reading the file or folder at this path.
pub fn of_path(path: &Path, error: impl std::fmt::Display) -> PyErr {
    match path.try_exists() {
        Ok(false) => PyFileNotFoundError::new_err(spoken(&error.to_string())),
        _ => file(error),
    }
}
