//! The energy balance: the work of the load is stored in the springs, dissipated in the dashpots or used for flattening. The
//! difference is an error of the time steps. Of surfaces that adhere it is besides lost where they jump into contact or off it; there
//! the work is known as far as it is known where in the step they jump.

use super::words::digits;
use super::{ENERGY_BALANCE, Finding};
use crate::step::EnergyBalance;

/// Largest error of the sum, as a fraction of the largest work.
const MISSING: f64 = 0.02;

/// The balance over the rows.
#[derive(Default)]
pub(super) struct Balance {
    /// Largest work and largest error of it \[J\].
    work: f64,
    error: f64,
    worst: usize,
    adheres: bool,
    /// Found in an earlier session of the run.
    earlier: Option<Finding>,
}

impl Balance {
    /// The energies at the end of a row.
    pub(super) fn see(&mut self, index: usize, row: &EnergyBalance) {
        self.work = self.work.max(row.work.abs()).max(row.energies.abs());
        self.adheres = row.adheres;
        if row.error > self.error {
            (self.error, self.worst) = (row.error, index);
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let share = self.error / self.work;
        let now = (share > MISSING).then(|| {
            let percent = digits(100.0 * share);
            let text = match self.adheres {
                true => format!(
                    "external_work may be off by {percent} % of its largest value: the surfaces jump into contact or off it within a \
                     step, and where in the step is not known. Take more steps where the surfaces jump."
                ),
                false => format!(
                    "The work of the load differs from the energies stored and lost by {percent} % of the largest work: the steps are \
                     too long for the energies. Take more steps where the load moves. (Adaptive steps follow the stress of the \
                     material, not the work: give them a smaller tolerance, or take uniform steps there.)"
                ),
            };
            Finding::warning(ENERGY_BALANCE, share, MISSING, text).at([self.worst; 2])
        });
        now.into_iter().chain(self.earlier.clone()).reduce(|a, b| if b.value > a.value { b } else { a })
    }

    /// Takes over the finding of an earlier session.
    pub(super) fn resume(&mut self, finding: &Finding) {
        self.earlier = Some(finding.clone());
    }
}
