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
//! adaptive step it lies between 7 and 12.5 times the estimate by which its length was chosen, and so within the tolerance.

use super::estimate::chord_defect;
use super::{Relaxation, UnderWay};
use crate::step::SHARE;

/// The error reported over the estimate of leading order.
const MARGIN: f64 = 5.0;
/// Error of an adaptive step over the estimate by which its length was chosen, at the least.
const LEAST: f64 = 7.0;

#[derive(Clone, Debug, Default)]
pub(super) struct TotalError {
    /// A_i \[m\].
    pub(super) left: Vec<f64>,
    /// Relative to the stress.
    pub(super) value: f64,
    /// The estimate by which the length of an adaptive step was chosen.
    pub(super) adaptive: Option<f64>,
    /// What the solver leaves in u at the end of the step closed last \[m\].
    pub(super) solver: f64,
}

impl Relaxation {
    /// Adds the error of the step that ends now.
    pub(super) fn add_error(&mut self) {
        let (x, relaxation) = (self.rules.length, &self.dual.relaxation);
        let presses = self.under_way == UnderWay::Contact;
        let own = if presses { self.survey.own } else { 0.0 };
        let mut sum = if x > 0.0 { relaxation.viscosity * own / x } else { 0.0 };
        for (i, (left, term)) in self.total_error.left.iter_mut().zip(&relaxation.terms).enumerate() {
            if x > 0.0 && presses {
                let y = x / term.relaxation_time;
                *left = libm::exp(-y) * self.survey.staying * *left + 2.0 * chord_defect(y) * own;
            } else if x > 0.0 {
                // Without pressure strains fade, with their own times.
                let fades = self.dual.creep.terms.get(i).map_or(0.0, |term| x / term.retardation_time);
                *left *= libm::exp(-fades);
            }
            sum += term.modulus * *left;
        }
        let pressed = if presses { self.survey.pressed } else { 0.0 };
        let all = if pressed > 0.0 { (MARGIN * sum / pressed).min(self.survey.largest) } else { 0.0 };
        let noise = if presses { self.noise() } else { 0.0 };
        self.total_error.solver = if presses { self.survey.left } else { 0.0 };
        let TotalError { value, adaptive, .. } = &mut self.total_error;
        *value = adaptive.map_or(all, |own| all.clamp(LEAST * own, own / SHARE)).max(noise);
    }
}
