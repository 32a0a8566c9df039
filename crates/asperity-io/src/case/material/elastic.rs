//! `model = "elastic"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, springs};
use crate::case::keys::*;

springs! {
    /// A spring.
    Elastic [
        young | shear: "of the spring", "2.1 GPa" | "0.8 GPa";
    ] {
    }
}

impl Law for Elastic {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, [modulus]) = self.springs(at)?;
        Model::known(at, Material::elastic(measure, modulus))
    }
}
