//! The method of Polonsky & Keer (Wear 231, 1999) with a cut-off H of the pressure, as SC17 section 3 has it, with its
//! misprints corrected (docs/theory.md): conjugate gradients on the free cells D = {0 < p < H}, d <- r + theta (G/G_old) d;
//! then cells beyond a bound are clipped, cells that must leave a bound are released, and the cells below H are scaled to
//! the load.
//!
//! Clipping, releasing and scaling can raise the energy f, so that these steps alone can cycle where most of the contact is
//! at H. After a stall the solver takes gradient steps, which converge by themselves: see the file `gradient.rs`.

mod gradient;

use gradient::Progress;

use super::bounds::clip;
use super::residual::{ResidualReport, find_approach};
use super::start::{make_feasible, set_sum};
use super::{ContactState, Outcome, Prescribed, Problem, Task, not_converged, stop_at};
use crate::error::Result;
use crate::grid::Grid;
use asperity_sweep::{add, each, each_with_sums, sums};

/// The method's working memory: 24 bytes per cell and a set of cells.
pub struct PolonskyKeer {
    residual: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    touchable: Vec<u8>,
}

impl PolonskyKeer {
    /// Working memory for a grid.
    pub fn new(grid: &Grid) -> Self {
        let n = grid.len();
        PolonskyKeer {
            residual: vec![0.0; n],
            direction: vec![0.0; n],
            image: vec![0.0; n],
            touchable: vec![0; n.div_ceil(8)],
        }
    }

    /// Bytes that the method takes on that grid.
    pub(super) fn bytes(grid: &Grid) -> usize {
        24 * grid.len() + grid.len() / 8
    }

    /// See [`super::Solver::solve`]; the trivial cases are answered there.
    pub(super) fn solve(&mut self, task: Task) -> Result<Outcome> {
        let Task { operator, problem, options, state, interrupt } = task;
        let grid = *operator.grid();
        let stiffness = 1.0 / (problem.compliance * operator.self_influence());
        make_feasible(problem, grid.cell_area(), state, &mut self.touchable)?;
        operator.apply_into(&state.pressure, &mut state.unit_displacement);
        state.rounding = 1.0;
        let mut convolutions = 1;
        let mut progress = Progress::new();
        let mut gradient_length = stiffness;
        self.direction.fill(0.0);
        // 1 / G_old: zero after a change of the contact.
        let mut memory = 0.0;
        let mut iteration = 0;
        loop {
            state.approach = find_approach(problem, state);
            let report = ResidualReport::of(problem, state, state.approach);
            let rated = report.outcome(problem, &grid, options.tolerance);
            let outcome = Outcome { iterations: iteration, convolutions, ..rated };
            if outcome.residual <= options.tolerance {
                state.rounding = 1.0 + iteration as f64;
                return Ok(outcome);
            }
            if iteration == options.max_iterations {
                return Err(not_converged("polonsky-keer", options, &outcome).into());
            }
            stop_at(interrupt)?;
            iteration += 1;
            let stalled = progress.has_stalled(outcome.residual) || report.no_cell_is_free();
            tracing::debug!(
                iterations = iteration,
                residual = outcome.residual,
                working = report.working_cells(),
                step = if stalled { "gradient" } else { "conjugate" },
                convolutions
            );

            if stalled {
                if !self.gradient_step(operator, problem, state, &mut gradient_length) {
                    // Nothing descends: rounding is all that is left.
                    return Err(not_converged("polonsky-keer", options, &outcome).into());
                }
                convolutions += 1;
                memory = 0.0;
                continue;
            }
            let product = self.residual_on_free(problem, state);
            self.update_direction(problem, state, product * memory);
            operator.apply_into(&self.direction, &mut self.image);
            convolutions += 1;
            let [rd, curvature] = self.products();
            let curvature = problem.compliance * curvature;
            let length = if curvature > 0.0 { rd / curvature } else { stiffness };
            if self.step(problem, state, length, length.min(stiffness)) {
                if let Some(target) = problem.sum(grid.cell_area()) {
                    let p = &mut state.pressure;
                    if set_sum(p, &self.touchable, problem.hardness, target).is_none() {
                        return Err(not_converged("polonsky-keer", options, &outcome).into());
                    }
                }
                operator.apply_into(&state.pressure, &mut state.unit_displacement);
                convolutions += 1;
                memory = 0.0;
            } else {
                add(&mut state.unit_displacement, -length, &self.image);
                memory = if product > 0.0 { 1.0 / product } else { 0.0 };
            }
        }
    }

    /// r on D = {0 < p < H}, 0 elsewhere; returns G = <r, r>.
    fn residual_on_free(&mut self, problem: &Problem, state: &ContactState) -> f64 {
        let (c, w) = (problem.compliance, state.approach);
        let fields = (&state.pressure[..], &state.unit_displacement[..], problem.gap, problem.hardness);
        let [product] = each_with_sums(&mut self.residual, fields, |r, (p, u, h, hardness)| {
            *r = if is_free(p, hardness) { c * u + h - w } else { 0.0 };
            [*r * *r]
        });
        product
    }

    /// d <- r + beta d on D; under load control with its mean over D removed.
    fn update_direction(&mut self, problem: &Problem, state: &ContactState, beta: f64) {
        let hardness = problem.hardness;
        let fields = (&self.residual[..], &state.pressure[..], hardness);
        let [sum, cells] = each_with_sums(&mut self.direction, fields, |d, (r, p, hardness)| {
            let free = is_free(p, hardness);
            *d = if free { r + beta * *d } else { 0.0 };
            [*d, f64::from(u8::from(free))]
        });
        if cells > 0.0 && matches!(problem.prescribed, Prescribed::Load(_)) {
            let mean = sum / cells;
            each(&mut self.direction, (&state.pressure[..], hardness), |d, (p, hardness)| {
                *d -= if is_free(p, hardness) { mean } else { 0.0 };
            });
        }
    }

    /// <r, d> and <d, K d>.
    fn products(&self) -> [f64; 2] {
        sums((&self.residual[..], &self.direction[..], &self.image[..]), |(r, d, k)| [r * d, d * k])
    }

    /// p <- clip(p - a d); cells that must leave their bound move by -`release` r. True where the set changed.
    fn step(&self, problem: &Problem, state: &mut ContactState, length: f64, release: f64) -> bool {
        let (c, w) = (problem.compliance, state.approach);
        let fields = (&self.direction[..], &state.unit_displacement[..], problem.gap, problem.hardness);
        let [changes] = each_with_sums(&mut state.pressure, fields, |p, (d, u, h, hardness)| {
            let r = c * u + h - w;
            let released = is_released(*p, r, hardness);
            let new = *p - length * d - if released { release * r } else { 0.0 };
            let clipped = clip(new, hardness);
            *p = if h < f64::INFINITY { clipped } else { 0.0 };
            [f64::from(u8::from(released || clipped != new))]
        });
        changes > 0.0
    }
}

/// True in D.
#[inline(always)]
fn is_free(p: f64, hardness: f64) -> bool {
    p > 0.0 && p < hardness
}

/// True where a cell at a bound must leave it.
#[inline(always)]
fn is_released(p: f64, r: f64, hardness: f64) -> bool {
    if p <= 0.0 { r < 0.0 } else { p >= hardness && r > 0.0 }
}
