//! The arguments of whole seals.

use std::path::PathBuf;

use super::run::Common;

#[derive(Debug, clap::Args)]
pub struct Seal {
    /// The case file (TOML) of a patch, with [seal] and [leakage]
    pub case: PathBuf,
    /// The folder of the sweep and the answers [default: the case's name with -seal]. A folder that holds the same sweep goes on with it
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Runs side by side at most [default: one per thread, as many as memory allows]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    #[command(flatten)]
    pub common: Common,
    /// Unit for leaks or times in what is printed and drawn, e.g. --unit leak=ml/year --unit time=h
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Print one JSON object, in SI units
    #[arg(long)]
    pub json: bool,
    /// Treat warnings as errors: exit code 1; the answers are kept
    #[arg(long)]
    pub strict: bool,
    /// Print only errors and the answers
    #[arg(short, long)]
    pub quiet: bool,
}
