//! Materials and bodies.

use std::sync::Arc;

use asperity::kernel::{HalfSpace, Kernel};
use asperity::layer::{BodyLayer, Interface, LayeredBody, NonseparableLayers, Response, response};
use asperity::material::{
    self, Creep, CreepTerm, Fractional, Lateral, Material, Modulus, ReducedTime, Relaxation, Shift,
    TemperatureFactors, ThermalCreep, VerticalShift,
};
use asperity_io::curve::VerticalRequest;
use asperity_io::stress::Ratio;
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;

use crate::error::{CaseError, raised};
use crate::march::{choose, choose_among};

/// One deformable body: its creep function, Poisson's ratio or bulk modulus, hardness, and how warm it is.
#[pyclass(frozen)]
pub struct Body {
    /// At its own temperature where it has one, else at the reference temperature of its shift.
    pub inner: material::Body,
    /// Where the temperature of the run is its own.
    shift: Option<Shift>,
    /// How its moduli depend on that temperature.
    vertical: Option<VerticalShift>,
    /// Relative error of the Prony sum that stands for a fractional model.
    error: Option<f64>,
}

/// A vertical shift as Python gives it: the expansion of one by density, or points of (temperature, ln b_T).
pub type VerticalWords = (Option<f64>, Vec<(f64, f64)>);

/// A shift as Python gives it: its model, numbers, points of (temperature, ln a_T), and its vertical shift.
pub type ShiftWords = (String, Vec<f64>, Vec<(f64, f64)>, Option<VerticalWords>);

/// A shift, and how the moduli depend on temperature.
pub fn shift(words: ShiftWords) -> PyResult<(Shift, VerticalRequest)> {
    let (model, numbers, points, vertical) = words;
    let vertical = match vertical {
        None => VerticalRequest::None,
        Some((Some(expansion), _)) => VerticalRequest::Density { expansion },
        Some((None, points)) => VerticalRequest::Given(VerticalShift::Table { points }),
    };
    let shift = match (model.as_str(), numbers.as_slice()) {
        ("wlf", [c1, c2, reference]) => Shift::Wlf { c1: *c1, c2: *c2, reference: *reference },
        ("arrhenius", [activation_energy, reference]) => {
            Shift::Arrhenius { activation_energy: *activation_energy, reference: *reference }
        }
        ("table", []) => Shift::Table { points },
        _ => {
            return Err(CaseError::new_err(format!(
                "there is no shift '{model}' of {} numbers",
                numbers.len()
            )));
        }
    };
    Ok((shift, vertical))
}

/// The words of a shift, for Python.
pub fn words(shift: Shift, vertical: Option<&VerticalShift>) -> ShiftWords {
    let vertical = vertical.map(|vertical| match vertical {
        VerticalShift::Density { expansion, .. } => (Some(*expansion), vec![]),
        VerticalShift::Table { points } => (None, points.clone()),
    });
    match shift {
        Shift::Wlf { c1, c2, reference } => ("wlf".into(), vec![c1, c2, reference], vec![], vertical),
        Shift::Arrhenius { activation_energy, reference } => {
            ("arrhenius".into(), vec![activation_energy, reference], vec![], vertical)
        }
        Shift::Table { points } => ("table".into(), vec![], points, vertical),
    }
}

/// Shift factors a_T at temperatures.
#[pyfunction]
pub fn shift_factor<'py>(
    py: Python<'py>,
    words: ShiftWords,
    temperatures: PyReadonlyArray1<'_, f64>,
) -> PyResult<Curve<'py>> {
    let (shift, vertical) = shift(words)?;
    shift.validate().map_err(|error| raised(py, error))?;
    vertical.known(shift.reference()).map_err(CaseError::new_err)?;
    let factors =
        temperatures.as_array().iter().map(|t| shift.factor(*t)).collect::<asperity::Result<Vec<_>>>();
    Ok(factors.map_err(|error| raised(py, error))?.into_pyarray(py))
}

/// Vertical shift factors b_T at temperatures; 1 where there is no vertical shift.
#[pyfunction]
pub fn vertical_shift_factor<'py>(
    py: Python<'py>,
    words: ShiftWords,
    temperatures: PyReadonlyArray1<'_, f64>,
) -> PyResult<Curve<'py>> {
    let (shift, vertical) = shift(words)?;
    let vertical = vertical.known(shift.reference()).map_err(CaseError::new_err)?;
    let factor = |t: &f64| vertical.as_ref().map_or(Ok(1.0), |vertical| vertical.factor(*t));
    let factors = temperatures.as_array().iter().map(factor).collect::<asperity::Result<Vec<_>>>();
    Ok(factors.map_err(|error| raised(py, error))?.into_pyarray(py))
}

/// How Python gives the layers of a body, whose materials are the next of the list: thickness \[m\] and interface of each, and
/// whether a half-space lies below.
pub type StackParts = (Vec<(f64, String)>, bool);

/// Bodies as the march takes them.
pub struct Pair {
    /// How they yield in space.
    pub kernel: Arc<dyn Kernel>,
    /// How their waves creep, where they creep differently.
    pub waves: Option<Arc<NonseparableLayers>>,
    /// The creep function of those of constant temperature.
    pub creep: Creep,
    /// The others, on their clocks.
    pub thermal: Vec<ThermalCreep>,
}

