//! A body with a bed of springs on its surface: K + B, B the compliance of the bed in each cell (Winkler).
//!
//! A surface that recedes by κ p while it is solved, as one that wears does, is to the contact a bed of compliance B = κ/c. K + B is as
//! symmetric and positive as K, and better conditioned: short waves yield at least as the bed does.

use std::sync::Arc;

use asperity_sweep::simd::F64x8;
use asperity_sweep::{Cells, Fields, each, sums};
use ndarray::Array2;

use super::{ApproximateInverse, Operator};
use crate::error::Result;
use crate::grid::{Boundary, Grid};
use crate::kernel::Kernel;

/// The compliance of a bed for unit compliance of the body \[m\]: `scale` in all cells, or `scale` times the number of each cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bed<'a> {
    pub(crate) scale: f64,
    pub(crate) cells: Option<&'a [f64]>,
}

/// A bed that is less compliant than this share of a cell's own influence does not change the approximate inverse.
const STIFF: f64 = 0.125;

impl Bed<'_> {
    pub(crate) fn is_none(&self) -> bool {
        self.scale == 0.0
    }

    /// Eight cells, from `cell` on.
    #[inline(always)]
    pub(crate) fn load<V: F64x8>(&self, cell: usize) -> V {
        let scale = V::splat(self.scale);
        self.cells.map_or(scale, |cells| scale * V::load(cells, cell, 0.0))
    }

    /// Rounded to a power of 2 times the influence of a cell on itself, the compliance that the approximate inverse takes for all cells:
    /// the mean of the cells that have any. `None` where it is small.
    pub(crate) fn level(&self, self_influence: f64) -> Option<i32> {
        let mean = match self.cells {
            None => self.scale,
            Some(cells) => {
                let [sum, count] = sums(cells, |k| [k, f64::from(u8::from(k > 0.0))]);
                if count > 0.0 { self.scale * sum / count } else { 0.0 }
            }
        };
        let share = mean / self_influence;
        (share > STIFF && share.is_finite()).then(|| libm::round(libm::log2(share)) as i32)
    }
}

impl Cells for Bed<'_> {
    fn cells(&self) -> usize {
        self.cells.map_or(0, <[f64]>::len)
    }

    fn split(self, mid: usize) -> (Self, Self) {
        let halves = self.cells.map(|cells| cells.split_at(mid));
        (Bed { cells: halves.map(|h| h.0), ..self }, Bed { cells: halves.map(|h| h.1), ..self })
    }
}

impl Fields for Bed<'_> {
    type Cell = f64;
    #[inline(always)]
    fn at(&self, cell: usize) -> f64 {
        self.cells.map_or(self.scale, |cells| self.scale * cells[cell])
    }
}

/// The body under a bed.
pub(crate) struct Bedded<'a> {
    pub(crate) body: &'a mut dyn Operator,
    pub(crate) bed: Bed<'a>,
    /// Working memory.
    pub(crate) pressure: &'a mut Vec<f64>,
}

impl Operator for Bedded<'_> {
    fn grid(&self) -> &Grid {
        self.body.grid()
    }

    fn boundary(&self) -> Boundary {
        self.body.boundary()
    }

    fn apply_into(&mut self, p: &[f64], u: &mut [f64]) {
        self.body.apply_into(p, u);
        each(u, (p, self.bed), |u, (p, bed)| *u += bed * p);
    }

    fn apply_in_place(&mut self, x: &mut [f64]) {
        self.pressure.clear();
        self.pressure.extend_from_slice(x);
        self.body.apply_in_place(x);
        each(x, (&self.pressure[..], self.bed), |u, (p, bed)| *u += bed * p);
    }

    fn self_influence(&self) -> f64 {
        let most = self.bed.cells.map_or(1.0, |cells| cells.iter().copied().fold(0.0, f64::max));
        self.body.self_influence() + self.bed.scale * most
    }

    /// A uniform pressure presses the bed.
    fn determines_mean(&self) -> bool {
        true
    }

    fn approximate_inverse(&self) -> ApproximateInverse {
        let own = self.body.self_influence();
        let inverse = self.body.approximate_inverse();
        match self.bed.level(own) {
            None => inverse,
            Some(level) => {
                let bed = own * libm::exp2(f64::from(level));
                inverse.of(|kernel| Arc::new(BeddedKernel { kernel, bed }))
            }
        }
    }

    /// The body alone: a start from coarser grids only has to be near.
    fn on_grid(&self, grid: Grid) -> Option<Box<dyn Operator>> {
        self.body.on_grid(grid)
    }
}

/// A kernel under a bed of the same compliance in all cells.
#[derive(Debug)]
struct BeddedKernel {
    kernel: Arc<dyn Kernel>,
    bed: f64,
}

impl Kernel for BeddedKernel {
    fn influence(&self, cell: [f64; 2], count: [usize; 2]) -> Result<Array2<f64>> {
        let mut influence = self.kernel.influence(cell, count)?;
        influence.first_mut().into_iter().for_each(|own| *own += self.bed);
        Ok(influence)
    }

    fn symbol(&self, qx: f64, qy: f64) -> f64 {
        self.kernel.symbol(qx, qy) + self.bed
    }

    fn uniform(&self) -> Option<f64> {
        Some(self.kernel.uniform().unwrap_or(0.0) + self.bed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{ContactState, Method, Prescribed, Problem, Solver, SolverOptions};
    use crate::operator::half_space;

    /// Of a bed far more compliant than the body each cell presses by its own overlap, p = (w - h)/B.
    #[test]
    fn on_a_soft_bed_each_cell_presses_by_its_own_overlap() {
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let grid = Grid::new([40, 36], [1.0, 1.0]).unwrap();
            let gap: Vec<f64> = (0..grid.len())
                .map(|n| {
                    let (x, y) = (grid.x(n / 36) - 0.5, grid.y(n % 36) - 0.5);
                    x * x + y * y
                })
                .collect();
            let cells: Vec<f64> = (0..grid.len()).map(|n| 1.0 + (n % 3) as f64).collect();
            for cells in [None, Some(&cells[..])] {
                let bed = Bed { scale: 1e8, cells };
                let (mut body, mut pressure) = (half_space(grid, boundary), vec![]);
                let mut operator = Bedded { body: &mut *body, bed, pressure: &mut pressure };
                for method in [Method::ProjectedCg, Method::PolonskyKeer] {
                    let mut state = ContactState::new(grid.len());
                    let prescribed = Prescribed::Approach(0.1);
                    let problem =
                        Problem { gap: &gap, compliance: 1.0, hardness: f64::INFINITY.into(), prescribed };
                    let options = SolverOptions { method, ..SolverOptions::default() };
                    let outcome = Solver::new(method, &operator)
                        .solve(&mut operator, &problem, &options, &mut state, None)
                        .unwrap();
                    assert!(outcome.convolutions < 30, "{outcome:?}");
                    for (n, p) in state.pressure.iter().enumerate() {
                        let exact = (0.1 - gap[n]).max(0.0) / bed.at(n);
                        // The body yields 1e-8 of what the bed does; the solver's tolerance is 1e-6 of the mean.
                        assert!((p - exact).abs() < 2e-6 * 0.1e-8, "{n}: {p} {exact}");
                    }
                }
            }
        }
    }
}
