//! A run: a case, its march and its result, step by step.
//!
//! The command and the Python package run cases through here, so that the same case gives the same
//! numbers wherever it is started.

mod memory;
mod steady;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::finding::{Finding, Judge, Known};
use asperity::kernel::Kernel;
use asperity::march::{March, Row, Step, in_contact_frame};
use asperity::material::Creep;
use asperity::sliding::Friction;
use asperity::{Error, Simulation};
use ndarray::Array2;
use serde_json::{Map, Value, json};
use thiserror::Error;

use crate::case::{Case, CaseErrors, Travel};
use crate::leakage::{self, LeakError};
use crate::readable::counted;
use crate::resources::free_disk;
use crate::store::{Field, FieldKind, Header, Outcome, Reader, SCALARS, Status, StoreError, Work, Writer};
use crate::stress::{self, Below, Ratio, StressBody, StressError};

pub use memory::peak_memory_bytes;

/// How a case is run.
#[derive(Clone, Debug, Default)]
pub struct RunOptions {
    /// Where the result goes; default: what the case says.
    pub output: Option<PathBuf>,
    /// Replace a result that is there.
    pub force: bool,
    /// Go on with the interrupted or killed run whose result is there.
    pub resume: bool,
    /// Stops the run, within one iteration, when it becomes true.
    pub interrupt: Arc<AtomicBool>,
}

/// How far a run has come, after each step.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// The row just stored. Of steady states of motion its time is the velocity.
    pub row: &'a Row,
    /// Its forces, of a contact in motion.
    pub friction: Option<Friction>,
    /// Whether rows are steady states of motion.
    pub sweep: bool,
    /// Rows stored.
    pub done: usize,
    /// Rows that a resumed run found stored.
    pub resumed: usize,
    /// Rows of the full run; `None` where they are found as the run goes.
    pub total: Option<usize>,
    /// The run is over at the latest then \[s\].
    pub end: f64,
    /// Whether this was the last row.
    pub finished: bool,
    /// Once all rows are stored: the times at which the stress below the surface is computed, and all of them.
    pub stress: Option<[usize; 2]>,
}

/// What a run did.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Complete, interrupted or failed.
    pub status: Status,
    /// Rows stored.
    pub rows: usize,
    /// Iterations of all rows.
    pub iterations: u64,
    /// Convolutions of all rows.
    pub convolutions: u64,
    /// Time on the clock, over all sessions of a resumed run \[s\].
    pub wall_s: f64,
    /// Largest memory of the process, where the system tells.
    pub peak_memory_bytes: Option<u64>,
    /// The result.
    pub result: PathBuf,
    /// The last row stored.
    pub last: Option<Row>,
    /// Its forces, of a contact in motion.
    pub friction: Option<Friction>,
    /// Where its numbers may be off.
    pub findings: Vec<Finding>,
    /// The stress below the surface, where the case asks for it.
    pub stress: Option<Below>,
    /// What leaks, in a few words, where the case asks for it.
    pub leak: Option<String>,
}

