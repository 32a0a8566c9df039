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
//! ([`super::hereditary`]).

use super::clocks::Clocks;
use super::relaxation::branches::{Branches, Combination, Ending, Update};
use super::{Ends, Exchange, History, Law};
use crate::contact::ContactState;
use crate::error::Result;
use crate::simulation::Simulation;
use crate::step::{Interval, Loader, Saver};
use asperity_sweep::{dot, zeros};

pub(super) struct ConstantPressure {
    clocks: Clocks,
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
    /// <q, K q> of the pressure q of each spring, and what all springs store, where account is kept of the energy.
    springs: Option<(Vec<f64>, f64)>,
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

impl ConstantPressure {
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
        ConstantPressure {
            clocks: Clocks::new(simulation),
            instantaneous: simulation.instantaneous(),
            elements,
            strains: Branches::new(count, cells),
            unit: zeros(cells),
            under_way: false,
            updates: vec![Update::default(); count],
            kept: vec![0.0; count],
            none: vec![0.0; count],
            springs: None,
        }
    }

    fn plan(&mut self, step: &Interval) -> f64 {
        self.clocks.measure(step);
        let lengths = &self.clocks.lengths;
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

    /// Weights of the strains in g.
    fn recall(&self) -> Combination<'_> {
        Combination { weights: &self.kept, own: 0.0 }
    }
}

impl History for ConstantPressure {
    fn open(&mut self, step: &Interval, last: &ContactState, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        let updates = self.updates.clone();
        let ends = std::mem::replace(&mut self.under_way, true);
        let compliance = self.plan(step);
        let next = Combination { weights: &self.kept, own: 0.0 };
        if ends {
            // The strains follow U itself.
            let recalled = Combination { weights: &self.none, own: 0.0 };
            let ending = Ending { compliance: 1.0, recalled, updates: &updates };
            let unit = &last.unit_displacement;
            self.strains.end(ending, unit, unit, &mut self.unit, Some((next, rigid, gap)));
        } else {
            self.strains.combine(next, &self.unit, Some(rigid), gap);
        }
        Ok(Law::of(compliance))
    }

    fn reopen(&mut self, step: &Interval, rigid: &[f64], gap: &mut [f64]) -> Result<Law> {
        let compliance = self.plan(step);
        self.strains.combine(self.recall(), &self.unit, Some(rigid), gap);
        Ok(Law::of(compliance))
    }

    fn recalled(&self, g: &mut [f64]) {
        self.strains.combine(self.recall(), &self.unit, None, g);
    }

    fn track_energy(&mut self) -> bool {
        self.springs = Some((vec![0.0; self.elements.len()], 0.0));
        true
    }

    /// With the pressure p' from the start on, the spring of a retarded term, e = C K q, has q' = E q + (1 - E) p', and its dashpot
    /// turns C (1 - E²) <p' - q, K (p' - q)>/2 into heat; a flow turns x/η <p', K p'> into heat.
    fn exchange(&mut self, ends: &Ends<'_>) -> Option<Exchange> {
        let (springs, stored) = self.springs.as_mut()?;
        let (p, unit) = (&ends.now.pressure[..], &ends.now.unit_displacement[..]);
        let whole = dot(p, unit);
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
        let before = std::mem::replace(stored, 0.5 * now);
        let mean_load = 0.5 * (ends.loads[0] + ends.loads[1]);
        Some(Exchange { stored: *stored, work: *stored - before + heat, heat, mean_load })
    }

    fn save<'a>(&'a self, to: &mut Saver<'a>) {
        to.value("under_way", &self.under_way);
        to.value("updates", &self.updates);
        if let Some((springs, stored)) = &self.springs {
            to.value("springs", springs);
            to.value("stored", stored);
        }
        self.strains.save(to, "strain");
    }

    fn load(&mut self, from: &mut Loader<'_>) -> Result<()> {
        from.values_into("under_way", &mut [&mut self.under_way])?;
        from.values_into("updates", &mut [&mut self.updates])?;
        self.kept.iter_mut().zip(&self.updates).for_each(|(kept, update)| *kept = update.keep);
        if let Some((springs, stored)) = &mut self.springs {
            from.values_into("springs", &mut [springs])?;
            from.values_into("stored", &mut [stored])?;
        }
        self.strains.load(from, "strain")
    }
}
