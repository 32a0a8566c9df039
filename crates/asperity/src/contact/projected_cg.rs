//! Preconditioned projected conjugate gradients, one convolution per iteration.
//!
//! Each iteration takes a preconditioned conjugate direction d on the working set S (the free cells
//! and those that must leave their bound), projects the step p - a d back into \[0, H\] with the load
//! kept, and minimises f exactly along the segment from p to the projected point. f falls
//! monotonically. Where the residual fails to halve in ten iterations, a projected-gradient step with
//! exact minimisation is taken instead: by the spacer-step theorem (Luenberger & Ye, Linear and
//! Nonlinear Programming, section 7.11) the method converges from any start.
//!
//! The preconditioner (`preconditioner`) and the direction are f32, in units of the largest violation: they decide where to
//! go, never what is found there. In mixed precision the image K s of a step is f32 as well: p and U are f64, and what such
//! images leave in U (`roundings`) is found afresh before it is seen.
//!
//! Where the march knows U of its guess, for it is a combination of solutions, no convolution comes before the first iteration.
//! Such a guess lies beyond its bounds here and there: the first step is then taken whole, which ends at a feasible
//! pressure, whatever it does to f.
//!
//! An iteration is one convolution, whose rows take the state with them (`motion`), the preconditioner, and a few sweeps: one
//! that rates the state and finds S (`working`), the others over the groups of cells that hold one of S (`direction`,
//! `shift`). The approach w that the rating wants is the mean gap over the free cells, which the moving rows have summed.

use std::sync::atomic::AtomicBool;

use asperity_convolution::lanes::Sums;

use super::direction::{Ahead, Products, Turn, centre, products, steepest, turn};
use super::lengths::Lengths;
use super::motion::{Course, Landing, Passage, travel};
use super::preconditioner::Preconditioner;
use super::residual::Rating;
use super::roundings::Roundings;
use super::scalar::Scalar;
use super::shift::{Shift, Trial};
use super::start::{FreeGap, Start, make_feasible};
use super::working::find_working;
use super::{
    ContactState, Outcome, Precision, Prescribed, Problem, SolverOptions, interrupted, not_converged,
};
use crate::error::{Error, Result};
use crate::field::zeros;
use crate::grid::{Boundary, Grid};
use crate::operator::Operator;

/// Iterations without a halving of the residual before a spacer step.
const PATIENCE: usize = 10;
/// A clipped step is taken whole where the exact minimum lies beyond this share of it.
const WHOLE: f64 = 0.8;
/// How often, and by how much, a step is taken shorter where its load is lost in its rounding.
const SHORTER: (usize, f64) = (8, 1e-3);
/// The share of the largest violation by which the approach that a state is rated with may be wrong.
const ASTRAY: f64 = 0.02;
/// The share of the gap below which violations are to be measured in the largest of them, for f32 to hold their squares.
const FAINT: f64 = 1e-8;
/// The share of the largest violation below which the mean of the residual over S is left in it.
const CENTRED: f64 = 1e-4;

/// The method's working memory: 16 bytes per cell, sets of one bit, and the preconditioner.
pub struct ProjectedCg {
    precision: Precision,
    preconditioner: Preconditioner,
    /// Residual on S with its mean removed, in units of `unit`, now and one iteration ago.
    residual: Vec<f32>,
    previous: Vec<f32>,
    /// Preconditioned residual.
    image: Vec<f32>,
    /// Search direction d on S.
    direction: Vec<f32>,
    /// S of the residual now and one iteration ago: outside the latter the direction is zero.
    working: Vec<u8>,
    worked: Vec<u8>,
    pub(super) lengths: Lengths,
    /// That of a step of steepest descent \[Pa/m\].
    gradient_length: f64,
    /// Taken in this solve.
    convolutions: usize,
    /// Of U of the last solution.
    pub(super) roundings: Roundings,
}

/// What is asked for.
#[derive(Clone, Copy)]
struct Task<'a> {
    problem: &'a Problem<'a>,
    options: SolverOptions,
    interrupt: Option<&'a AtomicBool>,
}

/// What a conjugate step needs from the one before.
struct Conjugacy {
    /// <z, r> of the last step; `None` restarts.
    product: Option<f64>,
    /// Units of the last residual \[m\] and the last direction \[Pa\].
    unit: f64,
    pressure: f64,
}

