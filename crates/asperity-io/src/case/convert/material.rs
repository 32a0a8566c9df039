//! Materials: from the keys of a model to the model, before the times of the run are known.

use std::ops::Range;

use asperity::material::{Creep, CreepTerm, Fractional, Material, Modulus, Relaxation, Shift};

use super::sample::{Model, Sample};
use super::{Checks, curve, temperature};
use crate::case::error::CaseError;
use crate::case::quantity::range::{Order, Positive, Tolerance};
use crate::case::quantity::{Number, Pressure, Time};
use crate::case::raw::{self, At};
use crate::case::text::Text;
use crate::curve::{ShiftRequest, VerticalRequest};

/// The conversion between relaxation and creep finds as many roots as there are terms.
const MOST_TERMS: usize = 1000;
/// Relative error of a Prony sum in place of a fractional model, where the case gives none.
const TOLERANCE: f64 = 1e-3;

const WITHOUT_SHIFT: &str = "without a `shift` the material does not depend on temperature";
const ADD_SHIFT: &str = "add shift = { model = \"wlf\", ... } to the material, or leave the temperature out";

pub fn sample(checks: &mut Checks<'_, '_>, at: &At<raw::Material>) -> Option<Sample> {
    let span = &at.span;
    let (shift, temperature) = at.value.thermal();
    let request = match shift {
        Some(shift) => temperature::shift(checks, shift)?,
        None => ShiftRequest::None,
    };
    let vertical = temperature::vertical(checks, shift, fit_of(&at.value))?;
    let measured = matches!(
        &at.value,
        raw::Material::RelaxationTable(_) | raw::Material::CreepTable(_) | raw::Material::Dma(_)
    );
    // A spreadsheet may hold the shift of what it measures.
    if let (Some(own), ShiftRequest::None, false) = (temperature, &request, measured) {
        checks.fault(&own.span, WITHOUT_SHIFT.to_owned(), "a material with a shift", Some(ADD_SHIFT));
        return None;
    }
    let name = name(&at.value);
    let own = temperature.map(|at| at.value.get());
    let fitted = |checks: &mut Checks<'_, '_>, fit: Option<curve::Fit>| {
        let fit = fit?;
        let (shift, vertical) = (fit.fitted.shift.clone(), fit.fitted.vertical.clone());
        if let (Some(at), None) = (temperature, &shift) {
            checks.fault(&at.span, WITHOUT_SHIFT.to_owned(), "a material with a shift", Some(ADD_SHIFT));
            return None;
        }
        let file = Some((fit.file.clone(), fit.digest));
        let model = Model::Fitted { fitted: Box::new(fit.fitted), file: fit.file };
        Some(Sample { model, name, shift, vertical, temperature: own, file })
    };
    match &at.value {
        raw::Material::RelaxationTable(m) => {
            let fit = curve::relaxation(checks, m, request, vertical);
            return fitted(checks, fit);
        }
        raw::Material::CreepTable(m) => {
            let fit = curve::creep(checks, m, request, vertical);
            return fitted(checks, fit);
        }
        raw::Material::Dma(m) => {
            let fit = curve::dma(checks, m, request, vertical);
            return fitted(checks, fit);
        }
        _ => {}
    }
    let model = match fractional(checks, span, &at.value) {
        Some(model) => model?,
        None => Model::Known(known(checks, span, &at.value)?),
    };
    let place = shift.map_or(span, |at| &at.span);
    let law = match request {
        ShiftRequest::None => None,
        ShiftRequest::Given(shift) => Some(shift),
        ShiftRequest::Estimate(_) => {
            let message = "a shift can be estimated only from a file with several temperatures".to_owned();
            checks.fault(place, message, "wlf, arrhenius or table", Some("give the constants of the shift"));
            return None;
        }
    };
    if vertical == VerticalRequest::Free {
        let message =
            "factors of moduli can be estimated only from a file with several temperatures".to_owned();
        checks.fault(
            place,
            message,
            "\"density\", or pairs [temperature, b_T]",
            Some("give vertical = \"density\""),
        );
        return None;
    }
    let vertical = match vertical.known(law.as_ref().and_then(Shift::reference)) {
        Ok(vertical) => vertical,
        Err(message) => {
            checks.fault(place, message, "a vertical shift", None);
            return None;
        }
    };
    Some(Sample { model, name, shift: law, vertical, temperature: own, file: None })
}

