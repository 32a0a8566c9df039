//! The arguments of `asperity stress`.

use std::path::PathBuf;

use asperity_io::quantity::{Number, Time, range};

use crate::input::quantity;

#[derive(Debug, clap::Args)]
pub struct Stress {
    /// The result (a Zarr directory); its pressures must be stored
    pub result: PathBuf,
    /// Depths below the surface, e.g. '0,5 um,10 um', or auto: 0 and 24 depths from half a cell to the width of the contact
    /// [default: those stored, or auto]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub depths: Option<String>,
    /// Name or number (from 0) of the body [default: the one stored, or the first]
    #[arg(long, value_name = "BODY", allow_hyphen_values = true)]
    pub body: Option<String>,
    /// Poisson's ratio, if the result does not say it or another one is wanted
    #[arg(long, value_name = "NU", allow_hyphen_values = true, value_parser = quantity::<Number<range::Poisson>>())]
    pub poisson: Option<Number<range::Poisson>>,
    /// Fields to store at each depth: mises, tresca, tension, pressure, xx, yy, zz, xy, xz, yz; or none
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub components: Option<String>,
    /// Measure the volume with a von Mises stress above this, e.g. '100 MPa', or none
    #[arg(long, value_name = "P", allow_hyphen_values = true)]
    pub threshold: Option<String>,
    /// Yield stress of the body, e.g. '110 MPa': report first yield; or none
    #[arg(long, value_name = "P", allow_hyphen_values = true)]
    pub yield_stress: Option<String>,
    /// Direction in which the contact rolls, x or y: find the range of the orthogonal shear stress; or none
    #[arg(long, value_name = "AXIS")]
    pub rolling: Option<String>,
    /// Times of stored fields, e.g. '1 s,10 s', or fields for all of them [default: those stored, or all]
    #[arg(long, value_name = "LIST", allow_hyphen_values = true)]
    pub times: Option<String>,
    /// Time of the profile, the figure and the volume [default: the one with the largest von Mises stress]
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = quantity::<Time>())]
    pub time: Option<Time>,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Draw sections, a map and the profile: a file ending in png, svg or pdf
    #[arg(long, value_name = "PATH")]
    pub plot: Option<PathBuf>,
    /// Write the volume for ParaView: .vti with equal distances of depth, or .vtr with the depths themselves
    #[arg(short, long, value_name = "PATH")]
    pub output: Option<PathBuf>,
    /// Do not store the stress in the result
    #[arg(long)]
    pub no_store: bool,
    /// Replace existing files of --plot and --output
    #[arg(long)]
    pub force: bool,
    /// Threads to use [default: one per core]; the results do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}
