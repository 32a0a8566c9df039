//! The energy of the bodies: work of the load, springs, dashpots, flattening (docs/theory.md, "Energy and other quantities").
//!
//! ```text
//! springs     (A/2) [ E_inf <u, u> + Σ E_i <u - q_i, u - q_i> ],     <a, b> = Σ a K⁻¹ b,  A the area of a cell
//! dashpots    the work of the pressure on the bodies less what the springs take
//! flattening  A Σ p |h| over the cells at the hardness
//! work        ∫ W dw  =  the sum of the three
//! ```
//!
//! Springs and dashpots are those of the scheme, exactly ([`super::memory`]). The work is taken from load and approach
//! alone: the mean of W over the step, on the clock in which u runs, times the change of w.

use super::Past;
use super::memory::{Ends, Products};

/// The energies at the end of the last row.
#[derive(Clone, Debug)]
pub(super) struct Energy {
    bodies: Bodies,
    /// Energy of the springs \[J\].
    pub(super) elastic: f64,
    /// Heat since t = 0 \[J\].
    pub(super) dissipated: f64,
    /// Work on the cells at the hardness \[J\].
    pub(super) flattening: f64,
    /// ∫ W dw since t = 0 \[J\].
    pub(super) work: f64,
    load: f64,
    approach: f64,
}

/// What the energy of the bodies follows from, beside their fields.
#[derive(Clone, Debug)]
enum Bodies {
    Relaxing(Products),
    /// <q, K q> of each spring of the scheme of constant pressure.
    Springs(Vec<f64>),
}

/// What a row ends with.
#[derive(Clone, Copy)]
pub(super) struct End {
    /// W \[N\] and w \[m\].
    pub(super) load: f64,
    pub(super) approach: f64,
    /// The work on cells at the hardness: all of it, where the cut-off is reversible; of this row, where it stays.
    pub(super) flattening: Flattening,
    /// Whether the row is a jump: no time passes.
    pub(super) jump: bool,
}

/// Work on the cells at the hardness \[J\].
#[derive(Clone, Copy)]
pub(super) enum Flattening {
    /// Held at the end of the row.
    Held(f64),
    /// Spent in this row.
    Spent(f64),
}

impl Energy {
    /// Of bodies at rest; `None` where their memory knows no springs and dashpots.
    pub(super) fn new(past: &Past) -> Option<Self> {
        let bodies = match past {
            Past::Memory(memory) => Bodies::Relaxing(memory.products_at_rest()),
            Past::Constant(constant) => Bodies::Springs(vec![0.0; constant.count()]),
            Past::Waves(_) | Past::Direct(_) => return None,
        };
        let [elastic, dissipated, flattening, work, load, approach] = [0.0; 6];
        Some(Energy { bodies, elastic, dissipated, flattening, work, load, approach })
    }

    /// Takes in the row that was just solved.
    pub(super) fn take(&mut self, past: &Past, ends: Ends<'_>, cell_area: f64, end: End) {
        let step = match (&mut self.bodies, past) {
            (Bodies::Relaxing(products), Past::Memory(memory)) => memory.exchange(products, ends),
            (Bodies::Springs(springs), Past::Constant(constant)) => {
                constant.exchange(springs, self.elastic / cell_area, ends, [self.load, end.load])
            }
            _ => return,
        };
        let flattened = match end.flattening {
            Flattening::Held(work) => work - self.flattening,
            Flattening::Spent(work) => work,
        };
        // A jump is elastic against what the bodies remember, and the course of W over w at a first touch is not known: there
        // the work is what the bodies take.
        self.work += match end.jump || step.from_nothing {
            true => cell_area * step.work + flattened,
            false => step.mean_load * (end.approach - self.approach),
        };
        self.elastic = cell_area * step.stored;
        self.dissipated += cell_area * step.heat;
        self.flattening += flattened;
        (self.load, self.approach) = (end.load, end.approach);
    }

    /// Its numbers, for a checkpoint.
    pub(super) fn save(&self) -> Vec<f64> {
        let mut numbers = match &self.bodies {
            Bodies::Relaxing(products) => products.save(),
            Bodies::Springs(springs) => springs.clone(),
        };
        numbers.extend([self.elastic, self.dissipated, self.flattening, self.work, self.load, self.approach]);
        numbers
    }

    /// How many numbers [`save`](Self::save) gives.
    pub(super) fn len(&self) -> usize {
        self.save().len()
    }

    /// Takes back what [`save`](Self::save) gave of the state that `past` holds; false where it does not fit.
    pub(super) fn restore(&mut self, past: &Past, numbers: &[f64]) -> bool {
        let Some((bodies, sums)) = numbers.split_last_chunk::<6>() else { return false };
        [self.elastic, self.dissipated, self.flattening, self.work, self.load, self.approach] = *sums;
        match (&mut self.bodies, past) {
            (Bodies::Relaxing(products), Past::Memory(memory)) => products.restore(memory, bodies),
            (Bodies::Springs(springs), Past::Constant(_)) if springs.len() == bodies.len() => {
                springs.copy_from_slice(bodies);
                true
            }
            _ => false,
        }
    }
}
