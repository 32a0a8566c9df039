//! What the pair of bodies is to the contact.

use std::sync::Arc;

use asperity::finding::{self, Finding};
use asperity::history::check_layers;
use asperity::kernel::{HalfSpace, Kernel};
use asperity::layer::{Layered, NonseparableLayers, Response, response};
use asperity::material::{Body, Creep, ReducedTime, ThermalCreep, pair_hardness};
use asperity::time::Plan;
use asperity::{Boundary, Error, Grid};

use super::body::{self, Part};
use super::describe::MaterialReport;
use super::material::{Model, Sample};
use super::place::Place;
use super::warmth::{Course, Warmth, at_temperature, warmth};
use super::words::number;

/// The bodies, and what the pair of them is to the contact.
pub struct Pair {
    /// What they consist of: each half-space, layer and base.
    pub bodies: Vec<Body>,
    /// How the bodies yield in space, where they have layers.
    pub layers: Option<Arc<Layered>>,
    /// How their waves creep, where they creep differently.
    pub waves: Option<Arc<NonseparableLayers>>,
    /// Contact creep compliance [1/Pa] of each of `bodies`, and its clock where its temperature changes.
    pub creeps: Vec<(Creep, Option<ReducedTime>)>,
    /// Contact creep compliance of the bodies of constant temperature \[1/Pa\].
    pub creep: Creep,
    /// The bodies whose temperature changes.
    pub thermal: Vec<ThermalCreep>,
    /// Hardness of the softer body \[Pa\]; infinite without.
    pub hardness: f64,
    /// Where the materials come from, one for each of `bodies`.
    pub reports: Vec<MaterialReport>,
    /// Where fits are poor, and where the run goes beyond what is known of a material.
    pub findings: Vec<Finding>,
    /// Rows of the run.
    pub plan: Plan,
}

impl Pair {
    /// Adds the bodies up.
    pub fn sum(&mut self) {
        (self.creep, self.thermal) = (Creep::default(), Vec::new());
        for (creep, clock) in &self.creeps {
            match clock {
                Some(clock) => {
                    self.thermal.push(ThermalCreep { creep: creep.clone(), clock: clock.clone() });
                }
                None => self.creep = self.creep.sum(creep),
            }
        }
    }

    /// C(0+) [1/Pa].
    pub fn instantaneous(&self) -> f64 {
        self.creep.instantaneous + self.thermal.iter().map(|body| body.creep.instantaneous).sum::<f64>()
    }

    /// How the bodies yield in space.
    pub fn kernel(&self) -> Arc<dyn Kernel> {
        match &self.layers {
            Some(layers) => layers.clone(),
            None => Arc::new(HalfSpace),
        }
    }
}

