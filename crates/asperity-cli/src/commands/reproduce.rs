//! `asperity reproduce`: the figures of the paper.

use asperity_report::paper::{FIGURES, Options, PaperError, reproduce};
use serde_json::json;

use crate::args::Reproduce;
use crate::failure::{Failure, refuse};
use crate::verb::{Threads, Verb};

impl Verb for Reproduce {
    fn threads(&self) -> Threads {
        Threads::of(self.threads)
    }

    /// Computes the figures one after another, writes each, and prints how far they are from what is independent.
    fn run(&self) -> Result<(), Failure> {
        let mut numbers = if self.figures.is_empty() { FIGURES.to_vec() } else { self.figures.clone() };
        numbers.sort_unstable();
        numbers.dedup();
        let files: Vec<_> =
            numbers.iter().map(|n| self.output.join(format!("figure-{n}.{}", self.form))).collect();
        if let Some(taken) = files.iter().find(|file| !self.force && file.exists()) {
            refuse!("{} already exists; choose another directory or use --force", taken.display());
        }
        let results = self.output.join("results");
        std::fs::create_dir_all(&results)
            .map_err(Failure::about(format!("cannot make {}", results.display())))?;
        let options = Options { results, cells: self.cells.map(|n| n as usize) };
        let (mut list, mut table) = (Vec::new(), String::new());
        // The figures of the rough sphere come from the same runs.
        let (smooth, rough): (Vec<u8>, Vec<u8>) = numbers.iter().partition(|n| **n < 5);
        let groups = smooth.into_iter().map(|n| vec![n]).chain((!rough.is_empty()).then_some(rough));
        for group in groups {
            let names: Vec<_> = group.iter().map(u8::to_string).collect();
            crate::messages::message!("figure {} ...", names.join(", "));
            for one in reproduce(&group, &options).map_err(|error| match error {
                PaperError::Run(error) => Failure::Solve(error.to_string()),
                error => error.into(),
            })? {
                let file = self.output.join(format!("figure-{}.{}", one.number, self.form));
                one.figure.write(&file, self.force)?;
                table += &format!("Figure {}: {}\n  {}\n", one.number, one.title, file.display());
                for difference in &one.differences {
                    table += &format!("  {}\n", difference.words());
                    list.push(json!({
                        "figure": one.number,
                        "quantity": difference.quantity,
                        "difference": difference.value,
                        "of": difference.of,
                    }));
                }
            }
        }
        crate::print(&if self.json { format!("{}\n", json!(list)) } else { table })
    }
}
