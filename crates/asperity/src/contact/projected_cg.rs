//! Preconditioned projected conjugate gradients, one convolution per iteration.
//!
//! Each iteration takes a preconditioned conjugate direction d on the working set S (the free cells
//! and those that must leave their bound), projects the step p - a d back into \[0, H\] with the load
//! kept, and minimises f exactly along the segment from p to the projected point. f falls
//! monotonically. Where the residual fails to halve in ten iterations, a projected-gradient step with
//! exact minimisation is taken instead: by the spacer-step theorem (Luenberger & Ye, Linear and
//! Nonlinear Programming, section 7.11) the method converges from any start.
//!
//! The preconditioner is the inverse symbol |q|/2 on the unpadded grid.

use std::sync::atomic::AtomicBool;

use super::residual::{Balance, Violation};
use super::shift::{FREE, clip, shift_to_sum};
use super::start::make_feasible;
use super::{ContactState, Outcome, Prescribed, Problem, SolverOptions, interrupted, not_converged};
use crate::convolution::Convolution;
use crate::error::{Error, Result};
use crate::field::{Merge, Min, smaller, strands, sweep};
use crate::grid::Grid;
use crate::operator::{Operator, approximate_inverse};

/// Iterations without a halving of the residual before a spacer step.
const PATIENCE: usize = 10;
/// Iterations between fresh evaluations of U = K p, which accumulates rounding.
const REFRESH: usize = 50;
/// A clipped step is taken whole where the exact minimum lies beyond this share of it.
const WHOLE: f64 = 0.8;

/// The method's working memory: about 41 bytes per cell and the preconditioner's plan.
pub struct ProjectedCg {
    inverse: Convolution,
    /// Residual on S with its mean removed, now and one iteration ago.
    residual: Vec<f64>,
    previous: Vec<f64>,
    /// Search direction d on S.
    direction: Vec<f64>,
    /// Trial point y, then step s.
    step: Vec<f64>,
    /// Preconditioned residual, then K s.
    image: Vec<f64>,
    /// Membership of S.
    working: Vec<u8>,
}

/// What a conjugate step needs from the one before.
struct Conjugacy {
    /// <z, r> of the last step; `None` restarts.
    product: Option<f64>,
    /// Step length a that the next trial uses.
    length: f64,
}

/// The step to take, in `self.step`.
struct Step {
    /// <r, s>
    slope: f64,
    kind: Kind,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// s = -a d, feasible up to `reach` times s.
    Straight { reach: f64 },
    /// s leads to the projection of p - a d.
    Clipped,
    /// s leads to the projection of p - b r.
    Gradient,
}

impl ProjectedCg {
    /// Plans the method for a grid.
    pub fn new(grid: &Grid) -> Self {
        let n = grid.len();
        ProjectedCg {
            inverse: approximate_inverse(grid),
            residual: vec![0.0; n],
            previous: vec![0.0; n],
            direction: vec![0.0; n],
            step: vec![0.0; n],
            image: vec![0.0; n],
            working: vec![0; n],
        }
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
        make_feasible(problem, grid.cell_area(), state, &mut self.working, &mut self.step)?;
        operator.apply_into(&state.pressure, &mut state.unit_displacement);
        let mut convolutions = 1;
        let mut gradient_length = 1.0 / (problem.compliance * operator.self_influence());
        let mut conjugacy = Conjugacy { product: None, length: 1.0 };
        let mut best = f64::INFINITY;
        let mut stall = 0;
        let mut stuck = false;
        let mut iteration = 0;
        loop {
            let balance = Balance::of(problem, state);
            let w = balance.approach(problem.prescribed);
            state.approach = w;
            let violation = Violation::of(problem, state, w);
            let rated = violation.rate(problem, &grid, &balance, w, options.tolerance);
            let outcome = Outcome { iterations: iteration, convolutions, ..rated };
            if outcome.residual <= options.tolerance {
                return Ok(outcome);
            }
            if stuck || iteration == options.max_iterations {
                return Err(not_converged("projected-cg", options, &outcome));
            }
            if interrupted(interrupt) {
                return Err(Error::Interrupted);
            }
            if outcome.residual < 0.5 * best {
                best = outcome.residual;
                stall = 0;
            } else {
                stall += 1;
            }

            let conjugate = if stall >= PATIENCE || violation.nothing_works() {
                None
            } else {
                self.conjugate_step(problem, state, w, &violation, &mut conjugacy)
            };
            let step = match conjugate {
                Some(step) => step,
                None => {
                    conjugacy.product = None;
                    stall = 0;
                    match self.gradient_step(problem, state, w, gradient_length) {
                        Some(step) => step,
                        None => {
                            // Nothing descends any more: rounding has the last word.
                            stuck = true;
                            continue;
                        }
                    }
                }
            };
            operator.apply_into(&self.step, &mut self.image);
            convolutions += 1;
            let [curvature, length] = self.curvature();
            let curvature = problem.compliance * curvature;
            let exact = if curvature > 0.0 { -step.slope / curvature } else { 1.0 };
            let t = match step.kind {
                Kind::Straight { reach } => {
                    conjugacy.length = (conjugacy.length * exact).clamp(0.05, 20.0);
                    exact.min(reach)
                }
                Kind::Clipped => {
                    conjugacy.length *= exact.clamp(0.3, 1.5);
                    if exact >= WHOLE { 1.0 } else { exact }
                }
                Kind::Gradient => {
                    if curvature > 0.0 {
                        gradient_length = length / curvature;
                    }
                    exact.min(1.0)
                }
            };
            self.advance(problem, state, t);
            iteration += 1;
            if iteration % REFRESH == 0 {
                operator.apply_into(&state.pressure, &mut state.unit_displacement);
                convolutions += 1;
            }
        }
    }

