//! SC17's assumption: the pressure of a step is that of its end, from its start on.
//!
//! Each retarded term of the creep function keeps its own field of strains, λ de/dt + e = C U, so that
//!
//! ```text
//! e' = E e + C (1 - E) U_(n+1),   v' = v + (x/η) U_(n+1),    E = exp(-x/λ)
//! c  = C0 + Σ C (1 - E) + x/η,    g  = Σ E e + v
//! ```
//!
//! with x the length of the step on the clock of the term's body. First order; it gives the numbers of the full hereditary sum
//! ([`super::direct`]).

use super::memory::branches::{Branches, Combination, Ending, Update};
use super::memory::{Ends, Exchange};
use crate::march::Simulation;
use asperity_sweep::{strands, sweep, zeros};

pub(super) struct Constant {
    instantaneous: f64,
    elements: Vec<Element>,
    strains: Branches,
    /// U of the last step that has ended.
    unit: Vec<f64>,
    /// The step under way, if any.
    under_way: bool,
    updates: Vec<Update>,
    /// Weights of the strains in g.
    kept: Vec<f64>,
    none: Vec<f64>,
}

/// A strain C (1 - exp(-t/λ)), or a flow t/η; `clock` says which length of a step is its own.
#[derive(Clone, Copy)]
struct Element {
    clock: usize,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Retarded { compliance: f64, time: f64 },
    Flow { fluidity: f64 },
}

impl Constant {
    pub(super) fn new(simulation: &Simulation) -> Self {
        let mut elements = vec![];
        for (clock, creep) in simulation.parts().enumerate() {
            let term = |c: &crate::material::CreepTerm| Kind::Retarded {
                compliance: c.compliance,
                time: c.retardation_time,
            };
            let flow = (creep.fluidity > 0.0).then_some(Kind::Flow { fluidity: creep.fluidity });
            elements.extend(creep.terms.iter().map(term).chain(flow).map(|kind| Element { clock, kind }));
        }
        let (count, cells) = (elements.len(), simulation.grid.len());
        Constant {
            instantaneous: simulation.instantaneous(),
            elements,
            strains: Branches::new(count, cells),
            unit: zeros(cells),
            under_way: false,
            updates: vec![Update::default(); count],
            kept: vec![0.0; count],
            none: vec![0.0; count],
        }
    }

    /// Takes in the end of the step before, where `unit` = U; writes `gap` = `rigid` + g for the next one; returns c.
    pub(super) fn begin(&mut self, lengths: &[f64], unit: &[f64], rigid: &[f64], gap: &mut [f64]) -> f64 {
        let updates = self.updates.clone();
        let ends = std::mem::replace(&mut self.under_way, true);
        let compliance = self.plan(lengths);
        let next = Combination { weights: &self.kept, own: 0.0 };
        if ends {
            // The strains follow U itself.
            let recalled = Combination { weights: &self.none, own: 0.0 };
            let ending = Ending { compliance: 1.0, recalled, updates: &updates };
            self.strains.end(ending, unit, &mut self.unit, None, Some((next, rigid, gap)));
        } else {
            self.strains.combine(next, &self.unit, Some(rigid), gap);
        }
        compliance
    }

    /// As [`Constant::begin`] for the step under way at another length.
    pub(super) fn retry(&mut self, lengths: &[f64], rigid: &[f64], gap: &mut [f64]) -> f64 {
        let compliance = self.plan(lengths);
        let weights = Combination { weights: &self.kept, own: 0.0 };
        self.strains.combine(weights, &self.unit, Some(rigid), gap);
        compliance
    }

    fn plan(&mut self, lengths: &[f64]) -> f64 {
        for ((element, update), kept) in self.elements.iter().zip(&mut self.updates).zip(&mut self.kept) {
            let x = lengths[element.clock];
            *update = match element.kind {
                Kind::Retarded { compliance, time } => {
                    let y = x / time;
                    Update { keep: libm::exp(-y), old: 0.0, new: -compliance * libm::expm1(-y) }
                }
                Kind::Flow { fluidity } => Update { keep: 1.0, old: 0.0, new: fluidity * x },
            };
            *kept = update.keep;
        }
        self.instantaneous + self.updates.iter().map(|update| update.new).sum::<f64>()
    }

    /// g of the step under way.
    pub(super) fn remembered(&self, g: &mut [f64]) {
        self.strains.combine(Combination { weights: &self.kept, own: 0.0 }, &self.unit, None, g);
    }

    /// Number of strains.
    pub(super) fn count(&self) -> usize {
        self.elements.len()
    }

    /// What the step under way, which has just been solved, did; `springs` holds <q, K q> of the pressure q that the spring of
    /// each retarded term carries, e = C K q, at its start and then at its end.
    ///
    /// With the pressure p' from the start on, q' = E q + (1 - E) p', and the dashpot turns
    /// C (1 - E²) <p' - q, K (p' - q)>/2 into heat; a flow x/η <p', K p'>.
    pub(super) fn exchange(
        &self,
        springs: &mut [f64],
        stored: f64,
        ends: Ends<'_>,
        loads: [f64; 2],
    ) -> Exchange {
        let (p, unit) = ends.now;
        let whole =
            sweep((p, unit), &|(p, unit): (&[f64], &[f64])| strands(p.len(), |k| [p[k] * unit[k]]))[0];
        let with_strains = self.strains.products(&self.unit, p);
        let (mut now, mut heat) = (self.instantaneous * whole, 0.0);
        for (n, element) in self.elements.iter().enumerate() {
            let (update, spring) = (&self.updates[n], &mut springs[n]);
            match element.kind {
                Kind::Retarded { compliance, .. } => {
                    let (keep, fade) = (update.keep, update.new / compliance);
                    let both = with_strains[n] / compliance;
                    let square = (whole - 2.0 * both + *spring).max(0.0);
                    heat += 0.5 * compliance * fade * (1.0 + keep) * square;
                    *spring = (keep * (keep * *spring + 2.0 * fade * both) + fade * fade * whole).max(0.0);
                    now += compliance * *spring;
                }
                Kind::Flow { .. } => heat += update.new * whole,
            }
        }
        let (now, mean_load) = (0.5 * now, 0.5 * (loads[0] + loads[1]));
        Exchange { stored: now, work: now - stored + heat, heat, mean_load, from_nothing: loads[0] == 0.0 }
    }

    /// Numbers and fields for a checkpoint.
    pub(super) fn save(&self) -> (Vec<f64>, Vec<Vec<f64>>) {
        let mut numbers = vec![f64::from(u8::from(self.under_way))];
        numbers.extend(self.updates.iter().flat_map(|update| [update.keep, update.new]));
        (numbers, self.strains.save())
    }

    /// Takes back what [`Constant::save`] gave; false where it does not fit.
    pub(super) fn restore(&mut self, numbers: &[f64], fields: &[Vec<f64>]) -> bool {
        let Some((under_way, updates)) = numbers.split_first() else { return false };
        if updates.len() != 2 * self.updates.len() {
            return false;
        }
        self.under_way = *under_way == 1.0;
        for ((update, kept), n) in self.updates.iter_mut().zip(&mut self.kept).zip(updates.chunks(2)) {
            *update = Update { keep: n[0], old: 0.0, new: n[1] };
            *kept = n[0];
        }
        self.strains.load(fields)
    }
}
