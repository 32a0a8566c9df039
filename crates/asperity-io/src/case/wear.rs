//! `[wear]`: what sliding takes off the surfaces.

use asperity::Grid;
use asperity::sliding::Path;
use asperity::wear::Wear as Law;

use super::hardness::numbers_of_cells;
use super::history::{Course, Kind};
use super::keys::*;
use crate::quantity::WearCoefficient;

/// Wear of the surfaces by Archard's law: depth per sliding distance = coefficient x pressure.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wear {
    /// Wear coefficient k of the body that carries the moving surfaces, or a list of two: of that body and of the counterbody.
    #[schemars(example = "1e-15 m2/N")]
    #[schemars(example = serde_json::json!(["1e-6 mm3/(N m)", "2e-7 mm3/(N m)"]))]
    coefficient: Form<WearCoefficient<NonNegative>, Vec<WearCoefficient<NonNegative>>>,
    /// Sliding velocity where nothing moves on the grid, as of a pin on a disc: a constant, or a history as in `[load]`. With `[motion]` or
    /// `[tangential]` their sliding counts instead.
    #[schemars(example = "0.1 m/s")]
    velocity: Option<Course<Velocity>>,
    /// Pressure below which nothing wears: the depth per distance is coefficient x (pressure - threshold); 0 if not given.
    #[schemars(example = "10 MPa")]
    threshold: Option<Pressure<NonNegative>>,
    /// A factor of the coefficient in each cell, from a file relative to the case file: an array of shape (nx, ny) as NPY or NPZ, or a text
    /// matrix with a line for each y and values along x.
    #[schemars(example = "wear.npy")]
    map: Option<String>,
    /// Name of an array that a program gives beside the case: the factor of each cell.
    #[schemars(skip)]
    array: Option<String>,
    /// Cycles that each computed cycle of `[tangential]` stands for, with `cycles_tolerance` at most; 1 if not given. A finding says when they
    /// are too many.
    #[schemars(example = 1000)]
    cycles_per_step: Option<Number<Positive>>,
    /// Share of what a computed cycle wears whose place may be uncertain: the cycles that it stands for are chosen by it, from 1 on. They are always
    /// `cycles_per_step` if not given.
    #[schemars(example = "2 %")]
    cycles_tolerance: Option<Number<Positive>>,
    /// Depth at which a body is worn out: the result says after which time, distance and cycles; not asked if not given.
    #[schemars(example = "5 um")]
    depth_limit: Option<Length<Positive>>,
}

impl Word for WearCoefficient<NonNegative> {
    const FORMS: &'static str = "a wear coefficient such as \"1e-15 m2/N\", or a list of two";
    const IS_QUANTITY: bool = true;
}

impl Wear {
    /// The law. `slides` tells whether `[motion]` or `[tangential]` gives the sliding distance.
    pub fn law(&self, at: &Place<'_>, grid: Option<&Grid>, slides: Option<&str>) -> Option<Law> {
        let (body, counterbody) =
            self.coefficient.one_or_two(&at.key("coefficient"), "the body and the counterbody")?;
        let coefficients = [body.get(), counterbody.map_or(0.0, WearCoefficient::get)];
        let path = match (&self.velocity, slides) {
            (None, None) => {
                return at.fault(
                    "nothing says how far the surfaces slide",
                    "`velocity`, or a section [motion] or [tangential]",
                    "give [wear] velocity = \"0.1 m/s\" where the contact stays in its place, as of a pin on a disc",
                );
            }
            (Some(_), Some(section)) => {
                let help = format!("delete `velocity`, or [{section}]");
                let message = format!("the sliding distance is that of [{section}]");
                return at.key("velocity").fault(message, "one of the two", &help);
            }
            (Some(velocity), None) => {
                let at = at.key("velocity");
                let history = velocity.history(&at, Kind::VELOCITY, "")?;
                Some(at.core(Path::of_velocity(history, 0.0))?)
            }
            (None, Some(_)) => None,
        };
        let map = match (&self.array, &self.map) {
            (Some(name), _) => Some(at.key("array").array(name, grid?)?),
            (None, Some(path)) => Some(numbers_of_cells(&at.key("map"), path, grid)?),
            (None, None) => None,
        };
        Some(Law {
            coefficients,
            map,
            threshold: self.threshold.map_or(0.0, Pressure::get),
            path,
            cycles: self.cycles_per_step.map_or(1.0, Number::get),
            cycles_tolerance: self.cycles_tolerance.map(Number::get),
            depth_limit: self.depth_limit.map(Length::get),
        })
    }
}
