//! Preparation of measured surfaces: pure functions from a [`Surface`] to another one, and [`Operation`], the same steps as a
//! list that can be stored, so that a result documents the preparation of its surface.
//!
//! Steps that work point by point keep undefined points (NaN). Steps that need every point (filters, resampling by waves) return
//! an error.

mod border;
mod crop;
mod filter;
mod mirror;
mod orient;
mod outliers;
mod resample;
mod window;

pub use border::Border;
pub use crop::{crop, defined_extent};
pub use filter::{Band, Edge, filter};
pub use mirror::mirror;
pub use orient::{Axis, flip, invert, rotate};
pub use outliers::{Outliers, remove_outliers};
pub use resample::{Resampling, resample};
pub use window::{Window, window, window_for_spectrum};

use std::fmt;

use super::profile::remove_circle;
use super::{Fill, Level, Surface, fill, level};
use crate::error::{Result, require};

/// One step of the preparation of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// [`level()`]: subtract the least-squares form.
    Level(Level),
    /// [`fill()`]: fill undefined points, up to a given share of all points.
    Fill {
        /// How.
        method: Fill,
        /// Largest share of undefined points that is accepted, 0 to 1.
        largest_share: f64,
    },
    /// [`crop()`]: keep a rectangle of cells.
    Crop {
        /// First cell kept along x and y.
        from: [usize; 2],
        /// Cells kept along x and y.
        cells: [usize; 2],
    },
    /// [`resample()`]: other cells over the same size.
    Resample {
        /// Cells along x and y.
        cells: [usize; 2],
        /// How.
        method: Resampling,
    },
    /// [`filter()`]: keep a band of wavelengths.
    Filter(Band),
    /// [`flip`]: mirror along an axis.
    Flip(Axis),
    /// [`rotate`]: quarter turns from x towards y.
    Rotate {
        /// Number of quarter turns.
        quarter_turns: i32,
    },
    /// [`invert`]: change the sign of the heights.
    Invert,
    /// [`window()`]: fade to zero at the edges.
    Window(Window),
    /// [`mirror()`]: continue by reflections.
    Mirror,
    /// [`remove_circle`]: subtract a circle from a profile.
    RemoveCircle {
        /// Its radius \[m\]; `None`: the radius that fits best.
        radius: Option<f64>,
    },
    /// [`remove_outliers`]: make spikes undefined.
    RemoveOutliers(Outliers),
}

impl Operation {
    /// The surface after this step.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) as the function of this step.
    pub fn apply(&self, surface: &Surface) -> Result<Surface> {
        let grid = *surface.grid();
        match *self {
            Operation::Level(form) => Surface::new(grid, level(surface.heights(), form)?),
            Operation::Fill { method, largest_share } => {
                Surface::new(grid, fill(&grid, surface.heights(), method, largest_share)?)
            }
            Operation::Crop { from, cells } => crop(surface, from, cells),
            Operation::Resample { cells, method } => resample(surface, cells, method),
            Operation::Filter(band) => filter(surface, band),
            Operation::Flip(axis) => Ok(flip(surface, axis)),
            Operation::Rotate { quarter_turns } => rotate(surface, quarter_turns),
            Operation::Invert => Ok(invert(surface)),
            Operation::Window(shape) => window(surface, shape),
            Operation::Mirror => mirror(surface),
            Operation::RemoveOutliers(outliers) => remove_outliers(surface, outliers),
            Operation::RemoveCircle { radius } => without_circle(surface, radius),
        }
    }
}

/// A profile without its circle.
fn without_circle(surface: &Surface, radius: Option<f64>) -> Result<Surface> {
    let grid = *surface.grid();
    require(
        grid.is_line(),
        "surface to subtract a circle from",
        "a plane",
        "a profile, heights on a line of cells",
    )?;
    let heights: Vec<f64> = surface.heights().iter().copied().collect();
    let (flat, _) = remove_circle(&heights, grid.spacing()[0], radius)?;
    let mut left = surface.clone();
    left.heights.iter_mut().zip(flat).for_each(|(z, flat)| *z = flat);
    Ok(left)
}

/// The surface after all steps in order.
///
/// ```
/// use asperity::{Grid, surface::{Fill, Level, Operation, Surface, process}};
/// let heights = ndarray::array![[0.0, 1.0, 2.0], [1.0, f64::NAN, 3.0], [2.0, 3.0, 4.0]];
/// let surface = Surface::new(Grid::new([3, 3], [1.0, 1.0])?, heights)?;
/// let steps = [
///     Operation::Fill { method: Fill::Harmonic, largest_share: 0.2 },
///     Operation::Level(Level::Plane),
/// ];
/// let flat = process::apply(&surface, &steps)?;
/// assert!(flat.heights().iter().all(|z| z.abs() < 1e-11));
/// assert_eq!(steps[0].to_string(), "fill undefined points (harmonic, at most 20 %)");
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) of the first step that fails.
pub fn apply(surface: &Surface, steps: &[Operation]) -> Result<Surface> {
    steps.iter().try_fold(surface.clone(), |surface, step| step.apply(&surface))
}

impl fmt::Display for Operation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Operation::Level(form) => {
                let form = match form {
                    Level::None => "nothing",
                    Level::Mean => "the mean",
                    Level::Plane => "the plane",
                    Level::Quadratic => "the quadratic",
                };
                write!(f, "subtract {form} (least squares)")
            }
            Operation::Fill { method, largest_share } => {
                let method = match method {
                    Fill::Error => "none allowed",
                    Fill::Harmonic => "harmonic",
                    Fill::Nearest => "nearest",
                };
                write!(f, "fill undefined points ({method}, at most {} %)", 100.0 * largest_share)
            }
            Operation::Crop { from, cells } => {
                let (cut, [nx, ny], [i, j]) = (border::CUT, cells, from);
                write!(f, "{cut} {nx} x {ny} cells from ({i}, {j})")
            }
            Operation::Resample { cells, method } => {
                let method = match method {
                    Resampling::BandLimited => "band-limited",
                    Resampling::Bilinear => "bilinear",
                };
                write!(f, "resample to {} x {} cells ({method})", cells[0], cells[1])
            }
            Operation::RemoveCircle { radius: None } => write!(f, "subtract the circle that fits best"),
            Operation::RemoveCircle { radius: Some(radius) } => {
                write!(f, "subtract a circle of radius {radius:.6e} m (least squares)")
            }
            Operation::Filter(band) => write!(f, "{band}"),
            Operation::Flip(axis) => write!(f, "flip along {axis}"),
            Operation::Rotate { quarter_turns } => write!(f, "rotate by {quarter_turns} quarter turns"),
            Operation::Invert => write!(f, "invert"),
            Operation::Window(shape) => write!(f, "{shape}"),
            Operation::Mirror => f.write_str(border::MIRRORED),
            Operation::RemoveOutliers(outliers) => {
                write!(
                    f,
                    "remove outliers (beyond {} deviations from the lines through the points {} cells around)",
                    outliers.threshold, outliers.radius
                )
            }
        }
    }
}
