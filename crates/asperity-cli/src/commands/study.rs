//! `asperity study`: a case for several values of some of its keys.

use std::path::{Path, PathBuf};

use asperity_io::answer::{Answer, Units};
use asperity_io::store::Reader;
use asperity_io::study::{Event, Options, Outcome, Row, State, Study, StudyError, Table};
use asperity_report::sheet::Sheet;
use serde_json::{Value, json};

use super::answers::{note_unused, units};
use crate::args::{self, StudyAction, StudyFolder};
use crate::failure::{Failure, refuse};
use crate::format::{columns, counted, duration};
use crate::launcher;
use crate::verb::{Threads, Verb};

impl Verb for args::Study {
    fn threads(&self) -> Threads {
        match self.action {
            None => Threads::of(self.common.threads),
            Some(_) => Threads::Default,
        }
    }

    /// Computes what is missing, tells each run on stderr, and prints the table.
    fn run(&self) -> Result<(), Failure> {
        match (&self.action, &self.case) {
            (Some(StudyAction::Status(folder)), _) => status(folder),
            (Some(StudyAction::Collect(folder)), _) => collect(folder),
            (None, Some(case)) => self.work(case),
            (None, None) => refuse!("name a case file"),
        }
    }
}

impl args::Study {
    fn work(&self, case: &Path) -> Result<(), Failure> {
        let units = units(&self.unit)?;
        let folder = self.output.clone().unwrap_or_else(|| usual(case, "study"));
        let zip = (self.zip || self.product).then_some(self.zip);
        let study = Study::new(case, &self.vary, zip, &self.common.set, &folder).map_err(failure)?;
        let share = launcher::share(self.shard);
        let options = Options {
            jobs: self.jobs.map(usize::from),
            threads: None,
            shard: share.as_ref().map(|share| share.part),
            neighbours: launcher::neighbours(),
            error_bars: self.error_bars,
            interrupt: crate::interrupt::flag(),
        };
        if !self.quiet {
            let of = share.as_ref().map_or(String::new(), |share| format!("; {share}"));
            crate::messages::message!("{} in {}{of}", counted(study.runs.len(), "run"), folder.display());
        }
        let mut tell = |event: &Event<'_>| {
            if !self.quiet {
                crate::messages::message!("{}", told(event, &units, |_| true));
            }
        };
        let Outcome { table, interrupted } = study.work(&options, &mut tell).map_err(failure)?;
        if let Some(share) = share.filter(|_| !interrupted && !table.has_ended()) {
            let left = counted(table.rows.len() - table.count("done") - table.count("failed"), "run");
            if !self.quiet {
                crate::messages::message!(
                    "{share}: done. {left} of the other shares are left; whichever process ends last draws and prints the table"
                );
            }
            // A launcher ends all processes when one of them ends with an error.
            return if self.json { print(&study, &table, true, &units) } else { Ok(()) };
        }
        draw(&study, &table, &units)?;
        print(&study, &table, self.json, &units)?;
        let (done, failed) = (table.count("done"), table.count("failed"));
        if interrupted {
            return Err(Failure::Interrupted(format!(
                "{done} of {} are done; the same command goes on",
                counted(study.runs.len(), "run")
            )));
        }
        match failed {
            0 => Ok(()),
            failed => Err(Failure::Solve(format!("{failed} of {} failed", counted(study.runs.len(), "run")))),
        }
    }
}

/// The folder that is usual for what a case is solved for: "gel-study" for "gel.toml".
pub(super) fn usual(case: &Path, what: &str) -> PathBuf {
    format!("{}-{what}", case.file_stem().unwrap_or_default().to_string_lossy()).into()
}

pub(super) fn failure(error: StudyError) -> Failure {
    match error {
        StudyError::Case(errors) => Failure::Case(errors),
        error => error.into(),
    }
}

/// A run that has ended, on one line.
pub(super) fn told(event: &Event<'_>, units: &Units, is_shown: impl Fn(&Answer) -> bool) -> String {
    let came = match &event.row.state {
        State::Done => {
            let shown = event.row.answers.iter().find(|answer| is_shown(answer));
            let words = |answer: &Answer| answer.validity.cell(answer.words(units));
            shown.map_or("done".into(), |answer| format!("{} {}", answer.label(), words(answer)))
        }
        State::Failed(why) => format!("failed: {why}"),
        state => state.word().to_owned(),
    };
    let no_errors = event.no_errors.as_ref().map(|why| format!("; no error bars: {why}")).unwrap_or_default();
    let seconds = duration(event.seconds);
    format!("{}/{}  {}: {came}{no_errors} ({seconds})", event.ended, event.of, event.label)
}

fn status(args: &StudyFolder) -> Result<(), Failure> {
    let study = Study::open(&args.folder).map_err(failure)?;
    print(&study, &study.table(study.rows()), args.json, &units(&args.unit)?)
}

fn collect(args: &StudyFolder) -> Result<(), Failure> {
    let units = units(&args.unit)?;
    let study = Study::open(&args.folder).map_err(failure)?;
    let table = study.collect().map_err(failure)?;
    draw(&study, &table, &units)?;
    print(&study, &table, args.json, &units)
}

