//! `asperity converge`: the answers of a case with their errors.

use std::path::Path;

use asperity_io::answer::Units;
use asperity_io::case::Case;
use asperity_io::converge::{ConvergeError, ConvergeOptions, Convergence, converge};
use serde_json::{Value, json};

use super::answers;
use crate::args::Converge;
use crate::failure::Failure;
use crate::messages::message;
use crate::verb::{Threads, Verb};

impl Verb for Converge {
    fn threads(&self) -> Threads {
        Threads::of(self.common.threads)
    }

    /// Solves the case and its variations, and prints the answers.
    fn run(&self) -> Result<(), Failure> {
        let units = units(&self.case, &self.common.set, &self.unit)?;
        let found = of_case(&self.case, &self.common.set, None, self.refine, self.quiet)?;
        if !self.quiet {
            super::findings::print(&found.findings);
        }
        crate::print(&match self.json {
            true => format!("{}\n", object(&found)),
            false => text(&found, &units),
        })
    }
}

/// The units that a case and the options choose.
fn units(case: &Path, set: &[String], options: &[String]) -> Result<Units, Failure> {
    let set = [set, &answers::keys(options)?].concat();
    Ok(Case::read(case, &set)?.output.units)
}

/// The errors of the answers of a case, whose complete result may be there.
pub fn of_case(
    case: &Path,
    set: &[String],
    result: Option<&Path>,
    refine: bool,
    quiet: bool,
) -> Result<Convergence, Failure> {
    let options = ConvergeOptions { refine, interrupt: crate::interrupt::flag() };
    let mut observe = |what: &str| {
        if !quiet {
            message!("solves {what}");
        }
    };
    let read = |more: &[String]| Case::read(case, &[set, more].concat());
    converge(&read, result, &options, &mut observe).map_err(|error| match error {
        ConvergeError::Case(errors) => Failure::Case(errors),
        ConvergeError::Interrupted => Failure::Interrupted("the error bars are not complete".into()),
        ConvergeError::Store(error) => error.into(),
        error => Failure::Solve(error.to_string()),
    })
}

fn object(found: &Convergence) -> Value {
    json!({ "answers": found.bars, "cost": found.cost, "notes": found.notes, "findings": asperity_io::finding::list(&found.findings) })
}

/// A line for each answer, and what could not be varied.
pub fn text(found: &Convergence, units: &Units) -> String {
    let mut text = String::new();
    for answer in units.without_second_rate(&found.answers) {
        let Some(bar) = found.bars.iter().find(|bar| bar.name == answer.name) else { continue };
        let order = bar.order.map_or(String::new(), |order| format!(", order {order:.1}"));
        let note = if bar.note.is_empty() { String::new() } else { format!(", {}", bar.note) };
        text += &answers::line(&answer.label(), units.with_error(bar) + &order + &note);
    }
    for note in &found.notes {
        text += &answers::line("not varied", note);
    }
    text += &answers::line("cost", format!("{:.2} times the convolutions of the case", found.cost));
    text
}
