//! Over velocities: each row is a steady state of motion, solved from the one before it.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::{Axis, Drive};
use crate::error::Result;
use crate::simulation::Simulation;
use crate::sliding::{Steady, SteadyMotion, Streaming};
use crate::step::{Checkpoint, Loader, Saver, Step};

impl Steady {
    /// Goes on where a checkpoint of the same sweep was taken.
    ///
    /// # Errors
    /// As [`Steady::new`]; [`Error::Invalid`](crate::Error::Invalid) where the checkpoint belongs to another sweep.
    pub fn resumed(simulation: Simulation, motion: SteadyMotion, checkpoint: &Checkpoint) -> Result<Self> {
        let mut steady = Steady::new(simulation, motion)?;
        let from = Loader::new(checkpoint, Steady::simulation(&steady).grid.shape());
        steady.resume(checkpoint.step, &from.field("pressure")?)?;
        Ok(steady)
    }
}

impl Drive for Steady {
    fn advance(&mut self) -> Result<Option<Step<'_>>> {
        Steady::advance(self)
    }

    fn last(&self) -> Option<Step<'_>> {
        Steady::last(self)
    }

    fn simulation(&self) -> &Simulation {
        Steady::simulation(self)
    }

    fn axis(&self) -> Axis {
        Axis::Velocity
    }

    fn planned(&self) -> Vec<f64> {
        self.motion().velocities.clone()
    }

    fn rows_expected(&self) -> Option<usize> {
        Some(self.motion().velocities.len())
    }

    fn done(&self) -> usize {
        Steady::done(self)
    }

    fn finished(&self) -> bool {
        Steady::finished(self)
    }

    fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        Steady::interrupt_with(self, flag);
    }

    fn checkpoint(&self) -> Checkpoint<'_> {
        let mut to = Saver::new(Steady::done(self), Steady::simulation(self).grid.shape());
        to.field("pressure", self.start());
        to.finish()
    }

    fn streaming(&self) -> Option<&Streaming> {
        Some(Steady::streaming(self))
    }
}