/// Writes the figure, where there is something to draw, and the page.
fn draw(study: &Study, table: &Table, units: &Units) -> Result<(), Failure> {
    let name = study.folder.canonicalize().ok();
    let name = name.and_then(|folder| Some(folder.file_name()?.to_string_lossy().into_owned()));
    let name = name.unwrap_or_else(|| "study".into());
    let mut sheet = Sheet::new(match asperity_report::study::title(&study.plan, table) {
        Some(title) => format!("{name}: {title}"),
        None => name,
    });
    if let Some(figure) = asperity_report::study::figure(&study.plan, table) {
        super::picture::write(&figure, &study.folder.join("study.png"), true)?;
        sheet = sheet.figure("Answer", &figure);
    }
    sheet = sheet.table("Runs", &lines(study, table, units, usize::MAX));
    let findings = table.runs_of_findings();
    if !findings.is_empty() {
        let of = format!("runs of {}", table.rows.len());
        let lines = findings.iter().map(|(code, runs)| vec![(*code).to_owned(), runs.to_string()]);
        let lines: Vec<Vec<String>> = [vec!["finding".to_owned(), of]].into_iter().chain(lines).collect();
        sheet = sheet.table("Findings", &lines);
    }
    Ok(sheet.write(&study.folder.join("study.html"), true)?)
}

fn print(study: &Study, table: &Table, as_json: bool, units: &Units) -> Result<(), Failure> {
    let answers: Vec<Answer> = table.rows.iter().flat_map(|row| row.answers.clone()).collect();
    note_unused(units, &answers);
    crate::print(&if as_json { format!("{}\n", object(study, table)) } else { text(study, table, units) })
}

fn object(study: &Study, table: &Table) -> Value {
    let run = |row: &Row| {
        let mut values = serde_json::Map::new();
        for (n, varied) in study.plan.vary.iter().enumerate() {
            values.insert(varied.key.clone(), json!(row.run.values[n].text()));
        }
        let error = if let State::Failed(why) = &row.state { Some(why) } else { None };
        json!({
            "values": values,
            "status": row.state.word(),
            "answers": row.answers,
            "error_bars": row.bars,
            "findings": row.findings.len(),
            "finding_codes": row.codes(),
            "not_valid": row.not_valid(),
            "error": error,
            "result": study.result(&row.run).to_string_lossy(),
        })
    };
    let keys = table.keys.iter().zip(&study.plan.vary).map(|(key, varied)| {
        let value = |value: &asperity_io::study::Value| match (key.unit, value.number()) {
            (Some(_), Some((number, _))) => json!(number),
            _ => json!(value.text()),
        };
        json!({ "key": key.name, "unit": key.unit, "values": varied.values.iter().map(value).collect::<Vec<_>>() })
    });
    json!({
        "study": study.folder.to_string_lossy(),
        "zip": study.plan.zip,
        "keys": keys.collect::<Vec<_>>(),
        "counts": STATES.map(|word| (word, table.count(word))).into_iter().collect::<std::collections::BTreeMap<_, _>>(),
        "runs": table.rows.iter().map(run).collect::<Vec<_>>(),
    })
}

const STATES: [&str; 5] = ["done", "running", "unfinished", "failed", "missing"];
/// Answers in a line of the table.
const ANSWERS: usize = 4;
/// Letters of an error in it.
const LONGEST: usize = 90;

/// The cells of the table, with so many answers.
fn lines(study: &Study, table: &Table, units: &Units, most: usize) -> Vec<Vec<String>> {
    // The case may have chosen units.
    let done = table.rows.iter().find(|row| row.state == State::Done);
    let reader = done.and_then(|row| Reader::open(&study.result(&row.run)).ok());
    let units = reader.map_or_else(|| units.clone(), |reader| Units::of(&reader, units));
    let shown: Vec<&str> = table.answers.iter().map(|column| column.name.as_str()).take(most).collect();
    let keys = study.plan.vary.iter().map(|varied| study.plan.called(&varied.key));
    let head = keys.chain(["status".into()]).chain(shown.iter().map(|name| name.replace('_', " ")));
    let mut lines: Vec<Vec<String>> = vec![head.collect()];
    for row in &table.rows {
        let values = row.run.values.iter().map(|value| value.text());
        let mut line: Vec<String> = values.chain([row.state.word().to_owned()]).collect();
        match &row.state {
            State::Failed(why) => {
                let first = why.lines().next().unwrap_or_default();
                let cut: String = first.chars().take(LONGEST).collect();
                line.push(if cut.len() < why.len() { format!("{cut} ...") } else { cut });
            }
            _ => line.extend(shown.iter().map(|name| {
                let answer = row.answers.iter().find(|answer| answer.name == *name);
                let bar = row.bars.iter().find(|bar| bar.name == *name);
                let Some(answer) = answer else { return "-".to_owned() };
                let words = bar.map_or_else(|| answer.words(&units), |bar| units.plus_minus(bar));
                answer.validity.cell(words)
            })),
        }
        lines.push(line);
    }
    lines
}

fn text(study: &Study, table: &Table, units: &Units) -> String {
    let mut text = columns(&lines(study, table, units, ANSWERS), "");
    let counts = STATES.iter().filter(|word| table.count(word) > 0);
    let counts: Vec<String> = counts.map(|word| format!("{} {word}", table.count(word))).collect();
    text += &format!("\n{} of {}", counts.join(", "), counted(table.rows.len(), "run"));
    text += &format!("; table and figure in {}\n", study.folder.display());
    text.extend(table.findings().map(|words| format!("{words}\n")));
    text
}
