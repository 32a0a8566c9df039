//! `model = "burgers"`.

use asperity::material::Material;

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// Maxwell and Kelvin elements in series.
    Burgers [
        young | shear: "of the Maxwell element's spring", "2.1 GPa" | "0.8 GPa";
        young_kelvin | shear_kelvin: "of the Kelvin element's spring", "2.1 GPa" | "0.8 GPa";
    ] {
        /// Relaxation time of the Maxwell element.
        #[schemars(example = "1000 s")]
        relaxation_time: Time<Positive>,
        /// Retardation time of the Kelvin element.
        retardation_time: Time<Positive>,
    }
    model |keys, at, measure, [modulus, kelvin]| {
        let [relaxation, retardation] = [keys.relaxation_time, keys.retardation_time].map(Time::get);
        Model::known(at, Material::burgers(measure, modulus, relaxation, kelvin, retardation))
    }
}
