//! The power of the load in each step: P = (W_n + W_(n+1))/2 (w_(n+1) - w_n)/Δt.

use super::{Process, Solved};
use crate::error::Result;
use crate::quantities::Quantity;
use crate::simulation::Simulation;

pub(super) struct LoadPower {
    /// Of the last step \[W\].
    last: f64,
}

impl LoadPower {
    /// `None` where it is not asked for.
    pub(super) fn of(simulation: &Simulation) -> Option<Self> {
        simulation.takes(Quantity::LoadPower).then_some(LoadPower { last: f64::NAN })
    }
}

impl Process for LoadPower {
    fn accept(&mut self, row: &mut Solved<'_>) {
        self.last = power(row);
    }

    fn preview(&mut self, quantity: Quantity, row: &mut Solved<'_>) -> Result<Option<f64>> {
        Ok((quantity == Quantity::LoadPower).then(|| power(row)))
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        (quantity == Quantity::LoadPower).then_some(self.last)
    }

    fn name(&self) -> &'static str {
        "load_power"
    }
}

/// Of the step that led to this row \[W\].
fn power(row: &Solved<'_>) -> f64 {
    let [before, now] = row.loads;
    let advance = row.now.approach - row.before.approach;
    let dt = row.step.length();
    if dt > 0.0 { 0.5 * (before + now) * advance / dt } else { 0.0 }
}
