//! The contact of surfaces that recede.

use asperity_sweep::{Fields, Max, each, larger, sums, sweep};

use super::Recession;
use super::recession::depth;
use crate::contact::{ContactState, Method, Outcome, Problem, Solver, Start, Task, not_converged};
use crate::error::{Result, WEAR_THRESHOLD};
use crate::operator::{Bed, Bedded, Operator};

/// Rounds after which the cells above the threshold are given up.
const MOST_ROUNDS: usize = 50;

/// A contact solver whose surfaces may recede under their pressure.
pub(crate) struct RecedingSolver {
    solver: Solver,
    method: Method,
    /// That of the bed that the solver is planned for.
    level: Option<i32>,
    pressure: Vec<f64>,
    /// κ of the cells above the threshold, and the gap with it.
    active: Vec<f64>,
    gap: Vec<f64>,
}

impl RecedingSolver {
    pub(crate) fn new(method: Method, operator: &dyn Operator) -> Self {
        let solver = Solver::new(method, operator);
        RecedingSolver { solver, method, level: None, pressure: vec![], active: vec![], gap: vec![] }
    }

    /// The solver of surfaces that do not recede.
    fn still(&mut self, operator: &dyn Operator) -> &mut Solver {
        self.plan(None, operator)
    }

    fn plan(&mut self, level: Option<i32>, operator: &dyn Operator) -> &mut Solver {
        if level != self.level {
            self.solver = Solver::new(self.method, operator);
            self.level = level;
        }
        &mut self.solver
    }

    /// As [`Solver::solve_from`]. A displacement that is known at the start includes that of the bed; at the end it is that of the body.
    pub(crate) fn solve(&mut self, start: Start, recession: &Recession, task: Task) -> Result<Outcome> {
        if recession.is_none() {
            return self.still(task.operator).solve_from(start, task);
        }
        if recession.threshold > 0.0 {
            return self.solve_above_threshold(recession, task);
        }
        let bed = recession.bed(task.problem.compliance);
        self.solve_on(bed, start, task)
    }

    fn solve_on(&mut self, bed: Bed, start: Start, task: Task) -> Result<Outcome> {
        let Task { operator, problem, options, state, interrupt } = task;
        let level = bed.level(operator.self_influence());
        let mut pressure = std::mem::take(&mut self.pressure);
        let mut bedded = Bedded { body: operator, bed, pressure: &mut pressure };
        let solver = self.plan(level, &bedded);
        let solved = solver.solve_from(
            start,
            Task { operator: &mut bedded, problem, options, state: &mut *state, interrupt },
        );
        self.pressure = pressure;
        let cells = (&state.pressure[..], &state.unit_displacement[..], bed);
        let [own, whole] = sums(cells, |(p, u, bed)| [p * (u - bed * p), p * u]);
        each(&mut state.unit_displacement, (&state.pressure[..], bed), |u, (p, bed)| *u -= bed * p);
        // The rounding error of the whole displacement is now in that of the body.
        if own > 0.0 {
            state.rounding *= (whole / own).max(1.0);
        }
        solved
    }

    /// Which cells are above the threshold is found in turn with their pressure.
    fn solve_above_threshold(&mut self, recession: &Recession, task: Task) -> Result<Outcome> {
        let Task { operator, problem, options, state, interrupt } = task;
        let [mut active, mut gap] = [&mut self.active, &mut self.gap].map(std::mem::take);
        active.resize(state.pressure.len(), 0.0);
        gap.resize(state.pressure.len(), 0.0);
        let (threshold, per_pressure) = (recession.threshold, recession.per_pressure());
        let (mut total, mut solved) = (Outcome::default(), None);
        for _ in 0..MOST_ROUNDS {
            each(&mut active, (&state.pressure[..], per_pressure), |to, (p, k)| {
                *to = if p > threshold { k } else { 0.0 }
            });
            each(&mut gap, (problem.gap, &active[..]), |to, (h, k)| *to = h - k * threshold);
            let bed = Bed { scale: 1.0 / problem.compliance, cells: Some(&active) };
            let above = Problem { gap: &gap, ..*problem };
            let task =
                Task { operator: &mut *operator, problem: &above, options, state: &mut *state, interrupt };
            match self.solve_on(bed, Start::Pressure, task) {
                Ok(outcome) => total = total.then(outcome),
                Err(error) => {
                    solved = Some(Err(error));
                    break;
                }
            }
            let error = wrong_depth(recession, &active, problem, state);
            total.residual = total.residual.max(error);
            if error <= options.tolerance {
                solved = Some(Ok(total));
                break;
            }
        }
        (self.active, self.gap) = (active, gap);
        solved.unwrap_or_else(|| Err(not_converged(WEAR_THRESHOLD, options, &total).into()))
    }
}

/// By how much the depth of a cell misses the law, over the displacement under the pressure, weighted by it.
fn wrong_depth(recession: &Recession, active: &[f64], problem: &Problem, state: &ContactState) -> f64 {
    let (p, u) = (&state.pressure[..], &state.unit_displacement[..]);
    let [moved, pressure] = sums((p, u), |(p, u)| [p * problem.compliance * u, p]);
    let threshold = recession.threshold;
    let cells = (p, active, recession.per_pressure());
    let Max(most) = sweep(cells, &|(p, active, bed): (&[f64], &[f64], Bed)| {
        let wrong = |n: usize| {
            let k = bed.at(n);
            (active[n] * (p[n] - threshold) - depth(p[n], k, threshold)).abs()
        };
        Max((0..p.len()).map(wrong).fold(0.0, larger))
    });
    if most > 0.0 { most * pressure / moved.abs() } else { 0.0 }
}
