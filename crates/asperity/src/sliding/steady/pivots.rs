//! Principal pivoting for a contact on which Newton's steps and the metric iteration stall.
//!
//! On a set F of cells the pressure is that of w - h - A p = 0 with the load, and 0 elsewhere. Infeasible are the cells of F with p < 0 and
//! those outside with a negative gap. A moving body loses energy whatever the pressure, so that A is positive definite, and one set is
//! feasible (Cottle, Pang & Stone, The Linear Complementarity Problem, 1992, section 4.2). All infeasible cells change sides while their
//! number falls within [`TRIES`] exchanges, else the last one alone (J. J. Júdice & F. M. Pires, Comput. Oper. Res. 21 (1994) 587): that
//! ends after a finite number of exchanges, which blocks of cells alone need not. It ends only if each set is solved well enough to judge it:
//! where GMRES does not do that, elimination does.

use super::contact::{SteadyContact, Workspace};
use crate::contact::{self, ContactState, stop_at};
use crate::error::Result;
use crate::linear;

/// Exchanges of all infeasible cells without fewer of them.
const TRIES: usize = 10;
/// Solves on one set by GMRES: each brings the violations down by a factor.
const SOLVES: usize = 8;
/// Violations on the set over those that the contact may have.
const EXACT: f64 = 0.1;
/// Largest set, in cells, that is solved by elimination where these solves are not enough: a set of this size takes less than a second.
const DENSE: usize = 1024;

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
            trial.copy_from(state);
            contact::make_feasible(&self.problem, self.grid, trial)?;
            on.operators.apply_into(&trial.pressure, &mut trial.unit_displacement);
            if self.rate(trial).residual <= self.tolerance {
                state.copy_from(trial);
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
        let mut solves = 0;
        loop {
            on.operators.apply_into(&state.pressure, &mut state.unit_displacement);
            self.spent.convolutions += 1;
            let gaps: Vec<f64> = set.iter().map(|n| h[*n] + c * state.unit_displacement[*n]).collect();
            state.approach = gaps.iter().sum::<f64>() / set.len() as f64;
            let violations: Vec<f64> = gaps.iter().map(|gap| (gap - state.approach) / c).collect();
            let largest = violations.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
            let scale = set.iter().map(|n| state.unit_displacement[*n].abs()).sum::<f64>() / set.len() as f64;
            if largest <= EXACT * self.tolerance * scale || solves > SOLVES {
                return Ok(());
            }
            if solves == SOLVES && set.len() <= DENSE {
                self.eliminate(set, total, on, state)?;
            } else {
                let change = self.change_on(set, &violations, on)?;
                set.iter().zip(&change).for_each(|(n, d)| state.pressure[*n] += d);
            }
            solves += 1;
        }
    }

    /// The same by elimination: sum_j A_ij p_j - d/c = -h_i/c on the set, sum_j p_j = the total. A_ij is the displacement at the distance from
    /// j to i of a pressure of 1 in that corner of the domain from which this distance stays inside.
    fn eliminate(
        &mut self,
        set: &[usize],
        total: f64,
        on: &mut Workspace,
        state: &mut ContactState,
    ) -> Result<()> {
        let [nx, ny] = self.grid.cells();
        let mut from_corner = |right: bool, top: bool| {
            let [unit, response] = &mut on.work;
            unit.fill(0.0);
            let (x, y) = (if right { nx - 1 } else { 0 }, if top { ny - 1 } else { 0 });
            unit[x * ny + y] = 1.0;
            on.operators.apply_into(unit, response);
            response.clone()
        };
        let responses = [false, true].map(|right| [false, true].map(|top| from_corner(right, top)));
        self.spent.convolutions += 4;
        self.spent.iterations += 1;
        stop_at(self.interrupt)?;
        let (c, h) = (self.problem.compliance, self.problem.gap);
        let influence = |i: usize, j: usize| {
            let index = |to: usize, from: usize, n: usize| match to >= from {
                true => (false, to - from),
                false => (true, n - 1 + to - from),
            };
            let (right, x) = index(i / ny, j / ny, nx);
            let (top, y) = index(i % ny, j % ny, ny);
            responses[usize::from(right)][usize::from(top)][x * ny + y]
        };
        let row = |i: &usize| {
            let row = set.iter().map(|j| influence(*i, *j));
            row.chain([-1.0, -h[*i] / c]).collect::<Vec<f64>>()
        };
        let load = set.iter().map(|_| 1.0).chain([0.0, total]).collect();
        let [pressure] = linear::solve(set.iter().map(row).chain([load]).collect());
        set.iter().zip(&pressure).for_each(|(n, p)| state.pressure[*n] = *p);
        Ok(())
    }
}
