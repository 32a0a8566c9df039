//! u = K q of the surface under tangential tractions, and the approximate inverse of K.
//!
//! Both components are convolved at once: two transforms, a symmetric 2 x 2 matrix for each wave, two transforms back.

use std::cmp::Ordering;

use asperity_sweep::each;

use super::vector::Vector;
use crate::convolution::torus::{Spectrum, Torus};
use crate::grid::{Boundary, Grid};
use crate::kernel::{Cerruti, Tangential, strip};
pub(super) use crate::operator::torus as lengths;

/// A convolution of a field of vectors with an even, symmetric tensor.
pub(crate) struct VectorConvolution {
    torus: Torus,
    /// The tensor of each wave.
    spectrum: Vec<Tangential>,
    waves: [Spectrum; 2],
    /// One component of a field.
    part: Vec<f64>,
}

impl VectorConvolution {
    /// K of a body, for unit contact compliance.
    pub(crate) fn of(grid: &Grid, boundary: Boundary, body: Cerruti) -> Self {
        let lengths = lengths(grid, boundary);
        match boundary {
            Boundary::Free if grid.is_line() => {
                // Plane strain along x; along y the body is sheared only.
                let strips = strip(grid.spacing()[0], lengths[0] / 2 + 1);
                let on_line =
                    |k: f64, j: usize| if j == 0 { [k, 0.0, body.transverse() * k] } else { [0.0; 3] };
                Self::of_coefficients(grid, lengths, |i, j| on_line(strips[i], j))
            }
            Boundary::Free => {
                let [dx, dy] = grid.spacing();
                let at = |i: usize, j: usize| body.influence(i as f64 * dx, j as f64 * dy, [dx, dy]);
                Self::of_coefficients(grid, lengths, at)
            }
            Boundary::Periodic => Self::of_waves(grid, |qx, qy| body.symbol(qx, qy)),
        }
    }

    /// The inverse of the symbol on a torus that is not padded; the mean counts as half of the longest wave.
    pub(crate) fn approximate_inverse(grid: &Grid, body: Cerruti) -> Self {
        let longest =
            if grid.is_line() { grid.size()[0] } else { grid.size().into_iter().fold(0.0, f64::max) };
        let first = 0.5 * body.inverse(std::f64::consts::TAU / longest, 0.0)[2];
        Self::of_waves(grid, |qx, qy| match (qx, qy) {
            (0.0, 0.0) => [first, 0.0, first],
            _ => body.inverse(qx, qy),
        })
    }

    fn new(torus: Torus, cells: usize, spectrum: Vec<Tangential>) -> Self {
        let waves = [0; 2].map(|_| Spectrum(vec![Default::default(); torus.spectrum_len()]));
        VectorConvolution { torus, spectrum, waves, part: vec![0.0; cells] }
    }

    /// Bytes that one on a torus of these lengths takes: the tensor of each wave and two transforms.
    pub(super) fn bytes([mx, my]: [usize; 2]) -> usize {
        mx * (my / 2 + 1) * (3 * 8 + 2 * 16)
    }

    /// By a symbol of the waves of the domain.
    fn of_waves(grid: &Grid, symbol: impl Fn(f64, f64) -> Tangential) -> Self {
        let ([mx, my], [lx, ly]) = (grid.cells(), grid.size());
        let torus = Torus::new([mx, my], [mx, my]);
        let tau = std::f64::consts::TAU;
        let number = |n: usize| {
            let [kx, ky] = torus.wave(n);
            let [xx, xy, yy] = symbol(tau * kx as f64 / lx, tau * ky as f64 / ly);
            // The shortest wave of an even number of cells has either sign: what is odd in it is 0.
            let own = 2 * kx == mx as i64 || 2 * ky == my as i64;
            [xx, if own { 0.0 } else { xy }, yy]
        };
        let spectrum = (0..torus.spectrum_len()).map(number).collect();
        Self::new(torus, grid.len(), spectrum)
    }

    /// By the coefficients at distances of so many cells on a torus of `lengths`.
    fn of_coefficients(
        grid: &Grid,
        [mx, my]: [usize; 2],
        coefficient: impl Fn(usize, usize) -> Tangential + Sync,
    ) -> Self {
        let quadrant = Quadrant::of([mx, my], coefficient);
        let mut whole = Torus::new([mx, my], [mx, my]);
        // x y is odd in both.
        let spectra = [(0, [false; 2]), (1, [true; 2]), (2, [false; 2])]
            .map(|(component, odd)| whole.transform(&quadrant.mirrored(|k| k[component], odd)));
        let spectrum = (0..whole.spectrum_len()).map(|n| [0, 1, 2].map(|k| spectra[k].0[n].re)).collect();
        Self::new(Torus::new(grid.cells(), [mx, my]), grid.len(), spectrum)
    }

    /// u = K q.
    pub(crate) fn apply_into(&mut self, q: &[Vector], u: &mut [Vector]) {
        let Self { torus, spectrum, waves, part } = self;
        for (axis, waves) in waves.iter_mut().enumerate() {
            each(part, q, |part, q| *part = q[axis]);
            torus.transform_into(part, waves);
        }
        let [x, y] = &*waves;
        for axis in 0..2 {
            torus.back(|n| x.0[n] * spectrum[n][axis] + y.0[n] * spectrum[n][axis + 1], part);
            each(u, &part[..], |u, part| u[axis] = part);
        }
    }
}

/// Coefficients at distances of so many cells on a torus: those of one quadrant; the others are their mirror images.
pub(super) struct Quadrant<K> {
    lengths: [usize; 2],
    coefficients: Vec<K>,
}

impl<K: Default + Clone + Send + Sync> Quadrant<K> {
    pub(super) fn of(lengths: [usize; 2], coefficient: impl Fn(usize, usize) -> K + Sync) -> Self {
        let [columns, rows] = lengths.map(|m| m / 2 + 1);
        let mut coefficients = vec![K::default(); columns * rows];
        each(&mut coefficients, 0..columns * rows, |k, n| *k = coefficient(n / rows, n % rows));
        Quadrant { lengths, coefficients }
    }

    /// One component on the whole torus; `odd` along x and y: of two signs, or of none, halfway around it.
    pub(super) fn mirrored(&self, component: impl Fn(&K) -> f64, odd: [bool; 2]) -> Vec<f64> {
        let [mx, my] = self.lengths;
        let sign = |i: usize, m: usize, odd: bool| match (2 * i).cmp(&m) {
            Ordering::Equal if odd => 0.0,
            Ordering::Greater if odd => -1.0,
            _ => 1.0,
        };
        let number = |n: usize| {
            let (i, j) = (n / my, n % my);
            let k = component(&self.coefficients[i.min(mx - i) * (my / 2 + 1) + j.min(my - j)]);
            k * sign(i, mx, odd[0]) * sign(j, my, odd[1])
        };
        (0..mx * my).map(number).collect()
    }
}
