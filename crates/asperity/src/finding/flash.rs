//! Flash temperature: materials that are taken colder than they become, steady temperatures in a motion that is not.

use super::words::{digits, rows, si};
use super::worst::extend;
use super::{FLASH_STEADY, FLASH_WARM, Finding};
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::Step;

/// Rise of the mean temperature of the contact that changes the times of a rubber by up to a decade \[K\].
const WARM: f64 = 20.0;

/// The largest mean temperature of the contact where the material does not see it.
#[derive(Clone, Debug, Default)]
pub(super) struct Warm {
    most: f64,
    at: Option<[usize; 2]>,
}

impl Warm {
    pub(super) fn see(&mut self, step: &Step<'_>) {
        let simulation = step.simulation();
        let is_cold = simulation.flash.as_ref().is_some_and(|flash| flash.feedback.is_none());
        if !is_cold || !simulation.parts().any(|creep| !creep.terms.is_empty()) {
            return;
        }
        let mean = step.quantity(Quantity::FlashTemperatureMean).map_or(0.0, |values| values[0]);
        if mean > WARM {
            extend(&mut self.at, step.index());
            self.most = self.most.max(mean);
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let at = self.at?;
        let text = format!(
            "The contact becomes {} K warmer in the mean ({}), but the material is taken at the temperature of the run: its friction is that of \
             cold material. For steady states give it a shift and flash.feedback = \"mean\"; otherwise lower the velocity or see what the warmer \
             material does by [temperature].",
            digits(self.most),
            rows(at)
        );
        Some(Finding::warning(FLASH_WARM, self.most, WARM, text).at(at))
    }

    /// Takes over the finding of an earlier session.
    pub(super) fn resume(&mut self, finding: &Finding) {
        (self.most, self.at) = (finding.value.unwrap_or(0.0), finding.rows);
    }
}

/// What is known before the run: how long a slider takes to become as warm as it is taken.
pub(super) fn before(simulation: &Simulation) -> Option<Finding> {
    let (flash, motion) = (simulation.flash.as_ref()?, simulation.motion.as_ref()?);
    let way = motion.path.travel(0.0, simulation.times.end());
    let side = simulation.grid.longest_side();
    let chi = flash.bodies.map(|body| body.diffusivity);
    let time = side * side / chi[0].min(chi[1]);
    (way < side || simulation.times.end() < time).then(|| {
        let text = format!(
            "The flash temperatures are those of a steady state with the velocity of each row, but the bodies slide {} in {}, and heat spreads over \
             the domain in up to {}: until then they are upper bounds.",
            si(way, "m"),
            si(simulation.times.end(), "s"),
            si(time, "s")
        );
        Finding::warning(FLASH_STEADY, simulation.times.end(), time, text).as_note()
    })
}