/// Why a run did not complete.
#[derive(Debug, Error)]
pub enum RunError {
    /// The case is wrong; nothing was written.
    #[error(transparent)]
    Case(#[from] CaseErrors),
    /// The result cannot be started; nothing was changed.
    #[error(transparent)]
    Output(StoreError),
    /// The result cannot be continued; the steps before are stored.
    #[error("{source}; {} before are stored", counted(summary.rows, "row"))]
    Storage {
        /// What failed.
        source: StoreError,
        /// What was done.
        summary: Box<Summary>,
    },
    /// The run is complete, its leakage is not.
    #[error("{source}; all rows are stored, and --resume or `asperity leak` computes the leakage")]
    Leakage {
        /// What failed.
        source: LeakError,
        /// What was done.
        summary: Box<Summary>,
    },
    /// A step was not solved; the rows before are stored.
    #[error("{source}")]
    Solve {
        /// What failed.
        source: Error,
        /// What was done.
        summary: Box<Summary>,
        /// Numbers of the best state of the step that failed.
        best: Option<Box<Row>>,
    },
}

/// Runs a case to its end, an error, or an interruption (which is a [`Summary`] of that status).
///
/// # Errors
/// [`RunError`], each with what was done.
pub fn run(
    case: &Case,
    options: &RunOptions,
    mut observe: impl FnMut(Progress) + Send,
) -> Result<Summary, RunError> {
    // Inside the pool: a sweep called from a worker starts sooner.
    rayon::scope(|_| run_inside(case, options, &mut observe))
}

fn run_inside(
    case: &Case,
    options: &RunOptions,
    observe: &mut (dyn FnMut(Progress) + Send),
) -> Result<Summary, RunError> {
    let path = options.output.clone().unwrap_or_else(|| case.output.path.clone());
    if !options.resume {
        check_disk(case, &path).map_err(RunError::Output)?;
    }
    let parts = case.parts()?;
    let simulation = case.simulation_of(&parts)?;
    if let Some(motion) = case.steady_of(&parts, &simulation)? {
        return steady::run(case, &parts, simulation, motion, options, observe);
    }
    let known = Known { parts: &parts, bodies: &case.bodies, thickness: case.thickness };
    let judge = Judge::new(&simulation, known);
    drop(parts);
    let header = header(case, &simulation);
    let (writer, checkpoint, earlier) = if options.resume {
        let earlier = earlier(&path).map_err(RunError::Output)?;
        let (writer, checkpoint) = match Writer::resume(&path, &header, simulation.gap.view()) {
            Err(complete @ StoreError::Complete { .. }) => return ended(case, &complete, &path, options),
            resumed => resumed.map_err(RunError::Output)?,
        };
        (writer, checkpoint, earlier)
    } else {
        let writer = Writer::create(&path, &header, simulation.gap.view(), options.force);
        (writer.map_err(RunError::Output)?, None, Earlier::default())
    };
    let mut record = Record { case, writer, judge, path: &path, last: None, friction: None, stress: None };
    let march = match &checkpoint {
        Some(checkpoint) => {
            let rows = earlier.rows.get(..checkpoint.step).unwrap_or_default();
            record.judge.resume(rows, &earlier.findings);
            March::resume(simulation, checkpoint)
        }
        None => March::new(simulation),
    };
    let mut march = match march {
        Ok(march) => march,
        Err(source) => return Err(record.fail(None, None, source)),
    };
    march.interrupt_with(options.interrupt.clone());
    let (total, resumed, end_time) = (march.rows_expected(), march.done(), case.times.end());
    let mut maps = Maps::new(case, march.simulation().grid.shape());
    loop {
        let row = match march.advance().map(|step| step.is_some()) {
            Ok(false) => break,
            Ok(true) => match record.store(&mut maps, &march) {
                Ok(Some(row)) => row,
                Ok(None) => break,
                Err(source) => return Err(record.stop_storing(Some(march.simulation()), source)),
            },
            Err(Error::Interrupted) => {
                // The step under way is lost: a resumed run repeats what came after the last checkpoint.
                return record.end(Some(march.simulation()), Outcome::new(Status::Interrupted));
            }
            Err(source) => return Err(record.fail(Some(march.simulation()), best(&march), source)),
        };
        let due = case.output.checkpoint && !march.finished() && record.writer.checkpoint_due();
        if due && let Err(source) = record.checkpoint(&march) {
            return Err(record.stop_storing(Some(march.simulation()), source));
        }
        let finished = march.finished();
        observe(Progress {
            row: &row,
            friction: march.last().and_then(|step| step.friction()),
            sweep: false,
            done: march.done(),
            resumed,
            total,
            end: end_time,
            finished,
            stress: None,
        });
        // Between two rows nothing is lost.
        if options.interrupt.load(Ordering::Relaxed) && !finished {
            if case.output.checkpoint
                && let Err(source) = record.checkpoint(&march)
            {
                return Err(record.stop_storing(Some(march.simulation()), source));
            }
            return record.end(Some(march.simulation()), Outcome::new(Status::Interrupted));
        }
    }
    if let (Some(plan), Some(row)) = (&case.stress, record.last) {
        let done = march.done();
        let tell = |times, of| {
            let stress = Some([times, of]);
            observe(Progress {
                row: &row,
                friction: None,
                sweep: false,
                done,
                resumed,
                total,
                end: end_time,
                finished: true,
                stress,
            });
        };
        match stress::evaluate(&mut record.writer, plan, &options.interrupt, tell) {
            Ok(below) => record.stress = Some(below),
            Err(StressError::Solve(Error::Interrupted)) => {
                return record.end(Some(march.simulation()), Outcome::new(Status::Interrupted));
            }
            Err(StressError::Solve(source)) => {
                return Err(record.fail(Some(march.simulation()), best(&march), source));
            }
            Err(StressError::Store(source)) => {
                return Err(record.stop_storing(Some(march.simulation()), source));
            }
            // The case would have been refused.
            Err(error @ (StressError::Refused { .. } | StressError::NoContact { .. })) => {
                let source = Error::invalid("[stress]", error, "left out");
                return Err(record.fail(Some(march.simulation()), best(&march), source));
            }
        }
    }
    let summary = record.end(Some(march.simulation()), Outcome::new(Status::Complete))?;
    drop(march);
    leakage(case, summary, options)
}

/// The leakage that a case asks for, computed and stored once all rows are.
fn leakage(case: &Case, mut summary: Summary, options: &RunOptions) -> Result<Summary, RunError> {
    let Some(leak) = &case.leakage else { return Ok(summary) };
    match leakage::store(&summary.result, leak, &options.interrupt, |_, _| {}) {
        Ok(leaks) => {
            summary.findings.extend(leaks.findings.iter().cloned());
            summary.leak = Some(leaks.sentence());
            Ok(summary)
        }
        Err(source) => Err(RunError::Leakage { source, summary: Box::new(summary) }),
    }
}

/// Resuming a complete result: its leakage is computed where it is asked for and missing, else nothing is left to do.
fn ended(case: &Case, complete: &StoreError, path: &Path, options: &RunOptions) -> Result<Summary, RunError> {
    let summary = stored(path).map_err(RunError::Output)?;
    if Reader::open(path).is_ok_and(|reader| reader.lacks_leakage()) {
        return leakage(case, summary, options);
    }
    tracing::warn!("{complete}");
    Ok(summary)
}

/// What the run did that stored the complete result at `path`.
fn stored(path: &Path) -> Result<Summary, StoreError> {
    let reader = Reader::open(path)?;
    let work = reader.work();
    Ok(Summary {
        status: reader.status(),
        rows: reader.len(),
        iterations: work.iterations,
        convolutions: work.convolutions,
        wall_s: work.wall_s,
        peak_memory_bytes: work.peak_memory_bytes,
        result: path.to_owned(),
        last: reader.rows()?.last().copied(),
        friction: None,
        findings: reader.findings().to_vec(),
        stress: Below::of(&reader)?,
        leak: None,
    })
}

/// How much fields are compressed at best where contact is sparse: zeros take next to nothing.
const BEST_COMPRESSION: u64 = 10;

/// Refuses a result that cannot fit on its disk, and warns of one that may not.
fn check_disk(case: &Case, path: &Path) -> Result<(), StoreError> {
    let description = case.describe();
    let stress = description.stress.and_then(|stress| stress.result_bytes).unwrap_or(0);
    let fields = description.result_bytes.map(|fields| fields.saturating_add(stress));
    let (Some(fields), Some(free)) = (fields, free_disk(path)) else { return Ok(()) };
    // The numbers of rows are not compressed.
    let columns = 8 * (SCALARS.len() + case.output.quantities.list.len()) as u64;
    let rows = (description.usual_rows as u64).saturating_mul(columns);
    let needed = fields.saturating_add(rows);
    let error = StoreError::NoSpace { path: path.to_owned(), needed, free };
    if rows.saturating_add(fields / BEST_COMPRESSION) > free {
        return Err(error);
    }
    if needed > free {
        tracing::warn!("{error}");
    }
    Ok(())
}

/// The numbers of the state that a failed step reached.
fn best(march: &March) -> Option<Box<Row>> {
    march.last().map(|step| Box::new(step.row()))
}

/// Rows and findings of the sessions before a resumed one.
#[derive(Default)]
struct Earlier {
    rows: Vec<Row>,
    findings: Vec<Finding>,
}

fn earlier(path: &Path) -> Result<Earlier, StoreError> {
    let reader = Reader::open(path)?;
    Ok(Earlier { rows: reader.rows()?, findings: reader.findings().to_vec() })
}

/// The result of a run under way, and its judge.
struct Record<'a> {
    case: &'a Case,
    writer: Writer,
    judge: Judge,
    path: &'a Path,
    /// The last row stored, and its forces.
    last: Option<Row>,
    friction: Option<Friction>,
    /// The stress below the surface, once it is computed.
    stress: Option<Below>,
}

