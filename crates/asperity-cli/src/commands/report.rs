//! `asperity report`: a result, or several side by side, as one page.

use std::path::PathBuf;

use asperity::Axis;
use asperity_io::answer::Units;
use asperity_io::compare::{answers, cases};
use asperity_io::store::{At, Reader};
use asperity_report::page::{Options, write};
use asperity_report::result::{self, Plot, together};
use asperity_report::sheet::Sheet;

use super::compare::{marked, rows_of};
use crate::args::Report;
use crate::failure::Failure;
use crate::files::Files;
use crate::format::counted;
use crate::verb::Verb;

impl Verb for Report {
    fn files(&self) -> Files {
        Files::default().reads(&self.results).writes(&self.output).force(self.force)
    }

    /// Writes the page and prints where it is.
    fn run(&self) -> Result<(), Failure> {
        let output = match &self.results[..] {
            [result] => self.output.clone().unwrap_or_else(|| result.with_extension("html")),
            _ => self.output.clone().unwrap_or_else(|| PathBuf::from("report.html")),
        };
        let readers = super::labels::open(&self.results)?;
        let labels = super::labels::of(&self.labels, &readers)?;
        match &readers[..] {
            [reader] => {
                let options = Options {
                    bytes: self.megabytes as usize * 1_000_000,
                    instants: self.instants as usize,
                    force: self.force,
                };
                write(reader, &output, &options)?;
            }
            _ => sheet(readers, &labels)?.write(&output, self.force)?,
        }
        crate::print(&format!("{}\n", output.display()))
    }
}

/// Several results: what differs, their answers, their curves.
fn sheet(readers: Vec<Reader>, labels: &[String]) -> Result<Sheet, Failure> {
    let mut sheet = Sheet::new(counted(readers.len(), "result"));
    let units = Units::of(&readers[0], &Units::default());
    let rows = rows_of("", &answers(&readers, &units)?, &marked(labels.to_vec(), &readers), &units);
    sheet = sheet.table("Answers", &rows).note("In brackets: the change against the first result.");
    let mut rows = vec![[&["key".to_owned()], labels].concat()];
    for (key, values) in cases(&readers.iter().collect::<Vec<_>>()) {
        let words = values.into_iter().map(|value| value.unwrap_or("-".into()).trim_matches('"').to_owned());
        rows.push([key].into_iter().chain(words).collect());
    }
    sheet = match rows.len() {
        1 => sheet.note("The cases are the same."),
        _ => sheet.table("What differs in the cases", &rows),
    };
    let plot = match readers[0].header().axis() {
        Axis::Velocity => Plot::Friction,
        _ => Plot::Evolution,
    };
    let all: Vec<(String, Reader, At)> =
        labels.iter().cloned().zip(readers).map(|(label, reader)| (label, reader, At::Last)).collect();
    // A page without the curves is still a page.
    Ok(match together(&all, plot, &result::Options::default()) {
        Ok(figure) => sheet.figure("Curves", &figure),
        Err(error) => sheet.note(&error.to_string()),
    })
}
