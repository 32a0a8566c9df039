//! The lane-batched back end: a vector holds the same element of several rows, or columns.
//!
//! Most fast Fourier transforms vectorise within one signal, which requires shuffles. A convolution of a field has hundreds of
//! signals of the same length, so here every lane of a vector belongs to a different signal, and each lane runs the scalar
//! algorithm:
//!
//! 1. `rows`: a block of rows is transposed into lanes, transformed along y as packed real signals,
//!    and transposed into blocks of columns (`work`);
//! 2. columns (`engine`): every block is transformed along x, multiplied by the real spectrum and
//!    transformed back while it is in the cache;
//! 3. `rows` again, backwards.
//!
//! The transforms (`transform`) leave the spectrum in digit-reversed order; the multiplier is stored in the same order. Zero
//! padding is never stored: the first pass of a transform takes the second half of its input as zero, and the last pass back
//! computes only the first half.
//!
//! Every lane does the same IEEE 754 operations in the same order on all processors, fused multiply-adds included, and no sum
//! depends on the distribution of the work: results are bit-identical for all instruction sets, vector lengths and numbers of
//! threads.
//!
//! # Memory
//! For nx ny cells and the lengths \[mx, my\], in scalars of s bytes: the half spectrum takes nx (my + 2) s, the multiplier
//! 5/8 mx (my/2 + 1) s, and each thread two blocks of lanes, of about 3 mx numbers each. On a free domain of N x N cells
//! (lengths 2 N) that is 26 bytes per cell in f64 and 13 in f32; on a periodic one 10.5 and 5.25.
//!
//! Only this module has `unsafe` code: the intrinsics, which need a suitable processor; the conversion between scalars and
//! vectors; and the transposition, where each thread writes to its own rows in a shared array.
#![allow(unsafe_code)]
// Butterflies are written like their sums, with elements by number.
#![allow(clippy::needless_range_loop)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod butterfly;
mod complex;
mod engine;
mod factors;
#[cfg(target_arch = "x86_64")]
mod intrinsics;
mod leaf;
mod parts;
mod portable;
mod prefetch;
mod real;
mod roots;
mod rows;
mod stage;
#[cfg(test)]
mod tests;
mod transform;
mod vector;
mod work;
mod wrap;

use asperity_sweep::Instructions;
use ndarray::{ArrayView2, CowArray, Ix2};

use engine::Convolve;
pub use engine::Modify;
use factors::{Factors, factors};
pub use real::Real;
use wrap::wrapped_spectrum;

/// The multipliers S(kx, ky) of a convolution, shape (mx/2 + 1, my/2 + 1): lent, or handed over.
pub type Spectrum<'a> = CowArray<'a, f64, Ix2>;

/// A planned convolution of real fields with a real, even spectrum, in `f64` or `f32`.
///
/// ```
/// use asperity_convolution::{even_spectrum, batched::BatchedFft};
///
/// // A kernel that only shifts nothing: K = 1 at distance 0. Its spectrum is 1.
/// let lengths = [BatchedFft::<f64>::good_length(2 * 30 - 1), BatchedFft::<f64>::good_length(2 * 20 - 1)];
/// let spectrum = ndarray::Array2::ones((lengths[0] / 2 + 1, lengths[1] / 2 + 1));
/// let mut convolution = BatchedFft::<f64>::new([30, 20], lengths, spectrum.view());
/// let input: Vec<f64> = (0..600).map(f64::from).collect();
/// let mut output = vec![0.0; 600];
/// convolution.apply_into(&input, &mut output);
/// assert!(input.iter().zip(&output).all(|(p, u)| (p - u).abs() < 1e-12));
/// ```
pub struct BatchedFft<T> {
    engine: Box<dyn Convolve<T>>,
}

impl<T: Real> BatchedFft<T> {
    /// The smallest fast length of at least `minimum` for padding with zeros.
    pub fn good_length(minimum: usize) -> usize {
        factors::good_length(minimum)
    }

    /// Plans a convolution of `cells` = \[nx, ny\], cyclic on `lengths` = \[mx, my\] cells.
    ///
    /// `spectrum` has the shape (mx/2 + 1, my/2 + 1): the real multiplier S(kx, ky), even in kx and ky, for transforms without
    /// normalisation. The fastest lengths are [`Self::good_length`] and, for periodic domains, 2^a 3^b 5^c with my even. All
    /// other lengths are converted to a padded convolution, which needs about three times the work of a periodic one.
    ///
    /// # Panics
    /// If a length is less than the number of cells, a count is 0, or the spectrum has another shape.
    pub fn new(cells: [usize; 2], lengths: [usize; 2], spectrum: ArrayView2<f64>) -> Self {
        Self::with_spectra(cells, lengths, vec![spectrum.into()])
    }

    /// As [`Self::new`], with several spectra for a [`Chain`] of convolutions; the first is that of [`Self::apply_into`].
    ///
    /// # Panics
    /// Also if there is no spectrum.
    pub fn with_spectra(cells: [usize; 2], lengths: [usize; 2], spectra: Vec<Spectrum<'_>>) -> Self {
        Self::on(Instructions::available()[0], cells, lengths, spectra)
    }

