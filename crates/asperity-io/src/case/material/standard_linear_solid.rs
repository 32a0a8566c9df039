//! `model = "standard-linear-solid"`.

use asperity::material::{Material, Relaxation};

use super::{Dependence, Law, Model, relaxed_and_instantaneous};
use crate::case::keys::*;

/// Standard linear solid in Maxwell's form: a spring in parallel with a Maxwell element. The same solid as a Zener one, given
/// by the moduli and the time of a relaxation test.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StandardLinearSolid {
    /// Young's modulus after all relaxation; this or `shear_equilibrium`.
    #[schemars(example = "1 MPa")]
    young_equilibrium: Option<Pressure<Positive>>,
    /// Instantaneous Young's modulus; with `young_equilibrium`.
    #[schemars(example = "3 MPa")]
    young_instantaneous: Option<Pressure<Positive>>,
    /// Shear modulus after all relaxation; this or `young_equilibrium`.
    #[schemars(example = "0.4 MPa")]
    shear_equilibrium: Option<Pressure<Positive>>,
    /// Instantaneous shear modulus; with `shear_equilibrium`.
    #[schemars(example = "1 MPa")]
    shear_instantaneous: Option<Pressure<Positive>>,
    /// Relaxation time: viscosity over modulus of the Maxwell element.
    relaxation_time: Time<Positive>,
}

impl Law for StandardLinearSolid {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        let young = [self.young_equilibrium, self.young_instantaneous];
        let shear = [self.shear_equilibrium, self.shear_instantaneous];
        let (measure, [relaxed, instantaneous]) = relaxed_and_instantaneous(at, young, shear)?;
        if instantaneous < relaxed {
            let message = format!(
                "the instantaneous modulus, {instantaneous} Pa, is below that after all relaxation, {relaxed} Pa"
            );
            return at.fault(message, "an instantaneous modulus above the relaxed one", "exchange them");
        }
        let terms = [(instantaneous - relaxed, self.relaxation_time.get())];
        let relaxation = at.core(Relaxation::absolute(relaxed, &terms))?;
        Model::known(at, Material::prony(measure, relaxation))
    }
}
