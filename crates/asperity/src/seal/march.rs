//! The pressure of the fluid across a seal: a march of the flux potential S. In a cell of width dx with contact pressure p0
//!
//! ```text
//! S(p0 - P_out of the cell) = S(p0 - P_in of the cell) + F dx
//! ```
//!
//! is exact, and no step is too long where the seal is choked. F is found by bisection on the pressure at the outlet.

use super::{Conductance, Profile};
use crate::error::{Error, Result};

/// Cells across the seal.
pub const CELLS: usize = 400;
/// Halvings of the logarithm of the flow.
const HALVINGS: usize = 70;

/// How the seal is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SealState {
    /// Nothing flows.
    Tight,
    /// The fluid flows.
    Leaks,
    /// The inlet pressure is not below the contact pressure anywhere: the fluid lifts the seal.
    Lifted,
    /// The seal is pressed less than all pressures of a sweep that is tight: not known.
    Unknown,
}

/// The flow across a seal at an inlet and an outlet pressure.
#[derive(Clone, Debug, PartialEq)]
pub struct SealFlow {
    /// How the seal is.
    pub state: SealState,
    /// F \[Pa m^2\], so that F/(12 mu) is the leak per length \[m^2/s\]; infinite where the seal is lifted, NaN where it is not known.
    pub flow: f64,
    /// F with the contact of the dry seal, which the fluid does not open.
    pub one_way: f64,
    /// Pressure of the fluid \[Pa\] at the ends of the cells, [`CELLS`] + 1 numbers.
    pub pressure: Vec<f64>,
    /// Where the pressure falls the most, of a seal that leaks.
    pub choke: Option<Choke>,
    /// Least and largest p0 - P \[Pa\] in the contact.
    pub pressed: [f64; 2],
}

/// Where the pressure of the fluid falls the most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choke {
    /// Place across the seal \[m\] from the inlet.
    pub x: f64,
    /// p0 - P there \[Pa\].
    pub pressed: f64,
}

/// The flow between two pressures \[Pa\], inlet and outlet, both counted as the contact pressure is.
///
/// # Errors
/// [`Error::Invalid`]: an inlet pressure that is not above the outlet pressure, or one that the profile has no table for.
pub fn flow(sigma: &Conductance, profile: &Profile, [inlet, outlet]: [f64; 2]) -> Result<SealFlow> {
    if !(inlet > outlet && outlet.is_finite() && inlet.is_finite()) {
        let expected = format!("a pressure above that of the outlet, {outlet} Pa");
        return Err(Error::invalid("the pressure at the inlet", inlet, expected).of("inlet"));
    }
    profile.validate()?;
    let Some(p0) = profile.pressures(CELLS, inlet) else {
        let [from, to] = profile.inlets().unwrap_or_default();
        let expected = format!("a pressure from {from} Pa to {to} Pa, as the profile has");
        return Err(Error::invalid("the pressure at the inlet", inlet, expected).of("inlet"));
    };
    let dx = profile.width() / CELLS as f64;
    let largest =
        p0.iter().copied().fold(f64::NEG_INFINITY, f64::max).max(profile.largest(inlet).unwrap_or(0.0));
    let ended = |state, flow, pressure, pressed| SealFlow {
        state,
        flow,
        one_way: one_way(sigma, &p0, dx, inlet - outlet),
        pressure,
        choke: None,
        pressed,
    };
    // The fluid moves the edges of the contact to where it is pressed.
    let Some(start) = p0.iter().position(|p0| *p0 > inlet) else {
        return Ok(ended(SealState::Lifted, f64::INFINITY, vec![inlet; CELLS + 1], [0.0; 2]));
    };
    let end = p0.iter().rposition(|p0| *p0 > outlet).map_or(CELLS, |last| last + 1);
    let first = sigma.ends()[0];
    if let Some(tight) = sigma.sealing_pressure() {
        if largest - inlet >= tight {
            let closed = p0.iter().position(|p0| p0 - inlet >= tight).unwrap_or(CELLS / 2);
            let pressure = (0..=CELLS).map(|n| if n <= closed { inlet } else { outlet }).collect();
            return Ok(ended(SealState::Tight, 0.0, pressure, [tight, largest - outlet]));
        }
        if sigma.last_leaking().is_none() {
            let pressed = [largest - inlet, first];
            return Ok(ended(SealState::Unknown, f64::NAN, vec![f64::NAN; CELLS + 1], pressed));
        }
    }
    let march = |flow: f64| -> Option<Vec<f64>> {
        let mut pressure = vec![inlet; start + 1];
        for p0 in &p0[start..end] {
            let here = pressure[pressure.len() - 1];
            pressure.push(p0 - sigma.pressure(sigma.potential(p0 - here) + flow * dx)?);
            if pressure[pressure.len() - 1] < outlet - 10.0 * (inlet - outlet) {
                return None;
            }
        }
        pressure.resize(CELLS + 1, pressure[pressure.len() - 1]);
        Some(pressure)
    };
    let is_too_much = |flow: f64| march(flow).is_none_or(|pressure| pressure[CELLS] < outlet);
    // A bracket of the flow, by factors, then halved in its logarithm.
    let mut high = sigma.at(0.0).max(sigma.at(first)) * (inlet - outlet) / dx;
    while !is_too_much(high) {
        high *= 1e3;
    }
    let mut low = high;
    while is_too_much(low) && low > f64::MIN_POSITIVE {
        (high, low) = (low, 1e-3 * low);
    }
    for _ in 0..HALVINGS {
        let middle = (low * high).sqrt();
        if is_too_much(middle) { high = middle } else { low = middle }
    }
    let pressure = march(low).unwrap_or_else(|| vec![inlet; CELLS + 1]);
    let steepest = (start..end).max_by(|a, b| {
        let drop = |n: usize| pressure[n] - pressure[n + 1];
        drop(*a).total_cmp(&drop(*b))
    });
    let pressed = |n: usize| p0[n] - 0.5 * (pressure[n] + pressure[n + 1]);
    let choke = steepest.map(|n| Choke { x: (n as f64 + 0.5) * dx, pressed: pressed(n) });
    let all = (start..end).map(pressed);
    let ends = all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
    Ok(SealFlow { choke, ..ended(SealState::Leaks, low, pressure, ends) })
}

/// F where the fluid does not open the contact: the drop over the sum of the resistances dx/sigma(p0).
fn one_way(sigma: &Conductance, p0: &[f64], dx: f64, drop: f64) -> f64 {
    match sigma.last_leaking() {
        None => {
            if p0.iter().any(|p0| *p0 >= sigma.ends()[0]) {
                0.0
            } else {
                f64::NAN
            }
        }
        Some(_) => drop / p0.iter().map(|p0| dx / sigma.at(*p0)).sum::<f64>(),
    }
}
