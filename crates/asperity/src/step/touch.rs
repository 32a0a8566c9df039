//! Where within a step the bodies touch or part under a prescribed approach.
//!
//! Bodies that are apart touch where the approach w(dt) reaches the least gap of the recovering surfaces, and bodies in contact
//! part where it falls below the least value of h0 + g(dt), the gap of the surfaces without pressure at the end of the
//! step. Both are functions of the length of the step that need no solve. Adaptive steps end at such a moment and start
//! afresh after it.

use super::event::Enclosure;
use super::{Interval, Load, Stepper};
use crate::error::Result;
use crate::load::Control;

/// Bodies that are closer than this share of their motion in the step touch from its start on.
const TOUCHING: f64 = 1e-6;

impl Stepper {
    /// Prepares the step that is open for its solve. Where adaptive steps under a prescribed approach touch or part within it,
    /// the step ends there, and the answer is true.
    pub(super) fn locate_touch(&mut self, step: Interval) -> Result<(Interval, bool)> {
        if step.instant.control != Control::Approach || self.contact.pulls() {
            return Ok((step, false));
        }
        let locates = step.is_adaptive && !step.instant.jump;
        let overlap = self.overlap(&step);
        if step.load == Load::Apart {
            if overlap <= 0.0 {
                return Ok((step, false));
            }
            if locates {
                let start = self.overlap_at(&step, 0.0)?;
                if -start > TOUCHING * (overlap - start) {
                    let mut enclosure = Enclosure::new(step.length(), -start, -overlap);
                    self.enclose(&mut enclosure, &step, -1.0)?;
                    if enclosure.near > 0.0 {
                        return self.cut(&step, enclosure.near);
                    }
                }
            }
            // Pressure from the start on.
            let step = step.under(Load::Approach);
            self.reopen(&step)?;
            return Ok((step, false));
        }
        if locates && overlap <= 0.0 {
            let step = step.under(Load::Approach);
            let mut enclosure = Enclosure::new(step.length(), f64::NAN, overlap);
            self.enclose(&mut enclosure, &step, 1.0)?;
            return self.cut(&step, enclosure.far);
        }
        Ok((step, false))
    }

    /// Narrows the moment at which the overlap, times `side`, turns from positive to negative.
    fn enclose(&mut self, enclosure: &mut Enclosure, step: &Interval, side: f64) -> Result<()> {
        while let Some(dt) = enclosure.guess() {
            let overlap = self.overlap_at(step, dt)?;
            enclosure.narrow(dt, side * overlap);
        }
        Ok(())
    }

    fn cut(&mut self, step: &Interval, dt: f64) -> Result<(Interval, bool)> {
        let step = step.of_length(dt);
        self.reopen(&step)?;
        Ok((step, true))
    }

    /// How far the prescribed approach goes beyond first touch at the end of a step of this length.
    fn overlap_at(&mut self, step: &Interval, dt: f64) -> Result<f64> {
        let step = step.of_length(dt);
        self.reopen(&step)?;
        Ok(self.overlap(&step))
    }

    fn overlap(&self, step: &Interval) -> f64 {
        step.instant.value - self.state.first_touch()
    }
}