/// The step to take.
struct Step {
    kind: Kind,
    /// a, in units of the direction, and the shift.
    length: f64,
    shift: Shift,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// s = -a d.
    Straight,
    /// s leads to the projection of p - a d.
    Clipped,
    /// s leads to the projection of p - b r.
    Gradient,
}

impl ProjectedCg {
    /// Plans the method for a grid and what surrounds it.
    pub fn new(grid: &Grid, boundary: Boundary, precision: Precision) -> Self {
        let n = grid.len();
        ProjectedCg {
            precision,
            preconditioner: Preconditioner::new(grid, boundary),
            residual: zeros(n),
            previous: zeros(n),
            image: zeros(n),
            direction: zeros(n),
            working: zeros(n.div_ceil(8)),
            worked: zeros(n.div_ceil(8)),
            lengths: Lengths::default(),
            gradient_length: 0.0,
            convolutions: 0,
            roundings: Roundings::of_convolution(),
        }
    }

    /// z, roughly the inverse of K restricted to a set of cells (bits, eight in a byte) times r, which is zero elsewhere; in
    /// units of the preconditioner's largest value. What is beyond the set means nothing. One iteration takes it once.
    pub fn precondition(&mut self, r: &[f32], set: &[u8], z: &mut [f32]) {
        self.preconditioner.apply_into(r, set, z, &|_, _| Sums::default());
    }

    /// See [`super::Solver::solve`]; the trivial cases are settled there.
    pub(super) fn solve(
        &mut self,
        start: Start,
        operator: &mut dyn Operator,
        problem: &Problem,
        options: &SolverOptions,
        state: &mut ContactState,
        interrupt: Option<&AtomicBool>,
    ) -> Result<Outcome> {
        let task = Task { problem, options: *options, interrupt };
        self.convolutions = 0;
        if let Start::Known { roundings, beyond, gap } = start {
            self.roundings = roundings;
            match self.iterate(operator, task, state, beyond, gap) {
                // It leads nowhere.
                Err(Error::NotConverged(report)) if report.iterations == 0 => {}
                solved => return solved,
            }
        }
        make_feasible(problem, operator.grid().cell_area(), state, &mut self.working)?;
        self.roundings = Roundings::of_convolution();
        self.convolve(operator, state);
        self.iterate(operator, task, state, false, None)
    }

    /// Finds U afresh.
    fn convolve(&mut self, operator: &mut dyn Operator, state: &mut ContactState) {
        operator.apply_into(&state.pressure, &mut state.unit_displacement);
        self.convolutions += 1;
        self.roundings = self.roundings.afresh();
    }

    /// Iterates from a state whose U is known; its pressure may lie `beyond` its bounds. Its free gap is known or not.
    fn iterate(
        &mut self,
        operator: &mut dyn Operator,
        task: Task,
        state: &mut ContactState,
        beyond: bool,
        gap: Option<FreeGap>,
    ) -> Result<Outcome> {
        match self.precision {
            Precision::Double => self.iterate_in::<f64>(operator, task, state, beyond, gap),
            Precision::Mixed => self.iterate_in::<f32>(operator, task, state, beyond, gap),
        }
    }

