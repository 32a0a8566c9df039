//! `model = "creep"`: creep compliance as a series.

use asperity::material::{self, Material, Modulus};

use super::{Dependence, Law, Model, few_terms};
use crate::case::keys::*;

/// Creep compliance as series (generalised Kelvin).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Creep {
    /// What the compliances measure: uniaxial tension or shear.
    compliance: Modulus,
    /// Instantaneous compliance.
    #[schemars(example = "4e-4 1/MPa")]
    instantaneous: Compliance<NonNegative>,
    /// The retarded terms.
    #[schemars(example = serde_json::json!([{ "compliance": "4.47e-5 1/MPa", "time": "9.94 s" }]))]
    #[serde(default)]
    terms: Vec<Term>,
    /// Steady flow: rate of compliance after all retardation; none if not given.
    #[schemars(example = "1e-8 1/(MPa s)")]
    fluidity: Option<Fluidity<NonNegative>>,
}

/// One retarded term: its compliance and its retardation time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "CreepTerm")]
pub struct Term {
    /// Compliance of the term.
    #[schemars(example = "4.47e-5 1/MPa")]
    compliance: Compliance<Positive>,
    /// Retardation time.
    #[schemars(example = "9.94 s")]
    time: Time<Positive>,
}

impl Law for Creep {
    fn model(&self, at: &Place<'_>, _: Dependence) -> Option<Model> {
        few_terms(at, self.terms.len())?;
        let term = |term: &Term| material::CreepTerm {
            compliance: term.compliance.get(),
            retardation_time: term.time.get(),
        };
        let creep = material::Creep {
            instantaneous: self.instantaneous.get(),
            terms: self.terms.iter().map(term).collect(),
            fluidity: self.fluidity.map_or(0.0, Fluidity::get),
        };
        Model::known(at, Material::generalised_kelvin(self.compliance, creep))
    }
}
