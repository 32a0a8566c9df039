//! The depths at which the stress is computed.

use crate::error::{Error, Result, increasing, require};
use crate::grid::{Boundary, Grid};

/// Depths between 0 and this fraction of a cell are refused: they would show the jumps of the pressure from cell to cell.
const SHALLOWEST: f64 = 0.25;
/// Depths beyond this many times the domain are an input error.
const DEEPEST: f64 = 1e9;
/// Depths of [`automatic_depths`] below the surface.
const AUTOMATIC: usize = 24;
/// They reach at least this number of cells.
const CELLS: f64 = 4.0;
/// Depths of less than this number of cells are not resolved by the grid.
pub(super) const RESOLVED: f64 = 2.0;
/// Largest ratio of neighbouring depths around a maximum: with it the search of the maximum by a parabola misses less than 0.5 % below
/// a sphere and a cylinder, with Poisson's ratios of 0 to 0.5; with a ratio of 4 up to 2 %.
const APART: f64 = 3.0;
/// Largest number of depths of a survey: more are an input error.
const MOST: usize = 10_000;

/// 0, and 24 depths in geometric progression from half a cell: on a free domain to 2 sqrt(A/pi), where A is the area of the
/// rectangle around the contact ([`contact_box`]; if that is 0 because there is no contact, the area of the domain); for a line,
/// to the width of the contact; on a periodic domain, to half its shorter side. They reach at least four cells.
///
/// ```
/// use asperity::{Boundary, Grid, stress::automatic_depths};
/// let grid = Grid::new([128, 128], [1e-3, 1e-3])?;
/// let depths = automatic_depths(&grid, Boundary::Periodic, 0.0);
/// assert_eq!((depths.len(), depths[0]), (25, 0.0));
/// assert!((depths[1] - 0.5 * 1e-3 / 128.0).abs() < 1e-18 && (depths[24] - 0.5e-3).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
pub fn automatic_depths(grid: &Grid, boundary: Boundary, contact_box: f64) -> Vec<f64> {
    let area = if contact_box > 0.0 { contact_box } else { grid.area() };
    let deepest = match boundary {
        Boundary::Periodic => 0.5 * grid.shortest_side(),
        // A line is one metre long: its area is its width.
        Boundary::Free if grid.is_line() => area,
        Boundary::Free => 2.0 * (area / std::f64::consts::PI).sqrt(),
    };
    let cell = grid.longest_cell();
    spaced_depths([0.5 * cell, deepest.max(CELLS * cell)], AUTOMATIC, true, true)
}

/// `count` depths from the first to the last, in geometric (`geometric`) or arithmetic progression; with `surface` 0 before
/// them.
pub fn spaced_depths([first, last]: [f64; 2], count: usize, geometric: bool, surface: bool) -> Vec<f64> {
    let depth = |k: usize| match k {
        0 => first,
        k if k + 1 == count => last,
        k => {
            let share = k as f64 / (count - 1) as f64;
            if geometric {
                first * libm::exp(libm::log(last / first) * share)
            } else {
                first + (last - first) * share
            }
        }
    };
    surface.then_some(0.0).into_iter().chain((0..count).map(depth)).collect()
}

/// Depths \[m\] around the largest of the stresses `by_depth` between which the stress may be larger, because no depth is near enough
/// on one side; infinite if none is deeper. `None` if the depths enclose the maximum: the next depths are at most 3 times deeper or
/// shallower, or less than two cells deep.
///
/// ```
/// use asperity::stress::unseen_depths;
/// let depths = [0.0, 1e-6, 2e-6, 5e-6, 50e-6];
/// assert_eq!(unseen_depths(&depths, &[1.0, 2.0, 3.0, 2.0, 1.0], 1e-6), None);
/// assert_eq!(unseen_depths(&depths, &[1.0, 2.0, 2.5, 3.0, 1.0], 1e-6), Some([5e-6, 50e-6]));
/// assert_eq!(unseen_depths(&depths[1..3], &[1.0, 2.0], 1e-6), Some([2e-6, f64::INFINITY]));
/// ```
pub fn unseen_depths(depths: &[f64], by_depth: &[f64], cell: f64) -> Option<[f64; 2]> {
    let best = (0..by_depth.len()).reduce(|best, n| if by_depth[n] > by_depth[best] { n } else { best })?;
    let far = |above: f64, below: f64| below > (APART * above).max(RESOLVED * cell);
    let depth = depths[best];
    let above = best.checked_sub(1).map_or(0.0, |n| depths[n]);
    let below = depths.get(best + 1).copied().unwrap_or(f64::INFINITY);
    let open = [far(above, depth), far(depth, below)];
    open.contains(&true).then_some([if open[0] { above } else { depth }, if open[1] { below } else { depth }])
}

/// Area of the rectangle around the cells under pressure \[m^2\]; for a line, the width of the contact \[m\]; 0 if there are
/// none.
pub fn contact_box(grid: &Grid, pressure: &[f64]) -> f64 {
    let ny = grid.cells()[1];
    let touching = || pressure.iter().enumerate().filter(|(_, p)| **p > 0.0).map(|(n, _)| [n / ny, n % ny]);
    let ends = |axis: usize| {
        touching().fold((usize::MAX, 0), |(least, most), at| (least.min(at[axis]), most.max(at[axis])))
    };
    let [(x0, x1), (y0, y1)] = [ends(0), ends(1)];
    if x0 > x1 { 0.0 } else { ((x1 - x0 + 1) * (y1 - y0 + 1)) as f64 * grid.cell_area() }
}

/// A depth must be 0, or from a quarter of a cell up to 1e9 times the domain.
///
/// # Errors
/// [`Error::Invalid`] for any other.
pub fn check_depth(grid: &Grid, depth: f64) -> Result<()> {
    let shallowest = SHALLOWEST * grid.longest_cell();
    let deepest = DEEPEST * grid.longest_side();
    if depth == 0.0 || (shallowest..=deepest).contains(&depth) {
        return Ok(());
    }
    let expected = match depth > deepest {
        true => format!("at most {deepest:e} m, a thousand million times the domain"),
        false => format!(
            "0, or at least {shallowest:e} m, a quarter of a cell (nearer to the surface the stress shows the steps of \
             the pressure from cell to cell)"
        ),
    };
    Err(Error::invalid("depth", format!("{depth:e} m"), expected))
}

/// Depths of a survey: 1 to 10000 valid depths, each deeper than the previous one.
///
/// # Errors
/// [`Error::Invalid`] with the first invalid depth.
pub fn check_depths(grid: &Grid, depths: &[f64]) -> Result<()> {
    require(
        (1..=MOST).contains(&depths.len()),
        "number of depths",
        depths.len(),
        format!("from 1 to {MOST}"),
    )?;
    depths.iter().try_for_each(|depth| check_depth(grid, *depth))?;
    increasing(depths.iter().copied(), |_| "depth".to_owned(), |depth| format!("{depth:e} m"))
}
