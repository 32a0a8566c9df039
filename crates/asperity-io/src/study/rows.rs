//! What has become of each run, as its files say.

use std::fs;

use super::folder::Study;
use super::plan::Run;
use crate::answer::{self, Answer, Units};
use crate::store::{Reader, Status};

/// How far a run is.
#[derive(Clone, Debug, PartialEq)]
pub enum State {
    /// Its result is complete.
    Done,
    /// A process computes it now.
    Running,
    /// It was stopped or killed; it goes on when the study is called again.
    Unfinished,
    /// It failed, for this reason.
    Failed(String),
    /// It was not started.
    Missing,
}

impl State {
    /// The word in tables: done, running, unfinished, failed, missing.
    pub fn word(&self) -> &'static str {
        match self {
            State::Done => "done",
            State::Running => "running",
            State::Unfinished => "unfinished",
            State::Failed(_) => "failed",
            State::Missing => "missing",
        }
    }
}

/// A run and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The run.
    pub run: Run,
    /// How far it is.
    pub state: State,
    /// Its answers, once it is done.
    pub answers: Vec<Answer>,
    /// Findings of its result.
    pub findings: usize,
}

/// The row of a run.
pub(super) fn of(study: &Study, run: &Run) -> Row {
    let row = |state, answers, findings| Row { run: run.clone(), state, answers, findings };
    let told =
        fs::read_to_string(study.error_file(run)).ok().map(|text| State::Failed(text.trim().to_owned()));
    let path = study.result(run);
    if !path.exists() {
        return row(told.unwrap_or(State::Missing), vec![], 0);
    }
    let reader = match Reader::open(&path) {
        Ok(reader) => reader,
        Err(error) => return row(State::Failed(error.to_string()), vec![], 0),
    };
    let findings = reader.findings().len();
    if reader.is_being_written() {
        return row(State::Running, vec![], findings);
    }
    match reader.status() {
        Status::Complete if !reader.lacks_leakage() => {
            match answer::of(&reader, &Units::of(&reader, &Units::default())) {
                Ok(answers) => row(State::Done, answers, findings),
                Err(error) => row(State::Failed(error.to_string()), vec![], findings),
            }
        }
        Status::Failed => {
            let message = || State::Failed(reader.work().message.clone().unwrap_or_else(|| reader.state()));
            row(told.unwrap_or_else(message), vec![], findings)
        }
        Status::Complete | Status::Running | Status::Interrupted => {
            row(told.unwrap_or(State::Unfinished), vec![], findings)
        }
    }
}
