//! `[[body]]`: lateral contraction, hardness; the material has a file of its own.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{At, Material};
use crate::case::quantity::range::{Poisson, Positive};
use crate::case::quantity::{Number, Pressure};

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
    /// Cut-off for the pressure in each cell, from a file. Of several hardnesses the smallest counts.
    #[schemars(example = serde_json::json!({ "path": "hardness.npy", "unit": "1 MPa" }))]
    pub hardness_file: Option<At<HardnessFile>>,
    /// Linear viscoelastic material.
    #[schemars(example = serde_json::json!({ "model": "elastic", "young": "2.1 GPa" }))]
    pub material: At<Material>,
}

/// A number for each cell of the domain.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HardnessFile {
    /// The file, relative to the case file: an array of shape (nx, ny) as NPY or NPZ, or a text matrix with a line for
    /// each y and values along x.
    #[schemars(example = "hardness.npy")]
    pub path: At<String>,
    /// Unit of the numbers in the file; 1 Pa if not given.
    #[schemars(example = "1 MPa")]
    pub unit: Option<Pressure<Positive>>,
}
