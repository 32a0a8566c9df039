//! One elastic contact: the convex problem inside every time step.
//!
//! Find 0 <= p <= H minimising f(p) = p'(cK)p/2 + h'p, with the sum of p given (load control) or
//! minus w sum p (approach control). Its optimality conditions are the contact conditions on the gap
//! g = cKp + h - w: p = 0 where g >= 0, 0 < p < H where g = 0, p = H where g <= 0. The solution is
//! unique. This module knows neither time nor material: c is a number, h a field.
//!
//! Two methods: [`ProjectedCg`] (default) and [`PolonskyKeer`] (SC17's, corrected).

mod bounds;
mod certificate;
mod coarse;
mod direction;
mod polonsky_keer;
mod problem;
mod projected_cg;
mod projection;
mod residual;
mod search;
mod start;
mod state;
mod step;
mod sweeps;
mod workspace;

pub use bounds::Hardness;
pub use polonsky_keer::PolonskyKeer;
pub(crate) use problem::SAME_LOAD;
pub use problem::{Prescribed, Problem};
pub(crate) use start::Start;
pub use state::ContactState;
pub use workspace::ProjectedCg;

use std::sync::atomic::{AtomicBool, Ordering};

use crate::error::{Error, NotConverged, Result, require};
use crate::grid::{Boundary, Grid};
use crate::operator::Operator;
use asperity_sweep::sum;

/// The solver of the contact problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Method {
    /// Preconditioned projected conjugate gradients, one convolution per iteration.
    #[default]
    ProjectedCg,
    /// Polonsky & Keer (Wear 231, 1999) with a pressure cut-off, SC17 section 3 as corrected.
    PolonskyKeer,
}

/// When and how to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverOptions {
    /// The method; default [`Method::ProjectedCg`].
    pub method: Method,
    /// Largest violation of the contact conditions, relative to the pressure-weighted mean
    /// displacement; default 1e-6.
    pub tolerance: f64,
    /// Iterations after which a solve is given up; default 5000.
    pub max_iterations: usize,
}

impl Default for SolverOptions {
    fn default() -> Self {
        SolverOptions { method: Method::default(), tolerance: 1e-6, max_iterations: 5000 }
    }
}

impl SolverOptions {
    /// Checks the ranges.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the tolerance is not in \[1e-14, 0.1\] or no iteration is allowed.
    pub fn validate(&self) -> Result<()> {
        let within = (1e-14..=0.1).contains(&self.tolerance);
        require(within, "solver tolerance", self.tolerance, "between 1e-14 and 0.1")?;
        require(self.max_iterations > 0, "largest number of iterations", 0, "at least 1")
    }
}

/// What a solve did and how good its result is.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Outcome {
    /// Iterations.
    pub iterations: usize,
    /// Applications of K; one on a coarser grid counts by its share of cells.
    pub convolutions: usize,
    /// Largest violation of the contact conditions over the pressure-weighted mean displacement.
    pub residual: f64,
    /// sqrt(Gamma / p'u), a bound of |p - p*|_K / |p|_K: the certified relative energy-norm error.
    pub certificate: f64,
    /// Every touching cell is at the hardness: the approach is only bounded from below.
    pub saturated: bool,
}

impl Outcome {
    /// That of a further solve of the same row: its work adds up.
    pub(crate) fn then(self, next: Outcome) -> Outcome {
        Outcome {
            iterations: self.iterations + next.iterations,
            convolutions: self.convolutions + next.convolutions,
            ..next
        }
    }
}

impl NotConverged {
    /// How good the state is where the solve stopped.
    pub(crate) fn outcome(&self) -> Outcome {
        let NotConverged { iterations, residual, certificate, .. } = *self;
        Outcome { iterations, residual, certificate, ..Outcome::default() }
    }
}

/// A contact solver with its own working memory. What one solve finds does not depend on the solves before it.
pub enum Solver {
    /// Preconditioned projected conjugate gradients. Planned in the first solve that needs it: until then the coarser grids
    /// of a cold start have the memory.
    ProjectedCg(Option<Box<ProjectedCg>>),
    /// Polonsky & Keer.
    PolonskyKeer(Box<PolonskyKeer>),
}

