//! A discrete Fourier transform that returns the same bits on every machine.
//!
//! Synthetic surfaces must not depend on the processor, so their transform takes its roots of unity
//! from `libm` (the platform's sine may differ in the last bit, by machine and even by instruction
//! set) and adds in one fixed order. Everything else uses `rustfft`, which is faster.
//!
//! ```text
//! X_j = sum_k x_k exp(+2 pi i j k / n)      not normalised
//! ```
//!
//! The transform has mixed radix and is self-sorting (Stockham; Van Loan, Computational Frameworks for the Fast Fourier
//! Transform, SIAM 1992, section 1.7), with Bluestein's chirp (Van Loan, section 4.2) if a prime factor is large, so the cost is
//! O(n log n) for any length.

use std::f64::consts::{PI, TAU};

use ndarray::parallel::prelude::*;
use ndarray::{Array2, Axis};
use rustfft::num_complex::Complex64;

/// Above this prime factor the chirp is cheaper than the direct sum.
const LARGEST_RADIX: usize = 47;

/// A plan for transforms of one length.
pub(super) struct Transform {
    n: usize,
    kind: Kind,
}

enum Kind {
    /// Radices, and exp(2 pi i k / n) for k < n.
    MixedRadix { radices: Vec<usize>, roots: Vec<Complex64> },
    /// exp(i pi k^2 / n) for k < n, and the transform of its conjugate on `padded`.
    Chirp { chirp: Vec<Complex64>, kernel: Vec<Complex64>, padded: Box<Transform> },
}

impl Transform {
    /// A plan for n >= 1 points.
    pub(super) fn new(n: usize) -> Self {
        let radices = radices(n);
        let kind = if radices.iter().all(|p| *p <= LARGEST_RADIX) {
            let roots = (0..n).map(|k| unit(TAU * (k as f64 / n as f64))).collect();
            Kind::MixedRadix { radices, roots }
        } else {
            Self::plan_chirp(n)
        };
        Transform { n, kind }
    }

    /// j k = (j^2 + k^2 - (j - k)^2) / 2 turns the transform into a convolution with the chirp.
    fn plan_chirp(n: usize) -> Kind {
        let square = |k: usize| (k as u128 * k as u128 % (2 * n as u128)) as f64;
        let chirp: Vec<_> = (0..n).map(|k| unit(PI * (square(k) / n as f64))).collect();
        let padded = Transform::new((2 * n - 1).next_power_of_two());
        let mut kernel = vec![Complex64::ZERO; padded.n];
        for (k, c) in chirp.iter().enumerate() {
            kernel[k] = c.conj();
            kernel[(padded.n - k) % padded.n] = c.conj();
        }
        padded.apply(&mut kernel, &mut vec![Complex64::ZERO; padded.scratch_len()]);
        Kind::Chirp { chirp, kernel, padded: Box::new(padded) }
    }

    /// Length of the scratch space that [`apply`](Self::apply) needs.
    pub(super) fn scratch_len(&self) -> usize {
        match &self.kind {
            Kind::MixedRadix { .. } => self.n,
            Kind::Chirp { padded, .. } => padded.n + padded.scratch_len(),
        }
    }

    /// Transforms `data` in place, with exp(+i), not normalised.
    pub(super) fn apply(&self, data: &mut [Complex64], scratch: &mut [Complex64]) {
        match &self.kind {
            Kind::MixedRadix { radices, roots } => {
                mixed_radix(radices, roots, data, &mut scratch[..self.n]);
            }
            Kind::Chirp { chirp, kernel, padded } => {
                let (work, scratch) = scratch.split_at_mut(padded.n);
                work.fill(Complex64::ZERO);
                for ((w, x), c) in work.iter_mut().zip(data.iter()).zip(chirp) {
                    *w = x * c;
                }
                padded.apply(work, scratch);
                // The inverse transform is the conjugate of the transform of the conjugate.
                for (w, k) in work.iter_mut().zip(kernel) {
                    *w = (*w * k).conj();
                }
                padded.apply(work, scratch);
                let scale = 1.0 / padded.n as f64;
                for ((x, w), c) in data.iter_mut().zip(work).zip(chirp) {
                    *x = w.conj() * c * scale;
                }
            }
        }
    }
}

/// Two-dimensional transforms of one shape.
pub(super) struct Plane {
    along_x: Transform,
    along_y: Transform,
}

impl Plane {
    pub(super) fn new((nx, ny): (usize, usize)) -> Self {
        Plane { along_x: Transform::new(nx), along_y: Transform::new(ny) }
    }

