//! The steady contact at one velocity, by the metric iteration and by continuation (see [`super`]).

use std::sync::atomic::AtomicBool;

use ndarray::Array2;

use super::operators::{Operators, Stream};
use crate::contact::{self, ContactState, Outcome, Problem, Solver, SolverOptions};
use crate::error::{Error, NotConverged, Result};
use crate::grid::{Boundary, Grid};
use crate::operator::Operator;
use crate::simulation::Simulation;
use asperity_sweep::zeros;

/// Metric steps without Newton's steps after some of those that were rejected, at most.
const SKIP: usize = 3;
/// Metric steps after which a contact is taken from easier ones.
const STEPS: usize = 60;
/// C0/C(∞) of the first of the easier bodies, from each to the next, and where even one as small as this took too many steps.
const EASY: f64 = 0.25;
const FALL: f64 = 1.0 / 3.0;
const LEAST_FALL: f64 = 0.9;
/// Exchanges of pivoting before an easier body is tried.
const PIVOTS: usize = 100;
/// Tolerance of the contacts on the way.
const ON_THE_WAY: f64 = 1e-3;

/// The contact of one velocity.
pub(super) struct SteadyContact<'a> {
    pub(super) grid: &'a Grid,
    pub(super) problem: Problem<'a>,
    pub(super) options: SolverOptions,
    pub(super) stream: Stream<'a>,
    pub(super) interrupt: Option<&'a AtomicBool>,
    /// Of the contact under way.
    pub(super) tolerance: f64,
    /// Iterations and convolutions until now, and the rating of the last state.
    pub(super) spent: Outcome,
    /// The kernel of the loss, of a free domain.
    loss: Option<Array2<f64>>,
}

/// The operators of one velocity, the solver of metric steps, and the fields of the iteration.
pub(super) struct Workspace {
    pub(super) operators: Operators,
    solver: Solver,
    pub(super) trial: ContactState,
    pub(super) best: ContactState,
    /// The gap of the metric step, and the image of the pressure.
    pub(super) work: [Vec<f64>; 2],
}

impl Workspace {
    fn plan(stream: &Stream, long: bool, interrupt: Option<&AtomicBool>) -> Result<Self> {
        let Simulation { grid, solver, .. } = stream.simulation;
        let operators = Operators::plan(stream, long, interrupt)?;
        Ok(Workspace {
            solver: Solver::new(solver.method, &*operators.metric),
            operators,
            trial: ContactState::new(grid.len()),
            best: ContactState::new(grid.len()),
            work: [zeros(grid.len()), zeros(grid.len())],
        })
    }
}

impl<'a> SteadyContact<'a> {
    pub(super) fn new(stream: Stream<'a>, problem: Problem<'a>, interrupt: Option<&'a AtomicBool>) -> Self {
        let Simulation { grid, solver: options, .. } = stream.simulation;
        let (options, tolerance) = (*options, options.tolerance);
        let spent = Outcome::default();
        SteadyContact { grid, problem, options, stream, interrupt, tolerance, spent, loss: None }
    }

    /// What a pressure loses per distance \[N\]; NaN where the operators could not be planned.
    pub(super) fn loss(&self, pressure: &[f64]) -> f64 {
        match (self.stream.simulation.boundary, &self.loss) {
            (Boundary::Free, None) => f64::NAN,
            (_, kernel) => self.stream.loss(pressure, kernel.as_ref()),
        }
    }

    /// Solves the contact from the pressure of `state`, which becomes the best one found.
    ///
    /// # Errors
    /// [`Error::NotConverged`], [`Error::Infeasible`], [`Error::Interrupted`].
    pub(super) fn solve(&mut self, state: &mut ContactState) -> Result<()> {
        let mut on = Workspace::plan(&self.stream, false, self.interrupt)?;
        self.loss = on.operators.loss.take();
        if self.iterate(&mut on, state)? {
            return Ok(());
        }
        drop(on);
        let found = self.continue_from_easier(state);
        if let Err(Error::NotConverged(_)) = found {
            // The pressure of an easier body is no contact of this one.
            let mut operators = Operators::plan(&self.stream, false, self.interrupt)?;
            operators.apply_into(&state.pressure, &mut state.unit_displacement);
            self.tolerance = self.options.tolerance;
            self.rate(state);
            return Err(self.not_converged());
        }
        found
    }

