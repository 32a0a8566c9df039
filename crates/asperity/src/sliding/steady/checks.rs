//! What can be known of a sweep before its first velocity.

use super::SteadyMotion;
use crate::error::{Error, Of, Result, require};
use crate::grid::Boundary;
use crate::load::{Control, Course, History, Stage};
use crate::simulation::{Plasticity, Simulation};
use crate::sliding::{ShearStress, Streaming};

impl SteadyMotion {
    /// Checks all that can be known before the first velocity, besides [`Simulation::validate`].
    ///
    /// # Errors
    /// [`Error::Invalid`] naming the quantity.
    pub fn validate(&self, simulation: &Simulation) -> Result<()> {
        Streaming::new(simulation)?;
        held_load(simulation)?;
        let Simulation { grid, boundary, kernel, .. } = simulation;
        require(!self.velocities.is_empty(), "velocities", "none", "one at least")?;
        if let Some(v) = self.velocities.iter().find(|v| !(v.is_finite() && **v >= 0.0)) {
            return Err(Error::invalid("velocity", format!("{v} m/s"), "finite and not negative"));
        }
        let fits = self.slopes.x.dim() == grid.shape() && self.slopes.y.dim() == grid.shape();
        let shape = format!("{:?}", self.slopes.x.dim());
        require(fits, "shape of the slopes", shape, format!("{:?}, that of the grid", grid.shape()))?;
        self.direction.validate(simulation)?;
        self.shear_stress.iter().try_for_each(ShearStress::validate).of("shear_stress")?;
        require(
            simulation.layers.is_none(),
            "body of a steady state of motion",
            "layers that creep differently",
            "layers and bodies of one relative creep",
        )?;
        require(
            *boundary == Boundary::Periodic || kernel.is_half_space(),
            "body of a steady state of motion on a free domain",
            "layers",
            "a half-space, or boundary = \"periodic\"",
        )?;
        require(
            simulation.traction.is_none(),
            "body of a steady state of motion",
            "one that adheres or that a fluid acts on",
            "one without: take a motion in time",
        )?;
        require(
            simulation.plasticity == Plasticity::Cap,
            "plasticity of a steady state of motion",
            "accumulate",
            "cap: dents that stay are made in time",
        )?;
        require(
            simulation.hardness_map.is_none(),
            "hardness of a steady state of motion",
            "different from cell to cell",
            "one number: the material streams by",
        )?;
        let refused = simulation.quantities.list.iter().find(|quantity| quantity.is_of_time());
        require(
            refused.is_none(),
            "quantity of a steady state of motion",
            refused.map_or("", |quantity| quantity.name()),
            "one of the state of a contact; energies and stiffness belong to a run in time",
        )
    }
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
