//! The sweep of the patch: two studies of the case, and the conductance that each of their runs has stored.
//!
//! ```text
//! pressures from the largest down to 1/300 of it
//! repeat: add the pressure that refine names, with all seeds, until the leak stands
//! ```

use std::path::Path;
use std::sync::atomic::Ordering;

use asperity::finding::{FLUID_UNCOUPLED, Finding};
use asperity::seal::{Conductance, Shape};

use super::{RANGE, SealPlan, refine};
use crate::case::{Case, CaseErrors};
use crate::readable::{counted, quantity};
use crate::store::{Reader, StoreError};
use crate::study::{self, Event, Options, Row, Study, StudyError};

/// A mean pressure is the one asked for, and a time the same, within this share.
const SAME: f64 = 1e-3;

/// Why a seal was not computed.
#[derive(Debug, thiserror::Error)]
pub enum SealError {
    /// The case is wrong.
    #[error(transparent)]
    Case(#[from] CaseErrors),
    /// What was asked for is wrong.
    #[error("{0}")]
    Input(String),
    /// The runs of the patch cannot go on.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A result cannot be read.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The numbers do not make a seal.
    #[error(transparent)]
    Core(#[from] asperity::Error),
    /// Runs of the patch failed.
    #[error("{0}")]
    Failed(String),
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// What the runs of the patch say.
#[derive(Clone, Debug, PartialEq)]
pub struct SealSweep {
    /// Times \[s\] at which all runs have the pressure asked for.
    pub times: Vec<f64>,
    /// One sweep for each seed.
    pub seeds: Vec<SeedSweep>,
    /// The findings of the runs, each code once.
    pub findings: Vec<PatchFinding>,
    /// Sides of the patch \[m\].
    pub size: [f64; 2],
}

/// A finding of runs of the patch.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct PatchFinding {
    /// That of the first run that has it.
    #[serde(flatten)]
    pub finding: Finding,
    /// What tells this run from the others: "1 kPa, seed 2".
    pub run: String,
    /// So many runs have it.
    pub runs: usize,
    /// All runs.
    pub of: usize,
}

impl std::fmt::Display for PatchFinding {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let PatchFinding { finding, run, runs, of } = self;
        let share = if runs == of { "all".to_owned() } else { format!("{runs} of") };
        write!(f, "{}: {share} {} of the patch, first at {run}: ", finding.severity, counted(*of, "run"))?;
        write!(f, "{} [{}]", finding.text, finding.code)
    }
}

/// The sweep of a seed.
#[derive(Clone, Debug, PartialEq)]
pub struct SeedSweep {
    /// The seed; `None` of a surface without one.
    pub seed: Option<u64>,
    /// Mean pressure \[Pa\], increasing, and the state at each time.
    pub points: Vec<(f64, Vec<State>)>,
}

impl SeedSweep {
    /// The conductance at the n-th time, for a liquid.
    ///
    /// # Errors
    /// As [`Conductance::new`].
    pub fn conductance(&self, time: usize) -> asperity::Result<Conductance> {
        let at = |point: &(f64, Vec<State>)| (point.0, point.1[time].sigma);
        Conductance::new(&self.points.iter().map(at).collect::<Vec<_>>())
    }
}

/// What flows through the patch in one state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Conductance \[m^3\]; 0 where the patch is tight.
    pub sigma: f64,
    /// Critical gap \[m\].
    pub critical_gap: f64,
    /// Leak of the patch under the pressures of the case \[kg/s\], of a gas.
    pub leak_rate: f64,
}

impl State {
    const UNKNOWN: State = State { sigma: f64::NAN, critical_gap: f64::NAN, leak_rate: f64::NAN };
}

/// One run of the patch.
#[derive(Clone)]
struct Run {
    pressure: f64,
    seed: Option<u64>,
    /// What tells it from the others.
    label: String,
    /// Times and states.
    states: Vec<(f64, State)>,
    findings: Vec<Finding>,
}