    /// The conjugate step on S; `None` where it does not descend.
    fn conjugate_step(
        &mut self,
        problem: &Problem,
        state: &ContactState,
        w: f64,
        violation: &Violation,
        conjugacy: &mut Conjugacy,
    ) -> Option<Step> {
        let load = matches!(problem.prescribed, Prescribed::Load(_));
        std::mem::swap(&mut self.residual, &mut self.previous);
        self.restrict(problem, state, w, if load { violation.working_mean() } else { 0.0 });
        self.inverse.apply_into(&self.residual, &mut self.image);

        // <z - mean z, r> = <z, r>, since r has zero mean on S.
        let [z, zr, z_old, r_old, d_old, cells] = self.products();
        let mean_z = if load { z / cells } else { 0.0 };
        let scale = 1.0 / problem.compliance;
        let product = scale * zr;
        if product <= 0.0 || product.is_nan() {
            return None;
        }
        let beta = match conjugacy.product {
            Some(last) => ((product - scale * (z_old - mean_z * r_old)) / last).max(0.0),
            None => 0.0,
        };
        conjugacy.product = Some(product);
        let mean_d = if load { beta * d_old / cells } else { 0.0 };

        let trial = self.turn(problem, state, Turn { scale, mean_z, beta, mean_d, length: conjugacy.length });
        let kind = if trial.leaves() { Kind::Clipped } else { Kind::Straight { reach: trial.reach.0 } };
        if load && kind == Kind::Clipped {
            shift_to_sum(&mut self.step, &self.working, problem.hardness, trial.pressure)?;
        }
        let slope = self.step_from_trial(problem, state, w);
        (slope < 0.0).then_some(Step { slope, kind })
    }

    /// The projected-gradient step over all cells that can touch; `None` where it does not descend.
    fn gradient_step(
        &mut self,
        problem: &Problem,
        state: &ContactState,
        w: f64,
        length: f64,
    ) -> Option<Step> {
        let c = problem.compliance;
        let pressure = sweep(
            (
                (&mut self.step[..], &mut self.working[..]),
                &state.pressure[..],
                &state.unit_displacement[..],
                problem.gap,
            ),
            &|((y, working), p, u, h): ((&mut [f64], &mut [u8]), &[f64], &[f64], &[f64])| {
                strands(p.len(), |i| {
                    let can_touch = h[i] < f64::INFINITY;
                    working[i] = if can_touch { FREE } else { 0 };
                    y[i] = if can_touch { p[i] - length * (c * u[i] + h[i] - w) } else { 0.0 };
                    [p[i]]
                })
            },
        )[0];
        if matches!(problem.prescribed, Prescribed::Load(_)) {
            shift_to_sum(&mut self.step, &self.working, problem.hardness, pressure)?;
        }
        let slope = self.step_from_trial(problem, state, w);
        (slope < 0.0).then_some(Step { slope, kind: Kind::Gradient })
    }

    /// residual = r - mean on S, 0 elsewhere; marks S.
    fn restrict(&mut self, problem: &Problem, state: &ContactState, w: f64, mean: f64) {
        let (c, hardness) = (problem.compliance, problem.hardness);
        sweep(
            (
                (&mut self.residual[..], &mut self.working[..]),
                &state.pressure[..],
                &state.unit_displacement[..],
                problem.gap,
            ),
            &|((residual, working), p, u, h): ((&mut [f64], &mut [u8]), &[f64], &[f64], &[f64])| {
                let n = p.len();
                let (residual, working, u, h) = (&mut residual[..n], &mut working[..n], &u[..n], &h[..n]);
                for i in 0..n {
                    let r = c * u[i] + h[i] - w;
                    let works = if p[i] <= 0.0 { r < 0.0 } else { p[i] < hardness || r > 0.0 };
                    working[i] = if works { FREE } else { 0 };
                    residual[i] = if works { r - mean } else { 0.0 };
                }
            },
        );
    }

