//! A cold start from coarser grids: the contact of the gap averaged over 2 x 2 cells (two of a line), solved roughly (and, in its turn,
//! started from a coarser one), tells where the fine grid will touch and under what pressure.
//!
//! Long waves cost the same number of iterations on every grid, and a quarter (half on a line) for each halving: the fine grid is
//! left with what only it can see. Whatever goes wrong on a coarse grid only costs the start.

use rayon::prelude::*;

use super::{ContactState, Hardness, Problem, Solver, SolverOptions, Task};
use crate::error::{Error, Result};
use crate::grid::Grid;

/// Fewest cells along a side of a coarse grid.
const FEWEST_CELLS: usize = 64;
/// Tolerance on a coarse grid: finer than what its cells can tell.
const COARSE_TOLERANCE: f64 = 3e-3;
/// Iterations on a coarse grid at most.
const COARSE_ITERATIONS: usize = 30;

/// Sets `state.pressure`, so far zero everywhere, to that of coarser grids where the grid has any; the sum of p is only
/// roughly right. Returns the work in convolutions of the fine grid.
///
/// # Errors
/// [`Error::Interrupted`].
pub(super) fn start(task: &mut Task) -> Result<f64> {
    let Task { operator, problem, options, state, interrupt } = task;
    let Some(grid) = coarser(operator.grid()) else {
        return Ok(0.0);
    };
    let Some(mut coarse_operator) = operator.on_grid(grid) else {
        return Ok(0.0);
    };
    let gap = averaged(operator.grid(), problem.gap);
    let of_cells = match problem.hardness {
        Hardness::Cells(cells) => Some(averaged(operator.grid(), cells)),
        Hardness::Uniform(_) => None,
    };
    let hardness = of_cells.as_deref().map_or(problem.hardness, Hardness::Cells);
    let mut solver = Solver::new(options.method, &*coarse_operator);
    let mut coarse = ContactState::new(grid.len());
    let options = SolverOptions {
        tolerance: options.tolerance.max(COARSE_TOLERANCE),
        max_iterations: COARSE_ITERATIONS,
        ..**options
    };
    let problem = Problem { gap: &gap, hardness, ..**problem };
    let convolutions = match solver.solve(&mut *coarse_operator, &problem, &options, &mut coarse, *interrupt)
    {
        Ok(outcome) => outcome.convolutions,
        Err(Error::NotConverged(report)) => report.iterations,
        Err(Error::Interrupted) => return Err(Error::Interrupted),
        Err(_) => return Ok(0.0),
    };
    prolong(&grid, &coarse.pressure, &mut state.pressure);
    Ok(convolutions as f64 * grid.len() as f64 / operator.grid().len() as f64)
}

/// The grid of half as many cells along each side.
fn coarser(grid: &Grid) -> Option<Grid> {
    let [nx, ny] = grid.cells();
    let fits = |n: usize| n.is_multiple_of(2) && n / 2 >= FEWEST_CELLS;
    let halves = fits(nx) && (fits(ny) || grid.is_line());
    halves.then(|| grid.with_cells([nx / 2, ny / 2]).ok()).flatten()
}

/// Mean of 2 x 2 cells, two of a line; infinite ones do not count, unless all are.
fn averaged(fine: &Grid, gap: &[f64]) -> Vec<f64> {
    let ny = fine.cells()[1];
    let across = if fine.is_line() { 1 } else { 2 };
    let mut coarse = vec![0.0; fine.len() / (2 * across)];
    coarse.par_chunks_mut(ny / across).zip(gap.par_chunks(2 * ny)).for_each(|(row, two)| {
        let (first, second) = two.split_at(ny);
        for ((h, a), b) in row.iter_mut().zip(first.chunks_exact(across)).zip(second.chunks_exact(across)) {
            let finite = a.iter().chain(b).filter(|h| h.is_finite());
            let (sum, cells) = finite.fold((0.0, 0.0), |(sum, cells), h| (sum + h, cells + 1.0));
            *h = if cells > 0.0 { sum / cells } else { f64::INFINITY };
        }
    });
    coarse
}

