//! Measured surfaces of a case: from a topography file to heights on the grid.

use std::ops::Range;
use std::path::PathBuf;

use asperity::Grid;
use asperity::surface::{Fill, Level, Part, fill, level};

use crate::topography::{ReadOptions, read};

/// A topography file of a case and what is done with it.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The file.
    pub path: PathBuf,
    /// Place of the path in the case file's source.
    pub(super) span: Range<usize>,
    /// Physical size \[m\], where the case gives one.
    pub size: Option<[f64; 2]>,
    /// Metres per unit of the heights, where the case gives one.
    pub height_unit: Option<f64>,
    /// What is taken off the heights.
    pub level: Level,
    /// What is done about undefined points.
    pub fill: Fill,
    /// Whether the heights change their sign.
    pub invert: bool,
}

/// Size of the file against size of the domain: they agree to this share.
const SAME: f64 = 1e-6;
/// More of a surface than this is not filled: it would be invention, not measurement.
const LARGEST_FILLED_SHARE: f64 = 0.25;

impl Measured {
    /// The heights as a part of the gap.
    ///
    /// # Errors
    /// A sentence: the file cannot be read, or does not fit the grid.
    pub fn part(&self, grid: &Grid) -> Result<Part, String> {
        let options =
            ReadOptions { size: self.size, height_unit: self.height_unit, ..ReadOptions::default() };
        let topography = read(&self.path, &options).map_err(|error| error.to_string())?;
        let (found, wanted) = (topography.heights.dim(), grid.shape());
        if found != wanted {
            return Err(format!(
                "{} holds {} x {} points, but the domain has {} x {} cells; set domain.cells = [{}, {}]",
                self.path.display(),
                found.0,
                found.1,
                wanted.0,
                wanted.1,
                found.0,
                found.1
            ));
        }
        let agree = |a: f64, b: f64| (a - b).abs() <= SAME * b;
        let [size, domain] = [topography.size, grid.size()];
        if !(agree(size[0], domain[0]) && agree(size[1], domain[1])) {
            return Err(format!(
                "{} measures {:e} m x {:e} m, but the domain {:e} m x {:e} m; set domain.size to the file's",
                self.path.display(),
                size[0],
                size[1],
                domain[0],
                domain[1]
            ));
        }
        // The form is fitted to what was measured, not to what fills the holes.
        let of_file = |error| format!("{}: {error}", self.path.display());
        let levelled = level(topography.heights.view(), self.level).map_err(of_file)?;
        let mut heights = fill(grid, levelled.view(), self.fill, LARGEST_FILLED_SHARE).map_err(of_file)?;
        if self.invert {
            heights.mapv_inplace(|z| -z);
        }
        Ok(Part::Heights { name: self.path.display().to_string(), heights })
    }
}
