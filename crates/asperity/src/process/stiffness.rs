//! The stiffness dW/dw of the contact in each row ([`ContactStiffness`]).

use super::{Process, Solved};
use crate::contact::Hardness;
use crate::error::Result;
use crate::operator::Operator;
use crate::quantities::{ContactStiffness, Quantity};
use crate::simulation::{Plasticity, Simulation};

pub(super) struct Stiffness {
    solver: ContactStiffness,
    /// Of the row that is prepared, and of the last one.
    next: f64,
    last: f64,
}

impl Stiffness {
    pub(super) fn of(simulation: &Simulation, operator: &dyn Operator) -> Option<Self> {
        let wanted = simulation.takes(Quantity::ContactStiffness);
        wanted.then(|| Stiffness { solver: ContactStiffness::new(operator), next: f64::NAN, last: f64::NAN })
    }

    fn of_row(&mut self, row: &mut Solved<'_>) -> Result<f64> {
        let pressure = &row.now.pressure;
        // Cells at the hardness carry no more, unless they stay flat: then they respond to unloading.
        let most = match row.simulation.plasticity {
            Plasticity::Cap => row.hardness,
            Plasticity::Accumulate => Hardness::Uniform(f64::INFINITY),
        };
        let bears = |k: usize| pressure[k] > 0.0 && pressure[k] < most.at(k);
        let compliance = row.simulation.instantaneous();
        let (stiffness, convolutions) = self.solver.of(row.operator, compliance, bears, row.interrupt)?;
        row.convolutions += convolutions;
        Ok(stiffness)
    }
}

impl Process for Stiffness {
    fn prepare(&mut self, row: &mut Solved<'_>) -> Result<()> {
        self.next = self.of_row(row)?;
        Ok(())
    }

    fn accept(&mut self, _row: &mut Solved<'_>) {
        self.last = self.next;
    }

    fn preview(&mut self, quantity: Quantity, row: &mut Solved<'_>) -> Result<Option<f64>> {
        (quantity == Quantity::ContactStiffness).then(|| self.of_row(row)).transpose()
    }

    fn quantity(&self, quantity: Quantity) -> Option<f64> {
        (quantity == Quantity::ContactStiffness).then_some(self.last)
    }

    fn name(&self) -> &'static str {
        "stiffness"
    }
}
