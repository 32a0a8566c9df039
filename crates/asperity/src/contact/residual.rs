//! The residual of a state: the approach that fits it best, and how far it violates the contact conditions.
//!
//! With g = c U + h and r = g - w, the conditions are p = 0 where r >= 0, 0 < p < H where r = 0, p = H where r <= 0. The
//! working set S holds the cells that violate them or are free to move. Under load control w is the mean of g over the free
//! cells D = {0 < p < H}, or where there are none, between what the cells at the two bounds allow.

use super::sweeps::residual::FindResidual;
use super::{ContactState, Prescribed, Problem};
use asperity_sweep::{Merge, larger, run, smaller};

/// Sums and extremes over all cells, for the approach w; one strand for each of eight cells while they are taken.
#[derive(Clone, Copy, Debug)]
pub(super) struct ResidualReport<T = f64> {
    /// w \[m\].
    pub w: f64,
    /// Sum of r, and number of cells, over the free cells D.
    pub free: [T; 2],
    /// Sum of r, number of cells, and sum of p, over the working set S.
    pub working: [T; 3],
    /// sum p, sum p U.
    pub pressure: [T; 2],
    /// Sum of p r+ + (H - p) r-; without a cut-off sum of p r.
    pub gamma: T,
    /// Largest r where p = H.
    pub capped: T,
    /// Least r where p = 0.
    pub empty: T,
    /// Least r where p > 0, without a cut-off.
    pub touching: T,
    /// Largest p.
    pub peak: T,
    /// Largest |r| on S \[m\].
    pub violation: T,
}

impl Merge for ResidualReport {
    fn merge(self, next: Self) -> Self {
        ResidualReport {
            w: self.w,
            free: self.free.merge(next.free),
            working: self.working.merge(next.working),
            pressure: self.pressure.merge(next.pressure),
            gamma: self.gamma + next.gamma,
            capped: larger(next.capped, self.capped),
            empty: smaller(next.empty, self.empty),
            touching: smaller(next.touching, self.touching),
            peak: larger(next.peak, self.peak),
            violation: larger(next.violation, self.violation),
        }
    }
}

impl ResidualReport {
    /// The report of a state for the approach w.
    pub(super) fn of(problem: &Problem, state: &ContactState, w: f64) -> Self {
        let Problem { gap, compliance, hardness, .. } = *problem;
        run(FindResidual { p: &state.pressure, u: &state.unit_displacement, gap, hardness, compliance, w })
    }

    /// The approach that the cells give: the prescribed one, or the mean of g over D; where D is empty, the middle of what
    /// the cells at the bounds allow.
    pub(super) fn approach(&self, prescribed: Prescribed) -> f64 {
        match prescribed {
            Prescribed::Approach(w) => w,
            Prescribed::Load(_) if self.free[1] > 0.0 => self.w + self.free[0] / self.free[1],
            Prescribed::Load(_) if self.empty == f64::INFINITY => self.w + self.capped,
            Prescribed::Load(_) if self.capped == f64::NEG_INFINITY => self.w + self.empty,
            Prescribed::Load(_) => self.w + 0.5 * (self.capped + self.empty),
        }
    }

    /// True where D = {0 < p < H} is empty.
    pub(super) fn no_cell_is_free(&self) -> bool {
        self.free[1] == 0.0
    }

    /// Cells in S.
    pub(super) fn working_cells(&self) -> f64 {
        self.working[1]
    }

    /// Mean of r over S; 0 where S is empty.
    pub(super) fn working_mean(&self) -> f64 {
        if self.working[1] > 0.0 { self.working[0] / self.working[1] } else { 0.0 }
    }
}

/// The approach that fits a state best, see [`ResidualReport::approach`].
pub(super) fn find_approach(problem: &Problem, state: &ContactState) -> f64 {
    match problem.prescribed {
        Prescribed::Approach(w) => w,
        load => ResidualReport::of(problem, state, 0.0).approach(load),
    }
}
