//! When a solve may stop, and a bound of its error.
//!
//! With r = g - w any feasible p satisfies (subtract the two variational inequalities)
//!
//! |p - p*|_K^2 <= Gamma = sum [ p r+ + (H - p) r- ]
//!
//! for any w where the load is given. Without a cut-off w is taken as the least g, so that r >= 0 and
//! Gamma = sum p (g - min g). Under approach control w is given; the sum of p* that then multiplies the largest r- is
//! replaced by that of p.

use super::residual::ResidualReport;
use super::{Outcome, Prescribed, Problem};
use crate::grid::Grid;

impl ResidualReport {
    /// The displacement that violations are measured by: (p'u)/(sum p), or the overlap before first contact \[m\].
    pub(super) fn displacement(&self, problem: &Problem) -> f64 {
        let [pressure, pu] = self.pressure;
        if pressure > 0.0 { (problem.compliance * pu / pressure).max(0.0) } else { self.empty.abs() }
    }

    /// Rounding error of g: a violation below it means nothing \[m\].
    fn rounding(&self, problem: &Problem, grid: &Grid) -> f64 {
        let peak = self.peak.max(0.0);
        16.0 * f64::EPSILON * (self.w.abs() + problem.compliance * peak * grid.longest_side())
    }

    /// The largest violation of the contact conditions over what violations are measured by, and the certificate.
    ///
    /// A violation of the size of rounding errors counts as no more than `tolerance`. Where w is not the approach that the
    /// cells give, the violation grows by at most the difference.
    pub(super) fn outcome(&self, problem: &Problem, grid: &Grid, tolerance: f64) -> Outcome {
        let scale = self.displacement(problem) + self.rounding(problem, grid) / tolerance;
        let apart = (self.approach(problem.prescribed) - self.w).abs();
        let residual = if self.violation > 0.0 { (self.violation + apart) / scale } else { 0.0 };
        Outcome { residual, certificate: self.certificate(problem), ..Outcome::default() }
    }

    /// sqrt(Gamma / p'u).
    fn certificate(&self, problem: &Problem) -> f64 {
        let [pressure, pu] = self.pressure;
        let gamma = if !problem.hardness.is_infinite() {
            self.gamma
        } else {
            let least = self.empty.min(self.touching);
            let above_least = self.gamma - least * pressure;
            match problem.prescribed {
                Prescribed::Load(_) => above_least,
                Prescribed::Approach(_) => {
                    above_least + pressure * (2.0 * (-least).max(0.0) + least.max(0.0))
                }
            }
        };
        let energy = problem.compliance * pu;
        if gamma > 0.0 && energy > 0.0 { (gamma / energy).sqrt() } else { 0.0 }
    }
}