    /// Continuation in the instantaneous compliance: from a body that yields a quarter at once, on which the iteration contracts
    /// well, down to the body itself, each contact from the one before.
    fn continue_from_easier(&mut self, state: &mut ContactState) -> Result<()> {
        let streaming = self.stream.streaming;
        let own = streaming.instantaneous() / streaming.relaxed();
        let (mut solved, mut fall) = (None, FALL);
        let mut start = state.pressure.clone();
        loop {
            let at_once = solved.map_or(EASY, |at_once| fall * at_once).max(own);
            let easier = streaming.hastened((at_once - own) / (1.0 - own));
            let stream = Stream { streaming: &easier, ..self.stream };
            self.tolerance =
                if at_once > own { self.options.tolerance.max(ON_THE_WAY) } else { self.options.tolerance };
            let mut on = Workspace::plan(&stream, true, self.interrupt)?;
            // Newton's steps mostly find the contact; where they go round in circles, single exchanges end.
            let is_last = fall >= LEAST_FALL;
            let most = if is_last { usize::MAX } else { PIVOTS };
            let found = self.iterate(&mut on, state)? || self.pivot(&mut on, most, state)?;
            tracing::debug!(at_once, found, "continuation");
            if !found && is_last {
                return Err(self.not_converged());
            }
            if !found {
                fall = fall.sqrt();
                state.pressure.copy_from_slice(&start);
            } else if at_once <= own {
                return Ok(());
            } else {
                start.copy_from_slice(&state.pressure);
                solved = Some(at_once);
            }
        }
    }

    /// The metric iteration with Newton's steps. False where [`STEPS`] metric steps are not enough.
    fn iterate(&mut self, on: &mut Workspace, state: &mut ContactState) -> Result<bool> {
        self.begin(on, state)?;
        let (mut rejected, mut skip) = (0, 0);
        for _ in 0..=STEPS {
            on.operators.apply_into(&state.pressure, &mut state.unit_displacement);
            let residual = self.rate(state).residual;
            tracing::debug!(
                iterations = self.spent.iterations,
                residual,
                convolutions = self.spent.convolutions,
                rejected,
                "steady"
            );
            if residual <= self.tolerance {
                return Ok(true);
            }
            if self.spent.iterations >= self.options.max_iterations {
                return Err(self.not_converged());
            }
            self.metric_step(on, residual, state)?;
            if skip > 0 {
                skip -= 1;
                continue;
            }
            rejected = if self.newton(on, residual, state)? { 0 } else { rejected + 1 };
            skip = SKIP.min(rejected);
        }
        Ok(false)
    }

    /// p = the contact of M and the gap h + u - M p.
    fn metric_step(&mut self, on: &mut Workspace, residual: f64, state: &mut ContactState) -> Result<()> {
        let Workspace { operators, solver, work: [gap, image], .. } = on;
        operators.metric.apply_into(&state.pressure, image);
        let displacements = state.unit_displacement.iter().zip(&*image);
        for ((to, h), (u, mp)) in gap.iter_mut().zip(self.problem.gap).zip(displacements) {
            *to = h + self.problem.compliance * (u - mp);
        }
        let options = SolverOptions {
            tolerance: f64::max(0.1 * self.tolerance, 0.1 * residual).clamp(1e-13, 0.1),
            ..self.options
        };
        let problem = Problem { gap: &gap[..], ..self.problem };
        let (iterations, convolutions) =
            match solver.solve(&mut *operators.metric, &problem, &options, state, self.interrupt) {
                Ok(done) => (done.iterations, done.convolutions),
                Err(Error::NotConverged(report)) => (report.iterations, report.iterations),
                Err(error) => return Err(error),
            };
        self.spent.iterations += iterations + 1;
        self.spent.convolutions += convolutions + 1;
        Ok(())
    }

    /// Makes the pressure of the state feasible; where there is none, it is that of the contact of M.
    fn begin(&mut self, on: &mut Workspace, state: &mut ContactState) -> Result<()> {
        if state.pressure.iter().any(|p| *p > 0.0) {
            return contact::make_feasible(&self.problem, self.grid, state);
        }
        let rough = SolverOptions { tolerance: self.options.tolerance.max(1e-3), ..self.options };
        let metric = &mut *on.operators.metric;
        let outcome = on.solver.solve(metric, &self.problem, &rough, state, self.interrupt)?;
        self.spent.iterations += outcome.iterations;
        self.spent.convolutions += outcome.convolutions;
        Ok(())
    }

    /// Rates a state whose U was just computed.
    pub(super) fn rate(&mut self, state: &mut ContactState) -> Outcome {
        let rated = contact::assess(&self.problem, self.grid, self.tolerance, state);
        let Outcome { iterations, convolutions, .. } = self.spent;
        self.spent = Outcome { iterations, convolutions: convolutions + 1, ..rated };
        self.spent
    }

    fn not_converged(&self) -> Error {
        let report = contact::not_converged("steady motion", &self.options, &self.spent);
        NotConverged { velocity: Some(self.stream.velocity), ..report }.into()
    }
}
