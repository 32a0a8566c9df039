//! The command line: a file of arguments for each group of commands.

mod material;
mod result;
mod run;
mod surface;

use asperity_io::choice::{self as choices, Choice};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Parser, Subcommand};
use clap_complete::Shell;

pub use material::{Fit, FitIndentation, Material, Show};
pub use result::{Export, Plot, Report, Reproduce, ShowResult, View};
pub use run::{Check, New, Run, Verify};
pub use surface::{
    Surface, SurfaceConvert, SurfaceFile, SurfaceGenerate, SurfaceInfo, SurfaceOutput, SurfaceProcess,
};

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
    /// Check a case and say what will be solved, the memory and the time that it takes
    Check(Check),
    /// Write a commented starter case
    New(New),
    /// Compare the solver with exact solutions and print the table of errors
    Verify(Verify),
    /// Look at, make, prepare or convert surfaces
    #[command(subcommand)]
    Surface(Surface),
    /// Print a summary of a result with a small map of the contact
    Show(ShowResult),
    /// Write a result as one HTML page: maps, curves, numbers; it needs no network
    Report(Report),
    /// Look at a result in the browser, maps at full resolution; follows a run that goes on
    View(View),
    /// Draw a figure of a result as PNG, SVG or PDF
    Plot(Plot),
    /// Show a material over time and frequency, or fit one to measured curves
    #[command(subcommand)]
    Material(Material),
    /// Find the material of a body from a measured indentation: load and depth over time
    FitIndentation(FitIndentation),
    /// Write a result for other programs: NetCDF, HDF5, npz, VTK, CSV, PNG
    Export(Export),
    /// Compute the figures of Spinu and Cerlinca (2017) again, each with an independent curve and the difference
    Reproduce(Reproduce),
    /// Print the JSON Schema of the case file
    Schema,
    /// Print the completions for a shell
    Completions {
        /// bash, elvish, fish, powershell or zsh
        shell: Shell,
    },
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Args::command().debug_assert();
    }
}
