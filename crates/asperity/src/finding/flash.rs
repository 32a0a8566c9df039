//! Flash temperature: materials that are taken colder than they become, several steady states, steady temperatures in a motion that is not
//! steady.

use super::plausible::exceeded;
use super::words::{digits, rows, si};
use super::worst::{Watch, Worst, extend};
use super::{FLASH_STATES, FLASH_STEADY, FLASH_WARM, Finding, UNLIKELY_UNIT};
use crate::flash::Partition;
use crate::numbers::bisect;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::sliding::Path;
use crate::step::{Row, Step};

/// Rise of the mean temperature of the contact that changes the times of a rubber by up to a decade \[K\].
const WARM: f64 = 20.0;

/// The largest mean temperature of the contact where the material does not see it.
#[derive(Default)]
pub(super) struct Warm(Worst);

impl Watch for Warm {
    fn see(&mut self, step: &Step<'_>, _: &Row) {
        let simulation = step.simulation();
        let is_cold = simulation.flash.as_ref().is_some_and(|flash| flash.feedback.is_none());
        if !is_cold || !simulation.parts().any(|creep| !creep.terms.is_empty()) {
            return;
        }
        let mean = step.quantity(Quantity::FlashTemperatureMean).map_or(0.0, |values| values[0]);
        self.0.above(step.index(), mean, WARM);
    }

    fn findings(&self, _: &Simulation) -> Vec<Finding> {
        let warm = self.0.warning(FLASH_WARM, |warm| {
            format!(
                "The contact becomes {} K warmer in the mean{}, but the material is taken at the temperature of the run: its friction is that of \
                 cold material. For steady states give it a shift and flash.feedback = \"mean\"; otherwise lower the velocity or see what the warmer \
                 material does by [temperature].",
                digits(warm.value),
                warm.place()
            )
        });
        warm.into_iter().collect()
    }

    fn resume(&mut self, finding: &Finding) {
        self.0.resume(FLASH_WARM, finding);
    }
}

/// Conductivities of solids, from aerogels to diamond \[W/(m K)\], and diffusivities \[m²/s\].
const CONDUCTIVITIES: [f64; 2] = [5e-3, 5e3];
const DIFFUSIVITIES: [f64; 2] = [1e-9, 5e-3];
/// Friction coefficients are seldom above 2.
const FRICTION: f64 = 5.0;
/// Metals melt, and polymers are gone long before, at such a rise \[K\].
const HOT: f64 = 1500.0;

/// Numbers that no material has.
pub(super) fn unlikely(simulation: &Simulation) -> Vec<Finding> {
    let Some(flash) = &simulation.flash else { return vec![] };
    let numbers = flash.bodies.iter().flat_map(|body| {
        [
            ("thermal conductivity", body.conductivity, "W/(m K)", CONDUCTIVITIES),
            ("thermal diffusivity", body.diffusivity, "m²/s", DIFFUSIVITIES),
        ]
    });
    let friction = ("friction coefficient of [flash]", flash.friction, "", [0.0, FRICTION]);
    let unlikely = |(what, value, unit, range): (&str, f64, &str, [f64; 2])| {
        let ([least, most], limit) = (range, exceeded(range, value)?);
        let text =
            format!("The {what} is {value:e} {unit}; materials have {least:e} to {most:e}. Check its unit.");
        Some(Finding::warning(UNLIKELY_UNIT, value, limit, text))
    };
    numbers.chain([friction]).filter_map(unlikely).collect()
}

/// Surfaces of both bodies that are not flat: no frame has a source that stands still.
pub(super) fn both_uneven(simulation: &Simulation) -> Option<Finding> {
    let motion = simulation.flash.as_ref().and(simulation.motion.as_ref())?;
    let text = "Parts of the surface stay with the track (moves = false), but [flash] lets all of the heat move with the slider: places of the \
                track that stay in contact become warmer than the temperatures say.";
    let both = motion.gap.moves_and_stands() == [true; 2];
    both.then(|| Finding::warning(FLASH_STEADY, f64::NAN, f64::NAN, text))
}

/// Surfaces hotter than any material, steady states of which there are several, and rows whose temperatures are not steady.
#[derive(Default)]
pub(super) struct Rows {
    hot: Worst,
    /// Rise of a row and another one with which the same velocity would be steady \[K\], and such rows.
    several: Option<([f64; 2], [usize; 2])>,
    /// Rows before which the bodies have not slid long enough; rows that remember more heat, or a turn; and the contact length \[m\] of
    /// the last one of them.
    early: Option<[usize; 2]>,
    uneven: Option<[usize; 2]>,
    length: f64,
    /// Time \[s\] and heat \[W\] of each row.
    powers: Vec<[f64; 2]>,
}

/// Heat of earlier rows over that of a row, from which on its temperatures are higher than steady ones.
const EVEN: f64 = 1.25;
/// The track remembers so many contact lengths, and the slider so many times that heat takes over the contact.
const LENGTHS: f64 = 4.0;
const TIMES: f64 = 10.0;

