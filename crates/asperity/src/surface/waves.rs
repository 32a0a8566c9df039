//! Sums of random plane waves.
//!
//! ```text
//! z(x, y) = sum over k of A_k exp(i q.x),   q = 2 pi (kx / Lx, ky / Ly),   A_(-k) = conj A_k
//! ```
//!
//! with A_k a complex normal number times a given amplitude. The random number of a wave depends only on the seed and on (kx,
//! ky): ky is the number of the stream of the generator, kx the position in it, so that it does not depend on the grid or the
//! spectrum. Bits do not depend on machine or threads.

use std::f64::consts::TAU;

use ndarray::Array2;
use ndarray::parallel::prelude::*;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rustfft::num_complex::Complex64;

use super::fourier::Transform;
use crate::grid::Grid;

/// Wavelengths that agree to this fraction are equal: 0.1 mm / 1024 is not an exact binary number.
pub(super) const SAME: f64 = 1e-9;

/// The plane waves of a domain with |q| up to a largest, one half plane of them: ky > 0, and ky = 0
/// with kx > 0. The others are their conjugates.
pub(super) struct Waves {
    cells: [usize; 2],
    /// 2 pi / L along x and y.
    fundamental: [f64; 2],
    largest: f64,
}

impl Waves {
    pub(super) fn new(grid: &Grid, largest: f64) -> Self {
        let fundamental = grid.size().map(|length| TAU / length);
        Waves { cells: grid.cells(), fundamental, largest: largest * (1.0 + SAME) }
    }

    /// Largest index along an axis: below Nyquist and within the band.
    pub(super) fn reach(&self, axis: usize, largest: f64) -> usize {
        let nyquist = (self.cells[axis] - 1) / 2;
        nyquist.min((largest / self.fundamental[axis]) as usize)
    }

    /// The waves, and the mean of z^2 and of |grad z|^2. Column ky holds A_k at index kx (negative ones from the end), with the
    /// phase that moves the samples from the corners to the centres of the cells.
    pub(super) fn amplitudes(
        &self,
        seed: u64,
        amplitude: impl Fn(f64, f64) -> f64 + Sync,
    ) -> (Vec<Vec<Complex64>>, [f64; 2]) {
        let (columns, moments): (Vec<_>, Vec<_>) = (0..=self.reach(1, self.largest))
            .into_par_iter()
            .map(|ky| self.column(seed, ky, &amplitude))
            .unzip();
        (columns, moments.iter().fold([0.0; 2], |sum, m: &[f64; 2]| [sum[0] + m[0], sum[1] + m[1]]))
    }

    fn column(
        &self,
        seed: u64,
        ky: usize,
        amplitude: &(impl Fn(f64, f64) -> f64 + Sync),
    ) -> (Vec<Complex64>, [f64; 2]) {
        let [nx, ny] = self.cells;
        let mut column = vec![Complex64::ZERO; nx];
        let [mut height, mut gradient] = [0.0; 2];
        let mut random = generator(seed, ky as u64);
        let qy = self.fundamental[1] * ky as f64;
        let room = (self.largest * self.largest - qy * qy).max(0.0).sqrt();
        let reach = self.reach(0, room) as i64;
        // 0, 1, -1, 2, -2, ...: the position of a wave in the stream does not depend on the number of following waves.
        for kx in (0..=reach).flat_map(|k| [k, -k]).skip(1) {
            let normal = complex_normal(&mut random);
            if ky == 0 && kx <= 0 {
                continue;
            }
            let qx = self.fundamental[0] * kx as f64;
            let q2 = qx * qx + qy * qy;
            let a = normal * amplitude(qx, qy);
            // This wave and its conjugate.
            height += 2.0 * a.norm_sqr();
            gradient += 2.0 * q2 * a.norm_sqr();
            let half_a_cell = 0.5 * TAU * (kx as f64 / nx as f64 + ky as f64 / ny as f64);
            let (sin, cos) = libm::sincos(half_a_cell);
            column[kx.rem_euclid(nx as i64) as usize] = a * Complex64::new(cos, sin);
        }
        (column, [height, gradient])
    }

    /// scale * (sum of the waves and their conjugates) at the cell centres.
    pub(super) fn sum(&self, columns: &mut [Vec<Complex64>], scale: f64) -> Array2<f64> {
        let [nx, ny] = self.cells;
        let along_x = Transform::new(nx);
        columns.par_iter_mut().for_each_init(
            || vec![Complex64::ZERO; along_x.scratch_len()],
            |scratch, column| along_x.apply(column, scratch),
        );
        let along_y = Transform::new(ny);
        let mut heights = Array2::zeros((nx, ny));
        heights.outer_iter_mut().into_par_iter().enumerate().for_each_init(
            || (vec![Complex64::ZERO; ny], vec![Complex64::ZERO; along_y.scratch_len()]),
            |(row, scratch), (i, mut out)| {
                row.fill(Complex64::ZERO);
                for (ky, column) in columns.iter().enumerate() {
                    row[ky] = column[i];
                }
                along_y.apply(row, scratch);
                for (z, w) in out.iter_mut().zip(row.iter()) {
                    *z = 2.0 * scale * w.re; // a wave plus its conjugate
                }
            },
        );
        heights
    }
}

/// One stream of random numbers per ky.
fn generator(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    let mut random = ChaCha8Rng::from_seed(key);
    random.set_stream(stream);
    random
}

/// A complex number with independent normal parts (Box & Muller 1958).
fn complex_normal(random: &mut ChaCha8Rng) -> Complex64 {
    const ULP: f64 = 1.0 / (1u64 << 53) as f64;
    let radius = (-2.0 * libm::log(((random.next_u64() >> 11) + 1) as f64 * ULP)).sqrt();
    let (sin, cos) = libm::sincos(TAU * ((random.next_u64() >> 11) as f64 * ULP));
    Complex64::new(radius * cos, radius * sin)
}
