//! `asperity surface convert`: the same heights in another format.

use asperity_io::topography::write;

use crate::args::SurfaceConvert;
use crate::failure::Failure;
use crate::verb::{Paths, Verb};

impl Verb for SurfaceConvert {
    fn reads(&self) -> Paths<'_> {
        vec![Some(&self.file.file)]
    }

    fn writes(&self) -> Paths<'_> {
        vec![Some(&self.output)]
    }

    /// Reads and writes.
    fn run(&self) -> Result<(), Failure> {
        let format = super::target(&self.output, self.to.as_deref(), self.force)?;
        let topography = super::open(&self.file)?;
        write(&self.output, &topography, format).map_err(Failure::of)
    }
}
