//! What can be known of a sweep before its first velocity.

use super::SteadyMotion;
use crate::error::{Error, Result};
use crate::grid::Boundary;
use crate::load::{Control, Course, History, Stage};
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::sliding::{Direction, Streaming};

impl SteadyMotion {
    /// Checks all that can be known before the first velocity, besides [`Simulation::validate`].
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity.
    pub fn validate(&self, simulation: &Simulation) -> Result<()> {
        Streaming::new(simulation)?;
        held_load(simulation)?;
        validate(simulation, self)
    }
}

fn validate(simulation: &Simulation, motion: &SteadyMotion) -> Result<()> {
    if motion.velocities.is_empty() {
        return Err(Error::invalid("velocities", "none", "one at least"));
    }
    if let Some(v) = motion.velocities.iter().find(|v| !(v.is_finite() && **v >= 0.0)) {
        return Err(Error::invalid("velocity", format!("{v} m/s"), "finite and not negative"));
    }
    if motion.slopes.x.dim() != simulation.grid.shape() || motion.slopes.y.dim() != simulation.grid.shape() {
        return Err(Error::invalid(
            "shape of the slopes",
            format!("{:?}", motion.slopes.x.dim()),
            format!("{:?}, that of the grid", simulation.grid.shape()),
        ));
    }
    if let (Direction::Angle(angle), Boundary::Free) = (motion.direction, simulation.boundary) {
        return Err(Error::invalid(
            "direction of motion on a free domain",
            format!("{:.4} degrees", angle.to_degrees()),
            "x or y; other directions need a periodic domain",
        ));
    }
    if simulation.grid.is_line() && motion.direction != Direction::X {
        return Err(Error::invalid("direction of motion of a line contact", "not x", "x"));
    }
    if simulation.layers.is_some() {
        return Err(Error::invalid(
            "body of a steady state of motion",
            "layers that creep differently",
            "layers and bodies of one relative creep",
        ));
    }
    if simulation.boundary == Boundary::Free && !simulation.kernel.is_half_space() {
        return Err(Error::invalid(
            "body of a steady state of motion on a free domain",
            "layers",
            "a half-space, or boundary = \"periodic\"",
        ));
    }
    if simulation.hardness_map.is_some() {
        return Err(Error::invalid(
            "hardness of a steady state of motion",
            "different from cell to cell",
            "one number: the material streams by",
        ));
    }
    let refused = |q: &&Quantity| q.is_of_time();
    if let Some(quantity) = simulation.quantities.list.iter().find(refused) {
        return Err(Error::invalid(
            "quantity of a steady state of motion",
            quantity.name(),
            "one of the state of a contact; energies and stiffness belong to a run in time",
        ));
    }
    Ok(())
}

/// The load that is held \[N\].
pub(super) fn held_load(simulation: &Simulation) -> Result<f64> {
    let held = match simulation.loading.stages[..] {
        [Stage { control, course: Course::Given(History::Step { value }), until: None, .. }] => {
            Some((control, value))
        }
        _ => None,
    };
    match held {
        Some((Control::Load, value)) if value > 0.0 => Ok(value),
        Some((Control::Pressure, value)) if value > 0.0 => Ok(value * simulation.grid.area()),
        _ => Err(Error::invalid(
            "load of a steady state of motion",
            "not a load or a pressure above 0 that is held",
            "control = \"load\" or \"pressure\" with history = { kind = \"step\", value = ... }",
        )),
    }
}
