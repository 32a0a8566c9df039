//! The periodic half-space: 2/|q| on the waves of the domain (Westergaard 1939; Stanley & Kato, J.
//! Tribol. 119, 1997). The mean pressure displaces nothing: displacements have zero mean.

use super::{Operator, Single, wave_spectrum};
use crate::convolution::Convolution;
use crate::convolution::lanes::Lanes;
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
        let grid = &self.grid;
        let plan = || {
            Lanes::new(
                grid.cells(),
                grid.cells(),
                wave_spectrum(grid.cells(), grid.size(), wave_kernel).view(),
            )
        };
        self.single.apply_into(plan, p, u);
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }
}
