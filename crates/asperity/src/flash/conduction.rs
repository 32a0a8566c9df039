//! The temperature of the surface of one body under a field of heat.

use std::f64::consts::{PI, TAU};

use rustfft::num_complex::Complex64;

use super::Conductor;
use super::kernel::Source;
use crate::convolution::torus::{Spectrum, Torus};
use crate::grid::{Boundary, Grid};
use crate::sliding::Direction;

/// Transforms of the heat on a domain.
pub(super) struct Conduction {
    grid: Grid,
    boundary: Boundary,
    direction: Direction,
    heated_for: Option<f64>,
    torus: Torus,
}

impl Conduction {
    pub(super) fn new(
        grid: &Grid,
        boundary: Boundary,
        direction: Direction,
        heated_for: Option<f64>,
    ) -> Self {
        let cells = grid.cells();
        let lengths = match boundary {
            Boundary::Periodic => cells,
            Boundary::Free => cells.map(|n| if n > 1 { 2 * n } else { 1 }),
        };
        Conduction { grid: *grid, boundary, direction, heated_for, torus: Torus::new(cells, lengths) }
    }

    /// T^/q^ of a body over which the heat moves with this velocity.
    pub(super) fn spectrum(&mut self, body: Conductor, velocity: f64) -> Spectrum {
        match self.boundary {
            Boundary::Periodic => self.of_waves(body, velocity),
            Boundary::Free => self.of_cells(body, velocity),
        }
    }

    fn of_waves(&self, body: Conductor, velocity: f64) -> Spectrum {
        let Conductor { conductivity: k, diffusivity: chi } = body;
        let ([lx, ly], [cx, cy], [nx, ny]) = (self.grid.size(), self.direction.unit(), self.grid.cells());
        // The mean of an even flux since the heating began.
        let mean = self.heated_for.map_or(0.0, |time| 2.0 * (chi * time / PI).sqrt() / k);
        self.torus.spectrum(|kx, ky| {
            let (qx, qy) = (TAU * kx as f64 / lx, TAU * ky as f64 / ly);
            if kx == 0 && ky == 0 {
                return Complex64::new(mean, 0.0);
            }
            let along = (cx * qx + cy * qy) * velocity / chi;
            let wave = Complex64::new(qx * qx + qy * qy, -along).sqrt().inv() / k;
            // The shortest wave of a side is its own opposite.
            let is_shortest = 2 * kx.unsigned_abs() as usize == nx || 2 * ky.unsigned_abs() as usize == ny;
            if is_shortest { Complex64::new(wave.re, 0.0) } else { wave }
        })
    }

    fn of_cells(&mut self, body: Conductor, velocity: f64) -> Spectrum {
        let Conductor { conductivity: k, diffusivity: chi } = body;
        let axis = self.direction.axis();
        let source = Source::new(&self.grid, axis, velocity.abs() / (2.0 * chi));
        let influence = source.influence();
        let ([mx, my], [along, across]) = (self.torus.lengths(), source.cells);
        let sign = if velocity < 0.0 { -1 } else { 1 };
        // From places on the torus to distances; the place in its middle stands for two and is not seen.
        let signed = |n: usize, m: usize| if 2 * n > m { n as i64 - m as i64 } else { n as i64 };
        let value = |n: usize| {
            let place = [signed(n / my, mx), signed(n % my, my)];
            let (i, j) = (sign * place[axis], place[1 - axis].unsigned_abs() as usize);
            let (i, j) = (i.clamp(1 - along as i64, along as i64 - 1), j.min(across - 1));
            influence[(i + along as i64 - 1) as usize * across + j] / k
        };
        let coefficients: Vec<f64> = (0..mx * my).map(value).collect();
        Torus::new([mx, my], [mx, my]).transform(&coefficients)
    }

    /// T of a field of heat.
    pub(super) fn apply_into(&mut self, spectrum: &Spectrum, heat: &[f64], to: &mut [f64]) {
        self.torus.apply_into(spectrum, heat, to);
    }
}
