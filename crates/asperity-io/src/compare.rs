//! What differs between results: in their cases, in their answers, and, of two, at their ends and at the times that both have.

use std::collections::BTreeMap;

use asperity::quantities::Quantity;
use serde::Serialize;

use crate::answer::{self, Answer, Units, Validity};
use crate::converge::ErrorBar;
use crate::readable::quantity;
use crate::store::{At, FieldKind, Reader, Status, StoreError};

/// The differences of a second result from a first one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Comparison {
    /// Keys of the cases that have different values, with both; `None` where a case lacks the key.
    pub case: BTreeMap<String, [Option<String>; 2]>,
    /// Numbers of the rows, in the order of the results.
    pub numbers: Vec<Number>,
    /// Rows of the first result at whose time the second has a row too.
    pub common_rows: usize,
    /// Largest difference of the last stored pressures, relative to the largest pressure of the first result; `None` where the
    /// grids differ or a result stores no pressure.
    pub pressure: Option<f64>,
}

/// A number of the rows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Number {
    /// Its name in results.
    pub name: String,
    /// Its unit; "1" where it has none.
    pub units: String,
    /// Its last value in both.
    pub last: [f64; 2],
    /// Largest difference at a common time, relative to the largest magnitude of the first result there; `None` without common times.
    pub largest_difference: Option<f64>,
    /// What the findings of both say of its last value.
    pub validity: [Validity; 2],
}

/// An answer of several results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Answers {
    /// Its name.
    pub name: String,
    /// Its SI unit; "1" if it has none.
    pub unit: &'static str,
    /// Its value in each result, SI; NaN (in JSON null) where a result does not have it.
    pub values: Vec<f64>,
    /// Its error in each result, SI; NaN (in JSON null) where that is not known.
    pub errors: Vec<f64>,
    /// Each value over that of the first result, less 1; NaN (in JSON null) where that says nothing, a finding takes one of them back, or a
    /// result is not complete.
    pub changes: Vec<f64>,
    /// What the findings of each result say of it.
    pub validity: Vec<Validity>,
}

impl Answers {
    /// Its name for people.
    pub fn label(&self) -> String {
        self.name.replace('_', " ")
    }

    /// Its value in a result, with a unit that suits it and its error, and, of all but the first, the change and whether that is larger
    /// than the errors: "43 % ± 1 (+2.1 %, within the errors)".
    pub fn words(&self, n: usize, units: &Units) -> String {
        let Answers { values, changes, validity, .. } = self;
        if values[n].is_nan() {
            return "-".to_owned();
        }
        let value = validity[n].cell(self.with_error(n, units));
        let change = match changes[n] {
            change if n == 0 || !change.is_finite() => return value,
            0.0 => "same".to_owned(),
            change if change >= FACTOR => format!("{} times", quantity(1.0 + change, "")),
            change => {
                let sign = if change < 0.0 { "-" } else { "+" };
                format!("{sign}{} %", quantity(100.0 * change.abs(), ""))
            }
        };
        match self.is_larger_than_errors(n) {
            Some(true) => format!("{value} ({change}, more than the errors)"),
            Some(false) if values[n] != values[0] => format!("{value} ({change}, within the errors)"),
            _ => format!("{value} ({change})"),
        }
    }

    fn with_error(&self, n: usize, units: &Units) -> String {
        let answer = Answer::new(self.name.clone(), self.values[n], self.unit);
        match self.errors[n] {
            error if error.is_finite() => units.plus_minus(&ErrorBar::of(&answer, error)),
            _ => answer.words(units),
        }
    }

    /// Whether a value differs from the first one by more than both errors together; `None` where one of them is not known.
    fn is_larger_than_errors(&self, n: usize) -> Option<bool> {
        let error = self.errors[0] + self.errors[n];
        error.is_finite().then(|| (self.values[n] - self.values[0]).abs() > error)
    }
}

/// A change of this much is shown as a factor.
pub const FACTOR: f64 = 9.0;

