//! The contact of an attempt, where a process displaces the surfaces too: both are solved in turn until they agree (Panagiotopoulos,
//! Ingenieur-Archiv 44, 1975, 421).
//!
//! ```text
//! a = that of the last row
//! repeat:  p = contact of c, h0 + g + c a;    A = what the process adds under p;    stop where c (A - a) is 0
//!          a = extrapolation of the last rounds
//! ```
//!
//! The state holds U = K p + a then, so that c U + g is the whole displacement of the bodies. A round is solved as precisely as the
//! last one was far from agreement.

use super::state::StepState;
use super::{Stepper, saved, solved};
use crate::contact::{Outcome, Prescribed, Start, not_converged};
use crate::error::{COUPLING, Result};
use crate::extrapolation::Extrapolation;
use crate::process::Process;
use asperity_sweep::{Max, each, larger, sums, sweep, zeros};

/// Rounds after which pressure and process are given up.
const MOST_ROUNDS: usize = 100;
/// A round is solved to this share of the residual of the last one; the first, and the last one at least.
const PRECISION: f64 = 0.05;
const COARSEST: f64 = 1e-3;
const LAST: f64 = 0.5;
/// No round is solved more precisely than this, close to the rounding error.
const FINEST: f64 = 1e-12;
/// Rounds after which the best one no longer counts.
const RECENT: usize = 5;

pub(super) struct Coupled {
    /// The number of the process.
    process: usize,
    /// a, and A of the last round, for unit compliance \[Pa m\].
    added: Vec<f64>,
    answer: Vec<f64>,
    /// h0 + g + c a.
    gap: Vec<f64>,
    extrapolation: Extrapolation,
}

saved! {
    Coupled {}
    fields {
        "added": added;
    }
}

impl Coupled {
    /// `None` where no process acts back on the pressure.
    pub(super) fn of(processes: &[Box<dyn Process>], cells: usize) -> Option<Self> {
        let process = processes.iter().position(|process| process.acts_back())?;
        let [added, answer, gap] = [0; 3].map(|_| zeros(cells));
        Some(Coupled { process, added, answer, gap, extrapolation: Extrapolation::default() })
    }
}

impl Stepper {
    /// Solves the contact of the attempt that is open.
    ///
    /// # Errors
    /// Those of the contact and of the process; [`Error::NotConverged`](crate::Error::NotConverged) where they do not agree.
    pub(super) fn solve_contact(&mut self, start: Start, prescribed: Prescribed) -> Result<Outcome> {
        let Some(mut coupled) = self.coupled.take() else {
            let StepState { undeformed, own_gap, compliance, now, .. } = &mut self.state;
            let gap = undeformed.or(own_gap);
            return self.contact.solve_receding(
                start,
                gap,
                *compliance,
                prescribed,
                &undeformed.recession,
                now,
            );
        };
        let options = self.simulation.solver;
        let outcome = self.agree(&mut coupled, prescribed, options.tolerance);
        self.contact.options.tolerance = options.tolerance;
        self.coupled = Some(coupled);
        outcome
    }

    fn agree(&mut self, coupled: &mut Coupled, prescribed: Prescribed, tolerance: f64) -> Result<Outcome> {
        let Coupled { process, added, answer, gap, extrapolation } = coupled;
        extrapolation.clear();
        let mut total = Outcome::default();
        let (finest, coarsest) = (FINEST.max(LAST * tolerance), COARSEST.max(LAST * tolerance));
        let (mut precision, mut best, mut age) = (coarsest, f64::INFINITY, 0);
        for _ in 0..MOST_ROUNDS {
            let (state, step) = (&mut self.state, self.step.as_ref());
            let c = state.compliance;
            each(gap, (state.undeformed.or(&state.own_gap), &added[..]), |to, (h, a)| *to = h + c * a);
            self.contact.options.tolerance = precision;
            let outcome = self.contact.solve(Start::Pressure, gap, c, prescribed, &mut state.now)?;
            each(&mut state.now.unit_displacement, &added[..], |u, a| *u += a);
            state.meet(prescribed);
            let Some(step) = step else { break };
            let mut row = solved(&self.simulation, step, state, &mut self.contact);
            self.processes[*process].act_back(&mut row, precision, answer)?;
            total = total.then(outcome);
            total.convolutions += row.convolutions;
            let change = self.largest_change(added, answer);
            total.residual = total.residual.max(change);
            if change <= tolerance && precision <= finest {
                return Ok(total);
            }
            precision = (PRECISION * change).clamp(finest, coarsest);
            age += 1;
            let is_best = change < best || age > RECENT;
            extrapolation.step(added, answer, change > 2.0 * best && !is_best, is_best);
            if is_best {
                (best, age) = (change, 0);
            }
        }
        total.iterations = MOST_ROUNDS;
        Err(not_converged(COUPLING, &self.simulation.solver, &total).into())
    }

    /// The largest |A - a| in a cell in contact, over the displacement under the pressure for unit compliance, weighted by it.
    fn largest_change(&self, added: &[f64], answer: &[f64]) -> f64 {
        let now = &self.state.now;
        let cells = (&now.pressure[..], &now.unit_displacement[..]);
        let [moved, pressure] = sums(cells, |(p, u)| [p * u, p]);
        let fields = (added, answer, &now.pressure[..]);
        let Max(change) = sweep(fields, &|(added, answer, p): (&[f64], &[f64], &[f64])| {
            let change = |n: usize| if p[n] > 0.0 { (answer[n] - added[n]).abs() } else { 0.0 };
            Max((0..p.len()).map(change).fold(0.0, larger))
        });
        if change > 0.0 { change * pressure / moved.abs() } else { 0.0 }
    }
}
