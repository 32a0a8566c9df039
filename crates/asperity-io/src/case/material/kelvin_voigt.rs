//! `model = "kelvin-voigt"`.

use asperity::material::Material;

use super::{Dependence, Law, Model, springs};
use crate::case::keys::*;

springs! {
    /// Spring and dashpot in parallel: no instantaneous deformation.
    KelvinVoigt [
        young | shear: "of the spring", "2.1 GPa" | "0.8 GPa";
    ] {
        /// Retardation time: viscosity over modulus.
        retardation_time: Time<Positive>,
    }
}

impl Law for KelvinVoigt {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, [modulus]) = self.springs(at)?;
        Model::known(at, Material::kelvin_voigt(measure, modulus, self.retardation_time.get()))
    }
}
