//! Keeping a rectangle of cells.

use ndarray::s;

use super::Surface;
use crate::error::{Result, require};
use crate::grid::Grid;

/// The `cells` = \[nx, ny\] cells from `from` = \[i, j\] on; the cells keep their size.
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if the rectangle is empty or not inside the surface.
pub fn crop(surface: &Surface, from: [usize; 2], cells: [usize; 2]) -> Result<Surface> {
    let (whole, [dx, dy]) = (surface.grid().cells(), surface.grid().spacing());
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let end = from[axis].checked_add(cells[axis]);
        require(
            cells[axis] > 0 && end.is_some_and(|end| end <= whole[axis]),
            format!("cells to keep along {name}"),
            format!("{} from {}", cells[axis], from[axis]),
            format!("at least 1, within the {} of the surface", whole[axis]),
        )?;
    }
    let kept = s![from[0]..from[0] + cells[0], from[1]..from[1] + cells[1]];
    let size = [dx * cells[0] as f64, dy * cells[1] as f64];
    let grid =
        if surface.grid().is_line() { Grid::line(cells[0], size[0])? } else { Grid::new(cells, size)? };
    Surface::new(grid, surface.heights().slice(kept).to_owned())
}

/// The smallest rectangle that contains every defined point, as arguments of `crop` (first cell, cells); `None` if no point is
/// defined.
pub fn defined_extent(surface: &Surface) -> Option<([usize; 2], [usize; 2])> {
    let mut range: Option<([usize; 2], [usize; 2])> = None;
    for ((i, j), _) in surface.heights().indexed_iter().filter(|(_, z)| !z.is_nan()) {
        let (low, high) = range.unwrap_or(([i, j], [i, j]));
        range = Some(([low[0].min(i), low[1].min(j)], [high[0].max(i), high[1].max(j)]));
    }
    range.map(|(low, high)| (low, [high[0] - low[0] + 1, high[1] - low[1] + 1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    fn surface() -> Surface {
        let heights = Array2::from_shape_fn((5, 4), |(i, j)| (10 * i + j) as f64);
        Surface::new(Grid::new([5, 4], [10.0, 2.0]).unwrap(), heights).unwrap()
    }

    #[test]
    fn the_cells_kept_keep_their_size_and_heights() {
        let part = crop(&surface(), [1, 2], [3, 2]).unwrap();
        assert_eq!(part.grid().spacing(), [2.0, 0.5]);
        assert_eq!(part.heights(), ndarray::array![[12.0, 13.0], [22.0, 23.0], [32.0, 33.0]]);
    }

    #[test]
    fn rectangles_that_do_not_fit_are_refused() {
        for (from, cells) in [([0, 0], [6, 1]), ([4, 0], [2, 1]), ([0, 0], [1, 0]), ([0, usize::MAX], [1, 2])]
        {
            assert!(crop(&surface(), from, cells).is_err(), "{from:?} {cells:?}");
        }
    }

    #[test]
    fn the_defined_part_is_framed() {
        let mut heights = Array2::from_elem((5, 4), f64::NAN);
        let grid = *surface().grid();
        assert_eq!(defined_extent(&Surface::new(grid, heights.clone()).unwrap()), None);
        heights[[1, 3]] = 0.0;
        heights[[3, 2]] = 0.0;
        let framed = defined_extent(&Surface::new(grid, heights).unwrap());
        assert_eq!(framed, Some(([1, 2], [3, 2])));
    }
}
