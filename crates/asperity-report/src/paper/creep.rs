//! Figure 3: the creep compliance of PMMA.

use asperity::material::{Material, Modulus, Relaxation};

use super::{Difference, Reproduction, Result};
use crate::figure::{Axis, Curves, Figure, Series, Style};

/// E(t) of the paper's eq. 23 with its misprint corrected \[Pa\].
const EQUILIBRIUM: f64 = 1973e6;
const TERMS: [(f64, f64); 2] = [(254.776e6, 8.93), (263.6628e6, 117.96)];
/// Steps of the numerical solution, and its end \[s\].
const STEPS: usize = 4000;
const END: f64 = 800.0;

pub(super) fn pmma() -> Result<Reproduction> {
    let relaxation = Relaxation::absolute(EQUILIBRIUM, &TERMS)?;
    let material = Material::prony(Modulus::Young, relaxation.clone())?;
    let time: Vec<f64> = (0..=400).map(|n| f64::from(n) * END / 400.0).collect();
    let solved = volterra(&relaxation);
    let exact = |t: f64| material.creep().value(t);
    let every = STEPS / 40;
    let points: Vec<[f64; 2]> =
        solved.iter().enumerate().step_by(every).map(|(n, d)| [n as f64 * END / STEPS as f64, *d]).collect();
    let largest = points.iter().map(|[t, d]| (d / exact(*t) - 1.0).abs()).fold(0.0, f64::max);
    let panel = Curves::new("", Axis::linear("time", "s"), Axis::linear("creep compliance", "1/Pa"))
        .with(Series::of("exact conversion", Style::Line, &time, exact))
        .with(Series::through("convolution solved in steps", Style::Points, points));
    let figure = Figure::new("").with(panel).panel_size([345.0, 240.0]);
    let differences = vec![Difference::new("Largest difference of the compliance", largest, "it")];
    let more = "Uniaxial creep compliance that belongs to the relaxation modulus of eq. 23.";
    Ok(Reproduction::new(3, "creep compliance of PMMA", figure, differences, more))
}

/// D(t) from int_0^t E(t - s) dD(s) = 1 in equal steps, E taken in the middle of each: knows no Prony series.
fn volterra(relaxation: &Relaxation) -> Vec<f64> {
    let step = END / STEPS as f64;
    let middle: Vec<f64> = (0..STEPS).map(|n| relaxation.value((n as f64 + 0.5) * step)).collect();
    let first = 1.0 / relaxation.value(0.0);
    let mut rises: Vec<f64> = Vec::with_capacity(STEPS);
    let mut compliance = vec![first];
    for n in 0..STEPS {
        // 1 = E(t) D(0) + sum of E(t - s_k) dD_k, the last of which is unknown
        let past: f64 = rises.iter().enumerate().map(|(k, rise)| middle[n - k] * rise).sum();
        let rise = (1.0 - relaxation.value((n as f64 + 1.0) * step) * first - past) / middle[0];
        rises.push(rise);
        compliance.push(compliance[n] + rise);
    }
    compliance
}
