//! Multiplication of a real field by a complex spectrum: u = F⁻¹[ S F p ] on a torus at least as large as the domain.
//!
//! The convolution engine of the contact solver takes even, real spectra only. What slides has a front and a back: its
//! spectrum S(-q) = conj S(q) is complex. Normalisation: both transforms together are the identity.

use std::sync::Arc;

use asperity_convolution::fft;
use rayon::prelude::*;
use realfft::{ComplexToReal, RealToComplex};
use rustfft::Fft;
use rustfft::num_complex::Complex64;

/// The multipliers of a torus of mx x my cells, in columns of constant ky: S(kx, ky) at `ky * mx + kx`, 0 <= ky <= my/2, all kx.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Spectrum(pub(crate) Vec<Complex64>);

/// The transforms of a domain on a torus.
pub(crate) struct Torus {
    /// nx, ny.
    cells: [usize; 2],
    /// mx, my.
    lengths: [usize; 2],
    rows_forward: Arc<dyn RealToComplex<f64>>,
    rows_back: Arc<dyn ComplexToReal<f64>>,
    columns_forward: Arc<dyn Fft<f64>>,
    columns_back: Arc<dyn Fft<f64>>,
    /// Transformed rows, a row after the other.
    rows: Vec<Complex64>,
    /// The same, a column after the other.
    columns: Vec<Complex64>,
}

impl Torus {
    pub(crate) fn new(cells: [usize; 2], lengths: [usize; 2]) -> Self {
        let half = lengths[1] / 2 + 1;
        Torus {
            cells,
            lengths,
            rows_forward: fft::real_forward(lengths[1]),
            rows_back: fft::real_inverse(lengths[1]),
            columns_forward: fft::forward(lengths[0]),
            columns_back: fft::inverse(lengths[0]),
            rows: vec![Complex64::ZERO; cells[0] * half],
            columns: vec![Complex64::ZERO; cells[0] * half],
        }
    }

    /// mx, my.
    pub(crate) fn lengths(&self) -> [usize; 2] {
        self.lengths
    }

    /// Numbers of a [`Spectrum`].
    pub(crate) fn spectrum_len(&self) -> usize {
        self.lengths[0] * (self.lengths[1] / 2 + 1)
    }

    /// The spectrum with these numbers S(kx, ky), -mx/2 < kx <= mx/2. Where a wave is its own opposite, only the real part counts.
    pub(crate) fn spectrum(&self, of: impl Fn(i64, i64) -> Complex64 + Sync) -> Spectrum {
        let [mx, my] = self.lengths;
        let own = |k: usize, m: usize| k == 0 || 2 * k == m;
        let number = |n: usize| {
            let (kx, ky) = (n % mx, n / mx);
            let signed = if 2 * kx > mx { kx as i64 - mx as i64 } else { kx as i64 };
            let value = of(signed, ky as i64);
            if own(kx, mx) && own(ky, my) { Complex64::new(value.re, 0.0) } else { value }
        };
        Spectrum((0..self.spectrum_len()).into_par_iter().map(number).collect())
    }

    /// u = F⁻¹[ S F p ]; both fields have nx ny cells.
    pub(crate) fn apply_into(&mut self, spectrum: &Spectrum, p: &[f64], u: &mut [f64]) {
        self.forward(p);
        self.multiply(|n, x| x * spectrum.0[n]);
        self.back(u);
    }

    /// F p, p of nx ny cells.
    pub(crate) fn transform(&mut self, p: &[f64]) -> Spectrum {
        let (mx, nx) = (self.lengths[0], self.cells[0]);
        self.forward(p);
        let mut all = vec![Complex64::ZERO; self.spectrum_len()];
        let fft = &self.columns_forward;
        all.par_chunks_mut(mx).zip(self.columns.par_chunks(nx)).for_each(|(wave, column)| {
            wave[..nx].copy_from_slice(column);
            fft.process(wave);
        });
        Spectrum(all)
    }

    /// Σ weight(kx, ky) |p^|² over all waves of the torus, over mx my: by Parseval's theorem a sum over its cells.
    pub(crate) fn energy(
        &mut self,
        spectrum: &Spectrum,
        weight: impl Fn(Complex64, i64) -> f64 + Sync,
        p: &[f64],
    ) -> f64 {
        let [mx, my] = self.lengths;
        self.forward(p);
        let fft = &self.columns_forward;
        let nx = self.cells[0];
        let sums: Vec<f64> = self
            .columns
            .par_chunks(nx)
            .enumerate()
            .map(|(ky, column)| {
                let mut wave = vec![Complex64::ZERO; mx];
                wave[..nx].copy_from_slice(column);
                fft.process(&mut wave);
                let twice = if ky == 0 || 2 * ky == my { 1.0 } else { 2.0 };
                let terms = wave.iter().enumerate().map(|(kx, x)| {
                    let signed = if 2 * kx > mx { kx as i64 - mx as i64 } else { kx as i64 };
                    weight(spectrum.0[ky * mx + kx], signed) * x.norm_sqr()
                });
                twice * terms.sum::<f64>()
            })
            .collect();
        sums.iter().sum::<f64>() / (mx as f64 * my as f64)
    }