/// The answers of results side by side, in the order in which the first result that has one lists it.
///
/// # Errors
/// [`StoreError`] where a result is damaged.
pub fn answers(readers: &[Reader], units: &Units) -> Result<Vec<Answers>, StoreError> {
    let mut all: Vec<Answers> = vec![];
    for (n, reader) in readers.iter().enumerate() {
        let bars = reader.error_bars();
        for Answer { name, value, unit, validity, .. } in answer::of(reader, &Units::of(reader, units))? {
            let error = bars.iter().find(|bar| bar.name == name).and_then(|bar| bar.error);
            let place = all.iter().position(|known| known.name == name && known.unit == unit);
            let place = place.unwrap_or_else(|| {
                let none = vec![f64::NAN; readers.len()];
                let validity = vec![Validity::Holds; readers.len()];
                let (values, errors) = (none.clone(), none.clone());
                all.push(Answers { name, unit, values, errors, changes: none, validity });
                all.len() - 1
            });
            all[place].validity[n] = validity;
            all[place].values[n] = value;
            all[place].errors[n] = error.unwrap_or(f64::NAN);
        }
    }
    let complete: Vec<bool> = readers.iter().map(|reader| reader.status() == Status::Complete).collect();
    for Answers { values, changes, validity, .. } in &mut all {
        let first = values[0];
        let holds = |n: usize| complete[n] && validity[n].is_valid();
        let change = |(n, value): (usize, &f64)| {
            let change = match *value == first {
                true => 0.0,
                // Of a change of sign a share says nothing.
                false if value * first < 0.0 => f64::NAN,
                false => value / first - 1.0,
            };
            if change.is_finite() && (n == 0 || holds(0) && holds(n)) { change } else { f64::NAN }
        };
        *changes = values.iter().enumerate().map(change).collect();
    }
    Ok(all)
}

/// How far a result is that is not complete: "interrupted, 12 of 40 rows".
pub fn unfinished(reader: &Reader) -> Option<String> {
    let of = reader.header().rows_expected.map_or(String::new(), |total| format!(" of {total}"));
    let status = reader.status();
    (status != Status::Complete).then(|| format!("{}, {}{of} rows", status.as_str(), reader.len()))
}

/// Keys that say how a case is called and what is kept, not what is computed.
const OF_THE_RESULT: [&str; 3] = ["title", "output.", "study."];
/// More keys than this make no label.
const MOST_KEYS: usize = 4;

/// What tells results from each other, for legends: the keys of their cases that differ, with their values. Where nothing differs, or
/// too much, it is the name of the result, which is also added where two would be called the same.
pub fn labels(readers: &[Reader], names: &[String]) -> Vec<String> {
    let all: Vec<&Reader> = readers.iter().collect();
    let found = cases(&all);
    let differ: Vec<(&String, &Vec<Option<String>>)> =
        found.iter().filter(|(key, _)| !OF_THE_RESULT.iter().any(|other| key.starts_with(other))).collect();
    if differ.is_empty() || differ.len() > MOST_KEYS {
        return names.to_vec();
    }
    let keys: Vec<&str> = differ.iter().map(|(key, _)| key.as_str()).collect();
    let word = |key: &str, value: &Option<String>| match value {
        Some(value) => format!("{} = {}", called(key, &keys), value.trim_matches('"')),
        None => format!("no {}", called(key, &keys)),
    };
    let label =
        |n: usize| differ.iter().map(|(key, values)| word(key, &values[n])).collect::<Vec<_>>().join(", ");
    let labels: Vec<String> = (0..readers.len()).map(label).collect();
    let is_twice = |label: &String| labels.iter().filter(|other| *other == label).count() > 1;
    let named = |(label, name): (&String, &String)| {
        if is_twice(label) { format!("{label} ({name})") } else { label.clone() }
    };
    labels.iter().zip(names).map(named).collect()
}

/// How a key is called in legends and tables: by its shortest end that says what it is and that no other of these keys has, "load" for
/// "load.history.value".
pub fn called(key: &str, all: &[&str]) -> String {
    /// Ends that do not say what they are of.
    const UNSAID: [&str; 2] = [".value", ".history"];
    fn said(key: &str) -> &str {
        UNSAID.iter().find_map(|end| key.strip_suffix(end)).map_or(key, said)
    }
    let others: Vec<&str> = all.iter().filter(|other| **other != key).map(|other| said(other)).collect();
    match others.contains(&said(key)) {
        true => short(key, all).to_owned(),
        false => short(said(key), &others).replace('.', " "),
    }
}

/// The shortest end of a key that no other of these keys has: "value" of "load.history.value".
pub fn short<'k>(key: &'k str, all: &[&str]) -> &'k str {
    let clash = |end: &str| {
        let mut others = all.iter().filter(|other| **other != key);
        others.any(|other| *other == end || other.ends_with(&format!(".{end}")))
    };
    let ends = key.rmatch_indices('.').map(|(n, _)| &key[n + 1..]);
    let named = ends.filter(|end| end.starts_with(|c: char| c.is_alphabetic()));
    named.into_iter().find(|end| !clash(end)).unwrap_or(key)
}

/// The first line in which two texts differ, from 1, and what stands there in each; `None` where only their line ends differ.
pub(crate) fn other_line(old: &str, new: &str) -> Option<(usize, [String; 2])> {
    let (mut old, mut new) = (old.lines(), new.lines());
    let pairs = std::iter::from_fn(|| Some([old.next(), new.next()]).filter(|pair| *pair != [None; 2]));
    let (n, pair) = (1..).zip(pairs).find(|(_, [old, new])| old != new)?;
    Some((n, pair.map(|line| line.map_or("missing".to_owned(), |line| format!("`{}`", line.trim())))))
}

