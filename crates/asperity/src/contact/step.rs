//! One step of an iteration: from p towards the projection of a trial point, as far as f falls.

use super::projection::{Shift, Sum, Trial};

/// A clipped step is taken whole where the exact minimum lies beyond this share of it.
const FULL_STEP: f64 = 0.8;
/// How often, and by how much, a step is shortened whose sum is lost in its rounding error.
const SHORTENING: (usize, f64) = (8, 1e-3);

/// The step s = clip(p - a d + lambda) - p on a set of cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub kind: StepKind,
    /// a, in units of the direction.
    pub length: f64,
    pub shift: Shift,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StepKind {
    /// The trial point is feasible: s = -a d, and the step may go on beyond it, as far as the bounds.
    Straight,
    /// The trial point was projected.
    Clipped,
    /// A projected gradient step.
    Gradient,
}

/// The quadratic f along a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slope {
    /// <r, s>, negative where f falls.
    pub slope: f64,
    /// c <s, K s>
    pub curvature: f64,
    /// The largest t for which p + t s is feasible.
    pub reach: f64,
}

impl Step {
    /// The step to a trial point along a conjugate direction on a set of so many `cells`. `sum` is the sum of p that its cells
    /// are to have, where the load is given. `None` where no shift gives it to them.
    pub(super) fn conjugate(trial: Trial, sum: Option<f64>, cells: f64) -> Option<Self> {
        let unshifted = trial.clipped_sum(0.0);
        let kind = if unshifted.inside == cells { StepKind::Straight } else { StepKind::Clipped };
        Step::shifted(kind, trial, sum, unshifted)
    }

    /// The projected gradient step; `sum` as above.
    pub(super) fn gradient(trial: Trial, sum: Option<f64>) -> Option<Self> {
        Step::shifted(StepKind::Gradient, trial, sum, trial.clipped_sum(0.0))
    }

    fn shifted(mut kind: StepKind, mut trial: Trial, sum: Option<f64>, mut unshifted: Sum) -> Option<Self> {
        let Some(sum) = sum else {
            return Some(Step { kind, length: trial.length, shift: Shift::default() });
        };
        for _ in 0..SHORTENING.0 {
            if let Some(shift) = trial.shift_to_sum(sum, unshifted) {
                return Some(Step { kind, length: trial.length, shift });
            }
            trial.length *= SHORTENING.1;
            unshifted = trial.clipped_sum(0.0);
            if kind == StepKind::Straight {
                kind = StepKind::Clipped;
            }
        }
        None
    }

    /// The exact line search: the t that minimises f along the step, as far as it may go.
    pub(super) fn line_search(&self, along: Slope) -> f64 {
        let exact = along.minimum();
        match self.kind {
            StepKind::Straight => exact.min(along.reach),
            // Taken whole it puts all clipped cells exactly on their bounds, and f still falls.
            StepKind::Clipped if exact >= FULL_STEP => 1.0,
            StepKind::Clipped => exact,
            StepKind::Gradient => exact.min(1.0),
        }
    }
}

impl Slope {
    /// The t at which f is least along the step, whatever the bounds.
    pub(super) fn minimum(&self) -> f64 {
        if self.curvature > 0.0 { -self.slope / self.curvature } else { 1.0 }
    }
}

impl std::fmt::Display for StepKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            StepKind::Straight => "straight",
            StepKind::Clipped => "clipped",
            StepKind::Gradient => "gradient",
        })
    }
}