impl Record<'_> {
    /// Stores the last row, and before it the fields between it and the row before it that are asked for.
    fn store(&mut self, maps: &mut Maps<'_>, march: &March) -> Result<Option<Row>, StoreError> {
        let Some(step) = march.last() else { return Ok(None) };
        let instant = step.instant();
        for time in maps.case.output.rows.between(instant.time - instant.dt, instant.time) {
            // Steps that end there keep their own fields.
            if let Some(between) = march.between(*time) {
                let fields = maps.of(&march.view(&between));
                self.writer.stage(*time, &fields)?;
            }
        }
        let row = step.row();
        let keeps = maps.case.output.rows.holds(step.index(), march.finished(), instant.time);
        let fields = if keeps { maps.of(&step) } else { vec![] };
        self.writer.append_with(&row, step.quantities(), &fields)?;
        self.judge.see(&step, &row);
        self.last = Some(row);
        self.friction = step.friction();
        Ok(Some(row))
    }

    /// What was found so far: of the materials, and of the run.
    fn findings(&self, simulation: Option<&Simulation>) -> Vec<Finding> {
        let of_run = match simulation {
            Some(simulation) => self.judge.findings(simulation),
            None => self.judge.known().to_vec(),
        };
        let of_stress = self.stress.iter().flat_map(|below| below.findings(&self.case.grid));
        self.case.findings.iter().cloned().chain(of_run).chain(of_stress).collect()
    }

    /// Stores what was found, and the state from which the run goes on.
    fn checkpoint(&mut self, march: &March) -> Result<(), StoreError> {
        self.writer.note(self.findings(Some(march.simulation())))?;
        self.writer.checkpoint(&march.checkpoint())
    }

    /// Ends a run whose step was not solved.
    fn fail(self, simulation: Option<&Simulation>, best: Option<Box<Row>>, source: Error) -> RunError {
        let outcome = Outcome { message: Some(source.to_string()), ..Outcome::new(Status::Failed) };
        match self.end(simulation, outcome) {
            Ok(summary) => RunError::Solve { source, summary: Box::new(summary), best },
            Err(error) => error,
        }
    }

    /// Ends a run whose step could not be stored; that this cannot be stored either is no news.
    fn stop_storing(self, simulation: Option<&Simulation>, source: StoreError) -> RunError {
        let outcome = Outcome { message: Some(source.to_string()), ..Outcome::new(Status::Failed) };
        let summary = match self.end(simulation, outcome) {
            Ok(summary) => Box::new(summary),
            Err(RunError::Storage { summary, .. }) => summary,
            Err(error) => return error,
        };
        RunError::Storage { source, summary }
    }

    /// Ends the result.
    fn end(mut self, simulation: Option<&Simulation>, outcome: Outcome) -> Result<Summary, RunError> {
        let findings = self.findings(simulation);
        self.writer.set_findings(findings.clone());
        let (rows, before) = (self.writer.len(), self.writer.work().clone());
        let outcome = Outcome {
            peak_memory_bytes: peak_memory_bytes(),
            threads: Some(rayon::current_num_threads()),
            ..outcome
        };
        let (status, result, last) = (outcome.status, self.path.to_owned(), self.last);
        let friction = self.friction;
        let stress = self.stress.take();
        let summary = |status, work: Work| Summary {
            status,
            rows,
            iterations: work.iterations,
            convolutions: work.convolutions,
            wall_s: work.wall_s,
            peak_memory_bytes: work.peak_memory_bytes,
            result,
            last,
            friction,
            findings,
            stress,
            leak: None,
        };
        match self.writer.finish(&outcome) {
            Ok(work) => Ok(summary(status, work)),
            Err(source) => {
                Err(RunError::Storage { source, summary: Box::new(summary(Status::Failed, before)) })
            }
        }
    }
}