/// Rows are at the same time within this share of it: rounding of times that were computed differently.
const SAME: f64 = 1e-12;
/// Numbers that say how a row was solved, not what it is.
const WORK: [&str; 6] = ["iterations", "convolutions", "residual", "certificate", "time_error", "stage"];

/// Compares two results.
///
/// # Errors
/// [`StoreError`] where one has no row or is damaged.
pub fn compare(first: &Reader, second: &Reader) -> Result<Comparison, StoreError> {
    let readers = [first, second];
    if let Some(empty) = readers.into_iter().find(|reader| reader.is_empty()) {
        return Err(empty.no_rows());
    }
    let times = [first.series("time")?, second.series("time")?];
    let common = common(&times);
    let theirs: Vec<&'static str> = second.scalars().iter().map(|series| series.name).collect();
    let mut numbers = vec![];
    let answers = [of_all(first)?, of_all(second)?];
    for series in first.scalars() {
        let is_of_solver = Quantity::from_name(series.name).is_some_and(Quantity::is_of_solver);
        if is_of_solver || WORK.contains(&series.name) || !theirs.contains(&series.name) {
            continue;
        }
        let [a, b] = [first.series(series.name)?, second.series(series.name)?];
        let largest = common.iter().map(|[n, _]| a[*n].abs()).fold(0.0, f64::max);
        let off = common.iter().map(|[n, m]| (a[*n] - b[*m]).abs()).fold(0.0, f64::max);
        let share = if off == 0.0 { 0.0 } else { off / largest };
        numbers.push(Number {
            name: series.name.to_owned(),
            units: series.units.to_owned(),
            last: [a, b].map(|values| values.last().copied().unwrap_or(f64::NAN)),
            largest_difference: (!common.is_empty()).then_some(share),
            validity: [0, 1].map(|n| of_last(readers[n], &answers[n], series.name)),
        });
    }
    let pair =
        |values: Vec<Option<String>>| [values.first().cloned().flatten(), values.last().cloned().flatten()];
    let case = cases(&readers).into_iter().map(|(key, values)| (key, pair(values))).collect();
    Ok(Comparison { case, numbers, common_rows: common.len(), pressure: pressure(readers)? })
}

/// Names of the answers of a result.
fn of_all(reader: &Reader) -> Result<Vec<String>, StoreError> {
    Ok(answer::of(reader, &Units::default())?.into_iter().map(|answer| answer.name).collect())
}

/// What the findings of a result say of the last value of a number of its rows; nothing of what the case prescribes, which is no answer.
fn of_last(reader: &Reader, answers: &[String], name: &str) -> Validity {
    let prescribed = match name {
        "time" => true,
        "load" | "mean_pressure" => !answers.iter().any(|answer| answer == "load"),
        "approach" => !answers.iter().any(|answer| answer == "approach"),
        _ => false,
    };
    match prescribed {
        true => Validity::Holds,
        false => Validity::at_row(name, reader.len() - 1, reader.findings().iter()),
    }
}

/// Rows of both at the same times; of the two rows of a jump the first ones and the second ones.
fn common(times: &[Vec<f64>; 2]) -> Vec<[usize; 2]> {
    let (mut pairs, mut m) = (vec![], 0);
    for (n, time) in times[0].iter().enumerate() {
        while times[1].get(m).is_some_and(|other| *other < time * (1.0 - SAME)) {
            m += 1;
        }
        if times[1].get(m).is_some_and(|other| (other - time).abs() <= SAME * time.abs()) {
            pairs.push([n, m]);
            m += 1;
        }
    }
    pairs
}

fn pressure(readers: [&Reader; 2]) -> Result<Option<f64>, StoreError> {
    let [a, b] = readers.map(Reader::header);
    let stored = |reader: &Reader| {
        reader.header().fields.contains(&FieldKind::Pressure) && !reader.field_times().is_empty()
    };
    if a.grid != b.grid || !readers.into_iter().all(stored) {
        return Ok(None);
    }
    let [a, b] = readers.map(|reader| reader.field(FieldKind::Pressure, At::Last));
    let (a, b) = (a?, b?);
    let largest = a.iter().copied().fold(0.0, f64::max);
    let off = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    Ok(Some(if off == 0.0 { 0.0 } else { off / largest }))
}

