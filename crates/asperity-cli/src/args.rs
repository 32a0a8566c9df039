//! The command line.

use std::path::PathBuf;

use clap::{Parser, Subcommand};
use clap_complete::Shell;

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

#[derive(Debug, clap::Args)]
pub struct Run {
    /// The case file (TOML)
    pub case: PathBuf,
    /// Where the result goes [default: output.path of the case, or the case's name with .zarr]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Go on with the run of this case that was interrupted or killed
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Replace a result that is there already
    #[arg(long)]
    pub force: bool,
    #[command(flatten)]
    pub common: Common,
    /// Print one JSON object at the end
    #[arg(long)]
    pub json: bool,
    /// Say nothing but errors and the result
    #[arg(short, long)]
    pub quiet: bool,
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
}

#[derive(Debug, clap::Args)]
pub struct Common {
    /// Threads to use [default: one per core]; the numbers are the same for any
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Set a key of the case, e.g. --set domain.cells='[256, 256]' --set body.0.hardness='200 MPa'
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

#[derive(Debug, clap::Args)]
pub struct New {
    /// The starter case; without it they are listed
    pub template: Option<String>,
    /// The file to write [default: TEMPLATE.toml]
    pub path: Option<PathBuf>,
    /// Replace a file that is there already
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

#[derive(Debug, Subcommand)]
pub enum Surface {
    /// Print format, size and statistics of the heights as stored
    Info(SurfaceInfo),
    /// Make a rough surface: self-affine, with a lay, with a height distribution
    Generate(Box<SurfaceGenerate>),
    /// Prepare a surface step by step: level, fill, crop, resample, filter, ...
    Process(Box<SurfaceProcess>),
    /// Write the surface as NPZ, GWY, X3P, SDF, NetCDF or text
    Convert(SurfaceConvert),
}

#[derive(Debug, clap::Args)]
pub struct SurfaceInfo {
    #[command(flatten)]
    pub file: SurfaceFile,
    /// The surface repeats beyond its edges: take its spectrum without levelling and window
    #[arg(long)]
    pub periodic: bool,
    /// Fit the Hurst exponent only to waves up to this length
    #[arg(long, value_name = "LENGTH")]
    pub longest: Option<String>,
    /// Fit the Hurst exponent only to waves from this length on
    #[arg(long, value_name = "LENGTH")]
    pub shortest: Option<String>,
    /// Draw height map, power spectrum and height distribution (.png or .svg)
    #[arg(long, value_name = "PICTURE")]
    pub plot: Option<PathBuf>,
    /// Replace a picture that is there already
    #[arg(long)]
    pub force: bool,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// The keys of kind = "self-affine" in a case file, as options.
#[derive(Debug, clap::Args)]
pub struct SurfaceGenerate {
    /// Number of cells along x and y, one number for a square
    #[arg(long, value_name = "NX,NY", default_value = "512")]
    pub cells: String,
    /// Length along x and y, one for a square: --size '1 mm,1 mm'
    #[arg(long, value_name = "A,B")]
    pub size: Option<String>,
    /// A known roughness: contact-mechanics-challenge; other options change its numbers
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
    /// Hurst exponent, greater than 0 and at most 1
    #[arg(long, value_name = "H")]
    pub hurst: Option<String>,
    /// Root mean square of the gradient; this or --rms-height
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    pub rms_gradient: Option<String>,
    /// Root mean square of the height, e.g. '0.2 um'; this or --rms-gradient
    #[arg(long, value_name = "LENGTH", allow_hyphen_values = true)]
    pub rms_height: Option<String>,
    /// Longest wavelength
    #[arg(long, value_name = "LENGTH")]
    pub longest: Option<String>,
    /// Shortest wavelength, two cells at least
    #[arg(long, value_name = "LENGTH")]
    pub shortest: Option<String>,
    /// Wavelength down to which the spectrum is flat [default: the longest]
    #[arg(long, value_name = "LENGTH")]
    pub roll_off: Option<String>,
    /// Angle of the lay from the x axis, e.g. '30 deg'; needs --lay-ratio
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true, requires = "lay_ratio")]
    pub lay_angle: Option<String>,
    /// Length along the lay over length across it, 1 or more
    #[arg(long, value_name = "RATIO")]
    pub lay_ratio: Option<String>,
    /// Skewness of the heights, negative for plateaus with valleys
    #[arg(long, value_name = "SSK", allow_hyphen_values = true)]
    pub skewness: Option<String>,
    /// Kurtosis of the heights, 3 for Gaussian ones
    #[arg(long, value_name = "SKU")]
    pub kurtosis: Option<String>,
    /// A measured surface whose heights are distributed as wanted
    #[arg(long, value_name = "FILE", conflicts_with_all = ["skewness", "kurtosis"])]
    pub distribution: Option<String>,
    /// Number that picks the realisation
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    #[command(flatten)]
    pub to: SurfaceOutput,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceProcess {
    #[command(flatten)]
    pub file: SurfaceFile,
    /// A step, done in the order given, as in `process` of a case file: --op level=plane --op fill=harmonic --op 'crop
    /// size=50um,50um' --op 'filter shortest=2um' --op 'resample=bilinear cells=512,512' --op flip=x --op rotate=1
    /// --op invert --op window=hann --op 'outliers=6 radius=2'
    #[arg(long, value_name = "STEP", required = true)]
    pub op: Vec<String>,
    #[command(flatten)]
    pub to: SurfaceOutput,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceConvert {
    #[command(flatten)]
    pub file: SurfaceFile,
    /// The file to write; its ending tells the format
    pub output: PathBuf,
    /// The format, where the ending does not tell it: npz, gwy, x3p, sdf, nc, asc
    #[arg(long)]
    pub to: Option<String>,
    /// Replace a file that is there already
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceOutput {
    /// The file to write; its ending tells the format
    #[arg(short, long, value_name = "PATH")]
    pub output: PathBuf,
    /// The format, where the ending does not tell it: npz, gwy, x3p, sdf, nc, asc
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<String>,
    /// Draw height map, power spectrum and height distribution (.png or .svg)
    #[arg(long, value_name = "PICTURE")]
    pub plot: Option<PathBuf>,
    /// Replace files that are there already
    #[arg(long)]
    pub force: bool,
    /// Print the statistics as one JSON object
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceFile {
    /// The measured surface; its format is found from the content
    pub file: PathBuf,
    /// Physical size along x and y, where the file holds none: --size '1 mm,1 mm'
    #[arg(long, value_name = "A,B")]
    pub size: Option<String>,
    /// Unit of the heights, where the file holds none: --height-unit um
    #[arg(long, value_name = "U")]
    pub height_unit: Option<String>,
    /// Name or number (from 0) of the channel, where a file has several
    #[arg(long)]
    pub channel: Option<String>,
}

#[derive(Debug, Subcommand)]
pub enum Material {
    /// Print relaxation, creep, storage, loss and tan delta over decades
    Show(Show),
    /// Fit a Prony series to a relaxation test, a creep test or DMA sweeps
    Fit(Fit),
}

#[derive(Debug, clap::Args)]
pub struct Show {
    /// A case file, or a file with a `material = { ... }` and nothing else
    pub file: PathBuf,
    /// First time, e.g. --from '1 ms' [default: a decade before the material's times]
    #[arg(long, value_name = "TIME")]
    pub from: Option<String>,
    /// Last time [default: a decade after the material's times]
    #[arg(long, value_name = "TIME")]
    pub to: Option<String>,
    /// Lines of the table per decade
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=100))]
    pub per_decade: u16,
    /// Set a key of the case, e.g. --set temperature.history.value='60 °C'
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Print a JSON list with one object per body
    #[arg(long)]
    pub json: bool,
    /// Draw the functions: a path that ends in .svg, .png or .pdf
    #[arg(long, value_name = "PATH")]
    pub plot: Option<PathBuf>,
    /// Replace a picture that is there already
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct Fit {
    /// The text table: one point per line; separator and decimal mark are found, units stand in the header
    pub data: PathBuf,
    /// What was measured [default: what the header says]
    #[arg(long)]
    pub kind: Option<KindName>,
    /// Whether the numbers are Young's or shear moduli (or compliances)
    #[arg(long, default_value = "young")]
    pub modulus: MeasureName,
    /// Where a quantity stands, by number from 1 or by header: --column frequency=1 --column storage="E' [MPa]";
    /// quantities: time, modulus, compliance, frequency, storage, loss, tan_delta, temperature
    #[arg(long, value_name = "QUANTITY=COLUMN")]
    pub column: Vec<String>,
    /// Unit of a quantity, where the header names none: --unit storage=MPa
    #[arg(long, value_name = "QUANTITY=UNIT")]
    pub unit: Vec<String>,
    /// The part of the curve that is fitted: --window '0.1 s, 100 s', of a dma --window '0.1 Hz, 100 Hz'
    #[arg(long, value_name = "A,B")]
    pub window: Option<String>,
    /// Most terms [default: as many as the data call for]
    #[arg(long, value_name = "N")]
    pub max_terms: Option<usize>,
    /// Times per decade that the fit begins with [default: 3]
    #[arg(long, value_name = "N")]
    pub per_decade: Option<f64>,
    /// Decades of times beyond the data [default: 1]
    #[arg(long, value_name = "DECADES")]
    pub margin: Option<f64>,
    /// Largest relative misfit before the data are refused [default: 0.1]
    #[arg(long, value_name = "SHARE")]
    pub max_misfit: Option<f64>,
    /// What comes after the data
    #[arg(long, default_value = "free")]
    pub long_time: LongTimeName,
    /// Shift of several temperatures: --wlf 'C1, C2, REFERENCE', e.g. '8.86, 101.6 K, 20 °C'
    #[arg(long, value_name = "C1,C2,REF", conflicts_with_all = ["arrhenius", "estimate_shift"])]
    pub wlf: Option<String>,
    /// Shift of several temperatures: --arrhenius 'ENERGY, REFERENCE', e.g. '120 kJ/mol, 20 °C'
    #[arg(long, value_name = "ENERGY,REF", conflicts_with = "estimate_shift")]
    pub arrhenius: Option<String>,
    /// Find the shift from the overlap of the sweeps, about this temperature
    #[arg(long, value_name = "REF")]
    pub estimate_shift: Option<String>,
    /// The file to write, with a `material = { ... }` for a case [default: printed]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Draw data and fit: a path that ends in .svg, .png or .pdf
    #[arg(long, value_name = "PATH")]
    pub plot: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Replace files that are there already
    #[arg(long)]
    pub force: bool,
}

/// What was measured.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum KindName {
    /// Relaxation modulus over time
    Relaxation,
    /// Creep compliance over time
    Creep,
    /// Storage and loss modulus over frequency
    Dma,
}

/// What a modulus measures.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum MeasureName {
    Young,
    Shear,
}

/// What comes after the data.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum LongTimeName {
    /// Whatever fits best
    Free,
    /// No flow
    Solid,
    /// No modulus is left
    Fluid,
}

