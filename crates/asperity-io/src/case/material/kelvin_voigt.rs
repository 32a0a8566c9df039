//! `model = "kelvin-voigt"`.

use asperity::material::Material;

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// Spring and dashpot in parallel: no instantaneous deformation.
    KelvinVoigt [
        young | shear: "of the spring", "2.1 GPa" | "0.8 GPa";
    ] {
        /// Retardation time: viscosity over modulus.
        retardation_time: Time<Positive>,
    }
    model |keys, at, measure, [modulus]| {
        Model::known(at, Material::kelvin_voigt(measure, modulus, keys.retardation_time.get()))
    }
}
