//! `model = "elastic"`.

use asperity::material::Material;

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// A spring.
    Elastic [
        young | shear: "of the spring", "2.1 GPa" | "0.8 GPa";
    ] {
    }
    model |keys, at, measure, [modulus]| Model::known(at, Material::elastic(measure, modulus))
}
