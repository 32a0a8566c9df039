//! The free domain, u(i, j) = sum K(i - i', j - j') p(i', j') with no pressure outside: by influence coefficients and zero-padded
//! convolution (DC-FFT: Liu, Wang & Liu, Wear 243, 2000).

use ndarray::{Array1, Array2};

use crate::convolution::Convolution;
use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::kernel::Kernel;

/// The influence coefficients on the quadrant of the padded torus.
pub(super) fn influence(grid: &Grid, kernel: &dyn Kernel) -> Result<Array2<f64>> {
    kernel.check(grid.longest_cell())?;
    let influence = match grid.is_line() {
        true => of_strips(kernel.strip(grid.spacing()[0], computed(grid)[0])?, padded(grid)[1]),
        false => kernel.influence(grid.spacing(), computed(grid))?,
    };
    plausible(&influence)?;
    Ok(influence)
}

/// The coefficients of a line as those of a grid with one cell along y, on a torus that is so long along y.
pub(super) fn of_strips(strips: Vec<f64>, across: usize) -> Array2<f64> {
    let mut influence = Array2::zeros((strips.len(), across / 2 + 1));
    influence.column_mut(0).assign(&Array1::from(strips));
    influence
}

/// Lengths of the transforms.
pub(super) fn padded(grid: &Grid) -> [usize; 2] {
    grid.cells().map(|n| Convolution::good_length(2 * n - 1))
}

/// Coefficients along x and y: the quadrant of the padded torus. Beyond the domain the true coefficients go on: no output
/// of the domain reads them, and the kernel stays smooth and its spectrum positive.
pub(super) fn computed(grid: &Grid) -> [usize; 2] {
    padded(grid).map(|length| length / 2 + 1)
}

/// A positive definite kernel is largest at its centre.
///
/// The spectrum on the padded torus may be negative in places, where the response reaches beyond the domain: the torus is not
/// the body. On the domain K is positive as long as the symbol of the body is.
pub(super) fn plausible(influence: &Array2<f64>) -> Result<()> {
    let most =
        influence.iter().fold(0.0, |most: f64, k| if k.is_nan() { f64::NAN } else { most.max(k.abs()) });
    let own = influence[(0, 0)];
    match own > 0.0 && own.is_finite() && most <= own {
        true => Ok(()),
        false => Err(Error::invalid(
            "largest influence of a cell on another over that on itself",
            format!("{:e}", most / own),
            "less than 1: the cells are too coarse for the body; take smaller ones, or a periodic domain",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::convolution::even_spectrum;
    use crate::kernel::HalfSpace;

    #[test]
    fn the_spectrum_is_positive_for_any_shape() {
        for (cells, size) in [
            ([1, 1], [1.0, 1.0]),
            ([3, 50], [1.0, 1.0]),
            ([64, 64], [1.0, 1.0]),
            ([33, 17], [1.0, 4.0]),
            ([65, 129], [3.0, 2.0]),
        ] {
            let grid = Grid::new(cells, size).unwrap();
            let spectrum = even_spectrum(&influence(&grid, &HalfSpace).unwrap(), padded(&grid));
            assert!(spectrum.iter().all(|s| *s > 0.0), "{cells:?} {size:?}");
        }
        for cells in [2, 3, 17, 64, 1000] {
            let grid = Grid::line(cells, 1e-3).unwrap();
            let spectrum = even_spectrum(&influence(&grid, &HalfSpace).unwrap(), padded(&grid));
            assert!(spectrum.iter().all(|s| *s > 0.0), "a line of {cells}");
        }
    }
}
