//! Materials, bodies of layers and shifts, from the keys of a case.

use asperity::material::{Creep, Shift, VerticalShift};
use asperity_io::case::{Pair, given};
use asperity_io::choice;
use asperity_io::curve::{ShiftRequest, VerticalRequest};
use numpy::IntoPyArray;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use toml::{Table, Value};

use crate::error::{self, Answer, Failure};
use crate::given::{Dict, List, Numbers, choose, table};

/// The bodies of these keys (`body`, `temperature`).
pub fn bodies(keys: &Dict<'_>, window: Option<[f64; 2]>) -> Answer<Pair> {
    given::bodies(&table(keys)?, window).map_err(error::alone)
}

/// One half-space, at its own temperature or the reference temperature of its shift.
#[pyclass(frozen)]
pub struct Body {
    inner: asperity::material::Body,
    error: Option<f64>,
}

#[pymethods]
impl Body {
    /// Of the keys of a `[[body]]`; a fractional model becomes a Prony sum over `window`.
    #[new]
    #[pyo3(signature = (keys, window=None))]
    fn new(py: Python<'_>, keys: Dict<'_>, window: Option<[f64; 2]>) -> Answer<Body> {
        let document = PyDict::new(py);
        document.set_item("body", [keys])?;
        let mut made = bodies(&document, window)?;
        let error = made.reports.pop().and_then(|report| report.error);
        let inner = made.bodies.pop().ok_or_else(|| Failure::case("there is no body"))?;
        Ok(Body { inner, error })
    }

    /// "young" or "shear": the modulus that the material was given in.
    #[getter]
    fn measure(&self) -> &'static str {
        choice::word(&self.inner.material.measure())
    }

    /// Creep compliance at times: 1/Pa, of the modulus `measure`.
    fn creep<'py>(&self, py: Python<'py>, times: List<'_>, measure: &str) -> Answer<Numbers<'py>> {
        let creep = self.of(measure)?;
        Ok(map(py, times, |t| creep.value(t)))
    }

    /// Relaxation modulus `measure` at times: Pa.
    fn relaxation<'py>(&self, py: Python<'py>, times: List<'_>, measure: &str) -> Answer<Numbers<'py>> {
        let relaxation = self.of(measure)?.to_relaxation()?;
        Ok(map(py, times, |t| relaxation.value(t)))
    }

    /// Storage and loss modulus of the modulus `measure` at angular frequencies: Pa.
    fn complex<'py>(
        &self,
        py: Python<'py>,
        omega: List<'_>,
        measure: &str,
    ) -> Answer<(Numbers<'py>, Numbers<'py>)> {
        let creep = self.of(measure)?;
        let (storage, loss): (Vec<f64>, Vec<f64>) =
            omega.as_array().iter().map(|w| creep.modulus(*w)).unzip();
        Ok((storage.into_pyarray(py), loss.into_pyarray(py)))
    }

    /// Contact creep compliance against a rigid body at times: 1/Pa.
    fn contact_creep<'py>(&self, py: Python<'py>, times: List<'_>) -> Answer<Numbers<'py>> {
        let creep = self.inner.contact_creep()?;
        Ok(map(py, times, |t| creep.value(t)))
    }

    /// (instantaneous compliance, [(compliance, retardation time)], fluidity).
    fn creep_terms(&self) -> (f64, Vec<(f64, f64)>, f64) {
        let creep = self.inner.material.creep();
        let terms = creep.terms.iter().map(|term| (term.compliance, term.retardation_time)).collect();
        (creep.instantaneous, terms, creep.fluidity)
    }

    /// Largest relative error of creep and relaxation of a fractional model in its window; None of others.
    #[getter]
    fn error(&self) -> Option<f64> {
        self.error
    }

    /// (equilibrium modulus, [(modulus, relaxation time)]).
    fn relaxation_terms(&self) -> Answer<(f64, Vec<(f64, f64)>)> {
        let relaxation = self.inner.material.relaxation()?;
        let terms = relaxation.terms.iter().map(|term| (term.modulus, term.relaxation_time)).collect();
        Ok((relaxation.equilibrium, terms))
    }
}

impl Body {
    /// The creep function of the modulus `measure`.
    fn of(&self, measure: &str) -> Answer<Creep> {
        Ok(self.inner.creep(choose("measure", measure)?)?)
    }
}

