//! Bodies: from samples of materials to what the pair of them is to the contact.

use std::sync::Arc;

use asperity::finding::{self, Finding};
use asperity::layer::{Layered, NonseparableLayers};
use asperity::material::{
    Body, Creep, Lateral, Material, ReducedTime, Shift, TemperatureFactors, ThermalCreep, VerticalShift,
    pair_hardness,
};
use asperity::time::Plan;

use super::Checks;
use super::layer::{self, Made, Part};
use super::sample::{Model, Sample};
use crate::case::describe::MaterialReport;
use crate::case::raw::{self, At};

/// The bodies, and what the pair of them is to the contact.
pub struct Pair {
    /// What they consist of: each half-space, layer and base.
    pub bodies: Vec<Body>,
    /// How the bodies yield in space, where they have layers.
    pub layers: Option<Arc<Layered>>,
    /// How their waves creep, where they creep differently.
    pub waves: Option<Arc<NonseparableLayers>>,
    /// Contact creep compliance [1/Pa] of each body without layers, and its clock where its temperature changes.
    pub creeps: Vec<(Creep, Option<ReducedTime>)>,
    /// Contact creep compliance of the bodies of constant temperature [1/Pa].
    pub creep: Creep,
    /// The bodies whose temperature changes.
    pub thermal: Vec<ThermalCreep>,
    /// Hardness of the softer body [Pa]; infinite without.
    pub hardness: f64,
    /// Where the materials come from, one for each of `bodies`.
    pub reports: Vec<MaterialReport>,
    /// Where fits are poor, and where the run goes beyond what is known of a material.
    pub findings: Vec<Finding>,
    /// Rows of the run.
    pub plan: Plan,
}

impl Pair {
    /// Adds the bodies up.
    pub fn sum(&mut self) {
        (self.creep, self.thermal) = (Creep::default(), Vec::new());
        for (creep, clock) in &self.creeps {
            match clock {
                Some(clock) => {
                    self.thermal.push(ThermalCreep { creep: creep.clone(), clock: clock.clone() });
                }
                None => self.creep = self.creep.sum(creep),
            }
        }
    }

    /// C(0+) [1/Pa].
    pub fn instantaneous(&self) -> f64 {
        self.creep.instantaneous + self.thermal.iter().map(|body| body.creep.instantaneous).sum::<f64>()
    }

    /// Fields that the memory keeps.
    pub fn branches(&self) -> usize {
        let parts = std::iter::once(&self.creep).chain(self.thermal.iter().map(|body| &body.creep));
        parts.map(|creep| creep.terms.len() + usize::from(creep.fluidity > 0.0)).sum()
    }
}

/// When and how warm the run is.
pub struct Course<'a> {
    /// Last instant [s]; `None` for a fault.
    pub end: Option<f64>,
    /// The rows of the run as far as they are known, with steps at further instants [s]; none for a fault.
    pub plan: &'a dyn Fn(&[f64]) -> Plan,
    /// (time [s], temperature [K]) of the section [temperature].
    pub temperatures: Option<&'a [(f64, f64)]>,
    /// Steady motion asks for the loss at the ends of the window, which models of many times must reach beyond by this factor.
    pub beyond: f64,
}

