//! The answers as files: seal.json, seal.csv.

use std::path::Path;

use asperity::seal::{Opens, SealState};
use serde_json::{Value, json};

use super::answer::{MILLILITRES_A_YEAR, Over, SealAnswer, Spread};
use crate::finding;
use crate::output::{WriteError, write_all};

impl SealAnswer {
    /// The answers as JSON, SI; what is infinite or not known is null.
    pub fn object(&self) -> Value {
        let times = |factor: f64, spread: &Spread| json!({ "mean": factor * spread.mean, "least": factor * spread.least, "largest": factor * spread.largest });
        let (x, p0, fluid) = self.inside();
        let over = |name: &str, list: &[Over]| {
            let one = |over: &Over| json!({ name: over.at, "seal_leak": over.leak, "one_way": over.one_way });
            list.iter().map(one).collect::<Vec<_>>()
        };
        let seeds = self.sweep.seeds.iter().zip(&self.flows).zip(&self.opens).zip(&fluid).map(
            |(((seed, flow), opens), fluid)| {
                let points =
                    seed.points.iter().map(|(p, sigma)| json!({ "pressure": p, "conductance": sigma }));
                json!({
                    "seed": seed.seed,
                    "state": state(flow.state),
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
        json!({
            "seal_leak": self.leak,
            "seal_leak_per_metre": times(1.0 / self.plan.length, &self.leak),
            "seal_leak_ml_per_year": times(MILLILITRES_A_YEAR, &self.leak),
            "seal_leak_one_way": self.one_way,
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
        })
    }

    /// The leak over the inlet pressure as comma-separated values, SI.
    pub fn csv(&self) -> String {
        let line = |over: &Over| {
            let Spread { mean, least, largest } = over.leak;
            [over.at, mean, least, largest, over.one_way]
                .map(|x| if x.is_finite() { format!("{x:e}") } else { String::new() })
                .join(",")
        };
        let head = "inlet [Pa],seal_leak [m3/s],least [m3/s],largest [m3/s],one_way [m3/s]".to_owned();
        [head].into_iter().chain(self.by_inlet.iter().map(line)).map(|line| line + "\r\n").collect()
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

/// The word of a state.
fn state(state: SealState) -> &'static str {
    match state {
        SealState::Tight => "tight",
        SealState::Leaks => "leaks",
        SealState::Lifted => "lifted",
        SealState::Unknown => "unknown",
    }
}
