//! `asperity surface process`: a measured surface or profile prepared step by step.

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
        let steps = super::steps(&self.op)?;
        if let Some(profile) = super::profile::open(&self.file)? {
            return super::profile::process(self, profile, format, &steps);
        }
        let mut topography = super::open(&self.file)?;
        let name = self.file.file.display().to_string();
        let prepared = super::prepared(&name, super::map(&name, &topography)?, &steps)?;
        topography.record(prepared.history);
        let size = prepared.surface.grid().size();
        let processed = Topography { heights: prepared.surface.into_heights(), size, ..topography };
        let processed = Topography { format, ..processed };
        let extent = super::extent(&processed, false);
        super::finish(&self.to, &processed, extent, |summary| summary)
    }
}
