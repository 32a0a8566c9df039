//! `[solver]` and `[output]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::At;
use crate::case::quantity::range::{NonNegative, Tolerance};
use crate::case::quantity::{Number, Time, Whole};

/// How each step is solved.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Method; "projected-cg" if not given.
    #[serde(default)]
    pub method: Method,
    /// Largest residual of a converged step, relative to the mean displacement; 1e-6 if not given.
    #[schemars(example = 1e-6)]
    pub tolerance: Option<Number<Tolerance>>,
    /// Most iterations of one step.
    #[schemars(example = 1000)]
    pub max_iterations: Option<Whole<1>>,
    /// Floating-point numbers of the iterations; "double" if not given.
    #[serde(default)]
    pub precision: Precision,
    /// What flattening leaves behind; "cap" if not given.
    #[serde(default)]
    pub plasticity: Plasticity,
}

/// Solver of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Preconditioned projected conjugate gradients.
    #[default]
    ProjectedCg,
    /// The conjugate gradients of Polonsky and Keer (1999).
    PolonskyKeer,
}

/// Floating-point numbers of the iterations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 64 bits.
    #[default]
    Double,
    /// The steps of the iterations in 32 bits, their sum and every check in 64: the same tolerance in less time. With
    /// "projected-cg".
    Mixed,
}

/// What flattening leaves behind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Plasticity {
    /// Nothing: the pressure is cut off at the hardness, the flattening heals on unloading.
    #[default]
    Cap,
}

/// What is stored, and where.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The result, relative to the working directory; the case file's name with ".zarr" if not given.
    #[schemars(example = "rough_pmma.zarr")]
    pub path: Option<At<String>>,
    /// The fields that are stored; ["pressure", "gap"] if not given, [] for none.
    #[schemars(example = ["pressure", "gap"])]
    pub fields: Option<Vec<At<Field>>>,
    /// Fields are stored at the first row, at every n-th row after it and at the last row; if not given, n is
    /// a tenth of the number of steps. This or `times`.
    #[schemars(example = 10)]
    pub every: Option<At<Whole<1>>>,
    /// Instants at which fields are stored, besides the first and the last row; each becomes a step. This or
    /// `every`.
    #[schemars(example = ["1 s", "10 s", "100 s"])]
    pub times: Option<At<Vec<At<Time<NonNegative>>>>>,
    /// Whether a run can be resumed; true if not given.
    #[schemars(example = true)]
    pub checkpoint: Option<bool>,
}

/// A field over the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Field {
    /// Contact pressure, in Pa.
    Pressure,
    /// Gap between the deformed surfaces, in m.
    Gap,
    /// Normal displacement, in m.
    Displacement,
    /// Contact state: 0 out of contact, 1 in contact, 2 at the hardness.
    Contact,
}
