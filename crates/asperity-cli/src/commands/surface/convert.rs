//! `asperity surface convert`: the same heights in another format.

use asperity_io::topography::write;

use crate::args::SurfaceConvert;
use crate::failure::Failure;

/// Reads and writes.
pub fn run(args: &SurfaceConvert) -> Result<(), Failure> {
    let format = super::target(&args.output, args.to.as_deref(), args.force)?;
    let topography = super::open(&args.file)?;
    write(&args.output, &topography, format).map_err(Failure::of)
}
