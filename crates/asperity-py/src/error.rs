//! Errors as Python exceptions, with the same words.

use std::path::Path;

use asperity::Error;
use asperity_io::case::CaseErrors;
use asperity_io::curve::{CurveError, Words};
use asperity_io::leakage::LeakError;
use asperity_io::session::RunError;
use asperity_io::store::StoreError;
use asperity_io::stress::StressError;
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

/// An error on its way to Python: the exception that suits it. `?` makes it of the errors of the library; those of
/// keys that Python gave go through [`given`] or [`alone`].
pub struct Failure(PyErr);

/// What a function gives Python.
pub type Answer<T> = Result<T, Failure>;

impl Failure {
    /// Wrong input.
    pub fn case(message: impl ToString) -> Failure {
        Failure(CaseError::new_err(message.to_string()))
    }

    /// Anything that files do.
    pub fn file(error: impl std::fmt::Display) -> Failure {
        Failure(PyOSError::new_err(spoken(&error.to_string())))
    }

    /// An error of reading the file or folder at this path.
    pub fn of_path(path: &Path, error: impl std::fmt::Display) -> Failure {
        match path.try_exists() {
            Ok(false) => Failure(PyFileNotFoundError::new_err(spoken(&error.to_string()))),
            _ => Failure::file(error),
        }
    }

    /// Gives the exception its best state, if it is one that has some.
    pub fn with_best<'py>(
        self,
        py: Python<'py>,
        best: impl FnOnce() -> PyResult<Bound<'py, PyAny>>,
    ) -> Failure {
        if self.0.is_instance_of::<ConvergenceError>(py) {
            // The error itself matters more than that.
            let _ = best().and_then(|best| self.0.value(py).setattr("best", best));
        }
        self
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> PyErr {
        failure.0
    }
}

/// How each error becomes a failure.
macro_rules! failures {
    ($($error:ty => $failure:expr,)*) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Failure {
                $failure(error)
            }
        })*
    };
}
failures! {
    PyErr => Failure,
    Error => of_numerics,
    RunError => of_run,
    TopographyError => of_topography,
    CurveError => of_curve,
    CaseErrors => Failure::case,
    String => Failure::case,
    serde_json::Error => Failure::case,
    ndarray::ShapeError => Failure::case,
    std::io::Error => Failure::file,
    StoreError => Failure::file,
    StressError => Failure::file,
    LeakError => Failure::file,
}

fn of_numerics(error: Error) -> Failure {
    let stopped = match &error {
        Error::Interrupted => return Failure(PyKeyboardInterrupt::new_err(())),
        Error::NotConverged(stopped) => stopped,
        _ => return Failure::case(error),
    };
    let raised = ConvergenceError::new_err(error.to_string());
    // Setting attributes of an exception that was just made cannot fail.
    let _ = Python::attach(|py| {
        let value = raised.value(py);
        value.setattr("residual", stopped.residual)?;
        value.setattr("tolerance", stopped.tolerance)?;
        value.setattr("certificate", stopped.certificate)?;
        value.setattr("iterations", stopped.iterations)?;
        value.setattr("time", stopped.time)?;
        value.setattr("best", py.None())
    });
    Failure(raised)
}

fn of_run(error: RunError) -> Failure {
    match error {
        RunError::Case(errors) => errors.into(),
        RunError::Solve { source, .. } => source.into(),
        error => Failure::file(error),
    }
}

/// A measured surface that cannot be read.
fn of_topography(error: TopographyError) -> Failure {
    match (&error.problem, &error.path) {
        (Problem::Unrecognised | Problem::Foreign { .. }, _) => {
            Failure(FormatError::new_err(spoken(&error.to_string())))
        }
        (_, Some(path)) => Failure::of_path(path, &error),
        (_, None) => Failure::file(error),
    }
}

/// A fault of a file of measured curves: of what it holds, or of reading it.
fn of_curve(error: CurveError) -> Failure {
    match error.path.is_file() {
        true => Failure::case(error.told(Words::Python)),
        false => Failure::of_path(&error.path, &error),
    }
}

/// The faults of keys that Python gave, one to a line: their places in a text that nobody wrote are left out.
pub fn given(errors: CaseErrors) -> Failure {
    let said = errors.errors.iter().map(|error| {
        let help = error.help.as_ref().map(|help| format!(" ({help})")).unwrap_or_default();
        spoken(&format!("{}{help}", error.message)).replace('`', "")
    });
    Failure::case(said.collect::<Vec<_>>().join("\n"))
}

/// The faults of tables that stand alone, whose keys are parameters: a message begins with the parameter, or with a word for the table.
pub fn alone(mut errors: CaseErrors) -> Failure {
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
    given(errors)
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
