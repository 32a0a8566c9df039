//! What an iteration of projected conjugate gradients tells the next, in one solve.

use super::step::StepKind;
use super::{ContactState, Problem, Task};
use crate::operator::Operator;

/// The length a of the first trial step.
const FIRST_LENGTH: f64 = 0.75;

/// One solve: what is asked for, and what an iteration tells the next.
pub(super) struct Search<'a> {
    pub operator: &'a mut dyn Operator,
    pub problem: &'a Problem<'a>,
    pub state: &'a mut ContactState,
    /// Sum of p that the load asks for.
    pub sum: Option<f64>,
    /// Mean of g over the free cells, where it is known \[m\].
    pub free_gap: Option<f64>,
    /// Unit of residuals: the largest violation at the start \[m\]; 0 before.
    pub unit: f64,
    /// Length a of trial steps, in units of the preconditioned residual, and of gradient steps \[Pa/m\].
    pub length: f64,
    pub gradient_length: f64,
    /// <z, r> of the last conjugate direction; `None` forgets it.
    pub product: Option<f64>,
    pub best: f64,
    pub stalled: usize,
    pub iterations: usize,
    pub convolutions: usize,
}

impl<'a> Search<'a> {
    /// Before the first step; see [`super::ProjectedCg::start`].
    pub(super) fn new(Task { operator, problem, state, .. }: Task<'a>) -> Self {
        Search {
            sum: problem.sum(operator.grid().cell_area()),
            free_gap: None,
            unit: 0.0,
            length: FIRST_LENGTH,
            gradient_length: 1.0 / (problem.compliance * operator.self_influence()),
            product: None,
            best: f64::INFINITY,
            stalled: 0,
            iterations: 0,
            convolutions: 0,
            operator,
            problem,
            state,
        }
    }

    /// Computes U = K p afresh.
    pub(super) fn convolve(&mut self) {
        self.operator.apply_into(&self.state.pressure, &mut self.state.unit_displacement);
        self.convolutions += 1;
        self.state.rounding = 1.0;
        self.product = None;
        self.free_gap = None;
    }

    /// Whether rounding errors of U are below what the tolerance shows, or as small as they can be.
    pub(super) fn is_precise(&self, tolerance: f64) -> bool {
        self.state.rounding <= 1.0 || self.state.is_precise(tolerance)
    }

    /// Counts the iterations in which the residual has not halved.
    pub(super) fn count_stall(&mut self, residual: f64) {
        self.stalled += 1;
        if residual < 0.5 * self.best {
            (self.best, self.stalled) = (residual, 0);
        }
    }

    /// The next length of trial steps, from the multiple of the last one at which f was least.
    pub(super) fn update_lengths(&mut self, kind: StepKind, exact: f64, inverse_curvature: f64) {
        match kind {
            StepKind::Straight => self.length = (self.length * exact).clamp(0.05, 20.0),
            StepKind::Clipped => self.length *= exact.max(0.0).sqrt().clamp(0.3, 1.5),
            StepKind::Gradient if inverse_curvature.is_finite() => self.gradient_length = inverse_curvature,
            StepKind::Gradient => {}
        }
    }
}
