//! Converts a kernel in space to its real, even spectrum.

use crate::fft;
use ndarray::parallel::prelude::*;
use ndarray::{Array2, Axis, Zip};

/// S(kx, ky) = sum over all i, j of K(i, j) cos(2 pi (kx i/mx + ky j/my)).
///
/// `kernel` holds K on the quadrant 0 <= i <= mx/2, 0 <= j <= my/2; the other three are its mirror
/// images, as on a torus of `lengths` = \[mx, my\] cells. The result has the same shape.
pub fn even_spectrum(kernel: &Array2<f64>, lengths: [usize; 2]) -> Array2<f64> {
    // Each array is given back before the next but one is made.
    let along_y = transposed(transform_rows(kernel, lengths[1]));
    let along_both = transform_rows(&along_y, lengths[0]);
    drop(along_y);
    transposed(along_both)
}

fn transposed(rows: Array2<f64>) -> Array2<f64> {
    let mut columns = Array2::zeros((rows.ncols(), rows.nrows()));
    Zip::from(&mut columns).and(rows.t()).par_for_each(|to, from| *to = *from);
    columns
}

/// The real spectrum of the even extension of every row to `length`.
fn transform_rows(rows: &Array2<f64>, length: usize) -> Array2<f64> {
    let half = length / 2 + 1;
    let fft = fft::real_forward(length);
    let mut spectrum = Array2::zeros((rows.nrows(), half));
    spectrum
        .axis_iter_mut(Axis(0))
        .into_par_iter()
        .zip(rows.axis_iter(Axis(0)).into_par_iter())
        .for_each_init(
            || (fft.make_input_vec(), fft.make_output_vec(), fft.make_scratch_vec()),
            |(even, transform, scratch), (mut out, row)| {
                for (i, value) in even.iter_mut().enumerate() {
                    *value = row[i.min(length - i)];
                }
                let done = fft.process_with_scratch(even, transform, scratch);
                debug_assert!(done.is_ok(), "the buffers have the plan's lengths");
                out.iter_mut().zip(transform.iter()).for_each(|(o, t)| *o = t.re);
            },
        );
    spectrum
}
