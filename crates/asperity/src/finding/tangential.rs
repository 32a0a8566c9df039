//! Tangential loads: forces that friction will not hold, displacements that are hardly meant, what pressure and tangential tractions of
//! different bodies do to each other, slip that the grid does not resolve.

use super::words::{digits, rows, si};
use super::worst::{Watch, extend};
use super::{FORCE_BEYOND_FRICTION, Finding, NORMAL_COUPLING, SLIP_UNRESOLVED, UNLIKELY_UNIT};
use crate::simulation::Simulation;
use crate::step::{PERIMETER_SHARE, Row, Step};
use crate::tangential::{Coupling, Tangential, TangentialControl};

/// Smaller values of Dundurs' β are rounding errors.
const ROUNDING: f64 = 1e-6;
/// Share of the pressure that the neglected tractions may change, roughly μβ.
const LARGEST: f64 = 0.02;

/// Cells across a ring that slips, at least, unless a larger share of the contact slips.
const RING: f64 = 1.5;
const LARGE_PART: f64 = 0.25;
/// Share of the largest force that friction holds below which the ring does not matter.
const SMALL_FORCE: f64 = 1e-3;

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
    let beta = law.beta.abs();
    if beta <= ROUNDING || law.coupling == Coupling::Full {
        return None;
    }
    let effect = beta * law.largest();
    let text = format!(
        "The bodies have different elastic constants (Dundurs' β = {}): tangential tractions then also move the surfaces normally, and pressures \
         along each other, which is neglected. Pressure, stick and slip are off by about {} % (μβ). friction.coupling = \"full\" computes it; \
         nothing is neglected for bodies of like materials, or for incompressible ones.",
        digits(beta),
        digits(100.0 * effect),
    );
    let finding = Finding::warning(NORMAL_COUPLING, effect, LARGEST, text);
    Some(if effect > LARGEST { finding } else { finding.as_note() })
}

/// The ring that slips at the edge of the contact, in the rows with large contacts.
#[derive(Default)]
pub(super) struct Ring {
    /// Area of the contact from which on rows of up to twice of it count \[m²\].
    area: f64,
    /// Its largest width \[cells\], and the largest share of the contact that slips.
    width: f64,
    share: f64,
    /// The rows with a force that matters.
    rows: Option<[usize; 2]>,
}

impl Watch for Ring {
    fn see(&mut self, step: &Step<'_>, row: &Row) {
        let simulation = step.simulation();
        let (Some(law), Some(slip)) = (&simulation.tangential, step.slip_row()) else { return };
        // Area of the cells at the edge.
        let edge = (row.contact_area - row.contact_area_corrected) / PERIMETER_SHARE;
        let [fx, fy] = slip.force;
        let pulls = f64::hypot(fx, fy) >= SMALL_FORCE * law.largest() * row.load;
        // Pressing alone may make surfaces slip.
        let spreads = law.is_coupled() && slip.slip_area > 0.0;
        if edge <= 0.0 || !(pulls || spreads) || row.contact_area < 0.5 * self.area {
            return;
        }
        if row.contact_area > 2.0 * self.area {
            *self = Ring { area: row.contact_area, ..Ring::default() };
        }
        extend(&mut self.rows, step.index());
        self.width = self.width.max(slip.slip_area / edge);
        self.share = self.share.max(slip.slip_area / row.contact_area);
    }

    fn findings(&self, _: &Simulation) -> Vec<Finding> {
        let Some(at) = self.rows.filter(|_| self.width < RING && self.share < LARGE_PART) else {
            return vec![];
        };
        let width = match self.width {
            0.0 => "No cell slips, although a ring at the edge of each contact does".to_string(),
            width => format!("The ring that slips is at most {} cells wide", digits(width)),
        };
        let text = format!(
            "{width} ({}): slip areas, work of friction and loops are too small or missing. Take smaller cells; the stiffness hardly changes.",
            rows(at)
        );
        vec![Finding::warning(SLIP_UNRESOLVED, self.width, RING, text).at(at)]
    }

    fn resume(&mut self, finding: &Finding) {
        if finding.code == SLIP_UNRESOLVED {
            (self.width, self.rows) = (finding.value.unwrap_or(0.0), finding.rows);
        }
    }
}
