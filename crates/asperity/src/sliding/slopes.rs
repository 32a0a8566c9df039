//! The slopes of the undeformed gap, which friction comes from.

use ndarray::Array2;
use rustfft::num_complex::Complex64;

use super::{Direction, MovingGap};
use crate::convolution::torus::Torus;
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::surface::Part;

/// dh/dx and dh/dy of the undeformed gap at the cell centres, and the place that moments are taken about.
#[derive(Clone, Debug, PartialEq)]
pub struct Slopes {
    /// dh/dx, shape (nx, ny).
    pub x: Array2<f64>,
    /// dh/dy.
    pub y: Array2<f64>,
    /// The middle of the first shape that has one, else on a free domain the cell of the smallest gap \[m\], from the corner of the domain; NaN where
    /// neither is known.
    pub centre: [f64; 2],
}

impl Slopes {
    /// Of the gap that these parts make. Shapes have closed forms; heights are differentiated as sums of waves on a periodic
    /// domain, else by central differences.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) for a flat punch, whose edge has no slope, and for heights of another shape than the grid's.
    pub fn of(grid: &Grid, boundary: Boundary, parts: &[Part]) -> Result<Slopes> {
        let moving: Vec<(Part, bool)> = parts.iter().map(|part| (part.clone(), true)).collect();
        Ok(MovingGap::new(grid, boundary, &moving)?.at(0.0, Direction::X).1)
    }

    /// Of what a field adds to a gap, by central differences: it may have kinks.
    pub(crate) fn of_heights(grid: &Grid, boundary: Boundary, added: &Array2<f64>) -> Slopes {
        let [x, y] = [0, 1].map(|axis| central(grid, boundary, added, axis));
        Slopes { x, y, centre: [f64::NAN; 2] }
    }

    /// With those of what is added to the gap.
    pub(crate) fn and(&self, added: &Slopes) -> Slopes {
        Slopes { x: &self.x + &added.x, y: &self.y + &added.y, centre: self.centre }
    }
}

/// dz/dx and dz/dy of a field.
pub(super) fn derivatives(grid: &Grid, boundary: Boundary, z: &Array2<f64>) -> [Array2<f64>; 2] {
    match boundary {
        Boundary::Periodic => spectral(grid, z),
        Boundary::Free => [0, 1].map(|axis| central(grid, boundary, z, axis)),
    }
}

fn spectral(grid: &Grid, z: &Array2<f64>) -> [Array2<f64>; 2] {
    let cells = grid.cells();
    let mut torus = Torus::new(cells, cells);
    let input: Vec<f64> = z.iter().copied().collect();
    [0, 1].map(|axis| {
        let mut out = Array2::zeros(grid.shape());
        let fundamental = std::f64::consts::TAU / grid.size()[axis];
        let spectrum = torus.spectrum(|kx, ky| {
            let k = [kx, ky][axis];
            // A wave of two cells has no slope at their centres in the mean of its two phases.
            let alternates = 2 * k.unsigned_abs() as usize == cells[axis];
            Complex64::new(0.0, if alternates { 0.0 } else { fundamental * k as f64 })
        });
        if let Some(out) = out.as_slice_mut() {
            torus.apply_into(&spectrum, &input, out);
        }
        out
    })
}

fn central(grid: &Grid, boundary: Boundary, z: &Array2<f64>, axis: usize) -> Array2<f64> {
    let (cells, step) = (grid.cells()[axis], grid.spacing()[axis]);
    Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let n = [i, j][axis];
        let at = |n: usize| if axis == 0 { z[(n, j)] } else { z[(i, n)] };
        let (before, after, between) = match boundary {
            Boundary::Periodic => ((n + cells - 1) % cells, (n + 1) % cells, 2),
            Boundary::Free => {
                let (before, after) = (n.saturating_sub(1), (n + 1).min(cells - 1));
                (before, after, after - before)
            }
        };
        if after == before { 0.0 } else { (at(after) - at(before)) / (step * between as f64) }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::Shape;

    #[test]
    fn the_slopes_of_shapes_are_the_difference_quotients_of_their_gaps() {
        let grid = Grid::new([40, 30], [4.0, 3.0]).unwrap();
        for shape in [
            Shape::Sphere { radius: 3.0 },
            Shape::Ellipsoid { radius_x: 2.0, radius_y: 5.0 },
            Shape::Cylinder { radius: 2.0 },
            Shape::Wedge { slope: 0.3 },
            Shape::Cone { slope: 0.2 },
            Shape::Wave { amplitude: 0.1, wavelength: [2.0, 3.0] },
            Shape::Wave { amplitude: 0.1, wavelength: [2.0, f64::INFINITY] },
        ] {
            for (x, y) in [(0.7, 0.2), (-0.4, 1.1), (-1.3, -0.6)] {
                let h = 1e-5;
                let [sx, sy] = shape.slope(x, y);
                let quotient = (shape.gap(x + h, y) - shape.gap(x - h, y)) / (2.0 * h);
                let across = (shape.gap(x, y + h) - shape.gap(x, y - h)) / (2.0 * h);
                // h² of numbers of order 1
                assert!((sx - quotient).abs() < 1e-8 && (sy - across).abs() < 1e-8, "{shape:?}");
            }
        }
        let parts = [Part::Shape { shape: Shape::Sphere { radius: 3.0 }, center: [0.5, -0.25] }];
        let slopes = Slopes::of(&grid, Boundary::Free, &parts).unwrap();
        assert_eq!(slopes.centre, [2.5, 1.25]);
        assert!((slopes.x[(0, 0)] - (0.05 - 2.5) / 3.0).abs() < 1e-15);
    }

    #[test]
    fn waves_on_a_periodic_domain_are_differentiated_exactly() {
        let grid = Grid::new([16, 9], [1.0, 1.0]).unwrap();
        let tau = std::f64::consts::TAU;
        let wave = |x: f64, y: f64| (tau * (2.0 * x - y) + 0.3).sin();
        let z = Array2::from_shape_fn((16, 9), |(i, j)| wave(grid.x(i), grid.y(j)));
        let [x, y] = derivatives(&grid, Boundary::Periodic, &z);
        for ((i, j), slope) in x.indexed_iter() {
            let cos = (tau * (2.0 * grid.x(i) - grid.y(j)) + 0.3).cos();
            // roundings of a transform, of numbers of order 10
            assert!((slope - 2.0 * tau * cos).abs() < 1e-12 && (y[(i, j)] + tau * cos).abs() < 1e-12);
        }
    }
}