/// The fields of the rows that keep them, in memory of their own.
struct Maps<'a> {
    case: &'a Case,
    pressure: Array2<f64>,
    gap: Array2<f64>,
    displacement: Array2<f64>,
    flattening: Array2<f64>,
    contact: Array2<u8>,
}

impl<'a> Maps<'a> {
    fn new(case: &'a Case, shape: (usize, usize)) -> Self {
        let keeps = |field| case.output.fields.contains(&field);
        let map = |kept: bool| Array2::zeros(if kept { shape } else { (0, 0) });
        Maps {
            case,
            pressure: map(false),
            gap: map(keeps(FieldKind::Gap)),
            displacement: map(keeps(FieldKind::Displacement)),
            flattening: map(keeps(FieldKind::Flattening)),
            contact: Array2::zeros(if keeps(FieldKind::Contact) { shape } else { (0, 0) }),
        }
    }

    /// All fields of the case.
    fn of<'b>(&'b mut self, step: &Step<'b>) -> Vec<Field<'b>> {
        let output = &self.case.output;
        let keeps = |field| output.fields.contains(&field);
        let mut fields = vec![];
        if step.frame_shift() != [0; 2] {
            return self.in_contact_frame(step);
        }
        if keeps(FieldKind::Pressure) {
            fields.push(Field::Pressure(step.pressure()));
        }
        if keeps(FieldKind::Gap) {
            step.gap_into(&mut self.gap);
            fields.push(Field::Gap(self.gap.view()));
        }
        if keeps(FieldKind::Displacement) {
            step.displacement_into(&mut self.displacement);
            fields.push(Field::Displacement(self.displacement.view()));
        }
        if keeps(FieldKind::Contact) {
            step.contact_into(&mut self.contact);
            fields.push(Field::Contact(self.contact.view()));
        }
        if keeps(FieldKind::Flattening) {
            step.flattening_into(&mut self.flattening);
            fields.push(Field::Flattening(self.flattening.view()));
        }
        fields
    }
}

