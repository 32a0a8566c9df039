//! `model = "maxwell"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, springs};
use crate::case::keys::*;

springs! {
    /// Spring and dashpot in series: a fluid.
    Maxwell [
        young | shear: "of the spring", "2.1 GPa" | "0.8 GPa";
    ] {
        /// Relaxation time: viscosity over modulus.
        relaxation_time: Time<Positive>,
    }
}

impl Law for Maxwell {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, [modulus]) = self.springs(at)?;
        Model::known(at, Material::maxwell(measure, modulus, self.relaxation_time.get()))
    }
}
