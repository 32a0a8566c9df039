//! The command line: a file of arguments for each group of commands.

mod app;
mod leak;
mod material;
mod result;
mod run;
mod seal;
mod stress;
mod study;
mod surface;

use asperity_io::choice::{self as choices, Choice};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand};
use clap_complete::Shell;

pub use app::App;
pub use leak::{FluidOptions, Leak};
pub use material::{Data, Fit, FitIndentation, FitOutput, Material, MaterialExport, Model as FitModel, Show};
pub use result::{Compare, Export, Labels, Plot, Report, Reproduce, ShowResult, VerifyResult, View};
pub use run::{Check, Converge, New, Purpose, Run, Verify};
pub use seal::Seal;
pub use stress::Stress;
pub use study::{Study, StudyAction, StudyFolder};
pub use surface::{
    Surface, SurfaceConvert, SurfaceFile, SurfaceFromProfile, SurfaceGenerate, SurfaceInfo, SurfaceOutput,
    SurfaceProcess,
};

use crate::verb::Verb;

/// A parser of the words of a choice; help and completions list them.
fn choice<T: Choice + Clone + Send + Sync + 'static>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(choices::words::<T>().iter().copied())
        .try_map(|word| choices::parse::<T>(&word).ok_or("no such choice"))
}

/// Contact of rough, linear viscoelastic bodies: pressure, gap, contact area and approach over time,
/// from a case file.
#[derive(Debug, Parser)]
#[command(name = "asperity", version, propagate_version = true, arg_required_else_help = true)]
pub struct Args {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Run a case; the result is a Zarr directory
    Run(Run),
    /// Run a case for several values of some of its keys: all results in one folder, with one table and one figure
    Study(Study),
    /// Check a case and report what will be solved and how much memory and time it needs
    Check(Check),
    /// Solve a case with other cells, steps and tolerances too, and print its answers with their errors
    Converge(Converge),
    /// Write a commented starter case
    New(New),
    /// Compare the solver with exact solutions and print the table of errors
    Verify(Verify),
    /// Inspect, generate, process or convert surfaces
    #[command(subcommand)]
    Surface(Surface),
    /// Print a summary of a result with a small map of the contact
    Show(ShowResult),
    /// Compare every number of a result with its checksum and list what is damaged; exit code 1 where anything is
    VerifyResult(VerifyResult),
    /// Write a result, or several side by side, as one HTML page with curves and numbers, of one with maps; it needs no network
    Report(Report),
    /// View a result in the browser with maps at full resolution, also while it is being written
    View(View),
    /// Open a page in the browser on a folder of cases, data and results: from files to the decision without a terminal
    App(App),
    /// Draw a figure of a result, or of several results together, as PNG, SVG or PDF, or an animation
    Plot(Plot),
    /// List what differs between results: in their cases and answers, and of two at their ends and at the times that both have
    Compare(Compare),
    /// Compute the stress below the surface of a result: largest values with places, profile over depth, first yield
    Stress(Stress),
    /// Compute how much a fluid leaks through the gap of a result over time, or of a map of the gap
    Leak(Leak),
    /// Compute a whole seal of which the case is a patch: how much it leaks and at which pressure it opens
    Seal(Seal),
    /// Show a material over time and frequency, or fit one to measured curves
    #[command(subcommand)]
    Material(Material),
    /// Fit a material to a measured indentation: load and depth over time
    FitIndentation(FitIndentation),
    /// Write a result for other programs: NetCDF, HDF5, npz, VTK, CSV, PNG
    Export(Export),
    /// Compute the figures of Spinu and Cerlinca (2017), each with an independent curve and the difference
    Reproduce(Reproduce),
    /// Print the JSON Schema of the case file
    Schema(Schema),
    /// Print the completion script for a shell
    Completions(Completions),
}

#[derive(Debug, clap::Args)]
pub struct Schema {}

#[derive(Debug, clap::Args)]
pub struct Completions {
    /// bash, elvish, fish, powershell or zsh
    pub shell: Shell,
}