fn map<'py>(py: Python<'py>, at: List<'_>, f: impl Fn(f64) -> f64) -> Numbers<'py> {
    at.as_array().iter().map(|v| f(*v)).collect::<Vec<f64>>().into_pyarray(py)
}

/// C(q, t) \[m/Pa\] of the body of these keys at wave numbers \[rad/m\].
#[pyfunction]
pub fn layer_compliance<'py>(
    py: Python<'py>,
    waves: List<'_>,
    keys: Dict<'_>,
    time: f64,
) -> Answer<Numbers<'py>> {
    let made = bodies(&keys, None)?;
    let creep = made.creep.value(time);
    let of_wave = |q: &f64| match &made.waves {
        Some(waves) => waves.creep(*q).map(|creep| creep.value(time)),
        None => Ok(creep * made.kernel().symbol(*q, 0.0)),
    };
    let values: asperity::Result<Vec<f64>> = waves.as_array().iter().map(of_wave).collect();
    Ok(values?.into_pyarray(py))
}

/// The shift of these keys, and how the moduli depend on temperature.
pub fn shift(keys: &Dict<'_>) -> Answer<(ShiftRequest, VerticalRequest)> {
    given::shift(table(keys)?).map_err(error::alone)
}

/// The keys of a shift.
pub fn shift_keys(shift: &Shift, vertical: Option<&VerticalShift>) -> Table {
    let number = |key: &str, number: f64| (key.to_owned(), Value::Float(number));
    let model = |name: &str| ("model".to_owned(), Value::String(name.to_owned()));
    let pairs = |points: &[(f64, f64)], scaled: fn(f64) -> f64| {
        let pair = |(kelvin, value): &(f64, f64)| {
            Value::Array(vec![Value::Float(*kelvin), Value::Float(scaled(*value))])
        };
        Value::Array(points.iter().map(pair).collect())
    };
    let mut keys = Table::from_iter(match shift {
        Shift::Wlf { c1, c2, reference } => {
            vec![model("wlf"), number("c1", *c1), number("c2", *c2), number("reference", *reference)]
        }
        Shift::Arrhenius { activation_energy, reference } => {
            vec![model("arrhenius"), number("energy", *activation_energy), number("reference", *reference)]
        }
        Shift::Table { points } => {
            let decades = pairs(points, |ln| ln / std::f64::consts::LN_10);
            vec![model("table"), ("points".to_owned(), decades)]
        }
    });
    let vertical = vertical.map(|vertical| match vertical {
        VerticalShift::Density { expansion: 0.0, .. } => Value::String("density".into()),
        VerticalShift::Density { expansion, .. } => {
            Value::Table(Table::from_iter([number("expansion", *expansion)]))
        }
        VerticalShift::Table { points } => pairs(points, f64::exp),
    });
    keys.extend(vertical.map(|vertical| ("vertical".to_owned(), vertical)));
    keys
}

/// Shift factors a_T at temperatures.
#[pyfunction]
pub fn shift_factor<'py>(py: Python<'py>, keys: Dict<'_>, temperatures: List<'_>) -> Answer<Numbers<'py>> {
    let (law, _) = law(&keys)?;
    let factors: asperity::Result<Vec<_>> = temperatures.as_array().iter().map(|t| law.factor(*t)).collect();
    Ok(factors?.into_pyarray(py))
}

/// Vertical shift factors b_T at temperatures; 1 where there is no vertical shift.
#[pyfunction]
pub fn vertical_shift_factor<'py>(
    py: Python<'py>,
    keys: Dict<'_>,
    temperatures: List<'_>,
) -> Answer<Numbers<'py>> {
    let (_, vertical) = law(&keys)?;
    let factor = |t: &f64| vertical.as_ref().map_or(Ok(1.0), |vertical| vertical.factor(*t));
    let factors: asperity::Result<Vec<_>> = temperatures.as_array().iter().map(factor).collect();
    Ok(factors?.into_pyarray(py))
}

/// A shift that is known, and its vertical shift.
fn law(keys: &Dict<'_>) -> Answer<(Shift, Option<VerticalShift>)> {
    match shift(keys)? {
        (ShiftRequest::Given(shift), vertical) => {
            let vertical = vertical.known(shift.reference())?;
            Ok((shift, vertical))
        }
        _ => Err(Failure::case("the shift is to be estimated, and has no factors yet")),
    }
}
