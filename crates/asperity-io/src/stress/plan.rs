//! Which stress is computed: the body, the depths, the times.

use asperity::Simulation;
use asperity::material::{Body, Creep};
use asperity::stress::{Rolling, StressQuantity, SurveyOptions};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::Ratio;
use super::evaluate::{StressError, refuse_layers};
use crate::readable::{counted, quantity};
use crate::store::{Reader, StressSet};

/// Depths of "auto": the surface and 24 below it.
const AUTOMATIC: usize = 25;
/// Depths at which a maximum is looked for, besides.
const REFINED: usize = 6;

/// The plan of `[stress]` in the setup of a result.
pub(crate) const SETUP: &str = "stress_plan";
/// Functions of Poisson's ratio in the setup of a result, one for each body; null where it is constant.
pub(crate) const POISSON_CREEP: &str = "poisson_creep";
const NO_POISSON: &str = "it does not say the Poisson's ratio of its first body, or this changes with the temperature; use \
                          asperity stress --poisson NU";

/// A body as the stress sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct StressBody {
    /// Its name.
    pub name: String,
    /// Its Poisson's ratio; `None` where it changes with the temperature, or is not known.
    pub poisson: Option<Ratio>,
}

impl StressBody {
    /// That of a case with this contact creep compliance; `None` where a temperature changes it.
    pub fn of(body: &Body, contact: Option<&Creep>) -> StressBody {
        StressBody { name: body.name.clone(), poisson: Ratio::of(body, contact) }
    }
}

/// The bodies of a result, as its setup names them.
pub fn bodies_of(reader: &Reader) -> Vec<StressBody> {
    let setup = &reader.header().setup;
    let list = |key: &str| setup.get(key).and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let (ratios, creeps) = (list("poisson"), list(POISSON_CREEP));
    let changing = |n: usize| serde_json::from_value(creeps.get(n)?.clone()).ok().map(Ratio::Changing);
    let bodies = list("bodies").iter().enumerate().map(|(n, name)| StressBody {
        name: name.as_str().map_or_else(|| format!("body {}", n + 1), str::to_owned),
        poisson: ratios.get(n).and_then(Value::as_f64).map(Ratio::Constant).or_else(|| changing(n)),
    });
    bodies.collect()
}

/// Depths below the surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Depths {
    /// Those of [`asperity::stress::automatic_depths`], for the largest contact of the times.
    Auto,
    /// These \[m\], rising.
    List(Vec<f64>),
}

/// Which stress is computed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StressPlan {
    /// Name of the body.
    pub body: String,
    /// Its Poisson's ratio; 0 to 0.5 where it is constant.
    pub poisson: Ratio,
    /// Depths.
    pub depths: Depths,
    /// Fields that are stored.
    pub quantities: Vec<StressQuantity>,
    /// The volume above this von Mises stress is measured \[Pa\].
    pub threshold: Option<f64>,
    /// Yield stress of the body \[Pa\].
    pub yield_stress: Option<f64>,
    /// Direction of rolling.
    pub rolling: Option<Rolling>,
    /// Times \[s\], of which the nearest stored ones are taken; `None` for all that are stored.
    pub times: Option<Vec<f64>>,
}

/// What will be computed, and what it takes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StressDescription {
    /// Name of the body.
    pub body: String,
    /// Its Poisson's ratio.
    pub poisson: Ratio,
    /// Number of depths.
    pub depth_count: usize,
    /// First and last depth \[m\]; absent where they follow from the contact.
    pub depth_range: Option<[f64; 2]>,
    /// Number of times, where known.
    pub times: Option<usize>,
    /// Names of the stored fields.
    pub fields: Vec<&'static str>,
    /// Evaluations of the six components at a depth, at most, for all times.
    pub evaluations: Option<usize>,
    /// Memory \[bytes\].
    pub memory_bytes: u64,
    /// Stored fields before compression \[bytes\].
    pub result_bytes: Option<u64>,
}

impl StressPlan {
    /// The plan for a body that asks only for the largest values and the profile.
    pub fn new(body: &str, poisson: impl Into<Ratio>) -> StressPlan {
        StressPlan {
            body: body.to_owned(),
            poisson: poisson.into(),
            depths: Depths::Auto,
            quantities: vec![],
            threshold: None,
            yield_stress: None,
            rolling: None,
            times: None,
        }
    }