/// Keys with different values, with that of each result: of the case files, or, where a result was not made from one, of what
/// results say of their case.
pub fn cases(readers: &[&Reader]) -> BTreeMap<String, Vec<Option<String>>> {
    let text = |reader: &&Reader| {
        let table =
            reader.header().case_text.parse::<toml::Table>().ok().filter(|table| !table.is_empty())?;
        Some(flat(&serde_json::to_value(table).unwrap_or_default()))
    };
    let texts: Option<Vec<_>> = readers.iter().map(text).collect();
    let setup = |reader: &&Reader| flat(&serde_json::Value::Object(reader.header().setup.clone()));
    let keys = texts.unwrap_or_else(|| readers.iter().map(setup).collect());
    let mut found = BTreeMap::new();
    for key in keys.iter().flat_map(BTreeMap::keys) {
        let values: Vec<Option<String>> = keys.iter().map(|own| own.get(key).cloned()).collect();
        if values.iter().any(|value| *value != values[0]) {
            found.insert(key.clone(), values);
        }
    }
    found
}

/// Every number and text of a table by its dotted key.
fn flat(value: &serde_json::Value) -> BTreeMap<String, String> {
    fn walk(value: &serde_json::Value, path: &str, into: &mut BTreeMap<String, String>) {
        match value {
            serde_json::Value::Object(table) => {
                for (key, value) in table {
                    let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                    walk(value, &path, into);
                }
            }
            serde_json::Value::Array(list) if list.iter().any(serde_json::Value::is_object) => {
                list.iter().enumerate().for_each(|(n, value)| walk(value, &format!("{path}[{n}]"), into));
            }
            value => {
                into.insert(path.to_owned(), value.to_string());
            }
        }
    }
    let mut into = BTreeMap::new();
    walk(value, "", &mut into);
    into
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_at_the_same_times_are_paired_and_those_of_a_jump_in_order() {
        let times = [vec![0.0, 1.0, 2.0, 2.0, 3.0], vec![0.0, 0.5, 1.0 + 1e-14, 2.0, 2.0, 2.5]];
        assert_eq!(common(&times), [[0, 0], [1, 2], [2, 3], [3, 4]]);
    }

    #[test]
    fn changes_have_four_digits() {
        let (values, changes) = (vec![1.0; 5], vec![0.0, 0.0, 0.12345678, -0.5, 66.54321]);
        let errors = vec![f64::NAN; 5];
        let validity = vec![Validity::Holds; 5];
        let answers = Answers { name: "max_pressure".into(), unit: "Pa", values, errors, changes, validity };
        let words: Vec<String> = (0..5).map(|n| answers.words(n, &Units::default())).collect();
        assert_eq!(words, ["1 Pa", "1 Pa (same)", "1 Pa (+12.35 %)", "1 Pa (-50 %)", "1 Pa (67.54 times)"]);
    }

    #[test]
    fn a_difference_is_compared_with_the_errors() {
        let (values, changes) = (vec![1.0, 1.3, 1.4, 1.0], vec![0.0, 0.3, 0.4, 0.0]);
        // Both errors together are 0.35 Pa.
        let errors = vec![0.2, 0.15, 0.15, f64::NAN];
        let validity = vec![Validity::Holds; 4];
        let answers = Answers { name: "max_pressure".into(), unit: "Pa", values, errors, changes, validity };
        let words: Vec<String> = (0..4).map(|n| answers.words(n, &Units::default())).collect();
        let expected = [
            "1.00 Pa ± 0.20",
            "1.30 Pa ± 0.15 (+30 %, within the errors)",
            "1.40 Pa ± 0.15 (+40 %, more than the errors)",
            "1 Pa (same)",
        ];
        assert_eq!(words, expected);
    }

    #[test]
    fn a_key_is_shortened_as_far_as_it_stays_its_own() {
        let all = [
            "load.history.value",
            "temperature.history.value",
            "surface[0].seed",
            "surface[1].seed",
            "time.end",
        ];
        let shorts = all.map(|key| short(key, &all));
        assert_eq!(
            shorts,
            ["load.history.value", "temperature.history.value", "surface[0].seed", "surface[1].seed", "end"]
        );
        assert_eq!(short("surface.0.seed", &["surface.0.seed", "load.value"]), "seed");
        let names = all.map(|key| called(key, &all));
        assert_eq!(names, ["load", "temperature", "surface[0] seed", "surface[1] seed", "end"]);
        let stages = ["load.stages.0.history.value", "load.stages.1.history.value"];
        assert_eq!(called(stages[1], &stages), "stages 1");
        let both = ["load.value", "load.history.value"];
        assert_eq!(called(both[0], &both), "load.value");
    }

    #[test]
    fn tables_become_dotted_keys() {
        let table: toml::Table = "[a]\nb = 1\n[[c]]\nd = \"x\"\n[[c]]\nd = [1, 2]".parse().unwrap();
        let keys = flat(&serde_json::to_value(table).unwrap());
        let expected = [("a.b", "1"), ("c[0].d", "\"x\""), ("c[1].d", "[1,2]")];
        assert_eq!(keys, expected.map(|(key, value)| (key.to_owned(), value.to_owned())).into());
    }
}
