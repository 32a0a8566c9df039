//! Materials from measured curves.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::str::FromStr;

use asperity::material::{FitOptions, Modulus};
use asperity_io::choice;
use asperity_io::curve::{
    Column, Columns, CurveError, Curves, Fitted, Request, Role, Series, ShiftRequest, Sweep, VerticalRequest,
    VerticalWord, Words,
};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::error::{Answer, Failure};
use crate::given::{Dict, List, choose, dictionary, entries};
use crate::material::{shift, shift_keys};
use crate::wait::detached;

/// How to fit, as Python gives it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Options<'py> {
    /// None: what the header of the file names, or else Young's modulus.
    modulus: Option<String>,
    /// Keys of a shift, also of one that is to be estimated.
    shift: Option<Dict<'py>>,
    /// "density", "free", or none.
    vertical: Option<String>,
    window: Option<[f64; 2]>,
    per_decade: f64,
    margin: f64,
    long_time: String,
    max_misfit: f64,
    max_terms: Option<usize>,
    misfit: Option<f64>,
    moduli: String,
    loss_weight: f64,
}

impl Options<'_> {
    /// The request; `named` is the modulus that the header of the file names.
    fn request(self, named: Option<Modulus>) -> Answer<Request> {
        let measure = self.modulus.map(|word| choose("modulus", &word)).transpose()?;
        let (shift, vertical) = match &self.shift {
            Some(keys) => shift(keys)?,
            None => (ShiftRequest::None, VerticalRequest::None),
        };
        let word = self.vertical.map(|word| choose("vertical", &word)).transpose()?;
        let vertical = match (word, vertical) {
            (None, vertical) => vertical,
            (Some(VerticalWord::Density), VerticalRequest::None) => {
                VerticalRequest::Density { expansion: 0.0 }
            }
            (Some(VerticalWord::Free), VerticalRequest::None) => VerticalRequest::Free,
            (Some(_), _) => {
                return Err(Failure::case("vertical is given, and the shift has one of its own"));
            }
        };
        Ok(Request {
            measure: measure.or(named).unwrap_or(Modulus::Young),
            shift,
            vertical,
            window: self.window,
            options: FitOptions {
                per_decade: self.per_decade,
                margin: self.margin,
                long_time: choose("long_time", &self.long_time)?,
                limit: self.max_misfit,
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
    sweeps: Vec<(Option<f64>, List<'_>, Vec<List<'_>>)>,
    options: Options<'_>,
) -> Answer<Dict<'py>> {
    let array = |array: &List<'_>| array.as_array().to_vec();
    let mut points = 0;
    let sweeps = sweeps.iter().map(|(temperature, x, curves)| {
        let x = array(x);
        // A message names the point by its number.
        let lines = (points + 1..=points + x.len()).collect();
        points += x.len();
        Sweep { temperature: *temperature, x, curves: curves.iter().map(array).collect(), lines }
    });
    let curves = Curves::of("the data", choose("kind", kind)?, sweeps.collect());
    let request = options.request(None)?;
    let fitted = detached(py, || request.fit(&curves))?;
    told(py, fitted.map_err(located)?, &curves)
}

/// A fault of the caller's arrays: the number is that of a point, not a line.
fn located(error: CurveError) -> Failure {
    let point = error.line.map(|n| format!("point {n}: ")).unwrap_or_default();
    Failure::case(format!("{point}{}{}", error.message, error.remedies(Words::Python)))
}

/// Where a column is.
#[derive(FromPyObject)]
pub enum Place {
    Name(String),
    Number(usize),
}

/// Fits a text table or a spreadsheet; `columns` and `units` are by quantity.
#[pyfunction]
pub fn fit_file<'py>(
    py: Python<'py>,
    path: PathBuf,
    kind: Option<String>,
    columns: BTreeMap<String, Place>,
    units: BTreeMap<String, String>,
    sheet: Option<String>,
    segment: Option<usize>,
    options: Options<'_>,
) -> Answer<Dict<'py>> {
    let role = |name: String| Role::from_str(&name);
    let column = |place| match place {
        Place::Name(name) => Column::Name(name),
        Place::Number(number) => Column::Number(number),
    };
    let said = Columns {
        sheet,
        segment,
        columns: columns
            .into_iter()
            .map(|(name, place)| Ok((role(name)?, column(place))))
            .collect::<Result<_, String>>()?,
        units: units
            .into_iter()
            .map(|(name, unit)| Ok((role(name)?, unit)))
            .collect::<Result<_, String>>()?,
    };
    let found = match kind {
        Some(word) => choose("kind", &word)?,
        None => Curves::kind_of(&path, said.sheet.as_deref())?,
    };
    let mut curves = detached(py, || Curves::read(&path, found, &said))??;
    let mut request = options.request(curves.measure)?;
    if let (ShiftRequest::None, Some(reference)) = (&request.shift, reference_of_several(&curves)) {
        curves.notes.push(format!(
            "no shift is given, so it is estimated from the sweeps, about {reference:.2} K; give shift= to set it"
        ));
        request.shift = ShiftRequest::Estimate(reference);
    }
    let fitted = detached(py, || request.fit(&curves))??;
    told(py, fitted, &curves)
}

