//! The tangential problem of one step (Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990).
//!
//! ```text
//! minimise 1/2 q'(c K) q + q'(b - d)   over |q_i| <= R_i,       r = c K q + b - d  is the slip of the step
//! ```
//!
//! with the displacement d given, or as the multiplier of a given force Σ q. Where |q| < R nothing slips, r = 0; where |q| = R, r is
//! opposite to q. Convex, with one solution.
//!
//! The method is that of [`contact`](crate::contact), with discs in place of intervals: preconditioned conjugate gradients on the
//! directions that the cells are free to take, projection of the trial point, exact minimisation along the segment; where the
//! residual does not fall, a projected gradient step. The edge of a disc is curved: see [`Freedom::Along`].
//!
//! A step is solved where the largest violation of the conditions is within the tolerance, or where the certified error
//! Γ = Σ (R |r| + r q), with |q - q*|² <= Γ in the energy norm, is no more than the rounding of its terms.

use std::sync::atomic::AtomicBool;

use asperity_sweep::{Max, Min, each, smaller, strands, sums, sweep};

use super::discs::{clip, shift_to_sum};
use super::freedom::Freedom;
use super::operator::VectorConvolution;
use super::row::SlipOutcome;
use super::vector::{Vector, inner, length, minus, plus, solve, times};
use crate::contact::{SAME_LOAD, stop_at};
use crate::error::{NotConverged, Result};
use crate::grid::{Boundary, Grid};
use crate::kernel::Cerruti;

/// Residuals are measured by so many times the displacement of the step, at most.
const STEPS: f64 = 10.0;
/// Iterations without a halving of the residual before a gradient step.
const PATIENCE: usize = 10;
/// The first trial step, over the length that the preconditioner would take on all cells.
const FIRST_LENGTH: f64 = 0.6;
/// Iterations after which u is computed afresh.
const REFRESH: usize = 50;
/// Relative rounding error of a term of the certificate.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What is asked of one step.
pub(crate) struct SlipProblem<'a> {
    /// c \[1/Pa\].
    pub(crate) compliance: f64,
    /// b: what the past leaves, less the displacement at the start of the step \[m\].
    pub(crate) offset: &'a [Vector],
    /// R \[Pa\].
    pub(crate) radius: &'a [f64],
    pub(crate) given: Given,
    /// A displacement that residuals are measured by, where that of the tractions is less \[m\].
    pub(crate) scale: f64,
    /// The largest q c K q of the steps before, to which the certificate refers where that of this step is less.
    pub(crate) energy: f64,
}

/// What is given of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Given {
    /// Σ q \[Pa\].
    Sum(Vector),
    /// d \[m\].
    Displacement(Vector),
}

/// The traction of a step and what it does.
#[derive(Clone, Debug)]
pub(crate) struct Slip {
    /// q \[Pa\].
    pub(crate) traction: Vec<Vector>,
    /// U = K q.
    pub(crate) unit: Vec<Vector>,
    /// d \[m\].
    pub(crate) displacement: Vector,
}

pub(crate) struct SlipSolver {
    operator: VectorConvolution,
    inverse: VectorConvolution,
    /// Displacement of a cell under its own unit traction, the mean of both directions.
    own: f64,
    free: Vec<Freedom>,
    /// The part of r on the free directions, now and in the last iteration.
    residual: Vec<Vector>,
    last_residual: Vec<Vector>,
    preconditioned: Vec<Vector>,
    direction: Vec<Vector>,
    trial: Vec<Vector>,
    step: Vec<Vector>,
    image: Vec<Vector>,
}

/// What changes from iteration to iteration besides the fields.
struct Search {
    /// Of the trial step, and of the gradient step.
    length: f64,
    gradient_length: f64,
    /// <r, z> of the last iteration; `None` where there is no direction to go on from.
    product: Option<f64>,
    best: f64,
    stalled: usize,
    /// Steps since u was computed.
    rounding: usize,
    /// Whether the certified error is no more than its rounding.
    is_certain: bool,
    tensor: [f64; 3],
}