impl<'a> Maps<'a> {
    /// The fields of a contact that has moved, in its frame. Beyond the ends of a free track nothing is known but that there is no
    /// pressure.
    fn in_contact_frame<'b>(&'b mut self, step: &Step<'b>) -> Vec<Field<'b>> {
        let (shift, boundary) = (step.frame_shift(), step.simulation().boundary);
        let keeps = |field| self.case.output.fields.contains(&field);
        let moved = |field: &Array2<f64>, beyond| in_contact_frame(field.view(), boundary, shift, beyond);
        let (pressure, gap) = (keeps(FieldKind::Pressure), keeps(FieldKind::Gap));
        let (displacement, contact) = (keeps(FieldKind::Displacement), keeps(FieldKind::Contact));
        if pressure {
            self.pressure = in_contact_frame(step.pressure(), boundary, shift, 0.0);
        }
        if gap {
            step.gap_into(&mut self.gap);
            self.gap = moved(&self.gap, f64::NAN);
        }
        if displacement {
            step.displacement_into(&mut self.displacement);
            self.displacement = moved(&self.displacement, f64::NAN);
        }
        if contact {
            step.contact_into(&mut self.contact);
            self.contact = in_contact_frame(self.contact.view(), boundary, shift, 0);
        }
        let all = [
            (pressure, Field::Pressure(self.pressure.view())),
            (gap, Field::Gap(self.gap.view())),
            (displacement, Field::Displacement(self.displacement.view())),
            (contact, Field::Contact(self.contact.view())),
        ];
        all.into_iter().filter_map(|(kept, field)| kept.then_some(field)).collect()
    }
}

