//! Over velocities: each row is a steady state of motion, solved from the one before it.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use ndarray::Array2;

use super::{Axis, Drive};
use crate::error::{Error, Result};
use crate::march::{Checkpoint, Simulation, Step};
use crate::sliding::{Steady, SteadyMotion, Streaming};

impl Steady {
    /// Goes on where a checkpoint of the same sweep was taken.
    ///
    /// # Errors
    /// As [`Steady::new`]; [`Error::Invalid`] where the checkpoint belongs to another sweep.
    pub fn resumed(simulation: Simulation, motion: SteadyMotion, checkpoint: &Checkpoint) -> Result<Self> {
        let mut steady = Steady::new(simulation, motion)?;
        let pressure = checkpoint.fields.iter().find(|(name, _)| name == "pressure");
        let Some((_, pressure)) = pressure else {
            return Err(Error::invalid("checkpoint", "without the field pressure", "one of this sweep"));
        };
        steady.resume(checkpoint.step, &pressure.iter().copied().collect::<Vec<_>>())?;
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
        Steady::done(self) == self.motion().velocities.len()
    }

    fn interrupt_with(&mut self, flag: Arc<AtomicBool>) {
        Steady::interrupt_with(self, flag);
    }

    fn checkpoint(&self) -> Checkpoint<'_> {
        let shape = Steady::simulation(self).grid.shape();
        let pressure =
            Steady::last(self).map_or_else(|| Array2::zeros(shape), |step| step.pressure().to_owned());
        Checkpoint {
            step: Steady::done(self),
            numbers: vec![],
            fields: vec![("pressure".into(), pressure.into())],
        }
    }

    fn streaming(&self) -> Option<&Streaming> {
        Some(Steady::streaming(self))
    }
}
