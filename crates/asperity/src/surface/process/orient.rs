//! Turning a surface over.
//!
//! Two measured surfaces in contact were both measured from outside, but one of them faces the other way in the contact: [`flip`]
//! it along one axis.

use std::fmt;

use ndarray::s;

use super::Surface;
use crate::error::{Result, require};
use crate::grid::Grid;

/// An axis of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Axis {
    /// x, axis 0 of the heights.
    X,
    /// y, axis 1 of the heights.
    Y,
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Axis::X => "x",
            Axis::Y => "y",
        })
    }
}

/// The mirror image: along x, x becomes Lx - x.
pub fn flip(surface: &Surface, axis: Axis) -> Surface {
    let mut flipped = surface.clone();
    let heights = surface.heights();
    let mirrored = match axis {
        Axis::X => heights.slice(s![..;-1, ..]),
        Axis::Y => heights.slice(s![.., ..;-1]),
    };
    flipped.heights.assign(&mirrored);
    flipped
}

/// Turned by quarter turns from x towards y (anticlockwise with y up): once, (x, y) goes to (Ly - y, x).
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if the new grid is invalid, which is impossible for a valid surface.
pub fn rotate(surface: &Surface, quarter_turns: i32) -> Result<Surface> {
    let heights = surface.heights();
    let turned = match quarter_turns.rem_euclid(4) {
        0 => heights,
        1 => heights.reversed_axes().slice_move(s![..;-1, ..]),
        2 => heights.slice_move(s![..;-1, ..;-1]),
        _ => heights.reversed_axes().slice_move(s![.., ..;-1]),
    };
    let ([nx, ny], [lx, ly]) = (surface.grid().cells(), surface.grid().size());
    require(
        !surface.grid().is_line() || quarter_turns % 2 == 0,
        "number of quarter turns of a profile",
        quarter_turns,
        "even",
    )?;
    let grid = if quarter_turns % 2 == 0 { *surface.grid() } else { Grid::new([ny, nx], [ly, lx])? };
    Surface::new(grid, turned.to_owned())
}

/// Heights with the opposite sign: a replica becomes its original.
pub fn invert(surface: &Surface) -> Surface {
    let mut inverted = surface.clone();
    inverted.heights.mapv_inplace(|z| -z);
    inverted
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    fn surface() -> Surface {
        let grid = Grid::new([2, 3], [2.0, 6.0]).unwrap();
        Surface::new(grid, array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]).unwrap()
    }

    #[test]
    fn flips_mirror_one_axis() {
        assert_eq!(flip(&surface(), Axis::X).heights(), array![[4.0, 5.0, 6.0], [1.0, 2.0, 3.0]]);
        assert_eq!(flip(&surface(), Axis::Y).heights(), array![[3.0, 2.0, 1.0], [6.0, 5.0, 4.0]]);
        assert_eq!(flip(&flip(&surface(), Axis::X), Axis::X), surface());
    }

    #[test]
    fn a_quarter_turn_takes_x_to_y() {
        let once = rotate(&surface(), 1).unwrap();
        assert_eq!(once.grid().size(), [6.0, 2.0]);
        // The cell at the origin goes to the end of x, the start of y.
        assert_eq!(once.heights(), array![[3.0, 6.0], [2.0, 5.0], [1.0, 4.0]]);
        assert_eq!(rotate(&once, 3).unwrap(), surface());
        assert_eq!(rotate(&once, 1).unwrap(), rotate(&surface(), -2).unwrap());
        assert_eq!(rotate(&surface(), i32::MIN).unwrap(), surface()); // a multiple of four
    }

    #[test]
    fn inverting_twice_changes_nothing() {
        assert_eq!(invert(&surface()).heights()[[1, 2]], -6.0);
        assert_eq!(invert(&invert(&surface())), surface());
    }
}
