//! How long a run takes: the convolutions that an estimate on a coarse grid counts, times what one takes here.

use std::time::Instant;

use asperity::operator::half_space;
use asperity::{Grid, Method, Scheme};
use asperity_io::case::{Case, CostEstimate, Description};
use asperity_io::stress::StressDescription;

/// Cells along a side on which a convolution is timed.
const TIMED: usize = 512;
/// Time of an iteration over that of its convolution (docs/performance.md).
const PROJECTED_CG: f64 = 3.0;
const POLONSKY_KEER: f64 = 2.5;
/// Time of a row without any iteration, and of each term that the material remembers, over that of a convolution.
const ROW: f64 = 0.5;
const TERM: f64 = 0.1;
/// Of the full hereditary sum, one sweep over a field for each past row.
const PAST: f64 = 0.2;
/// Time of a flow that begins with the factorisation of the one before, over that of one alone.
const REUSED: f64 = 0.5;
/// Iterations of the solver for an opening pressure, about.
const OPENING: f64 = 300.0;
/// Bytes of fields that are compressed and stored in a second.
const STORED: f64 = 150e6;
/// Time until the first row \[s\].
const START: f64 = 0.03;

/// What a run takes.
pub(super) struct Cost {
    /// Rows and convolutions.
    pub(super) estimate: CostEstimate,
    /// On the clock \[s\].
    pub(super) seconds: f64,
}

/// The cost of a case; `None` where it cannot be estimated.
pub(super) fn cost(case: &Case, description: &Description) -> Option<Cost> {
    let estimate = case.cost()?;
    let iteration = match case.conditions.solver.method {
        Method::ProjectedCg => PROJECTED_CG,
        Method::PolonskyKeer => POLONSKY_KEER,
    };
    let rows = estimate.rows as f64;
    let past = if case.conditions.scheme == Scheme::Direct { 0.5 * PAST * rows * rows } else { 0.0 };
    let terms = description.retardation_times.len() as f64;
    let units = iteration * estimate.convolutions as f64 + (ROW + TERM * terms) * rows + past;
    let cells = case.conditions.grid.len() as f64;
    let stored = description.stored_rows.unwrap_or(estimate.rows) as f64;
    let fields = 8.0 * cells * (stored * description.fields.len() as f64 + 1.0);
    let flow = if estimate.flows > 0 { REUSED * flow_seconds(case)? } else { 0.0 };
    let seconds = START + units * convolution(case)? + estimate.flows as f64 * flow + fields / STORED;
    Some(Cost { estimate, seconds })
}

/// What a convolution takes here \[s\], timed on a small grid and scaled as N log N.
fn convolution(case: &Case) -> Option<f64> {
    let cells = case.conditions.grid.cells().map(|n| n.min(TIMED));
    let grid = case.conditions.grid.with_cells(cells).ok()?;
    let mut operator = half_space(grid, case.conditions.boundary);
    let pressure = vec![1.0; grid.len()];
    let mut displacement = vec![0.0; grid.len()];
    operator.apply_into(&pressure, &mut displacement);
    let start = Instant::now();
    for _ in 0..3 {
        operator.apply_into(&pressure, &mut displacement);
    }
    let timed = start.elapsed().as_secs_f64() / 3.0;
    Some(timed * growth(&grid, &case.conditions.grid))
}

/// How much longer transforms take on the second grid: N log N.
fn growth(small: &Grid, large: &Grid) -> f64 {
    let cost = |grid: &Grid| grid.len() as f64 * (grid.len() as f64).max(2.0).log2();
    cost(large) / cost(small)
}

/// Cells along a side on which the flow through a gap is timed.
const TIMED_FLOW: usize = 128;

/// What the leakage takes after the run \[s\].
pub(super) fn leak_seconds(case: &Case, description: &Description) -> Option<f64> {
    let leak = case.leakage.as_ref()?;
    let times = leak.times.as_ref().map(Vec::len).or(description.stored_rows)? as f64;
    let opening = if leak.opening { OPENING * PROJECTED_CG * convolution(case)? } else { 0.0 };
    Some(times * (flow_seconds(case)? + opening))
}

/// What one flow takes \[s\]: timed with all cells open on a small grid, and scaled as a sparse factorisation, N^1.3; about half of the
/// cells of a seal are open.
fn flow_seconds(case: &Case) -> Option<f64> {
    let leak = case.leakage.as_ref()?;
    let grid =
        case.conditions.grid.with_cells(case.conditions.grid.cells().map(|n| n.min(TIMED_FLOW))).ok()?;
    let gap = ndarray::Array2::from_elem(grid.shape(), 1e-6);
    let start = Instant::now();
    leak.of_gap(&grid, gap.view(), None, 0.0).ok()?;
    let open = 0.5 * case.conditions.grid.len() as f64 / grid.len() as f64;
    Some(start.elapsed().as_secs_f64() * open.powf(1.3))
}

/// Cells along a side on which the stress at a depth is timed.
const TIMED_STRESS: usize = 128;

/// Times and depths times what the stress at a depth takes here, timed on a small grid and scaled as N log N.
pub(super) fn stress_seconds(case: &Case, description: &StressDescription) -> Option<f64> {
    let cells = case.conditions.grid.cells().map(|n| n.min(TIMED_STRESS));
    let grid = case.conditions.grid.with_cells(cells).ok()?;
    let mut stress = description.poisson.transforms(grid, case.conditions.boundary).ok()?;
    stress.set_pressure(&vec![1.0; grid.len()]).ok()?;
    let mut six = std::array::from_fn(|_| Vec::new());
    let depth = grid.size()[0];
    stress.at(depth, &mut six).ok()?;
    let start = Instant::now();
    stress.at(depth, &mut six).ok()?;
    let timed = start.elapsed().as_secs_f64();
    Some(description.evaluations? as f64 * timed * growth(&grid, &case.conditions.grid))
}

/// What is computed from the stored fields after the run takes \[s\].
pub(super) fn seconds_after(case: &Case, description: &Description) -> f64 {
    let stress = description.stress.as_ref().and_then(|stress| stress_seconds(case, stress));
    leak_seconds(case, description).unwrap_or(0.0) + stress.unwrap_or(0.0)
}