    /// The plan that led to what is stored.
    pub fn of(set: &StressSet, reader: &Reader) -> StressPlan {
        let times = set.instants.iter().map(|index| reader.field_times()[*index]).collect();
        StressPlan {
            depths: Depths::List(set.depths.clone()),
            quantities: set.quantities.clone(),
            threshold: set.threshold,
            yield_stress: set.yield_stress,
            rolling: set.rolling,
            // A time does not tell the states before and after a jump apart.
            times: (set.instants.len() < reader.field_times().len()).then_some(times),
            ..StressPlan::new(&set.body, set.poisson.clone())
        }
    }

    /// The plan that is known of a result: what its stress was computed by, or else `[stress]` of its case.
    pub fn known(reader: &Reader) -> Option<StressPlan> {
        let of_case = || serde_json::from_value(reader.header().setup.get(SETUP)?.clone()).ok();
        reader.stress().map(|set| StressPlan::of(set, reader)).or_else(of_case)
    }

    /// The plan for a result if the caller says nothing: [`known`](Self::known), or the largest values of the first body.
    ///
    /// # Errors
    /// [`StressError::Refused`] where the bodies have layers, or the result does not say their Poisson's ratio.
    pub fn for_result(reader: &Reader) -> Result<StressPlan, StressError> {
        refuse_layers(reader)?;
        if let Some(plan) = StressPlan::known(reader) {
            return Ok(plan);
        }
        let body = bodies_of(reader).into_iter().next();
        let plan = body.and_then(|body| Some(StressPlan::new(&body.name, body.poisson?)));
        let refused = || StressError::Refused { path: reader.path().to_owned(), why: NO_POISSON };
        let allowed =
            |plan: &StressPlan| plan.poisson.constant().is_none_or(|ratio| (0.0..=0.5).contains(&ratio));
        plan.filter(allowed).ok_or_else(refused)
    }

    /// The body, the depths and the times in a few words.
    pub fn words(&self) -> String {
        let depths = match &self.depths {
            Depths::Auto => "automatic depths".to_owned(),
            Depths::List(list) => {
                let last = list.last().copied().unwrap_or_default();
                format!("{} down to {}", counted(list.len(), "depth"), quantity(last, "m"))
            }
        };
        let times = match &self.times {
            None => "all stored times".to_owned(),
            Some(times) => {
                let shown: Vec<String> = times.iter().take(8).map(|time| quantity(*time, "s")).collect();
                let more = if times.len() > shown.len() { ", ..." } else { "" };
                format!("t = {}{more}", shown.join(", "))
            }
        };
        format!("of {} (Poisson's ratio {}), {depths}, at {times}", self.body, self.poisson)
    }

    /// What a survey looks for.
    pub(super) fn survey(&self) -> SurveyOptions {
        SurveyOptions { threshold: self.threshold, rolling: self.rolling }
    }

    /// Memory that it takes \[bytes\]: transforms, six components, the pressure, and a field that is stored.
    pub fn bytes(&self, simulation: &Simulation) -> usize {
        let Simulation { grid, boundary, tangential, .. } = simulation;
        self.poisson.bytes(grid, *boundary, tangential.is_some()) + 2 * 8 * grid.len()
    }

    /// What will be done at `times` times.
    pub fn describe(&self, simulation: &Simulation, times: Option<usize>) -> StressDescription {
        let (depth_count, depth_range) = match &self.depths {
            Depths::Auto => (AUTOMATIC, None),
            Depths::List(list) => (list.len(), list.first().zip(list.last()).map(|(a, b)| [*a, *b])),
        };
        let maps = times.map(|times| times * depth_count * self.quantities.len());
        StressDescription {
            body: self.body.clone(),
            poisson: self.poisson.clone(),
            depth_count,
            depth_range,
            times,
            fields: self.quantities.iter().map(|quantity| quantity.name()).collect(),
            evaluations: times.map(|times| times * (depth_count + REFINED)),
            memory_bytes: self.bytes(simulation) as u64,
            result_bytes: maps.map(|maps| 8 * (maps * simulation.grid.len()) as u64),
        }
    }
}
