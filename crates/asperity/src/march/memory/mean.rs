//! The mean course of the displacements under a load: the driver of waves that creep differently.
//!
//! Under load control u runs linearly in L = ∫ C dW where space and time separate (see [`super::shape`]). Where waves creep
//! differently, L is that of a mean creep function: the mean of the C_k(t) of the waves, each with the weight |p^|² that it has in the
//! pressure that the load brings first.
//!
//! While the approach is held, u changes outside of the contact only, because the pressure relaxes. It runs as the pressure of the
//! mean then, Σ A_i (1 - exp(-s/τ_i)) with A_i = E_i (L - q_i). Otherwise u runs linearly in time.

use super::estimate::{growing, soon};
use super::rules::{Course, Rules, Share};
use super::shape::{Shape, fading_share, moment};
use super::{Imposed, Total};
use crate::error::Result;
use crate::material::{Creep, CreepTerm, Dual};

/// A term of the other sign below this share of the largest is rounding.
const ROUNDING: f64 = 1e-12;

/// How u runs over a step.
pub(super) enum Run {
    /// Linearly in time, or in L.
    Driver(Course),
    /// As a sum of terms (A, τ) that relax.
    Relaxing(Vec<(f64, f64)>),
}

pub(super) struct Mean {
    dual: Dual,
    shape: Shape,
    rules: Rules,
    strains: Vec<f64>,
    /// The load as a cell at the start of the step under way, and at its end.
    start: Total,
    end: Total,
}

impl Mean {
    /// Of a creep function, after a first step of length `x` in which the load ran from 0 to `load`.
    pub(super) fn new(creep: Creep, x: f64, load: f64) -> Result<Self> {
        let dual = Dual::of(creep)?;
        let count = dual.states();
        let rest = Total { load: 0.0, driver: 0.0, states: vec![0.0; count] };
        let mut mean = Mean {
            shape: Shape::new(dual.creep.terms.len()),
            rules: Rules::new(count),
            strains: vec![0.0; dual.strains()],
            start: rest.clone(),
            end: rest,
            dual,
        };
        mean.run(Imposed::Load(load), x);
        mean.settle(load);
        Ok(mean)
    }

    /// The row has ended.
    pub(super) fn begin(&mut self) {
        self.start.set(&self.end);
    }

    /// How u runs over a step of length `x`.
    pub(super) fn run(&mut self, drive: Imposed, x: f64) -> Run {
        let load = match drive {
            Imposed::Load(load) => Some(load),
            Imposed::Apart => Some(0.0),
            Imposed::Approach | Imposed::Held => None,
        };
        let course = match load {
            Some(load) if x > 0.0 => {
                self.dual.to_strains(&self.start.states, self.start.driver, &mut self.strains);
                self.shape.set(&self.dual, self.start.load, (load - self.start.load) / x, &self.strains);
                match self.shape.runs_one_way(&self.dual, self.start.driver, x) {
                    true => Course::Load(self.shape.change(&self.dual, x)),
                    false => Course::Time,
                }
            }
            _ => Course::Time,
        };
        self.rules.set(&self.dual, x, course, &self.shape);
        let states = self.dual.relaxation.terms.iter().zip(&self.start.states);
        let relaxing = states.map(|(e, q)| (e.modulus * (self.start.driver - q), e.relaxation_time));
        let relaxing: Vec<(f64, f64)> = relaxing.collect();
        let most = relaxing.iter().fold(0.0, |most: f64, (a, _)| most.max(*a));
        let one_way = most > 0.0 && relaxing.iter().all(|(a, _)| *a >= -ROUNDING * most);
        match drive == Imposed::Held && x > 0.0 && one_way {
            true => Run::Relaxing(relaxing),
            false => Run::Driver(course),
        }
    }

    /// The step under way ends under this load.
    pub(super) fn settle(&mut self, load: f64) {
        self.end.set(&self.start);
        self.end.load = load;
        self.end.driver = self.rules.end(load, self.start.driver, &mut self.end.states);
    }

    /// As [`super::Memory::first_step`] on the clock of the laboratory.
    pub(super) fn first_step(&mut self, longest: f64, load: Option<f64>, after_jump: bool) -> f64 {
        let relaxed = if after_jump { soon(&self.dual, longest, 1.0) } else { longest };
        let Some(slope) = load else { return relaxed };
        self.dual.to_strains(&self.end.states, self.end.driver, &mut self.strains);
        self.shape.set(&self.dual, self.end.load, slope, &self.strains);
        growing(&self.dual, &self.shape, self.end.driver, [relaxed, longest], 1.0)
    }

    /// What a state with the relaxation time `tau` takes over a step of length `x` in which u runs so.
    pub(super) fn share(&self, run: &Run, tau: f64, x: f64) -> Share {
        match run {
            Run::Relaxing(terms) => fading_share(terms, tau, x),
            Run::Driver(Course::Time) => linear(x / tau),
            Run::Driver(Course::Load(change)) => {
                let gap = |j: usize| self.dual.creep.terms[j].retardation_time / tau - 1.0;
                self.shape.share_of(&self.dual, tau, gap, x, *change)
            }
        }
    }

    /// Its numbers, for a checkpoint; they tell their own length.
    pub(super) fn save(&self) -> Vec<f64> {
        let creep = &self.dual.creep;
        let mut numbers = vec![creep.terms.len() as f64, creep.instantaneous, self.end.load, self.end.driver];
        numbers.extend(creep.terms.iter().flat_map(|term| [term.compliance, term.retardation_time]));
        numbers.extend(&self.end.states);
        numbers
    }

    /// From what [`Mean::save`] gave; `None` where it does not fit.
    pub(super) fn load(numbers: &[f64]) -> Option<Self> {
        let [count, instantaneous, load, driver, rest @ ..] = numbers else { return None };
        let (terms, states) = rest.split_at_checked(2 * *count as usize)?;
        let terms: Vec<CreepTerm> =
            terms.chunks(2).map(|t| CreepTerm { compliance: t[0], retardation_time: t[1] }).collect();
        let creep = Creep { instantaneous: *instantaneous, terms, fluidity: 0.0 };
        let mut mean = Mean::new(creep, 0.0, 0.0).ok()?;
        if states.len() != mean.end.states.len() {
            return None;
        }
        mean.end = Total { load: *load, driver: *driver, states: states.to_vec() };
        Some(mean)
    }
}

/// u linear in time.
pub(super) fn linear(y: f64) -> Share {
    Share { taken: moment(1, y), left: moment(0, y) / y }
}
