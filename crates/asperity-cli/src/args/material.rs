//! The arguments of `asperity material` and `asperity fit-indentation`.

use std::path::PathBuf;

use asperity::force_curve::{Branch, ForceModel, PullOffControl, Weights};
use asperity::indentation::{Given, Indenter};
use asperity::layer::Interface;
use asperity::material::{LongTime, Moduli, Modulus};
use asperity_io::choice;
use asperity_io::curve::{Kind, VerticalWord};
use asperity_io::material_export::Program;
use asperity_io::quantity::{Angle, Expansion, ForcePerLength, Length, Number, Time, range};
use clap::Subcommand;
use clap::builder::{PossibleValuesParser, TypedValueParser};

use super::choice as words;
use crate::input::quantity;

#[derive(Debug, Subcommand)]
pub enum Material {
    /// Print relaxation, creep, storage, loss and tan delta over decades; of measured data, what the file holds
    Show(Show),
    /// Fit a Prony series to a relaxation test, a creep test or DMA sweeps
    Fit(Box<Fit>),
    /// Write a material for another program: relative moduli, times and the shift with temperature
    Export(MaterialExport),
}

#[derive(Debug, clap::Args)]
pub struct MaterialExport {
    /// A case file, or a file with the `material = { ... }` of a body, as the fits write it
    pub file: PathBuf,
    /// The program: abaqus (keywords of an input file), ansys (commands of Mechanical APDL), comsol (branches of the generalised
    /// Maxwell model) or csv (comma-separated values)
    #[arg(long, value_parser = words::<Program>())]
    pub to: Program,
    /// The body of a case [default: the only one with a viscoelastic material]
    #[arg(long, value_name = "NAME")]
    pub body: Option<String>,
    /// Poisson's ratio, where the file is no case
    #[arg(long, value_name = "NU", allow_hyphen_values = true, value_parser = quantity::<Number<range::Poisson>>())]
    pub poisson: Option<Number<range::Poisson>>,
    /// Set a key of the case
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// The file to write [default: printed]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Replace an existing file
    #[arg(long)]
    pub force: bool,
}

/// What is said about a file of measured data.
#[derive(Debug, Default, clap::Args)]
pub struct Data {
    /// What was measured: relaxation modulus over time, creep compliance over time, or storage and loss modulus over
    /// frequency (dma) [default: what the header says]
    #[arg(long, value_parser = words::<Kind>())]
    pub kind: Option<Kind>,
    /// Column of a quantity, by number from 1 or by header: --column frequency=1 --column storage="E' [MPa]";
    /// quantities: time, modulus, compliance, frequency, storage, loss, tan_delta, phase, complex_modulus,
    /// storage_compliance, loss_compliance, complex_viscosity, real_viscosity, imaginary_viscosity, temperature, set
    #[arg(long, value_name = "QUANTITY=COLUMN")]
    pub column: Vec<String>,
    /// Unit of a quantity, if the header does not name it: --unit storage=MPa
    #[arg(long, value_name = "QUANTITY=UNIT")]
    pub unit: Vec<String>,
    /// Sheet of a spreadsheet (.xls, .xlsx) [default: the first one that names such columns]
    #[arg(long, value_name = "NAME")]
    pub sheet: Option<String>,
    /// Which of several steps or sweeps below each other to read, from 1 [default: all, as one]
    #[arg(long, value_name = "N")]
    pub segment: Option<usize>,
}

