//! Deformations beyond linear theory.
//!
//! The half-space is linear: it assumes that the contact is small compared with the radius, a/R, and that strains are small. Two
//! numbers measure this: the approach over the contact radius, w/a, which is a/R of a paraboloid and a measure of the strain of
//! any compact contact that has not shrunk (K. L. Johnson, Contact Mechanics, 1985, section 3.5), and the contact pressure over the relaxed modulus,
//! ε(t) = ∫ C(t - s) dp(s). A Hertzian contact has ε = 2a/(πR), so the two limits agree. The pressure is the largest one, or that
//! in the middle of a Hertzian contact of the same load and area, 3W/(2A), if that is smaller: at the edge of a punch the largest
//! pressure is infinite, and depends on the size of the cells. On layers the compliance of a contact of radius a is q K(q)/2
//! times that of the half-space of the top layer, q = 1/a, and its strain has the same factor.

use std::f64::consts::PI;
use std::sync::Arc;

use super::contact::Counted;
use super::words::{digits, si};
use super::worst::Worst;
use super::{Finding, LARGE_STRAIN, UNLIKELY_UNIT};
use crate::kernel::Kernel;
use crate::layer::NonseparableLayers;
use crate::material::{Creep, ReducedTime};
use crate::simulation::Simulation;
use crate::sliding::Streaming;
use crate::step::Row;

/// Contact radius over radius.
const WIDEST: f64 = 0.3;
/// Pressure over modulus.
const HARDEST: f64 = 0.2;
/// Approach over thickness of layers on a rigid base.
const SQUEEZED: f64 = 0.2;

/// The strains of the rows.
pub(super) struct Strain {
    bodies: Vec<Branches>,
    /// In steady states of motion: the compliance at the frequency of passing spots, and the side of a cell \[m\].
    sweep: Option<(Streaming, f64)>,
    kernel: Arc<dyn Kernel>,
    /// Layers whose waves creep differently.
    waves: Option<Arc<NonseparableLayers>>,
    time: f64,
    /// Radius of the shapes \[m\], if known.
    radius: Option<f64>,
    /// Largest contact so far \[m^2\].
    largest: f64,
    width: Worst,
    pressure: Worst,
}

impl Strain {
    pub(super) fn new(simulation: &Simulation, radius: Option<f64>) -> Self {
        let thermal = simulation.thermal.iter().map(|body| Branches::new(&body.creep, Some(&body.clock)));
        Strain {
            bodies: std::iter::once(Branches::new(&simulation.creep, None)).chain(thermal).collect(),
            sweep: None,
            kernel: simulation.kernel.clone(),
            waves: simulation.layers.clone(),
            time: 0.0,
            radius,
            largest: 0.0,
            width: Worst::default(),
            pressure: Worst::default(),
        }
    }

    /// The following rows are steady states of motion at their velocities.
    pub(super) fn sweep(&mut self, streaming: Streaming, cell: f64) {
        self.sweep = Some((streaming, cell));
    }

    pub(super) fn see(&mut self, index: usize, row: &Row, contact: Counted) {
        let start = std::mem::replace(&mut self.time, row.coordinate.value());
        // Largest over mean pressure of Hertz's contact.
        let hertz = if contact.line { 4.0 / PI } else { 1.5 };
        let of_hertz = if row.contact_area > 0.0 { hertz * row.load / row.contact_area } else { 0.0 };
        let pressure = row.max_pressure.min(of_hertz) * self.share(row, contact);
        let of_wave = self.waves.as_ref().filter(|_| contact.is_compact() && row.contact_area > 0.0);
        let creep = of_wave.and_then(|waves| waves.creep(wave_of(row, contact)).ok());
        let strain: f64 = match &self.sweep {
            Some((streaming, cell)) if row.contact_area > 0.0 => {
                let width = contact.width().min(contact.cells) * cell;
                pressure * streaming.at(row.coordinate.value() * PI / width).norm()
            }
            Some(_) => 0.0,
            None if creep.is_some() => {
                // As if the pressure had acted from t = 0 on.
                let creep = creep.map_or(0.0, |creep| creep.value(row.coordinate.value()));
                row.max_pressure.min(of_hertz) * 0.5 * wave_of(row, contact) * creep
            }
            None => self
                .bodies
                .iter_mut()
                .map(|body| body.strain([start, row.coordinate.value()], pressure))
                .sum(),
        };
        self.pressure.above(index, strain, HARDEST);
        let shrunk = row.contact_area < self.largest;
        self.largest = self.largest.max(row.contact_area);
        let width = match (contact.is_compact(), self.radius) {
            // A load that falls leaves an imprint deeper than the contact that remains: w/a is no strain then.
            (true, _) if shrunk => 0.0,
            (true, Some(radius)) if contact.line => 0.5 * row.contact_area / radius,
            _ if contact.line || row.contact_area <= 0.0 || row.approach <= 0.0 => 0.0,
            (true, _) => row.approach / (row.contact_area / PI).sqrt(),
            (false, Some(radius)) => (row.approach / radius).sqrt(),
            (false, None) => 0.0,
        };
        self.width.above(index, width, WIDEST);
    }