#[derive(Debug, clap::Args)]
pub struct ShowResult {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// The instant of the map: the stored one that is nearest, e.g. '500 s' [default: last]
    #[arg(long, value_name = "T")]
    pub time: Option<String>,
    /// Print one JSON object: status, rows, work and every number of the last row
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, clap::Args)]
pub struct Report {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// The page to write [default: the result's name with .html]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Largest size of the maps in the page, in megabytes; larger ones are reduced to means over blocks of cells
    #[arg(long, value_name = "MB", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=2000))]
    pub megabytes: u32,
    /// Largest number of instants whose maps are in the page
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=10000))]
    pub instants: u32,
    /// Replace a page that is there already
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct View {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// The port; 0 takes a free one
    #[arg(long, default_value_t = 0)]
    pub port: u16,
    /// The address to listen at: other machines can look at the result where it is not this machine's own
    #[arg(long, default_value = "127.0.0.1", value_name = "ADDRESS")]
    pub host: std::net::IpAddr,
}

#[derive(Debug, clap::Args)]
pub struct FitIndentation {
    /// The record: a text table with columns of time, load and depth
    pub record: PathBuf,
    /// Radius of the sphere, e.g. '5 mm'
    #[arg(long, value_name = "LENGTH", required_unless_present = "cone", conflicts_with = "cone")]
    pub radius: Option<String>,
    /// Slope of a cone instead: rise per length, the cotangent of its half angle
    #[arg(long, value_name = "SLOPE")]
    pub cone: Option<String>,
    /// Poisson's ratio of the body
    #[arg(long, value_name = "NU", default_value = "0.5")]
    pub poisson: String,
    /// The moduli to give
    #[arg(long, value_enum, default_value = "young")]
    pub modulus: MeasureName,
    /// The channel that the instrument controlled, taken as it was measured [default: the one with less scatter]
    #[arg(long, value_enum)]
    pub given: Option<GivenName>,
    /// Number of terms, at most 6 [default: as many as the record calls for]
    #[arg(long, value_name = "N")]
    pub terms: Option<usize>,
    /// What happens at times longer than the record
    #[arg(long, value_enum, default_value = "free")]
    pub long_time: LongTimeName,
    /// Fit the depth of first touch too, instead of taking it as 0
    #[arg(long)]
    pub fit_touch: bool,
    /// Where a quantity stands: QUANTITY=NUMBER or QUANTITY=HEADER, of time, load, depth; may be given several times
    #[arg(long, value_name = "QUANTITY=COLUMN")]
    pub column: Vec<String>,
    /// The unit of a quantity: QUANTITY=UNIT; may be given several times
    #[arg(long, value_name = "QUANTITY=UNIT")]
    pub unit: Vec<String>,
    /// Write the material, ready to paste under a [[body]] of a case file
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Draw record and model as PNG, SVG or PDF
    #[arg(long, value_name = "PATH")]
    pub plot: Option<PathBuf>,
    /// Replace files that are there already
    #[arg(long)]
    pub force: bool,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

/// A channel of an indentation.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub enum GivenName {
    Depth,
    Load,
}

