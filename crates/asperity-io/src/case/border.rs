//! What the preparation of its surfaces says about the border of a periodic domain.

use asperity::surface::process::Border;

use super::Case;
use super::plan::Surface;
use crate::preparation::border;

impl Case {
    /// Reads the measured surfaces, so that it is known what was done to them. One that cannot be read is told with the gap.
    pub(super) fn read_surfaces(&self) {
        for surface in &self.surfaces {
            if let Surface::File(file) = surface {
                let _ = file.prepared(Some(self.conditions.grid.cells()));
            }
        }
    }

    /// Names of the windowed surfaces, of those that were read.
    pub(super) fn windowed(&self) -> Vec<String> {
        let windowed = self.surfaces.iter().filter(|surface| border_of(surface) == Border::Windowed);
        windowed.map(Surface::name).collect()
    }

    /// Whether a surface was continued by its reflections, of those that were read.
    pub fn is_mirrored(&self) -> bool {
        self.surfaces.iter().any(|surface| border_of(surface) == Border::Mirrored)
    }
}

fn border_of(surface: &Surface) -> Border {
    surface.history().map_or(Border::AsMeasured, |history| border(&history))
}
