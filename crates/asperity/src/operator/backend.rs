//! The back end of the operators: what plans and computes their convolutions, and those of their approximate inverses.
//!
//! An operator says which spectrum it is, on a torus of which lengths; how a convolution is computed, and where, is known to
//! the back end alone. [`Cpu`](super::Cpu) is the one there is. Another (a graphics processor, several machines) is one more
//! implementation of [`Backend`], handed to [`plan_on`](super::plan_on); [`plan`](super::plan) takes
//! [`default_backend`](super::default_backend).
//!
//! Spectra are real and even, for transforms without normalisation: shape (mx/2 + 1, my/2 + 1) for lengths \[mx, my\]. Cells
//! between the domain and the torus hold zeros on the way in and are dropped on the way out. Fields are C-order, nx ny cells.

use std::fmt::Debug;

use ndarray::{Array2, ArrayView2};

/// Plans convolutions.
pub trait Backend: Debug + Send + Sync {
    /// u = F⁻¹\[ S F p \] in double precision, for fields of `cells` on a torus of `lengths`.
    fn plan(
        &self,
        cells: [usize; 2],
        lengths: [usize; 2],
        spectrum: ArrayView2<f64>,
    ) -> Box<dyn ConvolutionPlan>;

    /// Bytes that [`plan`](Self::plan) takes.
    fn bytes(&self, cells: [usize; 2], lengths: [usize; 2]) -> usize;

    /// The approximate inverse with these spectra of M and G, in single precision.
    fn plan_inverse(
        &self,
        cells: [usize; 2],
        lengths: [usize; 2],
        inverse: Array2<f64>,
        screened: Array2<f64>,
    ) -> Box<dyn InversePlan>;

    /// Bytes that [`plan_inverse`](Self::plan_inverse) takes.
    fn inverse_bytes(&self, cells: [usize; 2], lengths: [usize; 2]) -> usize;
}

/// A planned convolution. The same bits for any number of threads; it allocates nothing.
pub trait ConvolutionPlan: Send {
    /// u = K p.
    fn apply_into(&mut self, p: &[f64], u: &mut [f64]);

    /// x becomes K x.
    fn apply_in_place(&mut self, x: &mut [f64]);
}

/// A planned approximate inverse of K, on all cells and on a set of them (see
/// [`ApproximateInverse`](super::ApproximateInverse)). As deterministic as a convolution.
pub trait InversePlan: Send {
    /// z = M r.
    fn apply_into(&mut self, r: &[f32], z: &mut [f32]);

    /// z = M_SS r - a M_SC y, y = D G_CC D M_CS r, on a set S (bits, eight cells in a byte) outside of which r is zero; what z
    /// holds there means nothing. a = b'y / y'M y, or 0 where one of the two is not positive.
    fn apply_on_set_into(&mut self, r: &[f32], set: &[u8], z: &mut [f32]);
}
