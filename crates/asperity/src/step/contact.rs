//! The contact of a step: operator, solver, cut-off, and the tractions that act on the surfaces besides.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use crate::contact::{ContactState, Hardness, Outcome, Prescribed, Problem, SolverOptions, Start, Task};
use crate::error::Result;
use crate::grid::Boundary;
use crate::operator::Operator;
use crate::simulation::Simulation;
use crate::time::Instant;
use crate::traction::TractionSolver;
use crate::wear::{RecedingSolver, Recession};

pub(crate) struct StepContact {
    pub(crate) operator: Box<dyn Operator>,
    /// Whether the operator is that of one step alone.
    changes: bool,
    solver: RecedingSolver,
    pub(super) options: SolverOptions,
    pub(super) hardness: CutOff,
    pub(super) traction: Option<TractionSolver>,
    pub(crate) interrupt: Option<Arc<AtomicBool>>,
}

/// The cut-off of the pressure: of all cells, or of each, where it is not the same everywhere.
pub(super) struct CutOff {
    all: f64,
    of_cells: Option<Vec<f64>>,
}

impl CutOff {
    pub(super) fn lent(&self) -> Hardness<'_> {
        self.of_cells.as_deref().map_or(Hardness::Uniform(self.all), Hardness::Cells)
    }
}

impl StepContact {
    pub(crate) fn new(simulation: &Simulation, operator: Box<dyn Operator>) -> Self {
        let law = simulation.traction.as_deref();
        StepContact {
            solver: RecedingSolver::new(simulation.solver.method, &*operator),
            operator,
            changes: false,
            options: simulation.solver,
            hardness: CutOff { all: simulation.hardness, of_cells: simulation.hardness_of_cells() },
            traction: law.map(|law| TractionSolver::new(law, &simulation.grid, simulation.solver.tolerance)),
            interrupt: None,
        }
    }

    pub(crate) fn hardness(&self) -> Hardness<'_> {
        self.hardness.lent()
    }

    /// Whether other tractions act on the surfaces.
    pub(super) fn pulls(&self) -> bool {
        self.traction.is_some()
    }

    /// The contacts of both states of a step: without what other tractions press or pull.
    pub(super) fn contacts<'a>(&'a self, states: [&'a ContactState; 2]) -> [&'a ContactState; 2] {
        self.traction.as_ref().map_or(states, TractionSolver::contacts)
    }

    /// The contact pressures of both states of a step \[Pa\], 0 or more: all pressure, where no other traction acts.
    pub(super) fn pressures<'a>(&'a self, states: [&'a ContactState; 2]) -> [&'a [f64]; 2] {
        self.contacts(states).map(|state| &state.pressure[..])
    }

    /// Takes the operator of the step that was opened, where it has one of its own.
    pub(super) fn take_operator(&mut self, operator: Option<Box<dyn Operator>>) {
        if let Some(operator) = operator {
            (self.operator, self.changes) = (operator, true);
        }
    }

    /// Whether U of a known state is that of the operator of the step.
    pub(super) fn keeps_operator(&self) -> bool {
        !self.changes
    }

    /// Where the operator is another one in each step: U of a known state under the present one; the convolutions that it took.
    pub(super) fn refresh(&mut self, known: &mut ContactState) -> usize {
        if !self.changes {
            return 0;
        }
        self.operator.apply_into(&known.pressure, &mut known.unit_displacement);
        known.rounding = 1.0;
        1
    }

    /// The contact has moved by these cells along x and y since the last row.
    pub(super) fn follow(&mut self, shift: [isize; 2], boundary: Boundary) {
        self.traction.iter_mut().for_each(|traction| traction.follow(shift, boundary));
    }

    /// The instant that is solved for.
    pub(super) fn begin(&mut self, at: &Instant) {
        self.traction.iter_mut().for_each(|traction| traction.begin(at));
    }

    pub(crate) fn solve(
        &mut self,
        start: Start,
        gap: &[f64],
        compliance: f64,
        prescribed: Prescribed,
        state: &mut ContactState,
    ) -> Result<Outcome> {
        self.solve_receding(start, gap, compliance, prescribed, &Recession::default(), state)
    }

    /// The same of surfaces that recede under the pressure.
    pub(super) fn solve_receding(
        &mut self,
        start: Start,
        gap: &[f64],
        compliance: f64,
        prescribed: Prescribed,
        recession: &Recession,
        state: &mut ContactState,
    ) -> Result<Outcome> {
        let problem = Problem { gap, compliance, hardness: self.hardness.lent(), prescribed };
        let (operator, options, interrupt) = (&mut *self.operator, &self.options, self.interrupt.as_deref());
        let task = Task { operator, problem: &problem, options, state, interrupt };
        match &mut self.traction {
            None => self.solver.solve(start, recession, task),
            Some(traction) => traction.solve(&mut self.solver, recession, task),
        }
    }

    /// The step stands.
    pub(super) fn commit(&mut self) {
        self.traction.iter_mut().for_each(TractionSolver::commit);
    }
}
