//! The error of the stress at the end of a row: that of its step, and what the branches remember of the steps before.
//!
//! ```text
//! A_i' = s exp(-x/τ_i) A_i + 2 b(x/τ_i) S,    S = Σ max( |u[z0, z1, z2]| Δz², gap before )
//! time_error = 5 [ Σ E_i A_i + ζ S/x ] / max( N Σ p U'/Σ p, 0.1 Σ U_n, 0.1 E_inf Σ |u'|, 0.1 a Σ p )
//! ```
//!
//! with the second difference of u, b(y) and the size a of the contact of [`super::estimate`]; at most what the cells below the
//! hardness could carry. S goes over the cells that are in contact and below the hardness at the end of the step, N over all in contact.
//! A cell that leaves the contact leaves no error of the pressure behind: s is the share of the cells in contact that stays. The gap before counts for cells that come into contact in the
//! step: until then they do not move with the others. The sums add the sizes of all errors, so that none cancels another. The factor 5
//! turns the leading order into a number that covers the largest error of load and largest pressure in 95 of 100 random runs (the
//! test `time_error`); it bounds neither each row nor each cell. Of an
//! adaptive step it is at least 7 times the estimate by which its length was chosen.
//!
//! On lines the cells that come into contact are followed by themselves, by an A of their own, and add 2 [ Σ E_i A_i + ζ S/x ] / (Σ p dx):
//! π/3 of a cell alone, times 2, because the course of u bends at the moment of touch: the chord leaves 3 (1 - θ) times as much as a parabola,
//! where the touch is after the share θ of the step.
//!
//! Where tractions act on open cells (adhesion), the number is at least the error of the largest traction alone, Σ E_i A_i + ζ S/x over the
//! displacement of its cell under its own traction. S is the estimate of that cell ([`super::estimate`]), and A_i' the larger one of
//! s exp(-x/τ_i) A_i and 2 b(x/τ_i) S: in the next step it is mostly another cell.

use super::estimate::{Survey, chord_defect};
use super::{Relaxation, UnderWay};

/// The error reported over the estimate of leading order; that of cells alone.
const MARGIN: f64 = 5.0;
const MARGIN_ALONE: f64 = 2.0;
/// Error of an adaptive step over the estimate by which its length was chosen, at the least.
const LEAST: f64 = 7.0;

#[derive(Clone, Debug, Default)]
pub(super) struct TotalError {
    /// A_i \[m\], that of cells alone, and that of the largest traction.
    pub(super) left: Vec<f64>,
    pub(super) left_alone: Vec<f64>,
    pub(super) left_peak: Vec<f64>,
    /// Relative to the stress.
    pub(super) value: f64,
    /// The estimate by which the length of an adaptive step was chosen.
    pub(super) adaptive: Option<f64>,
    /// What the solver leaves in u at the end of the step closed last \[m\].
    pub(super) solver: f64,
}

impl TotalError {
    /// Of so many branches.
    pub(super) fn new(branches: usize) -> Self {
        let none = vec![0.0; branches];
        TotalError { left: none.clone(), left_alone: none.clone(), left_peak: none, ..TotalError::default() }
    }
}

impl Relaxation {
    /// Adds the error of the step that ends now.
    pub(super) fn add_error(&mut self) {
        let presses = self.under_way == UnderWay::Contact;
        let survey = if presses { self.survey } else { Survey::default() };
        let mut left = std::mem::take(&mut self.total_error.left);
        let mut alone = std::mem::take(&mut self.total_error.left_alone);
        let mut peak = std::mem::take(&mut self.total_error.left_peak);
        let add = |left: f64, new: f64| left + new;
        let sum = self.carry_on(&mut left, survey.own, presses, add);
        let sum_alone = self.carry_on(&mut alone, survey.alone, presses, add);
        let sum_peak = self.carry_on(&mut peak, survey.peak, presses, f64::max);
        let over = |sum: f64, stress: f64| if stress > 0.0 { sum / stress } else { 0.0 };
        let all = MARGIN * over(sum, survey.pressed) + MARGIN_ALONE * over(sum_alone, survey.pressed_alone);
        let all = all.max(over(sum_peak, survey.pressed_peak));
        let all = if survey.pressed > 0.0 { all.min(survey.largest) } else { 0.0 };
        let noise = if presses { self.noise() } else { 0.0 };
        self.total_error.solver = survey.left;
        let TotalError { value, adaptive, .. } = &mut self.total_error;
        *value = all.max(adaptive.map_or(0.0, |own| LEAST * own)).max(noise);
        (self.total_error.left, self.total_error.left_alone) = (left, alone);
        self.total_error.left_peak = peak;
    }

    /// The A_i at the end of the step, which `join` makes of what is left and the `own` error of the step; Σ E_i A_i + ζ S/x.
    fn carry_on(&self, left: &mut [f64], own: f64, presses: bool, join: fn(f64, f64) -> f64) -> f64 {
        let (x, relaxation) = (self.rules.length, &self.dual.relaxation);
        let mut sum = if x > 0.0 { relaxation.viscosity * own / x } else { 0.0 };
        for (i, (left, term)) in left.iter_mut().zip(&relaxation.terms).enumerate() {
            if x > 0.0 && presses {
                let y = x / term.relaxation_time;
                *left = join(libm::exp(-y) * self.survey.staying * *left, 2.0 * chord_defect(y) * own);
            } else if x > 0.0 {
                // Without pressure strains fade, with their own times.
                let fades = self.dual.creep.terms.get(i).map_or(0.0, |term| x / term.retardation_time);
                *left *= libm::exp(-fades);
            }
            sum += term.modulus * *left;
        }
        sum
    }
}
