//! How far a pressure is from the solution: the approach that fits it best, the violation of the
//! contact conditions, and the certificate.
//!
//! With r = g - w, g = cU + h, any feasible p satisfies (subtract the two variational inequalities)
//! |p - p*|_K^2 <= Gamma = sum [ p r+ + (H - p) r- ]. Without a cut-off w is taken as the least g, so
//! that r >= 0 and Gamma = sum p (g - min g). Under approach control w is given; the sum of p* that
//! then multiplies the largest r- is replaced by that of p.

use super::{ContactState, Outcome, Prescribed, Problem};
use crate::field::{Max, Merge, Min, larger, smaller, strands, sweep};
use crate::grid::Grid;

/// Sums of one sweep over p, U, h.
#[derive(Clone, Copy)]
pub(super) struct Balance {
    /// sum of g and number of cells over D = {0 < p < H}; sum p, sum p U, sum p g.
    sums: [f64; 5],
    /// Largest g where p = H.
    capped: Max,
    /// Least g where p = 0.
    empty: Min,
    /// Least g where p > 0.
    touching: Min,
    /// Largest p.
    peak: Max,
}

impl Merge for Balance {
    fn merge(self, next: Self) -> Self {
        Balance {
            sums: self.sums.merge(next.sums),
            capped: self.capped.merge(next.capped),
            empty: self.empty.merge(next.empty),
            touching: self.touching.merge(next.touching),
            peak: self.peak.merge(next.peak),
        }
    }
}

impl Balance {
    pub(super) fn of(problem: &Problem, state: &ContactState) -> Self {
        let (c, hardness) = (problem.compliance, problem.hardness);
        sweep((&state.pressure[..], &state.unit_displacement[..], problem.gap), &|(p, u, h): (
            &[f64],
            &[f64],
            &[f64],
        )| {
            let n = p.len();
            let (u, h) = (&u[..n], &h[..n]);
            let mut extremes = [f64::NEG_INFINITY, f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY];
            let sums = strands(n, |i| {
                let g = c * u[i] + h[i];
                let touches = p[i] > 0.0;
                let free = touches && p[i] < hardness;
                let [capped, empty, touching, peak] = extremes;
                extremes = [
                    if p[i] >= hardness { larger(g, capped) } else { capped },
                    if touches { empty } else { smaller(g, empty) },
                    if touches { smaller(g, touching) } else { touching },
                    larger(p[i], peak),
                ];
                let pg = if touches { p[i] * g } else { 0.0 };
                [if free { g } else { 0.0 }, f64::from(u8::from(free)), p[i], p[i] * u[i], pg]
            });
            let [capped, empty, touching, peak] = extremes;
            Balance { sums, capped: Max(capped), empty: Min(empty), touching: Min(touching), peak: Max(peak) }
        })
    }

    /// The approach: given, or the mean of g over D; where D is empty, the middle of what the cells
    /// at the bounds allow.
    pub(super) fn approach(&self, prescribed: Prescribed) -> f64 {
        let (above, below) = (self.capped.0, self.empty.0);
        match prescribed {
            Prescribed::Approach(w) => w,
            Prescribed::Load(_) if self.sums[1] > 0.0 => self.sums[0] / self.sums[1],
            Prescribed::Load(_) if below == f64::INFINITY => above,
            Prescribed::Load(_) if above == f64::NEG_INFINITY => below,
            Prescribed::Load(_) => 0.5 * (above + below),
        }
    }

    /// True where D = {0 < p < H} is empty.
    pub(super) fn no_cell_is_free(&self) -> bool {
        self.sums[1] == 0.0
    }

    /// The displacement that violations are measured by: (p'u)/(sum p), or the overlap before first contact.
    fn displacement(&self, problem: &Problem, w: f64) -> f64 {
        let mean = problem.compliance * self.sums[3] / self.sums[2];
        if self.sums[2] > 0.0 { mean.max(0.0) } else { (w - self.empty.0).abs() }
    }

    /// What rounding alone makes of g: a violation below it means nothing.
    fn rounding(&self, problem: &Problem, grid: &Grid, w: f64) -> f64 {
        let [lx, ly] = grid.size();
        let peak = if problem.hardness.is_finite() { self.peak.0.min(problem.hardness) } else { self.peak.0 };
        16.0 * f64::EPSILON * (w.abs() + problem.compliance * peak.max(0.0) * lx.max(ly))
    }
}

/// Violations of one state, and the working set of the next step.
#[derive(Clone, Copy)]
pub(super) struct Violation {
    /// Largest violation \[m\].
    largest: Max,
    /// Gamma; sum of r and number of cells over S = D + {p = 0, r < 0} + {p = H, r > 0}.
    sums: [f64; 3],
}

impl Merge for Violation {
    fn merge(self, next: Self) -> Self {
        Violation { largest: self.largest.merge(next.largest), sums: self.sums.merge(next.sums) }
    }
}

impl Violation {
    pub(super) fn of(problem: &Problem, state: &ContactState, w: f64) -> Self {
        let (c, hardness) = (problem.compliance, problem.hardness);
        sweep((&state.pressure[..], &state.unit_displacement[..], problem.gap), &|(p, u, h): (
            &[f64],
            &[f64],
            &[f64],
        )| {
            let n = p.len();
            let (u, h) = (&u[..n], &h[..n]);
            let mut largest = 0.0;
            let sums = strands(n, |i| {
                let r = c * u[i] + h[i] - w;
                let releases = p[i] >= hardness;
                // |r| counts unless the cell sits at the bound that r presses it against.
                let works = if p[i] <= 0.0 { r < 0.0 } else { !releases || r > 0.0 };
                let violation = if works { r.abs() } else { 0.0 };
                largest = larger(violation, largest);
                let distance = if r > 0.0 { p[i] } else { hardness - p[i] };
                let gamma = if works { distance * violation } else { 0.0 };
                [gamma, if works { r } else { 0.0 }, f64::from(u8::from(works))]
            });
            Violation { largest: Max(largest), sums }
        })
    }

    /// Mean of r over the working set S; 0 where S is empty.
    pub(super) fn working_mean(&self) -> f64 {
        if self.sums[2] > 0.0 { self.sums[1] / self.sums[2] } else { 0.0 }
    }

    /// True where no cell may change.
    pub(super) fn nothing_works(&self) -> bool {
        self.sums[2] == 0.0
    }

    /// Residual and certificate of a state.
    pub(super) fn rate(
        &self,
        problem: &Problem,
        grid: &Grid,
        balance: &Balance,
        w: f64,
        tolerance: f64,
    ) -> Outcome {
        let scale = balance.displacement(problem, w) + balance.rounding(problem, grid, w) / tolerance;
        let residual = if self.largest.0 > 0.0 { self.largest.0 / scale } else { 0.0 };
        let [_, _, pressure, pu, pg] = balance.sums;
        let gamma = if problem.hardness.is_finite() {
            self.sums[0]
        } else {
            let least = balance.empty.0.min(balance.touching.0);
            match problem.prescribed {
                Prescribed::Load(_) => pg - least * pressure,
                Prescribed::Approach(w) => {
                    let rise = 2.0 * (w - least).max(0.0) + (least - w).max(0.0);
                    (pg - least * pressure) + pressure * rise
                }
            }
        };
        let energy = problem.compliance * pu;
        let certificate = if gamma > 0.0 && energy > 0.0 { (gamma / energy).sqrt() } else { 0.0 };
        Outcome { residual, certificate, ..Outcome::default() }
    }
}
