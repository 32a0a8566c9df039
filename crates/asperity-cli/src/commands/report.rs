//! `asperity report`: a result as one page.

use asperity_io::store::Reader;
use asperity_report::page::{Options, write};

use crate::args::Report;
use crate::failure::Failure;

/// Writes the page and prints where it is.
pub fn run(args: &Report) -> Result<(), Failure> {
    let output = args.output.clone().unwrap_or_else(|| args.result.with_extension("html"));
    let options = Options {
        bytes: args.megabytes as usize * 1_000_000,
        instants: args.instants as usize,
        force: args.force,
    };
    let reader = Reader::open(&args.result).map_err(|error| Failure::input(error.to_string()))?;
    write(&reader, &output, &options).map_err(Failure::of)?;
    crate::print(&format!("{}\n", output.display()))
}
