//! `model = "zener"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, springs};
use crate::case::keys::*;

springs! {
    /// Standard linear solid: a spring in series with a Kelvin element.
    Zener [
        young | shear: "of the spring in series (the instantaneous modulus)", "2.1 GPa" | "0.8 GPa";
        young_kelvin | shear_kelvin: "of the Kelvin element's spring", "2.1 GPa" | "0.8 GPa";
    ] {
        /// Retardation time of the Kelvin element.
        retardation_time: Time<Positive>,
    }
}

impl Law for Zener {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, [modulus, kelvin]) = self.springs(at)?;
        Model::known(at, Material::zener(measure, modulus, kelvin, self.retardation_time.get()))
    }
}
