//! Materials from measured curves.

use std::path::PathBuf;
use std::str::FromStr;

use asperity::material::FitOptions;
use asperity_io::curve::{
    Column, Columns, CurveError, Curves, Fitted, Remedy, Request, Role, Series, ShiftRequest, Sweep,
};
use numpy::{IntoPyArray, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{CaseError, file};
use crate::march::choose;
use crate::material::{ShiftWords, shift, words};
use crate::wait::detached;

/// How to fit, as Python gives it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Options {
    measure: String,
    shift: Option<ShiftWords>,
    /// Reference temperature of a shift that is to be estimated.
    estimate: Option<f64>,
    window: Option<[f64; 2]>,
    per_decade: f64,
    margin: f64,
    long_time: String,
    limit: f64,
    max_terms: Option<usize>,
    misfit: Option<f64>,
    moduli: String,
    loss_weight: f64,
}

impl Options {
    fn request(self) -> PyResult<Request> {
        let shift = match (self.shift, self.estimate) {
            (Some(words), _) => ShiftRequest::Given(shift(words)?),
            (None, Some(reference)) => ShiftRequest::Estimate(reference),
            (None, None) => ShiftRequest::None,
        };
        Ok(Request {
            measure: choose("modulus", &self.measure)?,
            shift,
            window: self.window,
            options: FitOptions {
                per_decade: self.per_decade,
                margin: self.margin,
                long_time: choose("long_time", &self.long_time)?,
                limit: self.limit,
                max_terms: self.max_terms.unwrap_or(usize::MAX),
                misfit: self.misfit,
                moduli: choose("moduli", &self.moduli)?,
                loss_weight: self.loss_weight,
            },
        })
    }
}

/// Fits sweeps of (temperature, times or angular frequencies, curves), in SI, one per temperature.
#[pyfunction]
#[allow(clippy::type_complexity)]
pub fn fit<'py>(
    py: Python<'py>,
    kind: &str,
    sweeps: Vec<(Option<f64>, PyReadonlyArray1<'_, f64>, Vec<PyReadonlyArray1<'_, f64>>)>,
    options: Options,
) -> PyResult<Bound<'py, PyDict>> {
    let array = |array: &PyReadonlyArray1<'_, f64>| array.as_array().to_vec();
    let mut points = 0;
    let sweeps = sweeps.iter().map(|(temperature, x, curves)| {
        let x = array(x);
        // A message names the point by its number.
        let lines = (points + 1..=points + x.len()).collect();
        points += x.len();
        Sweep { temperature: *temperature, x, curves: curves.iter().map(array).collect(), lines }
    });
    let curves = Curves::of("the data", choose("kind", kind)?, sweeps.collect());
    let request = options.request()?;
    let fitted = detached(py, || request.fit(&curves))?;
    told(py, fitted.map_err(located)?, &curves)
}

/// A fault of the caller's arrays: the number is that of a point, not a line.
fn located(error: CurveError) -> PyErr {
    let point = error.line.map(|n| format!("point {n}: ")).unwrap_or_default();
    let remedy = error.remedy.as_ref().map(|remedy| format!("; {}", remedy.in_python())).unwrap_or_default();
    CaseError::new_err(format!("{point}{}{remedy}", error.message))
}

/// What is said of a column: quantity, name or number, unit.
type Said = (String, Option<String>, Option<usize>, Option<String>);

/// Fits a text table.
#[pyfunction]
pub fn fit_file<'py>(
    py: Python<'py>,
    path: PathBuf,
    kind: Option<String>,
    columns: Vec<Said>,
    sheet: Option<String>,
    options: Options,
) -> PyResult<Bound<'py, PyDict>> {
    let mut said = Columns { sheet, ..Columns::default() };
    for (role, name, number, unit) in columns {
        let role = Role::from_str(&role).map_err(CaseError::new_err)?;
        match (name, number) {
            (Some(name), _) => drop(said.columns.insert(role, Column::Name(name))),
            (None, Some(number)) => drop(said.columns.insert(role, Column::Number(number))),
            (None, None) => {}
        }
        if let Some(unit) = unit {
            said.units.insert(role, unit);
        }
    }
    let request = options.request()?;
    let unreadable = |error: CurveError| match error.path.is_file() {
        true => CaseError::new_err(error.told(Remedy::in_python)),
        false => file(error),
    };
    let found = match kind {
        Some(word) => Some(choose("kind", &word)?),
        None => Curves::kind_of(&path, said.sheet.as_deref()).map_err(unreadable)?,
    };
    let Some(found) = found else {
        return Err(CaseError::new_err(format!(
            "{}: its header does not state what was measured; give kind=\"relaxation\", \"creep\" or \"dma\"",
            path.display()
        )));
    };
    let fitted = detached(py, || {
        let curves = Curves::read(&path, found, &said)?;
        request.fit(&curves).map(|fitted| (fitted, curves))
    })?;
    let (fitted, curves) = fitted.map_err(unreadable)?;
    told(py, fitted, &curves)
}

fn told<'py>(py: Python<'py>, fitted: Fitted, curves: &Curves) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("kind", curves.kind.name())?;
    match &fitted.series {
        Series::Relaxation(relaxation) => {
            let terms: Vec<_> = relaxation.terms.iter().map(|t| (t.modulus, t.relaxation_time)).collect();
            out.set_item("relaxation", (relaxation.equilibrium, terms))?;
        }
        Series::Creep(creep) => {
            let terms: Vec<_> = creep.terms.iter().map(|t| (t.compliance, t.retardation_time)).collect();
            out.set_item("creep", (creep.instantaneous, terms, creep.fluidity))?;
        }
    }
    out.set_item("max_misfit", fitted.misfit.max)?;
    out.set_item("rms_misfit", fitted.misfit.rms)?;
    let columns = fitted.columns.iter().map(|(name, m)| (*name, (m.rms, m.max)));
    out.set_item("misfits", columns.collect::<std::collections::BTreeMap<_, _>>())?;
    out.set_item("worst", fitted.misfit.worst)?;
    out.set_item("noise", fitted.noise)?;
    out.set_item("uncertainty", fitted.uncertainty.iter().map(|u| (u[0], u[1])).collect::<Vec<_>>())?;
    out.set_item("window", (fitted.window[0], fitted.window[1]))?;
    out.set_item("shift", fitted.shift.clone().map(words))?;
    out.set_item("shift_rms", fitted.shift_rms)?;
    out.set_item("temperatures", fitted.temperatures.clone())?;
    out.set_item("notes", fitted.notes.clone())?;
    out.set_item("toml", fitted.to_toml(curves))?;
    out.set_item("x", fitted.data.x.into_pyarray(py))?;
    let columns: Vec<_> = fitted.data.curves.into_iter().map(|curve| curve.into_pyarray(py)).collect();
    out.set_item("curves", columns)?;
    Ok(out)
}