    /// As [`Self::with_spectra`], on the given instructions.
    ///
    /// # Panics
    /// Also if the processor does not have them.
    pub fn on(
        instructions: Instructions,
        cells: [usize; 2],
        lengths: [usize; 2],
        spectra: Vec<Spectrum<'_>>,
    ) -> Self {
        assert!(Instructions::available().contains(&instructions), "{instructions:?} is not available");
        assert!(cells[0] > 0 && cells[1] > 0 && lengths[0] >= cells[0] && lengths[1] >= cells[1]);
        assert!(!spectra.is_empty());
        for spectrum in &spectra {
            assert_eq!(spectrum.dim(), (lengths[0] / 2 + 1, lengths[1] / 2 + 1));
        }
        if let Some([x, y]) = factors_of(lengths) {
            return BatchedFft { engine: T::plan(instructions, cells, lengths, [&x, &y], spectra) };
        }
        let longer = Self::converted(cells, lengths).unwrap_or(lengths);
        let wrap = |spectrum: Spectrum| wrapped_spectrum(cells, lengths, longer, spectrum.view()).into();
        Self::on(instructions, cells, longer, spectra.into_iter().map(wrap).collect())
    }

    /// `output` = S * `input`; both C-order, nx ny cells.
    ///
    /// # Panics
    /// If a length is not nx ny.
    pub fn apply_into(&mut self, input: &[T], output: &mut [T]) {
        self.engine.forward(input);
        self.engine.multiply(0);
        self.engine.back(output);
    }

    /// `field` becomes S * `field`; C-order, nx ny cells.
    ///
    /// # Panics
    /// If the length is not nx ny.
    pub fn apply_in_place(&mut self, field: &mut [T]) {
        self.engine.forward(field);
        self.engine.multiply(0);
        self.engine.back(field);
    }

    /// Bytes of a plan with this number of spectra.
    pub fn bytes(cells: [usize; 2], lengths: [usize; 2], spectra: usize) -> usize {
        let [mx, my] = Self::converted(cells, lengths).unwrap_or(lengths);
        let size = size_of::<T>();
        let lanes = WIDEST / size;
        let columns = (my / 2 + 1).next_multiple_of(lanes);
        let plan = size * (2 * cells[0] * columns + spectra * (5 * mx).div_ceil(8) * columns);
        // A signal and its transform, two numbers in each lane, and some rows.
        let thread = WIDEST * (2 * (cells[0].max(cells[1] / 2) + mx.max(my / 2)) + cells[1]);
        plan + rayon::current_num_threads() * thread
    }

    /// Bytes that planning takes besides, where the lengths are converted.
    pub fn converting_bytes(cells: [usize; 2], lengths: [usize; 2]) -> usize {
        let quadrant = |lengths: [usize; 2]| lengths.map(|m| m / 2 + 1).iter().product::<usize>();
        Self::converted(cells, lengths).map_or(0, |longer| 3 * size_of::<f64>() * quadrant(longer))
    }

    /// The lengths in place of those that the engine has no transform of.
    fn converted(cells: [usize; 2], lengths: [usize; 2]) -> Option<[usize; 2]> {
        factors_of(lengths).is_none().then(|| cells.map(|n| Self::good_length(2 * n - 1)))
    }

    /// Starts several consecutive convolutions with an operation on the field in between.
    ///
    /// # Panics
    /// If the length is not nx ny.
    pub fn chain(&mut self, input: &[T]) -> Chain<'_, T> {
        self.engine.forward(input);
        Chain { engine: &mut *self.engine }
    }
}

/// Bytes of the widest vectors.
const WIDEST: usize = 64;

/// The factors of mx and my/2; `None` if the engine has no transform of these lengths.
fn factors_of([mx, my]: [usize; 2]) -> Option<[Factors; 2]> {
    let half = my.is_multiple_of(2).then_some(my / 2)?;
    Some([factors(mx)?, factors(half)?])
}

/// Several consecutive convolutions of a field, with an operation on the cells in between. The operation runs on a few rows at a
/// time while they are in the cache, and only the values that it stores are written to memory.
///
/// ```
/// use asperity_convolution::batched::BatchedFft;
///
/// // x -> 3 x, squared -> 5 x.
/// let [three, five] = [3.0, 5.0].map(|s| ndarray::Array2::from_elem((9, 9), s));
/// let mut plan = BatchedFft::<f64>::with_spectra([16, 16], [16, 16], vec![three.into(), five.into()]);
/// let input: Vec<f64> = (0..256).map(f64::from).collect();
/// let mut output = vec![0.0; 256];
/// let mut chain = plan.chain(&input);
/// chain.multiply(0);
/// chain.modify(&mut [], &|_, x, _| x.iter_mut().for_each(|x| *x *= *x));
/// chain.multiply(1);
/// chain.finish(&mut output, &|_, x, output| output.copy_from_slice(x));
/// assert!(output.iter().zip(&input).all(|(y, x)| (y - 45.0 * x * x).abs() < 1e-8));
/// ```
pub struct Chain<'a, T> {
    engine: &'a mut dyn Convolve<T>,
}

impl<T: Real> Chain<'_, T> {
    /// Replaces x by S * x with the spectrum of this number; returns x'S x of the previous x (Parseval's theorem).
    ///
    /// # Panics
    /// If there is no such spectrum.
    pub fn multiply(&mut self, spectrum: usize) -> f64 {
        self.engine.multiply(spectrum)
    }

    /// `modify(first, x, kept)` changes x, eight rows (sixteen in f32) at a time; `kept` holds the same cells of a field of the
    /// caller, or is empty if there is no field. `first` is the number of the first cell, a multiple of eight. `modify` must not
    /// wait for another thread.
    ///
    /// # Panics
    /// If `kept` has another length.
    pub fn modify(&mut self, kept: &mut [T], modify: &Modify<T>) {
        self.engine.modify(kept, modify, true);
    }

    /// The last operation: x is not convolved again.
    ///
    /// # Panics
    /// If `kept` has another length.
    pub fn finish(self, kept: &mut [T], modify: &Modify<T>) {
        self.engine.modify(kept, modify, false);
    }
}
