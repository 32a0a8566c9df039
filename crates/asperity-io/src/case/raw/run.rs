//! `[solver]` and `[output]`.

use schemars::JsonSchema;
use serde::Deserialize;

use super::At;
use crate::case::quantity::range::{NonNegative, Positive, Tolerance};
use crate::case::quantity::{Length, Number, Pressure, Time, Whole};

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
    /// What flattening at the hardness leaves behind; "cap" if not given.
    pub plasticity: Option<At<Plasticity>>,
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
    /// A dent: what a cell is flattened by is added to the undeformed gap after every row and stays. Needs a hardness.
    Accumulate,
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
    /// Quantities that each row has besides load, approach and areas; ["all"] for all that the case allows.
    #[schemars(example = ["contact_stiffness", "contact_spots", "dissipated_energy"])]
    pub quantities: Option<Vec<At<Quantity>>>,
    /// Bins of the histograms among the quantities.
    #[schemars(example = serde_json::json!({ "bins": 50, "pressure": "300 MPa" }))]
    pub histogram: Option<At<Histogram>>,
    /// Fields are stored at the first row, at every n-th row after it and at the last row; if not given, n is
    /// a tenth of the number of steps (10 where steps are adaptive). This or `times`.
    #[schemars(example = 10)]
    pub every: Option<At<Whole<1>>>,
    /// Instants at which fields are stored, besides the first and the last row; each becomes a step, or where steps are
    /// adaptive the state there is interpolated. This or `every`.
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
    /// Permanent flattening, in m; with plasticity = "accumulate".
    Flattening,
}

/// A quantity of each row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// All that the case allows.
    All,
    /// Slope of load over approach under a small, sudden change, in N/m; some ten convolutions a row.
    ContactStiffness,
    /// Number of contact spots.
    ContactSpots,
    /// Area of the largest contact spot, in m2.
    LargestSpot,
    /// Mean area of a contact spot, in m2.
    MeanSpot,
    /// Length of the border of the contact, counted along the edges of cells, in m.
    ContactPerimeter,
    /// Root of the mean square of the gap, in m.
    RmsGap,
    /// Energy in the springs of the bodies, in J.
    ElasticEnergy,
    /// Heat since the start, in J.
    DissipatedEnergy,
    /// Work on the cells at the hardness, in J.
    FlatteningWork,
    /// Work of the load since the start, in J.
    ExternalWork,
    /// Number of contact spots per class of area: 1 cell, 2 to 3, 4 to 7, and so on.
    SpotHistogram,
    /// Probability density of the pressure of the cells in contact, in 1/Pa.
    PressureHistogram,
    /// Probability density of the gap of the open cells, in 1/m.
    GapHistogram,
}

/// Bins of the histograms of pressure and gap; they begin at 0 and have one width.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Histogram {
    /// Number of bins, at most 10000; 50 if not given.
    #[schemars(example = 50)]
    pub bins: Option<At<Whole<1>>>,
    /// Upper end of the pressure; the hardness if not given, needed where there is none.
    #[schemars(example = "300 MPa")]
    pub pressure: Option<Pressure<Positive>>,
    /// Upper end of the gap; the largest undeformed gap if not given.
    #[schemars(example = "5 um")]
    pub gap: Option<Length<Positive>>,
}
