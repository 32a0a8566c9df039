//! The creep functions of a pair, each on its own clock, as one material over a step.
//!
//! A body whose temperature changes lives in its reduced time, and so do its retardation times: over a step in
//! which its clock goes ξ and the fastest one x, its times are λ x/ξ on the fastest clock. Rates that are constant over
//! the step make the pair one material with the same compliances. The strains of its terms do not depend on the
//! rates, so that they carry the state of the bodies from one ratio of the rates to another.

use crate::material::{Creep, CreepTerm};
use crate::simulation::Simulation;

/// A clock slower than this share of the fastest stands still.
const STOPPED: f64 = 1e-40;
/// Rates that differ by less are the same: reduced times are known to their rounding.
const SAME: f64 = 1e-12;

/// The parts of a creep function that remember, by their clocks.
pub(super) struct Pair {
    /// C0 of all parts.
    instantaneous: f64,
    parts: Vec<Part>,
}

struct Part {
    /// Which of the lengths of a step is its own.
    clock: usize,
    creep: Creep,
}

impl Pair {
    /// Of a simulation, whose steps have a length in laboratory time and then one for each body with a temperature.
    pub(super) fn new(simulation: &Simulation) -> Self {
        let mut parts: Vec<Part> = vec![];
        let thermal = &simulation.thermal;
        for (clock, creep) in simulation.parts().enumerate() {
            if !creep.remembers() {
                continue;
            }
            // The clocks of the bodies begin with the second length.
            let same = |part: &&mut Part| {
                part.clock > 0 && clock > 0 && thermal[part.clock - 1].clock == thermal[clock - 1].clock
            };
            match parts.iter_mut().find(same) {
                Some(part) => part.creep = part.creep.sum(creep),
                None => parts.push(Part { clock, creep: creep.tidy() }),
            }
        }
        Pair { instantaneous: simulation.instantaneous(), parts }
    }

    /// Number of clocks that matter.
    pub(super) fn count(&self) -> usize {
        self.parts.len()
    }

    /// 1 where a part creeps in laboratory time, else 0: the slowest that the fastest clock goes.
    pub(super) fn laboratory(&self) -> f64 {
        f64::from(u8::from(self.parts.iter().any(|part| part.clock == 0)))
    }

    /// How far each of these clocks goes, given all lengths of a step.
    pub(super) fn own<'s>(&'s self, lengths: &'s [f64]) -> impl Iterator<Item = f64> + 's {
        self.parts.iter().map(|part| lengths[part.clock])
    }

    /// Length of the step on the fastest clock; in laboratory time where nothing remembers.
    pub(super) fn length(&self, lengths: &[f64]) -> f64 {
        match self.parts.is_empty() {
            true => lengths[0],
            false => self.own(lengths).fold(0.0, f64::max),
        }
    }

    /// Sets `rates` to those of the step; whether they have changed. A step in no time has the rates of the last.
    pub(super) fn set_rates(&self, lengths: &[f64], rates: &mut [f64]) -> bool {
        let fastest = self.length(lengths);
        if fastest.is_nan() || fastest <= 0.0 {
            return false;
        }
        let rate = |length: f64| (length / fastest).max(STOPPED);
        if self.own(lengths).zip(&*rates).all(|(length, old)| (rate(length) / old - 1.0).abs() <= SAME) {
            return false;
        }
        self.own(lengths).zip(rates).for_each(|(length, old)| *old = rate(length));
        true
    }

    /// The pair over a step with these rates: the terms of one part after the other.
    pub(super) fn creep(&self, rates: &[f64]) -> Creep {
        let terms = self.parts.iter().zip(rates).flat_map(|(part, rate)| {
            let slowed =
                move |term: &CreepTerm| CreepTerm { retardation_time: term.retardation_time / rate, ..*term };
            part.creep.terms.iter().map(slowed)
        });
        let fluidity = self.parts.iter().zip(rates).map(|(part, rate)| part.creep.fluidity * rate).sum();
        Creep { instantaneous: self.instantaneous, terms: terms.collect(), fluidity }
    }

    /// What is left of each strain of a body without pressure, after the clocks have gone so far.
    pub(super) fn fading(&self, gone: &[f64], left: &mut Vec<f64>) {
        left.clear();
        for (part, gone) in self.parts.iter().zip(gone) {
            left.extend(part.creep.terms.iter().map(|term| libm::exp(-gone / term.retardation_time)));
        }
        if self.parts.iter().any(|part| part.creep.fluidity > 0.0) {
            left.push(1.0);
        }
    }
}