pub fn pair(
    checks: &mut Checks<'_, '_>,
    raw: &[At<raw::Body>],
    parts: &[Part<'_>],
    samples: &[Option<Sample>],
    course: &Course<'_>,
) -> Option<Pair> {
    if let Some(third) = raw.get(2) {
        checks.wrong(&third.span, "one of at most two bodies", Some("a missing second body is rigid"));
        return None;
    }
    let samples: Vec<_> = parts.iter().zip(samples).collect();
    let warmths: Vec<Option<Warmth>> = samples
        .iter()
        .map(|(part, sample)| checks.core(&part.material.span, warmth(sample.as_ref()?, course)))
        .collect();
    let clocks = warmths.iter().flatten().filter_map(Warmth::clock);
    let end = course.end.unwrap_or(0.0);
    let plan = (course.plan)(&clocks.flat_map(|clock| clock.breaks(end)).collect::<Vec<f64>>());
    let made: Vec<_> = samples
        .into_iter()
        .zip(warmths)
        .map(|((part, sample), warmth)| made(checks, part, sample.as_ref(), warmth, &plan, course))
        .collect();
    let made = made.into_iter().collect::<Option<Vec<Made>>>()?;
    let mut pair = Pair {
        bodies: Vec::new(),
        layers: None,
        waves: None,
        creeps: Vec::new(),
        creep: Creep::default(),
        thermal: Vec::new(),
        hardness: f64::INFINITY,
        reports: Vec::new(),
        findings: Vec::new(),
        plan,
    };
    let layered = raw.iter().any(|at| !at.value.layer.is_empty());
    if layered {
        let response = layer::respond(checks, raw, parts, &made)?;
        pair.layers = Some(Arc::new(response.kernel));
        pair.waves = response.waves;
        match made.first().and_then(|made| made.clock.clone()) {
            Some(clock) => pair.thermal.push(ThermalCreep { creep: response.creep, clock }),
            None => pair.creep = response.creep,
        }
    }
    for made in made {
        if !layered {
            pair.creeps.push((made.creep, made.clock));
        }
        pair.bodies.push(made.body);
        pair.findings.extend(made.findings);
        pair.reports.push(made.report);
    }
    if !layered {
        pair.sum();
    }
    pair.hardness = pair_hardness(&pair.bodies);
    Some(pair)
}

fn made(
    checks: &mut Checks<'_, '_>,
    part: &Part<'_>,
    sample: Option<&Sample>,
    warmth: Option<Warmth>,
    plan: &Plan,
    course: &Course<'_>,
) -> Option<Made> {
    let keys = [("poisson", part.poisson.is_some()), ("bulk_modulus", part.bulk_modulus.is_some())];
    checks.exactly_one(part.span, &keys)?;
    let name = part.name.clone();
    let lateral = match (part.poisson, part.bulk_modulus) {
        (Some(ratio), _) => Lateral::Poisson(ratio.get()),
        (_, Some(modulus)) => Lateral::BulkModulus(modulus.get()),
        (None, None) => return None,
    };
    let (sample, warmth) = (sample?, warmth?);
    let window = warmth.window(plan);
    let (reference, report, outside) = reference(checks, part.material, sample, window, course.beyond)?;
    let mut findings = findings(&name, &report, window, outside);
    findings.extend(finding::unlikely_temperature(&name, coldest(sample, course.temperatures)));
    let factors = warmth.constant();
    let material = match factors {
        Some(factors) => checks.core(&part.material.span, factors.of(&reference))?,
        None => reference,
    };
    let clock = match warmth {
        Warmth::Changing(clock) => Some(clock),
        Warmth::Constant(_) => None,
    };
    let report = MaterialReport {
        body: name.clone(),
        law: sample.shift.clone(),
        vertical_law: sample.vertical.clone(),
        vertical: sample.vertical.as_ref().map(vertical),
        shift_factor: factors.filter(|_| sample.shift.is_some()).map(|factors| factors.times),
        vertical_factor: factors.filter(|_| sample.vertical.is_some()).map(|factors| factors.moduli),
        terms: material.creep().terms.len(),
        ..report
    };
    let body = Body { name, material, lateral, hardness: part.hardness };
    let creep = checks.core(part.span, body.contact_creep())?;
    Some(Made { body, creep, clock, report, findings })
}

/// The lowest temperature that a material with a shift is told \[K\]; infinite without a shift.
fn coldest(sample: &Sample, course: Option<&[(f64, f64)]>) -> f64 {
    let Some(shift) = &sample.shift else { return f64::INFINITY };
    let course = course.unwrap_or_default().iter().map(|point| point.1);
    shift.reference().into_iter().chain(sample.temperature).chain(course).fold(f64::INFINITY, f64::min)
}

/// What is found about the material of the body `name`; `beyond` says where a run over `window` [s] leaves the data.
fn findings(
    name: &str,
    report: &MaterialReport,
    window: Option<[f64; 2]>,
    beyond: Option<String>,
) -> Vec<Finding> {
    let misfit = match (report.rms_misfit, report.max_misfit) {
        (Some(rms), Some(largest)) => finding::misfit(name, rms, largest, report.noise.unwrap_or(0.0)),
        _ => None,
    };
    let beyond = match (beyond, window, report.window) {
        (Some(words), Some(needed), Some(known)) => Some(finding::beyond_data(name, needed, known, &words)),
        _ => None,
    };
    let other = report
        .other_misfit
        .as_ref()
        .and_then(|(column, misfit)| finding::contradiction(name, column, *misfit));
    let measured = report.points.unwrap_or(0) + report.left_out;
    let left_out = finding::points_left_out(name, report.left_out, measured);
    misfit.into_iter().chain(other).chain(beyond).chain(left_out).collect()
}

/// A material by itself, and where it comes from.
pub fn alone(
    checks: &mut Checks<'_, '_>,
    at: &At<raw::Material>,
    sample: &Sample,
    window: Option<[f64; 2]>,
) -> Option<(Material, MaterialReport)> {
    let plan = |_: &[f64]| Plan { instants: Vec::new(), exact: true };
    let course = Course { end: None, plan: &plan, temperatures: None, beyond: 1.0 };
    let factors =
        checks.core(&at.span, warmth(sample, &course))?.constant().unwrap_or(TemperatureFactors::NONE);
    let around = match &sample.model {
        Model::Fractional { time, .. } => Some([1e-4 * time, 1e4 * time]),
        _ => None,
    };
    let window = window.map(|window| window.map(|t| t / factors.times)).or(around);
    let (reference, report, _) = reference(checks, at, sample, window, 1.0)?;
    let material = checks.core(&at.span, factors.of(&reference))?;
    let report = MaterialReport {
        terms: material.creep().terms.len(),
        shift_factor: sample.shift.is_some().then_some(factors.times),
        law: sample.shift.clone(),
        vertical_law: sample.vertical.clone(),
        vertical: sample.vertical.as_ref().map(vertical),
        vertical_factor: sample.vertical.is_some().then_some(factors.moduli),
        ..report
    };
    Some((material, report))
}

/// How warm a body is.
enum Warmth {
    /// At a constant temperature.
    Constant(TemperatureFactors),
    Changing(ReducedTime),
}

fn warmth(sample: &Sample, course: &Course<'_>) -> asperity::Result<Warmth> {
    let Some(shift) = &sample.shift else { return Ok(Warmth::Constant(TemperatureFactors::NONE)) };
    let factors = |temperature: f64| {
        TemperatureFactors::at(shift, sample.vertical.as_ref(), temperature).map(Warmth::Constant)
    };
    match (sample.temperature, course.temperatures) {
        (Some(own), _) => factors(own),
        (None, Some([first, rest @ ..])) if rest.iter().all(|point| point.1 == first.1) => factors(first.1),
        (None, Some(_)) if sample.vertical.is_some() => Err(TemperatureFactors::not_constant()),
        (None, Some(points)) => Ok(Warmth::Changing(ReducedTime::new(shift.clone(), points)?)),
        (None, None) => Ok(Warmth::Constant(TemperatureFactors::NONE)),
    }
}

impl Warmth {
    fn clock(&self) -> Option<&ReducedTime> {
        match self {
            Warmth::Constant(_) => None,
            Warmth::Changing(clock) => Some(clock),
        }
    }

    fn constant(&self) -> Option<TemperatureFactors> {
        match self {
            Warmth::Constant(factors) => Some(*factors),
            Warmth::Changing(_) => None,
        }
    }

    /// The shortest step and the end of the run, on the clock of the body [s].
    fn window(&self, plan: &Plan) -> Option<[f64; 2]> {
        let [shortest, end] = plan.window();
        let window = match self {
            Warmth::Constant(factors) => [shortest / factors.times, end / factors.times],
            Warmth::Changing(clock) => {
                let steps = plan.instants.iter().filter(|instant| instant.dt > 0.0);
                let lengths = steps.map(|i| clock.elapsed(i.time - i.dt, i.time));
                [lengths.fold(f64::INFINITY, f64::min), clock.value(end)]
            }
        };
        (window[0] > 0.0 && window[1].is_finite()).then_some(window)
    }
}

/// The material at its reference temperature, where it comes from, and whether the run goes beyond what is known.
fn reference(
    checks: &mut Checks<'_, '_>,
    at: &At<raw::Material>,
    sample: &Sample,
    window: Option<[f64; 2]>,
    beyond: f64,
) -> Option<(Material, MaterialReport, Option<String>)> {
    let report = MaterialReport { model: sample.name, ..MaterialReport::default() };
    match &sample.model {
        Model::Known(material) => Some((material.clone(), report, None)),
        Model::Fractional { measure, model, time, tolerance } => {
            // Without the times of the run, which are wrong, only the model's own numbers can be checked.
            let [first, last] = window.unwrap_or([1e-2 * time, 1e2 * time]);
            let window = [first / beyond, last * beyond];
            let sum = checks.core(&at.span, model.to_prony(window, *tolerance))?;
            let material = checks.core(&at.span, Material::generalised_kelvin(*measure, sum.creep))?;
            Some((material, MaterialReport { error: Some(sum.error), window: Some(window), ..report }, None))
        }
        Model::Fitted { fitted, file } => {
            let beyond = window.and_then(|[first, last]| fitted.beyond(first, last));
            let clock = if sample.shift.is_some() { " (times at the reference temperature)" } else { "" };
            let warning = beyond.map(|words| words + clock);
            let report = MaterialReport {
                max_misfit: Some(fitted.misfit.max),
                rms_misfit: Some(fitted.misfit.rms),
                noise: Some(fitted.noise),
                other_misfit: fitted.other().map(|(name, misfit)| (name.to_owned(), misfit.rms)),
                columns: fitted
                    .columns
                    .iter()
                    .map(|(name, m)| ((*name).to_owned(), [m.rms, m.max]))
                    .collect(),
                window: Some(fitted.window),
                points: Some(fitted.data.x.len()),
                left_out: fitted.left_out,
                temperatures: fitted.temperatures.clone(),
                file: Some(file.clone()),
                shift: sample.shift.as_ref().map(law),
                notes: fitted.notes.clone(),
                ..report
            };
            Some((fitted.material.clone(), report, warning))
        }
    }
}

/// The vertical shift in words.
fn vertical(vertical: &VerticalShift) -> String {
    match vertical {
        VerticalShift::Density { expansion, .. } => {
            let volume =
                if *expansion > 0.0 { format!(", expansion {expansion:e} 1/K") } else { String::new() };
            format!("density times temperature{volume}")
        }
        VerticalShift::Table { points } => format!("table of {} factors b_T", points.len()),
    }
}

/// The law in words.
fn law(shift: &Shift) -> String {
    match shift {
        Shift::Wlf { c1, c2, reference } => {
            format!("WLF, c1 = {c1:.4}, c2 = {c2:.4} K about {reference:.2} K")
        }
        Shift::Arrhenius { activation_energy, reference } => {
            format!("Arrhenius, {:.4} kJ/mol about {reference:.2} K", 1e-3 * activation_energy)
        }
        Shift::Table { points } => format!("table of {} shift factors", points.len()),
    }
}
