//! Multiplication of a real field by a complex spectrum: u = F⁻¹[ S F p ] on a torus at least as large as the domain.
//!
//! [`Convolution`](crate::Convolution) takes real, even spectra only. The spectrum of a body that streams by, of a derivative or
//! of a shift is complex, with S(-q) = conj S(q). Normalisation: both transforms together are the identity.

use rayon::prelude::*;
use rustfft::num_complex::Complex64;

use crate::plane::{Column, RealPlane};

/// The multipliers of a torus of mx x my cells, in columns of constant ky: S(kx, ky) at `ky * mx + kx`, 0 <= ky <= my/2, all kx.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum(pub Vec<Complex64>);

/// The transforms of a domain of nx x ny cells on a torus of mx x my cells. Bit-identical for any number of threads.
///
/// ```
/// use asperity_convolution::torus::Torus;
/// use rustfft::num_complex::Complex64;
///
/// // Multiplied by i q, a wave along x becomes its derivative.
/// let mut torus = Torus::new([8, 1], [8, 1]);
/// let q = std::f64::consts::TAU / 8.0;
/// let derivative = torus.spectrum(|kx, _| Complex64::new(0.0, q * kx as f64));
/// let wave: Vec<f64> = (0..8).map(|i| (q * i as f64).sin()).collect();
/// let mut slope = [0.0; 8];
/// torus.apply_into(&derivative, &wave, &mut slope);
/// assert!((slope[1] - q * q.cos()).abs() < 1e-15);
/// ```
pub struct Torus {
    plane: RealPlane,
    /// The transformed rows of a field.
    columns: Vec<Complex64>,
}

impl Torus {
    /// Plans the transforms of fields of `cells` = \[nx, ny\] on a torus of `lengths` = \[mx, my\].
    ///
    /// # Panics
    /// If a length is less than the number of cells.
    pub fn new(cells: [usize; 2], lengths: [usize; 2]) -> Self {
        let plane = RealPlane::new(cells, lengths);
        Torus { columns: plane.columns(), plane }
    }

    /// mx, my.
    pub fn lengths(&self) -> [usize; 2] {
        self.plane.lengths()
    }

    /// 1/(mx my), which makes both transforms together the identity.
    fn scale(&self) -> f64 {
        let [mx, my] = self.lengths();
        1.0 / (mx as f64 * my as f64)
    }

    /// Numbers of a [`Spectrum`].
    pub fn spectrum_len(&self) -> usize {
        self.lengths()[0] * self.plane.waves_along_y()
    }

    /// kx and ky of the number n of a [`Spectrum`], -mx/2 < kx <= mx/2.
    pub fn wave(&self, n: usize) -> [i64; 2] {
        let mx = self.lengths()[0];
        let (kx, ky) = ((n % mx) as i64, (n / mx) as i64);
        [if 2 * (n % mx) > mx { kx - mx as i64 } else { kx }, ky]
    }

    /// The spectrum with these numbers S(kx, ky). Where a wave is its own opposite, only the real part counts.
    pub fn spectrum(&self, of: impl Fn(i64, i64) -> Complex64 + Sync) -> Spectrum {
        let lengths = self.lengths().map(|m| m as i64);
        let number = |n: usize| {
            let wave = self.wave(n);
            let value = of(wave[0], wave[1]);
            let is_own = wave.iter().zip(lengths).all(|(k, m)| *k == 0 || 2 * k == m);
            if is_own { Complex64::new(value.re, 0.0) } else { value }
        };
        Spectrum((0..self.spectrum_len()).into_par_iter().map(number).collect())
    }

    /// u = F⁻¹[ S F p ]; both fields have nx ny cells.
    pub fn apply_into(&mut self, spectrum: &Spectrum, p: &[f64], u: &mut [f64]) {
        let (mx, scale) = (self.lengths()[0], self.scale());
        self.plane.rows_forward(p, &mut self.columns);
        self.plane.each_column(&mut self.columns, |transforms, ky, column| {
            let waves = transforms.forward(column).iter_mut();
            waves.zip(&spectrum.0[ky * mx..]).for_each(|(x, s)| *x = *x * s * scale);
            column.copy_from_slice(transforms.back());
        });
        self.plane.rows_back(&self.columns, u);
    }

    /// F p, p of nx ny cells.
    pub fn transform(&mut self, p: &[f64]) -> Spectrum {
        let mut all = Spectrum(vec![Complex64::ZERO; self.spectrum_len()]);
        self.transform_into(p, &mut all);
        all
    }