    /// Transforms `data` in place, with exp(+i), not normalised.
    pub(super) fn apply(&self, data: &mut Array2<Complex64>) {
        for (axis, plan) in [(Axis(0), &self.along_y), (Axis(1), &self.along_x)] {
            data.axis_iter_mut(axis).into_par_iter().for_each_init(
                || (vec![Complex64::ZERO; plan.n], vec![Complex64::ZERO; plan.scratch_len()]),
                |(work, scratch), mut lane| {
                    work.iter_mut().zip(&lane).for_each(|(a, b)| *a = *b);
                    plan.apply(work, scratch);
                    lane.iter_mut().zip(work.iter()).for_each(|(a, b)| *a = *b);
                },
            );
        }
    }
}

/// exp(i angle).
fn unit(angle: f64) -> Complex64 {
    let (sin, cos) = libm::sincos(angle);
    Complex64::new(cos, sin)
}

/// Factors of n, fours first.
fn radices(mut n: usize) -> Vec<usize> {
    let mut radices = vec![];
    while n.is_multiple_of(4) {
        radices.push(4);
        n /= 4;
    }
    let mut p = 2;
    while p * p <= n {
        while n.is_multiple_of(p) {
            radices.push(p);
            n /= p;
        }
        p += 1;
    }
    if n > 1 {
        radices.push(n);
    }
    radices
}

/// One pass per radix p: x seen as (p, m, s) becomes y seen as (m, p, s),
/// y(q, r) = w^r sum_k x(k, q) exp(2 pi i k r / p), w = exp(2 pi i q / (p m)).
fn mixed_radix(radices: &[usize], roots: &[Complex64], data: &mut [Complex64], scratch: &mut [Complex64]) {
    let n = data.len();
    let (mut x, mut y) = (data, scratch);
    let (mut m, mut s) = (n, 1);
    for &p in radices {
        m /= p;
        for q in 0..m {
            for j in 0..s {
                let from = |k: usize| x[j + s * (q + m * k)];
                let to = j + s * p * q;
                match p {
                    2 => {
                        let (a, b) = (from(0), from(1));
                        y[to] = a + b;
                        y[to + s] = (a - b) * roots[q * s];
                    }
                    4 => {
                        let (a, b, c, d) = (from(0), from(1), from(2), from(3));
                        let (ac, bd) = (a - c, Complex64::I * (b - d));
                        y[to] = (a + c) + (b + d);
                        y[to + s] = (ac + bd) * roots[q * s];
                        y[to + 2 * s] = ((a + c) - (b + d)) * roots[2 * q * s];
                        y[to + 3 * s] = (ac - bd) * roots[3 * q * s];
                    }
                    _ => {
                        for r in 0..p {
                            let sum = (0..p).map(|k| from(k) * roots[k * r % p * (n / p)]).sum::<Complex64>();
                            y[to + s * r] = sum * roots[q * r * s];
                        }
                    }
                }
            }
        }
        s *= p;
        (x, y) = (y, x);
    }
    if radices.len() % 2 == 1 {
        y.copy_from_slice(x); // the last pass wrote into the scratch space
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn transform(x: &[Complex64]) -> Vec<Complex64> {
        let plan = Transform::new(x.len());
        let mut data = x.to_vec();
        plan.apply(&mut data, &mut vec![Complex64::ZERO; plan.scratch_len()]);
        data
    }

    /// Unstructured numbers: a Weyl sequence.
    fn samples(n: usize) -> Vec<Complex64> {
        let weyl = |k: usize, step: f64| (k as f64 * step).fract() - 0.5;
        (0..n).map(|k| Complex64::new(weyl(k, 0.618_033_988_7), weyl(k, 0.414_213_562_4))).collect()
    }

    #[test]
    fn it_is_the_defining_sum_at_any_length() {
        // 106 = 2 x 53 and 211 go through the chirp; the others through every radix.
        for n in [1, 2, 3, 4, 5, 8, 12, 30, 47, 49, 64, 97, 100, 106, 128, 211] {
            let x = samples(n);
            for (j, got) in transform(&x).iter().enumerate() {
                let sum =
                    (0..n).map(|k| x[k] * unit(TAU * ((j * k % n) as f64 / n as f64))).sum::<Complex64>();
                // eps times the sum's size, a few times over for the passes
                assert!((got - sum).norm() < 2e-15 * n as f64 + 1e-15, "n = {n}, j = {j}: {got} {sum}");
            }
        }
    }

    #[test]
    fn a_long_prime_length_agrees_with_rustfft() {
        let n = 8191;
        let x = samples(n);
        let mut reference = x.clone();
        rustfft::FftPlanner::new().plan_fft_inverse(n).process(&mut reference);
        let size = x.iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt() * (n as f64).sqrt();
        for (a, b) in transform(&x).iter().zip(&reference) {
            assert!((a - b).norm() < 1e-14 * size); // eps log2(n) of the 2-norm
        }
    }
}
