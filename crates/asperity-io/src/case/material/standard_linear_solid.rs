//! `model = "standard-linear-solid"`.

use asperity::material::{Material, Relaxation};

use super::{Model, springs};
use crate::case::keys::*;

springs! {
    /// Standard linear solid in Maxwell's form: a spring in parallel with a Maxwell element. The same solid as a Zener one, given
    /// by the moduli and the time of a relaxation test.
    StandardLinearSolid [
        young_equilibrium | shear_equilibrium: "after all relaxation", "1 MPa" | "0.4 MPa";
        young_instantaneous | shear_instantaneous: "right after a load", "3 MPa" | "1 MPa";
    ] {
        /// Relaxation time: viscosity over modulus of the Maxwell element.
        relaxation_time: Time<Positive>,
    }
    model |keys, at, measure, [relaxed, instantaneous]| {
        if instantaneous < relaxed {
            let message = format!(
                "the instantaneous modulus, {instantaneous} Pa, is below that after all relaxation, {relaxed} Pa"
            );
            return at.fault(message, "an instantaneous modulus above the relaxed one", "exchange them");
        }
        let terms = [(instantaneous - relaxed, keys.relaxation_time.get())];
        let relaxation = at.core(Relaxation::absolute(relaxed, &terms))?;
        Model::known(at, Material::prony(measure, relaxation))
    }
}
