//! The undeformed gap of a run: that of the simulation, until a process makes it its own.

use std::sync::Arc;

use crate::simulation::Simulation;

pub(crate) struct UndeformedGap {
    simulation: Arc<Simulation>,
    own: Option<Vec<f64>>,
}

impl UndeformedGap {
    pub(crate) fn of(simulation: &Arc<Simulation>) -> Self {
        UndeformedGap { simulation: simulation.clone(), own: None }
    }

    /// h0 \[m\] now, and at the start of the run.
    pub(crate) fn now(&self) -> &[f64] {
        self.own.as_deref().unwrap_or(self.at_start())
    }

    pub(crate) fn at_start(&self) -> &[f64] {
        self.simulation.gap.as_slice().unwrap_or_default()
    }

    /// To be changed.
    pub(crate) fn own_mut(&mut self) -> &mut [f64] {
        let simulation = &self.simulation;
        self.own.get_or_insert_with(|| simulation.gap.iter().copied().collect())
    }
}
