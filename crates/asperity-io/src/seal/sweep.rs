//! The sweep of the patch: two studies of the case, and the conductance that each of their runs has stored.

use std::path::Path;
use std::sync::atomic::Ordering;

use asperity::finding::FLUID_UNCOUPLED;
use asperity::seal::{Conductance, Shape};

use super::SealPlan;
use crate::case::{Case, CaseErrors};
use crate::store::{Reader, StoreError};
use crate::study::{self, Event, Options, Row, Study, StudyError};

/// The sweep begins at the largest pressure over this.
const RANGE: f64 = 300.0;
/// The share of the pressures that lies where the patch closes.
const REFINED: usize = 4;
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
    /// Which runs have findings, in words.
    pub findings: Vec<String>,
    /// Sides of the patch \[m\].
    pub size: [f64; 2],
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

/// One run: pressure, seed, (time, state).
type Run = (f64, Option<u64>, Vec<(f64, State)>);

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
    let refined = plan.pressures / REFINED;
    let most = plan.largest();
    let values =
        |from: f64, to: f64, count: usize| format!("{} Pa:{} Pa:{count}:log", short(from), short(to));
    let vary = values(most / RANGE, up(most), plan.pressures - refined);
    let (mut runs, first) = swept(path, &set, plan, &folder.join("sweep"), &vary, options, observe)?;
    let mut findings = Vec::from_iter(first);
    let found = SealSweep { times: times(&runs), seeds: seeds(&runs), findings: vec![], size: [0.0; 2] };
    if found.times.is_empty() {
        let message = "the runs of the sweep have no stored time in common; give [output] times, or steps that do not adapt";
        return Err(SealError::Input(message.into()));
    }
    if let Some([from, to]) = closing(&found)? {
        // The ends are known already.
        let step = (to / from).powf(1.0 / (refined + 1) as f64);
        let vary = values(from * step, to / step, refined);
        let (more, second) = swept(path, &set, plan, &folder.join("refined"), &vary, options, observe)?;
        runs.extend(more);
        findings.extend(second);
    }
    runs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let case = Case::read(path, &set)?;
    Ok(SealSweep { times: times(&runs), seeds: seeds(&runs), findings, size: case.conditions.grid.size() })
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

/// The pressures between which the patch closes, of all seeds, at the last time; `None` where nothing is to be refined.
fn closing(sweep: &SealSweep) -> Result<Option<[f64; 2]>, SealError> {
    let last = sweep.times.len() - 1;
    let (mut from, mut to) = (f64::INFINITY, 0.0f64);
    for seed in &sweep.seeds {
        let sigma = seed.conductance(last)?;
        if let (Some(leaking), Some(tight)) = (sigma.last_leaking(), sigma.sealing_pressure()) {
            (from, to) = (from.min(leaking), to.max(tight));
        }
    }
    Ok((from < to).then_some([from, to]))
}

/// The runs of one of the two studies, and which of them have findings, in words.
fn swept(
    path: &Path,
    set: &[String],
    plan: &SealPlan,
    folder: &Path,
    values: &str,
    options: &Options,
    observe: &mut (dyn FnMut(&Event<'_>) + Send),
) -> Result<(Vec<Run>, Option<String>), SealError> {
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
    let mut table = outcome.table;
    for row in &mut table.rows {
        // The fluid is taken into account here.
        row.findings.retain(|code| code != FLUID_UNCOUPLED);
        if row.state != study::State::Done {
            let why =
                if let study::State::Failed(why) = &row.state { why.as_str() } else { row.state.word() };
            let message = format!(
                "the run with {} has no leak: {why}; the same command tries it again",
                study.plan.label(&row.run)
            );
            return Err(SealError::Failed(message));
        }
    }
    let runs = table.rows.iter().map(|row| run(&study, row, plan.rough.is_some()));
    Ok((runs.collect::<Result<_, _>>()?, table.findings()))
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
    let leaks: Vec<(f64, State)> = (0..times.len()).filter(held).map(|n| (times[n], state(n))).collect();
    match leaks.is_empty() {
        false => Ok((pressure, seed, leaks)),
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
    let Some((_, _, first)) = runs.first() else { return vec![] };
    let in_all = |time: &f64| runs.iter().all(|run| run.2.iter().any(|leak| is_same(leak.0, *time)));
    first.iter().map(|leak| leak.0).filter(in_all).collect()
}

fn seeds(runs: &[Run]) -> Vec<SeedSweep> {
    let times = times(runs);
    let mut seeds: Vec<SeedSweep> = vec![];
    for (pressure, seed, leaks) in runs {
        let at = |time: &f64| {
            leaks.iter().find(|leak| is_same(leak.0, *time)).map_or(State::UNKNOWN, |leak| leak.1)
        };
        let point = (*pressure, times.iter().map(at).collect());
        match seeds.iter_mut().find(|known| known.seed == *seed) {
            Some(known) => known.points.push(point),
            None => seeds.push(SeedSweep { seed: *seed, points: vec![point] }),
        }
    }
    seeds
}
