//! Materials and bodies.

use asperity::material::{self, Creep, CreepTerm, Fractional, Lateral, Material, Modulus, Relaxation};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::error::{CaseError, raised};

/// One deformable body: its creep function, Poisson's ratio or bulk modulus, and hardness.
#[pyclass(frozen)]
pub struct Body {
    pub inner: material::Body,
}

type Curve<'py> = Bound<'py, PyArray1<f64>>;

#[pymethods]
impl Body {
    /// A body of a named model. `numbers` are the model's moduli and times in the order of its Rust constructor,
    /// `terms` its (modulus or fraction or compliance, time) pairs.
    #[new]
    #[pyo3(signature = (model, measure, numbers, terms, poisson, bulk_modulus, hardness, name))]
    #[allow(clippy::too_many_arguments)]
    fn new(
        py: Python<'_>,
        model: &str,
        measure: &str,
        numbers: Vec<f64>,
        terms: Vec<(f64, f64)>,
        poisson: Option<f64>,
        bulk_modulus: Option<f64>,
        hardness: Option<f64>,
        name: String,
    ) -> PyResult<Body> {
        let measure = match measure {
            "young" => Modulus::Young,
            "shear" => Modulus::Shear,
            other => {
                return Err(CaseError::new_err(format!(
                    "measure is {other:?}, but must be 'young' or 'shear'"
                )));
            }
        };
        let lateral = match (poisson, bulk_modulus) {
            (Some(nu), None) => Lateral::Poisson(nu),
            (None, Some(modulus)) => Lateral::BulkModulus(modulus),
            _ => return Err(CaseError::new_err("give poisson or bulk_modulus, one of them")),
        };
        let material = build(model, measure, &numbers, &terms).map_err(|error| raised(py, error))?;
        let inner = material::Body { name, material, lateral, hardness };
        // Poisson's ratio, bulk modulus and hardness are checked where they are used.
        inner.contact_creep().map_err(|error| raised(py, error))?;
        Ok(Body { inner })
    }

    /// Creep compliance at times: 1/Pa, of the modulus that the material was given in.
    fn creep<'py>(&self, py: Python<'py>, times: PyReadonlyArray1<'_, f64>) -> Curve<'py> {
        map(py, times, |t| self.inner.material.creep().value(t))
    }

    /// Relaxation modulus at times: Pa.
    fn relaxation<'py>(&self, py: Python<'py>, times: PyReadonlyArray1<'_, f64>) -> PyResult<Curve<'py>> {
        let relaxation = self.inner.material.relaxation().map_err(|error| raised(py, error))?;
        Ok(map(py, times, |t| relaxation.value(t)))
    }

    /// Storage and loss modulus at angular frequencies: Pa.
    fn complex<'py>(
        &self,
        py: Python<'py>,
        omega: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<(Curve<'py>, Curve<'py>)> {
        let creep = self.inner.material.creep();
        // E' + i E'' = 1 / (D' - i D'')
        let modulus = |w: f64| {
            let (stored, lost) = creep.complex(w);
            let square = stored * stored + lost * lost;
            (stored / square, lost / square)
        };
        let pairs: Vec<_> = omega.as_array().iter().map(|w| modulus(*w)).collect();
        let (storage, loss): (Vec<f64>, Vec<f64>) = pairs.into_iter().unzip();
        Ok((storage.into_pyarray(py), loss.into_pyarray(py)))
    }

    /// Contact creep compliance against a rigid body at times: 1/Pa.
    fn contact_creep<'py>(&self, py: Python<'py>, times: PyReadonlyArray1<'_, f64>) -> PyResult<Curve<'py>> {
        let creep = self.inner.contact_creep().map_err(|error| raised(py, error))?;
        Ok(map(py, times, |t| creep.value(t)))
    }

    /// (instantaneous compliance, [(compliance, retardation time)], fluidity).
    fn creep_terms(&self) -> (f64, Vec<(f64, f64)>, f64) {
        let creep = self.inner.material.creep();
        let terms = creep.terms.iter().map(|term| (term.compliance, term.retardation_time)).collect();
        (creep.instantaneous, terms, creep.fluidity)
    }

    /// (equilibrium modulus, [(modulus, relaxation time)]).
    fn relaxation_terms(&self, py: Python<'_>) -> PyResult<(f64, Vec<(f64, f64)>)> {
        let relaxation = self.inner.material.relaxation().map_err(|error| raised(py, error))?;
        let terms = relaxation.terms.iter().map(|term| (term.modulus, term.relaxation_time)).collect();
        Ok((relaxation.equilibrium, terms))
    }
}

fn map<'py>(py: Python<'py>, at: PyReadonlyArray1<'_, f64>, f: impl Fn(f64) -> f64) -> Curve<'py> {
    at.as_array().iter().map(|v| f(*v)).collect::<Vec<f64>>().into_pyarray(py)
}

fn build(model: &str, measure: Modulus, numbers: &[f64], terms: &[(f64, f64)]) -> asperity::Result<Material> {
    match (model, numbers) {
        ("elastic", [modulus]) => Material::elastic(measure, *modulus),
        ("maxwell", [modulus, time]) => Material::maxwell(measure, *modulus, *time),
        ("kelvin-voigt", [modulus, time]) => Material::kelvin_voigt(measure, *modulus, *time),
        ("zener", [modulus, kelvin, time]) => Material::zener(measure, *modulus, *kelvin, *time),
        ("burgers", [modulus, relaxation, kelvin, time]) => {
            Material::burgers(measure, *modulus, *relaxation, *kelvin, *time)
        }
        ("prony", [equilibrium]) => Material::prony(measure, Relaxation::absolute(*equilibrium, terms)?),
        ("prony-instantaneous", [modulus]) => {
            Material::prony(measure, Relaxation::from_instantaneous(*modulus, terms)?)
        }
        ("creep", [instantaneous, fluidity]) => {
            let terms = terms.iter().map(|(compliance, retardation_time)| CreepTerm {
                compliance: *compliance,
                retardation_time: *retardation_time,
            });
            let creep = Creep { instantaneous: *instantaneous, terms: terms.collect(), fluidity: *fluidity };
            Material::generalised_kelvin(measure, creep)
        }
        ("springpot", [modulus, time, order, first, last, tolerance]) => {
            let model = Fractional::Springpot { modulus: *modulus, time: *time, order: *order };
            Material::generalised_kelvin(measure, model.to_prony([*first, *last], *tolerance)?.creep)
        }
        ("fractional-zener", [equilibrium, instantaneous, time, order, first, last, tolerance]) => {
            let model = Fractional::Zener {
                equilibrium: *equilibrium,
                instantaneous: *instantaneous,
                time: *time,
                order: *order,
            };
            Material::generalised_kelvin(measure, model.to_prony([*first, *last], *tolerance)?.creep)
        }
        _ => Err(asperity::Error::invalid("model", model, "one of those of the package, with its numbers")),
    }
}
