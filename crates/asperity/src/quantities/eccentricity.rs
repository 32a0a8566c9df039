//! Distance of the centre of pressure from the middle of the contact: |Σ p x / Σ p - mean of x over the cells in contact|.
//!
//! On a periodic domain of length L the means are those around a circle, (L/2π) arg Σ exp(2πi x/L), and the distance is the shorter
//! way round. Where the contact goes around the domain along an axis, it has no middle there, and that axis does not count.

use std::f64::consts::TAU;

use ndarray::ArrayView2;

use crate::grid::{Boundary, Grid};

/// Length of the mean vector of the contact around an axis below which it has no middle along it; 1 for a small contact, 0 for an even one.
const AROUND: f64 = 0.1;

/// The distance \[m\]; 0 without contact, NaN where the contact has no middle along any axis.
pub(crate) fn eccentricity(grid: &Grid, boundary: Boundary, pressure: ArrayView2<'_, f64>) -> f64 {
    let offset = [0, 1].map(|axis| {
        let along = |cell: (usize, usize)| if axis == 0 { grid.x(cell.0) } else { grid.y(cell.1) };
        let touching = || pressure.indexed_iter().filter(|(_, p)| **p > 0.0);
        let length = grid.size()[axis];
        match boundary {
            Boundary::Free => {
                let sums = touching().fold([0.0; 4], |[p, px, n, x], (cell, pressure)| {
                    let at = along(cell);
                    [p + pressure, px + pressure * at, n + 1.0, x + at]
                });
                if sums[2] > 0.0 { sums[1] / sums[0] - sums[3] / sums[2] } else { 0.0 }
            }
            Boundary::Periodic => {
                let mut sums = [[0.0; 2]; 2];
                for (cell, pressure) in touching() {
                    let phase = TAU * along(cell) / length;
                    for (sum, weight) in sums.iter_mut().zip([*pressure, 1.0]) {
                        sum[0] += weight * libm::cos(phase);
                        sum[1] += weight * libm::sin(phase);
                    }
                }
                let [cos, sin] = sums[1];
                if libm::hypot(cos, sin) < AROUND * touching().count() as f64 {
                    return f64::NAN;
                }
                let [of_pressure, of_area] = sums.map(|[cos, sin]| libm::atan2(sin, cos));
                let turn = (of_pressure - of_area) / TAU;
                length * (turn - turn.round())
            }
        }
    });
    let axes = if grid.is_line() { &offset[..1] } else { &offset[..] };
    let squares = axes.iter().filter(|offset| !offset.is_nan()).map(|offset| offset * offset);
    squares.reduce(|a, b| a + b).map_or(f64::NAN, f64::sqrt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::Array2;

    #[test]
    fn a_pressure_that_rises_across_a_strip_bears_a_third_of_its_half_width_beside_the_middle() {
        // p = 1 + b x/a on |x| < a: Σ p x / Σ p = b a/3.
        let grid = Grid::new([400, 3], [4.0, 1.0]).unwrap();
        let (a, b) = (0.5, 0.6);
        for (boundary, middle) in
            [(Boundary::Free, 1.7), (Boundary::Periodic, 2.0), (Boundary::Periodic, 3.9)]
        {
            let pressure = Array2::from_shape_fn(grid.shape(), |(i, _)| {
                let x = grid.x(i) - middle;
                let x = if boundary == Boundary::Periodic { x - 4.0 * (x / 4.0_f64).round() } else { x };
                if x.abs() < a { 1.0 + b * x / a } else { 0.0 }
            });
            let found = eccentricity(&grid, boundary, pressure.view());
            // Cells of 0.01; the mean around the circle weighs by the sine, 3 % for a strip of an eighth of it.
            let tolerance = if boundary == Boundary::Free { 1e-3 } else { 0.04 };
            assert!((found / (b * a / 3.0) - 1.0).abs() < tolerance, "{boundary:?}: {found}");
        }
        let none = Array2::zeros(grid.shape());
        assert_eq!(eccentricity(&grid, Boundary::Free, none.view()), 0.0);
        assert_eq!(eccentricity(&grid, Boundary::Periodic, none.view()), 0.0);
        // Full contact has no middle, whatever its pressure.
        let full = Array2::from_shape_fn(grid.shape(), |(i, _)| 1.0 + 1e-3 * libm::sin(i as f64));
        assert!(eccentricity(&grid, Boundary::Periodic, full.view()).is_nan());
    }
}
