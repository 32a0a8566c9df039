//! Flow of a gas: Picard's iteration on the factor of the rarefaction.
//!
//! In the potential G(P) = integral of P Q(P h_c) dP, taken with the critical gap h_c, the flow is
//!
//! ```text
//! div(k grad G) = 0,   k = h^3 Q(D(P, h))/Q(D(P, h_c))
//! leak = W (G_in - G_out)/(12 mu R_s T L) T      T: transmissivity of the mobility k
//! ```
//!
//! The ratio of the two factors depends only weakly on the pressure: it is 1 at the constriction, 1 everywhere in the continuum,
//! and h_c/h (up to a logarithm) in free molecular flow. A few passes are therefore sufficient. Each is a linear problem with the
//! k of the previous pressure; for parallel plates the result is exact. All passes use the factorisation of the first one.

use ndarray::Array2;
use rayon::prelude::*;

use super::flow::{Channel, mobility, still};
use super::gas::{Gas, Rarefaction, STANDARD_TEMPERATURE};
use super::opening::Opening;
use super::passages::Passages;
use super::solve::{FlowOptions, Previous};
use crate::error::{Error, NotConverged, Result, non_negative, positive};

/// Largest number of passes; usually five are enough.
const PASSES: usize = 50;
/// The leak has converged if a pass changes it by less than this fraction.
const SETTLED: f64 = 1e-9;
/// The factor of the rarefaction is evaluated at no less than this fraction of the inlet pressure: the resistance below it is
/// negligible.
const LEAST_PRESSURE: f64 = 1e-5;

/// The flow of a gas through a gap.
#[derive(Clone, Debug)]
pub struct GasFlow {
    /// Leak \[kg/s\]; exactly 0 if the seal is tight.
    pub leak_rate: f64,
    /// Pressure \[Pa\], shape (nx, ny); NaN as in [`Flow::pressure`](super::Flow::pressure).
    pub pressure: Array2<f64>,
    /// Knudsen number at the critical constriction, at the mean of inlet and outlet pressure; NaN if the seal is tight.
    pub knudsen: f64,
    /// Number of passes.
    pub passes: usize,
}

/// A leak \[kg/s\] in the customary unit \[Pa m^3/s at 0 degC\]: m R_s 273.15 K. 1 mbar l/s is 0.1 Pa m^3/s.
pub fn standard(leak_rate: f64, gas: &Gas) -> f64 {
    leak_rate * gas.specific_energy() / gas.temperature * STANDARD_TEMPERATURE
}

/// Checks the pressures of inlet and outlet \[Pa\].
fn pressures(inlet: f64, outlet: f64) -> Result<()> {
    positive("pressure of the inlet", inlet, "Pa")?;
    non_negative("pressure of the outlet", outlet, "Pa")?;
    if inlet < outlet {
        let expected = format!(
            "not below that of the outlet, {outlet} Pa; exchange them for a flow in the other direction"
        );
        return Err(Error::invalid("pressure of the inlet", format!("{inlet} Pa"), expected));
    }
    Ok(())
}

/// Leak \[kg/s\] between parallel plates at a distance `gap` \[m\], of length and width `size` \[m\].
///
/// # Errors
/// [`Error::Invalid`] if the pressures \[Pa\] are not positive (the outlet may be 0), or rise.
pub fn plate(
    gas: &Gas,
    rarefaction: Rarefaction,
    gap: f64,
    [length, width]: [f64; 2],
    [inlet, outlet]: [f64; 2],
) -> Result<f64> {
    pressures(inlet, outlet)?;
    if gap <= 0.0 {
        return Ok(0.0);
    }
    let scale = gas.inverse_knudsen_scale() * gap;
    let potential = |p: f64| rarefaction.potential(scale * p) / (scale * scale);
    let drop = potential(inlet) - potential(outlet);
    Ok(gap.powi(3) * drop * width / (12.0 * gas.viscosity * gas.specific_energy() * length))
}

/// Solves the flow of a gas between the pressures `inlet` and `outlet` \[Pa, absolute\].
///
/// # Errors
/// [`Error::Invalid`] if the pressures are not positive (the outlet may be 0), or rise; [`Error::NotConverged`] as for a
/// [`liquid`](super::liquid).
pub fn gas_flow(
    opening: &Opening,
    passages: &Passages,
    gas: &Gas,
    rarefaction: Rarefaction,
    pressures: [f64; 2],
    options: &FlowOptions,
) -> Result<GasFlow> {
    gas_flow_after(opening, passages, gas, rarefaction, pressures, options, &mut Previous::default())
}

/// The same after a flow through a gap that differs little.
pub(crate) fn gas_flow_after(
    opening: &Opening,
    passages: &Passages,
    gas: &Gas,
    rarefaction: Rarefaction,
    [inlet, outlet]: [f64; 2],
    options: &FlowOptions,
    previous: &mut Previous,
) -> Result<GasFlow> {
    pressures(inlet, outlet)?;
    let at_rest = |pressure: &mut Array2<f64>| pressure.mapv_inplace(|p| outlet + (inlet - outlet) * p);
    let Some(constriction) = passages.constriction else {
        let mut pressure = still(opening, passages, None);
        at_rest(&mut pressure);
        return Ok(GasFlow { leak_rate: 0.0, pressure, knudsen: f64::NAN, passes: 0 });
    };
    let critical = constriction.gap;
    let scale = gas.inverse_knudsen_scale() * critical;
    let [top, bottom] = [inlet, outlet].map(|p| rarefaction.potential(scale * p));
    // Pressure of a potential between 1 at the inlet and 0 at the outlet.
    let pressure_of = |x: f64, near: f64| {
        let w = bottom + (top - bottom) * x.clamp(0.0, 1.0);
        rarefaction.inverse_potential(w, scale * near) / scale
    };
    let bare = mobility(opening, passages, critical);
    let least = LEAST_PRESSURE * inlet;
    let factor = |p: f64, h: f64| {
        let d = scale * p.max(least);
        rarefaction.factor(d * h / critical) / rarefaction.factor(d)
    };
    let mobility_at = |pressure: &[f64]| -> Vec<f64> {
        let cells = bare.par_iter().zip(&opening.gap).zip(pressure);
        cells.map(|((k, h), p)| if *k > 0.0 { k * factor(*p, *h) } else { 0.0 }).collect()
    };
    let mut pressure = vec![0.5 * (inlet + outlet); bare.len()];
    let mut channel = Channel::new(opening, &mobility_at(&pressure));
    let mut conductance = 0.0;
    for pass in 1..=PASSES {
        let (now, _) = channel.solve(previous, options)?;
        let x = &previous.x;
        pressure.par_iter_mut().zip(x).for_each(|(p, x)| *p = pressure_of(*x, *p));
        if (now - conductance).abs() <= SETTLED * now {
            let leak = plate(gas, rarefaction, critical, opening.size(), [inlet, outlet])?;
            let [length, width] = opening.size();
            let mut map = still(opening, passages, Some((&bare, x)));
            map.mapv_inplace(|x| if x.is_nan() { x } else { pressure_of(x, inlet) });
            return Ok(GasFlow {
                leak_rate: leak * now * length / width,
                pressure: map,
                knudsen: gas.knudsen(0.5 * (inlet + outlet), critical),
                passes: pass,
            });
        }
        conductance = now;
        channel = Channel::new(opening, &mobility_at(&pressure));
    }
    Err(NotConverged::of("the flow of the gas through the gap", PASSES, f64::NAN, SETTLED).into())
}
