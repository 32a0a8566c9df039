//! `model = "springpot"`.

use asperity::material::Fractional;

use super::{Dependence, Law, Model, springs};
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
}

impl Law for Springpot {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let (measure, [modulus]) = self.springs(at)?;
        let (time, order) = (self.time.get(), self.order.get());
        let model = Fractional::Springpot { modulus, time, order };
        Some(Model::fractional(measure, model, time, self.tolerance))
    }
}
