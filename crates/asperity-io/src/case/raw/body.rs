//! `[[body]]`: lateral contraction, hardness; the material has a file of its own.

use schemars::JsonSchema;
use serde::Deserialize;

use asperity::layer::Interface;

use super::{At, Material};
use crate::case::quantity::range::{Poisson, Positive};
use crate::case::quantity::{Length, Number, Pressure};

/// A deformable body: a half-space, or layers on a half-space or on a rigid base.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Name for messages and reports.
    #[schemars(example = &"PMMA")]
    pub name: Option<String>,
    /// What the layers lie on; "half-space" if not given. A rigid base has no material.
    pub base: Option<BodyBase>,
    /// Layers from the surface down; none if not given.
    #[serde(default)]
    pub layer: Vec<At<Layer>>,
    /// Thickness of a body without layers, which is solved as a half-space: a finding says where it is too thin for that.
    #[schemars(example = "50 mm")]
    pub thickness: Option<At<Length<Positive>>>,
    /// Poisson's ratio, constant in time (0.5 = incompressible); this or `bulk_modulus`. With layers: of the half-space below.
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
    /// Name of an array that a program gives beside the case: the cut-off for the pressure in each cell.
    #[schemars(skip)]
    pub hardness_array: Option<At<String>>,
    /// Linear viscoelastic material; needed unless the base is rigid. With layers: of the half-space below.
    #[schemars(example = serde_json::json!({ "model": "elastic", "young": "2.1 GPa" }))]
    pub material: Option<At<Material>>,
}

/// What layers lie on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BodyBase {
    /// A half-space of the body's material.
    #[default]
    HalfSpace,
    /// A base that does not yield.
    Rigid,
}

/// A layer of a body.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Layer {
    /// Thickness of the layer.
    #[schemars(example = "10 mm")]
    pub thickness: Length<Positive>,
    /// Poisson's ratio, constant in time (0.5 = incompressible); this or `bulk_modulus`.
    #[schemars(example = 0.49)]
    pub poisson: Option<Number<Poisson>>,
    /// Bulk modulus, constant in time, of an elastic layer; this or `poisson`.
    #[schemars(example = "4 GPa")]
    pub bulk_modulus: Option<Pressure<Positive>>,
    /// Linear viscoelastic material.
    #[schemars(example = serde_json::json!({ "model": "elastic", "young": "5 MPa" }))]
    pub material: At<Material>,
    /// To what lies below; "bonded" if not given.
    pub interface: Option<Interface>,
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