impl SlipSolver {
    pub(crate) fn new(grid: &Grid, boundary: Boundary, body: Cerruti) -> Self {
        let [dx, dy] = grid.spacing();
        let own = match grid.is_line() {
            true => dx,
            false => {
                let [xx, _, yy] = body.influence(0.0, 0.0, [dx, dy]);
                0.5 * (xx + yy)
            }
        };
        let none = || vec![[0.0; 2]; grid.len()];
        SlipSolver {
            operator: VectorConvolution::of(grid, boundary, body),
            inverse: VectorConvolution::approximate_inverse(grid, body),
            own,
            free: vec![Freedom::Fixed; grid.len()],
            residual: none(),
            last_residual: none(),
            preconditioned: none(),
            direction: none(),
            trial: none(),
            step: none(),
            image: none(),
        }
    }

    /// Solves the problem from the traction of `state`.
    ///
    /// # Errors
    /// [`Error::NotConverged`](crate::Error::NotConverged), [`Error::Interrupted`](crate::Error::Interrupted).
    pub(crate) fn solve(
        &mut self,
        problem: &SlipProblem<'_>,
        state: &mut Slip,
        (tolerance, most): (f64, usize),
        interrupt: Option<&AtomicBool>,
    ) -> Result<SlipOutcome> {
        let mut outcome = SlipOutcome::default();
        state.displacement = match problem.given {
            Given::Displacement(d) => d,
            Given::Sum(_) => [0.0; 2],
        };
        let [held] = sums(problem.radius, |radius| [radius]);
        if held == 0.0 {
            state.traction.fill([0.0; 2]);
            state.unit.fill([0.0; 2]);
            return Ok(outcome);
        }
        if let Given::Sum(sum) = problem.given
            && length(sum) >= held * (1.0 - SAME_LOAD)
        {
            self.slide(problem, state, times(1.0 / length(sum), sum));
            outcome.convolutions = 1;
            return Ok(outcome);
        }
        self.start(problem, state);
        self.convolve(state, &mut outcome);
        let gradient_length = 1.0 / (problem.compliance * self.own);
        let mut search = Search {
            length: FIRST_LENGTH,
            gradient_length,
            product: None,
            best: f64::INFINITY,
            stalled: 0,
            rounding: 0,
            is_certain: false,
            tensor: [0.0; 3],
        };
        loop {
            (outcome.residual, outcome.certificate, outcome.energy) =
                self.report(problem, state, &mut search);
            tracing::debug!(iterations = outcome.iterations, residual = outcome.residual, "slip");
            // Cells under next to no pressure may violate the conditions by more, where no digit of the certificate tells.
            let converged = outcome.residual <= tolerance || search.is_certain;
            if converged && search.is_precise(tolerance) {
                return Ok(outcome);
            }
            if outcome.iterations == most {
                let SlipOutcome { iterations, residual, certificate, .. } = outcome;
                let report = NotConverged::of("friction", iterations, residual, tolerance);
                return Err(NotConverged { certificate, ..report }.into());
            }
            stop_at(interrupt)?;
            if converged || search.rounding == REFRESH {
                self.convolve(state, &mut outcome);
                search.rounding = 0;
                continue;
            }
            search.count_stall(outcome.residual);
            let is_taken = search.stalled < PATIENCE && self.conjugate_step(problem, state, &mut search);
            if !is_taken && !self.gradient_step(problem, state, &mut search) {
                if search.rounding > 0 {
                    self.convolve(state, &mut outcome);
                    search.rounding = 0;
                    continue;
                }
                // Nothing but rounding is left.
                return Ok(outcome);
            }
            outcome.iterations += 1;
            outcome.convolutions += 1;
            search.rounding += 1;
        }
    }

