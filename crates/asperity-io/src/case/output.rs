//! `[solver]` and `[output]`: how each step is solved; what is stored, and where.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::PathBuf;

use asperity::quantities::{Quantities, Quantity};
use asperity::{Method, Plasticity, Programme, Simulation, SolverOptions, TimeGrid};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde_json::{Value, json};

use super::keys::*;
use super::plan::{Output, Rows};
use super::time;
use super::words::{nearest, number};
use crate::Code;
use crate::answer::Units;
use crate::store::FieldKind;

/// How each step is solved.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solver {
    /// Method; "projected-cg" if not given.
    #[serde(default)]
    method: Method,
    /// Largest residual of a converged step, relative to the mean displacement; 1e-6 if not given.
    tolerance: Option<Number<Tolerance>>,
    /// Largest number of iterations of one step.
    #[schemars(example = 1000)]
    max_iterations: Option<Whole<1>>,
    /// What remains of the flattening at the hardness after unloading; "cap" if not given.
    #[serde(default)]
    pub plasticity: Plasticity,
}

/// What is stored, and where.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Output")]
pub struct OutputKeys {
    /// The result, relative to the working directory; the case file's name with ".zarr" if not given.
    #[schemars(example = "rough_pmma.zarr")]
    path: Option<String>,
    /// The fields that are stored; ["pressure", "gap"] if not given, with [adhesion] also "contact_pressure", with [tangential] also "contact",
    /// "traction_x" and "traction_y"; [] for none.
    #[schemars(example = ("pressure", "gap"))]
    fields: Option<Vec<FieldKind>>,
    /// Optional quantities of each row, in addition to load, approach and areas; ["all"] for all that the case allows.
    #[schemars(example = ("contact_stiffness", "contact_spots", "dissipated_energy"))]
    #[serde(default)]
    quantities: Vec<Wanted>,
    /// Bins of the histograms among the quantities.
    #[schemars(example = serde_json::json!({ "bins": 50, "pressure": "300 MPa" }))]
    histogram: Option<Histogram>,
    /// Fields are stored at the first row, at every n-th row after it and at the last row; if not given, n is
    /// a tenth of the number of steps (10 if steps are adaptive). This or `times`.
    #[schemars(example = 10)]
    every: Option<Whole<1>>,
    /// Times at which fields are stored, in addition to the first and the last row. Each becomes a step. This or `every`.
    #[schemars(example = ("1 s", "10 s", "100 s"))]
    times: Option<Vec<Time<NonNegative>>>,
    /// Units in which leaks and times are printed and drawn; numbers that are stored and JSON stay SI.
    #[schemars(example = json!({ "leak": "ml/year", "time": "h" }))]
    #[serde(default)]
    units: BTreeMap<String, String>,
    /// Whether a run can be resumed; true if not given.
    #[schemars(example = true)]
    checkpoint: Option<bool>,
}

/// A quantity of each row, or all that the case allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Wanted(Option<Quantity>);

impl Scalar for Wanted {
    fn expected() -> String {
        "\"all\" or the name of a quantity".to_owned()
    }

    fn from_text(word: &str) -> Result<Self, QuantityError> {
        if word == "all" {
            return Ok(Wanted(None));
        }
        Quantity::from_name(word).map(|quantity| Wanted(Some(quantity))).ok_or_else(|| {
            let help = match nearest(word, &Quantity::ALL.map(Quantity::name)) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("the quantities: {}", Quantity::ALL.map(Quantity::name).join(", ")),
            };
            QuantityError { code: Code::UnknownKind, expected: Self::expected(), help: Some(help) }
        })
    }
}

deserialize!(Wanted);

