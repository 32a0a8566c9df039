//! `model = "fractional-maxwell"`.

use asperity::material::Fractional;

use super::{Dependence, Law, Model, modulus};
use crate::case::keys::*;

/// Spring and springpot in series; as a Prony sum over the times of the run.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FractionalMaxwell {
    /// Young's modulus of the spring; this or `shear`.
    #[schemars(example = "3 MPa")]
    young: Option<Pressure<Positive>>,
    /// Shear modulus of the spring; this or `young`.
    #[schemars(example = "1 MPa")]
    shear: Option<Pressure<Positive>>,
    /// Relaxation time.
    #[schemars(example = "1 s")]
    time: Time<Positive>,
    /// Order of the derivative: 1 is a Maxwell element.
    order: Number<Order>,
    /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
    #[schemars(example = 1e-3)]
    tolerance: Option<Number<Tolerance>>,
}

impl Law for FractionalMaxwell {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, modulus) = modulus(at, self.young, self.shear)?;
        let (time, order) = (self.time.get(), self.order.get());
        let model = Fractional::Maxwell { modulus, time, order };
        Some(Model::fractional(measure, model, time, self.tolerance))
    }
}