impl Solver {
    /// A solver for the operator's grid.
    pub fn new(method: Method, operator: &dyn Operator) -> Self {
        match method {
            Method::ProjectedCg => Solver::ProjectedCg(None),
            Method::PolonskyKeer => Solver::PolonskyKeer(Box::new(PolonskyKeer::new(operator.grid()))),
        }
    }

    /// Bytes that a solver takes at most, without the operator.
    pub fn bytes(method: Method, grid: &Grid, boundary: Boundary) -> usize {
        match method {
            Method::ProjectedCg => ProjectedCg::bytes(grid, boundary),
            Method::PolonskyKeer => PolonskyKeer::bytes(grid),
        }
    }

    /// Solves `problem`, starting from the pressure in `state`, which becomes the solution; where that is zero
    /// everywhere, [`Method::ProjectedCg`] starts from the contact on coarser grids.
    ///
    /// # Errors
    /// [`Error::Infeasible`] where W > H times the area that can touch, [`Error::Undetermined`] where
    /// an approach closes a periodic gap, [`Error::Invalid`] for a negative load,
    /// [`Error::NotConverged`] (the state then holds the best pressure), [`Error::Interrupted`].
    pub fn solve(
        &mut self,
        operator: &mut dyn Operator,
        problem: &Problem,
        options: &SolverOptions,
        state: &mut ContactState,
        interrupt: Option<&AtomicBool>,
    ) -> Result<Outcome> {
        self.solve_from(Start::Pressure, Task { operator, problem, options, state, interrupt })
    }

    /// See [`Self::solve`]. Polonsky and Keer's method computes U afresh.
    pub(crate) fn solve_from(&mut self, start: Start, mut task: Task) -> Result<Outcome> {
        if let Some(outcome) = task.problem.trivial_solution(task.operator, task.state)? {
            return Ok(outcome);
        }
        match self {
            Solver::ProjectedCg(solver) => {
                let cold = matches!(start, Start::Pressure) && sum(&task.state.pressure) <= 0.0;
                let before = if cold { coarse::start(&mut task)? } else { 0.0 };
                let solver = solver.get_or_insert_with(|| Box::new(ProjectedCg::new(task.operator)));
                let outcome = solver.solve(start, task)?;
                Ok(Outcome { convolutions: outcome.convolutions + before.ceil() as usize, ..outcome })
            }
            Solver::PolonskyKeer(solver) => solver.solve(task),
        }
    }
}

/// One contact to solve: on which operator, what is asked, how precisely, from which state, which becomes the solution, and what stops
/// it early.
pub(crate) struct Task<'a> {
    pub(crate) operator: &'a mut dyn Operator,
    pub(crate) problem: &'a Problem<'a>,
    pub(crate) options: &'a SolverOptions,
    pub(crate) state: &'a mut ContactState,
    pub(crate) interrupt: Option<&'a AtomicBool>,
}

/// How far a state with this pressure and this U, of whatever operator, is from the contact of `problem`; sets its approach. The
/// certificate holds for every operator with a positive symmetric part.
pub(crate) fn assess(problem: &Problem, grid: &Grid, tolerance: f64, state: &mut ContactState) -> Outcome {
    state.approach = residual::find_approach(problem, state);
    let report = residual::ResidualReport::of(problem, state, state.approach);
    report.outcome(problem, grid, tolerance)
}

/// Clips a pressure to its bounds and gives it the load of `problem` again.
///
/// # Errors
/// [`Error::Infeasible`].
pub(crate) fn make_feasible(problem: &Problem, grid: &Grid, state: &mut ContactState) -> Result<()> {
    let mut touchable = vec![0; grid.len().div_ceil(8)];
    start::make_feasible(problem, grid.cell_area(), state, &mut touchable)
}

/// The error of a solve that stopped early.
pub(crate) fn not_converged(
    method: &'static str,
    options: &SolverOptions,
    outcome: &Outcome,
) -> NotConverged {
    let Outcome { iterations, residual, certificate, .. } = *outcome;
    NotConverged { certificate, ..NotConverged::of(method, iterations, residual, options.tolerance) }
}

/// [`Error::Interrupted`] where somebody asked to stop.
pub(crate) fn stop_at(interrupt: Option<&AtomicBool>) -> Result<()> {
    match interrupt.is_some_and(|flag| flag.load(Ordering::Relaxed)) {
        true => Err(Error::Interrupted),
        false => Ok(()),
    }
}