    fn iterate_in<T: Scalar>(
        &mut self,
        operator: &mut dyn Operator,
        task: Task,
        state: &mut ContactState,
        mut beyond: bool,
        gap: Option<FreeGap>,
    ) -> Result<Outcome> {
        let Task { problem, options, interrupt } = task;
        let grid = *operator.grid();
        self.lengths.begin();
        // Whatever an earlier solve left behind is overwritten, everywhere.
        self.working.fill(u8::MAX);
        self.worked.fill(u8::MAX);
        self.gradient_length = 1.0 / (problem.compliance * operator.self_influence());
        let mut conjugacy = Conjugacy { product: None, unit: 0.0, pressure: 0.0 };
        let (mut best, mut stall, mut stuck) = (f64::INFINITY, 0, false);
        let mut iteration = 0;
        let (mut rating, mut unit) = match gap {
            Some(FreeGap { mean, size }) => {
                let w = problem.prescribed.approach().unwrap_or(mean);
                let found = (&mut self.residual[..], &mut self.working[..]);
                let rating = find_working(problem, state, (w, size), beyond, found);
                (rating, if rating.violation() < FAINT * size { 0.0 } else { size })
            }
            // Only to find the approach. No guess from the state: it would leave its rounding.
            None => (Rating::of(problem, state, 0.0), 0.0),
        };
        loop {
            let w = rating.approach(problem.prescribed);
            if unit == 0.0 || (w - rating.w).abs() > ASTRAY * rating.violation() {
                unit = if rating.violation() > 0.0 { rating.violation() } else { 1.0 };
                let found = (&mut self.residual[..], &mut self.working[..]);
                rating = find_working(problem, state, (w, unit), beyond, found);
            }
            state.approach = rating.approach(problem.prescribed);
            let rated = rating.rate(problem, &grid, options.tolerance);
            let outcome = Outcome { iterations: iteration, convolutions: self.convolutions, ..rated };
            if !beyond && (outcome.residual <= options.tolerance || stuck) {
                if !self.roundings.are_small(options.tolerance) && !self.roundings.are_least() {
                    self.convolve(operator, state);
                    (stuck, unit, conjugacy.product) = (false, 0.0, None);
                    rating = Rating::of(problem, state, 0.0);
                    continue;
                }
                if outcome.residual <= options.tolerance {
                    return Ok(outcome);
                }
            }
            if stuck || iteration == options.max_iterations {
                return Err(not_converged("projected-cg", &options, &outcome));
            }
            if interrupted(interrupt) {
                return Err(Error::Interrupted);
            }
            if beyond {
                // What it says is of no pressure that is allowed.
            } else if outcome.residual < 0.5 * best {
                best = outcome.residual;
                stall = 0;
            } else {
                stall += 1;
            }

            let sum = match problem.prescribed {
                Prescribed::Load(load) => Some(load / grid.cell_area() - rating.pressure()),
                Prescribed::Approach(_) => None,
            };
            let conjugate = if stall >= PATIENCE || rating.nothing_works() {
                None
            } else {
                self.conjugate_step(problem, state, sum, &rating, unit, &mut conjugacy)
            };
            let w = rating.w;
            let mut take = |this: &mut Self, state: &mut ContactState, step| {
                this.take::<T>(operator, problem, state, step, (unit, w), beyond)
            };
            let mut landing = conjugate.and_then(|step| take(self, state, step));
            if landing.is_none() {
                conjugacy.product = None;
                stall = 0;
                let length = self.gradient_length;
                let steepest = self.gradient_step(problem, state, sum, &rating, unit, length);
                landing = steepest.and_then(|step| take(self, state, step));
            }
            let Some(landing) = landing else {
                // Nothing descends any more: rounding has the last word.
                stuck = true;
                continue;
            };
            let w = problem.prescribed.approach().or(landing.free_gap).unwrap_or(rating.w);
            // Residuals are measured in the largest violation of the iteration before.
            unit = rating.violation();
            std::mem::swap(&mut self.residual, &mut self.previous);
            std::mem::swap(&mut self.working, &mut self.worked);
            beyond = false;
            let found = (&mut self.residual[..], &mut self.working[..]);
            rating = find_working(problem, state, (w, unit), beyond, found);
            let grown = problem.compliance * landing.change;
            self.roundings = self.roundings.with_step(grown / rating.displacement(problem), T::EPSILON);
            iteration += 1;
        }
    }

    /// Takes a step as far as f falls along it, one convolution; `None` where it does not descend, unless it is taken from
    /// `beyond` the bounds. The residual is in that unit and for that approach.
    fn take<T: Scalar>(
        &mut self,
        operator: &mut dyn Operator,
        problem: &Problem,
        state: &mut ContactState,
        step: Step,
        (unit, w): (f64, f64),
        beyond: bool,
    ) -> Option<Landing> {
        self.convolutions += 1;
        let ProjectedCg { lengths, gradient_length, residual, direction, working, .. } = self;
        let mut settle = |passage: Passage| {
            let slope = unit * passage.slope;
            if !(slope < 0.0 || beyond && slope.is_finite()) || !passage.curvature.is_finite() {
                return None;
            }
            let curvature = problem.compliance * passage.curvature;
            let exact = if curvature > 0.0 { -slope / curvature } else { 1.0 };
            Some(match step.kind {
                _ if beyond => {
                    if step.kind != Kind::Gradient && slope < 0.0 {
                        lengths.learn(false, exact);
                    }
                    1.0
                }
                Kind::Straight => {
                    lengths.learn(true, exact);
                    exact.min(passage.reach)
                }
                Kind::Clipped => {
                    lengths.learn(false, exact);
                    if exact >= WHOLE { 1.0 } else { exact }
                }
                Kind::Gradient => {
                    if curvature > 0.0 {
                        *gradient_length = passage.square / curvature;
                    }
                    exact.min(1.0)
                }
            })
        };
        let course = Course {
            direction,
            set: working,
            hardness: problem.hardness,
            length: step.length,
            shift: step.shift,
            beyond_end: step.kind == Kind::Straight,
        };
        travel::<T>(operator, problem, state, (course, residual), w, &mut settle)
    }

