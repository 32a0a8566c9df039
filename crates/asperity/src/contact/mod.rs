//! One elastic contact: the convex problem inside every time step.
//!
//! Find 0 <= p <= H minimising f(p) = p'(cK)p/2 + h'p, with the sum of p given (load control) or
//! minus w sum p (approach control). Its optimality conditions are the contact conditions on the gap
//! g = cKp + h - w: p = 0 where g >= 0, 0 < p < H where g = 0, p = H where g <= 0. The solution is
//! unique. This module knows neither time nor material: c is a number, h a field.
//!
//! Two methods: [`ProjectedCg`] (default) and [`PolonskyKeer`] (SC17's, corrected).

// The closures of a sweep spell out the slices that they walk.
#![allow(clippy::type_complexity)]

mod coarse;
mod direction;
mod gauss_seidel;
mod hardness;
mod lengths;
mod motion;
mod neighbours;
mod polonsky_keer;
mod preconditioner;
mod projected_cg;
mod residual;
mod roundings;
mod scalar;
mod shift;
mod start;
mod state;
mod torus;
mod working;

pub use gauss_seidel::gauss_seidel;
pub use hardness::Hardness;
pub(crate) use lengths::REMEMBERED;
pub use polonsky_keer::PolonskyKeer;
pub use projected_cg::ProjectedCg;
pub(crate) use roundings::Roundings;
pub(crate) use start::{FreeGap, MET, Start};
pub use state::ContactState;

use std::sync::atomic::AtomicBool;

use crate::error::{Error, NotConverged, Result};
use crate::field::{Max, sum, sweep};
use crate::grid::{Boundary, Grid};
use crate::operator::{Operator, half_space, half_space_with_single};

/// One elastic contact of unit operator K.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Undeformed gap h \[m\], nx ny cells; infinite where a cell cannot touch.
    pub gap: &'a [f64],
    /// Compliance c = 1/E* \[1/Pa\].
    pub compliance: f64,
    /// Cut-off H of the pressure.
    pub hardness: Hardness<'a>,
    /// What is given.
    pub prescribed: Prescribed,
}

/// The given quantity of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prescribed {
    /// Normal load W \[N\].
    Load(f64),
    /// Rigid-body approach w \[m\].
    Approach(f64),
}

impl Prescribed {
    /// w, where it is what is given.
    fn approach(self) -> Option<f64> {
        match self {
            Prescribed::Approach(w) => Some(w),
            Prescribed::Load(_) => None,
        }
    }
}

/// The solver of the contact problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Method {
    /// Preconditioned projected conjugate gradients, one convolution per iteration.
    #[default]
    ProjectedCg,
    /// Polonsky & Keer (Wear 231, 1999) with a pressure cut-off, SC17 section 3 as corrected.
    PolonskyKeer,
}

/// Floating-point numbers of the steps of a solve. Either way pressure and displacement are f64, and so are their residual
/// and certificate; the displacement is that of the pressure to a hundredth of the tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Precision {
    /// Every convolution in f64.
    #[default]
    Double,
    /// Convolutions of steps in f32, at half the cost; what they leave in the displacement is found afresh in f64 before it
    /// is seen. The same tolerance holds; the digits beyond it differ. For [`Method::ProjectedCg`].
    Mixed,
}

impl Precision {
    /// The operator of a grid and its boundary, with all that solves in this precision convolve with.
    pub fn half_space(self, grid: Grid, boundary: Boundary) -> Box<dyn Operator> {
        match self {
            Precision::Double => half_space(grid, boundary),
            Precision::Mixed => half_space_with_single(grid, boundary),
        }
    }
}

/// When and how to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolverOptions {
    /// The method; default [`Method::ProjectedCg`].
    pub method: Method,
    /// Floating-point numbers; default [`Precision::Double`].
    pub precision: Precision,
    /// Largest violation of the contact conditions, relative to the pressure-weighted mean
    /// displacement; default 1e-6.
    pub tolerance: f64,
    /// Iterations after which a solve is given up; default 5000.
    pub max_iterations: usize,
}

