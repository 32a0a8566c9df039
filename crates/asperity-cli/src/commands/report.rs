//! `asperity report`: a result as one page.

use asperity_io::store::Reader;
use asperity_report::page::{Options, write};

use crate::args::Report;
use crate::failure::Failure;
use crate::verb::{Paths, Verb};

impl Verb for Report {
    fn reads(&self) -> Paths<'_> {
        vec![Some(&self.result)]
    }

    fn writes(&self) -> Paths<'_> {
        vec![self.output.as_ref()]
    }

    /// Writes the page and prints where it is.
    fn run(&self) -> Result<(), Failure> {
        let output = self.output.clone().unwrap_or_else(|| self.result.with_extension("html"));
        let options = Options {
            bytes: self.megabytes as usize * 1_000_000,
            instants: self.instants as usize,
            force: self.force,
        };
        let reader = Reader::open(&self.result).map_err(|error| Failure::input(error.to_string()))?;
        write(&reader, &output, &options).map_err(Failure::of)?;
        crate::print(&format!("{}\n", output.display()))
    }
}
