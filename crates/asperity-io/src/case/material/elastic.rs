//! `model = "elastic"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, modulus};
use crate::case::keys::*;

/// A spring.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elastic {
    /// Young's modulus; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    young: Option<Pressure<Positive>>,
    /// Shear modulus; this or `young`.
    #[schemars(example = "0.8 GPa")]
    shear: Option<Pressure<Positive>>,
}

impl Law for Elastic {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, modulus) = modulus(at, self.young, self.shear)?;
        Model::known(at, Material::elastic(measure, modulus))
    }
}
