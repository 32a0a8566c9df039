//! Which stress is computed: the body, the depths, the times.

use asperity::material::Body;
use asperity::stress::{Rolling, StressQuantity, SubsurfaceStress, SurveyOptions};
use asperity::{Boundary, Grid};
use serde::Serialize;
use serde_json::Value;

use crate::store::{Reader, StressSet};

/// Depths of "auto": the surface and 24 below it.
const AUTOMATIC: usize = 25;
/// Depths at which a maximum is looked for, besides.
const REFINED: usize = 6;

/// A body as the stress sees it.
#[derive(Clone, Debug, PartialEq)]
pub struct StressBody {
    /// Its name.
    pub name: String,
    /// Its Poisson's ratio; `None` where it changes with time, or is not known.
    pub poisson: Option<f64>,
}

impl StressBody {
    /// That of a case.
    pub fn of(body: &Body) -> StressBody {
        StressBody { name: body.name.clone(), poisson: body.poisson() }
    }
}

/// The bodies of a result, as its setup names them.
pub fn bodies_of(reader: &Reader) -> Vec<StressBody> {
    let setup = &reader.header().setup;
    let list = |key: &str| setup.get(key).and_then(Value::as_array).map(Vec::as_slice).unwrap_or_default();
    let ratios = list("poisson");
    let bodies = list("bodies").iter().enumerate().map(|(n, name)| StressBody {
        name: name.as_str().map_or_else(|| format!("body {}", n + 1), str::to_owned),
        poisson: ratios.get(n).and_then(Value::as_f64),
    });
    bodies.collect()
}

/// Depths below the surface.
#[derive(Clone, Debug, PartialEq)]
pub enum Depths {
    /// Those of [`asperity::stress::automatic_depths`], for the largest contact of the times.
    Auto,
    /// These \[m\], rising.
    List(Vec<f64>),
}

/// Which stress is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct StressPlan {
    /// Name of the body.
    pub body: String,
    /// Its Poisson's ratio, 0 to 0.5.
    pub poisson: f64,
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
    pub poisson: f64,
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
    /// The plan for a body with nothing asked for but the largest values and the profile.
    pub fn new(body: &str, poisson: f64) -> StressPlan {
        StressPlan {
            body: body.to_owned(),
            poisson,
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
            ..StressPlan::new(&set.body, set.poisson)
        }
    }

    /// The plan for a result of which nothing else is said: what is stored, or the largest values of the first body.
    /// `None` where the result does not say its Poisson's ratio.
    pub fn for_result(reader: &Reader) -> Option<StressPlan> {
        if let Some(set) = reader.stress() {
            return Some(StressPlan::of(set, reader));
        }
        let body = bodies_of(reader).into_iter().next()?;
        body.poisson
            .filter(|ratio| (0.0..=0.5).contains(ratio))
            .map(|ratio| StressPlan::new(&body.name, ratio))
    }

    /// What a survey looks for.
    pub(super) fn survey(&self) -> SurveyOptions {
        SurveyOptions { threshold: self.threshold, rolling: self.rolling }
    }

    /// Memory that it takes \[bytes\]: transforms, six components, the pressure, and a field that is stored.
    pub fn bytes(&self, grid: &Grid, boundary: Boundary) -> usize {
        SubsurfaceStress::bytes(grid, boundary) + 2 * 8 * grid.len()
    }

    /// What will be done at `times` times.
    pub fn describe(&self, grid: &Grid, boundary: Boundary, times: Option<usize>) -> StressDescription {
        let (depth_count, depth_range) = match &self.depths {
            Depths::Auto => (AUTOMATIC, None),
            Depths::List(list) => (list.len(), list.first().zip(list.last()).map(|(a, b)| [*a, *b])),
        };
        let maps = times.map(|times| times * depth_count * self.quantities.len());
        StressDescription {
            body: self.body.clone(),
            poisson: self.poisson,
            depth_count,
            depth_range,
            times,
            fields: self.quantities.iter().map(|quantity| quantity.name()).collect(),
            evaluations: times.map(|times| times * (depth_count + REFINED)),
            memory_bytes: self.bytes(grid, boundary) as u64,
            result_bytes: maps.map(|maps| 8 * (maps * grid.len()) as u64),
        }
    }
}
