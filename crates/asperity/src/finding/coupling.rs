//! Tangential loads: what pressure and tangential tractions of different bodies do to each other.

use super::words::digits;
use super::{Finding, NORMAL_COUPLING};
use crate::simulation::Simulation;

/// Smaller values of Dundurs' β are rounding errors.
const ROUNDING: f64 = 1e-6;
/// Share of the pressure that the neglected tractions may change, roughly μβ.
const LARGEST: f64 = 0.02;

/// What the pair of bodies says before the run.
pub(super) fn before(simulation: &Simulation) -> Option<Finding> {
    let law = simulation.tangential.as_ref()?;
    let beta = law.coupling.abs();
    if beta <= ROUNDING {
        return None;
    }
    let of_cells = law.coefficients.iter().flatten().copied();
    let effect = beta * of_cells.fold(law.coefficient, f64::max);
    let text = format!(
        "The bodies have different elastic constants (Dundurs' β = {}): tangential tractions then also move the surfaces normally, and pressures \
         along each other, which is neglected. Pressure, stick and slip are off by about {} % (μβ). Nothing is neglected for bodies of \
         like materials, or for incompressible ones.",
        digits(beta),
        digits(100.0 * effect),
    );
    let finding = Finding::warning(NORMAL_COUPLING, effect, LARGEST, text);
    Some(if effect > LARGEST { finding } else { finding.as_note() })
}
