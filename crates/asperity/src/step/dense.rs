//! The state between two rows, consistent with the scheme: dense output.
//!
//! Within a step u runs linearly in time, or in L = ∫ C dW under load control ([`super::memory`]). The load follows from the
//! memory of the load as a cell, and the pressure is the mixture of those at both ends that has this load: exact while the
//! contact set stands, of second order where it moves. The approach is the one at which the cells in contact are closed in the
//! pressure-weighted mean, sum p (h0 + u - w) = 0 over 0 < p < H. The steps themselves take no notice.

use super::Stepper;
use crate::contact::ContactState;
use crate::history::Moment;
use crate::load::Control;
use crate::time::Instant;
use asperity_sweep::{each, minimum, sum, sums, zeros};

/// A state within the last step of a run; [`Drive::view`](crate::Drive::view) shows it as a row.
pub struct Between {
    pub(crate) instant: Instant,
    pub(crate) state: ContactState,
    /// h0 + u.
    pub(crate) gap: Vec<f64>,
    /// u.
    pub(crate) displacement: Vec<f64>,
}

impl Stepper {
    /// The state at `time` within the step of the last row: after the row before it, not after the last row. `None` outside of it, and
    /// where the history knows none.
    pub(crate) fn between(&self, time: f64) -> Option<Between> {
        let row = self.step.as_ref().filter(|_| !self.is_open)?;
        if row.instant.jump || !(time > row.start && time <= row.instant.time) {
            return None;
        }
        let part = row.up_to(time);
        let mut displacement = zeros(self.state.gap.len());
        let Moment { share, load } =
            self.history.within(&part, &self.state.ends(self.contact.hardness()), &mut displacement)?;
        let hardness = self.contact.hardness();
        let cell_area = self.simulation.grid.cell_area();
        let (from, to) = (&self.state.before.pressure[..], &self.state.now.pressure[..]);
        let [before, now] = [from, to].map(|p| cell_area * sum(p));
        let mixed = before + share * (now - before);
        let scale = if mixed > 0.0 { load / mixed } else { 1.0 };
        let mut pressure = zeros(from.len());
        each(&mut pressure, (from, to, hardness), |m, (a, b, top)| {
            let value = a + share * (b - a);
            // Cells at the hardness at both ends stay there.
            *m = if value >= top { top } else { (scale * value).min(top) };
        });
        let mut gap = self.state.undeformed.now().to_vec();
        each(&mut gap, &displacement[..], |h, u| *h += u);
        let [weight, closed, touching] = sums((&pressure[..], &gap[..], hardness), |(p, h, hardness)| {
            let free = if p > 0.0 && p < hardness { p } else { 0.0 };
            [free, if free > 0.0 { free * h } else { 0.0 }, f64::from(u8::from(p > 0.0))]
        });
        let approach = match row.instant.control {
            _ if weight > 0.0 => closed / weight,
            Control::Approach => part.instant.value,
            // Every touching cell is at the hardness: bounded from below only.
            _ if touching > 0.0 => self.state.now.approach,
            _ => minimum(&gap),
        };
        // The gap holds u itself: nothing is multiplied by a compliance.
        let unit_displacement = zeros(pressure.len());
        Some(Between {
            instant: part.instant,
            state: ContactState { pressure, unit_displacement, approach, rounding: f64::INFINITY },
            gap,
            displacement,
        })
    }
}
