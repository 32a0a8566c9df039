//! The convolution on rustfft: the reference for results and speed of the batched engine.

use ndarray::{Array2, ArrayView2};
use rustfft::num_complex::Complex64;

use crate::plane::RealPlane;

/// A convolution as [`Convolution`](crate::Convolution), on rustfft. It is slower, rounds differently, and allocates buffers in each
/// application. It serves as the reference for results and speed of the engine.
pub struct OnRustfft {
    plane: RealPlane,
    /// S / (mx my), stored as (ky, kx), in the order of the columns.
    spectrum: Array2<f64>,
    columns: Vec<Complex64>,
}

impl OnRustfft {
    /// Plans a convolution, with the arguments of [`BatchedFft::new`](crate::batched::BatchedFft::new).
    ///
    /// # Panics
    /// If the shapes are inconsistent.
    pub fn new(cells: [usize; 2], lengths: [usize; 2], spectrum: ArrayView2<f64>) -> Self {
        assert_eq!(spectrum.dim(), (lengths[0] / 2 + 1, lengths[1] / 2 + 1));
        let plane = RealPlane::new(cells, lengths);
        let normalisation = 1.0 / (lengths[0] as f64 * lengths[1] as f64);
        let spectrum = spectrum.t().mapv(|s| s * normalisation).as_standard_layout().into_owned();
        OnRustfft { columns: plane.columns(), plane, spectrum }
    }

    /// `output` = S * `input`; both C-order, nx ny cells.
    pub fn apply_into(&mut self, input: &[f64], output: &mut [f64]) {
        self.plane.rows_forward(input, &mut self.columns);
        let spectrum = &self.spectrum;
        self.plane.each_column(&mut self.columns, |transforms, ky, column| {
            let waves = transforms.forward(column);
            let mx = waves.len();
            // S(min(kx, mx - kx), ky)
            waves.iter_mut().enumerate().for_each(|(kx, x)| *x *= spectrum[(ky, kx.min(mx - kx))]);
            column.copy_from_slice(transforms.back());
        });
        self.plane.rows_back(&self.columns, output);
    }
}
