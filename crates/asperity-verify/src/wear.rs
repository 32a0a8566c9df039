//! Wear: Archard's volume, the flat of a worn sphere, the even pressure under a worn punch.

use std::f64::consts::PI;
use std::sync::Arc;

use super::{Check, Checks, last, number, shape_on, step_load};
use asperity::error::Result;
use asperity::load::History;
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::Simulation;
use asperity::sliding::Path;
use asperity::surface::{Punch, Shape};
use asperity::time::TimeGrid;
use asperity::wear::Wear;

pub(super) fn archard() -> Result<Vec<Check>> {
    let mut checks = Checks::new("wear", "Archard, J. Appl. Phys. 24 (1953) 981");
    let path = || Path::of_velocity(History::Step { value: 1.0 }, 0.0);
    let worn = |shape: Shape, load: f64, k: f64, steps: usize| -> Result<Simulation> {
        Ok(Simulation {
            loading: step_load(load),
            times: TimeGrid::Uniform { end: 1.0, steps },
            quantities: Quantities::of([Quantity::WearVolume, Quantity::WearDepthMax]),
            wear: Some(Arc::new(Wear { path: Some(path()?), ..Wear::new([k, 0.0]) })),
            ..shape_on(128, 0.3, shape)?
        })
    };
    // Worn 10⁴ times deeper than it yields: a = (4 R k W s/π)^(1/4), depth a²/2R.
    let (load, k) = (1e-6, 100.0);
    let a = (4.0 * k * load / PI).powf(0.25);
    last(worn(Shape::Sphere { radius: 1.0 }, load, k, 12)?, |step| {
        checks.relative("worn volume", number(step, Quantity::WearVolume), k * load, 1e-12);
        checks.relative("radius of the flat of a sphere", (step.row().contact_area / PI).sqrt(), a, 0.01);
        checks.relative("depth of the flat", number(step, Quantity::WearDepthMax), 0.5 * a * a, 0.01);
        Ok(())
    })?;
    let punch = Shape::FlatPunch(Punch::Circle { radius: 0.1 });
    let ratio = last(worn(punch, 1e-4, 1e3, 8)?, |step| {
        let row = step.row();
        Ok(row.max_pressure * row.contact_area / row.load)
    })?;
    let name = "largest pressure of a worn punch over the mean";
    checks.relative(name, ratio.unwrap_or(f64::NAN), 1.0, 1e-4);
    Ok(checks.list)
}
