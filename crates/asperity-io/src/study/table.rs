//! The runs as a table: what varied, how far each run is, its answers.

use std::collections::{BTreeMap, BTreeSet};

use super::folder::Study;
use super::plan::Run;
use super::rows::{Row, State};
use crate::readable::counted;

/// A study as columns.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The keys that vary.
    pub keys: Vec<Key>,
    /// The runs.
    pub rows: Vec<Row>,
    /// Their answers, in the order in which results have them.
    pub answers: Vec<Column>,
}

/// A key that varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Key {
    /// Its path.
    pub name: String,
    /// Its SI unit, empty for pure numbers; `None` where a value is no number.
    pub unit: Option<&'static str>,
}

/// An answer of all runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name.
    pub name: String,
    /// Its SI unit; "1" if it has none.
    pub unit: &'static str,
    /// Its value in each run, SI; NaN where a run does not have it.
    pub values: Vec<f64>,
    /// Its error in each run, SI; NaN where it is not known.
    pub errors: Vec<f64>,
}

impl Column {
    /// Whether the error of a run is known.
    pub fn has_errors(&self) -> bool {
        self.errors.iter().any(|error| error.is_finite())
    }
}

impl Table {
    pub(super) fn new(study: &Study, rows: Vec<Row>) -> Table {
        let keys =
            (0..study.plan.vary.len()).map(|n| Key::of(&study.plan.vary[n].key, &study.runs, n)).collect();
        let mut answers: Vec<Column> = vec![];
        for (n, row) in rows.iter().enumerate() {
            let mut last = None;
            for answer in &row.answers {
                let is_this = |column: &Column| column.name == answer.name && column.unit == answer.unit;
                let at = answers.iter().position(is_this).unwrap_or_else(|| {
                    // An answer that not all runs have stands where it stands among the others.
                    let at = last.map_or(0, |last| last + 1);
                    let (name, none) = (answer.name.clone(), vec![f64::NAN; rows.len()]);
                    answers
                        .insert(at, Column { name, unit: answer.unit, values: none.clone(), errors: none });
                    at
                });
                answers[at].values[n] = answer.value;
                let bar = row.bars.iter().find(|bar| bar.name == answer.name);
                answers[at].errors[n] = bar.and_then(|bar| bar.error).unwrap_or(f64::NAN);
                last = Some(at);
            }
        }
        Table { keys, rows, answers }
    }

    /// A value of a key in SI; `None` where the key has values that are no numbers.
    pub fn number(&self, row: usize, key: usize) -> Option<f64> {
        self.keys[key].unit?;
        Some(self.rows[row].run.values[key].number()?.0)
    }

    /// So many runs are in a state of this word.
    pub fn count(&self, word: &str) -> usize {
        self.rows.iter().filter(|row| row.state.word() == word).count()
    }

    /// Whether every run is done or has failed.
    pub fn has_ended(&self) -> bool {
        self.rows.iter().all(|row| matches!(row.state, State::Done | State::Failed(_)))
    }

    /// The codes of findings, with how many runs have each.
    pub fn runs_of_findings(&self) -> BTreeMap<&str, usize> {
        let mut runs_of: BTreeMap<&str, usize> = BTreeMap::new();
        for row in &self.rows {
            let codes: BTreeSet<&str> = row.findings.iter().map(String::as_str).collect();
            codes.into_iter().for_each(|code| *runs_of.entry(code).or_default() += 1);
        }
        runs_of
    }

    /// Which runs have findings, in words: "3 of 50 runs have findings: few-contact-cells (2 runs), large-slope (1 run)"; `None` without.
    pub fn findings(&self) -> Option<String> {
        let runs_of = self.runs_of_findings();
        let with = self.rows.iter().filter(|row| !row.findings.is_empty()).count();
        let words = runs_of.iter().map(|(code, runs)| format!("{code} ({})", counted(*runs, "run")));
        let have = if with == 1 { "has" } else { "have" };
        let of = counted(self.rows.len(), "run");
        (with > 0)
            .then(|| format!("{with} of {of} {have} findings: {}", words.collect::<Vec<_>>().join(", ")))
    }

    /// The table as comma-separated values (RFC 4180): SI, under a line of names with units.
    pub fn csv(&self) -> String {
        let keys = self.keys.iter().map(|key| named(&key.name, key.unit.unwrap_or("")));
        let answers = self.answers.iter().flat_map(|column| {
            let error = column.has_errors().then(|| named(&format!("{}_error", column.name), column.unit));
            [named(&column.name, column.unit)].into_iter().chain(error)
        });
        let ends = ["findings", "finding_codes", "not_valid", "error", "path"].map(str::to_owned);
        let mut text = line(keys.chain(["status".to_owned()]).chain(answers).chain(ends));
        for (n, row) in self.rows.iter().enumerate() {
            let values = (0..self.keys.len()).map(|key| match self.number(n, key) {
                Some(value) => number(value),
                None => row.run.values[key].text(),
            });
            let answers = self.answers.iter().flat_map(|column| {
                let error = column.has_errors().then(|| number(column.errors[n]));
                [number(column.values[n])].into_iter().chain(error)
            });
            let error =
                if let State::Failed(why) = &row.state { why.replace('\n', " ") } else { String::new() };
            let is_done = row.state == State::Done;
            let findings = if is_done { row.findings.len().to_string() } else { String::new() };
            let ends = [findings, row.codes(), row.not_valid(), error, row.run.name.clone()];
            text += &line(values.chain([row.state.word().to_owned()]).chain(answers).chain(ends));
        }
        text
    }
}

impl Key {
    fn of(name: &str, runs: &[Run], n: usize) -> Key {
        let mut units = vec![];
        for run in runs {
            match run.values[n].number() {
                // A number without a unit is in SI.
                Some((_, "")) => {}
                Some((_, unit)) => units.push(unit),
                None => return Key { name: name.to_owned(), unit: None },
            }
        }
        let unit = match units.first() {
            None => Some(""),
            Some(first) => units.iter().all(|unit| unit == first).then_some(*first),
        };
        Key { name: name.to_owned(), unit }
    }
}

/// "contact_area [m2]".
fn named(name: &str, unit: &str) -> String {
    if unit.is_empty() || unit == "1" { name.to_owned() } else { format!("{name} [{unit}]") }
}

/// The shortest text that reads back to the same bits; nothing for NaN.
fn number(x: f64) -> String {
    match x {
        x if x.is_nan() => String::new(),
        x if x == 0.0 || (1e-3..1e7).contains(&x.abs()) => format!("{x}"),
        x => format!("{x:e}"),
    }
}

fn line(cells: impl Iterator<Item = String>) -> String {
    let quoted = |cell: String| match cell.contains([',', '"', '\n', '\r']) {
        true => format!("\"{}\"", cell.replace('"', "\"\"")),
        false => cell,
    };
    cells.map(quoted).collect::<Vec<_>>().join(",") + "\r\n"
}
