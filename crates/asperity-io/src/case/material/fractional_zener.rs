//! `model = "fractional-zener"`.

use asperity::material::Fractional;

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// A spring in parallel with a fractional Maxwell element; as a Prony sum over the times of the run.
    FractionalZener [
        young_equilibrium | shear_equilibrium: "after all relaxation", "3 MPa" | "1 MPa";
        young_instantaneous | shear_instantaneous: "right after a load", "3 GPa" | "1 GPa";
    ] {
        /// Relaxation time.
        #[schemars(example = "1 ms")]
        time: Time<Positive>,
        /// Order of the derivative: 1 is a Zener solid.
        #[schemars(example = 0.5)]
        order: Number<Order>,
        /// Largest relative error of the Prony sum over the times of the run; 1e-3 if not given.
        #[schemars(example = 1e-3)]
        tolerance: Option<Number<Tolerance>>,
    }
    model |keys, at, measure, [equilibrium, instantaneous]| {
        let (time, order) = (keys.time.get(), keys.order.get());
        let model = Fractional::Zener { equilibrium, instantaneous, time, order };
        Some(Model::fractional(measure, model, time, keys.tolerance))
    }
}
