//! `model = "kelvin-voigt"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, modulus};
use crate::case::keys::*;

/// Spring and dashpot in parallel: no instantaneous deformation.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KelvinVoigt {
    /// Young's modulus of the spring; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    young: Option<Pressure<Positive>>,
    /// Shear modulus of the spring; this or `young`.
    #[schemars(example = "0.8 GPa")]
    shear: Option<Pressure<Positive>>,
    /// Retardation time: viscosity over modulus.
    retardation_time: Time<Positive>,
}

impl Law for KelvinVoigt {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, modulus) = modulus(at, self.young, self.shear)?;
        Model::known(at, Material::kelvin_voigt(measure, modulus, self.retardation_time.get()))
    }
}
