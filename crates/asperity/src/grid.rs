//! The computational domain: a rectangle of equal cells, x along axis 0, or a line of cells in plane strain.
//!
//! Cell (i, j) has its centre at ((i + 1/2) dx, (j + 1/2) dy) from the corner of the domain.
//! Fields on the grid are C-order arrays of shape (nx, ny).

use crate::error::{Result, length, require};

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
    line: bool,
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

impl Boundary {
    /// The cell that is `step` cells from cell n of `count` along an axis; `None` beyond the ends of a free domain.
    pub(crate) fn beside(self, n: usize, step: isize, count: usize) -> Option<usize> {
        let at = n as isize + step;
        match self {
            Boundary::Periodic => Some(at.rem_euclid(count as isize) as usize),
            Boundary::Free => (0..count as isize).contains(&at).then_some(at as usize),
        }
    }
}

impl Grid {
    /// A grid of `cells` = \[nx, ny\] over `size` = \[Lx, Ly\] in metres.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a count is 0, a size is not from 1e-60 m to 1e60 m, there are more than 2^31 cells, or a cell is
    /// longer than 1000 times its width.
    pub fn new(cells: [usize; 2], size: [f64; 2]) -> Result<Self> {
        for (count, axis) in cells.iter().zip(["x", "y"]) {
            require(*count > 0, format!("number of cells along {axis}"), count, "at least 1")?;
        }
        for (side, axis) in size.iter().zip(["x", "y"]) {
            length(&format!("size of the domain along {axis}"), *side)?;
        }
        let product = cells[0].checked_mul(cells[1]);
        require(
            product.is_some_and(|n| n <= 1 << 31),
            "number of cells",
            format!("{} x {}", cells[0], cells[1]),
            "at most 2^31 in all",
        )?;
        let grid = Grid { cells, size, line: false };
        let [dx, dy] = grid.spacing();
        require(
            dx / dy < 1e3 && dy / dx < 1e3,
            "cell",
            format!("{dx:e} m x {dy:e} m"),
            "no longer than 1000 times its width",
        )?;
        Ok(grid)
    }

    /// A line of cells along x in plane strain: nothing changes along y. The grid has one cell along y, one metre long, so loads,
    /// areas and energies are per metre: \[N/m\], \[m\] and \[J/m\].
    ///
    /// ```
    /// let grid = asperity::Grid::line(4, 2e-3)?;
    /// assert_eq!((grid.cells(), grid.spacing()), ([4, 1], [0.5e-3, 1.0]));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the count is 0 or more than 2^31, or the length is not from 1e-60 m to 1e60 m.
    pub fn line(cells: usize, side: f64) -> Result<Self> {
        length("size of the domain along x", side)?;
        require((1..=1 << 31).contains(&cells), "number of cells along x", cells, "between 1 and 2^31")?;
        Ok(Grid { cells: [cells, 1], size: [side, 1.0], line: true })
    }

    /// The same domain with another number of cells; for a line, the number along y is 1.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) as [`Grid::new`].
    pub fn with_cells(&self, cells: [usize; 2]) -> Result<Self> {
        if self.line { Grid::line(cells[0], self.size[0]) } else { Grid::new(cells, self.size) }
    }

    /// Whether it is a line of cells in plane strain.
    pub fn is_line(&self) -> bool {
        self.line
    }

    /// Number of directions in which fields vary: 1 for a line, otherwise 2.
    pub fn dimensions(&self) -> usize {
        if self.line { 1 } else { 2 }
    }

    /// The unit of a quantity with the unit `units` on a surface: on a line, forces, areas and energies are per length.
    ///
    /// ```
    /// use asperity::Grid;
    /// assert_eq!(Grid::line(4, 1e-3)?.units("N"), "N/m");
    /// assert_eq!(Grid::new([4, 4], [1e-3, 1e-3])?.units("N"), "N");
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn units(&self, units: &'static str) -> &'static str {
        match units {
            "N" if self.line => "N/m",
            "m2" if self.line => "m",
            "m3" if self.line => "m2",
            "J" if self.line => "J/m",
            "W" if self.line => "W/m",
            "N m" if self.line => "N",
            "N/m" if self.line => "N/m2",
            units => units,
        }
    }

    /// Lengths of the domain in the directions in which fields vary \[m\].
    pub fn extents(&self) -> &[f64] {
        &self.size[..self.dimensions()]
    }

    /// Longest side of the domain \[m\].
    pub fn longest_side(&self) -> f64 {
        self.extents().iter().fold(0.0, |most, side| side.max(most))
    }

    /// Shortest side of the domain \[m\].
    pub fn shortest_side(&self) -> f64 {
        self.extents().iter().fold(f64::INFINITY, |least, side| side.min(least))
    }

    /// Sides of a cell in the directions in which fields vary \[m\].
    pub fn cell_sides(&self) -> impl Iterator<Item = f64> {
        self.spacing().into_iter().take(self.dimensions())
    }

    /// Longest side of a cell \[m\].
    pub fn longest_cell(&self) -> f64 {
        self.cell_sides().fold(0.0, f64::max)
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

    /// Shape of a field for ndarray.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_whose_products_are_no_numbers_are_refused() {
        for side in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
            assert!(Grid::new([4, 4], [side, side]).is_err() && Grid::line(4, side).is_err(), "{side}");
        }
        assert!(Grid::new([4, 4], [1e-60, 1e-60]).is_ok() && Grid::line(4, 1e60).is_ok());
    }
}
