//! Preconditioned projected conjugate gradients, one convolution per iteration (docs/theory.md, section 7).
//!
//! Each iteration takes a preconditioned conjugate direction d on the working set S (the free cells and those that must leave
//! their bound), projects the trial point p - a d onto \[0, H\] with the load kept, and minimises f exactly along the segment
//! from p to the projected point. f falls monotonically. Where the residual fails to halve in ten iterations, a projected
//! gradient step with exact minimisation is taken instead: by the spacer-step theorem (Luenberger & Ye, Linear and
//! Nonlinear Programming, section 7.11) the method converges from any start.

use super::projection::Trial;
use super::residual::{ResidualReport, find_approach};
use super::search::Search;
use super::start::Start;
use super::step::{Slope, Step, StepKind};
use super::sweeps::direction::{Centre, Steepest};
use super::sweeps::residual::FindWorking;
use super::sweeps::step::{Advance, Curvature, FindStep};
use super::workspace::preconditioned;
use super::{ContactState, Outcome, Problem, ProjectedCg, Task, not_converged, stop_at};
use crate::error::Result;
use asperity_sweep::{Min, Set, SetMut, run};

/// Iterations without a halving of the residual before a gradient step.
const PATIENCE: usize = 10;

impl ProjectedCg {
    /// See [`super::Solver::solve`]; [`Problem::trivial_solution`] has answered the trivial cases.
    pub(super) fn solve(&mut self, start: Start, task: Task) -> Result<Outcome> {
        let Task { problem, options, interrupt, .. } = task;
        let grid = *task.operator.grid();
        let mut search = Search::new(task);
        self.start(start, &mut search)?;
        loop {
            let report = self.residual_report(&mut search);
            let rated = report.outcome(problem, &grid, options.tolerance);
            let Search { iterations, convolutions, .. } = search;
            let outcome = Outcome { iterations, convolutions, ..rated };
            let converged = outcome.residual <= options.tolerance;
            if converged && search.is_precise(options.tolerance) {
                return Ok(outcome);
            }
            if iterations == options.max_iterations {
                return Err(not_converged("projected-cg", options, &outcome).into());
            }
            stop_at(interrupt)?;
            if converged {
                search.convolve();
                continue;
            }
            search.count_stall(outcome.residual);
            let step =
                if search.stalled < PATIENCE { self.conjugate_step(&mut search, &report) } else { None };
            let taken = step.and_then(|step| self.take(&mut search, step)).or_else(|| {
                let step = self.gradient_step(&mut search, &report)?;
                self.take(&mut search, step)
            });
            match taken {
                Some(step) => tracing::debug!(
                    iterations, residual = outcome.residual, working = report.working_cells(), %step,
                    convolutions = search.convolutions
                ),
                // Rounding errors of U may hide the way down.
                None if search.state.rounding > 1.0 => search.convolve(),
                None => return Err(not_converged("projected-cg", options, &outcome).into()),
            }
        }
    }

    /// The report of the state for the approach that fits it best; finds the working set and the residual on it.
    pub(super) fn residual_report(&mut self, search: &mut Search) -> ResidualReport {
        let Search { problem, state, .. } = search;
        let w = search.free_gap.take().unwrap_or_else(|| find_approach(problem, state));
        state.approach = w;
        let (p, u) = (&state.pressure[..], &state.unit_displacement[..]);
        let Problem { gap, compliance, hardness, .. } = **problem;
        let (residual, set) = (&mut self.residual[..], SetMut(&mut self.working));
        let report = run(FindWorking { p, u, gap, hardness, residual, set, compliance, w });
        if search.unit == 0.0 {
            search.unit = if report.violation > 0.0 { report.violation } else { 1.0 };
        }
        report
    }

