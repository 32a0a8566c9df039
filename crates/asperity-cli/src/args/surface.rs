//! The arguments of `asperity surface`.

use std::path::PathBuf;

use asperity_io::quantity::Length;
use clap::Subcommand;

use crate::files::Files;
use crate::input::quantity;

#[derive(Debug, Subcommand)]
pub enum Surface {
    /// Print format, size and statistics of the heights as stored; of a profile its parameters Ra, Rq, Rz, ...
    Info(SurfaceInfo),
    /// Generate a self-affine rough surface, optionally with a lay or a height distribution
    Generate(Box<SurfaceGenerate>),
    /// Generate an isotropic surface with the power spectrum of a measured profile
    FromProfile(Box<SurfaceFromProfile>),
    /// Process a surface step by step: level, fill, crop, resample, filter, ...
    Process(Box<SurfaceProcess>),
    /// Write the surface as NPZ, GWY, X3P, SDF, NetCDF or text
    Convert(SurfaceConvert),
}

#[derive(Debug, Default, clap::Args)]
pub struct SurfaceInfo {
    #[command(flatten)]
    pub file: SurfaceFile,
    /// Treat the surface as periodic: compute its spectrum without levelling and window
    #[arg(long)]
    pub periodic: bool,
    /// Longest wavelength used to fit the Hurst exponent
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<Length>())]
    pub longest: Option<Length>,
    /// Shortest wavelength used to fit the Hurst exponent
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<Length>())]
    pub shortest: Option<Length>,
    /// Of a profile: subtract the Gaussian mean line of this cut-off (ISO 16610-21), e.g. '0.8 mm'
    #[arg(long, value_name = "LENGTH", value_parser = quantity::<Length>())]
    pub cutoff: Option<Length>,
    /// Of a profile: subtract a circle of this radius instead of a straight line, or "fit" for the one that fits best
    #[arg(long, value_name = "RADIUS")]
    pub circle: Option<String>,
    /// Draw height map, power spectrum and height distribution (.png, .svg or .pdf)
    #[arg(long, value_name = "PICTURE")]
    pub plot: Option<PathBuf>,
    /// Replace an existing picture
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
    /// A published roughness: contact-mechanics-challenge; other options replace its numbers
    #[arg(long, value_name = "NAME")]
    pub preset: Option<String>,
    /// Hurst exponent, greater than 0 and at most 1
    #[arg(long, value_name = "H")]
    pub hurst: Option<String>,
    /// Root mean square of the gradient; give this or --rms-height
    #[arg(long, value_name = "G", allow_hyphen_values = true)]
    pub rms_gradient: Option<String>,
    /// Root mean square of the height, e.g. '0.2 um'; give this or --rms-gradient
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
    /// Measured surface whose height distribution is used
    #[arg(long, value_name = "FILE", conflicts_with_all = ["skewness", "kurtosis"])]
    pub distribution: Option<String>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    #[command(flatten)]
    pub to: SurfaceOutput,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceFromProfile {
    #[command(flatten)]
    pub file: SurfaceFile,
    /// Number of cells along x and y, one number for a square [default: of the spacing of the profile, at most 2048]
    #[arg(long, value_name = "NX,NY")]
    pub cells: Option<String>,
    /// Length of the surface along x and y, one for a square [default: the length of the profile]
    #[arg(long, value_name = "A,B")]
    pub to_size: Option<String>,
    /// Treat the profile as periodic: compute its spectrum without levelling and window
    #[arg(long)]
    pub periodic: bool,
    /// A step that prepares the profile, done in the order given, as in `surface process`: --op outliers=6 --op fill=harmonic
    #[arg(long, value_name = "STEP")]
    pub op: Vec<String>,
    /// Seed of the random phases
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    #[command(flatten)]
    pub to: SurfaceOutput,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceProcess {
    #[command(flatten)]
    pub file: SurfaceFile,
    /// A processing step, done in the order given, as in `process` of a case file: --op level=plane --op fill=harmonic --op 'crop
    /// size=50um,50um' --op 'filter shortest=2um' --op 'resample=bilinear cells=512,512' --op flip=x --op rotate=1
    /// --op invert --op border=mirror --op window=tukey --op 'outliers=6 radius=2'
    #[arg(long, value_name = "STEP", required = true)]
    pub op: Vec<String>,
    #[command(flatten)]
    pub to: SurfaceOutput,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceConvert {
    #[command(flatten)]
    pub file: SurfaceFile,
    /// The file to write; its extension selects the format
    pub output: PathBuf,
    /// The format, if the extension does not select it: npz, gwy, x3p, sdf, nc, asc
    #[arg(long)]
    pub to: Option<String>,
    /// Replace an existing file
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct SurfaceOutput {
    /// The file to write; its extension selects the format
    #[arg(short, long, value_name = "PATH")]
    pub output: PathBuf,
    /// The format, if the extension does not select it: npz, gwy, x3p, sdf, nc, asc
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<String>,
    /// Draw height map, power spectrum and height distribution (.png, .svg or .pdf)
    #[arg(long, value_name = "PICTURE")]
    pub plot: Option<PathBuf>,
    /// Replace existing files
    #[arg(long)]
    pub force: bool,
    /// Print the statistics as one JSON object
    #[arg(long)]
    pub json: bool,
}

impl SurfaceOutput {
    /// The files that are written.
    pub fn files(&self) -> Files {
        Files::default().writes([&self.output]).draws(&self.plot).force(self.force)
    }
}

#[derive(Debug, Default, clap::Args)]
pub struct SurfaceFile {
    /// The measured surface; its format is detected from the content
    pub file: PathBuf,
    /// Physical size along x and y, if the file does not state it: --size '1 mm,1 mm'; of a profile its length, the number of points times their spacing:
    /// --size '4 mm'
    #[arg(long, value_name = "A,B")]
    pub size: Option<String>,
    /// Unit of the heights, if the file does not state it: --height-unit um
    #[arg(long, value_name = "U")]
    pub height_unit: Option<String>,
    /// Name or number (from 0) of the channel, if the file has several; `surface info` lists them [default: the first with heights]
    #[arg(long)]
    pub channel: Option<String>,
}
