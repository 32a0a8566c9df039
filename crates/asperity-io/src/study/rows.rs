//! What has become of each run, as its files say.

use std::collections::BTreeSet;
use std::fs;

use super::folder::Study;
use super::plan::Run;
use crate::answer::{self, Answer, Units};
use crate::converge::ErrorBar;
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
    /// The errors of its answers, where they were computed.
    pub bars: Vec<ErrorBar>,
    /// Codes of the findings of its result, one for each finding.
    pub findings: Vec<String>,
}

impl Row {
    /// The names of its answers that its findings take back.
    pub fn not_valid(&self) -> String {
        let taken = self.answers.iter().filter(|answer| !answer.validity.is_valid());
        taken.map(|answer| answer.name.as_str()).collect::<Vec<_>>().join(" ")
    }

    /// The codes of its findings, each once.
    pub fn codes(&self) -> String {
        let codes: BTreeSet<&str> = self.findings.iter().map(String::as_str).collect();
        codes.into_iter().collect::<Vec<_>>().join(" ")
    }
}

/// The row of a run.
pub(super) fn of(study: &Study, run: &Run) -> Row {
    let row = |state, answers, findings| Row { run: run.clone(), state, answers, bars: vec![], findings };
    let told =
        fs::read_to_string(study.error_file(run)).ok().map(|text| State::Failed(text.trim().to_owned()));
    let path = study.result(run);
    if !path.exists() {
        return row(told.unwrap_or(State::Missing), vec![], vec![]);
    }
    let reader = match Reader::open(&path) {
        Ok(reader) => reader,
        Err(error) => return row(State::Failed(error.to_string()), vec![], vec![]),
    };
    let findings: Vec<String> = reader.findings().iter().map(|finding| finding.code.to_string()).collect();
    if reader.is_being_written() {
        return row(State::Running, vec![], findings);
    }
    match reader.status() {
        Status::Complete if !reader.lacks_leakage() => {
            match answer::of(&reader, &Units::of(&reader, &Units::default())) {
                Ok(answers) => Row { bars: reader.error_bars(), ..row(State::Done, answers, findings) },
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