    /// sum z, <z, r>, <z, r_old>, sum r_old, sum d_old and the number of cells, all over S.
    fn products(&self) -> [f64; 6] {
        sweep(
            (&self.image[..], &self.residual[..], &self.previous[..], &self.direction[..], &self.working[..]),
            &|(z, r, old, d, working): (&[f64], &[f64], &[f64], &[f64], &[u8])| {
                let n = z.len();
                let (r, old, d, working) = (&r[..n], &old[..n], &d[..n], &working[..n]);
                strands(n, |i| {
                    let on = f64::from(working[i]);
                    let z = on * z[i];
                    [z, z * r[i], z * old[i], on * old[i], on * d[i], on]
                })
            },
        )
    }

    /// d = (z - mean z)/c + beta d - mean on S; trial point y = p - a d.
    fn turn(&mut self, problem: &Problem, state: &ContactState, turn: Turn) -> Trial {
        let hardness = problem.hardness;
        sweep(
            (
                &mut self.direction[..],
                &mut self.step[..],
                &self.image[..],
                &self.working[..],
                &state.pressure[..],
            ),
            &|(d, y, z, working, p): (&mut [f64], &mut [f64], &[f64], &[u8], &[f64])| {
                let n = d.len();
                let (y, z, working, p) = (&mut y[..n], &z[..n], &working[..n], &p[..n]);
                let mut reach = f64::INFINITY;
                let [pressure, outside] = strands(n, |i| {
                    let works = working[i] == FREE;
                    let conjugate = turn.scale * (z[i] - turn.mean_z) + turn.beta * d[i] - turn.mean_d;
                    d[i] = if works { conjugate } else { 0.0 };
                    let s = -turn.length * d[i];
                    y[i] = p[i] + s;
                    // Reach: the largest multiple of s that stays feasible.
                    let room = if s < 0.0 { p[i] } else { hardness - p[i] };
                    let reached = if s != 0.0 { room / s.abs() } else { f64::INFINITY };
                    reach = smaller(reached, reach);
                    let outside = works && (y[i] < 0.0 || y[i] > hardness);
                    [if works { p[i] } else { 0.0 }, f64::from(u8::from(outside))]
                });
                Trial { pressure, outside, reach: Min(reach) }
            },
        )
    }

    /// s = clip(y) - p on the working cells, 0 elsewhere; returns <r, s>.
    fn step_from_trial(&mut self, problem: &Problem, state: &ContactState, w: f64) -> f64 {
        let (c, hardness) = (problem.compliance, problem.hardness);
        sweep(
            (
                (&mut self.step[..], &self.working[..]),
                &state.pressure[..],
                &state.unit_displacement[..],
                problem.gap,
            ),
            &|((s, working), p, u, h): ((&mut [f64], &[u8]), &[f64], &[f64], &[f64])| {
                let n = p.len();
                let (s, working, u, h) = (&mut s[..n], &working[..n], &u[..n], &h[..n]);
                strands(n, |i| {
                    let on = working[i] == FREE;
                    s[i] = if on { clip(s[i], hardness) - p[i] } else { 0.0 };
                    [if on { (c * u[i] + h[i] - w) * s[i] } else { 0.0 }]
                })
            },
        )[0]
    }

    /// <s, K s> and <s, s>.
    fn curvature(&self) -> [f64; 2] {
        sweep((&self.step[..], &self.image[..]), &|(s, k): (&[f64], &[f64])| {
            let k = &k[..s.len()];
            strands(s.len(), |i| [s[i] * k[i], s[i] * s[i]])
        })
    }

    /// p += t s, U += t K s; a cell that lands within rounding of a bound is put on it.
    fn advance(&self, problem: &Problem, state: &mut ContactState, t: f64) {
        let hardness = problem.hardness;
        let cap = hardness * (1.0 - 4.0 * f64::EPSILON);
        sweep(
            (&mut state.pressure[..], &mut state.unit_displacement[..], &self.step[..], &self.image[..]),
            &|(p, u, s, k): (&mut [f64], &mut [f64], &[f64], &[f64])| {
                let n = p.len();
                let (u, s, k) = (&mut u[..n], &s[..n], &k[..n]);
                for i in 0..n {
                    let new = p[i] + t * s[i];
                    let floor = 4.0 * f64::EPSILON * p[i];
                    let new = if s[i] < 0.0 && new <= floor { 0.0 } else { new };
                    p[i] = if new >= cap { hardness } else { new };
                    u[i] += t * k[i];
                }
            },
        );
    }
}

/// How the direction turns.
#[derive(Clone, Copy)]
struct Turn {
    scale: f64,
    mean_z: f64,
    beta: f64,
    mean_d: f64,
    length: f64,
}

/// What the trial point shows.
struct Trial {
    /// sum of p over S.
    pressure: f64,
    /// Working cells outside \[0, H\].
    outside: f64,
    reach: Min,
}

impl Trial {
    fn leaves(&self) -> bool {
        self.outside > 0.0
    }
}

impl Merge for Trial {
    fn merge(self, next: Self) -> Self {
        Trial {
            pressure: self.pressure + next.pressure,
            outside: self.outside + next.outside,
            reach: self.reach.merge(next.reach),
        }
    }
}
