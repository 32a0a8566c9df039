//! A run: a case, the drive of its rows and their result, row by row.
//!
//! The command and the Python package run cases through here, so that the same case gives the same
//! numbers wherever it is started.

mod maps;
mod record;
mod setup;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use asperity::finding::{Diagnostics, Finding, Known};
use asperity::sliding::Friction;
use asperity::step::Row;
use asperity::{Drive, Error, drive};
use thiserror::Error;

use crate::answer::{self, Answer, Units};
use crate::case::{Case, CaseErrors};
use crate::leakage::{self, LeakError};
use crate::readable::counted;
use crate::resources::free_disk;
use crate::store::{LeakTable, Outcome, Reader, SCALARS, Status, StoreError, Work, Writer};
use crate::stress::{self, StressError};
use maps::Maps;
use record::{Record, Stop};
use setup::header;
pub use setup::setup;

pub use crate::resources::peak_memory_bytes;

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
    /// The row just stored.
    pub row: &'a Row,
    /// Its forces, of a contact in motion.
    pub friction: Option<Friction>,
    /// Rows stored.
    pub done: usize,
    /// Rows that a resumed run found stored.
    pub resumed: usize,
    /// Rows of the full run; `None` where they are found as the run goes.
    pub total: Option<usize>,
    /// A run in time is over at the latest then \[s\].
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
    /// The numbers that the run was made for; none if it failed before its first row.
    pub answers: Vec<Answer>,
    /// Where its numbers may be off.
    pub findings: Vec<Finding>,
}

impl Summary {
    /// Of what is stored at `result`: its rows and the work that they took.
    fn of(status: Status, rows: usize, work: &Work, result: &Path) -> Summary {
        Summary {
            status,
            rows,
            iterations: work.iterations,
            convolutions: work.convolutions,
            wall_s: work.wall_s,
            peak_memory_bytes: work.peak_memory_bytes,
            result: result.to_owned(),
            last: None,
            answers: vec![],
            findings: vec![],
        }
    }
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
    let steady = case.steady_of(&parts, &simulation)?;
    let known = Known {
        parts: &parts,
        bodies: &case.bodies,
        thickness: case.thickness,
        mirrored: case.is_mirrored(),
    };
    let diagnostics = Diagnostics::new(&simulation, known);
    drop(parts);
    let header = header(case, &simulation, steady.as_ref());
    let gap = simulation.gap.view();
    let opened = match options.resume {
        true => Writer::resume(&path, &header, gap),
        false => Writer::create(&path, &header, gap, options.force).map(|writer| (writer, None)),
    };
    let (writer, checkpoint) = match opened {
        Err(complete @ StoreError::Complete { .. }) => return ended(case, &complete, &path, options),
        opened => opened.map_err(RunError::Output)?,
    };
    let mut record =
        Record { case, writer, diagnostics, path: &path, last: None, friction: None, stress: None };
    let drive = match &checkpoint {
        Some(checkpoint) => drive::resume(simulation, steady, checkpoint),
        None => drive::of(simulation, steady),
    };
    let mut drive = match drive {
        Ok(drive) => drive,
        Err(source) => return record.stop(None, source.into()),
    };
    if let Some(streaming) = drive.streaming() {
        record.diagnostics = record.diagnostics.of_sweep(streaming.clone());
    }
    if checkpoint.is_some() {
        record.recall().map_err(RunError::Output)?;
    }
    drive.interrupt_with(options.interrupt.clone());
    if let Err(stop) = rows(case, options, &mut *drive, &mut record, observe) {
        return record.stop(Some(drive), stop);
    }
    let summary = record.end(Some(drive), Outcome::new(Status::Complete))?;
    leakage(case, summary, options)
}

