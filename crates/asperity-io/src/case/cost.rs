//! The cost of a run, estimated by the case on a coarse grid: its number of rows and of convolutions.
//!
//! How many iterations a row takes depends on what the load does, on the roughness and on the material, hardly on the number of
//! cells, because the solver is preconditioned. So the same case with few cells tells it. For the method of Polonsky and Keer,
//! whose iterations grow with the grid, the number is scaled.

use asperity::quantities::Quantity;
use asperity::surface::Part;
use asperity::{Grid, Method, drive};
use ndarray::Array2;

use super::Case;
use crate::leakage::Leak;

/// Cells along the longer side, of a plane and of a line.
const CELLS: usize = 128;
const CELLS_OF_LINE: usize = 256;
/// Convolutions, and rows, after which the rest of the rows is taken to be like those before.
const ENOUGH: usize = 1200;
const ENOUGH_ROWS: usize = 2000;

/// The estimated cost of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostEstimate {
    /// Rows of the run.
    pub rows: usize,
    /// Convolutions of the run.
    pub convolutions: usize,
    /// Flows of a fluid that acts on the surfaces.
    pub flows: usize,
}

impl Case {
    /// Solves the case on a coarse grid. `None` where that cannot be solved.
    pub fn cost(&self) -> Option<CostEstimate> {
        let parts = self.parts().ok()?;
        let grid = &self.conditions.grid;
        let every = grid.cells()[0].max(grid.cells()[1]).div_ceil(match grid.is_line() {
            true => CELLS_OF_LINE,
            false => CELLS,
        });
        let mut coarse = self.clone();
        coarse.conditions.grid = grid.with_cells(grid.cells().map(|n| n.div_ceil(every))).ok()?;
        coarse.conditions.hardness_map = self.conditions.hardness_map.as_ref().map(|map| sampled(map, every));
        let parts: Option<Vec<Part>> = parts.into_iter().map(|part| sample(part, grid, every)).collect();
        let parts = parts?;
        let simulation = coarse.simulation_of(&parts).ok()?;
        let mut found = CostEstimate { rows: 0, convolutions: 0, flows: 0 };
        let steady = coarse.steady_of(&parts, &simulation).ok()?;
        let mut drive = drive::of(simulation, steady).ok()?;
        let flows = self.leakage.as_ref().is_some_and(Leak::flows_with_the_contact);
        let mut reached = 0.0;
        while let Some(step) = drive.advance().ok()? {
            let row = step.row();
            reached = row.coordinate.value();
            found.rows += 1;
            found.convolutions += row.convolutions;
            let passes = step.quantity(Quantity::OuterIterations).map_or(0.0, |passes| passes[0]);
            found.flows += if flows { passes as usize } else { 0 };
            if found.convolutions >= ENOUGH || found.rows >= ENOUGH_ROWS {
                break;
            }
        }
        let share = if drive.finished() { 1.0 } else { reached / self.conditions.times.end() };
        let found = found.completed(share, self.rows);
        Some(match self.conditions.solver.method {
            Method::ProjectedCg => found,
            Method::PolonskyKeer => found.refined(every),
        })
    }
}

impl CostEstimate {
    /// The whole run, of whose course a `share` was computed, with the number of rows where it is known.
    fn completed(self, share: f64, rows: Option<usize>) -> CostEstimate {
        let most = |n: f64| n.round().clamp(0.0, 1e12) as usize;
        let all = rows.unwrap_or_else(|| most(self.rows as f64 / share.max(1e-6)));
        let of_all = |count: usize| most(count as f64 / self.rows.max(1) as f64 * all as f64);
        CostEstimate { rows: all, convolutions: of_all(self.convolutions), flows: of_all(self.flows) }
    }

    /// The same on a grid so many times finer by the method of Polonsky and Keer, which has no preconditioner: spheres and rough
    /// surfaces on 64 to 512 cells took convolutions in proportion to the power 0.6 to 1.1 of the cells along a side.
    fn refined(self, times: usize) -> CostEstimate {
        let growth = (times as f64).powf(0.75);
        CostEstimate { convolutions: (growth * self.convolutions as f64).round() as usize, ..self }
    }
}

/// A part on the coarse grid.
fn sample(part: Part, fine: &Grid, every: usize) -> Option<Part> {
    match part.heights(fine).ok()? {
        None => Some(part),
        Some(heights) => Some(Part::Heights { name: "heights".into(), heights: sampled(&heights, every) }),
    }
}

/// One of so many values along each axis.
fn sampled(values: &Array2<f64>, every: usize) -> Array2<f64> {
    let (nx, ny) = values.dim();
    let place = |k: usize, n: usize| (k * every + every / 2).min(n - 1);
    Array2::from_shape_fn((nx.div_ceil(every), ny.div_ceil(every)), |(i, j)| {
        values[[place(i, nx), place(j, ny)]]
    })
}
