//! Heights on a grid.

use ndarray::{Array2, ArrayView2};

use super::spectrum::check_shape;
use crate::error::Result;
use crate::grid::Grid;

/// Heights \[m\] at the cell centres of a grid, pointing out of their body; NaN if undefined.
///
/// ```
/// use asperity::{Grid, surface::Surface};
/// let grid = Grid::new([2, 3], [2e-6, 3e-6])?;
/// let surface = Surface::new(grid, ndarray::Array2::zeros((2, 3)))?;
/// assert_eq!(surface.undefined(), 0);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    pub(super) grid: Grid,
    pub(super) heights: Array2<f64>,
}

impl Surface {
    /// Heights of shape (nx, ny) on their grid; heights that are not finite become NaN, undefined.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the heights do not have the shape of the grid.
    pub fn new(grid: Grid, mut heights: Array2<f64>) -> Result<Self> {
        check_shape(&grid, heights.view())?;
        heights.par_mapv_inplace(|z| if z.is_finite() { z } else { f64::NAN });
        // C order for any input.
        if !heights.is_standard_layout() {
            heights = heights.as_standard_layout().into_owned();
        }
        Ok(Surface { grid, heights })
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The heights \[m\], shape (nx, ny).
    pub fn heights(&self) -> ArrayView2<'_, f64> {
        self.heights.view()
    }

    /// The heights \[m\], shape (nx, ny), in C order.
    pub fn into_heights(self) -> Array2<f64> {
        self.heights
    }

    /// Number of undefined points.
    pub fn undefined(&self) -> usize {
        self.heights.iter().filter(|z| z.is_nan()).count()
    }
}