impl JsonSchema for Wanted {
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
struct Histogram {
    /// Number of bins, at most 10000; 50 if not given.
    #[schemars(example = 50)]
    bins: Option<Whole<1>>,
    /// Upper end of the pressure; the hardness if not given, needed without a hardness.
    pressure: Option<Pressure<Positive>>,
    /// Upper end of the gap; the largest undeformed gap if not given.
    #[schemars(example = "5 um")]
    gap: Option<Length<Positive>>,
}

impl Solver {
    pub fn options(&self) -> SolverOptions {
        let default = SolverOptions::default();
        SolverOptions {
            method: self.method,
            tolerance: self.tolerance.map_or(default.tolerance, Number::get),
            max_iterations: self.max_iterations.map_or(default.max_iterations, Whole::count),
        }
    }
}

/// What is stored where the case does not say it.
pub struct Usual {
    pub path: PathBuf,
    pub fields: Vec<FieldKind>,
    /// Number of steps that the motion asks for, of which every tenth has fields.
    pub count: Option<usize>,
}

impl OutputKeys {
    /// What is stored.
    pub fn output(
        &self,
        at: &Place<'_>,
        times: Option<&TimeGrid>,
        programme: Option<&Programme>,
        usual: Usual,
    ) -> Option<Output> {
        if self.path.as_ref().is_some_and(|path| path.trim().is_empty()) {
            return at.key("path").wrong("the path of a directory for the run to create", "");
        }
        let mut units = Units::default();
        for (name, unit) in &self.units {
            if let Err(error) = units.choose(name, unit) {
                return at.key("units").key(name).fault(error.to_string(), &error.expected(), "");
            }
        }
        Some(Output {
            rows: self.rows(at, times?, programme, usual.count)?,
            path: self.path.as_ref().map_or(usual.path, PathBuf::from),
            fields: self.fields.clone().unwrap_or(usual.fields).into_iter().collect(),
            all_quantities: self.quantities.contains(&Wanted(None)),
            checkpoint: self.checkpoint.unwrap_or(true),
            units,
        })
    }

    fn rows(
        &self,
        at: &Place<'_>,
        times: &TimeGrid,
        programme: Option<&Programme>,
        count: Option<usize>,
    ) -> Option<Rows> {
        match (self.every, &self.times, count) {
            (Some(_), Some(_), _) => {
                let message = "`times` and `every` exclude each other";
                at.key("times").fault(message, "one of the two", "leave one of them out")
            }
            (Some(every), None, _) => Some(Rows::Every(every.count())),
            (None, None, Some(count)) => Some(Rows::Every((count / 10).max(1))),
            (None, None, None) => {
                let stages = programme.iter().flat_map(|programme| &programme.stages);
                let own: usize = stages.filter_map(|stage| stage.times.as_ref()).map(time::steps).sum();
                let own_only = matches!(times, TimeGrid::List(end) if end.len() == 1);
                let steps = if own > 0 && own_only { own } else { time::steps(times) + own };
                Some(Rows::Every(steps.div_ceil(10)))
            }
            (None, Some(list), _) => {
                let (at, end) = (at.key("times"), times.end());
                let instants = at.increasing(list.iter().map(|time| time.get()))?;
                if let Some(n) = instants.iter().position(|time| *time > end) {
                    let expected = format!("a time up to the end of the run, {} s", number(end));
                    return at.item(n).wrong(expected, "");
                }
                Some(Rows::At(instants))
            }
        }
    }

    fn named(&self) -> impl Iterator<Item = (usize, Quantity)> {
        self.quantities.iter().enumerate().filter_map(|(n, wanted)| Some((n, wanted.0?)))
    }

    /// The quantities that are named, each once, and their bins.
    pub fn quantities(&self) -> Quantities {
        let mut list: Vec<Quantity> = vec![];
        for (_, quantity) in self.named() {
            if !list.contains(&quantity) {
                list.push(quantity);
            }
        }
        let mut quantities = Quantities::of(list);
        if let Some(histogram) = &self.histogram {
            quantities.bins = histogram.bins.map_or(quantities.bins, Whole::count);
            quantities.largest_pressure = histogram.pressure.map(Pressure::get);
            quantities.largest_gap = histogram.gap.map(Length::get);
        }
        quantities
    }

    /// Refuses what the rows of a run under these `conditions` do not have; whether the contact `moves`.
    pub fn possible(&self, at: &Place<'_>, conditions: &Simulation, moves: bool) {
        for (n, kind) in self.fields.iter().flatten().enumerate() {
            if let Some([message, help]) = kind.lacks(conditions) {
                at.key("fields").item(n).fault::<()>(message, "another field", help);
            }
        }
        for (n, quantity) in self.named() {
            let at = at.key("quantities").item(n);
            if quantity.is_of_motion() && !moves {
                let message = "this quantity belongs to a contact in motion, but the case has no [motion]";
                let help = "leave it out, or add [motion]: its rows have it";
                at.fault::<()>(message, "another quantity", help);
            } else {
                at.core(conditions.allows(quantity));
            }
        }
    }
}
