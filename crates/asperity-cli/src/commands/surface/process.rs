//! `asperity surface process`: a measured surface prepared step by step.

use asperity::surface::statistics::Extent;
use asperity_io::case::fragment;
use asperity_io::preparation::{Step, prepare};
use asperity_io::topography::Topography;

use crate::args::SurfaceProcess;
use crate::failure::Failure;
use crate::files::Files;
use crate::verb::Verb;

impl Verb for SurfaceProcess {
    fn files(&self) -> Files {
        self.to.files().reads([&self.file.file])
    }

    /// Reads, prepares, writes, and prints the statistics of what was written.
    fn run(&self) -> Result<(), Failure> {
        let format = super::target(&self.to.output, self.to.to.as_deref())?;
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
        let processed = Topography { format, ..processed };
        super::finish(&self.to, &processed, Extent::Finite, |summary| summary)
    }
}