/// How a measured material is fitted, where it says so.
fn fit_of(material: &raw::Material) -> Option<&At<raw::Fit>> {
    match material {
        raw::Material::RelaxationTable(m) => m.fit.as_ref(),
        raw::Material::CreepTable(m) => m.fit.as_ref(),
        raw::Material::Dma(m) => m.fit.as_ref(),
        _ => None,
    }
}

/// The shortest time that the bodies show in a run to `end` [s]: the shortest retardation time, at the warmest; for
/// models that hold at all times, or were measured over any, a thousandth of the run. Infinite for elastic bodies.
pub fn shortest(samples: &[Option<Sample>], temperatures: Option<&[(f64, f64)]>, end: f64) -> f64 {
    let of = |sample: &Sample| {
        let Model::Known(material) = &sample.model else { return 1e-3 * end };
        let warm = match (sample.temperature, temperatures) {
            (Some(own), _) => vec![own],
            (None, Some(points)) => points.iter().map(|point| point.1).collect(),
            (None, None) => vec![],
        };
        let factors = warm.iter().filter_map(|t| sample.shift.as_ref()?.factor(*t).ok());
        let fastest = factors.fold(f64::INFINITY, f64::min);
        let fastest = if fastest.is_finite() && fastest > 0.0 { fastest } else { 1.0 };
        material
            .creep()
            .terms
            .iter()
            .map(|term| fastest * term.retardation_time)
            .fold(f64::INFINITY, f64::min)
    };
    samples.iter().flatten().map(of).fold(f64::INFINITY, f64::min)
}

/// A model that is a Prony sum only over a window of times.
fn fractional(
    checks: &mut Checks<'_, '_>,
    span: &Range<usize>,
    material: &raw::Material,
) -> Option<Option<Model>> {
    let model = |measure, model, time: Time<Positive>, tolerance: Option<Number<Tolerance>>| {
        let tolerance = tolerance.map_or(TOLERANCE, |tolerance| tolerance.get());
        Model::Fractional { measure, model, time: time.get(), tolerance }
    };
    let order = |order: Number<Order>| order.get();
    match material {
        raw::Material::Springpot(m) => {
            Some(modulus(checks, span, m.young, m.shear).map(|(measure, modulus)| {
                let springpot = Fractional::Springpot { modulus, time: m.time.get(), order: order(m.order) };
                model(measure, springpot, m.time, m.tolerance)
            }))
        }
        raw::Material::FractionalMaxwell(m) => {
            Some(modulus(checks, span, m.young, m.shear).map(|(measure, modulus)| {
                let maxwell = Fractional::Maxwell { modulus, time: m.time.get(), order: order(m.order) };
                model(measure, maxwell, m.time, m.tolerance)
            }))
        }
        raw::Material::FractionalZener(m) => Some(both_moduli(checks, span, m).map(|(measure, moduli)| {
            let [equilibrium, instantaneous] = moduli;
            let (time, order) = (m.time.get(), order(m.order));
            let zener = Fractional::Zener { equilibrium, instantaneous, time, order };
            model(measure, zener, m.time, m.tolerance)
        })),
        _ => None,
    }
}

/// The moduli of a fractional Zener solid after all relaxation and at once, both Young's or both shear moduli.
fn both_moduli(
    checks: &mut Checks<'_, '_>,
    span: &Range<usize>,
    m: &raw::FractionalZener,
) -> Option<(Modulus, [f64; 2])> {
    let young = (m.young_equilibrium, m.young_instantaneous);
    let shear = (m.shear_equilibrium, m.shear_instantaneous);
    match (young, shear) {
        ((Some(e), Some(i)), (None, None)) => Some((Modulus::Young, [e.get(), i.get()])),
        ((None, None), (Some(e), Some(i))) => Some((Modulus::Shear, [e.get(), i.get()])),
        _ => {
            checks.push(|text| {
                let path = text.path(span);
                let wanted = "`young_equilibrium` and `young_instantaneous`, or `shear_equilibrium` and \
                              `shear_instantaneous`";
                let message = format!("{path} needs {wanted}");
                text.error(span, path, None, wanted, None, message)
            });
            None
        }
    }
}

