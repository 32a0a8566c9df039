//! The periodic half-space: 2/|q| on the waves of the domain (Westergaard 1939; Stanley & Kato, J.
//! Tribol. 119, 1997). The mean pressure displaces nothing: displacements have zero mean.

use ndarray::{ArrayView1, ArrayView2};

use super::{Operator, Single, wave_spectrum};
use crate::convolution::Convolution;
use crate::convolution::lanes::{Journey, Lanes, Sums};
use crate::grid::{Boundary, Grid};
use crate::kernel::wave_kernel;

/// u = F^-1 \[ (2/|q|) F p \].
pub struct Periodic {
    grid: Grid,
    convolution: Convolution,
    single: Single,
    self_influence: f64,
}

impl Periodic {
    /// Plans the operator.
    pub fn new(grid: Grid) -> Self {
        Periodic::planned(grid, false)
    }

    /// The same, and its form in f32.
    pub fn with_single(grid: Grid) -> Self {
        Periodic::planned(grid, true)
    }

    fn planned(grid: Grid, single: bool) -> Self {
        let cells = grid.cells();
        let spectrum = wave_spectrum(cells, grid.size(), wave_kernel);
        let convolution = Convolution::new(cells, cells, spectrum.view());
        let self_influence = mean(cells, spectrum.view());
        let single = single.then(|| Lanes::new(cells, cells, spectrum.view()));
        Periodic { grid, convolution, single: Single(single), self_influence }
    }

    fn single(&mut self) -> &mut Lanes<f32> {
        let (cells, size) = (self.grid.cells(), self.grid.size());
        self.single.planned(|| Lanes::new(cells, cells, wave_spectrum(cells, size, wave_kernel).view()))
    }
}

/// The mean of an even spectrum over all waves, of which the array has those of a quarter: the response to a unit where it is.
fn mean([nx, ny]: [usize; 2], spectrum: ArrayView2<f64>) -> f64 {
    let times = |k: usize, n: usize| if k == 0 || 2 * k == n { 1.0 } else { 2.0 };
    let row = |row: ArrayView1<f64>| -> f64 { row.iter().enumerate().map(|(ky, s)| times(ky, ny) * s).sum() };
    let sum: f64 = spectrum.outer_iter().enumerate().map(|(kx, s)| times(kx, nx) * row(s)).sum();
    sum / (nx as f64 * ny as f64)
}

impl Operator for Periodic {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    fn boundary(&self) -> Boundary {
        Boundary::Periodic
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
    fn the_self_influence_is_what_the_convolution_says() {
        for cells in [[16, 16], [9, 14], [1, 7], [20, 33]] {
            let mut operator = Periodic::new(Grid::new(cells, [1.0, 2.0]).unwrap());
            let (mut unit, mut response) = (vec![0.0; cells[0] * cells[1]], vec![0.0; cells[0] * cells[1]]);
            unit[0] = 1.0;
            operator.apply_into(&unit, &mut response);
            // Roundings of a transform, and of a sum of a few hundred terms.
            assert!((operator.self_influence() / response[0] - 1.0).abs() < 1e-13, "{cells:?}");
        }
    }
}
