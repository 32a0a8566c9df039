//! The arguments of runs and their checks.

use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Run {
    /// The case file (TOML)
    pub case: PathBuf,
    /// Path of the result [default: output.path of the case, or the case's name with .zarr]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Continue the run of this case that was interrupted or killed
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Replace an existing result
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub common: Common,
    /// Unit for leaks or times in what is printed and drawn, e.g. --unit leak=ml/year --unit time=h
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Print one JSON object at the end
    #[arg(long)]
    pub json: bool,
    /// Solve the case with fewer cells, longer steps and a looser tolerance as well, and store and print the errors of the answers
    #[arg(long)]
    pub error_bars: bool,
    /// Treat warnings as errors: exit code 1; the result is kept
    #[arg(long)]
    pub strict: bool,
    /// Print only errors and the result
    #[arg(short, long)]
    pub quiet: bool,
    /// Print every row; given twice (-vv), print every iteration of the solver: residual, working cells, step
    #[arg(short, long, action = clap::ArgAction::Count, conflicts_with = "quiet")]
    pub verbose: u8,
}

#[derive(Debug, clap::Args)]
pub struct Check {
    /// The case file (TOML)
    pub case: PathBuf,
    #[command(flatten)]
    pub common: Common,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Warnings are errors: exit code 1
    #[arg(long)]
    pub strict: bool,
}

#[derive(Debug, clap::Args)]
pub struct Converge {
    /// The case file (TOML)
    pub case: PathBuf,
    /// Solve the case with twice the cells along each side as well, and extrapolate the answers to vanishing cells
    #[arg(long)]
    pub refine: bool,
    #[command(flatten)]
    pub common: Common,
    /// Unit for leaks or times, e.g. --unit leak=ml/year --unit time=h
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Print one JSON object: {answers: [{name, value, unit, error, grid, time, solver}], cost, notes}
    #[arg(long)]
    pub json: bool,
    /// Print only errors and the answers
    #[arg(short, long)]
    pub quiet: bool,
}

#[derive(Debug, clap::Args)]
pub struct Common {
    /// Threads to use [default: one per core that the process may use]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Set a key of the case, e.g. --set domain.cells='[256, 256]' --set body.0.hardness='200 MPa'
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// What a case with own files is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Purpose {
    /// How much leaks through the gap.
    Seal,
    /// Friction over the velocity.
    Friction,
    /// Area and pressure of a contact.
    Contact,
    /// A ball pressed in.
    Indentation,
    /// A contact that sticks.
    Adhesion,
}

#[derive(Debug, clap::Args)]
pub struct New {
    /// Name of the starter case; without it all are listed. With --for: the file to write [default: PURPOSE.toml]
    pub template: Option<String>,
    /// The file to write [default: TEMPLATE.toml]
    pub path: Option<PathBuf>,
    /// What the case is for: a case with your own files in place of a starter case
    #[arg(long = "for", value_name = "PURPOSE", value_enum, requires = "from", requires = "material")]
    pub purpose: Option<Purpose>,
    /// The measured surface; for an indentation and adhesion also a record of time, load and depth
    #[arg(long, value_name = "FILE", requires = "purpose")]
    pub from: Option<PathBuf>,
    /// The measured material: a table of a DMA, relaxation or creep test, or what `material fit -o` or `fit-indentation -o` wrote
    #[arg(long, value_name = "FILE", requires = "purpose")]
    pub material: Option<PathBuf>,
    /// Size of the surface along x and y, if the file does not state it; one length for a square
    #[arg(long, value_name = "A,B", requires = "purpose")]
    pub size: Option<String>,
    /// Unit of the heights, if the file does not state it
    #[arg(long, value_name = "U", requires = "purpose")]
    pub height_unit: Option<String>,
    /// Replace an existing file
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct Verify {
    /// Run only these cases
    pub cases: Vec<String>,
    /// Print a JSON list of {case, quantity, error, tolerance, ok}
    #[arg(long, conflicts_with = "markdown")]
    pub json: bool,
    /// Print the table as Markdown
    #[arg(long)]
    pub markdown: bool,
    /// Threads to use [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}
