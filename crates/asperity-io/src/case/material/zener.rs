//! `model = "zener"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, kelvin_modulus, modulus};
use crate::case::keys::*;

/// Standard linear solid: a spring in series with a Kelvin element.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Zener {
    /// Young's modulus of the spring in series (the instantaneous modulus); this or `shear`.
    #[schemars(example = "2.1 GPa")]
    young: Option<Pressure<Positive>>,
    /// Young's modulus of the Kelvin element's spring; with `young`.
    #[schemars(example = "2.1 GPa")]
    young_kelvin: Option<Pressure<Positive>>,
    /// Shear modulus of the spring in series (the instantaneous modulus); this or `young`.
    #[schemars(example = "0.8 GPa")]
    shear: Option<Pressure<Positive>>,
    /// Shear modulus of the Kelvin element's spring; with `shear`.
    #[schemars(example = "0.8 GPa")]
    shear_kelvin: Option<Pressure<Positive>>,
    /// Retardation time of the Kelvin element.
    retardation_time: Time<Positive>,
}

impl Law for Zener {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, modulus) = modulus(at, self.young, self.shear)?;
        let kelvin = kelvin_modulus(at, measure, self.young_kelvin, self.shear_kelvin)?;
        Model::known(at, Material::zener(measure, modulus, kelvin, self.retardation_time.get()))
    }
}
