//! `asperity compare`: what differs between two results.

use asperity::Axis;
use asperity_io::compare::{Comparison, compare};
use asperity_io::store::Reader;

use crate::args;
use crate::failure::Failure;
use crate::format::{counted, quantity};
use crate::verb::Verb;

impl Verb for args::Compare {
    /// Prints the table.
    fn run(&self) -> Result<(), Failure> {
        let [first, second] = [Reader::open(&self.first)?, Reader::open(&self.second)?];
        let kind = |reader: &Reader| (reader.header().grid.is_line(), reader.header().axis());
        if kind(&first) != kind(&second) {
            let words = |reader: &Reader| match kind(reader) {
                (_, Axis::Velocity) => "a sweep over velocities",
                (true, _) => "a line contact",
                (false, _) => "a contact over an area",
            };
            return Err(Failure::input(format!(
                "{} is {}, and {} is {}: their numbers have different units",
                self.first.display(),
                words(&first),
                self.second.display(),
                words(&second)
            )));
        }
        let found = compare(&first, &second)?;
        if self.json {
            return crate::print(&format!("{}\n", serde_json::to_string(&found)?));
        }
        crate::print(&text(&found, &first))
    }
}

fn text(found: &Comparison, first: &Reader) -> String {
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
    text +=
        &format!("\n{:<28}{:<16}{:<16}{:<14}largest difference\n", "at the end", "first", "second", "change");
    let axis = first.header().axis();
    for number in &found.numbers {
        let units = if number.units == "1" { "" } else { number.units.as_str() };
        let [a, b] = number.last;
        let change = match b / a - 1.0 {
            _ if a == b => "none".to_owned(),
            _ if a == 0.0 => "from 0".to_owned(),
            change if change >= FACTOR => format!("{:.4} times ", 1.0 + change),
            change if change.is_finite() => format!("{:+.3} %", 100.0 * change),
            _ => String::new(),
        };
        let word = |value: f64| if units.is_empty() { format!("{value:.6}") } else { quantity(value, units) };
        let largest = number.largest_difference.map_or(String::new(), apart);
        let name = if number.name == "time" { axis.name() } else { &number.name };
        text += &format!("{name:<28}{:<16}{:<16}{change:<14}{largest}\n", word(a), word(b));
    }
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

/// A change of this much is shown as a factor.
const FACTOR: f64 = 9.0;

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
