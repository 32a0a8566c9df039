//! Converts any cyclic convolution to a padded one of a length that the engine supports.
//!
//! On n cells a cyclic convolution of length m >= n only uses the distances |d| < n. Its kernel
//! K(d mod m), laid out for a linear convolution on L >= 2 n - 1 cells, gives the same sums:
//!
//! u(i) = sum over j < n of K((i - j) mod m) p(j).

use ndarray::{Array2, ArrayView2};

use crate::spectrum::even_spectrum;

/// The spectrum on the `longer` lengths that is equivalent to `spectrum` on `lengths`, for fields of `cells`.
///
/// Both are real and even, shape (m/2 + 1) along each axis.
pub fn wrapped_spectrum(
    cells: [usize; 2],
    lengths: [usize; 2],
    longer: [usize; 2],
    spectrum: ArrayView2<f64>,
) -> Array2<f64> {
    // An even transform is its own inverse, except for a factor of the number of cells.
    let kernel = even_spectrum(&spectrum.to_owned(), lengths);
    let normalisation = 1.0 / (lengths[0] as f64 * lengths[1] as f64);
    let nearest = |distance: usize, axis: usize| distance.min(lengths[axis] - distance);
    let linear = Array2::from_shape_fn((longer[0] / 2 + 1, longer[1] / 2 + 1), |(i, j)| {
        if i < cells[0] && j < cells[1] {
            kernel[(nearest(i, 0), nearest(j, 1))] * normalisation
        } else {
            0.0
        }
    });
    even_spectrum(&linear, longer)
}
