//! The depth that wear has taken off both bodies.

use asperity_sweep::{each, sums, zeros};
use ndarray::Array2;

use super::recession::depth;
use super::{Recession, Wear};
use crate::grid::{Boundary, Grid};
use crate::process::carry;
use crate::sliding::Slopes;

/// Worn depths \[m\] of the body, in its own frame, and of the counterbody, in that of the grid; empty where it does not wear.
pub(crate) struct Depth {
    grid: Grid,
    boundary: Boundary,
    pub(crate) of_bodies: [Vec<f64>; 2],
    shares: [f64; 2],
}

impl Depth {
    pub(crate) fn new(law: &Wear, grid: Grid, boundary: Boundary) -> Self {
        let of_bodies = law.coefficients.map(|k| if k > 0.0 { zeros(grid.len()) } else { vec![] });
        Depth { grid, boundary, of_bodies, shares: law.shares() }
    }

    /// Adds that of a step under a pressure, the body `offset` cells from its start. Returns the volume \[m³\], and half of what it would
    /// change by with the pressure `before`: an estimate of its error.
    pub(crate) fn add(
        &mut self,
        recession: &Recession,
        pressure: &[f64],
        before: &[f64],
        offset: [f64; 2],
    ) -> [f64; 2] {
        let threshold = recession.threshold;
        let of = |p: f64, k: f64| depth(p, k, threshold);
        let [body, counterbody] = self.shares;
        let [own, track] = &mut self.of_bodies;
        if !track.is_empty() {
            each(track, (pressure, recession.per_pressure()), |z, (p, k)| *z += counterbody * of(p, k));
        }
        if !own.is_empty() && offset == [0.0; 2] {
            each(own, (pressure, recession.per_pressure()), |z, (p, k)| *z += body * of(p, k));
        } else if !own.is_empty() {
            let mut step: Vec<f64> = zeros(pressure.len());
            each(&mut step, (pressure, recession.per_pressure()), |z, (p, k)| *z = body * of(p, k));
            let step = carry(&self.grid, self.boundary, offset.map(|cells| -cells), &step);
            each(own, &step[..], |z, step| *z += step);
        }
        let cells = (pressure, before, recession.per_pressure());
        let sums = sums(cells, |(p, before, k)| [of(p, k), 0.5 * (of(p, k) - of(before, k)).abs()]);
        sums.map(|sum| sum * self.grid.cell_area())
    }

    /// That of the body in the frame of the grid.
    fn on_grid(&self, offset: [f64; 2]) -> Vec<f64> {
        match &self.of_bodies[0] {
            field if field.is_empty() => zeros(self.grid.len()),
            field => carry(&self.grid, self.boundary, offset, field),
        }
    }

    /// Adds it to a gap that does not have it yet. Returns the slopes of the body's own part.
    pub(crate) fn add_to(&self, gap: &mut [f64], offset: [f64; 2]) -> Slopes {
        let own = self.on_grid(offset);
        each(gap, &own[..], |h, z| *h += z);
        if !self.of_bodies[1].is_empty() {
            each(gap, &self.of_bodies[1][..], |h, z| *h += z);
        }
        let own = Array2::from_shape_vec(self.grid.shape(), own).expect("one depth for each cell");
        Slopes::of_heights(&self.grid, self.boundary, &own)
    }

    /// The largest of both \[m\].
    pub(crate) fn largest(&self) -> f64 {
        self.of_bodies.iter().flatten().copied().fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_worn_on_the_way_is_found_again_on_the_body() {
        let grid = Grid::new([8, 6], [8.0, 6.0]).unwrap();
        let law = Wear::new([1.0, 3.0]);
        let mut depth = Depth::new(&law, grid, Boundary::Periodic);
        let mut pressure = vec![0.0; 48];
        pressure[3 * 6 + 2] = 5.0;
        let recession = Recession { scale: 0.1, ..Recession::default() };
        for offset in [[2.0, 0.0], [2.25, 1.0], [-3.5, 0.25]] {
            let [volume, _] = depth.add(&recession, &pressure, &pressure, offset);
            assert_eq!(volume, 0.5);
            let sum: f64 = depth.on_grid(offset).iter().sum();
            let own: f64 = depth.of_bodies[0].iter().sum();
            // moved by linear weights, which add up to 1 up to rounding
            assert!((sum - own).abs() < 1e-15);
        }
        let [own, track] = depth.of_bodies.each_ref().map(|field| field.iter().sum::<f64>());
        assert!((own - 3.0 * 0.125).abs() < 1e-15 && (track - 3.0 * 0.375).abs() < 1e-15);
        // The first step at a whole offset: cell (3, 2) of the grid is cell (1, 2) of the body.
        assert_eq!(track, depth.of_bodies[1][3 * 6 + 2]);
        assert!(depth.of_bodies[0][6 + 2] >= 0.125);
    }
}