/// Of sweeps at several temperatures whose shift the file does not hold, the one nearest to that of a room \[K\].
fn reference_of_several(curves: &Curves) -> Option<f64> {
    const ROOM: f64 = 293.15;
    let several = curves.sweeps.len() > 1 && !curves.is_over_temperature() && curves.held.shift().is_none();
    let temperatures = curves.sweeps.iter().filter_map(|sweep| sweep.temperature);
    temperatures.min_by(|a, b| (a - ROOM).abs().total_cmp(&(b - ROOM).abs())).filter(|_| several)
}

/// The shift that a table of temperatures and shift factors holds, in a text file or a spreadsheet.
#[pyfunction]
pub fn read_shift_table(py: Python<'_>, path: PathBuf) -> Answer<Dict<'_>> {
    let read = asperity_io::curve::read_shift_table(&path)?;
    Ok(dictionary(py, &shift_keys(&read, None))?)
}

/// The fields of a `Fit`.
fn told<'py>(py: Python<'py>, fitted: Fitted, curves: &Curves) -> Answer<Dict<'py>> {
    let out = PyDict::new(py);
    out.set_item("kind", curves.kind.name())?;
    out.set_item("modulus", choice::word(&fitted.material.measure()))?;
    let (equilibrium, creep, terms): (_, _, Vec<_>) = match &fitted.series {
        Series::Relaxation(relaxation) => {
            let terms = relaxation.terms.iter().map(|t| (t.modulus, t.relaxation_time));
            (Some(relaxation.equilibrium), None, terms.collect())
        }
        Series::Creep(creep) => {
            let terms = creep.terms.iter().map(|t| (t.compliance, t.retardation_time));
            (None, Some(creep), terms.collect())
        }
    };
    out.set_item("equilibrium", equilibrium)?;
    out.set_item("instantaneous", creep.map(|creep| creep.instantaneous))?;
    out.set_item("fluidity", creep.map(|creep| creep.fluidity))?;
    out.set_item("terms", terms)?;
    out.set_item("max_misfit", fitted.misfit.max)?;
    out.set_item("rms_misfit", fitted.misfit.rms)?;
    let columns = fitted.columns.iter().map(|(name, m)| (*name, (m.rms, m.max)));
    out.set_item("misfits", columns.collect::<BTreeMap<_, _>>())?;
    out.set_item("worst", fitted.misfit.worst)?;
    entries!(out, fitted; noise shift_rms temperatures notes);
    out.set_item("uncertainty", fitted.uncertainty.iter().map(|u| (u[0], u[1])).collect::<Vec<_>>())?;
    out.set_item("window", (fitted.window[0], fitted.window[1]))?;
    let shift = fitted.shift.as_ref().map(|shift| shift_keys(shift, fitted.vertical.as_ref()));
    out.set_item("shift", shift.map(|keys| dictionary(py, &keys)).transpose()?)?;
    let factors = |list: &[[f64; 3]]| list.iter().map(|f| (f[0], f[1], f[2])).collect::<Vec<_>>();
    out.set_item("shift_factors", factors(&fitted.factors))?;
    out.set_item("vertical_factors", factors(&fitted.vertical_factors))?;
    out.set_item("findings", asperity_io::finding::list(&fitted.findings("the material")).to_string())?;
    out.set_item("case_block", fitted.to_toml(curves))?;
    out.set_item("x", fitted.data.x.into_pyarray(py))?;
    let columns: Vec<_> = fitted.data.curves.into_iter().map(|curve| curve.into_pyarray(py)).collect();
    out.set_item("curves", columns)?;
    Ok(out)
}
