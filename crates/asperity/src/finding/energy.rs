//! The energy balance: the work of the load is stored in the springs, dissipated in the dashpots or used for flattening. The
//! difference is an error of the time steps.

use super::words::digits;
use super::{ENERGY_BALANCE, Finding};

/// Largest error of the sum, as a fraction of the largest work.
const MISSING: f64 = 0.02;

/// The balance over the rows.
#[derive(Default)]
pub(super) struct Balance {
    /// Largest work and largest difference \[J\].
    work: f64,
    missing: f64,
    worst: usize,
    /// Found in an earlier session of the run.
    earlier: Option<Finding>,
}

impl Balance {
    /// Work of the load, and energies stored and lost, at the end of a row \[J\].
    pub(super) fn see(&mut self, index: usize, [work, energies]: [f64; 2]) {
        self.work = self.work.max(work.abs()).max(energies.abs());
        let missing = (work - energies).abs();
        if missing > self.missing {
            (self.missing, self.worst) = (missing, index);
        }
    }

    pub(super) fn finding(&self) -> Option<Finding> {
        let share = self.missing / self.work;
        let now = (share > MISSING).then(|| {
            let text = format!(
                "The work of the load differs from the energies stored and lost by {} % of the largest work: the steps are \
                 too long for the energies. Take more steps where the load moves. (Adaptive steps follow the stress of the \
                 material, not the work: give them a smaller tolerance, or take uniform steps there.)",
                digits(100.0 * share)
            );
            Finding::warning(ENERGY_BALANCE, share, MISSING, text).at([self.worst; 2])
        });
        now.into_iter().chain(self.earlier.clone()).reduce(|a, b| if b.value > a.value { b } else { a })
    }

    /// Takes over the finding of an earlier session.
    pub(super) fn resume(&mut self, finding: &Finding) {
        self.earlier = Some(finding.clone());
    }
}