/// A model that is known at all times.
fn known(checks: &mut Checks<'_, '_>, span: &Range<usize>, material: &raw::Material) -> Option<Material> {
    let made = match material {
        raw::Material::Elastic(m) => {
            let (measure, modulus) = modulus(checks, span, m.young, m.shear)?;
            Material::elastic(measure, modulus)
        }
        raw::Material::Maxwell(m) => {
            let (measure, modulus) = modulus(checks, span, m.young, m.shear)?;
            Material::maxwell(measure, modulus, m.relaxation_time.get())
        }
        raw::Material::KelvinVoigt(m) => {
            let (measure, modulus) = modulus(checks, span, m.young, m.shear)?;
            Material::kelvin_voigt(measure, modulus, m.retardation_time.get())
        }
        raw::Material::Zener(m) => {
            let (measure, modulus) = modulus(checks, span, m.young, m.shear)?;
            let kelvin = kelvin_modulus(checks, span, measure, m.young_kelvin, m.shear_kelvin)?;
            Material::zener(measure, modulus, kelvin, m.retardation_time.get())
        }
        raw::Material::Burgers(m) => {
            let (measure, modulus) = modulus(checks, span, m.young, m.shear)?;
            let kelvin = kelvin_modulus(checks, span, measure, m.young_kelvin, m.shear_kelvin)?;
            let (relaxation, retardation) = (m.relaxation_time.get(), m.retardation_time.get());
            Material::burgers(measure, modulus, relaxation, kelvin, retardation)
        }
        raw::Material::Prony(m) => {
            let relaxation = relaxation(checks, span, m)?;
            let relaxation = checks.core(span, relaxation)?;
            Material::prony(m.modulus, relaxation)
        }
        raw::Material::Creep(m) => {
            few_terms(checks, span, m.terms.len())?;
            let term = |term: &raw::CreepTerm| CreepTerm {
                compliance: term.compliance.get(),
                retardation_time: term.time.get(),
            };
            Material::generalised_kelvin(
                m.compliance,
                Creep {
                    instantaneous: m.instantaneous.get(),
                    terms: m.terms.iter().map(term).collect(),
                    fluidity: m.fluidity.map_or(0.0, |fluidity| fluidity.get()),
                },
            )
        }
        // These are not known here.
        raw::Material::Springpot(_)
        | raw::Material::FractionalMaxwell(_)
        | raw::Material::FractionalZener(_)
        | raw::Material::RelaxationTable(_)
        | raw::Material::CreepTable(_)
        | raw::Material::Dma(_) => return None,
    };
    checks.core(span, made)
}

type Given = Option<Pressure<Positive>>;

/// The one of `young` and `shear` that is given.
fn modulus(
    checks: &mut Checks<'_, '_>,
    material: &Range<usize>,
    young: Given,
    shear: Given,
) -> Option<(Modulus, f64)> {
    checks.exactly_one(material, &[("young", young.is_some()), ("shear", shear.is_some())])?;
    match (young, shear) {
        (Some(modulus), _) => Some((Modulus::Young, modulus.get())),
        (_, Some(modulus)) => Some((Modulus::Shear, modulus.get())),
        (None, None) => None,
    }
}

/// The Kelvin element's modulus, in the same measure as the first.
fn kelvin_modulus(
    checks: &mut Checks<'_, '_>,
    material: &Range<usize>,
    measure: Modulus,
    young: Given,
    shear: Given,
) -> Option<f64> {
    let (wanted, given, other) = match measure {
        Modulus::Young => ("young_kelvin", young, shear),
        Modulus::Shear => ("shear_kelvin", shear, young),
    };
    if let (Some(modulus), None) = (given, other) {
        return Some(modulus.get());
    }
    let first = measure.name();
    checks.push(|text| {
        let path = text.path(material);
        let message = format!(
            "{path} gives its first modulus as {first}, so it needs `{wanted}` and no other modulus of the \
             Kelvin element"
        );
        text.error(material, path, None, wanted, None, message)
    });
    None
}

