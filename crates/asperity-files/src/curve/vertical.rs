//! Vertical shifts of measured sweeps: their moduli at the reference temperature, b_T E(t, T).

use asperity::material::{Shift, VerticalShift, estimate_vertical};

use schemars::JsonSchema;
use serde::Deserialize;

use super::error::{Remedy, Result, fault};
use super::isotherms::{abscissa, at_isotherm, held, shifted_by, snap};
use super::{Curves, Kind};

/// A vertical shift by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum VerticalWord {
    /// Moduli grow as the absolute temperature: b_T = reference/T.
    Density,
    /// One factor for each sweep of a file, estimated with the shift.
    Free,
}

/// How moduli depend on temperature, besides their times.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum VerticalRequest {
    /// They do not.
    #[default]
    None,
    /// As density times absolute temperature, about the reference of the shift.
    Density {
        /// Relative growth of the volume per kelvin \[1/K\]; 0 for a constant density.
        expansion: f64,
    },
    /// By one factor per sweep, estimated from the sweeps.
    Free,
    /// As given.
    Given(VerticalShift),
}

impl VerticalRequest {
    /// The vertical shift, where it does not follow from sweeps; `reference` is that of the shift \[K\].
    ///
    /// # Errors
    /// A sentence: there is no reference temperature, or a constant is wrong.
    pub fn known(&self, reference: Option<f64>) -> Result<Option<VerticalShift>, String> {
        let vertical = match (self, reference) {
            (VerticalRequest::None | VerticalRequest::Free, _) => return Ok(None),
            (VerticalRequest::Given(vertical), _) => vertical.clone(),
            (VerticalRequest::Density { expansion }, Some(reference)) => {
                VerticalShift::Density { reference, expansion: *expansion }
            }
            (VerticalRequest::Density { .. }, None) => {
                return Err(
                    "vertical shifts need the reference temperature of a shift, at which a_T is 1".to_owned()
                );
            }
        };
        vertical.validate().map_err(|error| error.to_string())?;
        Ok(Some(vertical))
    }
}

/// Curves whose values are those at the reference temperature.
pub(super) struct Corrected {
    pub curves: Curves,
    pub vertical: VerticalShift,
    /// Temperature \[K\], b_T and its relative standard deviation of each sweep.
    pub factors: Vec<[f64; 3]>,
}

/// The factor of measured values that belongs to the factor b_T of moduli.
pub(super) fn of_values(kind: Kind, factor: f64) -> f64 {
    match kind {
        Kind::Creep => 1.0 / factor,
        Kind::Relaxation | Kind::Dma => factor,
    }
}

/// The curves corrected by a vertical shift that does not depend on them; `None` if there is no such shift.
pub(super) fn corrected(
    curves: &Curves,
    request: &VerticalRequest,
    reference: Option<f64>,
) -> Result<Option<Corrected>> {
    let known = request.known(reference).map_err(|message| fault(message).remedy(Remedy::Shift))?;
    known.map(|vertical| scaled(curves, vertical, &[])).transpose()
}

/// The curves corrected by one factor for each sweep, estimated so that neighbouring sweeps continue each other after the shift.
/// `factors` are those of the shift with their standard deviations \[decades\].
pub(super) fn free(curves: &Curves, shift: Option<&Shift>, factors: &[[f64; 3]]) -> Result<Corrected> {
    let Some(shift) = shift.filter(|_| curves.sweeps.len() > 1) else {
        return Err(fault("vertical shifts that are free need sweeps at two temperatures or more"));
    };
    held(curves, "a factor for each sweep")?;
    let isotherms = shifted_by(curves, shift);
    let decades: Vec<f64> = factors.iter().map(|[.., deviation]| *deviation).collect();
    let found = estimate_vertical(&isotherms, abscissa(curves.kind), shift, &decades)
        .map_err(|error| at_isotherm(curves, &error))?;
    let vertical = match (curves.kind, found.vertical) {
        // The factors of compliances are one over those of moduli.
        (Kind::Creep, VerticalShift::Table { points }) => {
            VerticalShift::Table { points: points.iter().map(|(kelvin, ln)| (*kelvin, -ln)).collect() }
        }
        (_, vertical) => vertical,
    };
    scaled(curves, vertical, &found.uncertainty)
}

/// Values times the factors of their temperatures.
fn scaled(curves: &Curves, vertical: VerticalShift, uncertainty: &[f64]) -> Result<Corrected> {
    let (mut curves, mut factors) = (curves.clone(), Vec::new());
    let (kind, ramp) = (curves.kind, curves.is_ramp());
    for (n, sweep) in curves.sweeps.iter_mut().enumerate() {
        let Some(kelvin) = sweep.temperature else { continue };
        let mut near = kelvin;
        if let VerticalShift::Table { points } = &vertical {
            snap(&mut near, points, ramp);
        }
        let factor = vertical.factor(near).map_err(|error| fault(error.to_string()))?;
        factors.push([kelvin, factor, uncertainty.get(n).copied().unwrap_or(0.0)]);
        let factor = of_values(kind, factor);
        sweep.curves.iter_mut().flatten().for_each(|value| *value *= factor);
    }
    Ok(Corrected { curves, vertical, factors })
}
