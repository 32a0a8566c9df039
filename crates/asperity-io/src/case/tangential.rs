//! `[friction]` and `[tangential]`: a load along the surfaces, which friction holds.

use asperity::Grid;
use asperity::material::Body;
use asperity::tangential::{Coupling, PairRatio, Tangential as Law, TangentialControl};
use ndarray::Array2;

use super::hardness::numbers_of_cells;
use super::history::{History, Kind};
use super::keys::*;

/// Friction between the surfaces, under the load of `[tangential]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Friction coefficient: the largest tangential traction over the pressure. This or `field`.
    #[schemars(example = 0.3)]
    coefficient: Option<Number<NonNegative>>,
    /// The friction coefficient of each cell, from a file relative to the case file: an array of shape (nx, ny) as NPY or NPZ, or a text
    /// matrix with a line for each y and values along x.
    #[schemars(example = "friction.npy")]
    field: Option<String>,
    /// Name of an array that a program gives beside the case: the friction coefficient of each cell.
    #[schemars(skip)]
    array: Option<String>,
    /// Largest tangential traction, whatever the pressure; unlimited if not given.
    #[schemars(example = "50 MPa")]
    shear_limit: Option<Pressure<Positive>>,
    /// What the pressure and the tangential tractions of bodies with different elastic constants do to each other: "neglect" it, or find both
    /// in turn until they agree ("full"). "neglect" if not given.
    #[serde(default)]
    coupling: Coupling,
}

/// A load along the surfaces, with `[friction]`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tangential {
    /// The prescribed quantity: the "force", or the "displacement" of the bodies against each other.
    control: TangentialControl,
    /// Its component along x over the time of the run, with the kinds of load.history; 0 if not given. This or `y`, or both.
    #[schemars(example = serde_json::json!({ "kind": "triangle", "peak": "0.1 N", "rise": "1 s", "fall": "1 s" }))]
    x: Option<History>,
    /// Its component along y; 0 if not given.
    #[schemars(example = serde_json::json!({ "kind": "sine", "mean": "0 N", "amplitude": "50 mN", "frequency": "10 Hz" }))]
    y: Option<History>,
}

impl Tangential {
    /// The load.
    pub fn law(
        &self,
        at: &Place<'_>,
        friction: (&Place<'_>, &Friction),
        grid: Option<&Grid>,
        bodies: (&Place<'_>, &[Body]),
    ) -> Option<Law> {
        let coefficients = friction.1.coefficients(friction.0, grid);
        if self.x.is_none() && self.y.is_none() {
            return at.fault("nothing is prescribed", "`x`, `y` or both", "give x = { kind = ... }");
        }
        let unit = match self.control {
            TangentialControl::Force => grid?.units("N"),
            TangentialControl::Displacement => "m",
        };
        let kind = Kind { unit, presses: false };
        let read = |key: &str, history: &Option<History>| match history {
            None => Some(asperity::History::Step { value: 0.0 }),
            Some(history) => history.read(&at.key(key), kind, "give a step, a ramp or a table"),
        };
        let (x, y) = (read("x", &self.x), read("y", &self.y));
        let PairRatio { poisson, beta, changes } = bodies.0.core(PairRatio::of(bodies.1))?;
        let coupling = friction.1.coupling;
        if coupling == Coupling::Full && changes {
            return friction.0.key("coupling").fault(
                "\"full\" is given for bodies that creep differently",
                "bodies of which one is rigid, or that are elastic or of like materials: otherwise Dundurs' β changes in time",
                "take \"neglect\", or leave out a body that is much stiffer",
            );
        }
        let (coefficient, coefficients) = coefficients?;
        Some(Law {
            coefficient,
            coefficients,
            shear_limit: friction.1.shear_limit.map_or(f64::INFINITY, Pressure::get),
            poisson,
            beta,
            coupling,
            control: self.control,
            histories: [x?, y?],
        })
    }
}

impl Friction {
    /// The friction coefficient, and that of each cell where they differ.
    fn coefficients(&self, at: &Place<'_>, grid: Option<&Grid>) -> Option<(f64, Option<Array2<f64>>)> {
        at.exactly_one(&["coefficient", if self.array.is_some() { "array" } else { "field" }])?;
        let map = match (&self.array, &self.field) {
            (Some(name), _) => at.key("array").array(name, grid?),
            (None, Some(path)) => numbers_of_cells(&at.key("field"), path, grid),
            (None, None) => return Some((self.coefficient?.get(), None)),
        };
        Some((0.0, Some(map?)))
    }
}
