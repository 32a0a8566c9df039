//! `asperity compare`: what differs between results.

use asperity::Axis;
use asperity_io::answer::{Units, Validity};
use asperity_io::compare::{self, Answers, Comparison, FACTOR, Number, answers, cases, unfinished};
use asperity_io::store::Reader;
use serde_json::json;

use crate::args;
use crate::failure::{Failure, refuse};
use crate::format::{columns, counted, quantity};
use crate::verb::Verb;

impl Verb for args::Compare {
    /// Prints the tables.
    fn run(&self) -> Result<(), Failure> {
        let readers = super::labels::open(&self.results)?;
        if readers.len() < 2 {
            refuse!("two results or more are compared, and only one of these is a result");
        }
        let kind = |reader: &Reader| (reader.header().grid.is_line(), reader.header().axis());
        let first = &readers[0];
        if let Some(other) = readers.iter().find(|reader| kind(reader) != kind(first)) {
            let words = |reader: &Reader| match kind(reader) {
                (_, Axis::Velocity) => "a sweep over velocities",
                (true, _) => "a line contact",
                (false, _) => "a contact over an area",
            };
            refuse!(
                "{} is {}, and {} is {}: their numbers have different units",
                first.path().display(),
                words(first),
                other.path().display(),
                words(other)
            );
        }
        let units = super::answers::units_of(&self.unit, &readers)?;
        let labels = marked(super::labels::of(&self.labels, &readers)?, &readers);
        let answers = answers(&readers, &units)?;
        let others = readers[1..].iter().map(|other| compare::compare(first, other));
        let found = others.collect::<Result<Vec<Comparison>, _>>()?;
        if self.json {
            return crate::print(&format!("{}\n", object(&readers, &labels, &answers, &found)?));
        }
        crate::print(&match &found[..] {
            [found] => case(found) + &side_by_side(&answers, &labels, &units) + &text(found, &readers),
            _ => cases_of(&readers, &labels) + &side_by_side(&answers, &labels, &units),
        })
    }
}

/// The labels, with how far a result is that is not complete.
pub fn marked(labels: Vec<String>, readers: &[Reader]) -> Vec<String> {
    let mark = |(label, reader): (String, &Reader)| match unfinished(reader) {
        Some(how) => format!("{label} ({how})"),
        None => label,
    };
    labels.into_iter().zip(readers).map(mark).collect()
}

/// Of two results the comparison, of more each with the first.
fn object(
    readers: &[Reader],
    labels: &[String],
    answers: &[Answers],
    found: &[Comparison],
) -> Result<serde_json::Value, Failure> {
    let mut object = match found {
        [found] => serde_json::to_value(found)?,
        _ => json!({ "case": cases(&readers.iter().collect::<Vec<_>>()), "comparisons": found }),
    };
    object["results"] = readers.iter().map(|reader| reader.path().to_string_lossy()).collect();
    object["labels"] = json!(labels);
    object["states"] = readers.iter().map(Reader::state).collect();
    object["answers"] = json!(answers);
    Ok(object)
}

fn side_by_side(answers: &[Answers], labels: &[String], units: &Units) -> String {
    format!("\n{}", columns(&rows_of("answers", answers, labels, units), ""))
}

/// The answers in rows, a column for each result, below a head that begins with these words.
pub fn rows_of(first: &str, answers: &[Answers], labels: &[String], units: &Units) -> Vec<Vec<String>> {
    let head = [&[first.to_owned()], labels].concat();
    let row = |answer: &Answers| {
        let values = (0..labels.len()).map(|n| answer.words(n, units));
        [answer.label()].into_iter().chain(values).collect()
    };
    [head].into_iter().chain(answers.iter().map(row)).collect()
}

