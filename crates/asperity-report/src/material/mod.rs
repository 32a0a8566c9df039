//! Materials: relaxation, creep, storage and loss over decades, and fits beside the points that they are made of.

mod force_curve;
mod indentation;
mod measured;
mod shift;

use std::f64::consts::TAU;

use asperity::material::{Material, Modulus};
use asperity_io::case::WaveReport;

pub use self::force_curve::force_curve;
pub use self::indentation::{indentation, power_law};
pub use self::measured::{fit, isotherms};
pub use self::shift::{Factors, shift_factors};
use crate::figure::{Axis, Curves, Figure, Series, Style};

/// Points of a curve per decade.
const PER_DECADE: f64 = 20.0;
/// Longest curve.
const MOST: f64 = 4000.0;

/// Relaxation modulus, creep compliance, storage and loss modulus, and tan delta (unless all are elastic) of materials, over times from
/// `window[0]` to `window[1]` \[s\] and the angular frequencies 1/t \[rad/s\].
///
/// ```
/// use asperity::material::{Material, Modulus, Relaxation};
/// use asperity_report::material::functions;
/// let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)])?;
/// let pmma = Material::prony(Modulus::Young, pmma)?;
/// let figure = functions("PMMA", &[("PMMA", &pmma)], [0.1, 1000.0])?;
/// assert_eq!(figure.panels.len(), 4);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`asperity::Error`] where a creep function has no relaxation function.
pub fn functions(title: &str, materials: &[(&str, &Material)], window: [f64; 2]) -> asperity::Result<Figure> {
    let times = decades(window);
    let frequencies = decades([1.0 / window[1], 1.0 / window[0]]);
    let young = materials.iter().all(|(_, material)| material.measure() == Modulus::Young);
    let (modulus, compliance) = if young { ("E", "D") } else { ("modulus", "compliance") };
    let time = || Axis::log("time", "s");
    let frequency = || Axis::log("angular frequency", "rad/s");
    let mut relaxing = Curves::new("Relaxation", time(), Axis::log(format!("relaxation {modulus}"), "Pa"));
    let mut creeping = Curves::new("Creep", time(), Axis::log(format!("creep {compliance}"), "1/Pa"));
    let hertz = |panel: Curves| panel.beside("Hz", 1.0 / TAU);
    let mut dynamic = hertz(Curves::new("Storage and loss", frequency(), Axis::log("modulus", "Pa")));
    let mut factor = hertz(Curves::new("Loss factor", frequency(), Axis::log("tan delta", "")));
    for (name, material) in materials {
        let relaxation = material.relaxation()?;
        let storage = |w: f64| relaxation.complex(w).0;
        let loss = |w: f64| relaxation.complex(w).1;
        relaxing = relaxing.with(Series::of(*name, Style::Line, &times, |t| relaxation.value(t)));
        creeping = creeping.with(Series::of(*name, Style::Line, &times, |t| material.creep().value(t)));
        dynamic = dynamic
            .with(Series::of(format!("{name}, storage"), Style::Line, &frequencies, storage))
            .with(Series::of(format!("{name}, loss"), Style::Dashed, &frequencies, loss));
        factor = factor.with(Series::of(*name, Style::Line, &frequencies, |w| loss(w) / storage(w)));
    }
    // Elastic bodies have a loss factor of 0, which a logarithmic axis cannot show.
    let lossy = materials
        .iter()
        .any(|(_, material)| !material.creep().terms.is_empty() || material.creep().fluidity > 0.0);
    Ok(Figure::new(title).with(relaxing).with(creeping).with(dynamic).with_all(lossy.then_some(factor)))
}

/// q C(q) of bodies of layers, and the contact modulus 2/(q C) of the equivalent half-space, over the wavelength.
pub fn layers(title: &str, waves: &[WaveReport]) -> Figure {
    let lengths: Vec<f64> = waves.iter().map(|wave| wave.length).collect();
    let relaxed: Vec<f64> = waves.iter().map(|wave| wave.relaxed_modulus).collect();
    let at_once: Vec<f64> =
        waves.iter().map(|wave| wave.instantaneous_modulus.unwrap_or(f64::INFINITY)).collect();
    let creeps = at_once.iter().zip(&relaxed).any(|(at_once, relaxed)| at_once != relaxed);
    let panel = |title: &str, axis: Axis, of: fn(f64) -> f64| {
        let line = |name: &str, moduli: &[f64]| {
            let points = lengths.iter().zip(moduli).map(|(length, modulus)| [*length, of(*modulus)]);
            Series::through(name, Style::Line, points)
        };
        let panel = Curves::new(title, Axis::log("length of the wave", "m"), axis);
        match creeps {
            true => panel.with(line("instantaneous", &at_once)).with(line("relaxed", &relaxed)),
            false => panel.with(line("", &relaxed)),
        }
    };
    Figure::new(title)
        .with(panel("Response of the layers", Axis::log("q C(q)", "1/Pa"), |modulus| 2.0 / modulus))
        .with(panel("Equivalent half-space", Axis::log("contact modulus", "Pa"), |modulus| modulus))
}

/// Places from one end to the other, evenly on a logarithmic scale.
fn decades([first, last]: [f64; 2]) -> Vec<f64> {
    let decades = (last / first).log10();
    if !(decades.is_finite() && decades > 0.0) {
        return vec![first, last];
    }
    let steps = (PER_DECADE * decades).ceil().clamp(1.0, MOST);
    (0..=steps as usize).map(|k| first * 10f64.powf(decades * k as f64 / steps)).collect()
}
