//! The free half-space: Love's coefficients, zero-padded to at least twice the cells (DC-FFT; Liu,
//! Wang & Liu, Wear 243, 2000).

use ndarray::Array2;
use ndarray::parallel::prelude::*;

use super::{Operator, Single};
use crate::convolution::lanes::{Journey, Lanes, Sums};
use crate::convolution::{Convolution, even_spectrum};
use crate::grid::{Boundary, Grid};
use crate::kernel::love;

/// u(i, j) = sum K(i - i', j - j') p(i', j'), with no pressure outside the domain.
pub struct Free {
    grid: Grid,
    convolution: Convolution,
    single: Single,
    self_influence: f64,
}

impl Free {
    /// Plans the operator; the influence coefficients are computed here.
    pub fn new(grid: Grid) -> Self {
        Free::planned(grid, false)
    }

    /// The same, and its form in f32.
    pub fn with_single(grid: Grid) -> Self {
        Free::planned(grid, true)
    }

    fn planned(grid: Grid, single: bool) -> Self {
        let (self_influence, spectrum) = kernel(&grid);
        debug_assert!(spectrum.iter().all(|s| *s > 0.0), "the kernel is positive definite");
        let convolution = Convolution::new(grid.cells(), padded(&grid), spectrum.view());
        let single = single.then(|| Lanes::new(grid.cells(), padded(&grid), spectrum.view()));
        Free { grid, convolution, single: Single(single), self_influence }
    }

    fn single(&mut self) -> &mut Lanes<f32> {
        let grid = &self.grid;
        self.single.planned(|| Lanes::new(grid.cells(), padded(grid), kernel(grid).1.view()))
    }
}

/// K of a cell on itself, and the spectrum of K.
fn kernel(grid: &Grid) -> (f64, Array2<f64>) {
    let kernel = influence(grid, padded(grid));
    (kernel[(0, 0)], even_spectrum(&kernel, padded(grid)))
}

/// Lengths of the transforms.
fn padded(grid: &Grid) -> [usize; 2] {
    grid.cells().map(|n| Convolution::good_length(2 * n - 1))
}

/// K on the quadrant of the padded torus. Beyond the domain the true coefficients go on: no output
/// of the domain reads them, and the kernel stays smooth and its spectrum positive.
fn influence(grid: &Grid, lengths: [usize; 2]) -> Array2<f64> {
    let [dx, dy] = grid.spacing();
    let mut kernel = Array2::zeros((lengths[0] / 2 + 1, lengths[1] / 2 + 1));
    kernel.outer_iter_mut().into_par_iter().enumerate().for_each(|(i, mut row)| {
        for (j, k) in row.iter_mut().enumerate() {
            *k = love(i as f64 * dx, j as f64 * dy, [dx, dy]);
        }
    });
    kernel
}

impl Operator for Free {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::Free
    }

    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        self.convolution.apply_into(p, u);
    }

    fn apply_single_into(&mut self, p: &[f32], u: &mut [f32]) {
        self.single().apply_into(p, u);
    }

    fn carry(&mut self, journey: Journey<f64>) -> Option<Sums> {
        self.convolution.carry(journey)
    }

    fn carry_single(&mut self, journey: Journey<f32>) -> Option<Sums> {
        self.single().carry(journey)
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let lengths = cells.map(|n: usize| Convolution::good_length(2 * n - 1));
            let spectrum = even_spectrum(&influence(&grid, lengths), lengths);
            assert!(spectrum.iter().all(|s| *s > 0.0), "{cells:?} {size:?}");
        }
    }
}