    /// The step along the conjugate direction on S; `None` where there is none.
    pub(super) fn conjugate_step(&mut self, search: &mut Search, report: &ResidualReport) -> Option<Step> {
        let cells = report.working_cells();
        if cells == 0.0 {
            return None;
        }
        let mean = if search.sum.is_some() { report.working_mean() } else { 0.0 };
        run(Centre { r: &mut self.residual, set: Set(&self.working), mean, unit: search.unit });
        let z = preconditioned(&mut self.image);
        self.preconditioner.apply_on_set_into(&self.residual, &self.working, z);
        self.make_conjugate(search, cells)?;
        let length = search.length * self.preconditioner.unit() * search.unit / search.problem.compliance;
        let sum = search.sum.map(|sum| sum - report.pressure[0] + report.working[2]);
        Step::conjugate(self.trial(search, length), sum, cells)
    }

    /// The projected gradient step over all cells that can touch; `None` where no shift keeps the load.
    fn gradient_step(&mut self, search: &mut Search, report: &ResidualReport) -> Option<Step> {
        let Problem { gap, compliance, .. } = *search.problem;
        let (u, d, r) =
            (&search.state.unit_displacement[..], &mut self.direction[..], &mut self.residual[..]);
        let set = SetMut(&mut self.working);
        run(Steepest { u, gap, d, r, set, compliance, w: report.w, unit: search.unit });
        // The direction is not zero outside of the last working set any more.
        self.working_old.fill(u8::MAX);
        search.product = None;
        search.stalled = 0;
        Step::gradient(self.trial(search, search.gradient_length * search.unit), search.sum)
    }

    fn trial<'a>(&'a self, search: &'a Search, length: f64) -> Trial<'a> {
        let (pressure, hardness) = (&search.state.pressure[..], search.problem.hardness);
        Trial { pressure, direction: Some(&self.direction), set: &self.working, length, hardness }
    }

    /// Takes a step as far as f falls along it, one convolution; `None` where f does not fall.
    fn take(&mut self, search: &mut Search, step: Step) -> Option<StepKind> {
        let (slope, square, reach) = self.find_step(search, step);
        if slope >= 0.0 || slope.is_nan() {
            return None;
        }
        self.convolve_step(search);
        let Problem { compliance, hardness, .. } = *search.problem;
        let (p, d, image) = (&search.state.pressure[..], &self.direction[..], &self.image[..]);
        let curvature = compliance * run(Curvature { p, d, image, set: Set(&self.working), hardness, step });
        let along = Slope { slope, curvature, reach };
        search.update_lengths(step.kind, along.minimum(), square / curvature);
        self.advance(search, step, step.line_search(along));
        Some(step.kind)
    }

    /// Replaces s by its image K s.
    pub(super) fn convolve_step(&mut self, search: &mut Search) {
        search.operator.apply_in_place(&mut self.image);
        search.convolutions += 1;
    }

    /// Writes the step s to where its image will be; returns <r, s>, <s, s>, and the largest feasible multiple of s.
    pub(super) fn find_step(&mut self, search: &Search, step: Step) -> (f64, f64, f64) {
        let (p, hardness) = (&search.state.pressure[..], search.problem.hardness);
        let (d, r, set, s) =
            (&self.direction[..], &self.residual[..], Set(&self.working), &mut self.image[..]);
        let ([slope, square], Min(reach)) = run(FindStep { p, d, r, set, hardness, s, step });
        (search.unit * slope, square, reach)
    }

    /// p += t s, U += t K s.
    pub(super) fn advance(&mut self, search: &mut Search, step: Step, t: f64) {
        let ContactState { pressure: p, unit_displacement: u, .. } = &mut *search.state;
        let (d, image, set) = (&self.direction[..], &self.image[..], Set(&self.working));
        let Problem { gap, compliance, hardness, .. } = *search.problem;
        let [sum, cells] = run(Advance { p, u, d, image, gap, set, hardness, step, t, compliance });
        search.free_gap = (search.sum.is_some() && cells > 0.0).then(|| sum / cells);
        search.state.rounding += 1.0;
        search.iterations += 1;
        std::mem::swap(&mut self.residual, &mut self.residual_old);
        std::mem::swap(&mut self.working, &mut self.working_old);
    }
}
