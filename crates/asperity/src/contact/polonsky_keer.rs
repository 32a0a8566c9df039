//! The method of Polonsky & Keer (Wear 231, 1999) with a cut-off of the pressure, as SC17 section 3
//! has it, with its misprints mended (docs/theory.md): the direction is d <- r + theta (G/G_old) d,
//! means run over D = {0 < p < H}, capped cells with a positive gap are released, and only cells
//! below the hardness carry the correction of the load. A safeguard makes it finish with a cap and under
//! approach control: where no cell is free, or the residual stalls, the direction is r on all cells that
//! may move, those to be released with them. Close to saturation (W -> H A) it can still stall; that is
//! told as an error, and `projected-cg` solves such problems.

use std::sync::atomic::AtomicBool;

use super::bounds::clip;
use super::rating::Rating;
use super::start::{make_feasible, set_sum};
use super::{
    ContactState, Hardness, Outcome, Prescribed, Problem, SolverOptions, interrupted, not_converged,
};
use crate::error::{Error, Result};
use crate::field::{strands, sweep};
use crate::grid::Grid;
use crate::operator::Operator;

/// Iterations without a halving of the residual before a step along r on all cells that may move.
const PATIENCE: usize = 20;

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

    /// See [`super::Solver::solve`]; the trivial cases are settled there.
    pub(super) fn solve(
        &mut self,
        operator: &mut dyn Operator,
        problem: &Problem,
        options: &SolverOptions,
        state: &mut ContactState,
        interrupt: Option<&AtomicBool>,
    ) -> Result<Outcome> {
        let grid = *operator.grid();
        let fallback = 1.0 / (problem.compliance * operator.self_influence());
        make_feasible(problem, grid.cell_area(), state, &mut self.touchable)?;
        operator.apply_into(&state.pressure, &mut state.unit_displacement);
        state.rounding = 1.0;
        let mut convolutions = 1;
        self.direction.fill(0.0);
        // theta / G_old: zero after a change of the contact.
        let mut memory = 0.0;
        let (mut best, mut stall) = (f64::INFINITY, 0);
        let mut iteration = 0;
        loop {
            let w = Rating::of(problem, state, 0.0).approach(problem.prescribed);
            state.approach = w;
            let rating = Rating::of(problem, state, w);
            let rated = rating.outcome(problem, &grid, options.tolerance);
            let outcome = Outcome { iterations: iteration, convolutions, ..rated };
            if outcome.residual <= options.tolerance {
                state.rounding = 1.0 + iteration as f64;
                return Ok(outcome);
            }
            if iteration == options.max_iterations {
                return Err(not_converged("polonsky-keer", options, &outcome));
            }
            if interrupted(interrupt) {
                return Err(Error::Interrupted);
            }

            stall += 1;
            if outcome.residual < 0.5 * best {
                (best, stall) = (outcome.residual, 0);
            }
            let all = rating.no_cell_is_free() || stall >= PATIENCE;
            if all {
                stall = 0;
            }
            let product = self.residual_on_free(problem, state, w, all);
            self.turn(problem, state, if all { 0.0 } else { product * memory }, all);
            operator.apply_into(&self.direction, &mut self.image);
            convolutions += 1;
            let [rd, curvature] = self.products();
            let curvature = problem.compliance * curvature;
            let length = if curvature > 0.0 { rd / curvature } else { fallback };
            let changed = self.step(problem, state, w, length, if all { 0.0 } else { length.min(fallback) });
            if changed {
                if let Prescribed::Load(load) = problem.prescribed {
                    let target = load / grid.cell_area();
                    let p = &mut state.pressure;
                    if set_sum(p, &self.touchable, problem.hardness, target).is_none() {
                        return Err(not_converged("polonsky-keer", options, &outcome));
                    }
                }
                operator.apply_into(&state.pressure, &mut state.unit_displacement);
                convolutions += 1;
                memory = 0.0;
            } else {
                sweep((&mut state.unit_displacement[..], &self.image[..]), &|(u, k): (
                    &mut [f64],
                    &[f64],
                )| {
                    u.iter_mut().zip(k).for_each(|(u, k)| *u -= length * k)
                });
                memory = if product > 0.0 { 1.0 / product } else { 0.0 };
            }
            iteration += 1;
        }
    }

    /// r on D = {0 < p < H} (with `all`, on the cells to be released too), 0 elsewhere; returns G = <r, r>.
    fn residual_on_free(&mut self, problem: &Problem, state: &ContactState, w: f64, all: bool) -> f64 {
        let c = problem.compliance;
        sweep(
            (
                &mut self.residual[..],
                &state.pressure[..],
                &state.unit_displacement[..],
                problem.gap,
                problem.hardness,
            ),
            &|(r, p, u, h, hardness): (&mut [f64], &[f64], &[f64], &[f64], Hardness)| {
                strands(r.len(), |i| {
                    let hardness = hardness.at(i);
                    let gap = c * u[i] + h[i] - w;
                    let free = p[i] > 0.0 && p[i] < hardness;
                    r[i] = if free || (all && released(p[i], gap, hardness)) { gap } else { 0.0 };
                    [r[i] * r[i]]
                })
            },
        )[0]
    }

    /// d <- r + beta d on D; under load control with its mean over D removed.
    fn turn(&mut self, problem: &Problem, state: &ContactState, beta: f64, all: bool) {
        let hardness = problem.hardness;
        // With `all`, the residual itself tells which cells may move.
        let moves = |p: f64, r: f64, hardness: f64| (p > 0.0 && p < hardness) || (all && r != 0.0);
        let [sum, cells] = sweep(
            (&mut self.direction[..], &self.residual[..], &state.pressure[..], hardness),
            &|(d, r, p, hardness): (&mut [f64], &[f64], &[f64], Hardness)| {
                strands(d.len(), |i| {
                    let moves = moves(p[i], r[i], hardness.at(i));
                    d[i] = if moves { r[i] + beta * d[i] } else { 0.0 };
                    [d[i], f64::from(u8::from(moves))]
                })
            },
        );
        if cells > 0.0 && matches!(problem.prescribed, Prescribed::Load(_)) {
            let mean = sum / cells;
            sweep(
                (&mut self.direction[..], &self.residual[..], &state.pressure[..], hardness),
                &|(d, r, p, hardness): (&mut [f64], &[f64], &[f64], Hardness)| {
                    for i in 0..d.len() {
                        d[i] -= if moves(p[i], r[i], hardness.at(i)) { mean } else { 0.0 };
                    }
                },
            );
        }
    }

    /// <r, d> and <d, K d>.
    fn products(&self) -> [f64; 2] {
        sweep((&self.residual[..], &self.direction[..], &self.image[..]), &|(r, d, k): (
            &[f64],
            &[f64],
            &[f64],
        )| {
            strands(r.len(), |i| [r[i] * d[i], d[i] * k[i]])
        })
    }

    /// p <- clip(p - a d); cells that must leave their bound move by `release` r besides. True where the
    /// set changed.
    fn step(&self, problem: &Problem, state: &mut ContactState, w: f64, length: f64, release: f64) -> bool {
        let c = problem.compliance;
        let [changes] = sweep(
            (
                &mut state.pressure[..],
                &self.direction[..],
                &state.unit_displacement[..],
                problem.gap,
                problem.hardness,
            ),
            &|(p, d, u, h, hardness): (&mut [f64], &[f64], &[f64], &[f64], Hardness)| {
                strands(p.len(), |i| {
                    let hardness = hardness.at(i);
                    let r = c * u[i] + h[i] - w;
                    let released = released(p[i], r, hardness);
                    let new = p[i] - length * d[i] - if released { release * r } else { 0.0 };
                    let clipped = clip(new, hardness);
                    p[i] = if h[i] < f64::INFINITY { clipped } else { 0.0 };
                    [f64::from(u8::from(released || clipped != new))]
                })
            },
        );
        changes > 0.0
    }
}

/// True where a cell at a bound must leave it.
#[inline(always)]
fn released(p: f64, r: f64, hardness: f64) -> bool {
    if p <= 0.0 { r < 0.0 } else { p >= hardness && r > 0.0 }
}
