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
        crate::launcher::refuse_several("converge")?;
        let given = answers::units(&self.unit)?;
        let set = [&self.common.set[..], &answers::keys(&given)].concat();
        let case = Case::read(&self.case, &set)?;
        let units = &case.output.units;
        let found = of_case(&self.case, &self.common.set, None, self.refine, self.quiet)?;
        answers::note_unused(&given, &found.answers);
        if !self.quiet {
            super::findings::print(&found.findings);
        }
        if self.json {
            return crate::print(&format!("{}\n", object(&found)));
        }
        let grid = &case.conditions.grid;
        let row = answers::row(&found.answers, units, grid, found.last.as_ref(), found.rows);
        let row = row.map_or(String::new(), |row| answers::line("of the row at", row));
        crate::print(&(text(&found, units) + &row))
    }
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
    json!({ "answers": answers::bars(&found.answers, &found.bars), "cost": found.cost, "notes": found.notes, "findings": asperity_io::finding::list(&found.findings) })
}

/// A line for each answer, and how their errors were found.
pub fn text(found: &Convergence, units: &Units) -> String {
    let answers = answers::lines(&found.answers, &found.bars, units);
    let notes = found.notes.iter().map(|note| ["note".to_owned(), note.clone()]);
    let cost = format!("{:.2} times the convolutions of the case", found.cost);
    let lines = answers.into_iter().chain(notes).chain([["cost of the errors".into(), cost]]);
    lines.map(|[name, words]| answers::line(&name, words)).collect()
}
