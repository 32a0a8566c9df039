//! The result of a run under way: what each row brings, and how the run ends.

use std::path::Path;

use asperity::finding::{Diagnostics, Finding};
use asperity::sliding::Friction;
use asperity::step::Row;
use asperity::{Drive, Error};

use super::maps::Maps;
use super::{RunError, Summary, peak_memory_bytes};
use crate::case::Case;
use crate::store::{Outcome, Reader, Status, StoreError, Work, Writer};
use crate::stress::Below;

/// Why a run stops early.
#[derive(Debug, thiserror::Error)]
pub(super) enum Stop {
    /// The user interrupted it, its drive could not be made, or a step was not solved.
    #[error(transparent)]
    Solve(#[from] Error),
    /// A step could not be stored.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// The result of a run under way, and its diagnostics.
pub(super) struct Record<'a> {
    pub(super) case: &'a Case,
    pub(super) writer: Writer,
    pub(super) diagnostics: Diagnostics,
    pub(super) path: &'a Path,
    /// The last row stored, and its forces.
    pub(super) last: Option<Row>,
    pub(super) friction: Option<Friction>,
    /// The stress below the surface, once it is computed.
    pub(super) stress: Option<Below>,
}

impl Record<'_> {
    /// Takes in what the sessions before a resumed one have stored.
    pub(super) fn recall(&mut self) -> Result<(), StoreError> {
        let stored = Reader::open(self.path)?;
        self.diagnostics.resume(&stored.rows()?, &stored.frictions()?, stored.findings());
        Ok(())
    }

    /// Stores the last row, with its fields where they are asked for.
    pub(super) fn store(&mut self, maps: &mut Maps, drive: &dyn Drive) -> Result<Option<Row>, StoreError> {
        let Some(step) = drive.last() else { return Ok(None) };
        let (row, stored) = (step.row(), &self.case.output.rows);
        let at = row.coordinate.value();
        let fields = if stored.holds(step.index(), drive.finished(), at) { maps.of(&step) } else { vec![] };
        self.writer.append_with(&row, step.quantities(), &fields)?;
        self.diagnostics.see(&step, &row);
        self.last = Some(row);
        self.friction = step.friction();
        Ok(Some(row))
    }

    /// What was found so far: of the materials, and of the run.
    fn findings(&self, drive: Option<&dyn Drive>) -> Vec<Finding> {
        let of_run = match drive {
            Some(drive) => self.diagnostics.findings(drive.simulation()),
            None => self.diagnostics.known().to_vec(),
        };
        let of_stress = self.stress.iter().flat_map(|below| below.findings());
        self.case.findings.iter().cloned().chain(of_run).chain(of_stress).collect()
    }

    /// Stores what was found, and the state from which the run goes on.
    pub(super) fn checkpoint(&mut self, drive: &dyn Drive) -> Result<(), StoreError> {
        self.writer.note(self.findings(Some(drive)))?;
        self.writer.checkpoint(&drive.checkpoint())
    }

    /// Ends a run that stopped early. If the end of one whose step could not be stored cannot be stored either, the first error is
    /// reported.
    pub(super) fn stop(self, drive: Option<Box<dyn Drive>>, stop: Stop) -> Result<Summary, RunError> {
        if let Stop::Solve(Error::Interrupted) = stop {
            return self.end(drive, Outcome::new(Status::Interrupted));
        }
        let best = drive.as_ref().and_then(|drive| drive.last()).map(|step| Box::new(step.row()));
        let outcome = Outcome { message: Some(stop.to_string()), ..Outcome::new(Status::Failed) };
        Err(match (stop, self.end(drive, outcome)) {
            (Stop::Solve(source), Ok(summary)) => {
                RunError::Solve { source, summary: Box::new(summary), best }
            }
            (Stop::Store(source), Ok(summary)) => RunError::Storage { source, summary: Box::new(summary) },
            (Stop::Store(source), Err(RunError::Storage { summary, .. })) => {
                RunError::Storage { source, summary }
            }
            (_, Err(error)) => error,
        })
    }

    /// Ends the result. The memory of the drive is given back before the answers are read from it.
    pub(super) fn end(
        mut self,
        drive: Option<Box<dyn Drive>>,
        outcome: Outcome,
    ) -> Result<Summary, RunError> {
        let findings = self.findings(drive.as_deref());
        drop(drive);
        self.writer.set_findings(findings.clone());
        let (rows, before) = (self.writer.len(), self.writer.work().clone());
        let outcome = Outcome {
            peak_memory_bytes: peak_memory_bytes(),
            threads: Some(rayon::current_num_threads()),
            ..outcome
        };
        let (status, path, last, units) = (outcome.status, self.path, self.last, &self.case.output.units);
        let summary =
            |status, work: &Work| Summary { last, findings, ..Summary::of(status, rows, work, path) };
        match self.writer.finish(&outcome) {
            Ok(work) => Ok(Summary { answers: super::answers(path, units), ..summary(status, &work) }),
            Err(source) => {
                Err(RunError::Storage { source, summary: Box::new(summary(Status::Failed, &before)) })
            }
        }
    }
}
