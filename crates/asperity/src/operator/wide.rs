//! A torus twice as wide as the convolution of a free domain needs, on which the kernel fades out smoothly.
//!
//! On the torus of the convolution the kernel has a kink where it is cut off. It does not matter to the domain, but it adds to all waves,
//! and spoils those to which the body hardly yields: stiff layers on a soft base. With room to spare the kernel is continued at
//! distances that grow ever more slowly, and stand still on the opposite side,
//!
//! ```text
//! K(ρ(x), ρ(y)),   ρ(x) = x in the domain,   ρ = n + (h - n) S((x - n)/(h - n)) beyond,   h = half the torus
//! S(t) = t - 7 t⁵ + 14 t⁶ - 10 t⁷ + 2.5 t⁸:  S' falls from 1 to 0, with three smooth derivatives at both ends
//! ```
//!
//! so that its spectrum is that of the body up to a small and smooth part.

use ndarray::{Array2, s};

use super::free::{computed, of_strips, padded, plausible};
use crate::convolution::{Convolution, even_spectrum};
use crate::error::Result;
use crate::grid::Grid;
use crate::kernel::Kernel;
use crate::layer::Layered;

/// Sides of the torus over those of the domain.
const WIDTH: usize = 4;

/// Lengths of the torus.
pub(crate) fn lengths(grid: &Grid) -> [usize; 2] {
    let across = if grid.is_line() { 1 } else { WIDTH };
    let [nx, ny] = grid.cells();
    [Convolution::good_length(WIDTH * nx), Convolution::good_length(across * ny)]
}

/// The eigenvalues of K on it, those of a quarter of the waves, \[kx\]\[ky\] \[m\].
///
/// # Errors
/// As [`plan`](super::plan).
pub(crate) fn eigenvalues(grid: &Grid, kernel: &Layered) -> Result<Array2<f64>> {
    kernel.check(grid.longest_cell())?;
    let (cells, cell, lengths) = (grid.cells(), grid.spacing(), lengths(grid));
    let [xs, ys] = [0, 1].map(|k| distances(cells[k], lengths[k], cell[k]));
    let influence = match grid.is_line() {
        true => of_strips(kernel.response_of_line(cell[0], &xs)?, lengths[1]),
        false => kernel.response(cell, [&xs, &ys])?,
    };
    plausible(&influence)?;
    Ok(even_spectrum(&influence, lengths))
}

/// The eigenvalues on the torus of the convolution of the kernel that has these on the wide one.
pub(crate) fn narrowed(grid: &Grid, eigenvalues: &Array2<f64>) -> Array2<f64> {
    let (lengths, [nx, ny]) = (lengths(grid), computed(grid));
    // A transform of an even field is its own inverse, but for the number of cells.
    let mut influence = even_spectrum(eigenvalues, lengths).slice(s![..nx, ..ny]).to_owned();
    influence /= (lengths[0] * lengths[1]) as f64;
    even_spectrum(&influence, padded(grid))
}

/// The distances that stand for those of a quadrant along one side \[m\].
fn distances(n: usize, length: usize, cell: f64) -> Vec<f64> {
    let (last, half) = (n as f64 - 1.0, 0.5 * length as f64);
    let distance = |i: usize| {
        let t = (i as f64 - last) / (half - last);
        match t > 0.0 {
            true => last + (half - last) * (t + t.powi(5) * (-7.0 + t * (14.0 + t * (-10.0 + t * 2.5)))),
            false => i as f64,
        }
    };
    (0..=length / 2).map(|i| cell * distance(i)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layer::{Base, Interface, Layer, Stack};

    fn coated(shear: f64) -> Layered {
        let coating = Layer { thickness: 2.0, shear, poisson: 0.3, interface: Interface::Bonded };
        let base = Base::HalfSpace { shear: 1.0, poisson: 0.5 };
        Layered::new(vec![Stack::new(vec![coating], base).unwrap()]).unwrap()
    }

    #[test]
    fn what_a_domain_sees_is_the_body() {
        // Sides of different lengths, odd and even.
        let grid = Grid::new([24, 31], [24.0, 31.0]).unwrap();
        let kernel = coated(20.0);
        let [narrow, exact] = [
            narrowed(&grid, &eigenvalues(&grid, &kernel).unwrap()),
            super::super::eigenvalues(&grid, crate::Boundary::Free, &kernel).unwrap(),
        ];
        let coefficients =
            |spectrum: &Array2<f64>| even_spectrum(spectrum, padded(&grid)) / spectrum.len() as f64;
        let (a, b) = (coefficients(&narrow), coefficients(&exact));
        for i in 0..24 {
            for j in 0..31 {
                // Roundings of three transforms.
                assert!(
                    (a[(i, j)] - b[(i, j)]).abs() < 1e-13 * b[(0, 0)],
                    "{i} {j}: {} {}",
                    a[(i, j)],
                    b[(i, j)]
                );
            }
        }
    }

    #[test]
    fn distances_stand_still_on_the_opposite_side() {
        let all = distances(32, 128, 0.5);
        assert_eq!((all.len(), all[31]), (65, 15.5));
        let steps: Vec<f64> = all.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(steps.windows(2).all(|pair| pair[1] <= pair[0] + 1e-12) && steps[63] < 1e-3, "{steps:?}");
    }

    #[test]
    fn waves_of_a_stiff_coating_yield_as_those_of_the_body() {
        let grid = Grid::new([32, 32], [32.0, 32.0]).unwrap();
        let kernel = coated(20.0);
        let [mx, _] = lengths(&grid);
        let wide = eigenvalues(&grid, &kernel).unwrap();
        for k in [10, 20, 40] {
            let exact = kernel.symbol(std::f64::consts::TAU * k as f64 / mx as f64, 0.0);
            // Cells average over a wave: (q dx)²/24 and more.
            assert!((wide[(k, 0)] / exact - 1.0).abs() < 0.1, "{k}: {} {exact}", wide[(k, 0)]);
        }
    }
}
