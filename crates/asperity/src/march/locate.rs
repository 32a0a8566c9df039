//! Where within a step the bodies touch or part under a prescribed approach.
//!
//! Bodies that are apart touch where the approach w(dt) reaches the least gap of the recovering surfaces, and bodies in contact
//! part where it falls below the least value of h0 + g(dt), the gap of the surfaces without pressure at the end of the
//! step. Both are functions of the length of the step that need no solve. Adaptive steps end at such a moment and start
//! afresh after it.

use super::March;
use super::event::Enclosure;
use super::memory::Imposed;
use crate::error::Result;
use crate::load::Control;
use crate::time::Instant;
use asperity_sweep::minimum;

/// Bodies that are closer than this share of their motion in the step touch from its start on.
const TOUCHING: f64 = 1e-6;

impl March {
    /// Prepares the step that is set for its solve. Where adaptive steps under a prescribed approach touch or part within it,
    /// the step ends there, and the answer is true.
    pub(super) fn locate(&mut self, instant: &mut Instant) -> Result<bool> {
        if instant.control != Control::Approach {
            return Ok(false);
        }
        let locates = self.timeline.pace().is_some() && !instant.jump;
        let overlap = self.overlap(*instant);
        if self.is_apart() {
            if overlap <= 0.0 {
                return Ok(false);
            }
            let drive = Imposed::Apart;
            if locates {
                let start = self.overlap_at(drive, 0.0)?;
                if -start > TOUCHING * (overlap - start) {
                    let mut enclosure = Enclosure::new(instant.dt, -start, -overlap);
                    self.enclose(&mut enclosure, drive, -1.0)?;
                    if enclosure.near() > 0.0 {
                        self.cut(instant, enclosure.near(), drive)?;
                        return Ok(true);
                    }
                }
            }
            // Pressure from the start on.
            self.reset(*instant, Imposed::Approach)?;
        } else if locates && overlap <= 0.0 {
            let mut enclosure = Enclosure::new(instant.dt, f64::NAN, overlap);
            self.enclose(&mut enclosure, Imposed::Approach, 1.0)?;
            self.cut(instant, enclosure.far(), Imposed::Approach)?;
            return Ok(true);
        }
        Ok(false)
    }

    /// Narrows the moment at which the overlap, times `side`, turns from positive to negative.
    fn enclose(&mut self, enclosure: &mut Enclosure, drive: Imposed, side: f64) -> Result<()> {
        while let Some(dt) = enclosure.guess() {
            let overlap = self.overlap_at(drive, dt)?;
            enclosure.narrow(dt, side * overlap);
        }
        Ok(())
    }

    fn cut(&mut self, instant: &mut Instant, dt: f64, drive: Imposed) -> Result<()> {
        *instant = self.timeline.inside(&self.simulation, dt);
        self.reset(*instant, drive)
    }

    /// How far the prescribed approach goes beyond first touch at the end of a step of this length.
    fn overlap_at(&mut self, drive: Imposed, dt: f64) -> Result<f64> {
        let instant = self.timeline.inside(&self.simulation, dt);
        self.reset(instant, drive)?;
        Ok(self.overlap(instant))
    }

    fn overlap(&self, instant: Instant) -> f64 {
        instant.value - minimum(&self.gap)
    }
}
