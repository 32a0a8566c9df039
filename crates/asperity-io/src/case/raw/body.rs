//! `[[body]]`: material, lateral contraction, hardness.

use schemars::JsonSchema;
use serde::Deserialize;

use super::At;
use crate::case::quantity::range::{NonNegative, Poisson, Positive, Share};
use crate::case::quantity::{Compliance, Fluidity, Number, Pressure, Time};

/// A deformable half-space.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name for messages and reports.
    #[schemars(example = &"PMMA")]
    pub name: Option<String>,
    /// Poisson's ratio, constant in time (0.5 = incompressible); this or `bulk_modulus`.
    #[schemars(example = 0.38)]
    pub poisson: Option<Number<Poisson>>,
    /// Bulk modulus, constant in time; this or `poisson`.
    #[schemars(example = "4 GPa")]
    pub bulk_modulus: Option<Pressure<Positive>>,
    /// Cut-off for the pressure; none if not given. The softer body decides.
    #[schemars(example = "300 MPa")]
    pub hardness: Option<Pressure<Positive>>,
    /// Linear viscoelastic material.
    #[schemars(example = serde_json::json!({ "model": "elastic", "young": "2.1 GPa" }))]
    pub material: At<Material>,
}

/// A linear viscoelastic material. Springs and dashpots are given by moduli, either all as Young's (`young`)
/// or all as shear moduli (`shear`); Poisson's ratio or the bulk modulus converts.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(tag = "model")]
pub enum Material {
    /// A spring.
    Elastic(Elastic),
    /// Spring and dashpot in series: a fluid.
    Maxwell(Maxwell),
    /// Spring and dashpot in parallel: no deformation at once.
    KelvinVoigt(KelvinVoigt),
    /// Standard linear solid: a spring in series with a Kelvin element.
    Zener(Zener),
    /// Maxwell and Kelvin elements in series.
    Burgers(Burgers),
    /// Relaxation modulus as Prony series (generalised Maxwell, Wiechert).
    Prony(Prony),
    /// Creep compliance as series (generalised Kelvin).
    Creep(Creep),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Elastic {
    /// Young's modulus; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    pub young: Option<Pressure<Positive>>,
    /// Shear modulus; this or `young`.
    #[schemars(example = "0.8 GPa")]
    pub shear: Option<Pressure<Positive>>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Maxwell {
    /// Young's modulus of the spring; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    pub young: Option<Pressure<Positive>>,
    /// Shear modulus of the spring; this or `young`.
    #[schemars(example = "0.8 GPa")]
    pub shear: Option<Pressure<Positive>>,
    /// Relaxation time: viscosity over modulus.
    #[schemars(example = "10 s")]
    pub relaxation_time: Time<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct KelvinVoigt {
    /// Young's modulus of the spring; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    pub young: Option<Pressure<Positive>>,
    /// Shear modulus of the spring; this or `young`.
    #[schemars(example = "0.8 GPa")]
    pub shear: Option<Pressure<Positive>>,
    /// Retardation time: viscosity over modulus.
    #[schemars(example = "10 s")]
    pub retardation_time: Time<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Zener {
    /// Young's modulus of the spring in series (the modulus at once); this or `shear`.
    #[schemars(example = "2.1 GPa")]
    pub young: Option<Pressure<Positive>>,
    /// Young's modulus of the Kelvin element's spring; with `young`.
    #[schemars(example = "2.1 GPa")]
    pub young_kelvin: Option<Pressure<Positive>>,
    /// Shear modulus of the spring in series (the modulus at once); this or `young`.
    #[schemars(example = "0.8 GPa")]
    pub shear: Option<Pressure<Positive>>,
    /// Shear modulus of the Kelvin element's spring; with `shear`.
    #[schemars(example = "0.8 GPa")]
    pub shear_kelvin: Option<Pressure<Positive>>,
    /// Retardation time of the Kelvin element.
    #[schemars(example = "10 s")]
    pub retardation_time: Time<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Burgers {
    /// Young's modulus of the Maxwell element's spring; this or `shear`.
    #[schemars(example = "2.1 GPa")]
    pub young: Option<Pressure<Positive>>,
    /// Young's modulus of the Kelvin element's spring; with `young`.
    #[schemars(example = "2.1 GPa")]
    pub young_kelvin: Option<Pressure<Positive>>,
    /// Shear modulus of the Maxwell element's spring; this or `young`.
    #[schemars(example = "0.8 GPa")]
    pub shear: Option<Pressure<Positive>>,
    /// Shear modulus of the Kelvin element's spring; with `shear`.
    #[schemars(example = "0.8 GPa")]
    pub shear_kelvin: Option<Pressure<Positive>>,
    /// Relaxation time of the Maxwell element.
    #[schemars(example = "1000 s")]
    pub relaxation_time: Time<Positive>,
    /// Retardation time of the Kelvin element.
    #[schemars(example = "10 s")]
    pub retardation_time: Time<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prony {
    /// What the moduli measure: uniaxial tension or shear.
    pub modulus: Measure,
    /// Modulus after all relaxation, with absolute terms (`modulus`, `time`); 0 for a fluid.
    #[schemars(example = "1973 MPa")]
    pub equilibrium: Option<Pressure<NonNegative>>,
    /// Modulus at once, with relative terms (`fraction`, `time`).
    #[schemars(example = "2491.44 MPa")]
    pub instantaneous: Option<Pressure<Positive>>,
    /// The relaxing terms.
    #[schemars(example = serde_json::json!([{ "modulus": "254.776 MPa", "time": "8.93 s" }]))]
    pub terms: At<Vec<At<PronyTerm>>>,
}

/// One relaxing term: its share of the modulus and its relaxation time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PronyTerm {
    /// Modulus of the term, where `equilibrium` is given.
    #[schemars(example = "254.776 MPa")]
    pub modulus: Option<Pressure<Positive>>,
    /// Share of the modulus at once, where `instantaneous` is given.
    #[schemars(example = 0.25)]
    pub fraction: Option<Number<Share>>,
    /// Relaxation time.
    #[schemars(example = "8.93 s")]
    pub time: Time<Positive>,
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Creep {
    /// What the compliances measure: uniaxial tension or shear.
    pub compliance: Measure,
    /// Compliance at once.
    #[schemars(example = "4e-4 1/MPa")]
    pub instantaneous: Compliance<NonNegative>,
    /// The retarded terms.
    #[schemars(example = serde_json::json!([{ "compliance": "4.47e-5 1/MPa", "time": "9.94 s" }]))]
    #[serde(default)]
    pub terms: Vec<CreepTerm>,
    /// Steady flow: rate of compliance after all retardation; none if not given.
    #[schemars(example = "1e-8 1/(MPa s)")]
    pub fluidity: Option<Fluidity<NonNegative>>,
}

/// One retarded term: its compliance and its retardation time.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CreepTerm {
    /// Compliance of the term.
    #[schemars(example = "4.47e-5 1/MPa")]
    pub compliance: Compliance<Positive>,
    /// Retardation time.
    #[schemars(example = "9.94 s")]
    pub time: Time<Positive>,
}

/// The kind of deformation that a modulus or compliance belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Measure {
    /// Uniaxial tension: Young's modulus.
    Young,
    /// Shear modulus.
    Shear,
}