    /// The conjugate step on S; `None` where it does not descend.
    fn conjugate_step(
        &mut self,
        problem: &Problem,
        state: &ContactState,
        sum: Option<f64>,
        rating: &Rating,
        unit: f64,
        conjugacy: &mut Conjugacy,
    ) -> Option<Step> {
        let cells = rating.working_cells();
        let mean_r = if sum.is_some() { rating.working_mean() / unit } else { 0.0 };
        let centred = mean_r.abs() > CENTRED * rating.violation() / unit;
        if centred {
            centre(&mut self.residual, &self.working, mean_r);
        }
        let left_behind = [&self.residual[..], &self.previous, &self.direction];
        let set = &self.working;
        let visit = |first: usize, z: &[f32]| products(first, z, left_behind, set);
        let sums = self.preconditioner.apply_into(&self.residual, set, &mut self.image, &visit);
        let sums = Products::of(sums);

        // <z - mean z, r>, and the same with the residual before; each in its units.
        let mean_z = if sum.is_some() { sums.z / cells } else { 0.0 };
        let left = if centred { 0.0 } else { mean_r * cells };
        let pressure = self.preconditioner.sharpest * unit / problem.compliance;
        let product = pressure * unit * (sums.zr - mean_z * left);
        if product <= 0.0 || product.is_nan() {
            return None;
        }
        let unlike = pressure * conjugacy.unit * (sums.z_old - mean_z * sums.r_old);
        let beta = match conjugacy.product {
            Some(last) => ((product - unlike) / last).max(0.0) * conjugacy.pressure / pressure,
            None => 0.0,
        };
        *conjugacy = Conjugacy { product: Some(product), unit, pressure };

        let mean = mean_z + if sum.is_some() { beta * sums.d_old / cells } else { 0.0 };
        let length = self.lengths.next() * pressure;
        let ahead = turn(
            &mut self.direction,
            &self.image,
            (&self.working, &self.worked),
            &state.pressure,
            problem.hardness,
            Turn { mean, beta, length },
        );
        let kind = if ahead.outside > 0.0 { Kind::Clipped } else { Kind::Straight };
        self.shifted(problem, state, sum, ahead, (kind, length))
    }

    /// The projected-gradient step over all cells that can touch; `None` where it does not descend.
    fn gradient_step(
        &mut self,
        problem: &Problem,
        state: &ContactState,
        sum: Option<f64>,
        rating: &Rating,
        unit: f64,
        length: f64,
    ) -> Option<Step> {
        let length = length * unit;
        let found = (&mut self.direction[..], &mut self.residual[..], &mut self.working[..]);
        // The direction is written everywhere.
        self.worked.fill(u8::MAX);
        let ahead = steepest(problem, state, rating.w, unit, length, found);
        self.shifted(problem, state, sum, ahead, (Kind::Gradient, length))
    }

    /// The step from the trial point; `None` where no shift keeps the load. `sum` is the sum of p that load control prescribes,
    /// less the present one.
    fn shifted(
        &self,
        problem: &Problem,
        state: &ContactState,
        sum: Option<f64>,
        ahead: Ahead,
        (mut kind, mut length): (Kind, f64),
    ) -> Option<Step> {
        let Some(missing) = sum else {
            return Some(Step { kind, length, shift: Shift::default() });
        };
        let mut clipped = Some(ahead.clipped);
        for _ in 0..SHORTER.0 {
            let trial = trial(problem, state, &self.direction, &self.working, length);
            if let Some(shift) = trial.shift_to_sum(ahead.pressure + missing, clipped.take()) {
                return Some(Step { kind, length, shift });
            }
            length *= SHORTER.1;
            if kind == Kind::Straight {
                kind = Kind::Clipped;
            }
        }
        None
    }
}

/// The trial point at that length along the direction.
fn trial<'a>(
    problem: &Problem<'a>,
    state: &'a ContactState,
    direction: &'a [f32],
    set: &'a [u8],
    length: f64,
) -> Trial<'a> {
    Trial { pressure: &state.pressure, direction: Some(direction), set, length, hardness: problem.hardness }
}
