//! A fluid that acts on the surfaces: films, held access, slow squeezing, what it acts on.

use super::words::{digits, rows, si};
use super::worst::{Worst, extend};
use super::{FLUID_ACTS_ON_DOMAIN, FLUID_APPROACH_HELD, FLUID_CHATTER, FLUID_LIFTS, Finding, SQUEEZE_SLOW};
use crate::grid::Boundary;
use crate::load::Control;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::{Row, Step};

/// Share of the drop of the fluid's pressure that its squeezing out may take.
const SQUEEZE_SHARE: f64 = 0.1;

/// What is known before the run.
pub(super) fn before(simulation: &Simulation) -> Vec<Finding> {
    if simulation.traction.as_ref().is_none_or(|law| law.as_fluid().is_none()) {
        return vec![];
    }
    let Simulation { grid, boundary, loading, .. } = simulation;
    let is_held = loading.stages.iter().any(|stage| stage.control == Control::Approach);
    let mut found = vec![];
    if *boundary == Boundary::Free {
        let text = format!(
            "On a free domain the fluid acts on all of its cells, {}, and nowhere beyond: its force grows with the domain. Make the domain as \
             large as the part that the fluid wets.",
            si(grid.area(), grid.units("m2"))
        );
        found.push(Finding::warning(FLUID_ACTS_ON_DOMAIN, grid.area(), f64::NAN, text).as_note());
    } else if is_held && simulation.kernel.uniform().is_none() {
        let text = "On a periodic domain the approach fixes the mean gap: the fluid moves gap from one place to another, but cannot open \
                    the contact as a whole. Prescribe the load to see it open."
            .to_owned();
        found.push(Finding::warning(FLUID_APPROACH_HELD, f64::NAN, f64::NAN, text));
    }
    found
}

/// What the rows say.
#[derive(Clone, Debug, Default)]
pub(super) struct Wet {
    films: Option<[usize; 2]>,
    held: Worst,
    /// Spread of the leak in the worst of these rows.
    spread: f64,
    squeezed: Worst,
    /// Of the row before \[m\].
    mean_gap: Option<f64>,
}

impl Wet {
    pub(super) fn see(&mut self, step: &Step<'_>, row: &Row) {
        let simulation = step.simulation();
        let Some(law) = simulation.traction.as_ref().and_then(|law| law.as_fluid()) else { return };
        let of = |quantity| step.of_process(quantity).unwrap_or(0.0);
        let index = step.index();
        if of(Quantity::Film) == 1.0 && row.load > 0.0 {
            extend(&mut self.films, index);
        }
        let held = of(Quantity::LatchedCells);
        if self.held.above(index, held, 0.5) && self.held.value == held {
            self.spread = self.spread.max(of(Quantity::LeakSpread));
        }
        // Pressure that drives the fluid out of the closing gap of parallel plates, against that of the fluid.
        let before = self.mean_gap.replace(row.mean_gap);
        let length = simulation.grid.size().into_iter().fold(0.0, f64::max);
        if let (Some(before), Some(instant)) = (before, step.instant().filter(|instant| instant.dt > 0.0)) {
            let rate = (row.mean_gap - before) / instant.dt;
            let squeeze = 12.0 * law.viscosity * rate.abs() * (length / row.mean_gap).powi(2) / row.mean_gap;
            let pressure = of(Quantity::InletPressure) - law.outlet;
            if squeeze.is_finite() && of(Quantity::Connected) == 1.0 {
                self.squeezed.above(index, squeeze, SQUEEZE_SHARE * pressure);
            }
        }
    }

    pub(super) fn findings(&self) -> Vec<Finding> {
        let films = self.films.map(|at| {
            let text = format!(
                "In {} the fluid carries all of the load in a film without contact: the seal is lifted. Raise the load, or lower the \
                 pressure.",
                rows(at)
            );
            Finding::warning(FLUID_LIFTS, 1.0, 0.0, text).at(at)
        });
        let chatter = self.held.warning(FLUID_CHATTER, |worst| {
            format!(
                "In the solver's loop the access of {} cells to the fluid changed again and again{}: it has no steady state, or several. They \
                 were held. {}A finer grid may help.",
                digits(worst.value),
                worst.place(),
                if self.spread > 0.0 {
                    format!("The conductances of the last passes differ by {} of the largest. ", digits(self.spread))
                } else {
                    String::new()
                }
            )
        });
        let squeezed = self.squeezed.warning(SQUEEZE_SLOW, |worst| {
            format!(
                "The gap changes so fast that moving the fluid takes a pressure of about {}{}, more than {SQUEEZE_SHARE} of the drop from \
                 inlet to outlet. The flow is taken as steady: the fluid would delay the motion. Take slower loads, or a fluid of less viscosity.",
                si(worst.value, "Pa"),
                worst.place(),
            )
        });
        [films, chatter, squeezed].into_iter().flatten().collect()
    }

    /// Takes over a finding of an earlier session.
    pub(super) fn resume(&mut self, finding: &Finding) {
        let (value, limit) = (finding.value.unwrap_or(0.0), finding.limit.unwrap_or(1.0));
        let worst = Worst { value, limit, excess: value / limit, rows: finding.rows };
        match finding.code.as_ref() {
            FLUID_LIFTS => self.films = finding.rows,
            FLUID_CHATTER => self.held = worst,
            SQUEEZE_SLOW => self.squeezed = worst,
            _ => {}
        }
    }
}
