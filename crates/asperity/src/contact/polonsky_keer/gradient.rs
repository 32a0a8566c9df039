//! The gradient steps of Polonsky and Keer's method after a stall, and where no cell is free.
//!
//! s = clip(p - b r + lambda) - p over all cells that can touch, p <- p + t s, with the t of (0, 1] that minimises f on the
//! feasible segment. Such steps never raise f, and converge from any feasible pressure (Bertsekas, Nonlinear Programming,
//! 1999, section 2.3). The first stall, 20 iterations without a halving of the residual, takes one of them; each stall after
//! it lasts twice as long and takes twice as many, so that one series is long enough in the end: the whole method converges.

use super::super::projection::{Shift, Trial};
use super::super::{ContactState, Problem};
use super::PolonskyKeer;
use crate::operator::Operator;
use asperity_sweep::{Set, add, each, each_with_sums};

/// Iterations without a halving of the residual that are the first stall.
const PATIENCE: usize = 20;

/// Watches the residual, and says when gradient steps are due.
pub(super) struct Progress {
    best: f64,
    /// Iterations without a halving of the best residual.
    idle: usize,
    /// Gradient steps still to be taken after this stall.
    left: usize,
    /// Gradient steps after the next stall.
    series: usize,
}

impl Progress {
    pub(super) fn new() -> Self {
        Progress { best: f64::INFINITY, idle: 0, left: 0, series: 1 }
    }

    /// True from a stall on until its gradient steps are taken.
    pub(super) fn has_stalled(&mut self, residual: f64) -> bool {
        self.idle += 1;
        if residual < 0.5 * self.best {
            (self.best, self.idle) = (residual, 0);
        }
        if self.left == 0 && self.idle >= PATIENCE * self.series {
            (self.left, self.series) = (self.series, 2 * self.series);
        }
        if self.left == 0 {
            return false;
        }
        self.left -= 1;
        self.idle = 0;
        true
    }
}

impl PolonskyKeer {
    /// One step; lambda keeps the load. `b` becomes <s, s> / (c <s, K s>) (Barzilai & Borwein 1988). False where s does not
    /// descend.
    pub(super) fn gradient_step(
        &mut self,
        operator: &mut dyn Operator,
        problem: &Problem,
        state: &mut ContactState,
        b: &mut f64,
    ) -> bool {
        let area = operator.grid().cell_area();
        let Some([slope, square]) = self.projected_gradient(problem, state, area, *b) else {
            return false;
        };
        if slope.is_nan() || slope >= 0.0 {
            return false;
        }
        operator.apply_into(&self.direction, &mut self.image);
        let [_, curvature] = self.products();
        let curvature = problem.compliance * curvature;
        let mut t = 1.0;
        if curvature > 0.0 {
            t = (-slope / curvature).min(1.0);
            *b = square / curvature;
        }
        each(&mut state.pressure, (&self.direction[..], problem.hardness), |p, (s, hardness)| {
            // p + (H - p) may differ from H by rounding.
            let new = *p + t * s;
            *p = if new < hardness * (1.0 - 2.0 * f64::EPSILON) { new } else { hardness };
        });
        add(&mut state.unit_displacement, t, &self.image);
        true
    }

    /// The residual, and s in the place of the direction; returns <r, s> and <s, s>. `None` where no shift keeps the load.
    fn projected_gradient(
        &mut self,
        problem: &Problem,
        state: &ContactState,
        cell_area: f64,
        b: f64,
    ) -> Option<[f64; 2]> {
        let Problem { gap, compliance, hardness, .. } = *problem;
        let PolonskyKeer { residual, direction, touchable, .. } = self;
        let (p, u, w) = (&state.pressure[..], &state.unit_displacement[..], state.approach);
        each(residual, (u, gap, Set(touchable)), |r, (u, h, on)| {
            *r = if on { compliance * u + h - w } else { 0.0 };
        });
        each(direction, (p, &residual[..]), |y, (p, r)| *y = p - b * r);
        let shift = match problem.sum(cell_area) {
            None => Shift::default(),
            Some(target) => {
                let trial =
                    Trial { pressure: direction, direction: None, set: touchable, length: 0.0, hardness };
                trial.shift_to_sum(target, trial.clipped_sum(0.0))?
            }
        };
        let cells = (p, &residual[..], Set(touchable), hardness);
        Some(each_with_sums(direction, cells, |s, (p, r, on, hardness)| {
            *s = if on { shift.project_cell(*s, hardness) - p } else { 0.0 };
            [r * *s, *s * *s]
        }))
    }
}