    /// All cells at the limit, along the direction n of the force. Any d that pulls far enough fits: the least one.
    fn slide(&mut self, problem: &SlipProblem<'_>, state: &mut Slip, n: Vector) {
        let SlipProblem { compliance: c, offset, radius, .. } = *problem;
        each(&mut state.traction, radius, |q, radius| *q = times(radius, n));
        self.operator.apply_into(&state.traction, &mut state.unit);
        let across = [-n[1], n[0]];
        let cells = (&state.unit[..], offset, radius);
        let [aside, all] =
            sums(cells, |(u, b, radius)| [radius * inner(across, plus(times(c, u), b)), radius]);
        let Max(along) = sweep(cells, &|(u, b, radius): (&[Vector], &[Vector], &[f64])| {
            let moved = |k: usize| inner(n, plus(times(c, u[k]), b[k]));
            Max((0..u.len()).filter(|k| radius[*k] > 0.0).map(moved).fold(f64::NEG_INFINITY, f64::max))
        });
        state.displacement = plus(times(along, n), times(aside / all, across));
    }

    /// The traction of the last step, projected onto the discs of this one.
    fn start(&mut self, problem: &SlipProblem<'_>, state: &mut Slip) {
        self.trial.copy_from_slice(&state.traction);
        let shift = problem.shift(&self.trial).unwrap_or_default();
        each(&mut state.traction, (&self.trial[..], problem.radius), |q, (y, radius)| {
            *q = clip(plus(y, shift), radius);
        });
    }

    fn convolve(&mut self, state: &mut Slip, outcome: &mut SlipOutcome) {
        self.operator.apply_into(&state.traction, &mut state.unit);
        outcome.convolutions += 1;
    }

    /// Finds d, the freedom of the cells, and r on it. Returns residual, certificate and q c K q.
    fn report(
        &mut self,
        problem: &SlipProblem<'_>,
        state: &mut Slip,
        search: &mut Search,
    ) -> (f64, f64, f64) {
        let SlipProblem { compliance: c, offset, radius, .. } = *problem;
        let keeps_sum = matches!(problem.given, Given::Sum(_));
        let Slip { traction, unit, displacement } = state;
        let (q, u) = (&traction[..], &unit[..]);
        if keeps_sum {
            let [x, y, xx, xy, yy] = sums((q, radius, u, offset), |(q, radius, u, b)| {
                let free = Freedom::in_disc(q, radius);
                let ([x, y], [xx, xy, yy]) = (free.project(plus(times(c, u), b)), free.tensor());
                [x, y, xx, xy, yy]
            });
            // In a direction in which no cell is free to move d stays.
            let ridge = 1e-12 * (xx + yy);
            let kept = times(ridge, *displacement);
            *displacement = solve([xx + ridge, xy, yy + ridge], [x + kept[0], y + kept[1]]);
        }
        let d = *displacement;
        let (own, length_) = (c * self.own, search.gradient_length);
        let gradient = |u: Vector, b: Vector| minus(plus(times(c, u), b), d);
        each(&mut self.free, (q, radius, u, offset), |free, (q, radius, u, b)| {
            *free = Freedom::under(q, radius, gradient(u, b), own);
        });
        each(&mut self.residual, (u, offset, &self.free[..]), |r, (u, b, free)| {
            *r = free.project(gradient(u, b));
        });
        let [x, y, xx, xy, yy] = sums((&self.residual[..], &self.free[..]), |(r, free)| {
            let [xx, xy, yy] = free.tensor();
            [r[0], r[1], xx, xy, yy]
        });
        search.tensor = [xx, xy, yy];
        if keeps_sum {
            let mean = solve_with_ridge(search.tensor, [x, y]);
            each(&mut self.residual, &self.free[..], |r, free| *r = minus(*r, free.project(mean)));
        }
        // What a projected gradient step of the length of one cell would change.
        let cells = (q, radius, u, offset);
        let ([energy, force, defect, pulled, moved, all], Max(largest)) =
            sweep(cells, &|(q, radius, u, b): (&[Vector], &[f64], &[Vector], &[Vector])| {
                let largest = (0..q.len()).fold(0.0f64, |largest, n| {
                    let r = gradient(u[n], b[n]);
                    largest
                        .max(length(minus(clip(minus(q[n], times(length_, r)), radius[n]), q[n])) / length_)
                });
                let terms = strands(q.len(), |n| {
                    let r = gradient(u[n], b[n]);
                    let moved = radius[n] * length(plus(times(c, u[n]), b[n]));
                    [
                        c * inner(q[n], u[n]),
                        length(q[n]),
                        radius[n] * length(r) + inner(r, q[n]),
                        radius[n] * length(r),
                        moved,
                        radius[n],
                    ]
                });
                (terms, Max(largest))
            });
        // A small step on top of a large traction is solved as well as a large one.
        let level = if force > 0.0 { energy / force } else { 0.0 };
        let scale = level.min(STEPS * moved / all).max(problem.scale);
        let residual = if scale > 0.0 { largest / scale } else { 0.0 };
        search.is_certain = defect <= ROUNDING * pulled;
        let most = energy.max(problem.energy);
        let certificate = if most > 0.0 { (defect.max(0.0) / most).sqrt() } else { 0.0 };
        (residual, certificate, energy)
    }

