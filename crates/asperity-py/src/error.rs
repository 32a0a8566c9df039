//! Errors as Python exceptions, with the same words.

use asperity::Error;
use asperity_io::case::CaseErrors;
use asperity_io::session::RunError;
use asperity_io::topography::{Problem, TopographyError};
use pyo3::create_exception;
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
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
    const WORDS: [(&str, &str); 7] = [
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
        _ => file(error),
    }
}

/// Anything that files do.
pub fn file(error: impl std::fmt::Display) -> PyErr {
    PyOSError::new_err(spoken(&error.to_string()))
}
