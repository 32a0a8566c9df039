//! `asperity surface info`: what a file holds, and the statistics of its heights as stored.

use asperity::surface::statistics::Extent;

use super::table::SurfaceSummary;
use crate::args::SurfaceInfo;
use crate::failure::Failure;
use crate::verb::{Paths, Verb};

impl Verb for SurfaceInfo {
    fn reads(&self) -> Paths<'_> {
        vec![Some(&self.file.file)]
    }

    fn writes(&self) -> Paths<'_> {
        vec![self.plot.as_ref()]
    }

    /// Prints the table or one JSON object, and draws the picture asked for.
    fn run(&self) -> Result<(), Failure> {
        super::table::check_plot(self.plot.as_deref(), self.force)?;
        let limit = |given: &Option<String>, default: f64| match given {
            Some(text) => super::length(text),
            None => Ok(default),
        };
        let band = [limit(&self.longest, f64::INFINITY)?, limit(&self.shortest, 0.0)?];
        if let Some(profile) = super::profile::open(&self.file)? {
            return super::profile::info(self, profile);
        }
        if self.cutoff.is_some() || self.circle.is_some() {
            let name = self.file.file.display();
            return Err(Failure::input(format!(
                "{name} is no profile: --cutoff and --circle are for two columns of text"
            )));
        }
        let topography = super::open(&self.file)?;
        let name = self.file.file.display().to_string();
        let extent = if self.periodic { Extent::Periodic } else { Extent::Finite };
        let mut summary = SurfaceSummary::of(&name, &topography, extent)?;
        if self.longest.is_some() || self.shortest.is_some() {
            summary = summary.fitted_as_asked(band[0], band[1])?;
        }
        summary.print(self.json, self.plot.as_deref(), self.force)
    }
}