    /// Along the preconditioned conjugate direction; false where f does not fall.
    fn conjugate_step(&mut self, problem: &SlipProblem<'_>, state: &mut Slip, search: &mut Search) -> bool {
        let keeps_sum = matches!(problem.given, Given::Sum(_));
        each(&mut self.image, (&self.residual[..], &self.free[..]), |w, (r, free)| *w = free.weigh(r));
        self.inverse.apply_into(&self.image, &mut self.preconditioned);
        each(&mut self.preconditioned, &self.free[..], |z, free| {
            *z = free.weigh(free.project(times(1.0 / problem.compliance, *z)));
        });
        Self::centre(&mut self.preconditioned, &self.free, search.tensor, keeps_sum);
        let cells = (&self.residual[..], &self.last_residual[..], &self.preconditioned[..]);
        let [product, overlap] = sums(cells, |(r, last, z)| [inner(r, z), inner(last, z)]);
        if product.is_nan() || product <= 0.0 {
            return false;
        }
        let beta = search.product.map_or(0.0, |last| ((product - overlap) / last).max(0.0));
        search.product = Some(product);
        each(&mut self.direction, (&self.preconditioned[..], &self.free[..]), |d, (z, free)| {
            *d = free.project(plus(z, times(beta, *d)));
        });
        Self::centre(&mut self.direction, &self.free, search.tensor, keeps_sum);
        let step = search.length;
        let cells = (&state.traction[..], &self.direction[..], &self.free[..], problem.radius);
        each(&mut self.trial, cells, |y, (q, d, free, radius)| {
            *y = minus(free.snap(q, radius), times(step, d));
        });
        let Some((slope, clipped)) = self.find_step(problem, state) else { return false };
        let Some(best) = self.minimum(problem, slope) else { return false };
        let along = if clipped {
            search.length *= best.clamp(0.3, 1.5);
            if best >= 0.8 { 1.0 } else { best }
        } else {
            search.length *= best;
            best.min(self.reach(problem, state))
        };
        self.advance(problem, state, along);
        true
    }

    /// Along the projected gradient; false where f does not fall.
    fn gradient_step(&mut self, problem: &SlipProblem<'_>, state: &mut Slip, search: &mut Search) -> bool {
        let SlipProblem { compliance: c, offset, .. } = *problem;
        let (step, d) = (search.gradient_length, state.displacement);
        let cells = (&state.traction[..], &state.unit[..], offset);
        each(&mut self.trial, cells, |y, (q, u, b)| {
            *y = minus(q, times(step, minus(plus(times(c, u), b), d)));
        });
        (search.product, search.stalled) = (None, 0);
        let Some((slope, _)) = self.find_step(problem, state) else { return false };
        let Some(best) = self.minimum(problem, slope) else { return false };
        let cells = (&self.step[..], &self.image[..]);
        let [square, curvature] = sums(cells, |(s, image)| [inner(s, s), c * inner(s, image)]);
        search.gradient_length = square / curvature;
        self.advance(problem, state, best.min(1.0));
        true
    }

    /// v less its mean over the free directions, where the sum is kept.
    fn centre(v: &mut [Vector], free: &[Freedom], tensor: [f64; 3], keeps_sum: bool) {
        if keeps_sum {
            let sum = sums(&*v, |v| v);
            let mean = solve_with_ridge(tensor, sum);
            each(v, free, |v, free| *v = minus(*v, free.project(mean)));
        }
    }

