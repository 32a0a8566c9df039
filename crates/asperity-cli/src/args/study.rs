//! The arguments of studies.

use std::path::PathBuf;

use clap::Subcommand;

use super::run::Common;

#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Study {
    #[command(subcommand)]
    pub action: Option<StudyAction>,
    /// The case file (TOML)
    #[arg(required = true)]
    pub case: Option<PathBuf>,
    /// A key and its values: KEY=A,B,C, KEY=FROM:TO:COUNT[:log] with units at both ends, or KEY=1..10 for whole numbers; a value
    /// that has a comma itself is written in quotes or brackets. Replaces what [study] of the case says of the key
    #[arg(long, value_name = "KEY=VALUES")]
    pub vary: Vec<String>,
    /// Run every combination of the values [default, unless the case says zip = true]
    #[arg(long)]
    pub product: bool,
    /// Run the first values of all keys together, then the second ones, and so on
    #[arg(long, conflicts_with = "product")]
    pub zip: bool,
    /// The folder of the study [default: the case's name with -study]. A folder that holds the same study goes on with it
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// Runs side by side at most [default: one per thread, as many as memory allows]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Only the K-th of every N runs, e.g. 3/16: one of N processes that share the folder [default: as srun, mpirun or an array of jobs says]
    #[arg(long, value_name = "K/N", value_parser = shard)]
    pub shard: Option<[usize; 2]>,
    /// Compute the errors of the answers of every run too; takes about as long again
    #[arg(long)]
    pub error_bars: bool,
    #[command(flatten)]
    pub common: Common,
    /// Unit for leaks or times in what is printed, e.g. --unit leak=ml/year --unit time=h
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Print one JSON object at the end, in SI units
    #[arg(long)]
    pub json: bool,
    /// Print only errors and the table
    #[arg(short, long)]
    pub quiet: bool,
}

#[derive(Debug, Subcommand)]
pub enum StudyAction {
    /// Print which runs are done, running, unfinished, failed or missing, and their answers
    Status(StudyFolder),
    /// Write the table, the dataset and the figure of what is done so far
    Collect(StudyFolder),
}

#[derive(Debug, clap::Args)]
pub struct StudyFolder {
    /// The folder of the study
    pub folder: PathBuf,
    /// Unit for leaks or times in what is printed, e.g. --unit leak=ml/year --unit time=h
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Print one JSON object, in SI units
    #[arg(long)]
    pub json: bool,
}

/// "3/16".
fn shard(text: &str) -> Result<[usize; 2], String> {
    let numbers =
        text.split_once('/').and_then(|(k, n)| Some([k.trim().parse().ok()?, n.trim().parse().ok()?]));
    let valid = |[k, n]: &[usize; 2]| *k >= 1 && k <= n;
    numbers.filter(valid).ok_or_else(|| "write K/N with K from 1 to N, e.g. 3/16".to_owned())
}
