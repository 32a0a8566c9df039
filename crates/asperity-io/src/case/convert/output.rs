//! Solver options, and what is stored.

use std::path::PathBuf;

use asperity::{Method, Precision, SolverOptions, TimeGrid};

use super::Checks;
use super::time;
use crate::case::plan::{Output, Rows};
use crate::case::raw::{self, Field};
use crate::case::words::number;

pub fn solver(solver: &raw::Solver) -> SolverOptions {
    let default = SolverOptions::default();
    // One member in this version; the match keeps this place in step with the format.
    match solver.plasticity {
        raw::Plasticity::Cap => {}
    }
    SolverOptions {
        method: match solver.method {
            raw::Method::ProjectedCg => Method::ProjectedCg,
            raw::Method::PolonskyKeer => Method::PolonskyKeer,
        },
        precision: match solver.precision {
            raw::Precision::Double => Precision::Double,
            raw::Precision::Mixed => Precision::Mixed,
        },
        tolerance: solver.tolerance.map_or(default.tolerance, |tolerance| tolerance.get()),
        max_iterations: solver.max_iterations.map_or(default.max_iterations, |most| most.count()),
    }
}

pub fn output(
    checks: &mut Checks<'_, '_>,
    output: &raw::Output,
    times: Option<&TimeGrid>,
    default_path: PathBuf,
) -> Option<Output> {
    let path = match &output.path {
        Some(path) if path.value.trim().is_empty() => {
            checks.wrong(&path.span, "the path of a directory that the run makes", None);
            return None;
        }
        Some(path) => PathBuf::from(&path.value),
        None => default_path,
    };
    let fields = match &output.fields {
        Some(fields) => fields.iter().map(|at| at.value).collect(),
        None => [Field::Pressure, Field::Gap].into_iter().collect(),
    };
    let rows = match (&output.every, &output.times) {
        (Some(_), Some(times)) => {
            let message = "`times` and `every` exclude each other".to_owned();
            checks.fault(&times.span, message, "one of the two", Some("leave one of them out"));
            return None;
        }
        (Some(every), None) => Rows::Every(every.value.count()),
        (None, None) => Rows::Every(time::steps(times?).div_ceil(10)),
        (None, Some(list)) => {
            let instants = time::increasing(checks, &list.value, |time| time.get())?;
            let end = times?.end();
            if let Some(late) = list.value.iter().find(|at| at.value.get() > end) {
                checks.wrong(
                    &late.span,
                    &format!("a time up to the end of the run, {} s", number(end)),
                    None,
                );
                return None;
            }
            Rows::At(instants)
        }
    };
    Some(Output { path, fields, rows, checkpoint: output.checkpoint.unwrap_or(true) })
}
