//! From the order of a file to axis 0 = x.

use ndarray::Array2;
use rayon::prelude::*;

use super::Problem;

/// Most points of a topography, as of a grid.
pub(super) const MOST_POINTS: usize = 1 << 31;

/// Number of points nx ny, refused where it is 0 or absurd.
pub(super) fn points(nx: u64, ny: u64) -> Result<usize, Problem> {
    match nx.checked_mul(ny) {
        Some(n) if n > 0 && n <= MOST_POINTS as u64 => Ok(n as usize),
        _ => Err(Problem::malformed(
            "the number of points",
            format!("{nx} x {ny}"),
            "at least 1 along x and y and at most 2^31 in all",
        )),
    }
}

/// Values given line by line (x runs fastest) as an array with axis 0 = x.
///
/// # Panics
/// Never: `values` has nx ny elements where the caller checked it; else the missing ones are NaN.
pub(super) fn from_lines(nx: usize, ny: usize, values: &[f64]) -> Array2<f64> {
    debug_assert_eq!(values.len(), nx * ny);
    let mut columns = vec![f64::NAN; nx * ny];
    // Bands of x, blocks of y: each line of the file is read in runs and each cache line written once.
    const BAND: usize = 16;
    columns.par_chunks_mut(BAND * ny.max(1)).enumerate().for_each(|(band, out)| {
        let first = band * BAND;
        let width = out.len() / ny;
        for (y, line) in values.chunks_exact(nx).enumerate() {
            for (i, value) in line[first..first + width].iter().enumerate() {
                out[i * ny + y] = *value;
            }
        }
    });
    // The lengths agree by construction.
    Array2::from_shape_vec((nx, ny), columns).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_the_file_runs_along_axis_0() {
        let (nx, ny) = (37, 21);
        let values: Vec<f64> = (0..nx * ny).map(|k| k as f64).collect();
        let heights = from_lines(nx, ny, &values);
        for ((x, y), h) in heights.indexed_iter() {
            assert_eq!(*h, (y * nx + x) as f64);
        }
    }

    #[test]
    fn absurd_shapes_are_refused() {
        assert!(
            points(0, 5).is_err() && points(1 << 16, 1 << 16).is_err() && points(u64::MAX, u64::MAX).is_err()
        );
        assert_eq!(points(1 << 15, 1 << 16).ok(), Some(1 << 31));
    }
}