#[derive(Debug, clap::Args)]
pub struct Show {
    /// A case file, a file with the `material = { ... }` of a body, as the fits write it, or a file of measured data
    pub file: PathBuf,
    /// The table of measured data
    #[command(flatten)]
    pub table: Data,
    /// First time, e.g. --from '1 ms' [default: a decade before the material's times]
    #[arg(long, value_name = "TIME", value_parser = quantity::<Time<range::Positive>>())]
    pub from: Option<Time<range::Positive>>,
    /// Last time [default: a decade after the material's times]
    #[arg(long, value_name = "TIME", value_parser = quantity::<Time<range::Positive>>())]
    pub to: Option<Time<range::Positive>>,
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
    /// A text table or spreadsheet with one point per line; separator and decimal mark are detected, quantities and units come
    /// from the header (asperity material show FILE says what is found)
    pub data: PathBuf,
    /// The table of measured data
    #[command(flatten)]
    pub table: Data,
    /// Whether the numbers are Young's or shear moduli (or compliances) [default: what the header says, E or G, D or J]
    #[arg(long, value_parser = words::<Modulus>())]
    pub modulus: Option<Modulus>,
    /// Moduli of a dma to fit; measured ones often contradict each other, and then storage is usual
    #[arg(long, value_parser = words::<Moduli>(), default_value = "both")]
    pub fit: Moduli,
    /// Factor of the residuals of the loss modulus, before they are squared, where both moduli are fitted; that of the storage modulus is 1 [default: 1]
    #[arg(long, value_name = "WEIGHT")]
    pub loss_weight: Option<f64>,
    /// Rms misfit to hold with as few terms as possible, e.g. 0.02 or '2 %' [default: the data justify the number of terms]
    #[arg(long, value_name = "SHARE", conflicts_with = "max_terms", allow_hyphen_values = true, value_parser = quantity::<Number<range::Positive>>())]
    pub misfit: Option<Number<range::Positive>>,
    /// Part of the curve to fit: --window '0.1 s, 100 s', for a dma --window '0.1 Hz, 100 Hz'
    #[arg(long, value_name = "A,B", allow_hyphen_values = true)]
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
    /// Largest relative misfit (rms) before the data are refused, e.g. 0.2 or '20 %' [default: 0.1]
    #[arg(long, value_name = "SHARE", allow_hyphen_values = true, value_parser = quantity::<Number<range::Positive>>())]
    pub max_misfit: Option<Number<range::Positive>>,
    /// What comes after the data: whatever fits best (free), no flow (solid, of creep), or no modulus left (fluid)
    #[arg(long, value_parser = words::<LongTime>(), default_value = "free")]
    pub long_time: LongTime,
    /// Shift for data at several temperatures: --wlf 'C1, C2, REFERENCE', e.g. '8.86, 101.6 K, 20 °C'
    #[arg(long, value_name = "C1,C2,REF", allow_hyphen_values = true, conflicts_with_all = ["arrhenius", "estimate_shift", "shift_table"])]
    pub wlf: Option<String>,
    /// Shift for data at several temperatures: --arrhenius 'ENERGY, REFERENCE', e.g. '120 kJ/mol, 20 °C'
    #[arg(long, value_name = "ENERGY,REF", allow_hyphen_values = true, conflicts_with_all = ["estimate_shift", "shift_table"])]
    pub arrhenius: Option<String>,
    /// Table of shift factors, with columns T and log_aT (or ln_aT, aT)
    #[arg(long, value_name = "PATH", conflicts_with = "estimate_shift")]
    pub shift_table: Option<PathBuf>,
    /// Estimate the shift from the sweeps, with this reference temperature, e.g. --estimate-shift '-5 °C' [default where a
    /// file holds several temperatures and no shift: the temperature nearest to 20 °C]
    #[arg(long, value_name = "REF", allow_hyphen_values = true)]
    pub estimate_shift: Option<String>,
    /// How the moduli of sweeps at several temperatures depend on temperature, besides their times: as density times absolute
    /// temperature (density, rubbers), or by one factor per sweep, estimated from both moduli (free) [default: they do not]
    #[arg(long, value_parser = words::<VerticalWord>())]
    pub vertical: Option<VerticalWord>,
    /// Relative growth of the volume per kelvin for --vertical density, e.g. '6e-4 1/K' [default: a constant density]
    #[arg(long, value_name = "1/K", value_parser = quantity::<Expansion<range::NonNegative>>())]
    pub expansion: Option<Expansion<range::NonNegative>>,
    #[command(flatten)]
    pub to: FitOutput,
}

/// Where a fit goes.
#[derive(Debug, clap::Args)]
pub struct FitOutput {
    /// The file to write, with the `material = { ... }` for a [[body]] of a case [default: printed]
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

/// What `fit-indentation` fits: the relaxation of the body, or an elastic body to a force curve by one of its models.
#[derive(Clone, Copy, Debug)]
pub enum Model {
    /// As a Prony series.
    Viscoelastic,
    /// As a power law.
    PowerLaw,
    Curve(ForceModel),
}

impl Model {
    const RELAXATION: [&'static str; 2] = ["viscoelastic", "power-law"];

    fn parser() -> impl TypedValueParser<Value = Model> {
        let words = Self::RELAXATION.into_iter().chain(choice::words::<ForceModel>().iter().copied());
        PossibleValuesParser::new(words).map(|word| match choice::parse(&word) {
            Some(curve) => Model::Curve(curve),
            None if word == Self::RELAXATION[1] => Model::PowerLaw,
            None => Model::Viscoelastic,
        })
    }
}

/// The options of force curves.
#[derive(Debug, Default, clap::Args)]
pub struct ForceCurve {
    /// Part of a force curve that is fitted: from the largest load on (retraction), or before it (approach) [default: retraction]
    #[arg(long, value_parser = words::<Branch>())]
    pub branch: Option<Branch>,
    /// What a force curve was controlled by, which decides where the sphere comes off [default: the height of the cantilever with
    /// --spring-constant, else displacement]
    #[arg(long, value_parser = words::<PullOffControl>())]
    pub control: Option<PullOffControl>,
    /// How the rows of a force curve count: by their noise, or all alike (none), as other programs do it [default: noise]
    #[arg(long, value_parser = words::<Weights>())]
    pub weights: Option<Weights>,
    /// Range of the attraction, in place of a fitted transition of --model maugis, and for Tabor's number, e.g. '0.3 nm'
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<Length<range::Positive>>())]
    pub range: Option<Length<range::Positive>>,
    /// Spring constant of a cantilever, e.g. '0.2 N/m': the columns are height (larger towards the sample) and deflection
    #[arg(long, value_name = "STIFFNESS", value_parser = quantity::<ForcePerLength<range::Positive>>())]
    pub spring_constant: Option<ForcePerLength<range::Positive>>,
    /// Deflection of the cantilever per volt, where its column is in volts, e.g. '50 nm'
    #[arg(long, value_name = "LENGTH", requires = "spring_constant", value_parser = quantity::<Length<range::Positive>>())]
    pub sensitivity: Option<Length<range::Positive>>,
    /// Standard uncertainty of the radius (one standard deviation), e.g. '0.2 um' or '2 %', with any model; of a cone or pyramid in %, that of the
    /// cotangent of the half angle
    #[arg(long, value_name = "LENGTH")]
    pub radius_uncertainty: Option<String>,
    /// Standard uncertainty of the spring constant, e.g. '0.01 N/m' or '5 %'; of records of load, with any model, '5 %' of the load
    #[arg(long, value_name = "STIFFNESS")]
    pub spring_constant_uncertainty: Option<String>,
    /// Standard uncertainty of the scale of the deflection, e.g. '2 %'
    #[arg(long, value_name = "SHARE", requires = "spring_constant", value_parser = quantity::<Number<range::NonNegative>>())]
    pub sensitivity_uncertainty: Option<Number<range::NonNegative>>,
}