impl Command {
    /// What is to be done.
    pub fn verb(&self) -> &dyn Verb {
        match self {
            Command::Run(verb) => verb,
            Command::Study(verb) => verb,
            Command::Check(verb) => verb,
            Command::Converge(verb) => verb,
            Command::New(verb) => verb,
            Command::Verify(verb) => verb,
            Command::Surface(Surface::Info(verb)) => verb,
            Command::Surface(Surface::Generate(verb)) => &**verb,
            Command::Surface(Surface::FromProfile(verb)) => &**verb,
            Command::Surface(Surface::Process(verb)) => &**verb,
            Command::Surface(Surface::Convert(verb)) => verb,
            Command::Show(verb) => verb,
            Command::VerifyResult(verb) => verb,
            Command::Report(verb) => verb,
            Command::View(verb) => verb,
            Command::App(verb) => verb,
            Command::Plot(verb) => verb,
            Command::Compare(verb) => verb,
            Command::Stress(verb) => verb,
            Command::Leak(verb) => verb,
            Command::Seal(verb) => verb,
            Command::Material(Material::Show(verb)) => verb,
            Command::Material(Material::Fit(verb)) => &**verb,
            Command::Material(Material::Export(verb)) => verb,
            Command::FitIndentation(verb) => verb,
            Command::Export(verb) => verb,
            Command::Reproduce(verb) => verb,
            Command::Schema(verb) => verb,
            Command::Completions(verb) => verb,
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory, Parser};

    #[test]
    fn the_command_line_is_consistent() {
        super::Args::command().debug_assert();
    }

    /// Commands, options and values of the documents are those of the command.
    #[test]
    fn every_command_line_of_the_documents_is_understood() {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        let folders = ["docs", "docs/howto"].map(|folder| std::fs::read_dir(format!("{root}/{folder}")));
        let documents = folders.into_iter().flat_map(|folder| folder.expect("the documents").flatten());
        let documents =
            documents.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "md"));
        let readme = [format!("{root}/README.md").into(), format!("{root}/examples/data/README.md").into()];
        let mut lines = 0;
        for path in documents.chain(readme) {
            // A line that ends with a backslash goes on.
            let text = std::fs::read_to_string(&path).expect("a document").replace("\\\n", " ");
            let blocks = text.split("```sh").skip(1).filter_map(|block| block.split("```").next());
            for line in blocks.flat_map(str::lines).filter(|line| line.starts_with("asperity ")) {
                if let Err(error) = super::Args::try_parse_from(words(line)) {
                    panic!("{}: {line}\n{error}", path.display());
                }
                lines += 1;
            }
        }
        assert!(lines > 30, "the documents have more than {lines} command lines");
    }

    #[test]
    fn values_may_begin_with_a_minus() {
        for words in [
            &["leak", "r.zarr", "--temperature", "-40 degC"][..],
            &["plot", "r.zarr", "profile", "--at", "-20 um", "--time", "-1 s"],
            &["plot", "r.zarr", "gap", "--limits", "-1,3 um"],
        ] {
            let parsed = super::Args::try_parse_from([&["asperity"][..], words].concat());
            assert!(parsed.is_ok(), "{words:?}: {}", parsed.unwrap_err());
        }
    }

    /// The words of a line as a shell splits them: single and double quotes, up to a comment or redirection.
    fn words(line: &str) -> Vec<String> {
        let (mut words, mut word, mut quote) = (Vec::new(), String::new(), None);
        for c in line.chars().chain([' ']) {
            match (quote, c) {
                (Some(open), _) if c == open => quote = None,
                (None, '"' | '\'') => quote = Some(c),
                (None, ' ') if word.is_empty() => {}
                (None, ' ') => words.push(std::mem::take(&mut word)),
                (None, '#' | '>') if word.is_empty() => break,
                _ => word.push(c),
            }
        }
        words
    }
}
