//! `asperity surface info`: what a file holds, and the statistics of its heights as stored.

use asperity_io::quantity::Length;

use super::table::SurfaceSummary;
use crate::args::SurfaceInfo;
use crate::failure::{Failure, refuse};
use crate::files::Files;
use crate::verb::Verb;

impl Verb for SurfaceInfo {
    fn files(&self) -> Files {
        Files::default().reads([&self.file.file]).draws(&self.plot).force(self.force)
    }

    /// Prints the table or one JSON object, and draws the picture asked for.
    fn run(&self) -> Result<(), Failure> {
        if let Some(profile) = super::profile::open(&self.file)? {
            return super::profile::info(self, profile);
        }
        if self.cutoff.is_some() || self.circle.is_some() {
            let name = self.file.file.display();
            refuse!("{name} is no profile: --cutoff and --circle are for two columns of text");
        }
        let topography = super::open(&self.file)?;
        let name = self.file.file.display().to_string();
        let extent = super::extent(&topography, self.periodic);
        let mut summary = SurfaceSummary::of(&name, &topography, extent)?;
        if self.longest.is_some() || self.shortest.is_some() {
            let limit = |given: Option<Length>, usual: f64| given.map_or(usual, Length::get);
            summary =
                summary.fitted_as_asked(limit(self.longest, f64::INFINITY), limit(self.shortest, 0.0))?;
        }
        summary.print(self.json, self.plot.as_deref(), self.force)
    }
}
