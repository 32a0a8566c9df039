//! `model = "burgers"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, kelvin_modulus, modulus};
use crate::case::keys::*;

/// Maxwell and Kelvin elements in series.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Burgers {
    /// Young's modulus of the Maxwell element's spring; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    young: Option<Pressure<Positive>>,
    /// Young's modulus of the Kelvin element's spring; with `young`.
    #[schemars(example = "2.1 GPa")]
    young_kelvin: Option<Pressure<Positive>>,
    /// Shear modulus of the Maxwell element's spring; this or `young`.
    #[schemars(example = "0.8 GPa")]
    shear: Option<Pressure<Positive>>,
    /// Shear modulus of the Kelvin element's spring; with `shear`.
    #[schemars(example = "0.8 GPa")]
    shear_kelvin: Option<Pressure<Positive>>,
    /// Relaxation time of the Maxwell element.
    #[schemars(example = "1000 s")]
    relaxation_time: Time<Positive>,
    /// Retardation time of the Kelvin element.
    retardation_time: Time<Positive>,
}

impl Law for Burgers {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, modulus) = modulus(at, self.young, self.shear)?;
        let kelvin = kelvin_modulus(at, measure, self.young_kelvin, self.shear_kelvin)?;
        let [relaxation, retardation] = [self.relaxation_time, self.retardation_time].map(Time::get);
        Model::known(at, Material::burgers(measure, modulus, relaxation, kelvin, retardation))
    }
}
