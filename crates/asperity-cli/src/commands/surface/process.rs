//! `asperity surface process`: a measured surface prepared step by step.

use asperity::surface::statistics::Extent;
use asperity_io::case::fragment;
use asperity_io::preparation::{Step, prepare};
use asperity_io::topography::Topography;

use super::table::SurfaceSummary;
use crate::args::SurfaceProcess;
use crate::failure::Failure;
use crate::verb::{Paths, Verb};

impl Verb for SurfaceProcess {
    fn reads(&self) -> Paths<'_> {
        vec![Some(&self.file.file)]
    }

    fn writes(&self) -> Paths<'_> {
        vec![Some(&self.to.output), self.to.plot.as_ref()]
    }

    /// Reads, prepares, writes, and prints the statistics of what was written.
    fn run(&self) -> Result<(), Failure> {
        let format = super::targets(&self.to)?;
        let steps: Vec<Step> = self
            .op
            .iter()
            .map(|words| fragment::step(words).map_err(|reason| Failure::input(format!("--op {reason}"))))
            .collect::<Result<_, _>>()?;
        let mut topography = super::open(&self.file)?;
        let name = self.file.file.display().to_string();
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
        super::save(&self.to, &processed, format)?;
        let written = self.to.output.display().to_string();
        let processed = Topography { format, ..processed };
        SurfaceSummary::of(&written, &processed, Extent::Finite)?.print(
            self.to.json,
            self.to.plot.as_deref(),
            self.to.force,
        )
    }
}
