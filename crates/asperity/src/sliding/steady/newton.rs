//! Newton's steps on the contact set: the cells that are free, 0 < p < H, and those that violate the contact conditions.
//!
//! ```text
//! loop:
//!     u = A p,  w, r;  keep the best p;  stop where its residual has not fallen for a while
//!     D = free and violated cells;  p += d on D with A d = -r there, the load kept      (GMRES)
//!     p = p within its bounds, with the load
//! ```

use super::contact::{SteadyContact, Workspace};
use crate::contact::{self, ContactState};
use crate::error::Result;

/// Steps at most, and those without progress.
const STEPS: usize = 20;
const PATIENCE: usize = 2;
/// The residual after a step over the least one before it, at most, for progress.
const PROGRESS: f64 = 0.7;
/// The residual after all steps over `before`, at most, for them to count.
const ENOUGH: f64 = 0.7;

impl SteadyContact<'_> {
    /// Takes Newton's steps from the pressure of `state`, which is replaced where they bring the residual well below `before`.
    /// Returns whether they did.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::error::Error::Interrupted).
    pub(super) fn newton(
        &mut self,
        on: &mut Workspace,
        before: f64,
        state: &mut ContactState,
    ) -> Result<bool> {
        on.trial.copy_from(state);
        let (mut least, mut stalled) = (f64::INFINITY, 0);
        for _ in 0..=STEPS {
            on.operators.apply_into(&on.trial.pressure, &mut on.trial.unit_displacement);
            let residual = self.rate(&mut on.trial).residual;
            // The set may change a few times before the residual falls.
            stalled = if residual < PROGRESS * least { 0 } else { stalled + 1 };
            if residual < least {
                least = residual;
                on.best.copy_from(&on.trial);
            }
            if residual <= self.tolerance || stalled > PATIENCE {
                break;
            }
            let (cells, violations) = self.free_cells(&on.trial);
            if cells.is_empty() {
                break;
            }
            let change = self.change_on(&cells, &violations, on)?;
            cells.iter().zip(&change).for_each(|(n, d)| on.trial.pressure[*n] += d);
            if contact::make_feasible(&self.problem, self.grid, &mut on.trial).is_err() {
                break;
            }
        }
        let better = least < ENOUGH * before;
        if better {
            std::mem::swap(state, &mut on.best);
        }
        Ok(better)
    }

    /// The cells that are free or violate the contact conditions, and r/c there.
    fn free_cells(&self, state: &ContactState) -> (Vec<usize>, Vec<f64>) {
        let (problem, c) = (&self.problem, self.problem.compliance);
        let (mut cells, mut violations) = (vec![], vec![]);
        for (n, (p, u)) in state.pressure.iter().zip(&state.unit_displacement).enumerate() {
            let (h, most) = (problem.gap[n], problem.hardness.at(n));
            let r = h + c * u - state.approach;
            let free = *p > 0.0 && *p < most || *p <= 0.0 && r < 0.0 || *p >= most && r > 0.0;
            if h < f64::INFINITY && free {
                cells.push(n);
                violations.push(r / c);
            }
        }
        (cells, violations)
    }
}
