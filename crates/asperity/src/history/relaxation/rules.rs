//! What a step does to the memory: its compliance, and a few numbers for each branch.
//!
//! With x the length of the step, y = x/τ_i, E = exp(-y), r(s) the course of u from its value at the start (0) to that at
//! the end (1), and γ_i = ∫ exp(-(x - s)/τ_i) r(s) ds/τ_i,
//!
//! ```text
//! q_i' = E q_i + (1 - E - γ_i) u_n + γ_i u_(n+1)
//! e    = E_inf + Σ E_i (1 - γ_i) + ζ r'(x)                       c = 1/e
//! h    = Σ E_i [E q_i + (1 - E - γ_i) u_n] + ζ r'(x) u_n
//! u_(n+1) = (U_(n+1) + h)/e
//! ```
//!
//! which is exact for that course of u. All terms of h have one sign while u >= 0.

use super::branches::{Combination, Ending, Update};
use super::shape::{Shape, moment};
use crate::material::Dual;
use crate::step::Saved;

/// A rate r'(x) x of the driver below this is taken for this: a dashpot alone needs one.
const SLOWEST: f64 = 1e-9;

/// What u runs linearly in over a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Driver {
    /// Time.
    Time,
    /// L, which changes by so much.
    Load(f64),
}

/// The rules of a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rules {
    /// Length of the step on the fastest clock.
    pub(crate) length: f64,
    pub(crate) driver: Driver,
    /// c = 1/e.
    pub(crate) compliance: f64,
    updates: Vec<Update>,
    /// u_(n+1) = c U + Σ recalled q_i + own u_n.
    recalled: Vec<f64>,
    own: f64,
}

impl Rules {
    pub(crate) fn new(states: usize) -> Self {
        Rules {
            length: 0.0,
            driver: Driver::Time,
            compliance: 0.0,
            updates: vec![Update::default(); states],
            recalled: vec![0.0; states],
            own: 0.0,
        }
    }

    /// A step of length `x`.
    pub(crate) fn set(&mut self, dual: &Dual, x: f64, driver: Driver, shape: &Shape) {
        (self.length, self.driver) = (x, driver);
        let relaxation = &dual.relaxation;
        if x <= 0.0 {
            // No time passes: the states stay, and the springs of all branches answer.
            self.compliance = dual.creep.instantaneous;
            self.own = 0.0;
            for ((update, recalled), term) in
                self.updates.iter_mut().zip(&mut self.recalled).zip(&relaxation.terms)
            {
                *update = Update { keep: 1.0, old: 0.0, new: 0.0 };
                *recalled = self.compliance * term.modulus;
            }
            return;
        }
        let speed = match driver {
            Driver::Time => 1.0,
            Driver::Load(change) => (shape.slope(dual, x) * x / change).max(SLOWEST),
        };
        let dashpot = relaxation.viscosity * speed / x;
        let (mut modulus, mut own) = (relaxation.equilibrium + dashpot, dashpot);
        for (i, term) in relaxation.terms.iter().enumerate() {
            let y = x / term.relaxation_time;
            let (keep, fade) = (libm::exp(-y), moment(0, y));
            let Share { taken, left } = match driver {
                Driver::Time => Share { taken: moment(1, y), left: fade / y },
                Driver::Load(change) => shape.share(dual, i, x, change),
            };
            let update = Update { keep, old: (fade - taken).max(0.0), new: taken };
            modulus += term.modulus * left;
            own += term.modulus * update.old;
            self.updates[i] = update;
            self.recalled[i] = term.modulus * keep;
        }
        self.compliance = 1.0 / modulus;
        self.recalled.iter_mut().for_each(|weight| *weight *= self.compliance);
        self.own = self.compliance * own;
    }

    /// A step that is set recovers without pressure: u' = `recalled` (q, u); the states stay as they are until there is pressure
    /// again.
    pub(crate) fn set_apart(&mut self, recalled: &[f64]) {
        if let Some((own, weights)) = recalled.split_last() {
            self.recalled.copy_from_slice(weights);
            self.own = *own;
        }
    }

    /// g: what u_(n+1) is without pressure.
    pub(crate) fn recalled(&self) -> Combination<'_> {
        Combination { weights: &self.recalled, own: self.own }
    }

    pub(crate) fn ending(&self) -> Ending<'_> {
        Ending { compliance: self.compliance, recalled: self.recalled(), updates: &self.updates }
    }

    /// u_(n+1) of a cell under `unit` = U_(n+1).
    pub(crate) fn reach(&self, unit: f64, u: f64, q: &[f64]) -> f64 {
        let sum: f64 = self.recalled.iter().zip(q).map(|(weight, q)| weight * q).sum();
        self.compliance * unit + sum + self.own * u
    }

    /// u_(n+1) of a cell under `unit` = U_(n+1), and its states after the step.
    pub(crate) fn end(&self, unit: f64, u: f64, q: &mut [f64]) -> f64 {
        let fresh = self.reach(unit, u, q);
        for (q, update) in q.iter_mut().zip(&self.updates) {
            *q = update.keep * *q + update.old * u + update.new * fresh;
        }
        fresh
    }
}