    /// u = F⁻¹[ S T ] of a transform T and a spectrum S.
    pub(crate) fn back_from(&mut self, transform: &Spectrum, spectrum: &Spectrum, u: &mut [f64]) {
        let (mx, nx) = (self.lengths[0], self.cells[0]);
        let scale = 1.0 / (mx as f64 * self.lengths[1] as f64);
        let fft = &self.columns_back;
        self.columns.par_chunks_mut(nx).enumerate().for_each(|(ky, column)| {
            let own = ky * mx..(ky + 1) * mx;
            let pairs = transform.0[own.clone()].iter().zip(&spectrum.0[own]);
            let mut wave: Vec<Complex64> = pairs.map(|(a, b)| a * b * scale).collect();
            fft.process(&mut wave);
            column.copy_from_slice(&wave[..nx]);
        });
        self.back(u);
    }

    /// u = F⁻¹ T of a transform T.
    pub(crate) fn back_of(&mut self, transform: &[Complex64], u: &mut [f64]) {
        let (mx, nx) = (self.lengths[0], self.cells[0]);
        let scale = 1.0 / (mx as f64 * self.lengths[1] as f64);
        let fft = &self.columns_back;
        self.columns.par_chunks_mut(nx).zip(transform.par_chunks(mx)).for_each(|(column, waves)| {
            let mut waves: Vec<Complex64> = waves.iter().map(|wave| wave * scale).collect();
            fft.process(&mut waves);
            column.copy_from_slice(&waves[..nx]);
        });
        self.back(u);
    }

    fn forward(&mut self, p: &[f64]) {
        let (ny, half, fft) = (self.cells[1], self.lengths[1] / 2 + 1, &self.rows_forward);
        self.rows.par_chunks_mut(half).zip(p.par_chunks(ny)).for_each_init(
            || (fft.make_input_vec(), fft.make_scratch_vec()),
            |(input, scratch), (out, row)| {
                input[..ny].copy_from_slice(row);
                input[ny..].fill(0.0);
                let done = fft.process_with_scratch(input, out, scratch);
                debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
            },
        );
        let (nx, rows) = (self.cells[0], &self.rows);
        self.columns.par_chunks_mut(nx).enumerate().for_each(|(ky, column)| {
            column.iter_mut().enumerate().for_each(|(i, x)| *x = rows[i * half + ky]);
        });
    }

    /// Every column forward, each number times what `multiply(n, x)` makes of it, and back.
    fn multiply(&mut self, multiply: impl Fn(usize, Complex64) -> Complex64 + Sync) {
        let (mx, nx) = (self.lengths[0], self.cells[0]);
        let scale = 1.0 / (mx as f64 * self.lengths[1] as f64);
        let (forward, back) = (&self.columns_forward, &self.columns_back);
        let scratch = forward.get_inplace_scratch_len().max(back.get_inplace_scratch_len());
        self.columns.par_chunks_mut(nx).enumerate().for_each_init(
            || (vec![Complex64::ZERO; mx], vec![Complex64::ZERO; scratch]),
            |(wave, scratch), (ky, column)| {
                wave[..nx].copy_from_slice(column);
                wave[nx..].fill(Complex64::ZERO);
                forward.process_with_scratch(wave, scratch);
                wave.iter_mut().enumerate().for_each(|(kx, x)| *x = multiply(ky * mx + kx, *x) * scale);
                back.process_with_scratch(wave, scratch);
                column.copy_from_slice(&wave[..nx]);
            },
        );
    }

    fn back(&mut self, u: &mut [f64]) {
        let ([nx, ny], my) = (self.cells, self.lengths[1]);
        let (fft, columns) = (&self.rows_back, &self.columns);
        u.par_chunks_mut(ny).enumerate().for_each_init(
            || (fft.make_input_vec(), fft.make_output_vec(), fft.make_scratch_vec()),
            |(spectrum, row, scratch), (i, u)| {
                spectrum.iter_mut().enumerate().for_each(|(ky, x)| *x = columns[ky * nx + i]);
                // The ends of a real signal's spectrum are real; rounding left a trace.
                spectrum[0].im = 0.0;
                if my.is_multiple_of(2) {
                    spectrum[my / 2].im = 0.0;
                }
                let done = fft.process_with_scratch(spectrum, row, scratch);
                debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                u.copy_from_slice(&row[..ny]);
            },
        );
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
            let energy = torus.energy(&spectrum, |_, _| 1.0, &p);
            assert!((energy / square - 1.0).abs() < 1e-13);
        }
    }
}