/// `materials` are those of all bodies, from the surface down, `stacks` how many layers each body has of them.
pub fn pair(
    materials: &[PyRef<'_, Body>],
    stacks: &[StackParts],
    temperatures: &[(f64, f64)],
) -> PyResult<asperity::Result<Pair>> {
    let made: asperity::Result<Vec<_>> = materials.iter().map(|body| at(body, temperatures)).collect();
    let made = match made {
        Ok(made) => made,
        Err(error) => return Ok(Err(error)),
    };
    if stacks.iter().all(|(layers, _)| layers.is_empty()) {
        return Ok(half_spaces(made));
    }
    let (bodies, clocks): (Vec<material::Body>, Vec<Option<ReducedTime>>) = made.into_iter().unzip();
    let mut materials = bodies.into_iter();
    let mut bodies = vec![];
    for (layers, on_half_space) in stacks {
        let layer = |((thickness, interface), material): (&(f64, String), material::Body)| {
            let interfaces = [("bonded", Interface::Bonded), ("slip", Interface::Slip)];
            let interface = choose_among("interface", interface, &interfaces)?;
            Ok(BodyLayer { thickness: *thickness, interface, material })
        };
        let layers = layers.iter().zip(&mut materials).map(layer).collect::<PyResult<Vec<_>>>()?;
        let base = if *on_half_space { materials.next() } else { None };
        bodies.push(LayeredBody { layers, base });
    }
    Ok(layered(&bodies, &clocks))
}

/// How many bodies creep.
pub fn creeping(materials: &[PyRef<'_, Body>], stacks: &[StackParts]) -> usize {
    let mut rest = materials.iter();
    let mut creeps = |(layers, on_half_space): &StackParts| {
        let own = rest.by_ref().take(layers.len() + usize::from(*on_half_space));
        own.filter(|body| body.inner.material.creep().remembers()).count() > 0
    };
    stacks.iter().map(&mut creeps).filter(|creeps| *creeps).count()
}

fn half_spaces(made: Vec<(material::Body, Option<ReducedTime>)>) -> asperity::Result<Pair> {
    let mut pair =
        Pair { kernel: Arc::new(HalfSpace), waves: None, creep: Creep::default(), thermal: Vec::new() };
    for (body, clock) in made {
        let creep = body.contact_creep()?;
        match clock {
            Some(clock) => pair.thermal.push(ThermalCreep { creep, clock }),
            None => pair.creep = pair.creep.sum(&creep),
        }
    }
    Ok(pair)
}

fn layered(bodies: &[LayeredBody], clocks: &[Option<ReducedTime>]) -> asperity::Result<Pair> {
    if clocks.iter().any(|clock| *clock != clocks[0]) {
        return Err(asperity::Error::invalid(
            "temperature shift of the layers",
            "not the same in all of them",
            "the same law for all layers and bodies while the temperature changes: otherwise waves of different lengths creep \
             differently, which is not solved yet. Give all of them the same shift, or hold the temperature constant",
        ));
    }
    let Response { kernel, creep, waves } = response(bodies)?;
    let kernel: Arc<dyn Kernel> = Arc::new(kernel);
    Ok(match &clocks[0] {
        Some(clock) => {
            let thermal = vec![ThermalCreep { creep, clock: clock.clone() }];
            Pair { kernel, waves, creep: Creep::default(), thermal }
        }
        None => Pair { kernel, waves, creep, thermal: vec![] },
    })
}

/// A body at a constant temperature, or with the clock of a changing one.
fn at(body: &Body, temperatures: &[(f64, f64)]) -> asperity::Result<(material::Body, Option<ReducedTime>)> {
    let (Some(shift), [first, rest @ ..]) = (&body.shift, temperatures) else {
        return Ok((body.inner.clone(), None));
    };
    let clock = ReducedTime::new(shift.clone(), temperatures)?;
    match (rest.iter().all(|point| point.1 == first.1), &body.vertical) {
        (true, vertical) => Ok((warmed(&body.inner, shift, vertical.as_ref(), first.1)?, None)),
        (false, None) => Ok((body.inner.clone(), Some(clock))),
        (false, Some(_)) => Err(TemperatureFactors::not_constant()),
    }
}

/// C(q, t) \[m/Pa\] of one body at wave numbers \[rad/m\].
#[pyfunction]
pub fn layer_compliance<'py>(
    py: Python<'py>,
    waves: PyReadonlyArray1<'_, f64>,
    bodies: Vec<PyRef<'_, Body>>,
    stack: StackParts,
    time: f64,
) -> PyResult<Curve<'py>> {
    let pair = pair(&bodies, &[stack], &[])?.map_err(|error| raised(py, error))?;
    let creep = pair.creep.value(time);
    let of_wave = |q: &f64| match &pair.waves {
        Some(waves) => waves.creep(*q).map(|creep| creep.value(time)),
        None => Ok(creep * pair.kernel.symbol(*q, 0.0)),
    };
    let values: asperity::Result<Vec<f64>> = waves.as_array().iter().map(of_wave).collect();
    Ok(values.map_err(|error| raised(py, error))?.into_pyarray(py))
}

