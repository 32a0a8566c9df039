//! The temperature of the surface of one body under a field of heat.

use std::f64::consts::{PI, TAU};

use rustfft::num_complex::Complex64;

use super::Conductor;
use super::kernel::Source;
use crate::convolution::torus::{Spectrum, Torus};
use crate::grid::{Boundary, Grid};
use crate::kernel::gauss::GAUSS_8;
use crate::sliding::Direction;

/// Arguments of the error function from which on its asymptotic series is taken.
const LARGE: f64 = 7.0;

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

    /// T^/q^ of a body over which the heat moves with this velocity: 1/(k √s), s = |q|² - i q.v/χ, and where it has been heated for a time t
    /// only, that times erf √(s χ t). Waves along the motion, which pass no place, take as long as the mean to become steady.
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
            let rate = Complex64::new(qx * qx + qy * qy, -along);
            let begun =
                self.heated_for.map_or(Complex64::ONE, |time| error_function((rate * (chi * time)).sqrt()));
            let wave = begun * rate.sqrt().inv() / k;
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

/// The error function of a number with a real part of at least the size of its imaginary one.
fn error_function(z: Complex64) -> Complex64 {
    let scale = 2.0 / PI.sqrt();
    if z.norm() > LARGE {
        return Complex64::ONE - (-z * z).exp() / (z * PI.sqrt());
    }
    // exp(-z² x²) over 0 < x < 1 turns by 6 radians in the last of 16 panels, at most.
    let panel = |n: usize| {
        let (middle, half) = ((n as f64 + 0.5) / 16.0, 0.5 / 16.0);
        let at = |x: f64, w: f64| (-z * z * (middle + half * x).powi(2)).exp() * (w * half);
        GAUSS_8.iter().map(|(x, w)| at(*x, *w)).sum::<Complex64>()
    };
    z * scale * (0..16).map(panel).sum::<Complex64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_function_of_complex_numbers() {
        for x in [0.0, 0.1, 1.0, 3.0, 6.9, 7.1, 30.0] {
            assert!((error_function(x.into()) - libm::erf(x)).norm() < 1e-12);
        }
        // On the diagonal: the integrals of Fresnel, erf(√(i π/2) u) = √(2i) (C(u) - i S(u)); C(1), S(1) of Abramowitz & Stegun, table 7.8.
        let z = Complex64::new(0.0, PI / 2.0).sqrt();
        let exact =
            Complex64::new(0.0, 2.0).sqrt() * Complex64::new(0.779_893_400_376_8, -0.438_259_147_390_4);
        assert!((error_function(z) - exact).norm() < 1e-11);
        // Both rules meet: the next term of the series is of the order of |z|⁻³.
        let far = |r: f64| error_function(Complex64::from_polar(r, -0.25 * PI));
        assert!((far(LARGE * (1.0 - 1e-9)) - far(LARGE * (1.0 + 1e-9))).norm() < 2.0 / LARGE.powi(3));
    }
}
