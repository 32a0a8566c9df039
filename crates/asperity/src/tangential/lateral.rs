//! What pressure and tangential tractions do to each other: N p is the tangential displacement under a pressure, N'q the normal one under
//! tangential tractions ([`kernel::lateral`](crate::kernel)).

use asperity_sweep::each;
use rustfft::num_complex::Complex64;

use super::operator::{Quadrant, lengths};
use super::vector::Vector;
use crate::convolution::torus::{Spectrum, Torus};
use crate::grid::{Boundary, Grid};
use crate::kernel::{lateral, lateral_symbol};

/// N and its transpose, for unit contact compliance.
pub(crate) struct Lateral {
    torus: Torus,
    /// The imaginary parts of both components of each wave; N is odd, so there are no real ones.
    spectrum: Vec<Vector>,
    waves: [Spectrum; 2],
    part: Vec<f64>,
}

impl Lateral {
    /// Of a pair with this β, of which a free one is no line of cells.
    pub(crate) fn new(grid: &Grid, boundary: Boundary, beta: f64) -> Self {
        let lengths = lengths(grid, boundary);
        let torus = Torus::new(grid.cells(), lengths);
        let spectrum = match boundary {
            Boundary::Free => Self::of_coefficients(grid, lengths),
            Boundary::Periodic => Self::of_waves(grid, &torus),
        };
        let waves = [0; 2].map(|_| Spectrum(vec![Complex64::ZERO; torus.spectrum_len()]));
        let spectrum = spectrum.into_iter().map(|[x, y]| [beta * x, beta * y]).collect();
        Lateral { torus, spectrum, waves, part: vec![0.0; grid.len()] }
    }

    /// Bytes that it takes on a torus of these lengths.
    pub(super) fn bytes([mx, my]: [usize; 2]) -> usize {
        mx * (my / 2 + 1) * (2 * 8 + 2 * 16)
    }

    fn of_waves(grid: &Grid, torus: &Torus) -> Vec<Vector> {
        let tau = std::f64::consts::TAU;
        let ([lx, ly], lengths) = (grid.size(), torus.lengths().map(|m| m as i64));
        let number = |n: usize| {
            let k = torus.wave(n);
            let along = lateral_symbol(tau * k[0] as f64 / lx, tau * k[1] as f64 / ly);
            // The shortest wave of an even number of cells has either sign.
            [0, 1].map(|axis| if 2 * k[axis] == lengths[axis] { 0.0 } else { along[axis] })
        };
        (0..torus.spectrum_len()).map(number).collect()
    }

    fn of_coefficients(grid: &Grid, [mx, my]: [usize; 2]) -> Vec<Vector> {
        let [dx, dy] = grid.spacing();
        let quadrant = Quadrant::of([mx, my], |i, j| lateral(i as f64 * dx, j as f64 * dy, [dx, dy]));
        let mut whole = Torus::new([mx, my], [mx, my]);
        let spectra = [(0, [true, false]), (1, [false, true])]
            .map(|(component, odd)| whole.transform(&quadrant.mirrored(|k| k[component], odd)));
        (0..whole.spectrum_len()).map(|n| [0, 1].map(|k| spectra[k].0[n].im)).collect()
    }

    /// The tangential displacement under a pressure.
    pub(crate) fn under_pressure(&mut self, p: &[f64], u: &mut [Vector]) {
        let Self { torus, spectrum, waves, part } = self;
        torus.transform_into(p, &mut waves[0]);
        let pressure = &waves[0].0;
        for axis in 0..2 {
            torus.back(|n| pressure[n] * Complex64::new(0.0, spectrum[n][axis]), part);
            each(u, &part[..], |u, part| u[axis] = part);
        }
    }

    /// The normal displacement under tangential tractions.
    pub(crate) fn under_traction(&mut self, q: &[Vector], u: &mut [f64]) {
        let Self { torus, spectrum, waves, part } = self;
        for (axis, waves) in waves.iter_mut().enumerate() {
            each(part, q, |part, q| *part = q[axis]);
            torus.transform_into(part, waves);
        }
        let [x, y] = &*waves;
        torus.back(|n| (x.0[n] * spectrum[n][0] + y.0[n] * spectrum[n][1]) * Complex64::new(0.0, -1.0), u);
    }
}
