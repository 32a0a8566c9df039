//! Materials at the temperature of the run, and where they come from.

use asperity::material::{self, Material, ReducedTime, Shift, TemperatureFactors, VerticalShift};
use asperity::time::Plan;

use super::describe::MaterialReport;
use super::material::{Model, Sample};
use super::place::Place;

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

/// How warm a body is: at a constant temperature, or on a clock of its own.
pub struct Warmth {
    pub constant: Option<TemperatureFactors>,
    pub clock: Option<ReducedTime>,
}

/// How warm a material is over the run.
pub fn warmth(sample: &Sample, course: &Course<'_>) -> asperity::Result<Warmth> {
    let constant = |factors| Warmth { constant: Some(factors), clock: None };
    let Some(shift) = &sample.shift else { return Ok(constant(TemperatureFactors::NONE)) };
    let at =
        |temperature: f64| TemperatureFactors::at(shift, sample.vertical.as_ref(), temperature).map(constant);
    match (sample.temperature, course.temperatures) {
        (Some(own), _) => at(own),
        (None, Some([first, rest @ ..])) if rest.iter().all(|point| point.1 == first.1) => at(first.1),
        (None, Some(_)) if sample.vertical.is_some() => Err(TemperatureFactors::not_constant()),
        (None, Some(points)) => {
            Ok(Warmth { constant: None, clock: Some(ReducedTime::new(shift.clone(), points)?) })
        }
        (None, None) => Ok(constant(TemperatureFactors::NONE)),
    }
}

impl Warmth {
    /// The shortest step and the end of the run, on the clock of the body [s].
    pub fn window(&self, plan: &Plan) -> Option<[f64; 2]> {
        let [shortest, end] = plan.window();
        let window = match &self.clock {
            None => {
                let factor = self.constant.map_or(1.0, |factors| factors.times);
                [shortest / factor, end / factor]
            }
            Some(clock) => {
                let steps = plan.instants.iter().filter(|instant| instant.dt > 0.0);
                let lengths = steps.map(|i| clock.elapsed(i.time - i.dt, i.time));
                [lengths.fold(f64::INFINITY, f64::min), clock.value(end)]
            }
        };
        (window[0] > 0.0 && window[1].is_finite()).then_some(window)
    }
}

/// A material by itself, at its own temperature or its reference; fractional models become Prony sums over `window` \[s\], or
/// four decades on either side of their time.
pub fn alone(
    at: &Place<'_>,
    sample: &Sample,
    window: Option<[f64; 2]>,
) -> Option<(Material, MaterialReport)> {
    let plan = |_: &[f64]| Plan { instants: Vec::new(), exact: true };
    let course = Course { end: None, plan: &plan, temperatures: None, beyond: 1.0 };
    let factors = at.core(warmth(sample, &course))?.constant.unwrap_or(TemperatureFactors::NONE);
    let around = match &sample.model {
        Model::Fractional { time, .. } => Some([1e-4 * time, 1e4 * time]),
        _ => None,
    };
    let window = window.map(|window| window.map(|t| t / factors.times)).or(around);
    let (material, report, _) = at_temperature(at, sample, Some(factors), window, 1.0)?;
    Some((material, report))
}

/// The material at the temperature of `factors` (`None`: at its reference), where it comes from, and whether the run goes beyond
/// what is known.
pub fn at_temperature(
    at: &Place<'_>,
    sample: &Sample,
    factors: Option<TemperatureFactors>,
    window: Option<[f64; 2]>,
    beyond: f64,
) -> Option<(Material, MaterialReport, Option<String>)> {
    let (reference, report, warning) = reference(at, sample, window, beyond)?;
    let material = match factors {
        Some(factors) => at.core(factors.of(&reference))?,
        None => reference,
    };
    let report = MaterialReport {
        law: sample.shift.clone(),
        vertical_law: sample.vertical.clone(),
        vertical: sample.vertical.as_ref().map(vertical),
        shift_factor: factors.filter(|_| sample.shift.is_some()).map(|factors| factors.times),
        vertical_factor: factors.filter(|_| sample.vertical.is_some()).map(|factors| factors.moduli),
        terms: material.creep().terms.len(),
        ..report
    };
    Some((material, report, warning))
}

/// The material at its reference temperature, where it comes from, and whether the run goes beyond what is known.
fn reference(
    at: &Place<'_>,
    sample: &Sample,
    window: Option<[f64; 2]>,
    beyond: f64,
) -> Option<(Material, MaterialReport, Option<String>)> {
    let report = MaterialReport { model: sample.name, ..MaterialReport::default() };
    match &sample.model {
        Model::Known(material) => {
            let report = MaterialReport { window: sample.window, ..report };
            Some((material.clone(), report, outside(sample, sample.window, window)))
        }
        Model::Fractional { measure, model, time, tolerance } => {
            // Without the times of the run, which are wrong, only the model's own numbers can be checked.
            let [first, last] = window.unwrap_or([1e-2 * time, 1e2 * time]);
            let window = [first / beyond, last * beyond];
            let sum = at.core(model.to_prony(window, *tolerance))?;
            let material = at.core(Material::generalised_kelvin(*measure, sum.creep))?;
            Some((material, MaterialReport { error: Some(sum.error), window: Some(window), ..report }, None))
        }
        Model::Fitted { fitted, file } => {
            let warning = outside(sample, Some(fitted.window), window);
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

/// Whether a run over the times `run` \[s\] goes beyond the `known` ones, in words.
fn outside(sample: &Sample, known: Option<[f64; 2]>, run: Option<[f64; 2]>) -> Option<String> {
    let clock = if sample.shift.is_some() { " (times at the reference temperature)" } else { "" };
    material::beyond(known?, run?).map(|words| words + clock)
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
