//! `asperity report`: a result as one page.

use asperity_io::store::Reader;
use asperity_report::page::{Options, write};

use crate::args::Report;
use crate::failure::Failure;
use crate::files::Files;
use crate::verb::Verb;

impl Verb for Report {
    fn files(&self) -> Files {
        Files::default().reads([&self.result]).writes(&self.output).force(self.force)
    }

    /// Writes the page and prints where it is.
    fn run(&self) -> Result<(), Failure> {
        let output = self.output.clone().unwrap_or_else(|| self.result.with_extension("html"));
        let options = Options {
            bytes: self.megabytes as usize * 1_000_000,
            instants: self.instants as usize,
            force: self.force,
        };
        let reader = Reader::open(&self.result)?;
        write(&reader, &output, &options)?;
        crate::print(&format!("{}\n", output.display()))
    }
}