    /// The same, into a spectrum of [`spectrum_len`](Self::spectrum_len) numbers.
    pub fn transform_into(&mut self, p: &[f64], all: &mut Spectrum) {
        self.plane.rows_forward(p, &mut self.columns);
        let nx = self.columns.len() / self.plane.waves_along_y();
        all.0.par_chunks_mut(self.lengths()[0]).zip(self.columns.par_chunks(nx)).for_each_init(
            || self.plane.column(),
            |transforms, (waves, column)| transforms.forward_into(column, waves),
        );
    }

    /// Σ Re S |p^|² over all waves of the torus, over mx my: by Parseval's theorem a sum over its cells.
    pub fn energy(&mut self, spectrum: &Spectrum, p: &[f64]) -> f64 {
        let [mx, my] = self.lengths();
        self.plane.rows_forward(p, &mut self.columns);
        let nx = self.columns.len() / self.plane.waves_along_y();
        let column = |transforms: &mut Column, (ky, column): (usize, &[Complex64])| {
            let twice = if ky == 0 || 2 * ky == my { 1.0 } else { 2.0 };
            let waves = transforms.forward(column).iter().zip(&spectrum.0[ky * mx..]);
            twice * waves.map(|(x, s)| s.re * x.norm_sqr()).sum::<f64>()
        };
        let columns = self.columns.par_chunks(nx).enumerate();
        // One column after the other, so that the sum has the same bits for any number of threads.
        let sums: Vec<f64> = columns.map_init(|| self.plane.column(), column).collect();
        sums.iter().sum::<f64>() / (mx as f64 * my as f64)
    }

    /// u = F⁻¹[ S T ] of a transform T and a spectrum S.
    pub fn back_from(&mut self, transform: &Spectrum, spectrum: &Spectrum, u: &mut [f64]) {
        self.back(|n| transform.0[n] * spectrum.0[n], u);
    }

    /// u = F⁻¹ T of a transform T.
    pub fn back_of(&mut self, transform: &[Complex64], u: &mut [f64]) {
        self.back(|n| transform[n], u);
    }

    /// u = F⁻¹ of the numbers `wave(ky mx + kx)`.
    pub fn back(&mut self, wave: impl Fn(usize) -> Complex64 + Sync, u: &mut [f64]) {
        let (mx, scale) = (self.lengths()[0], self.scale());
        self.plane.each_column(&mut self.columns, |transforms, ky, column| {
            transforms.waves.iter_mut().zip(ky * mx..).for_each(|(x, n)| *x = wave(n) * scale);
            column.copy_from_slice(transforms.back());
        });
        self.plane.rows_back(&self.columns, u);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u(x) = p(x + shift) has the spectrum exp(i q shift).
    #[test]
    fn a_phase_is_a_shift() {
        for (cells, lengths) in [([8, 6], [8, 6]), ([9, 1], [9, 1]), ([5, 4], [16, 9]), ([1, 7], [1, 14])] {
            let mut torus = Torus::new(cells, lengths);
            let tau = std::f64::consts::TAU;
            let phase = |kx: i64, ky: i64| {
                Complex64::cis(tau * (kx as f64 / lengths[0] as f64 + 2.0 * ky as f64 / lengths[1] as f64))
            };
            let spectrum = torus.spectrum(phase);
            let p: Vec<f64> = (0..cells[0] * cells[1]).map(|n| (n * 37 % 11) as f64).collect();
            let mut u = vec![0.0; p.len()];
            torus.apply_into(&spectrum, &p, &mut u);
            for i in 0..cells[0] {
                for j in 0..cells[1] {
                    let (a, b) = ((i + 1) % lengths[0], (j + 2) % lengths[1]);
                    let exact = if a < cells[0] && b < cells[1] { p[a * cells[1] + b] } else { 0.0 };
                    // a few roundings of numbers of size 10; a whole-cell shift has real Nyquist phases
                    assert!((u[i * cells[1] + j] - exact).abs() < 1e-13, "{cells:?} {lengths:?}");
                }
            }
            let square: f64 = p.iter().map(|p| p * p).sum();
            let one = torus.spectrum(|_, _| Complex64::ONE);
            let energy = torus.energy(&one, &p);
            assert!((energy / square - 1.0).abs() < 1e-13);
        }
    }
}
