//! `asperity surface convert`: the same heights in another format.

use asperity_io::topography::write;

use crate::args::SurfaceConvert;
use crate::failure::Failure;
use crate::files::Files;
use crate::verb::Verb;

impl Verb for SurfaceConvert {
    fn files(&self) -> Files {
        Files::default().reads([&self.file.file]).writes([&self.output]).force(self.force)
    }

    /// Reads and writes.
    fn run(&self) -> Result<(), Failure> {
        let format = super::target(&self.output, self.to.as_deref())?;
        let topography = super::open(&self.file)?;
        Ok(write(&self.output, &topography, format)?)
    }
}
