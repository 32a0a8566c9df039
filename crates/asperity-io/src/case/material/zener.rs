//! `model = "zener"`.

use asperity::material::Material;

use super::{Model, springs};
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
    model |keys, at, measure, [modulus, kelvin]| {
        Model::known(at, Material::zener(measure, modulus, kelvin, keys.retardation_time.get()))
    }
}