impl Saved for Driver {
    fn save(&self, to: &mut Vec<f64>) {
        to.push(if let Driver::Load(change) = self { *change } else { f64::INFINITY });
    }
    fn load(&mut self, from: &mut std::slice::Iter<'_, f64>) -> Option<()> {
        let change = *from.next()?;
        *self = if change.is_infinite() { Driver::Time } else { Driver::Load(change) };
        Some(())
    }
}

impl Saved for Update {
    fn save(&self, to: &mut Vec<f64>) {
        to.extend([self.keep, self.old, self.new]);
    }
    fn load(&mut self, from: &mut std::slice::Iter<'_, f64>) -> Option<()> {
        [&mut self.keep, &mut self.old, &mut self.new].into_iter().try_for_each(|number| number.load(from))
    }
}

impl Saved for Rules {
    fn save(&self, to: &mut Vec<f64>) {
        let Rules { length, driver, compliance, updates, recalled, own } = self;
        let all: [&dyn Saved; 6] = [length, driver, compliance, own, recalled, updates];
        all.iter().for_each(|value| value.save(to));
    }
    fn load(&mut self, from: &mut std::slice::Iter<'_, f64>) -> Option<()> {
        let Rules { length, driver, compliance, updates, recalled, own } = self;
        let all: [&mut dyn Saved; 6] = [length, driver, compliance, own, recalled, updates];
        all.into_iter().try_for_each(|value| value.load(from))
    }
}

/// What a state takes of the change of u over a step, γ, and what it leaves, 1 - γ, each to its own digits.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    pub(crate) taken: f64,
    pub(crate) left: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Creep, Relaxation};

    /// Deterministic numbers in \[0, 1) (splitmix64).
    fn random(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// A spectrum of one to eight terms over eight decades.
    fn spectrum(random: &mut impl FnMut() -> f64) -> Relaxation {
        let count = 1 + (8.0 * random()) as usize;
        let terms: Vec<(f64, f64)> = (0..count)
            .map(|_| (libm::pow(10.0, 3.0 * random()), libm::pow(10.0, 8.0 * random() - 4.0)))
            .collect();
        Relaxation::absolute(1.0, &terms).unwrap()
    }

    #[test]
    fn a_held_approach_is_exact_and_recovery_monotone_for_any_spectrum_and_any_steps() {
        for seed in 0..1000 {
            let mut random = random(seed);
            let relaxation = spectrum(&mut random);
            let dual = Dual::of(relaxation.to_creep().unwrap()).unwrap();
            let mut rules = Rules::new(dual.states());
            let shape = Shape::new(dual.creep.terms.len());
            let mut q = vec![0.0; dual.states()];
            rules.set(&dual, 0.0, Driver::Time, &shape);
            let mut u = rules.end(dual.relaxation.instantaneous(), 0.0, &mut q);
            let mut t = 0.0;
            for _ in 0..12 {
                let x = libm::pow(10.0, 10.0 * random() - 6.0);
                t += x;
                rules.set(&dual, x, Driver::Time, &shape);
                let held = 1.0;
                let free = rules.clone().end(0.0, u, &mut q.clone());
                let unit = (held - free) / rules.compliance;
                // Roundings of the instantaneous modulus, which the sum began with.
                let rounding = 1e-14 * relaxation.instantaneous();
                assert!((unit - relaxation.value(t)).abs() < rounding, "{seed} {t}: {unit}");
                u = rules.end(unit, u, &mut q);
            }
            // Set free, in equal steps: down to 0, never past it.
            let x = libm::pow(10.0, 8.0 * random() - 4.0);
            rules.set(&dual, x, Driver::Time, &shape);
            for _ in 0..12 {
                let next = rules.end(0.0, u, &mut q);
                assert!(next <= u && next > -1e-13, "{seed}: {u} {next}");
                u = next;
            }
        }
    }

    #[test]
    fn a_held_load_keeps_the_creep_of_its_driver_for_any_spectrum_and_any_steps() {
        // L = W C(t): the load as a cell, through steps of eight decades.
        for seed in 0..200 {
            let mut random = random(seed);
            let creep = spectrum(&mut random).to_creep().unwrap();
            let creep =
                Creep { fluidity: if seed % 3 == 0 { 0.1 * creep.instantaneous } else { 0.0 }, ..creep };
            let dual = Dual::of(creep.clone()).unwrap();
            let mut rules = Rules::new(dual.states());
            let mut shape = Shape::new(dual.creep.terms.len());
            let (mut q, mut strains) = (vec![0.0; dual.states()], vec![0.0; dual.strains()]);
            rules.set(&dual, 0.0, Driver::Time, &shape);
            let mut driver = rules.end(2.0, 0.0, &mut q);
            let mut t = 0.0;
            for _ in 0..20 {
                let x = libm::pow(10.0, 8.0 * random() - 5.0);
                t += x;
                dual.to_strains(&q, driver, &mut strains);
                shape.set(&dual, 2.0, 0.0, &strains);
                let runs_in = match shape.runs_one_way(&dual, driver, x) {
                    true => Driver::Load(shape.change(&dual, x)),
                    false => Driver::Time,
                };
                rules.set(&dual, x, runs_in, &shape);
                let next = rules.end(2.0, driver, &mut q);
                assert!(next >= driver * (1.0 - 1e-9), "{seed}: {driver} {next}");
                driver = next;
                let exact = 2.0 * creep.value(t);
                assert!((driver / exact - 1.0).abs() < 1e-8, "{seed} {t}: {driver} {exact}");
            }
        }
    }
}