#[derive(Debug, clap::Args)]
pub struct Plot {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// evolution, load-displacement, pressure, gap, displacement, contact, flattening, initial-gap, profile,
    /// histogram, spots, work or quantities
    pub what: String,
    /// The file to write; its ending tells the form: png, svg or pdf [default: RESULT-WHAT.png]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// The instant of maps, profiles and distributions: the stored one that is nearest, e.g. '500 s' [default: last]
    #[arg(long, value_name = "T")]
    pub time: Option<String>,
    /// Direction of the line of a profile
    #[arg(long, value_name = "AXIS", default_value = "x", value_parser = ["x", "y"])]
    pub along: String,
    /// Where the line of a profile crosses the other axis, e.g. '20 um' [default: the middle]
    #[arg(long, value_name = "PLACE")]
    pub at: Option<String>,
    /// Time on a logarithmic axis
    #[arg(long)]
    pub log_time: bool,
    /// The title [default: that of the case]
    #[arg(long)]
    pub title: Option<String>,
    /// Replace a file that is there already
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct Reproduce {
    /// Only these figures, 1 to 8
    #[arg(value_parser = clap::value_parser!(u8).range(1..=8))]
    pub figures: Vec<u8>,
    /// The directory to make
    #[arg(short, long, value_name = "DIR", default_value = "reproduction")]
    pub output: PathBuf,
    /// What the figures are written as: png, svg or pdf
    #[arg(long, value_name = "FORM", default_value = "png", value_parser = ["png", "svg", "pdf"])]
    pub form: String,
    /// Cells along a side of every case [default: 256, and 512 for the rough sphere; the paper has 1024]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=8192))]
    pub cells: Option<u32>,
    /// Threads to use [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Replace figures and results that are there already
    #[arg(long)]
    pub force: bool,
    /// Print a JSON list of {figure, quantity, difference, of}
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, clap::Args)]
pub struct Export {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// netcdf, hdf5, npz, vtk, csv or png (a directory of pictures)
    #[arg(long)]
    pub to: String,
    /// The file to write [default: the result's name with the ending of the format]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Fields to export [default: all that the result holds; none for csv]
    #[arg(long, value_delimiter = ',')]
    pub fields: Option<Vec<String>>,
    /// Replace an output that is there already
    #[arg(long)]
    pub force: bool,
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Args::command().debug_assert();
    }
}
