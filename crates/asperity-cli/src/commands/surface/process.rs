//! `asperity surface process`: a measured surface prepared step by step.

use asperity::surface::statistics::Extent;
use asperity_io::case::fragment;
use asperity_io::preparation::{Step, prepare};
use asperity_io::topography::Topography;

use super::table::SurfaceSummary;
use crate::args::SurfaceProcess;
use crate::failure::Failure;

/// Reads, prepares, writes, and prints the statistics of what was written.
pub fn run(args: &SurfaceProcess) -> Result<(), Failure> {
    let format = super::targets(&args.to)?;
    let steps: Vec<Step> = args
        .op
        .iter()
        .map(|words| fragment::step(words).map_err(|reason| Failure::input(format!("--op {reason}"))))
        .collect::<Result<_, _>>()?;
    let mut topography = super::open(&args.file)?;
    let name = args.file.file.display().to_string();
    let failed = |error: asperity::Error| {
        // There is no domain here.
        let reason = error
            .to_string()
            .replace("as `cells` of the step or as `domain.cells` of the case", "cells=NX,NY");
        Failure::input(format!("{name}: {reason}"))
    };
    let prepared = prepare(super::map(&name, &topography)?, &steps, None).map_err(failed)?;
    topography.record(prepared.history);
    let size = prepared.surface.grid().size();
    let processed = Topography { heights: prepared.surface.into_heights(), size, ..topography };
    super::save(&args.to, &processed, format)?;
    let written = args.to.output.display().to_string();
    let processed = Topography { format, ..processed };
    SurfaceSummary::of(&written, &processed, Extent::Finite)?.print(
        args.to.json,
        args.to.plot.as_deref(),
        args.to.force,
    )
}
