//! Principal pivoting for a contact on which Newton's steps and the metric iteration stall.
//!
//! On a set F of cells the pressure is that of w - h - A p = 0 with the load, and 0 elsewhere. Infeasible are the cells of F with p < 0 and
//! those outside with a negative gap. A moving body loses energy whatever the pressure, so that A is positive definite, and one set is
//! feasible (Cottle, Pang & Stone, The Linear Complementarity Problem, 1992, section 4.2). All infeasible cells change sides while their
//! number falls within [`TRIES`] exchanges, else the last one alone (J. J. Júdice & F. M. Pires, Comput. Oper. Res. 21 (1994) 587): that
//! ends after a finite number of exchanges, which blocks of cells alone need not.

use super::contact::{SteadyContact, Workspace};
use super::newton::copy;
use crate::contact::{self, ContactState};
use crate::error::Result;

/// Exchanges of all infeasible cells without fewer of them.
const TRIES: usize = 10;
/// Solves on one set: each brings the violations down by a factor.
const SOLVES: usize = 8;
/// Violations on the set over those that the contact may have.
const EXACT: f64 = 0.1;

impl SteadyContact<'_> {
    /// Exchanges cells from the contact of `state` on until the contact conditions hold. False where that takes more than `most` exchanges or
    /// too many iterations.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::error::Error::Interrupted).
    pub(super) fn pivot(
        &mut self,
        on: &mut Workspace,
        most: usize,
        state: &mut ContactState,
    ) -> Result<bool> {
        let cells = state.pressure.len();
        let mut inside: Vec<bool> = state.pressure.iter().map(|p| *p > 0.0).collect();
        let (mut fewest, mut tries) = (usize::MAX, TRIES);
        let mut exchanges = 0;
        while self.spent.iterations < self.options.max_iterations && exchanges < most {
            exchanges += 1;
            let set: Vec<usize> = (0..cells).filter(|n| inside[*n]).collect();
            if set.is_empty() {
                return Ok(false);
            }
            self.solve_on(&set, on, state)?;
            let (c, h) = (self.problem.compliance, self.problem.gap);
            let is_wrong = |n: &usize| match inside[*n] {
                true => state.pressure[*n] < 0.0,
                false => h[*n] + c * state.unit_displacement[*n] < state.approach,
            };
            let wrong: Vec<usize> = (0..cells).filter(is_wrong).collect();
            tracing::debug!(wrong = wrong.len(), set = set.len(), "pivots");
            let trial = &mut on.trial;
            copy(state, trial);
            contact::make_feasible(&self.problem, self.grid, trial)?;
            on.operators.apply_into(&trial.pressure, &mut trial.unit_displacement);
            if self.rate(trial).residual <= self.tolerance {
                copy(trial, state);
                return Ok(true);
            }
            if wrong.len() < fewest {
                (fewest, tries) = (wrong.len(), TRIES);
            } else {
                tries = tries.saturating_sub(1);
            }
            let change = if tries > 0 { &wrong[..] } else { &wrong[wrong.len().saturating_sub(1)..] };
            if change.is_empty() {
                return Ok(false);
            }
            change.iter().for_each(|n| inside[*n] = !inside[*n]);
        }
        Ok(false)
    }

    /// The pressure on the set, with the load and 0 elsewhere, and the approach.
    fn solve_on(&mut self, set: &[usize], on: &mut Workspace, state: &mut ContactState) -> Result<()> {
        let mut pressure = vec![0.0; state.pressure.len()];
        set.iter().for_each(|n| pressure[*n] = state.pressure[*n]);
        let total = self.problem.sum(self.grid.cell_area()).unwrap_or(f64::NAN);
        let lacking = (total - pressure.iter().sum::<f64>()) / set.len() as f64;
        set.iter().for_each(|n| pressure[*n] += lacking);
        state.pressure = pressure;
        let (c, h) = (self.problem.compliance, self.problem.gap);
        for _ in 0..SOLVES {
            on.operators.apply_into(&state.pressure, &mut state.unit_displacement);
            self.spent.convolutions += 1;
            let gaps: Vec<f64> = set.iter().map(|n| h[*n] + c * state.unit_displacement[*n]).collect();
            state.approach = gaps.iter().sum::<f64>() / set.len() as f64;
            let violations: Vec<f64> = gaps.iter().map(|gap| (gap - state.approach) / c).collect();
            let largest = violations.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
            let scale = set.iter().map(|n| state.unit_displacement[*n].abs()).sum::<f64>() / set.len() as f64;
            if largest <= EXACT * self.tolerance * scale {
                break;
            }
            let change = self.change_on(set, &violations, on)?;
            set.iter().zip(&change).for_each(|(n, d)| state.pressure[*n] += d);
        }
        Ok(())
    }
}
