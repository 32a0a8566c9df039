//! `model = "fractional-maxwell"`.

use asperity::material::Fractional;

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// Spring and springpot in series; as a Prony sum over the times of the run.
    FractionalMaxwell [
        young | shear: "of the spring", "3 MPa" | "1 MPa";
    ] {
        /// Relaxation time.
        #[schemars(example = "1 s")]
        time: Time<Positive>,
        /// Order of the derivative: 1 is a Maxwell element.
        order: Number<Order>,
        /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
        #[schemars(example = 1e-3)]
        tolerance: Option<Number<Tolerance>>,
    }
    model |keys, at, measure, [modulus]| {
        let (time, order) = (keys.time.get(), keys.order.get());
        Some(Model::fractional(measure, Fractional::Maxwell { modulus, time, order }, time, keys.tolerance))
    }
}
