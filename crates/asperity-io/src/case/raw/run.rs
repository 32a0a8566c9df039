//! `[solver]` and `[output]`.

use std::borrow::Cow;
use std::fmt;
use std::sync::OnceLock;

use asperity::quantities::Quantity;
use asperity::{Method, Plasticity};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{Error, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::{Value, json};

use super::At;
use crate::case::quantity::range::{NonNegative, Positive, Tolerance};
use crate::case::quantity::{Length, Number, Pressure, Time, Whole};
use crate::store::FieldKind;

/// How each step is solved.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Method; "projected-cg" if not given.
    pub method: Option<Method>,
    /// Largest residual of a converged step, relative to the mean displacement; 1e-6 if not given.
    #[schemars(example = 1e-6)]
    pub tolerance: Option<Number<Tolerance>>,
    /// Largest number of iterations of one step.
    #[schemars(example = 1000)]
    pub max_iterations: Option<Whole<1>>,
    /// What remains of the flattening at the hardness after unloading; "cap" if not given.
    pub plasticity: Option<At<Plasticity>>,
}

/// What is stored, and where.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The result, relative to the working directory; the case file's name with ".zarr" if not given.
    #[schemars(example = "rough_pmma.zarr")]
    pub path: Option<At<String>>,
    /// The fields that are stored; ["pressure", "gap"] if not given, [] for none.
    #[schemars(example = ("pressure", "gap"))]
    pub fields: Option<Vec<At<FieldKind>>>,
    /// Optional quantities of each row, in addition to load, approach and areas; ["all"] for all that the case allows.
    #[schemars(example = ("contact_stiffness", "contact_spots", "dissipated_energy"))]
    pub quantities: Option<Vec<At<Quantities>>>,
    /// Bins of the histograms among the quantities.
    #[schemars(example = serde_json::json!({ "bins": 50, "pressure": "300 MPa" }))]
    pub histogram: Option<At<Histogram>>,
    /// Fields are stored at the first row, at every n-th row after it and at the last row; if not given, n is
    /// a tenth of the number of steps (10 if steps are adaptive). This or `times`.
    #[schemars(example = 10)]
    pub every: Option<At<Whole<1>>>,
    /// Times at which fields are stored, in addition to the first and the last row. Each becomes a step; if steps are
    /// adaptive the state there is interpolated instead. This or `every`.
    #[schemars(example = ("1 s", "10 s", "100 s"))]
    pub times: Option<At<Vec<At<Time<NonNegative>>>>>,
    /// Whether a run can be resumed; true if not given.
    #[schemars(example = true)]
    pub checkpoint: Option<bool>,
}

/// A quantity of each row, or all that the case allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantities {
    All,
    One(Quantity),
}

impl Quantities {
    /// The words of this choice: "all" and the names of the quantities.
    fn words() -> &'static [&'static str] {
        static WORDS: OnceLock<Vec<&'static str>> = OnceLock::new();
        WORDS.get_or_init(|| std::iter::once("all").chain(Quantity::ALL.map(Quantity::name)).collect())
    }
}

impl<'de> Deserialize<'de> for Quantities {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Word;

        impl Visitor<'_> for Word {
            type Value = Quantities;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"all\" or the name of a quantity")
            }

            fn visit_str<E: Error>(self, word: &str) -> Result<Quantities, E> {
                let one = |word| Quantity::from_name(word).map(Quantities::One);
                let chosen = if word == "all" { Some(Quantities::All) } else { one(word) };
                chosen.ok_or_else(|| E::unknown_variant(word, Quantities::words()))
            }
        }

        deserializer.deserialize_str(Word)
    }
}

impl JsonSchema for Quantities {
    fn schema_name() -> Cow<'static, str> {
        Quantity::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = Quantity::json_schema(generator);
        if let Some(Value::Array(members)) = schema.get_mut("oneOf") {
            members.insert(
                0,
                json!({ "type": "string", "const": "all", "description": "All that the case allows." }),
            );
        }
        schema
    }
}

/// Bins of the histograms of pressure and gap; they begin at 0 and have equal widths.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Histogram {
    /// Number of bins, at most 10000; 50 if not given.
    #[schemars(example = 50)]
    pub bins: Option<At<Whole<1>>>,
    /// Upper end of the pressure; the hardness if not given, needed without a hardness.
    #[schemars(example = "300 MPa")]
    pub pressure: Option<Pressure<Positive>>,
    /// Upper end of the gap; the largest undeformed gap if not given.
    #[schemars(example = "5 um")]
    pub gap: Option<Length<Positive>>,
}