#[derive(Debug, clap::Args)]
pub struct FitIndentation {
    /// The record: a text table with columns of time, load and depth, or of height and deflection with --spring-constant
    pub record: PathBuf,
    /// The indenter: a ball (sphere), the paraboloid that a ball is near its apex, a cone, or a square pyramid
    #[arg(long, value_parser = words::<Indenter>(), default_value = "sphere")]
    pub indenter: Indenter,
    /// Radius of the sphere or paraboloid, e.g. '5 mm'
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<Length<range::Positive>>())]
    pub radius: Option<Length<range::Positive>>,
    /// Half angle of the cone or pyramid, e.g. '20 deg': from the axis to the flank of a cone, to a face (not an edge) of a pyramid
    #[arg(long, value_name = "ANGLE", value_parser = quantity::<Angle>())]
    pub angle: Option<Angle>,
    /// What is fitted: the relaxation of the body as a Prony series (viscoelastic) or as a power law of time (power-law), or an elastic body to a
    /// force curve, without adhesion (hertz) or with it (dmt, jkr, maugis); force curves need no column of time
    #[arg(long, value_parser = Model::parser(), default_value = "viscoelastic")]
    pub model: Model,
    /// The options of force curves
    #[command(flatten)]
    pub curve: ForceCurve,
    /// Poisson's ratio of the body
    #[arg(long, value_name = "NU", default_value = "0.5", allow_hyphen_values = true, value_parser = quantity::<Number<range::Poisson>>())]
    pub poisson: Number<range::Poisson>,
    /// Thickness of a thin sample on a rigid base, e.g. '5 um' [default: much thicker than the contact is wide]
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<Length<range::Positive>>())]
    pub thickness: Option<Length<range::Positive>>,
    /// Standard uncertainty of the thickness (one standard deviation), e.g. '0.1 um' or '2 %'
    #[arg(long, value_name = "LENGTH", requires = "thickness")]
    pub thickness_uncertainty: Option<String>,
    /// Contact of the thin sample with its base
    #[arg(long, value_parser = words::<Interface>(), default_value = "bonded", requires = "thickness")]
    pub interface: Interface,
    /// Kind of moduli to report
    #[arg(long, value_parser = words::<Modulus>(), default_value = "young")]
    pub modulus: Modulus,
    /// The channel that the test controlled [default: the one that fewer straight pieces describe, ramps and holds]
    #[arg(long, value_parser = words::<Given>())]
    pub given: Option<Given>,
    /// Number of terms, at most 6 [default: as many as the record justifies]
    #[arg(long, value_name = "N")]
    pub terms: Option<usize>,
    /// Behaviour at times longer than the record: whatever fits best (free), no flow (solid), or no modulus left (fluid)
    #[arg(long, value_parser = words::<LongTime>(), default_value = "free")]
    pub long_time: LongTime,
    /// Fit the depth of first touch too, instead of taking it as 0
    #[arg(long)]
    pub fit_touch: bool,
    /// Column of a quantity (time, load, depth; height, deflection), by number from 1 or by header; may be given several times
    #[arg(long, value_name = "QUANTITY=COLUMN")]
    pub column: Vec<String>,
    /// Unit of a quantity, if the header does not name it; may be given several times
    #[arg(long, value_name = "QUANTITY=UNIT")]
    pub unit: Vec<String>,
    #[command(flatten)]
    pub to: FitOutput,
}
