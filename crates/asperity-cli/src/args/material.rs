//! The arguments of `asperity material` and `asperity fit-indentation`.

use std::path::PathBuf;

use asperity::indentation::Given;
use asperity::material::{LongTime, Modulus};
use asperity_io::curve::Kind;
use clap::Subcommand;

use super::choice;

#[derive(Debug, Subcommand)]
pub enum Material {
    /// Print relaxation, creep, storage, loss and tan delta over decades
    Show(Show),
    /// Fit a Prony series to a relaxation test, a creep test or DMA sweeps
    Fit(Fit),
}

#[derive(Debug, clap::Args)]
pub struct Show {
    /// A case file, or a file with the `material = { ... }` of a body, as the fits write it
    pub file: PathBuf,
    /// First time, e.g. --from '1 ms' [default: a decade before the material's times]
    #[arg(long, value_name = "TIME")]
    pub from: Option<String>,
    /// Last time [default: a decade after the material's times]
    #[arg(long, value_name = "TIME")]
    pub to: Option<String>,
    /// Show how bodies of layers answer waves of pressure instead: q C(q) over the length of the wave
    #[arg(long, conflicts_with_all = ["from", "to"])]
    pub layers: bool,
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
    /// Replace an existing picture
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct Fit {
    /// A text table with one point per line; separator and decimal mark are detected, units come from the header
    pub data: PathBuf,
    /// What was measured: relaxation modulus over time, creep compliance over time, or storage and loss modulus over
    /// frequency (dma) [default: what the header says]
    #[arg(long, value_parser = choice::<Kind>())]
    pub kind: Option<Kind>,
    /// Whether the numbers are Young's or shear moduli (or compliances) [default: what the header says, E or G, D or J]
    #[arg(long, value_parser = choice::<Modulus>())]
    pub modulus: Option<Modulus>,
    /// Column of a quantity, by number from 1 or by header: --column frequency=1 --column storage="E' [MPa]";
    /// quantities: time, modulus, compliance, frequency, storage, loss, tan_delta, temperature
    #[arg(long, value_name = "QUANTITY=COLUMN")]
    pub column: Vec<String>,
    /// Unit of a quantity, if the header does not name it: --unit storage=MPa
    #[arg(long, value_name = "QUANTITY=UNIT")]
    pub unit: Vec<String>,
    /// Part of the curve to fit: --window '0.1 s, 100 s', for a dma --window '0.1 Hz, 100 Hz'
    #[arg(long, value_name = "A,B")]
    pub window: Option<String>,
    /// Largest number of terms [default: as many as the data justify]
    #[arg(long, value_name = "N")]
    pub max_terms: Option<usize>,
    /// Times per decade at the start of the fit [default: 3]
    #[arg(long, value_name = "N")]
    pub per_decade: Option<f64>,
    /// Decades of times beyond the data [default: 1]
    #[arg(long, value_name = "DECADES")]
    pub margin: Option<f64>,
    /// Largest relative misfit (rms) before the data are refused [default: 0.1]
    #[arg(long, value_name = "SHARE", visible_alias = "misfit")]
    pub max_misfit: Option<f64>,
    /// What comes after the data: whatever fits best (free), no flow (solid), or no modulus left (fluid)
    #[arg(long, value_parser = choice::<LongTime>(), default_value = "free")]
    pub long_time: LongTime,
    /// Shift for data at several temperatures: --wlf 'C1, C2, REFERENCE', e.g. '8.86, 101.6 K, 20 °C'
    #[arg(long, value_name = "C1,C2,REF", conflicts_with_all = ["arrhenius", "estimate_shift"])]
    pub wlf: Option<String>,
    /// Shift for data at several temperatures: --arrhenius 'ENERGY, REFERENCE', e.g. '120 kJ/mol, 20 °C'
    #[arg(long, value_name = "ENERGY,REF", conflicts_with = "estimate_shift")]
    pub arrhenius: Option<String>,
    /// Estimate the shift from the overlap of the sweeps, with this reference temperature
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
    /// Replace existing files
    #[arg(long)]
    pub force: bool,
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
    /// Kind of moduli to report
    #[arg(long, value_parser = choice::<Modulus>(), default_value = "young")]
    pub modulus: Modulus,
    /// The channel that the test controlled [default: the one that fewer straight pieces describe, ramps and holds]
    #[arg(long, value_parser = choice::<Given>())]
    pub given: Option<Given>,
    /// Number of terms, at most 6 [default: as many as the record justifies]
    #[arg(long, value_name = "N")]
    pub terms: Option<usize>,
    /// Behaviour at times longer than the record: whatever fits best (free), no flow (solid), or no modulus left (fluid)
    #[arg(long, value_parser = choice::<LongTime>(), default_value = "free")]
    pub long_time: LongTime,
    /// Fit the depth of first touch too, instead of taking it as 0
    #[arg(long)]
    pub fit_touch: bool,
    /// Column of a quantity (time, load, depth), by number from 1 or by header; may be given several times
    #[arg(long, value_name = "QUANTITY=COLUMN")]
    pub column: Vec<String>,
    /// Unit of a quantity, if the header does not name it; may be given several times
    #[arg(long, value_name = "QUANTITY=UNIT")]
    pub unit: Vec<String>,
    /// Write the material, ready to paste under a [[body]] of a case file
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Draw record and model as PNG, SVG or PDF
    #[arg(long, value_name = "PATH")]
    pub plot: Option<PathBuf>,
    /// Replace existing files
    #[arg(long)]
    pub force: bool,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}