impl Watch for Rows {
    fn see(&mut self, step: &Step<'_>, row: &Row) {
        let (simulation, Some(found)) = (step.simulation(), step.flash()) else { return };
        let Some(flash) = &simulation.flash else { return };
        self.hot.above(step.index(), found.max, HOT);
        if found.other.is_finite() {
            let mut at = self.several.map(|several| several.1);
            extend(&mut at, step.index());
            self.several = at.map(|at| ([found.mean, found.other], at));
        }
        let (Some(motion), true) = (&simulation.motion, found.power > 0.0 || row.contact_area > 0.0) else {
            return;
        };
        let (path, time) = (&motion.path, row.coordinate.value());
        self.powers.push([time, found.power]);
        let moved = path.travel(0.0, time);
        if moved == 0.0 {
            return;
        }
        let width = if simulation.grid.is_line() { row.contact_area } else { row.contact_area.sqrt() };
        let speed = path.velocity(time).abs();
        let still = flash.still();
        let only_other = flash.partition == [Partition::Track, Partition::Slider][still];
        let (way, duration, [lengths, times]) = match flash.heated_for {
            Some(heated) => (speed * heated, heated, [1.0; 2]),
            None if only_other => (width, 0.0, [LENGTHS, TIMES]),
            None => (width, width * width / flash.bodies[still].diffusivity, [LENGTHS, TIMES]),
        };
        let remembered = (lengths * way).min(moved);
        let begin = start_of(path, time, remembered);
        let since = begin.min(time - times * duration);
        let remembers = self.powers.iter().rev().take_while(|row| row[0] >= since);
        let hottest = remembers.fold(0.0, |most: f64, row| most.max(row[1]));
        let rows = if hottest > EVEN * found.power || !goes_one_way(path, [begin, time], remembered) {
            &mut self.uneven
        } else if moved < way || time - path.start() < duration {
            &mut self.early
        } else {
            return;
        };
        extend(rows, step.index());
        self.length = way;
    }

    fn findings(&self, _: &Simulation) -> Vec<Finding> {
        let hot = self.hot.warning(UNLIKELY_UNIT, |hot| {
            format!(
                "Friction makes the surfaces {} K warmer{}; no material keeps its properties up to there. Check the units of [flash], of load and \
                 velocity, and heated_for.",
                digits(hot.value),
                hot.place()
            )
        });
        let several = self.several.map(|([rise, other], at)| {
            let text = format!(
                "With the feedback of the flash temperature there is more than one steady state ({}): the contact is {} K warmer in the mean, and \
                 may also settle near {} K. Which one it takes depends on how the velocity was reached; here each row starts from the row before, \
                 from the smallest velocity on.",
                rows(at),
                digits(rise),
                digits(other)
            );
            Finding::warning(FLASH_STATES, rise, other, text).at(at)
        });
        let words = |at: [usize; 2], why: &str| {
            let length = si(self.length, "m");
            format!(
                "The flash temperatures are those of a steady state with the velocity of each row. In {} {why} ({length}).",
                rows(at)
            )
        };
        let early = self.early.map(|at| {
            let why = "they are upper bounds: the bodies have not slid for as long as the temperatures need, over a few contact lengths and for \
                       the width of the contact squared over the diffusivity of the body in which the heat stands still";
            Finding::warning(FLASH_STEADY, self.length, f64::NAN, words(at, why)).at(at).as_note()
        });
        let uneven = self.uneven.map(|at| {
            let why = "they may be too low: there was more heat within the last few contact lengths, or before in the slider, or the bodies \
                       have turned back";
            Finding::warning(FLASH_STEADY, self.length, f64::NAN, words(at, why)).at(at)
        });
        hot.into_iter().chain(several).chain(early).chain(uneven).collect()
    }

    fn resume(&mut self, finding: &Finding) {
        let value = finding.value.unwrap_or(0.0);
        match finding.code.as_ref() {
            FLASH_STATES => {
                self.several = finding.rows.map(|at| ([value, finding.limit.unwrap_or(f64::NAN)], at))
            }
            // That of the surfaces, not of rows.
            FLASH_STEADY if finding.rows.is_none() => {}
            FLASH_STEADY if finding.is_warning() => (self.uneven, self.length) = (finding.rows, value),
            FLASH_STEADY => (self.early, self.length) = (finding.rows, value),
            _ => {}
        }
    }
}

/// When the last `way` before a time began \[s\].
fn start_of(path: &Path, time: f64, way: f64) -> f64 {
    bisect([0.0, time], 40, |start| path.travel(start, time) > way)[0]
}

/// Whether the path of length `way` between two times goes one way.
fn goes_one_way(path: &Path, [begin, end]: [f64; 2], way: f64) -> bool {
    (path.position(end) - path.position(begin)).abs() > (1.0 - 1e-6) * way
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::History;

    #[test]
    fn a_stroke_goes_one_way_until_it_turns() {
        let sine =
            Path::of_velocity(History::Sine { mean: 0.0, amplitude: 1.0, frequency: 0.25 }, 0.0).unwrap();
        // The stroke is 4/π long and turns at 2 s.
        let is_one = |time, way| goes_one_way(&sine, [start_of(&sine, time, way), time], way);
        assert!(is_one(1.0, 0.5) && is_one(1.95, 0.5));
        assert!(!is_one(2.3, 0.5) && is_one(3.0, 0.5) && !is_one(3.0, 2.0));
        // The last quarter of a unit before the middle of the stroke takes its way at about unit speed.
        assert!((start_of(&sine, 1.0, 0.25) - 0.75).abs() < 0.01);
    }
}
