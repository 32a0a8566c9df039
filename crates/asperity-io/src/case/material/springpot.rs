//! `model = "springpot"`.

use asperity::material::Fractional;

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// A power law, between spring and dashpot: J = (t/time)^order / (modulus Gamma(1 + order)); as a Prony sum
    /// over the times of the run.
    Springpot [
        young | shear: "at `time`", "3 MPa" | "1 MPa";
    ] {
        /// Time at which the compliance is 1/(modulus Gamma(1 + order)).
        #[schemars(example = "1 s")]
        time: Time<Positive>,
        /// Order of the derivative: 0 would be a spring, 1 is a dashpot.
        order: Number<Order>,
        /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
        #[schemars(example = 1e-3)]
        tolerance: Option<Number<Tolerance>>,
    }
    model |keys, at, measure, [modulus]| {
        let (time, order) = (keys.time.get(), keys.order.get());
        Some(Model::fractional(measure, Fractional::Springpot { modulus, time, order }, time, keys.tolerance))
    }
}
