//! The runs as a table: what varied, how far each run is, its answers.

use super::folder::Study;
use super::plan::Run;
use super::rows::{Row, State};

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
                    let values = vec![f64::NAN; rows.len()];
                    answers.insert(at, Column { name: answer.name.clone(), unit: answer.unit, values });
                    at
                });
                answers[at].values[n] = answer.value;
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

    /// The table as comma-separated values (RFC 4180): SI, under a line of names with units.
    pub fn csv(&self) -> String {
        let keys = self.keys.iter().map(|key| named(&key.name, key.unit.unwrap_or("")));
        let answers = self.answers.iter().map(|column| named(&column.name, column.unit));
        let ends = ["findings", "error", "path"].map(str::to_owned);
        let mut text = line(keys.chain(["status".to_owned()]).chain(answers).chain(ends));
        for (n, row) in self.rows.iter().enumerate() {
            let values = (0..self.keys.len()).map(|key| match self.number(n, key) {
                Some(value) => number(value),
                None => row.run.values[key].text(),
            });
            let answers = self.answers.iter().map(|column| number(column.values[n]));
            let error =
                if let State::Failed(why) = &row.state { why.replace('\n', " ") } else { String::new() };
            let findings = if row.state == State::Done { row.findings.to_string() } else { String::new() };
            let ends = [findings, error, row.run.name.clone()];
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
