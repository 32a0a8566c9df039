//! The clocks of the bodies: laboratory time, and the reduced time of each body whose temperature changes.

use crate::material::ReducedTime;
use crate::simulation::Simulation;
use crate::step::Interval;

pub(super) struct Clocks {
    bodies: Vec<ReducedTime>,
    /// Of the step measured last.
    pub(super) lengths: Vec<f64>,
}

impl Clocks {
    pub(super) fn new(simulation: &Simulation) -> Self {
        let bodies: Vec<ReducedTime> = simulation.thermal.iter().map(|body| body.clock.clone()).collect();
        Clocks { lengths: vec![0.0; bodies.len() + 1], bodies }
    }

    /// Measures a step in laboratory time, and then on the clock of each body.
    pub(super) fn measure(&mut self, step: &Interval) {
        let clocked = self.bodies.iter().map(|clock| clock.elapsed(step.start, step.instant.time));
        let all = std::iter::once(step.length()).chain(clocked);
        self.lengths.iter_mut().zip(all).for_each(|(length, x)| *length = x);
    }

    /// Rate of the fastest clock of a body over a time `dt` from `start` on, not less than `laboratory`.
    pub(super) fn fastest(&self, start: f64, dt: f64, laboratory: f64) -> f64 {
        let end = start + dt;
        self.bodies.iter().map(|clock| clock.elapsed(start, end) / dt).fold(laboratory, f64::max)
    }
}