/// The pair of `bodies`, whose materials are the `parts`; `list` is their place.
pub fn pair(
    list: &Place<'_>,
    bodies: &[body::Body],
    parts: &[Part<'_>],
    course: &Course<'_>,
) -> Option<Pair> {
    if bodies.len() > 2 {
        let help = "write a coating as [[body.layer]] of its body; a rigid body is left out";
        let message = "a contact has one or two bodies, and this is the third";
        return list.item(2).fault(message, "two bodies", help);
    }
    let warmths: Vec<Option<Warmth>> = parts
        .iter()
        .map(|part| part.at.key("material").core(warmth(part.sample.as_ref()?, course)))
        .collect();
    let clocks = warmths.iter().flatten().filter_map(|warmth| warmth.clock.as_ref());
    let end = course.end.unwrap_or(0.0);
    let plan = (course.plan)(&clocks.flat_map(|clock| clock.breaks(end)).collect::<Vec<f64>>());
    let mut pair = Pair {
        bodies: Vec::new(),
        layers: None,
        waves: None,
        creeps: Vec::new(),
        creep: Creep::default(),
        thermal: Vec::new(),
        hardness: f64::INFINITY,
        reports: Vec::new(),
        findings: Vec::new(),
        plan,
    };
    // All of them are looked at, also after one that is wrong.
    let added: Vec<_> =
        parts.iter().zip(warmths).map(|(part, warmth)| pair.add(part, warmth, course)).collect();
    added.into_iter().collect::<Option<()>>()?;
    pair.hardness = pair_hardness(&pair.bodies);
    if bodies.iter().all(|body| body.layer.is_empty()) {
        pair.sum();
        return Some(pair);
    }
    let response = pair.respond(list, bodies, parts)?;
    pair.layers = Some(Arc::new(response.kernel));
    pair.waves = response.waves;
    match pair.creeps.first().and_then(|(_, clock)| clock.clone()) {
        Some(clock) => pair.thermal.push(ThermalCreep { creep: response.creep, clock }),
        None => pair.creep = response.creep,
    }
    Some(pair)
}

/// The first temperature of a material with a shift that no polymer has: that of its shift, its own or that of the run.
fn unlikely_temperature(name: &str, sample: &Sample, course: Option<&[(f64, f64)]>) -> Option<Finding> {
    let course = course.unwrap_or_default().iter().map(|point| point.1);
    let all = sample.shift.as_ref()?.reference().into_iter().chain(sample.temperature).chain(course);
    all.filter_map(|kelvin| finding::unlikely_temperature(name, kelvin)).next()
}

/// The reference temperature of a material with a shift \[K\], where neither the material nor the run has a temperature.
fn untold(sample: &Sample, course: &Course<'_>) -> Option<f64> {
    let told = sample.temperature.is_some() || course.temperatures.is_some();
    sample.shift.as_ref().filter(|_| !told)?.reference()
}

/// What is found about the material of the body `name`; `beyond` says where a run over `window` [s] leaves the data.
fn findings(
    name: &str,
    sample: &Sample,
    report: &MaterialReport,
    window: Option<[f64; 2]>,
    beyond: Option<String>,
) -> Vec<Finding> {
    let beyond = match (beyond, window, report.window) {
        (Some(words), Some(needed), Some(known)) => Some(finding::beyond_data(name, needed, known, &words)),
        _ => None,
    };
    let fitted = match &sample.model {
        Model::Fitted { fitted, .. } => fitted.findings(name),
        _ => Vec::new(),
    };
    fitted.into_iter().chain(beyond).collect()
}

impl Pair {
    /// Adds a body or layer, as warm as it is.
    fn add(&mut self, part: &Part<'_>, warmth: Option<Warmth>, course: &Course<'_>) -> Option<()> {
        let lateral = part.lateral()?;
        let (sample, warmth, name) = (part.sample.as_ref()?, warmth?, part.name.clone());
        let window = warmth.window(&self.plan);
        let Warmth { constant, clock } = warmth;
        let place = part.at.key("material");
        let (material, report, outside) = at_temperature(&place, sample, constant, window, course.beyond)?;
        let body = Body { name: name.clone(), material, lateral, hardness: part.hardness };
        self.creeps.push((part.at.core(body.contact_creep())?, clock));
        self.bodies.push(body);
        self.findings.extend(findings(&name, sample, &report, window, outside));
        self.findings.extend(unlikely_temperature(&name, sample, course.temperatures));
        self.findings.extend(untold(sample, course).map(|kelvin| finding::at_reference(&name, kelvin)));
        self.reports.push(MaterialReport { body: name, ..report });
        Some(())
    }

    /// What bodies with layers are to the contact. Those of the pair are the `parts`, in their order.
    fn respond(&self, list: &Place<'_>, bodies: &[body::Body], parts: &[Part<'_>]) -> Option<Response> {
        let body = |(n, body): (usize, &body::Body)| {
            let of_body = parts.iter().zip(&self.bodies).filter(|(part, _)| part.body == n);
            body.of(of_body.map(|(_, body)| body.clone()))
        };
        let all: Vec<_> = bodies.iter().enumerate().map(body).collect();
        let found = match self.creeps.iter().position(|(_, clock)| *clock != self.creeps[0].1) {
            None => response(&all),
            Some(n) => Err(Error::invalid(
                format!("temperature shift of {}", parts[n].name),
                format!("not that of {}", parts[0].name),
                "the same law for all layers and bodies. While the temperature changes, waves of different lengths would creep \
                 differently, which is not solved; give all of them the same `shift`, or hold the temperature constant",
            )
            .of(&parts[n].at.key)),
        };
        match &found {
            Err(Error::Invalid { parameter, .. }) if !parameter.is_empty() => {
                list.sibling(parameter).core(found)
            }
            _ => list.item(bodies.iter().position(|body| !body.layer.is_empty())?).core(found),
        }
    }
}

impl Pair {
    /// Refuses cells of a free domain that do not resolve the top layers, and a domain that is not wide enough for waves that
    /// creep differently; a periodic domain takes layers of any thickness.
    pub fn resolved(&self, list: &Place<'_>, bodies: &[body::Body], grid: &Grid, boundary: Boundary) {
        let Some(layers) = self.layers.as_ref().filter(|_| boundary == Boundary::Free) else { return };
        let tops = bodies.iter().enumerate();
        let tops = tops.filter_map(|(n, body)| Some((n, body.layer.first()?.thickness.get())));
        let Some((n, _)) = tops.min_by(|a, b| a.1.total_cmp(&b.1)) else { return };
        let at = list.item(n).key("layer").item(0);
        let (longest, cell) = (layers.longest_cell(), grid.longest_cell());
        if cell > longest {
            let least: Vec<String> =
                grid.extents().iter().map(|side| (side / longest).ceil().to_string()).collect();
            let message = format!(
                "the cells are {} m long, more than 4 times the thickness of this layer: they do not resolve it",
                number(cell)
            );
            let help = format!(
                "set domain.cells to [{}] or more, take a smaller domain, or boundary = \"periodic\", which needs no such cells",
                least.join(", ")
            );
            at.fault::<()>(message, &format!("cells of at most {} m", number(longest)), &help);
        } else if let Some(waves) = &self.waves {
            at.core(check_layers(grid, boundary, waves));
        }
    }
}
