//! The error of the stress at the end of a row: that of its step, and what the branches remember of the steps before.
//!
//! ```text
//! A_i' = exp(-x/τ_i) A_i + 2 b(x/τ_i) S,    S = Σ max( |u[z0, z1, z2]| Δz², gap before )
//! time_error = 5 [ Σ E_i A_i + ζ S/x ] / max( N Σ p U'/Σ p, 0.1 Σ U_n, 0.1 E_inf Σ |u'|, 0.1 a Σ p )
//! ```
//!
//! with the second difference of u, b(y) and the size a of the contact of [`super::estimate`]; at most what the cells below the
//! hardness could carry. S goes over the cells that are in contact and below the hardness at the end of the step, N over all in contact:
//! a cell that leaves the contact takes no error of the pressure with it. The gap before counts for cells that come into contact in the
//! step: until then they do not move with the others. The sums add the sizes of all errors, so that none cancels another. The factor 5
//! turns the leading order into a number that covers the largest error of load and largest pressure in 95 of 100 random runs (the
//! test `time_error`); it bounds neither each row nor each cell. Adaptive steps report the error by which their length is chosen, over
//! the share of the tolerance that one step may take.

use super::estimate::chord_defect;
use super::{Relaxation, UnderWay};

/// The error reported over the estimate of leading order.
const MARGIN: f64 = 5.0;

#[derive(Clone, Debug, Default)]
pub(super) struct TotalError {
    /// A_i \[m\].
    pub(super) left: Vec<f64>,
    /// Relative to the stress.
    pub(super) value: f64,
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
                *left = libm::exp(-y) * *left + 2.0 * chord_defect(y) * own;
            } else if x > 0.0 {
                // Without pressure strains fade, with their own times.
                let fades = self.dual.creep.terms.get(i).map_or(0.0, |term| x / term.retardation_time);
                *left *= libm::exp(-fades);
            }
            sum += term.modulus * *left;
        }
        let pressed = if presses { self.survey.pressed } else { 0.0 };
        self.total_error.value =
            if pressed > 0.0 { (MARGIN * sum / pressed).min(self.survey.largest) } else { 0.0 };
    }
}