/// Stores the rows of a drive, and the stress below the surface where the case asks for it.
fn rows(
    case: &Case,
    options: &RunOptions,
    drive: &mut dyn Drive,
    record: &mut Record,
    observe: &mut (dyn FnMut(Progress) + Send),
) -> Result<(), Stop> {
    let mut maps = Maps::new(case, drive.simulation().grid.shape());
    let course = Progress {
        row: &Row::default(),
        friction: None,
        done: 0,
        resumed: drive.done(),
        total: drive.rows_expected(),
        end: case.conditions.times.end(),
        finished: false,
        stress: None,
    };
    // A step that is interrupted is lost: a resumed run repeats what came after the last checkpoint.
    while drive.advance()?.is_some() {
        let Some(row) = record.store(&mut maps, drive)? else { break };
        let finished = drive.finished();
        if case.output.checkpoint && !finished && record.writer.checkpoint_due() {
            record.checkpoint(drive)?;
        }
        observe(Progress { row: &row, friction: record.friction, done: drive.done(), finished, ..course });
        // Between two rows nothing is lost.
        if options.interrupt.load(Ordering::Relaxed) && !finished {
            if case.output.checkpoint {
                record.checkpoint(drive)?;
            }
            return Err(Error::Interrupted.into());
        }
    }
    if let (Some(plan), Some(row)) = (&case.stress, record.last) {
        let done = drive.done();
        let tell = |times, of| {
            observe(Progress { row: &row, done, finished: true, stress: Some([times, of]), ..course });
        };
        let below = stress::evaluate(&mut record.writer, plan, &options.interrupt, tell);
        record.stress = Some(below.map_err(|error| match error {
            StressError::Solve(source) => Stop::Solve(source),
            StressError::Store(source) => Stop::Store(source),
            // The case would have been refused.
            error => Stop::Solve(Error::invalid("[stress]", error, "left out")),
        })?);
    }
    Ok(())
}

/// The leakage that a case asks for, computed and stored once all rows are.
fn leakage(case: &Case, mut summary: Summary, options: &RunOptions) -> Result<Summary, RunError> {
    let Some(leak) = &case.leakage else { return Ok(summary) };
    let stored = || {
        let simulation =
            || case.simulation().map_err(|errors| Error::invalid("case", errors, "one that was run"));
        let reader = Reader::open(&summary.result)?;
        let beside = leakage::Beside::of(leak, simulation, &reader, &options.interrupt)?;
        leakage::store(&summary.result, leak, beside, &options.interrupt, |_, _| {})
    };
    match stored() {
        Ok(leaks) => {
            // Those of the case about its leak are among them.
            summary.findings.retain(|finding| !LeakTable::is_judged_by(&finding.code));
            summary.findings.extend(leaks.findings.iter().cloned());
            summary.answers = answers(&summary.result, &case.output.units);
            Ok(summary)
        }
        Err(source) => Err(RunError::Leakage { source, summary: Box::new(summary) }),
    }
}

/// Resuming a complete result: its leakage is computed where it is asked for and missing, else nothing is left to do.
fn ended(case: &Case, complete: &StoreError, path: &Path, options: &RunOptions) -> Result<Summary, RunError> {
    let summary = stored(path, &case.output.units).map_err(RunError::Output)?;
    if Reader::open(path).is_ok_and(|reader| reader.lacks_leakage()) {
        return leakage(case, summary, options);
    }
    tracing::warn!("{complete}");
    Ok(summary)
}

/// The answers of what is stored at `path`. A result that cannot be read back has been reported already where it was written.
fn answers(path: &Path, units: &Units) -> Vec<Answer> {
    Reader::open(path).and_then(|reader| answer::of(&reader, units)).unwrap_or_default()
}

/// What the run did that stored the complete result at `path`.
fn stored(path: &Path, units: &Units) -> Result<Summary, StoreError> {
    let reader = Reader::open(path)?;
    Ok(Summary {
        last: reader.rows()?.last().copied(),
        findings: reader.findings().to_vec(),
        answers: answer::of(&reader, units)?,
        ..Summary::of(reader.status(), reader.len(), reader.work(), path)
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
    let columns = 8 * (SCALARS.len() + case.conditions.quantities.list.len()) as u64;
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