/// What the result says of the run before it starts.
fn header(case: &Case, simulation: &Simulation) -> Header {
    Header {
        title: case.title.clone().unwrap_or_default(),
        case_text: case.source.clone(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        grid: simulation.grid,
        fields: case.output.fields.iter().copied().collect(),
        // Checked with the simulation.
        quantities: simulation.columns().unwrap_or_default(),
        rows_expected: Some(simulation.plan()).filter(|plan| plan.exact).map(|plan| plan.instants.len()),
        setup: setup(case),
    }
}

/// Points of a course for pictures: all of them, or of many every second one, every third one and so on, and the last.
fn thinned(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    const MOST: usize = 1000;
    let every = points.len().div_ceil(MOST).max(1);
    let is_kept = |n: usize| n.is_multiple_of(every) || n + 1 == points.len();
    points.iter().enumerate().filter(|(n, _)| is_kept(*n)).map(|(_, point)| *point).collect()
}

/// The case in numbers, SI.
fn setup(case: &Case) -> Map<String, Value> {
    let description = serde_json::to_value(case.describe()).unwrap_or_default();
    let mut setup = match description {
        Value::Object(map) => map,
        _ => Map::new(),
    };
    setup.insert("contact_creep_compliance".into(), creep(&case.creep));
    if !case.thermal.is_empty() {
        let parts: Vec<Value> = case.thermal.iter().map(|body| creep(&body.creep)).collect();
        setup.insert("contact_creep_compliance_over_reduced_time".into(), json!(parts));
    }
    if let Some(points) = &case.temperatures {
        setup.insert("temperature_course".into(), json!(thinned(points)));
    }
    if !case.files.is_empty() {
        let files: Map<String, Value> =
            case.files.iter().map(|(path, digest)| (path.clone(), json!(digest))).collect();
        setup.insert("md5_of_files".into(), json!(files));
    }
    if let Some(layers) = &case.layers {
        let misfit = case.waves.as_ref().map(|waves| waves.misfit());
        setup.insert("layer_separable".into(), json!(misfit.is_none()));
        setup.insert("layer_misfit".into(), json!(misfit.unwrap_or(0.0)));
        setup.insert("layer_rigid_base".into(), json!(layers.depth().is_some()));
    }
    if let Some(motion) = &case.motion {
        let steady = matches!(motion.travel, Travel::Steady(_));
        let [x, y] = motion.direction.unit();
        let shear = motion.shear_stress;
        setup.insert(
            "motion".into(),
            json!({ "steady": steady, "direction": [x, y], "rolls": motion.rolls, "shear_stress": shear }),
        );
    }
    let ratio = |body| StressBody::of(body, !case.thermal.is_empty()).poisson;
    let ratios: Vec<Option<Ratio>> = case.bodies.iter().map(ratio).collect();
    if ratios.iter().flatten().any(|ratio| ratio.constant().is_none()) {
        let creep = |ratio: &Option<Ratio>| match ratio {
            Some(Ratio::Changing(creep)) => json!(creep),
            _ => Value::Null,
        };
        setup.insert(stress::POISSON_CREEP.into(), ratios.iter().map(creep).collect());
    }
    setup.insert("solver_tolerance".into(), json!(case.solver.tolerance));
    if let Some(plan) = &case.stress {
        setup.insert(stress::SETUP.into(), serde_json::to_value(plan).unwrap_or_default());
    }
    if let Some(leak) = &case.leakage {
        setup.insert("leakage".into(), serde_json::to_value(leak).unwrap_or_default());
    }
    setup
}

/// A creep function in numbers, SI.
fn creep(creep: &Creep) -> Value {
    let terms: Vec<_> = creep.terms.iter().map(|t| json!([t.compliance, t.retardation_time])).collect();
    json!({ "instantaneous": creep.instantaneous, "terms": terms, "fluidity": creep.fluidity })
}
