//! Fourier transforms of rustfft and realfft in f64. These crates are generic; planning them here compiles them only once.

use std::sync::Arc;

use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use rustfft::{Fft, FftPlanner};

/// X(k) = sum_j x(j) exp(-2 pi i j k / n).
pub fn forward(n: usize) -> Arc<dyn Fft<f64>> {
    FftPlanner::new().plan_fft_forward(n)
}

/// x(j) = sum_k X(k) exp(2 pi i j k / n).
pub fn inverse(n: usize) -> Arc<dyn Fft<f64>> {
    FftPlanner::new().plan_fft_inverse(n)
}

/// [`forward`] of n real numbers: X(0), ..., X(n/2).
pub fn real_forward(n: usize) -> Arc<dyn RealToComplex<f64>> {
    RealFftPlanner::new().plan_fft_forward(n)
}

/// [`inverse`] to n real numbers.
pub fn real_inverse(n: usize) -> Arc<dyn ComplexToReal<f64>> {
    RealFftPlanner::new().plan_fft_inverse(n)
}