/// Runs the patch of a case; runs that are done in the folder already stay.
///
/// # Errors
/// [`SealError`].
pub fn sweep(
    path: &Path,
    set: &[String],
    plan: &SealPlan,
    folder: &Path,
    options: &Options,
    observe: &mut (dyn FnMut(&Event<'_>) + Send),
) -> Result<SealSweep, SealError> {
    if !folder.join("sweep").exists() && folder.join("seal.json").exists() {
        let message = format!(
            "{} has a seal.json, but no sweep: it would be replaced; choose another folder with -o",
            folder.display()
        );
        return Err(SealError::Input(message));
    }
    let mut set = set.to_vec();
    // None of them changes the patch, so that another length, width, liquid or pressure of it takes the same runs.
    let (known, liquid) = (!matches!(plan.profile.shape, Shape::Table(_)), !plan.is_gas());
    let keys = [
        (true, "seal.length=1 m"),
        (known, "seal.width=1 m"),
        (liquid, "leakage.viscosity=1 Pa s"),
        (known && liquid, "leakage.pressure_drop=1 Pa"),
    ];
    set.extend(keys.into_iter().filter(|(is_set, _)| *is_set).map(|(_, key)| key.to_owned()));
    let most = plan.largest();
    let vary = format!("{} Pa:{} Pa:{}:log", short(most / RANGE), short(up(most)), plan.first_pressures());
    let first = swept(path, &set, plan, &folder.join("sweep"), &vary, options, observe)?;
    let size = Case::read(path, &set)?.conditions.grid.size();
    if times(&first).is_empty() {
        let message = "the runs of the sweep have no stored time in common; give [output] times, or steps that do not adapt";
        return Err(SealError::Input(message.into()));
    }
    let refined = folder.join("refined");
    let mut pressures = stored(&refined)?;
    let most = pressures.len() + plan.pressures;
    loop {
        let mut runs = first.clone();
        if !pressures.is_empty() {
            runs.extend(swept(path, &set, plan, &refined, &pressures.join(", "), options, observe)?);
        }
        runs.sort_by(|a, b| a.pressure.total_cmp(&b.pressure));
        let sweep = SealSweep { times: times(&runs), seeds: seeds(&runs), findings: findings(&runs), size };
        let next = if pressures.len() < most { refine::next(plan, &sweep, pressures.len())? } else { None };
        let Some(next) = next else { return Ok(sweep) };
        pressures.push(format!("{} Pa", short(next)));
    }
}

/// The findings of the runs, each code once.
fn findings(runs: &[Run]) -> Vec<PatchFinding> {
    let mut found: Vec<PatchFinding> = vec![];
    for run in runs {
        let mut codes: Vec<&str> = vec![];
        for finding in &run.findings {
            if codes.contains(&finding.code.as_ref()) {
                continue;
            }
            codes.push(&finding.code);
            match found.iter_mut().find(|known| known.finding.code == finding.code) {
                Some(known) => known.runs += 1,
                None => found.push(PatchFinding {
                    finding: finding.clone(),
                    run: run.label.clone(),
                    runs: 1,
                    of: runs.len(),
                }),
            }
        }
    }
    found
}

/// The pressures of a study that is there already, as they are written.
fn stored(folder: &Path) -> Result<Vec<String>, SealError> {
    if !folder.join("study.json").exists() {
        return Ok(vec![]);
    }
    let study = Study::open(folder)?;
    let pressures = study.plan.vary.first().map_or(&[][..], |varied| &varied.values);
    Ok(pressures.iter().map(|value| value.source().to_owned()).collect())
}

/// Seven digits.
fn short(pressure: f64) -> f64 {
    format!("{pressure:.6e}").parse().unwrap_or(pressure)
}

/// Five digits, rounded up.
fn up(pressure: f64) -> f64 {
    let digit = 10f64.powi(pressure.log10().floor() as i32 - 4);
    (pressure / digit).ceil() * digit
}

/// The runs of one of the two studies.
fn swept(
    path: &Path,
    set: &[String],
    plan: &SealPlan,
    folder: &Path,
    values: &str,
    options: &Options,
    observe: &mut (dyn FnMut(&Event<'_>) + Send),
) -> Result<Vec<Run>, SealError> {
    let mut vary = vec![format!("load.history.value={values}")];
    if let Some(rough) = &plan.rough {
        let last = rough.seed.saturating_add(plan.seeds as u64 - 1);
        vary.push(format!("{}={}..{last}", rough.key, rough.seed));
    }
    let study = Study::new(path, &vary, Some(false), set, folder)?;
    if study.plan.vary.len() != vary.len() {
        let help = "asperity seal varies the pressure and the seed itself; leave [study] out of the case";
        return Err(SealError::Input(help.into()));
    }
    let outcome = study.work(options, observe)?;
    if options.interrupt.load(Ordering::Relaxed) {
        return Err(SealError::Interrupted);
    }
    for row in &outcome.table.rows {
        if row.state != study::State::Done {
            let why =
                if let study::State::Failed(why) = &row.state { why.as_str() } else { row.state.word() };
            let message = format!(
                "the run of the patch at {} has no leak: {why}; the same command tries it again",
                label(row, plan.rough.is_some())
            );
            return Err(SealError::Failed(message));
        }
    }
    outcome.table.rows.iter().map(|row| run(&study, row, plan.rough.is_some())).collect()
}

/// The mean pressure and the seed of a run of the patch: "1 kPa, seed 2".
pub fn label(row: &Row, rough: bool) -> String {
    let pressure = row.run.values[0].number().map_or(f64::NAN, |number| number.0);
    let seed = row.run.values.get(1).filter(|_| rough);
    let seed = seed.map_or(String::new(), |seed| format!(", seed {}", seed.text()));
    quantity(pressure, "Pa") + &seed
}

/// The conductance that a run has stored, at the times at which it has the pressure asked for.
fn run(study: &Study, row: &Row, rough: bool) -> Result<Run, SealError> {
    let reader = Reader::open(&study.result(&row.run))?;
    let pressure = row.run.values[0].number().map_or(f64::NAN, |number| number.0);
    let seed = if rough { row.run.values[1].text().parse().ok() } else { None };
    let leak = |name: &str| reader.leak(name);
    let (times, steps, open) = (leak("leak_time")?, leak("leak_step")?, leak("percolates")?);
    let (gaps, critical, rates) = (leak("hydraulic_gap")?, leak("critical_gap")?, leak("leak_rate")?);
    let rows = reader.rows()?;
    let held = |n: &usize| {
        let mean = rows.get(steps[*n] as usize).map_or(0.0, |row| row.mean_pressure);
        (mean / pressure - 1.0).abs() < SAME
    };
    let state = |n: usize| State {
        sigma: if open[n] > 0.0 { gaps[n].powi(3) } else { 0.0 },
        critical_gap: critical[n],
        leak_rate: rates[n],
    };
    let states: Vec<(f64, State)> = (0..times.len()).filter(held).map(|n| (times[n], state(n))).collect();
    let label = label(row, rough);
    // The fluid is taken into account here.
    let findings =
        reader.findings().iter().filter(|finding| finding.code != FLUID_UNCOUPLED).cloned().collect();
    match states.is_empty() {
        false => Ok(Run { pressure, seed, label, states, findings }),
        true => Err(SealError::Input(format!(
            "the leak is stored at no time at which the mean pressure is that of the history, {pressure} Pa; \
             hold the pressure to the end (kind = \"step\" or \"ramp\") and store a row there (output.every)"
        ))),
    }
}

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// The times that all runs have.
fn times(runs: &[Run]) -> Vec<f64> {
    let Some(first) = runs.first() else { return vec![] };
    let in_all = |time: &f64| runs.iter().all(|run| run.states.iter().any(|state| is_same(state.0, *time)));
    first.states.iter().map(|leak| leak.0).filter(in_all).collect()
}

fn seeds(runs: &[Run]) -> Vec<SeedSweep> {
    let times = times(runs);
    let mut seeds: Vec<SeedSweep> = vec![];
    for Run { pressure, seed, states, .. } in runs {
        let at = |time: &f64| {
            states.iter().find(|leak| is_same(leak.0, *time)).map_or(State::UNKNOWN, |leak| leak.1)
        };
        let point = (*pressure, times.iter().map(at).collect());
        match seeds.iter_mut().find(|known| known.seed == *seed) {
            Some(known) => known.points.push(point),
            None => seeds.push(SeedSweep { seed: *seed, points: vec![point] }),
        }
    }
    seeds
}
