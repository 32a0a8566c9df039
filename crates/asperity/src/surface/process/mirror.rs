//! A measured surface continued by its reflections.
//!
//! Opposite borders of a measured surface do not match, but a map beside its mirror image always does. The map and its reflections
//! in x, in y and in both make a surface of twice the length and width,
//!
//! ```text
//! z(i, j), z(2 nx - 1 - i, j), z(i, 2 ny - 1 - j), z(2 nx - 1 - i, 2 ny - 1 - j)   0 <= i < nx, 0 <= j < ny
//! ```
//!
//! which repeats: the cells on both sides of each seam are equal (half-sample symmetry, that of the cosine transform DCT-II). No height
//! changes, and a valley that reaches the border goes on in its reflection. What the continuation adds is symmetry: the
//! conductance of such a surface has no part off the diagonal, and it slides alike along +x and -x.

use ndarray::{Array2, s};

use super::Surface;
use crate::error::Result;
use crate::grid::Grid;

/// The surface and its reflections: 2 nx x 2 ny cells of the same size; of a profile 2 nx.
///
/// ```
/// use asperity::{Grid, surface::{Surface, process::mirror}};
/// let heights = ndarray::array![[1.0, 2.0], [3.0, 4.0]];
/// let whole = mirror(&Surface::new(Grid::new([2, 2], [2e-6, 4e-6])?, heights)?)?;
/// assert_eq!(whole.heights(), ndarray::array![
///     [1.0, 2.0, 2.0, 1.0], [3.0, 4.0, 4.0, 3.0], [3.0, 4.0, 4.0, 3.0], [1.0, 2.0, 2.0, 1.0]]);
/// assert_eq!(whole.grid().size(), [4e-6, 8e-6]);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if the surface is so long that twice the length is no length.
pub fn mirror(surface: &Surface) -> Result<Surface> {
    let ([nx, ny], [lx, ly]) = (surface.grid().cells(), surface.grid().size());
    let line = surface.grid().is_line();
    let grid =
        if line { Grid::line(2 * nx, 2.0 * lx)? } else { Grid::new([2 * nx, 2 * ny], [2.0 * lx, 2.0 * ly])? };
    let heights = surface.heights();
    let mut whole = Array2::zeros(grid.shape());
    whole.slice_mut(s![..nx, ..ny]).assign(&heights);
    whole.slice_mut(s![nx.., ..ny]).assign(&heights.slice(s![..;-1, ..]));
    if !line {
        whole.slice_mut(s![..nx, ny..]).assign(&heights.slice(s![.., ..;-1]));
        whole.slice_mut(s![nx.., ny..]).assign(&heights.slice(s![..;-1, ..;-1]));
    }
    Surface::new(grid, whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_seam_has_equal_cells_on_both_sides_and_the_distribution_of_heights_stays() {
        let heights = Array2::from_shape_fn((5, 3), |(i, j)| ((7 * i + 3 * j * j) % 11) as f64);
        let surface = Surface::new(Grid::new([5, 3], [5e-6, 6e-6]).unwrap(), heights).unwrap();
        let whole = mirror(&surface).unwrap();
        let z = whole.heights();
        assert_eq!((whole.grid().cells(), whole.grid().spacing()), ([10, 6], surface.grid().spacing()));
        for (i, j) in (0..10).flat_map(|i| (0..6).map(move |j| (i, j))) {
            assert_eq!(z[[i, j]], surface.heights()[[i.min(9 - i), j.min(5 - j)]]);
        }
    }

    #[test]
    fn a_profile_is_continued_along_x_and_undefined_points_with_it() {
        let heights = ndarray::array![[1.0], [f64::NAN], [3.0]];
        let whole = mirror(&Surface::new(Grid::line(3, 3e-6).unwrap(), heights).unwrap()).unwrap();
        assert!(whole.grid().is_line() && whole.grid().size()[0] == 6e-6);
        let z: Vec<f64> = whole.heights().iter().copied().collect();
        assert_eq!((z[0], z[2], z[3], z[5]), (1.0, 3.0, 3.0, 1.0));
        assert!(z[1].is_nan() && z[4].is_nan());
    }
}