/// Each cell has the pressure of the coarse one around it.
fn prolong(coarse: &Grid, from: &[f64], to: &mut [f64]) {
    let ny = coarse.cells()[1];
    let across = if coarse.is_line() { 1 } else { 2 };
    to.par_chunks_mut(across * ny).enumerate().for_each(|(i, to)| {
        let from = &from[i / 2 * ny..][..ny];
        to.chunks_exact_mut(across).zip(from).for_each(|(cells, p)| cells.fill(*p));
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::{Method, Prescribed};
    use crate::grid::Boundary;
    use crate::operator::half_space;

    /// Bumps of several lengths, one of them that of four cells; a corner cannot touch.
    fn gap(grid: &Grid) -> Vec<f64> {
        let [nx, ny] = grid.cells();
        let mut gap: Vec<f64> = (0..nx * ny)
            .map(|n| {
                let (x, y) = (grid.x(n / ny), grid.y(n % ny));
                let wave = |k: f64, a: f64| a * (1.0 - (k * x + 0.3).cos() * (k * y + 0.7).cos());
                wave(6.0, 0.02) + wave(31.0, 3e-3) + wave(401.0, 2e-4)
            })
            .collect();
        let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
        gap.iter_mut().for_each(|h| *h -= least);
        gap[..nx * ny / 16].fill(f64::INFINITY);
        gap
    }

    #[test]
    fn coarser_grids_lead_to_the_same_contact_in_fewer_convolutions() {
        for (cells, boundary) in [([256, 256], Boundary::Free), ([512, 128], Boundary::Periodic)] {
            let grid = Grid::new(cells, [1.0, 1.0]).unwrap();
            let gap = gap(&grid);
            for (prescribed, hardness) in [
                (Prescribed::Load(0.01), f64::INFINITY),
                (Prescribed::Load(0.01), 0.1),
                (Prescribed::Approach(0.02), f64::INFINITY),
            ] {
                let problem = Problem { gap: &gap, compliance: 1.0, hardness: hardness.into(), prescribed };
                let options = SolverOptions::default();
                let mut operator = half_space(grid, boundary);
                let mut solver = Solver::new(Method::ProjectedCg, &*operator);
                let mut solved = |p: f64| {
                    let mut state = ContactState::new(grid.len());
                    state.pressure.fill(p);
                    let outcome = solver.solve(&mut *operator, &problem, &options, &mut state, None).unwrap();
                    (state, outcome)
                };
                let ((cold, fast), (uniform, slow)) = (solved(0.0), solved(0.01));
                assert!(fast.convolutions <= slow.convolutions, "{fast:?} {slow:?}");
                assert!(fast.iterations < slow.iterations, "{fast:?} {slow:?}");
                // Each is within its own certificate of the solution.
                let apart = cold.energy_distance(&uniform);
                assert!(apart <= fast.certificate + slow.certificate, "{apart}");
            }
        }
    }

    #[test]
    fn the_work_of_a_coarse_grid_counts_as_its_share_of_the_cells() {
        for (grid, share) in
            [(Grid::line(128, 1.0).unwrap(), 0.5), (Grid::new([128, 128], [1.0, 1.0]).unwrap(), 0.25)]
        {
            let coarse = coarser(&grid).unwrap();
            let gap: Vec<f64> = (0..grid.len()).map(|n| 0.1 * grid.x(n / grid.cells()[1]).powi(2)).collect();
            let solved = |grid: Grid, gap: &[f64]| {
                let mut operator = half_space(grid, Boundary::Periodic);
                let mut state = ContactState::new(grid.len());
                let prescribed = Prescribed::Load(0.01);
                let problem = Problem { gap, compliance: 1.0, hardness: f64::INFINITY.into(), prescribed };
                // As a coarse grid is solved, on which there is no coarser one.
                let options = SolverOptions {
                    tolerance: COARSE_TOLERANCE,
                    max_iterations: COARSE_ITERATIONS,
                    ..SolverOptions::default()
                };
                let task = &mut Task {
                    operator: &mut *operator,
                    problem: &problem,
                    options: &options,
                    state: &mut state,
                    interrupt: None,
                };
                let work = start(task).unwrap();
                let mut solver = Solver::new(options.method, &*operator);
                state.pressure.fill(0.0);
                let outcome = solver.solve(&mut *operator, &problem, &options, &mut state, None);
                (work, outcome.map(|outcome| outcome.convolutions))
            };
            let (work, _) = solved(grid, &gap);
            let (none, convolutions) = solved(coarse, &averaged(&grid, &gap));
            assert_eq!((none, work), (0.0, share * convolutions.unwrap() as f64));
        }
    }

    #[test]
    fn only_even_grids_of_some_size_have_a_coarser_one() {
        let coarser = |cells| coarser(&Grid::new(cells, [1.0, 2.0]).unwrap()).map(|g| g.cells());
        assert_eq!(coarser([128, 130]), Some([64, 65]));
        assert_eq!(coarser([128, 129]), None);
        assert_eq!(coarser([126, 256]), None);
    }
}
