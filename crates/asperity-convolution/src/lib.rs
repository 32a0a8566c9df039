//! The convolution engine: u = F^-1 [ S F p ] with a real, even spectrum S, planned once and
//! applied many times.
//!
//! The transform lengths \[mx, my\] are at least the domain's cells \[nx, ny\]; the cells beyond the domain are zeros in the
//! input and are not computed in the output. With mx >= 2 nx - 1 the cyclic convolution is the linear one of the free half-space
//! (DC-FFT: Liu, Wang & Liu, Wear 243, 2000); with mx = nx it is the periodic one.
//!
//! Normalisation: forward and inverse transforms together are the identity.

pub mod batched;
pub mod fft;
mod on_rustfft;
pub mod plane;
mod spectrum;
pub mod torus;

pub use on_rustfft::OnRustfft;
pub use spectrum::even_spectrum;

/// A planned convolution in f64 on the batched engine. Bit-identical on every processor and for any number of threads;
/// `apply_into` allocates nothing.
///
/// ```
/// use asperity_convolution::{Convolution, even_spectrum};
///
/// // K = 1 at distance 0, 1/2 at distance 1 along x, else 0; fields of 3 x 1 cells.
/// let lengths = [Convolution::good_length(5), Convolution::good_length(1)];
/// let mut kernel = ndarray::Array2::zeros((lengths[0] / 2 + 1, lengths[1] / 2 + 1));
/// (kernel[(0, 0)], kernel[(1, 0)]) = (1.0, 0.5);
/// let spectrum = even_spectrum(&kernel, lengths);
/// let mut u = [0.0; 3];
/// Convolution::new([3, 1], lengths, spectrum.view()).apply_into(&[0.0, 2.0, 0.0], &mut u);
/// assert!((u[0] - 1.0).abs() < 1e-15 && (u[1] - 2.0).abs() < 1e-15);
/// ```
pub type Convolution = batched::BatchedFft<f64>;

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    /// The slow reference: the sum over all cells with the kernel K(min(i, mx - i), min(j, my - j)).
    fn direct(cells: [usize; 2], lengths: [usize; 2], kernel: &Array2<f64>, input: &[f64]) -> Vec<f64> {
        let wrap = |d: usize, m: usize| d.min(m - d);
        let mut out = vec![0.0; input.len()];
        for i in 0..cells[0] {
            for j in 0..cells[1] {
                for a in 0..cells[0] {
                    for b in 0..cells[1] {
                        let k = kernel[(wrap(i.abs_diff(a), lengths[0]), wrap(j.abs_diff(b), lengths[1]))];
                        out[i * cells[1] + j] += k * input[a * cells[1] + b];
                    }
                }
            }
        }
        out
    }

    #[test]
    fn equals_the_direct_sum_on_any_shape() {
        for (cells, lengths) in [
            ([1, 1], [1, 1]),
            ([1, 7], [1, 13]),
            ([5, 1], [9, 2]),
            ([8, 8], [16, 16]),
            ([7, 12], [15, 24]),
            ([9, 10], [9, 10]),
            ([13, 6], [13, 12]),
        ] {
            let kernel = Array2::from_shape_fn((lengths[0] / 2 + 1, lengths[1] / 2 + 1), |(i, j)| {
                1.0 / (1.0 + (i * i) as f64 + 2.0 * (j * j) as f64)
            });
            let input: Vec<f64> = (0..cells[0] * cells[1]).map(|n| ((n * 37 % 11) as f64) - 4.0).collect();
            let spectrum = even_spectrum(&kernel, lengths);
            let exact = direct(cells, lengths, &kernel, &input);
            let (mut batched, mut on_rustfft) = (vec![0.0; input.len()], vec![0.0; input.len()]);
            Convolution::new(cells, lengths, spectrum.view()).apply_into(&input, &mut batched);
            OnRustfft::new(cells, lengths, spectrum.view()).apply_into(&input, &mut on_rustfft);
            for output in [batched, on_rustfft] {
                for (u, e) in output.iter().zip(&exact) {
                    // sums of ~100 terms of size 5: a few roundings of that size
                    assert!((u - e).abs() < 1e-13, "{cells:?} {lengths:?}: {u} against {e}");
                }
            }
        }
    }

    #[test]
    fn has_the_same_bits_for_any_number_of_threads() {
        let (cells, lengths) = if cfg!(miri) { ([12, 10], [24, 20]) } else { ([96, 80], [192, 160]) };
        let kernel = Array2::from_shape_fn((lengths[0] / 2 + 1, lengths[1] / 2 + 1), |(i, j)| {
            1.0 / (1.0 + (i + 3 * j) as f64)
        });
        let spectrum = even_spectrum(&kernel, lengths);
        let input: Vec<f64> = (0..cells[0] * cells[1]).map(|n| (n as f64).sin()).collect();
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let mut output = vec![0.0; input.len()];
                Convolution::new(cells, lengths, spectrum.view()).apply_into(&input, &mut output);
                output
            })
        };
        assert_eq!(on(1), on(2));
        assert_eq!(on(1), on(5));
    }

    #[test]
    fn good_lengths_are_no_shorter_and_little_longer() {
        for minimum in 1..3000 {
            let length = Convolution::good_length(minimum);
            // 2^k {1, 3, 5} has no gap wider than a third, but among short lengths some are missing.
            let longest = if minimum < 128 { 2 * minimum.max(8) } else { 4 * minimum / 3 };
            assert!(length >= minimum && length <= longest, "{minimum}: {length}");
        }
    }
}
