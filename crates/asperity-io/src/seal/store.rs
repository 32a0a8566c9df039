//! The answers as files: seal.json, seal.csv.

use std::path::Path;

use asperity::seal::Opens;
use serde_json::{Value, json};

use super::answer::{Over, SealAnswer, Spread};
use super::{SealPlan, State};
use crate::answer::{MBAR_LITRE, Validity};
use crate::finding;
use crate::output::{WriteError, write_all};

impl SealAnswer {
    /// The answers as JSON, SI; what is infinite or not known is null.
    pub fn object(&self) -> Value {
        let (x, p0, fluid) = self.inside();
        let over = |name: &str, list: &[Over]| {
            let one = |over: &Over| {
                let mut object = json!({
                    name: over.at,
                    "seal_leak": over.leak,
                    "seal_leak_bounds": over.bounds,
                    "one_way": over.one_way,
                });
                if over.is_coarse() {
                    marked(&mut object, &self.validity("leak_over_inlet"));
                }
                object
            };
            list.iter().map(one).collect::<Vec<_>>()
        };
        let seeds = self.sweep.seeds.iter().zip(&self.flows).zip(&self.opens).zip(&fluid).map(
            |(((seed, flow), opens), fluid)| {
                let points = seed.points.iter().map(|(p, states)| {
                    let all = |of: fn(&State) -> f64| states.iter().map(of).collect::<Vec<_>>();
                    json!({
                        "pressure": p,
                        "conductance": all(|state| state.sigma),
                        "critical_gap": all(|state| state.critical_gap),
                    })
                });
                json!({
                    "seed": seed.seed,
                    "state": flow.state,
                    "opening": match opens {
                        Opens::Between(low, high) => json!([low, high]),
                        Opens::Always => json!("always"),
                        Opens::Never => json!("never"),
                        Opens::Unknown => Value::Null,
                    },
                    "choke_x": flow.choke.map(|choke| choke.x),
                    "choke_pressure": flow.choke.map(|choke| choke.pressed),
                    "seal_pressure": fluid,
                    "seal_sweep": points.collect::<Vec<_>>(),
                })
            },
        );
        let mut object = json!({
            "answers": self.answers(),
            "fluid": if self.plan.is_gas() { "gas" } else { "liquid" },
            "unit": self.plan.unit(),
            "seal_leak": self.leak,
            "seal_leak_bounds": self.bounds,
            "seal_leak_per_metre": self.leak.times(1.0 / self.plan.length),
            "seal_leak_one_way": self.one_way,
            "seal_leak_one_way_bounds": self.one_way_bounds,
            "seal_opening_pressure": self.opening,
            "leak_growth": self.growth,
            "inlet": self.plan.ends[0],
            "outlet": self.plan.ends[1],
            "by_inlet": over("inlet", &self.by_inlet),
            "by_time": over("time", &self.by_time),
            "x": x,
            "contact_pressure": p0,
            "time": self.sweep.times,
            "seeds": seeds.collect::<Vec<_>>(),
            "findings": finding::list(&self.findings),
            "patch_findings": self.sweep.findings,
        });
        for (name, factor) in usual(&self.plan) {
            object[name] = json!(self.leak.times(factor));
        }
        marked(&mut object, &self.validity("seal_leak"));
        if self.plan.is_gas() {
            object["knudsen_number"] = json!(self.knudsen);
        }
        object
    }

    /// The leak over the inlet pressure as comma-separated values, SI.
    pub fn csv(&self) -> String {
        let line = |over: &Over| {
            let Spread { mean, least, largest } = over.leak;
            [over.at, mean, least, largest, over.one_way, over.bounds[0], over.bounds[1]]
                .map(|x| if x.is_finite() { format!("{x:e}") } else { String::new() })
                .join(",")
        };
        let columns = ["seal_leak", "least", "largest", "one_way", "sweep_low", "sweep_high"];
        let head = columns.map(|name| format!("{name} [{}]", self.plan.unit())).join(",");
        [format!("inlet [Pa],{head}")]
            .into_iter()
            .chain(self.by_inlet.iter().map(line))
            .map(|line| line + "\r\n")
            .collect()
    }

    /// Writes seal.json and seal.csv into the folder of the sweep, in place of older ones.
    ///
    /// # Errors
    /// [`WriteError`].
    pub fn write(&self, folder: &Path) -> Result<(), WriteError> {
        write_all(&folder.join("seal.json"), true, format!("{:#}\n", self.object()).as_bytes())?;
        write_all(&folder.join("seal.csv"), true, self.csv().as_bytes())
    }
}

/// Adds what the findings say.
fn marked(object: &mut Value, validity: &Validity) {
    if let (Some(object), Value::Object(marks)) = (object.as_object_mut(), json!(validity)) {
        object.extend(marks);
    }
}

/// Seconds in a year of 365.25 days.
const YEAR: f64 = 31_557_600.0;

/// The leak in a year per SI value: its factor and its unit.
pub fn yearly(plan: &SealPlan) -> (f64, &'static str) {
    if plan.is_gas() { (1e3 * YEAR, "g") } else { (1e6 * YEAR, "ml") }
}

/// The leak in usual units, per SI value.
fn usual(plan: &SealPlan) -> Vec<(&'static str, f64)> {
    let (year, _) = yearly(plan);
    match (plan.standard(), plan.sccm()) {
        (Some(standard), Some(sccm)) => vec![
            ("seal_leak_standard", standard),
            ("seal_leak_mbar_l_per_s", MBAR_LITRE * standard),
            ("seal_leak_sccm", sccm),
            ("seal_leak_g_per_year", year),
        ],
        _ => vec![("seal_leak_ml_per_year", year)],
    }
}
