//! The arguments of the commands for results.

use std::path::PathBuf;

use asperity_io::quantity::range::Positive;
use asperity_io::quantity::{Length, Time};
use asperity_report::figure::Palette;
use asperity_report::result::Plot as Figure;

use crate::input::quantity;

#[derive(Debug, clap::Args)]
pub struct ShowResult {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// Time of the map, e.g. '500 s'; the nearest stored one is used [default: last]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub time: Option<String>,
    /// Unit for leaks or times, e.g. --unit leak=ml/year --unit time=h [default: that of the case]
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Print one JSON object: status, rows, work and every number of the last row
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, clap::Args)]
pub struct VerifyResult {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// Print one JSON object: {result, ok, checksums, arrays, chunks, damage}
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, clap::Args)]
pub struct Report {
    /// The result (a Zarr directory); several: what differs, their answers side by side, their curves in the same panels
    #[arg(required = true, value_name = "RESULT")]
    pub results: Vec<PathBuf>,
    #[command(flatten)]
    pub labels: Labels,
    /// The page to write [default: the result's name with .html; of several report.html]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Largest size of the maps in the page, in megabytes; larger maps are averaged over blocks of cells
    #[arg(long, value_name = "MB", default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=2000))]
    pub megabytes: u32,
    /// Largest number of times with maps in the page
    #[arg(long, value_name = "N", default_value_t = 24, value_parser = clap::value_parser!(u32).range(1..=10000))]
    pub instants: u32,
    /// Replace an existing page
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct View {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// Port to listen at; 0 chooses a free one
    #[arg(long, default_value_t = 0)]
    pub port: u16,
    /// Address to listen at; if it is not an address of this machine alone, other machines can view the result
    #[arg(long, default_value = "127.0.0.1", value_name = "ADDRESS")]
    pub host: std::net::IpAddr,
}

#[derive(Debug, clap::Args)]
pub struct Labels {
    /// What a result is called, once for each, in their order [default: the keys of the cases that differ, with their values]
    #[arg(long = "label", value_name = "TEXT")]
    pub label: Vec<String>,
}

#[derive(Debug, clap::Args)]
pub struct Compare {
    /// The results (Zarr directories), two or more; changes are against the first
    #[arg(required = true, num_args = 2.., value_name = "RESULT")]
    pub results: Vec<PathBuf>,
    #[command(flatten)]
    pub labels: Labels,
    /// Unit for leaks or times, e.g. --unit leak=ml/year --unit time=h [default: that of the case]
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Print one JSON object, in SI units
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, clap::Args)]
pub struct Plot {
    /// The result (a Zarr directory); several: their curves in the same panels, their maps side by side
    #[arg(required = true, value_name = "RESULT")]
    pub results: Vec<PathBuf>,
    #[arg(help = format!("What to draw: {}", Figure::names()))]
    pub what: String,
    #[command(flatten)]
    pub labels: Labels,
    /// The file to write; its extension selects the format: png, svg or pdf [default: RESULT-WHAT.png]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Write an animation over the stored times to this file instead: .png (or .apng) or .gif
    #[arg(long, value_name = "PATH", conflicts_with_all = ["output", "time", "same_colours"])]
    pub animate: Option<PathBuf>,
    /// Length of the animation, e.g. '6 s' [default: 0.2 s for each frame, at most 12 s]
    #[arg(long, value_name = "T", requires = "animate", allow_hyphen_values = true, value_parser = quantity::<Time<Positive>>())]
    pub duration: Option<Time<Positive>>,
    /// Largest number of frames of the animation; of more stored times some are left out evenly [default: 200]
    #[arg(long, value_name = "N", requires = "animate", value_parser = clap::value_parser!(u32).range(2..=10000))]
    pub frames: Option<u32>,
    /// Time of maps, profiles, distributions and the stress, e.g. '500 s'; the nearest stored one is used [default: last]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub time: Option<String>,
    /// Direction of a profile
    #[arg(long, value_name = "AXIS", default_value = "x", value_parser = ["x", "y"])]
    pub along: String,
    /// Position of a profile on the other axis, e.g. '20 um' [default: the middle]
    #[arg(long, value_name = "PLACE", allow_hyphen_values = true, value_parser = quantity::<Length>())]
    pub at: Option<Length>,
    /// Time on a logarithmic axis [default: where most rows lie in the first tenth of the run]
    #[arg(long, conflicts_with = "linear_time")]
    pub log_time: bool,
    /// Time on a linear axis
    #[arg(long)]
    pub linear_time: bool,
    /// First time of figures over time, or of the animation, e.g. '1 s' (of a sweep a velocity) [default: the first]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub from: Option<String>,
    /// Last time likewise [default: the last]
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub to: Option<String>,
    /// Values at the ends of the colours of a map, e.g. '0,20 MPa' [default: those of the map]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true)]
    pub limits: Option<String>,
    /// Colours of all stored times of all results given: maps made at other times can be compared
    #[arg(long, conflicts_with = "limits")]
    pub same_colours: bool,
    /// Colour map [default: inferno for pressure and stress, else viridis]
    #[arg(long, value_name = "NAME", value_parser = super::choice::<Palette>())]
    pub colours: Option<Palette>,
    /// Colours of a map by the logarithm of the values, e.g. of the gap; of a line contact the vertical axis
    #[arg(long)]
    pub log: bool,
    /// Width and height of the figure, e.g. '160 mm,100 mm' [default: what its panels take]
    #[arg(long, value_name = "A,B", allow_hyphen_values = true)]
    pub size: Option<String>,
    /// The title [default: that of the case]
    #[arg(long)]
    pub title: Option<String>,
    /// Unit for leaks or times, e.g. --unit leak=ml/year --unit time=h [default: that of the case]
    #[arg(long, value_name = "NAME=UNIT")]
    pub unit: Vec<String>,
    /// Replace an existing file
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct Export {
    /// The result (a Zarr directory)
    pub result: PathBuf,
    /// netcdf, hdf5, npz, vtk, csv, sdf (a surface file of one field at the last stored instant) or png (a directory of pictures)
    #[arg(long)]
    pub to: String,
    /// The file to write [default: the result's name with the extension of the format]
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Fields to export [default: all that the result holds; none for csv]
    #[arg(long, value_delimiter = ',')]
    pub fields: Option<Vec<String>>,
    /// Replace an existing output
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, clap::Args)]
pub struct Reproduce {
    /// Only these figures, 1 to 8
    #[arg(value_parser = clap::value_parser!(u8).range(1..=8))]
    pub figures: Vec<u8>,
    /// The directory to create
    #[arg(short, long, value_name = "DIR", default_value = "reproduction")]
    pub output: PathBuf,
    /// Format of the figures: png, svg or pdf
    #[arg(long, value_name = "FORM", default_value = "png", value_parser = ["png", "svg", "pdf"])]
    pub form: String,
    /// Cells along a side of every case [default: 256, and 512 for the rough sphere; the paper has 1024]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=8192))]
    pub cells: Option<u32>,
    /// Threads to use [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Replace existing figures and results
    #[arg(long)]
    pub force: bool,
    /// Print a JSON list of {figure, quantity, difference, of}
    #[arg(long)]
    pub json: bool,
}