impl Body {
    /// Whether the temperature of the run changes its times.
    pub fn is_thermal(&self) -> bool {
        self.shift.is_some()
    }
}

/// A body at a constant temperature.
fn warmed(
    body: &material::Body,
    shift: &Shift,
    vertical: Option<&VerticalShift>,
    kelvin: f64,
) -> asperity::Result<material::Body> {
    let material = TemperatureFactors::at(shift, vertical, kelvin)?.of(&body.material)?;
    Ok(material::Body { material, ..body.clone() })
}

type Curve<'py> = Bound<'py, PyArray1<f64>>;

#[pymethods]
impl Body {
    /// A body of a named model. `numbers` are the model's moduli and times in the order of its Rust constructor,
    /// `terms` its (modulus or fraction or compliance, time) pairs.
    #[new]
    #[pyo3(signature = (model, measure, numbers, terms, poisson, bulk_modulus, hardness, name, shift, temperature))]
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
        shift: Option<ShiftWords>,
        temperature: Option<f64>,
    ) -> PyResult<Body> {
        let measure = choose("measure", measure)?;
        let lateral = match (poisson, bulk_modulus) {
            (Some(nu), None) => Lateral::Poisson(nu),
            (None, Some(modulus)) => Lateral::BulkModulus(modulus),
            _ => return Err(CaseError::new_err("give poisson or bulk_modulus, exactly one of them")),
        };
        let (material, error) = build(model, measure, &numbers, &terms).map_err(|error| raised(py, error))?;
        let mut inner = material::Body { name, material, lateral, hardness };
        let (mut shift, vertical) = shift.map(self::shift).transpose()?.unzip();
        let mut vertical = match &shift {
            Some(shift) => {
                shift.validate().map_err(|error| raised(py, error))?;
                vertical.unwrap_or_default().known(shift.reference()).map_err(CaseError::new_err)?
            }
            None => None,
        };
        if let Some(own) = temperature {
            let Some(law) = shift.take() else {
                let words =
                    "but without a shift the material does not depend on it: give shift=asperity.wlf(...)";
                return Err(CaseError::new_err(format!("temperature is {own}, {words}")));
            };
            let moved = warmed(&inner, &law, vertical.take().as_ref(), own);
            inner = moved.map_err(|error| raised(py, error))?;
        }
        // Poisson's ratio, bulk modulus and hardness are checked where they are used.
        inner.contact_creep().map_err(|error| raised(py, error))?;
        Ok(Body { inner, shift, vertical, error })
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
        let (storage, loss): (Vec<f64>, Vec<f64>) =
            omega.as_array().iter().map(|w| creep.modulus(*w)).unzip();
        Ok((storage.into_pyarray(py), loss.into_pyarray(py)))
    }

    /// Poisson's ratio where it is constant in time, and the functions of one that is not as JSON.
    fn poisson(&self) -> (Option<f64>, Option<String>) {
        match Ratio::of(&self.inner) {
            Some(Ratio::Constant(ratio)) => (Some(ratio), None),
            Some(changing) => (None, serde_json::to_string(&changing).ok()),
            None => (None, None),
        }
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

    /// Largest relative error of creep and relaxation of a fractional model in its window; None of others.
    #[getter]
    fn error(&self) -> Option<f64> {
        self.error
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

/// The material, and how far a Prony sum is from the fractional model that it stands for.
fn build(
    model: &str,
    measure: Modulus,
    numbers: &[f64],
    terms: &[(f64, f64)],
) -> asperity::Result<(Material, Option<f64>)> {
    let sum = |model: Fractional, window: [f64; 2], tolerance: f64| {
        let sum = model.to_prony(window, tolerance)?;
        Ok((Material::generalised_kelvin(measure, sum.creep)?, Some(sum.error)))
    };
    match (model, numbers) {
        ("springpot", [modulus, time, order, first, last, tolerance]) => sum(
            Fractional::Springpot { modulus: *modulus, time: *time, order: *order },
            [*first, *last],
            *tolerance,
        ),
        ("fractional-maxwell", [modulus, time, order, first, last, tolerance]) => sum(
            Fractional::Maxwell { modulus: *modulus, time: *time, order: *order },
            [*first, *last],
            *tolerance,
        ),
        ("fractional-zener", [equilibrium, instantaneous, time, order, first, last, tolerance]) => {
            let model = Fractional::Zener {
                equilibrium: *equilibrium,
                instantaneous: *instantaneous,
                time: *time,
                order: *order,
            };
            sum(model, [*first, *last], *tolerance)
        }
        _ => Ok((exact(model, measure, numbers, terms)?, None)),
    }
}

/// A model that is a Prony series.
fn exact(model: &str, measure: Modulus, numbers: &[f64], terms: &[(f64, f64)]) -> asperity::Result<Material> {
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
        _ => Err(asperity::Error::invalid("model", model, "one of those of the package, with its numbers")),
    }
}