    /// Compliance of a compact contact on layers over that on the half-space of the top layer.
    fn share(&self, row: &Row, contact: Counted) -> f64 {
        if self.kernel.is_half_space() || !contact.is_compact() {
            return 1.0;
        }
        let q = wave_of(row, contact);
        0.5 * q * self.kernel.symbol(q, 0.0)
    }

    pub(super) fn findings(&self) -> Vec<Finding> {
        let large = |worst: &Worst, what: fn(f64) -> String| {
            worst.warning(LARGE_STRAIN, |worst| {
                large(&format!("{}{}", what(worst.value), worst.place()), worst.limit)
            })
        };
        let worst = match self.width.excess >= self.pressure.excess {
            true if self.radius.is_none() => large(&self.width, deep),
            true => large(&self.width, wide),
            false => large(&self.pressure, hard),
        };
        let too_deep = (self.width.value > 1.0).then(|| too_deep(self.width.value).at(self.width.rows));
        worst.into_iter().chain(too_deep).collect()
    }
}

/// Wave number of a compact contact \[rad/m\]: one over its radius.
fn wave_of(row: &Row, contact: Counted) -> f64 {
    match contact.line {
        true => 2.0 / row.contact_area,
        false => (PI / row.contact_area).sqrt(),
    }
}

/// "The contact radius is 0.4 of the radius of the body".
fn wide(value: f64) -> String {
    format!("The contact radius is {} of the radius of the body", digits(value))
}

/// "The approach is 0.4 of the radius of the contact", of a cone and other bodies without a radius.
fn deep(value: f64) -> String {
    format!("The approach is {} of the radius of the contact", digits(value))
}

fn hard(value: f64) -> String {
    format!("The contact pressure is {} of the contact modulus", digits(value))
}

fn large(what: &str, limit: f64) -> String {
    format!(
        "{what}, more than {limit}: the strains are no longer small, and linear theory is only an estimate. Check the \
         units of load, modulus and radius. If they are right, expect errors of this order."
    )
}

fn too_deep(value: f64) -> Finding {
    let text = format!(
        "The body is pressed in deeper than the contact is wide (approach over contact radius: {}). Check the units of load or \
         approach, modulus and radius.",
        digits(value)
    );
    Finding::warning(UNLIKELY_UNIT, value, 1.0, text)
}

/// The findings for contact radius over radius and pressure over modulus.
pub(super) fn expected(width: f64, pressure: f64) -> Vec<Finding> {
    let large = |what: String, value: f64, limit: f64| {
        Finding::warning(LARGE_STRAIN, value, limit, large(&format!("Expected: {what}"), limit))
    };
    let deep = (width > 1.0).then(|| too_deep(width));
    let worst = if width > WIDEST && width / WIDEST >= pressure / HARDEST {
        Some(large(wide(width), width, WIDEST))
    } else {
        (pressure > HARDEST).then(|| large(hard(pressure), pressure, HARDEST))
    };
    deep.into_iter().chain(worst).collect()
}

/// ∫ C(t - s) dp(s) of one creep function, p constant in each step.
struct Branches {
    creep: Creep,
    clock: Option<ReducedTime>,
    strains: Vec<f64>,
    flow: f64,
}

impl Branches {
    fn new(creep: &Creep, clock: Option<&ReducedTime>) -> Self {
        Branches {
            strains: vec![0.0; creep.terms.len()],
            creep: creep.clone(),
            clock: clock.cloned(),
            flow: 0.0,
        }
    }

    fn strain(&mut self, [start, end]: [f64; 2], pressure: f64) -> f64 {
        let length = self.clock.as_ref().map_or(end - start, |clock| clock.elapsed(start, end));
        for (strain, term) in self.strains.iter_mut().zip(&self.creep.terms) {
            let gained = -libm::expm1(-length / term.retardation_time);
            *strain += gained * (term.compliance * pressure - *strain);
        }
        self.flow += self.creep.fluidity * length * pressure;
        self.creep.instantaneous * pressure + self.strains.iter().sum::<f64>() + self.flow
    }
}

/// Layers of that thickness on a rigid base, pressed together by `approach` \[m\].
pub(super) fn compressed(approach: f64, depth: f64) -> Option<Finding> {
    (approach > SQUEEZED * depth).then(|| {
        let text = format!(
            "The bodies are pressed together by {}, {} of the thickness of the layers on their rigid base: the strains are no \
             longer small, and linear theory is an estimate only. Check the units of load, thickness and moduli.",
            si(approach, "m"),
            digits(approach / depth)
        );
        Finding::warning(LARGE_STRAIN, approach / depth, SQUEEZED, text)
    })
}
