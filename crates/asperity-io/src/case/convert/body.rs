//! Bodies: materials, and what the pair of them is to the contact.

use std::ops::Range;

use asperity::material::{
    Body, Creep, CreepTerm, Lateral, Material, Modulus, Relaxation, pair_creep, pair_hardness,
};

use super::Checks;
use crate::case::quantity::Pressure;
use crate::case::quantity::range::Positive;
use crate::case::raw::{self, At};

/// The bodies, and what the pair of them is to the contact.
pub struct Pair {
    pub bodies: Vec<Body>,
    /// Contact creep compliance of the pair [1/Pa].
    pub creep: Creep,
    /// Hardness of the softer body [Pa]; infinite without.
    pub hardness: f64,
}

/// The conversion between relaxation and creep finds as many roots as there are terms.
const MOST_TERMS: usize = 1000;

pub fn pair(checks: &mut Checks<'_, '_>, raw: &[At<raw::Body>]) -> Option<Pair> {
    if let Some(third) = raw.get(2) {
        checks.wrong(&third.span, "one of at most two bodies", Some("a missing second body is rigid"));
        return None;
    }
    let bodies: Vec<_> = raw.iter().enumerate().map(|(n, at)| body(checks, n, at)).collect();
    let bodies = bodies.into_iter().collect::<Option<Vec<Body>>>()?;
    for (body, at) in bodies.iter().zip(raw) {
        checks.core(&at.span, body.contact_creep())?;
    }
    let creep = checks.core(&raw.first()?.span, pair_creep(&bodies))?;
    let hardness = pair_hardness(&bodies);
    Some(Pair { bodies, creep, hardness })
}

fn body(checks: &mut Checks<'_, '_>, n: usize, at: &At<raw::Body>) -> Option<Body> {
    let raw = &at.value;
    let keys = [("poisson", raw.poisson.is_some()), ("bulk_modulus", raw.bulk_modulus.is_some())];
    let lateral = checks.exactly_one(&at.span, &keys);
    let material = material(checks, &raw.material);
    lateral?;
    Some(Body {
        name: raw.name.clone().unwrap_or_else(|| format!("body {}", n + 1)),
        material: material?,
        lateral: match (raw.poisson, raw.bulk_modulus) {
            (Some(ratio), _) => Lateral::Poisson(ratio.get()),
            (_, Some(modulus)) => Lateral::BulkModulus(modulus.get()),
            (None, None) => return None,
        },
        hardness: raw.hardness.map(|hardness| hardness.get()),
    })
}

fn material(checks: &mut Checks<'_, '_>, at: &At<raw::Material>) -> Option<Material> {
    let span = &at.span;
    let made = match &at.value {
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
            Material::prony(measure(m.modulus), relaxation)
        }
        raw::Material::Creep(m) => {
            few_terms(checks, span, m.terms.len())?;
            let term = |term: &raw::CreepTerm| CreepTerm {
                compliance: term.compliance.get(),
                retardation_time: term.time.get(),
            };
            Material::generalised_kelvin(
                measure(m.compliance),
                Creep {
                    instantaneous: m.instantaneous.get(),
                    terms: m.terms.iter().map(term).collect(),
                    fluidity: m.fluidity.map_or(0.0, |fluidity| fluidity.get()),
                },
            )
        }
    };
    checks.core(span, made)
}

fn measure(measure: raw::Measure) -> Modulus {
    match measure {
        raw::Measure::Young => Modulus::Young,
        raw::Measure::Shear => Modulus::Shear,
    }
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

fn relaxation(
    checks: &mut Checks<'_, '_>,
    material: &Range<usize>,
    prony: &raw::Prony,
) -> Option<asperity::Result<Relaxation>> {
    let keys =
        [("equilibrium", prony.equilibrium.is_some()), ("instantaneous", prony.instantaneous.is_some())];
    let given = checks.exactly_one(material, &keys)?;
    few_terms(checks, &prony.terms.span, prony.terms.value.len())?;
    let (wanted, other) = match prony.equilibrium.is_some() {
        true => ("modulus", "fraction"),
        false => ("fraction", "modulus"),
    };
    let mut terms = Vec::with_capacity(prony.terms.value.len());
    let mut complete = true;
    for term in &prony.terms.value {
        let (modulus, fraction) = (term.value.modulus.map(|m| m.get()), term.value.fraction.map(|f| f.get()));
        let (value, stray) = if wanted == "modulus" { (modulus, fraction) } else { (fraction, modulus) };
        match (value, stray) {
            (Some(value), None) => terms.push((value, term.value.time.get())),
            _ => {
                complete = false;
                checks.push(|text| {
                    let path = text.path(&term.span);
                    let message = format!(
                        "{path} must have `{wanted}` and not `{other}`, because the material gives `{given}`"
                    );
                    text.error(&term.span, path, Some(text.value(&term.span)), wanted, None, message)
                });
            }
        }
    }
    if !complete {
        return None;
    }
    match (prony.equilibrium, prony.instantaneous) {
        (Some(equilibrium), _) => Some(Relaxation::absolute(equilibrium.get(), &terms)),
        (_, Some(instantaneous)) => Some(Relaxation::from_instantaneous(instantaneous.get(), &terms)),
        (None, None) => None,
    }
}

fn few_terms(checks: &mut Checks<'_, '_>, span: &Range<usize>, terms: usize) -> Option<()> {
    if terms <= MOST_TERMS {
        return Some(());
    }
    let message = format!("the material has {terms} terms, but may have {MOST_TERMS}");
    let help = "three terms per decade of time describe any measured material";
    checks.fault(span, message, "fewer terms", Some(help));
    None
}
