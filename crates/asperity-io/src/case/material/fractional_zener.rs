//! `model = "fractional-zener"`.

use asperity::material::Fractional;

use super::{Dependence, Law, Model, relaxed_and_instantaneous};
use crate::case::keys::*;

/// A spring in parallel with a fractional Maxwell element; as a Prony sum over the times of the run.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FractionalZener {
    /// Young's modulus at equilibrium; this or `shear_equilibrium`.
    #[schemars(example = "3 MPa")]
    young_equilibrium: Option<Pressure<Positive>>,
    /// Instantaneous Young's modulus; with `young_equilibrium`.
    #[schemars(example = "3 GPa")]
    young_instantaneous: Option<Pressure<Positive>>,
    /// Shear modulus at equilibrium; this or `young_equilibrium`.
    #[schemars(example = "1 MPa")]
    shear_equilibrium: Option<Pressure<Positive>>,
    /// Instantaneous shear modulus; with `shear_equilibrium`.
    #[schemars(example = "1 GPa")]
    shear_instantaneous: Option<Pressure<Positive>>,
    /// Relaxation time.
    #[schemars(example = "1 ms")]
    time: Time<Positive>,
    /// Order of the derivative: 1 is a Zener solid.
    #[schemars(example = 0.5)]
    order: Number<Order>,
    /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
    #[schemars(example = 1e-3)]
    tolerance: Option<Number<Tolerance>>,
}

impl Law for FractionalZener {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let young = [self.young_equilibrium, self.young_instantaneous];
        let shear = [self.shear_equilibrium, self.shear_instantaneous];
        let (measure, [equilibrium, instantaneous]) = relaxed_and_instantaneous(at, young, shear)?;
        let (time, order) = (self.time.get(), self.order.get());
        let model = Fractional::Zener { equilibrium, instantaneous, time, order };
        Some(Model::fractional(measure, model, time, self.tolerance))
    }
}
