//! `asperity surface info`: what a file holds, and the statistics of its heights as stored.

use asperity::surface::statistics::Extent;

use super::table::SurfaceSummary;
use crate::args::SurfaceInfo;
use crate::failure::Failure;

/// Prints the table or one JSON object, and draws the picture asked for.
pub fn run(args: &SurfaceInfo) -> Result<(), Failure> {
    super::table::check_plot(args.plot.as_deref(), args.force)?;
    let limit = |given: &Option<String>, default: f64| match given {
        Some(text) => super::length(text),
        None => Ok(default),
    };
    let band = [limit(&args.longest, f64::INFINITY)?, limit(&args.shortest, 0.0)?];
    if let Some(profile) = super::profile::open(&args.file)? {
        return super::profile::info(args, profile);
    }
    if args.cutoff.is_some() || args.circle.is_some() {
        let name = args.file.file.display();
        return Err(Failure::input(format!(
            "{name} is no profile: --cutoff and --circle are for two columns of text"
        )));
    }
    let topography = super::open(&args.file)?;
    let name = args.file.file.display().to_string();
    let extent = if args.periodic { Extent::Periodic } else { Extent::Finite };
    let mut summary = SurfaceSummary::of(&name, &topography, extent)?;
    if args.longest.is_some() || args.shortest.is_some() {
        summary = summary.fitted_as_asked(band[0], band[1])?;
    }
    summary.print(args.json, args.plot.as_deref(), args.force)
}