    /// Writes the step to the projection of the trial point; returns <r, s> and whether a cell was clipped; `None` where f does not
    /// fall.
    fn find_step(&mut self, problem: &SlipProblem<'_>, state: &Slip) -> Option<(f64, bool)> {
        let SlipProblem { compliance: c, offset, radius, .. } = *problem;
        let shift = problem.shift(&self.trial)?;
        let d = state.displacement;
        let cells = (&state.traction[..], &self.trial[..], radius);
        each(&mut self.step, cells, |s, (q, y, radius)| *s = minus(clip(plus(y, shift), radius), q));
        let cells = (&self.step[..], &state.unit[..], offset, &self.trial[..], radius);
        let [slope, clipped] = sums(cells, |(s, u, b, y, radius)| {
            let outside = length(plus(y, shift)) > radius && radius > 0.0;
            [inner(s, minus(plus(times(c, u), b), d)), f64::from(u8::from(outside))]
        });
        (slope < 0.0).then_some((slope, clipped > 0.0))
    }

    /// How far f falls along the step; computes its image.
    fn minimum(&mut self, problem: &SlipProblem<'_>, slope: f64) -> Option<f64> {
        self.operator.apply_into(&self.step, &mut self.image);
        let [curvature] = sums((&self.step[..], &self.image[..]), |(s, image)| [inner(s, image)]);
        let best = -slope / (problem.compliance * curvature);
        // A uniform traction on a periodic body meets no resistance.
        Some(if curvature > 0.0 { best } else { f64::INFINITY }).filter(|best| !best.is_nan())
    }

    /// The largest multiple of the step that stays in all discs.
    fn reach(&self, problem: &SlipProblem<'_>, state: &Slip) -> f64 {
        let cells = (&state.traction[..], &self.step[..], problem.radius);
        let Min(reach) = sweep(cells, &|(q, s, radius): (&[Vector], &[Vector], &[f64])| {
            Min((0..q.len()).fold(f64::INFINITY, |reach, n| {
                let (ss, qs) = (inner(s[n], s[n]), inner(q[n], s[n]));
                let room = radius[n] * radius[n] - inner(q[n], q[n]);
                if ss == 0.0 {
                    reach
                } else {
                    smaller(((qs * qs + ss * room.max(0.0)).sqrt() - qs) / ss, reach)
                }
            }))
        });
        reach.max(1.0)
    }

    /// q += t s, U += t K s.
    fn advance(&mut self, problem: &SlipProblem<'_>, state: &mut Slip, t: f64) {
        each(&mut state.traction, (&self.step[..], problem.radius), |q, (s, radius)| {
            *q = clip(plus(*q, times(t, s)), radius);
        });
        each(&mut state.unit, &self.image[..], |u, image| *u = plus(*u, times(t, image)));
        std::mem::swap(&mut self.residual, &mut self.last_residual);
    }
}

impl SlipProblem<'_> {
    /// What moves a trial point to one whose projection has the given sum.
    fn shift(&self, trial: &[Vector]) -> Option<Vector> {
        match self.given {
            Given::Sum(sum) => shift_to_sum(trial, self.radius, sum),
            Given::Displacement(_) => Some([0.0; 2]),
        }
    }
}

impl Search {
    /// Whether the roundings of the steps since u was computed matter less than a hundredth of the tolerance.
    fn is_precise(&self, tolerance: f64) -> bool {
        f64::EPSILON * self.rounding as f64 <= 0.01 * tolerance
    }

    fn count_stall(&mut self, residual: f64) {
        if residual < 0.5 * self.best {
            (self.best, self.stalled) = (residual, 0);
        } else {
            self.stalled += 1;
        }
    }
}

/// T x = b, where T may be singular in a direction in which b is 0.
fn solve_with_ridge([xx, xy, yy]: [f64; 3], b: Vector) -> Vector {
    let ridge = 1e-12 * (xx + yy);
    if ridge > 0.0 { solve([xx + ridge, xy, yy + ridge], b) } else { [0.0; 2] }
}
