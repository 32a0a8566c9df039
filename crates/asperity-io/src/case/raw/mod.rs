//! The case file as it is written: one struct per section, one field per key.
//!
//! The comments on the fields are the descriptions in the JSON Schema; the types of the fields carry
//! dimension and range. What needs more than one key to judge is checked in `convert`.

mod axes;
mod body;
mod leakage;
mod load;
mod material;
mod motion;
pub mod prepare;
mod run;
mod stress;
mod surface;
mod thermal;
mod times;

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Range;

use asperity::Boundary;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

pub use axes::Axes;
pub use body::{Body, BodyBase, HardnessFile, Layer};
pub use leakage::Leakage;
pub use load::{From, History, Load, Sine, Spacing, Stage, Table, Time, Until};
pub use material::{
    Column, CreepTable, CreepTerm, Dma, Fit, FractionalZener, Material, Prony, RelaxationTable,
};
pub use motion::{Heading, Motion, MotionKind, RangeSpacing, Speed, Velocities};
pub use run::{Output, Quantities, Solver};
pub use stress::{Depths, Progression, Stress, Which};
pub use surface::{Distribution, File, Preset, SelfAffine, Surface};
pub use thermal::{Shift, Temperature, TemperatureHistory, TemperaturePoint, Vertical};
pub use times::StoredTimes;

use super::quantity::range::Positive;
use super::quantity::{Length, Whole};

/// A case of asperity: two bodies, the gap between them, a load over time.
#[derive(Debug, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Document {
    /// Title of the case, stored in the result.
    #[schemars(example = "PMMA rough sphere, step load")]
    #[schemars(length(max = 1000))]
    pub title: Option<At<String>>,
    /// The computational domain: a rectangle of equal cells, or a line of them.
    pub domain: At<Domain>,
    /// The parts whose sum is the undeformed gap.
    #[schemars(length(min = 1))]
    pub surface: Vec<At<Surface>>,
    /// The deformable bodies, one or two; a missing second body is rigid.
    #[schemars(length(min = 1, max = 2))]
    pub body: Vec<At<Body>>,
    /// What presses the bodies together.
    pub load: At<Load>,
    /// The times of the solution; not for steady states of motion.
    #[schemars(with = "Option<At<Time>>")]
    pub time: At<Time>,
    /// The temperature of bodies whose material has a `shift`; they are at its reference if not given.
    #[schemars(example = serde_json::json!({ "history": { "kind": "constant", "value": "60 °C" } }))]
    pub temperature: Option<At<Temperature>>,
    /// Motion of the contact over the bodies; nothing moves if not given.
    #[schemars(example = serde_json::json!({ "velocity": "10 mm/s" }))]
    pub motion: Option<At<Motion>>,
    /// The flow of a fluid through the gap.
    #[schemars(example = serde_json::json!({ "pressure_drop": "2 bar", "viscosity": "1 mPa s" }))]
    pub leakage: Option<At<Leakage>>,
    /// How each step is solved.
    #[schemars(default)]
    pub solver: Solver,
    /// What is stored, and where.
    #[schemars(default)]
    pub output: Output,
    /// The stress below the surface, from the stored pressures; not computed if not given.
    #[schemars(example = serde_json::json!({ "depths": "auto", "yield_stress": "110 MPa" }))]
    pub stress: Option<At<Stress>>,
}

/// A rectangle of equal cells; or a line of cells, with one value in `cells` and `size`: a line contact in plane strain, in which
/// nothing changes along y.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Domain {
    /// Number of cells along x and y; any numbers, also not square and not powers of two. One number for a line contact.
    /// Those of the measured surface if not given; needed without a measured surface.
    #[schemars(example = (1024, 1024), example = (1024,))]
    pub cells: Option<At<Axes<Whole<1>>>>,
    /// Length of the domain along x and y; one length for a line contact. That of the measured surface if not given; needed
    /// without a measured surface.
    #[schemars(example = ("0.1 mm", "0.1 mm"), example = ("2 mm",))]
    pub size: Option<At<Axes<Length<Positive>>>>,
    /// Boundary condition of the domain; "free" if not given.
    pub boundary: Option<Boundary>,
}

/// A list of two values: along x and y, or time and value.
#[derive(Clone, Copy, Debug)]
pub struct Two<A, B = A>(pub A, pub B);

impl<A> Two<A> {
    /// Both values, converted.
    pub fn map<T>(self, convert: impl Fn(A) -> T) -> [T; 2] {
        [convert(self.0), convert(self.1)]
    }
}

impl<'de, A: Deserialize<'de>, B: Deserialize<'de>> Deserialize<'de> for Two<A, B> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TwoVisitor<A, B>(PhantomData<fn() -> (A, B)>);

        impl<'de, A: Deserialize<'de>, B: Deserialize<'de>> Visitor<'de> for TwoVisitor<A, B> {
            type Value = Two<A, B>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of two values in brackets")
            }

            fn visit_seq<S: SeqAccess<'de>>(self, mut values: S) -> Result<Two<A, B>, S::Error> {
                let missing = |n| S::Error::invalid_length(n, &"a list of two values in brackets");
                let first = values.next_element()?.ok_or_else(|| missing(0))?;
                let second = values.next_element()?.ok_or_else(|| missing(1))?;
                match values.next_element::<IgnoredAny>()? {
                    None => Ok(Two(first, second)),
                    Some(_) => Err(missing(3)),
                }
            }
        }

        deserializer.deserialize_seq(TwoVisitor(PhantomData))
    }
}

impl<A: JsonSchema, B: JsonSchema> JsonSchema for Two<A, B> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{}And{}", A::schema_name(), B::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let items = [generator.subschema_for::<A>(), generator.subschema_for::<B>()];
        json_schema!({ "type": "array", "prefixItems": items, "minItems": 2, "maxItems": 2 })
    }
}

/// A value and its place in the text.
#[derive(Clone, Debug)]
pub struct At<T> {
    /// Bytes of the source that hold the value.
    pub span: Range<usize>,
    /// The value.
    pub value: T,
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for At<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let spanned = toml::Spanned::<T>::deserialize(deserializer)?;
        Ok(At { span: spanned.span(), value: spanned.into_inner() })
    }
}

impl<T: JsonSchema> JsonSchema for At<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