/// The keys that differ, of several results.
fn cases_of(readers: &[Reader], labels: &[String]) -> String {
    let found = cases(&readers.iter().collect::<Vec<_>>());
    if found.is_empty() {
        return "The cases are the same.\n".to_owned();
    }
    let mut rows = vec![[&["case".to_owned()], labels].concat()];
    for (key, values) in found {
        let words = values.into_iter().map(|value| shortened(&value.unwrap_or("-".into()), 24));
        rows.push([key].into_iter().chain(words).collect());
    }
    columns(&rows, "")
}

/// The keys that differ, of two.
fn case(found: &Comparison) -> String {
    let mut text = String::new();
    if found.case.is_empty() {
        text += "The cases are the same.\n";
    } else {
        let width = found.case.keys().map(|key| key.len()).max().unwrap_or(0) + 2;
        text += &format!("{:<width$}{:<26}second\n", "case", "first");
        for (key, [a, b]) in &found.case {
            let word = |value: &Option<String>| value.clone().unwrap_or_else(|| "-".into());
            text += &format!("{key:<width$}{:<26}{}\n", shortened(&word(a), 24), shortened(&word(b), 40));
        }
    }
    text
}

/// The last rows of two, and what differs at the times that both have.
fn text(found: &Comparison, readers: &[Reader]) -> String {
    let incomplete = readers.iter().any(|reader| unfinished(reader).is_some());
    let head = ["at the end", "first", "second", "change", "largest difference"].map(str::to_owned);
    let axis = readers[0].header().axis();
    let row = |number: &Number| {
        let units = if number.units == "1" { "" } else { number.units.as_str() };
        let [a, b] = number.last;
        let holds = number.validity.iter().all(Validity::is_valid);
        let change = match b / a - 1.0 {
            _ if !holds => "-".to_owned(),
            _ if a == b => "none".to_owned(),
            _ if incomplete => "not complete".to_owned(),
            _ if a == 0.0 => "from 0".to_owned(),
            change if change >= FACTOR => format!("{:.4} times", 1.0 + change),
            change if change.is_finite() => format!("{:+.3} %", 100.0 * change),
            _ => String::new(),
        };
        let word = |value: f64| if units.is_empty() { format!("{value:.6}") } else { quantity(value, units) };
        let largest = match number.largest_difference {
            Some(share) if holds => apart(share),
            Some(_) => "-".to_owned(),
            None => String::new(),
        };
        let name = if number.name == "time" { axis.name() } else { &number.name };
        let [first, second] = [0, 1].map(|n| number.validity[n].cell(word(number.last[n])));
        vec![name.to_owned(), first, second, change, largest]
    };
    let rows: Vec<Vec<String>> = [head.to_vec()].into_iter().chain(found.numbers.iter().map(row)).collect();
    let mut text = format!("\n{}", columns(&rows, ""));
    text += &match found.common_rows {
        0 => "\nThe results have no row at the same time: only their ends are compared.\n".to_owned(),
        rows => format!(
            "\nLargest difference: over {} that both have at the same time, relative to the largest value of the first.\n",
            counted(rows, "row")
        ),
    };
    if let Some(share) = found.pressure {
        text += &match share {
            0.0 => "Pressures stored last: the same in every cell.\n".to_owned(),
            share if share.is_infinite() => "Pressures stored last: the first has none.\n".to_owned(),
            share => format!("Pressures stored last: {} of the largest one apart at most.\n", apart(share)),
        };
    }
    text
}

/// A relative difference.
fn apart(share: f64) -> String {
    match share {
        0.0 => "none".to_owned(),
        share if share.is_infinite() => "the first is 0".to_owned(),
        share if share < 1e-4 => format!("{:.1e}", share),
        share => format!("{:.3} %", 100.0 * share),
    }
}

/// The text, or its beginning and an ellipsis.
fn shortened(text: &str, length: usize) -> String {
    match text.char_indices().nth(length) {
        Some(_) => text.chars().take(length - 1).chain(['…']).collect(),
        None => text.to_owned(),
    }
}