impl Default for SolverOptions {
    fn default() -> Self {
        SolverOptions {
            method: Method::default(),
            precision: Precision::default(),
            tolerance: 1e-6,
            max_iterations: 5000,
        }
    }
}

impl SolverOptions {
    /// Checks the ranges.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the tolerance is not in \[1e-14, 0.1\], no iteration is allowed, or the method has
    /// no mixed precision.
    pub fn validate(&self) -> Result<()> {
        if !(self.tolerance >= 1e-14 && self.tolerance <= 0.1) {
            return Err(Error::invalid("solver tolerance", self.tolerance, "between 1e-14 and 0.1"));
        }
        if (self.method, self.precision) == (Method::PolonskyKeer, Precision::Mixed) {
            return Err(Error::invalid(
                "solver precision",
                "mixed",
                "double with the method polonsky-keer (projected-cg has both)",
            ));
        }
        if self.max_iterations == 0 {
            return Err(Error::invalid("largest number of iterations", 0, "at least 1"));
        }
        Ok(())
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

/// A contact solver with its own working memory.
pub enum Solver {
    /// Preconditioned projected conjugate gradients.
    ProjectedCg(Box<ProjectedCg>),
    /// Polonsky & Keer.
    PolonskyKeer(Box<PolonskyKeer>),
}

impl Solver {
    /// Plans a solver in double precision for the operator's grid.
    pub fn new(method: Method, operator: &dyn Operator) -> Self {
        Solver::with_precision(method, Precision::Double, operator)
    }

    /// Plans a solver for the operator's grid. [`Method::PolonskyKeer`] knows double precision only.
    pub fn with_precision(method: Method, precision: Precision, operator: &dyn Operator) -> Self {
        let (grid, boundary) = (operator.grid(), operator.boundary());
        match method {
            Method::ProjectedCg => Solver::ProjectedCg(Box::new(ProjectedCg::new(grid, boundary, precision))),
            Method::PolonskyKeer => Solver::PolonskyKeer(Box::new(PolonskyKeer::new(grid))),
        }
    }

    /// Solves `problem`, starting from the pressure in `state`, which becomes the solution; where that is zero
    /// everywhere, [`Method::ProjectedCg`] starts from the contact on coarser grids. Otherwise it goes by the step lengths
    /// that its last solves found: digits beyond the tolerance depend on these.
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
        self.solve_from(Start::Guess, operator, problem, options, state, interrupt)
    }

    /// See [`Self::solve`]. Polonsky and Keer's method finds U anew.
    pub(crate) fn solve_from(
        &mut self,
        start: Start,
        operator: &mut dyn Operator,
        problem: &Problem,
        options: &SolverOptions,
        state: &mut ContactState,
        interrupt: Option<&AtomicBool>,
    ) -> Result<Outcome> {
        if let Some(outcome) = trivial(operator, problem, state)? {
            self.set_roundings(Roundings::of_convolution());
            return Ok(outcome);
        }
        let guessed = matches!((&*self, start), (Self::ProjectedCg(_), Start::Guess));
        let cold = guessed && sum(&state.pressure) <= 0.0;
        let before = if cold {
            self.remember([0.0; REMEMBERED]);
            coarse::start(operator, problem, options, state, interrupt)?
        } else {
            0.0
        };
        let outcome = match self {
            Solver::ProjectedCg(s) => s.solve(start, operator, problem, options, state, interrupt),
            Solver::PolonskyKeer(s) => s.solve(operator, problem, options, state, interrupt),
        }?;
        if cold {
            // What follows is near its solution, and unlike this.
            self.remember([0.0; REMEMBERED]);
        }
        Ok(Outcome { convolutions: outcome.convolutions + before.ceil() as usize, ..outcome })
    }
}

impl Solver {
    /// Step lengths that the next solve goes by, iteration by iteration; 0 for none.
    pub(crate) fn remembered(&self) -> [f64; REMEMBERED] {
        match self {
            Solver::ProjectedCg(s) => s.lengths.save(),
            Solver::PolonskyKeer(_) => [0.0; REMEMBERED],
        }
    }

