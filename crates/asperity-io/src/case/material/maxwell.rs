//! `model = "maxwell"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, modulus};
use crate::case::keys::*;

/// Spring and dashpot in series: a fluid.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Maxwell {
    /// Young's modulus of the spring; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    young: Option<Pressure<Positive>>,
    /// Shear modulus of the spring; this or `young`.
    #[schemars(example = "0.8 GPa")]
    shear: Option<Pressure<Positive>>,
    /// Relaxation time: viscosity over modulus.
    relaxation_time: Time<Positive>,
}

impl Law for Maxwell {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, modulus) = modulus(at, self.young, self.shear)?;
        Model::known(at, Material::maxwell(measure, modulus, self.relaxation_time.get()))
    }
}
