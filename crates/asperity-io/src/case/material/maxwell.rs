//! `model = "maxwell"`.

use asperity::material::Material;

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// Spring and dashpot in series: a fluid.
    Maxwell [
        young | shear: "of the spring", "2.1 GPa" | "0.8 GPa";
    ] {
        /// Relaxation time: viscosity over modulus.
        relaxation_time: Time<Positive>,
    }
    model |keys, at, measure, [modulus]| {
        Model::known(at, Material::maxwell(measure, modulus, keys.relaxation_time.get()))
    }
}