    /// What U of the last solution may be off by, in roundings of a convolution.
    pub(crate) fn roundings(&self) -> f64 {
        match self {
            Solver::ProjectedCg(s) => s.roundings.here,
            Solver::PolonskyKeer(_) => f64::INFINITY,
        }
    }

    fn set_roundings(&mut self, roundings: Roundings) {
        match self {
            Solver::ProjectedCg(s) => s.roundings = roundings,
            Solver::PolonskyKeer(_) => {}
        }
    }

    /// Takes them from another solver.
    pub(crate) fn remember(&mut self, lengths: [f64; REMEMBERED]) {
        match self {
            Solver::ProjectedCg(s) => s.lengths.load(lengths),
            Solver::PolonskyKeer(_) => {}
        }
    }
}

/// The cases that need no iteration: no load, no touch, full saturation; and those without a solution.
fn trivial(
    operator: &mut dyn Operator,
    problem: &Problem,
    state: &mut ContactState,
) -> Result<Option<Outcome>> {
    let (first_touch, touchable, most) = problem.limits();
    match problem.prescribed {
        Prescribed::Load(load) => {
            if !(load >= 0.0 && load.is_finite()) {
                return Err(Error::invalid("load", format!("{load} N"), "finite and not negative"));
            }
            if load == 0.0 {
                state.lift_off(first_touch);
                return Ok(Some(Outcome::default()));
            }
            let max = most * operator.grid().cell_area();
            if load > max * (1.0 + 1e-12) || touchable == 0.0 {
                return Err(Error::Infeasible { load, max });
            }
            if load >= max * (1.0 - 1e-12) {
                let at_bound =
                    |n: usize, h: f64| if h < f64::INFINITY { problem.hardness.at(n) } else { 0.0 };
                let cells = state.pressure.iter_mut().zip(problem.gap).enumerate();
                cells.for_each(|(n, (p, h))| *p = at_bound(n, *h));
                operator.apply_into(&state.pressure, &mut state.unit_displacement);
                state.approach =
                    sweep((problem.gap, &state.unit_displacement[..]), &|(h, u): (&[f64], &[f64])| {
                        let cells = h.iter().zip(u).filter(|(h, _)| **h < f64::INFINITY);
                        Max(cells.fold(f64::NEG_INFINITY, |m, (h, u)| m.max(h + problem.compliance * u)))
                    })
                    .0;
                return Ok(Some(Outcome { convolutions: 1, saturated: true, ..Outcome::default() }));
            }
        }
        Prescribed::Approach(approach) => {
            if !approach.is_finite() {
                return Err(Error::invalid("approach", format!("{approach} m"), "finite"));
            }
            if approach <= first_touch {
                state.lift_off(approach);
                return Ok(Some(Outcome::default()));
            }
            if operator.boundary() == Boundary::Periodic && problem.hardness.is_infinite() {
                // K has no mean: full contact at the approach where the mean gap closes.
                // A cell that cannot touch makes the mean infinite, and every approach determined.
                let max = sum(problem.gap) / problem.gap.len() as f64;
                if approach >= max {
                    return Err(Error::Undetermined { approach, max });
                }
            }
        }
    }
    Ok(None)
}

/// The error of a solve that stopped early.
fn not_converged(method: &'static str, options: &SolverOptions, outcome: &Outcome) -> Error {
    Error::NotConverged(NotConverged {
        method,
        iterations: outcome.iterations,
        residual: outcome.residual,
        tolerance: options.tolerance,
        certificate: outcome.certificate,
        time: None,
    })
}

/// True where somebody asked to stop.
fn interrupted(interrupt: Option<&AtomicBool>) -> bool {
    interrupt.is_some_and(|flag| flag.load(std::sync::atomic::Ordering::Relaxed))
}
