//! Wear: steps in which too much wears, tracks that do not go with the contact.

use super::words::{digits, si};
use super::worst::{Watch, Worst};
use super::{Finding, LAYER_WORN, UNLIKELY_UNIT, WEAR_STEPS, WEAR_TRACK};
use crate::load::{Control, Course, Stage};
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::step::{Row, Step};
use crate::wear::Sliding;

/// Share of the worn volume that may be in the wrong place, or wrong.
const UNCERTAIN: f64 = 0.05;
/// Share of the top layer that may be worn off: its thickness stays as it is in the run.
const WORN_LAYER: f64 = 0.1;
/// Rows count until so many times their volume is worn.
const FORGOTTEN: f64 = 4.0;

/// A mean depth of this share of the domain suggests a wrong unit of the coefficient.
const DEEP: f64 = 0.1;

/// A coefficient that takes off more than there is, under the largest prescribed load.
pub(super) fn unlikely(simulation: &Simulation) -> Option<Finding> {
    let law = simulation.wear.as_ref()?;
    let grid = &simulation.grid;
    let end = simulation.times.end();
    let [Stage { control, course: Course::Given(history), .. }] = &simulation.loading.stages[..] else {
        return None;
    };
    let pressure = match control {
        Control::Load => history.range(end)[1] / grid.area(),
        Control::Pressure => history.range(end)[1],
        Control::Approach => return None,
    };
    let depth = law.total() * law.distance(simulation, 0.0, end) * pressure;
    let side = grid.longest_side();
    (depth > DEEP * side).then(|| {
        let text = format!(
            "The wear coefficient, {} m²/N, takes {} off the domain in the mean, which is {} long. Check its unit: 1 mm³/(N m) is 1e-9 m²/N.",
            digits(law.total()),
            si(depth, "m"),
            si(side, "m")
        );
        Finding::warning(UNLIKELY_UNIT, depth, DEEP * side, text)
    })
}

/// What is known before the run: a counterbody that wears in place, although the surfaces slide further than the domain is long.
pub(super) fn before(simulation: &Simulation) -> Option<Finding> {
    let law = simulation.wear.as_ref()?;
    let side = simulation.grid.longest_side();
    let distance = law.distance(simulation, 0.0, simulation.times.end());
    let stays = law.sliding(simulation) == Sliding::Path && law.coefficients[1] > 0.0 && distance > side;
    stays.then(|| {
        let text = format!(
            "The counterbody wears in place, although the surfaces slide {} and the domain is {} long: its wear stays under the contact, as if \
             both moved to and fro. Leave its coefficient out where its track is long, or use [motion], which keeps the track.",
            si(distance, "m"),
            si(side, "m")
        );
        Finding::warning(WEAR_TRACK, distance, side, text)
    })
}

/// The estimated error of the worn depths.
#[derive(Default)]
pub(super) struct Steps {
    worst: Worst,
    /// Worn volume at the last of the rows.
    volume: f64,
    /// Largest worn depth \[m\].
    deepest: f64,
}

impl Watch for Steps {
    fn see(&mut self, step: &Step<'_>, _: &Row) {
        let of = |quantity| step.quantity(quantity).map_or(0.0, |values| values[0]);
        let (error, volume) = (of(Quantity::WearError), of(Quantity::WearVolume));
        self.deepest = self.deepest.max(of(Quantity::WearDepthMax));
        if volume > FORGOTTEN * self.volume {
            self.worst = Worst::default();
        }
        if self.worst.above(step.index(), error, UNCERTAIN) {
            self.volume = volume;
        }
    }

    fn findings(&self, simulation: &Simulation) -> Vec<Finding> {
        let cure = match simulation.wear.as_ref().map(|law| law.sliding(simulation)) {
            Some(Sliding::Slip) => "Take fewer cycles_per_step, or more steps in a cycle",
            Some(Sliding::Motion) => "Take fewer cells_per_step",
            _ => "Take more time steps, or spacing = \"adaptive\"",
        };
        let steps = self.worst.warning(WEAR_STEPS, |worst| {
            format!(
                "Much wears in a step{}: the pressure changes over the steps, so {} % of the worn volume may be in the wrong place, or wrong \
                 where the load changes. {cure}.",
                worst.place(),
                digits(100.0 * worst.value)
            )
        });
        steps.into_iter().chain(worn_layer(simulation, self.deepest)).collect()
    }

    fn resume(&mut self, finding: &Finding) {
        if self.worst.resume(WEAR_STEPS, finding) {
            self.volume = f64::INFINITY;
        }
    }
}

/// A top layer of which much is worn off.
fn worn_layer(simulation: &Simulation, deepest: f64) -> Option<Finding> {
    let layer = simulation.kernel.top_layer().filter(|layer| deepest > WORN_LAYER * layer)?;
    let text = format!(
        "Up to {} of a layer of {} is worn off, but the layer stays as thick in the run: from a tenth on its response is off. Take the part \
         of the run before, or give the layer its mean thickness.",
        si(deepest, "m"),
        si(layer, "m")
    );
    Some(Finding::warning(LAYER_WORN, deepest, WORN_LAYER * layer, text))
}
