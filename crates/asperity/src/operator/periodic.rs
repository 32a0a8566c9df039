//! The periodic half-space: 2/|q| on the waves of the domain (Westergaard 1939; Stanley & Kato, J.
//! Tribol. 119, 1997). The mean pressure displaces nothing: displacements have zero mean.

use super::{Operator, Single, wave_spectrum};
use crate::convolution::lanes::{Lanes, Sums};
use crate::convolution::{Convolution, Visit};
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
        let spectrum = wave_spectrum(grid.cells(), grid.size(), wave_kernel);
        let mut convolution = Convolution::new(grid.cells(), grid.cells(), spectrum.view());
        let mut unit = vec![0.0; grid.len()];
        let mut response = vec![0.0; grid.len()];
        unit[0] = 1.0;
        convolution.apply_into(&unit, &mut response);
        Periodic { grid, convolution, single: Single::default(), self_influence: response[0] }
    }

    fn single(&mut self) -> &mut Lanes<f32> {
        let (cells, size) = (self.grid.cells(), self.grid.size());
        self.single.planned(|| Lanes::new(cells, cells, wave_spectrum(cells, size, wave_kernel).view()))
    }
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

    fn apply_visited_into(&mut self, p: &[f64], u: &mut [f64], visit: &Visit<f64>) -> Sums {
        self.convolution.apply_visited_into(p, u, visit)
    }

    fn apply_single_visited_into(&mut self, p: &[f32], u: &mut [f32], visit: &Visit<f32>) -> Sums {
        self.single().apply_visited_into(p, u, visit)
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }
}