/// The Prony table in one of its three forms: moduli, fractions of the modulus at once, ratios to the relaxed one.
fn relaxation(
    checks: &mut Checks<'_, '_>,
    material: &Range<usize>,
    prony: &raw::Prony,
) -> Option<asperity::Result<Relaxation>> {
    let keys =
        [("equilibrium", prony.equilibrium.is_some()), ("instantaneous", prony.instantaneous.is_some())];
    let given = checks.exactly_one(material, &keys)?;
    few_terms(checks, &prony.terms.span, prony.terms.value.len())?;
    let wanted = match (given, prony.terms.value.first()) {
        ("instantaneous", _) => "fraction",
        // All terms as the first one.
        (_, Some(term)) if term.value.ratio.is_some() => "ratio",
        _ => "modulus",
    };
    let mut terms = Vec::with_capacity(prony.terms.value.len());
    let mut complete = true;
    for term in &prony.terms.value {
        let forms = [
            ("modulus", term.value.modulus.map(|m| m.get())),
            ("fraction", term.value.fraction.map(|f| f.get())),
            ("ratio", term.value.ratio.map(|r| r.get())),
        ];
        let found = forms.iter().find(|form| form.0 == wanted).and_then(|form| form.1);
        let strays: Vec<&str> =
            forms.iter().filter(|form| form.0 != wanted && form.1.is_some()).map(|form| form.0).collect();
        match (found, strays.as_slice()) {
            (Some(value), []) => terms.push((value, term.value.time.get())),
            _ => {
                complete = false;
                checks.push(|text| one_form(text, &term.span, wanted, given, &strays));
            }
        }
    }
    if !complete {
        return None;
    }
    match (wanted, prony.equilibrium, prony.instantaneous) {
        ("ratio", Some(equilibrium), _) => Some(Relaxation::from_equilibrium(equilibrium.get(), &terms)),
        (_, Some(equilibrium), _) => Some(Relaxation::absolute(equilibrium.get(), &terms)),
        (_, _, Some(instantaneous)) => Some(Relaxation::from_instantaneous(instantaneous.get(), &terms)),
        (_, None, None) => None,
    }
}

/// A term that is not of the form of the others.
fn one_form(text: &Text<'_>, span: &Range<usize>, wanted: &str, given: &str, strays: &[&str]) -> CaseError {
    let path = text.path(span);
    let why = match wanted {
        "ratio" => "the first term gives a ratio to `equilibrium`".to_owned(),
        _ => format!("the material gives `{given}`"),
    };
    let not = match strays {
        [] => String::new(),
        strays => format!(" and not `{}`", strays.join("` or `")),
    };
    let message = format!("{path} must have `{wanted}`{not}, because {why}");
    let help = "`equilibrium` takes terms with `modulus` or `ratio` (to it), `instantaneous` takes terms with `fraction` (of it)";
    text.error(span, path, Some(text.value(span)), wanted, Some(help.to_owned()), message)
}

fn few_terms(checks: &mut Checks<'_, '_>, span: &Range<usize>, terms: usize) -> Option<()> {
    if terms <= MOST_TERMS {
        return Some(());
    }
    let message = format!("the material has {terms} terms, but may have {MOST_TERMS}");
    let help = "three terms per decade of time are enough for any measured material";
    checks.fault(span, message, "fewer terms", Some(help));
    None
}

/// Name of the model in case files.
fn name(material: &raw::Material) -> &'static str {
    match material {
        raw::Material::Elastic(_) => "elastic",
        raw::Material::Maxwell(_) => "maxwell",
        raw::Material::KelvinVoigt(_) => "kelvin-voigt",
        raw::Material::Zener(_) => "zener",
        raw::Material::Burgers(_) => "burgers",
        raw::Material::Prony(_) => "prony",
        raw::Material::Creep(_) => "creep",
        raw::Material::Springpot(_) => "springpot",
        raw::Material::FractionalMaxwell(_) => "fractional-maxwell",
        raw::Material::FractionalZener(_) => "fractional-zener",
        raw::Material::RelaxationTable(_) => "relaxation-table",
        raw::Material::CreepTable(_) => "creep-table",
        raw::Material::Dma(_) => "dma",
    }
}
