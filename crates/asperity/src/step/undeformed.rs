//! The undeformed gap of a run: that of the simulation, until a process makes it its own.

use std::sync::Arc;

use crate::simulation::Simulation;
use crate::sliding::Slopes;
use crate::wear::Recession;

pub(crate) struct UndeformedGap {
    simulation: Arc<Simulation>,
    own: Option<Vec<f64>>,
    /// At the start of the step under way, if a process moves the gap in it.
    before: Option<Vec<f64>>,
    /// By what it recedes in the step under way because of the pressure at its end.
    pub(crate) recession: Recession,
    /// Depths of dents that stay \[m\], in the frame of the body that has them; empty where the contact stays too, or before the first.
    pub(crate) dents: Vec<f64>,
    /// Slopes of what wear and dents have added to the parts that move.
    pub(crate) own_slopes: Option<Slopes>,
}

impl UndeformedGap {
    pub(crate) fn of(simulation: &Arc<Simulation>) -> Self {
        UndeformedGap {
            simulation: simulation.clone(),
            own: None,
            before: None,
            recession: Recession::default(),
            dents: vec![],
            own_slopes: None,
        }
    }

    /// h0 \[m\] now.
    pub(crate) fn now(&self) -> &[f64] {
        self.own.as_deref().unwrap_or(self.at_start())
    }

    /// The gap h0 + g of a step: `own`, or h0 where that is empty.
    pub(crate) fn or<'a>(&'a self, own: &'a [f64]) -> &'a [f64] {
        if own.is_empty() { self.now() } else { own }
    }

    /// At the start of the step under way.
    pub(crate) fn before(&self) -> &[f64] {
        self.before.as_deref().unwrap_or(self.now())
    }

    /// At the start of the run.
    pub(crate) fn at_start(&self) -> &[f64] {
        self.simulation.gap_cells()
    }

    /// A step begins; `moves` if a process moves the gap in it.
    pub(crate) fn begin(&mut self, moves: bool) {
        if moves {
            let mut before = self.before.take().unwrap_or_default();
            before.clear();
            before.extend_from_slice(self.now());
            self.before = Some(before);
        } else {
            self.before = None;
        }
    }

    /// As it was at the start of the step under way.
    pub(crate) fn go_back(&mut self) {
        if let Some(before) = self.before.take() {
            self.own_mut().copy_from_slice(&before);
            self.before = Some(before);
        }
    }

    /// Adds what it recedes by in the step under this pressure, to `own` as well.
    pub(crate) fn recede(&mut self, pressure: &[f64], own: &mut [f64]) {
        let recession = std::mem::take(&mut self.recession);
        if !recession.is_none() {
            recession.add(pressure, self.own_mut());
            if !own.is_empty() {
                recession.add(pressure, own);
            }
        }
        self.recession = recession;
    }

    /// Something has changed the parts that move by a field of these slopes.
    pub(crate) fn add_slopes(&mut self, slopes: Slopes) {
        self.own_slopes = Some(match self.own_slopes.take() {
            Some(own) => own.and(&slopes),
            None => slopes,
        });
    }

    /// To be changed.
    pub(crate) fn own_mut(&mut self) -> &mut [f64] {
        let simulation = &self.simulation;
        self.own.get_or_insert_with(|| simulation.gap.iter().copied().collect())
    }
}
