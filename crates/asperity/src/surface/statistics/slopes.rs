//! Hybrid parameters of ISO 25178-2 (section 4.3), by differences between neighbouring points:
//!
//! ```text
//! Sdq = (<(dz/dx)^2> + <(dz/dy)^2>)^(1/2)
//! Sdr = <sqrt(1 + (dz/dx)^2 + (dz/dy)^2) - 1>      developed over projected area, less one
//! ```
//!
//! Each mean of Sdq is over the pairs of neighbours that are both defined. Sdr is over the squares of four defined points, each
//! with the mean of its two divisions into triangles. For a periodic surface given by its waves see
//! [`rms_gradient`](super::rms_gradient).

use ndarray::parallel::prelude::*;
use ndarray::{ArrayView1, Axis};

use super::super::Surface;
use crate::error::{Result, require};

/// Sdq and Sdr.
///
/// ```
/// use asperity::{Grid, surface::{Surface, statistics::SlopeStatistics}};
/// let grid = Grid::new([3, 3], [3.0, 3.0])?;
/// let plane = ndarray::Array2::from_shape_fn((3, 3), |(i, j)| 0.3 * i as f64 + 0.4 * j as f64);
/// let s = SlopeStatistics::of(&Surface::new(grid, plane)?)?;
/// assert!((s.sdq - 0.5).abs() < 1e-15 && (s.sdr - (1.25f64.sqrt() - 1.0)).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlopeStatistics {
    /// Root mean square slope Sdq.
    pub sdq: f64,
    /// Developed interfacial area ratio Sdr (1 is 100 %); 0 if no square of points is defined.
    pub sdr: f64,
}

/// Sum and count of the squared slopes along x, of those along y, and of the excess areas.
type Sums = [(f64, usize); 3];

impl SlopeStatistics {
    /// The value for the defined points.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if no two neighbours are defined.
    pub fn of(surface: &Surface) -> Result<Self> {
        let (heights, [dx, dy]) = (surface.heights(), surface.grid().spacing());
        // Rows in parallel, their sums added in order.
        let rows: Vec<Sums> = (0..heights.nrows())
            .into_par_iter()
            .map(|i| {
                let next = (i + 1 < heights.nrows()).then(|| heights.index_axis_move(Axis(0), i + 1));
                row_sums(heights.index_axis_move(Axis(0), i), next, [dx, dy])
            })
            .collect();
        let add = |a: Sums, b: &Sums| std::array::from_fn(|k| (a[k].0 + b[k].0, a[k].1 + b[k].1));
        let [along_x, along_y, area] = rows.iter().fold(Sums::default(), add);
        require(
            along_x.1 + along_y.1 > 0,
            "number of defined neighbours",
            0,
            "1 pair at least, to have a slope",
        )?;
        let mean = |(sum, count): (f64, usize)| if count > 0 { sum / count as f64 } else { 0.0 };
        Ok(SlopeStatistics { sdq: (mean(along_x) + mean(along_y)).sqrt(), sdr: mean(area) })
    }
}

fn row_sums(row: ArrayView1<f64>, next: Option<ArrayView1<f64>>, [dx, dy]: [f64; 2]) -> Sums {
    let mut sums = Sums::default();
    let mut add = |kind: usize, value: f64| {
        if value.is_finite() {
            sums[kind] = (sums[kind].0 + value, sums[kind].1 + 1);
        }
    };
    for j in 0..row.len() {
        let right = row.get(j + 1).map(|z| (z - row[j]) / dy);
        let up = next.map(|next| (next[j] - row[j]) / dx);
        right.into_iter().for_each(|slope| add(1, slope * slope));
        up.into_iter().for_each(|slope| add(0, slope * slope));
        if let (Some(low_y), Some(low_x), Some(next)) = (right, up, next) {
            let (high_y, high_x) = ((next[j + 1] - next[j]) / dy, (next[j + 1] - row[j + 1]) / dx);
            // The four triangles of the two cuts, one at each corner of the square.
            let excess = |sx: f64, sy: f64| {
                let square = sx * sx + sy * sy;
                square / (1.0 + (1.0 + square).sqrt())
            };
            let corners =
                excess(low_x, low_y) + excess(low_x, high_y) + excess(high_x, low_y) + excess(high_x, high_y);
            add(2, 0.25 * corners);
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use ndarray::{Array2, array};

    #[test]
    fn a_fine_wave_has_its_closed_forms() {
        // z = A sin(2 pi x): Sdq = sqrt 2 pi A, Sdr = Sdq^2/2 to first order; differences over a
        // 256th of the wave are (pi/256)^2 / 6 = 2.5e-5 too small.
        let grid = Grid::new([2560, 4], [10.0, 1.0]).unwrap();
        let amplitude = 1e-3;
        let wave = Array2::from_shape_fn(grid.shape(), |(i, _)| {
            amplitude * (std::f64::consts::TAU * grid.x(i)).sin()
        });
        let s = SlopeStatistics::of(&Surface::new(grid, wave).unwrap()).unwrap();
        let sdq = 2f64.sqrt() * std::f64::consts::PI * amplitude;
        // The last pair of the row is not closed: one in 2560.
        assert!((s.sdq / sdq - 1.0).abs() < 3e-4, "{}", s.sdq / sdq);
        assert!((s.sdr / (0.5 * sdq * sdq) - 1.0).abs() < 6e-4, "{}", s.sdr);
    }

    #[test]
    fn holes_cost_their_neighbours_only() {
        let grid = Grid::new([3, 4], [3.0, 4.0]).unwrap();
        let mut plane = Array2::from_shape_fn((3, 4), |(i, j)| (i + 2 * j) as f64);
        plane[[1, 1]] = f64::NAN;
        let s = SlopeStatistics::of(&Surface::new(grid, plane).unwrap()).unwrap();
        assert!((s.sdq - 5f64.sqrt()).abs() < 1e-15 && (s.sdr - (6f64.sqrt() - 1.0)).abs() < 1e-15);
    }

    #[test]
    fn a_point_has_no_slope_and_a_row_has_one() {
        let of = |heights: Array2<f64>| {
            let (nx, ny) = heights.dim();
            SlopeStatistics::of(&Surface::new(Grid::new([nx, ny], [1.0, 1.0]).unwrap(), heights).unwrap())
        };
        assert!(of(array![[1.0]]).is_err());
        assert_eq!(of(array![[1.0, 2.0]]).unwrap(), SlopeStatistics { sdq: 2.0, sdr: 0.0 });
    }
}
