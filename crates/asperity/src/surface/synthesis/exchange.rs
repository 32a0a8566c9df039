//! A surface with given ordered heights and, as closely as possible, the spectrum of another one: iterated exchange of amplitudes
//! (T. Schreiber and A. Schmitz, Phys. Rev. Lett. 77 (1996) 635).

use std::f64::consts::TAU;

use ndarray::Array2;
use rayon::prelude::*;
use rustfft::num_complex::Complex64;

use super::super::fourier::Plane;
use crate::grid::Grid;

/// Largest number of exchanges; a few are usually enough.
const MOST: usize = 40;

/// Heights with the (sorted) `values` and approximately the spectrum of `gaussian`, and their rms gradient.
pub(super) fn exchange(grid: &Grid, gaussian: Array2<f64>, values: &[f64]) -> (Array2<f64>, f64) {
    let plane = Plane::new(grid.shape());
    let mut heights = gaussian;
    let mut wanted = amplitudes(&plane, &heights).mapv(|a| a.norm());
    let sum = |a: &Array2<f64>| a.iter().map(|a| a * a).sum::<f64>();
    // Parseval: values of rms 1 have amplitudes whose squares add up to n^2.
    let n = grid.len() as f64;
    let scale = n / sum(&wanted).sqrt();
    wanted.mapv_inplace(|a| a * scale);

    let mut last = f64::INFINITY;
    for _ in 0..MOST {
        rank(&mut heights, values);
        let mut spectrum = amplitudes(&plane, &heights);
        let missed: f64 = spectrum.iter().zip(&wanted).map(|(a, w)| (a.norm() - w).powi(2)).sum();
        let error = missed.sqrt() / n;
        if error > 0.98 * last {
            return (heights, rms_gradient(grid, &spectrum));
        }
        last = error;
        spectrum.zip_mut_with(&wanted, |a, w| {
            let norm = a.norm();
            *a = if norm > 0.0 { *a * (w / norm) } else { Complex64::ZERO };
        });
        // The transform of the conjugate spectrum of a real field is that field (times n), mirrored twice.
        spectrum.mapv_inplace(|a| a.conj());
        plane.apply(&mut spectrum);
        heights = spectrum.mapv(|z| z.re / n);
    }
    rank(&mut heights, values);
    let spectrum = amplitudes(&plane, &heights);
    (heights, rms_gradient(grid, &spectrum))
}

fn amplitudes(plane: &Plane, heights: &Array2<f64>) -> Array2<Complex64> {
    let mut spectrum = heights.mapv(|z| Complex64::new(z, 0.0));
    plane.apply(&mut spectrum);
    spectrum
}

/// Replaces each height by the value of its rank; equal heights are ranked by position.
fn rank(heights: &mut Array2<f64>, values: &[f64]) {
    let mut order: Vec<(f64, usize)> = heights.iter().copied().zip(0..).collect();
    order.par_sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let ny = heights.ncols();
    for ((_, place), value) in order.iter().zip(values) {
        heights[[place / ny, place % ny]] = *value;
    }
}

/// Spectral rms gradient; Nyquist waves have none along their axis.
fn rms_gradient(grid: &Grid, spectrum: &Array2<Complex64>) -> f64 {
    let [nx, ny] = grid.cells();
    let slope = |k: usize, n: usize, length: f64| match (2 * k).cmp(&n) {
        std::cmp::Ordering::Less => TAU * k as f64 / length,
        std::cmp::Ordering::Equal => 0.0,
        std::cmp::Ordering::Greater => TAU * (n - k) as f64 / length,
    };
    let sum: f64 = spectrum
        .indexed_iter()
        .map(|((i, j), a)| {
            let (qx, qy) = (slope(i, nx, grid.size()[0]), slope(j, ny, grid.size()[1]));
            (qx * qx + qy * qy) * a.norm_sqr()
        })
        .sum();
    sum.sqrt() / grid.len() as f64
}
