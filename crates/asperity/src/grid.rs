//! The computational domain: a rectangle of equal cells, x along axis 0.
//!
//! Cell (i, j) has its centre at ((i + 1/2) dx, (j + 1/2) dy) from the corner of the domain.
//! Fields on the grid are C-order arrays of shape (nx, ny).

use crate::error::{Error, Result, positive};

/// A rectangle Lx x Ly of nx x ny cells.
///
/// ```
/// let grid = asperity::Grid::new([4, 2], [2e-3, 1e-3])?;
/// assert_eq!(grid.spacing(), [0.5e-3, 0.5e-3]);
/// assert_eq!(grid.x(0), 0.25e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    cells: [usize; 2],
    size: [f64; 2],
}

/// Boundary condition of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Boundary {
    /// A half-space without pressure outside the domain (zero-padded convolution).
    #[default]
    Free,
    /// The domain repeats along x and y.
    Periodic,
}

impl Grid {
    /// A grid of `cells` = \[nx, ny\] over `size` = \[Lx, Ly\] in metres.
    ///
    /// # Errors
    /// [`Error::Invalid`] where a count is 0, a size is not positive and finite, the cells are
    /// more than 2^31, or a cell is longer than 1000 times its width.
    pub fn new(cells: [usize; 2], size: [f64; 2]) -> Result<Self> {
        for (count, axis) in cells.iter().zip(["x", "y"]) {
            if *count == 0 {
                return Err(Error::invalid(format!("number of cells along {axis}"), count, "at least 1"));
            }
        }
        for (length, axis) in size.iter().zip(["x", "y"]) {
            positive(&format!("size of the domain along {axis}"), *length, "m")?;
        }
        let product = cells[0].checked_mul(cells[1]);
        if product.is_none_or(|n| n > 1 << 31) {
            return Err(Error::invalid(
                "number of cells",
                format!("{} x {}", cells[0], cells[1]),
                "at most 2^31 in all",
            ));
        }
        let grid = Grid { cells, size };
        let [dx, dy] = grid.spacing();
        if !(dx / dy < 1e3 && dy / dx < 1e3) {
            return Err(Error::invalid(
                "cell",
                format!("{dx:e} m x {dy:e} m"),
                "no longer than 1000 times its width",
            ));
        }
        Ok(grid)
    }

    /// \[nx, ny\].
    pub fn cells(&self) -> [usize; 2] {
        self.cells
    }

    /// \[Lx, Ly\] in metres.
    pub fn size(&self) -> [f64; 2] {
        self.size
    }

    /// \[dx, dy\] in metres.
    pub fn spacing(&self) -> [f64; 2] {
        [self.size[0] / self.cells[0] as f64, self.size[1] / self.cells[1] as f64]
    }

    /// dx dy in square metres.
    pub fn cell_area(&self) -> f64 {
        let [dx, dy] = self.spacing();
        dx * dy
    }

    /// Lx Ly in square metres.
    pub fn area(&self) -> f64 {
        self.size[0] * self.size[1]
    }

    /// nx ny.
    #[allow(clippy::len_without_is_empty)] // a grid is never empty
    pub fn len(&self) -> usize {
        self.cells[0] * self.cells[1]
    }

    /// Shape of a field, as ndarray takes it.
    pub fn shape(&self) -> (usize, usize) {
        (self.cells[0], self.cells[1])
    }

    /// Centre of the cells of index i along x \[m\].
    pub fn x(&self, i: usize) -> f64 {
        (i as f64 + 0.5) * self.spacing()[0]
    }

    /// Centre of the cells of index j along y \[m\].
    pub fn y(&self, j: usize) -> f64 {
        (j as f64 + 0.5) * self.spacing()[1]
    }

    /// Centre of the domain \[m\].
    pub fn centre(&self) -> [f64; 2] {
        [0.5 * self.size[0], 0.5 * self.size[1]]
    }
}
