//! Tangential loads: forces that friction will not hold, displacements that are hardly meant, what pressure and tangential tractions of
//! different bodies do to each other.

use super::words::{digits, si};
use super::{FORCE_BEYOND_FRICTION, Finding, NORMAL_COUPLING, UNLIKELY_UNIT};
use crate::simulation::Simulation;
use crate::tangential::{Tangential, TangentialControl};

/// Smaller values of Dundurs' β are rounding errors.
const ROUNDING: f64 = 1e-6;
/// Share of the pressure that the neglected tractions may change, roughly μβ.
const LARGEST: f64 = 0.02;

/// What is known before the run.
pub(super) fn before(simulation: &Simulation) -> Vec<Finding> {
    let Some(law) = &simulation.tangential else { return vec![] };
    let found = [coupling(law), sliding(law, simulation), displacement(law, simulation)];
    found.into_iter().flatten().collect()
}

fn sliding(law: &Tangential, simulation: &Simulation) -> Option<Finding> {
    let time = law.slides_at(simulation)?;
    let text = format!(
        "At t = {} the tangential force is more than the friction coefficient times the load: all of the contact slides, and the run ends \
         there. Lower the force, raise the load or the friction coefficient, or prescribe the displacement.",
        si(time, "s")
    );
    Some(Finding::warning(FORCE_BEYOND_FRICTION, time, simulation.times.end(), text))
}

fn displacement(law: &Tangential, simulation: &Simulation) -> Option<Finding> {
    let ends = law.histories.iter().flat_map(|history| history.range(simulation.times.end()));
    let (most, side) = (ends.fold(0.0f64, |most, end| most.max(end.abs())), simulation.grid.longest_side());
    (law.control == TangentialControl::Displacement && most > side).then(|| {
        let text = format!(
            "The tangential displacement, {}, is longer than the domain, {}: the surfaces stay where they are on the grid. Check its unit.",
            si(most, "m"),
            si(side, "m")
        );
        Finding::warning(UNLIKELY_UNIT, most, side, text)
    })
}

fn coupling(law: &Tangential) -> Option<Finding> {
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
