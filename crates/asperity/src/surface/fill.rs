//! Filling undefined points of a measured surface.
//!
//! - harmonic: the membrane through the defined points, Laplace's equation z_xx + z_yy = 0 on the
//!   undefined ones (five-point difference, zero slope across the edge of the map); no new peak or pit
//!   appears.
//! - nearest: the height of the nearest defined point (exact Euclidean distance; P. F. Felzenszwalb
//!   and D. P. Huttenlocher, Theory of Computing 8 (2012) 415).

use ndarray::{Array2, ArrayView2};

use super::membrane::Membrane;
use super::spectrum::check_shape;
use crate::error::{Error, Result, require};
use crate::grid::Grid;
use crate::numbers::extent;

/// The treatment of undefined points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Fill {
    /// Refuse the surface: an undefined point is an error.
    Error,
    /// Solve Laplace's equation over the holes.
    #[default]
    Harmonic,
    /// Take the height of the nearest defined point.
    Nearest,
}

/// Heights with every undefined point (not finite) filled \[m\].
///
/// ```
/// use asperity::{Grid, surface::{Fill, fill}};
/// let grid = Grid::new([3, 3], [1.0, 1.0])?;
/// let holed = ndarray::array![[0.0, 1.0, 2.0], [0.0, f64::NAN, 2.0], [0.0, 1.0, 2.0]];
/// let whole = fill(&grid, holed.view(), Fill::Harmonic, 0.2)?;
/// assert!((whole[[1, 1]] - 1.0).abs() < 1e-12); // the mean of its neighbours
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if more than `largest_share` (0 to 1) of the points are undefined, all of them are, `method` is
/// [`Fill::Error`] and one is, or the shape is not the grid's; [`Error::NotConverged`] if the membrane does not converge.
pub fn fill(grid: &Grid, heights: ArrayView2<f64>, method: Fill, largest_share: f64) -> Result<Array2<f64>> {
    check_shape(grid, heights)?;
    require(
        (0.0..=1.0).contains(&largest_share),
        "largest share of undefined points",
        largest_share,
        "between 0 and 1",
    )?;
    let undefined = heights.iter().filter(|z| !z.is_finite()).count();
    let of = || format!("{undefined} of {}", heights.len());
    if undefined == 0 {
        return Ok(heights.to_owned());
    }
    if undefined == heights.len() {
        return Err(Error::invalid("number of undefined heights", of(), "less than all"));
    }
    if undefined as f64 > largest_share * heights.len() as f64 {
        let expected = format!(
            "at most {} %; crop the surface to its defined part or allow a larger share",
            100.0 * largest_share
        );
        return Err(Error::invalid("number of undefined heights", of(), expected));
    }
    match method {
        Fill::Error => {
            Err(Error::invalid("number of undefined heights", of(), "0; fill them (harmonic or nearest)"))
        }
        Fill::Harmonic => harmonic(grid, heights),
        Fill::Nearest => Ok(nearest(grid, heights)),
    }
}

const NONE: usize = usize::MAX;

fn nearest(grid: &Grid, heights: ArrayView2<f64>) -> Array2<f64> {
    let (nx, ny) = heights.dim();
    let [dx, dy] = grid.spacing();
    // Nearest defined point within the row (index along y), the smaller index on a tie.
    let mut in_row = Array2::from_elem((nx, ny), NONE);
    for i in 0..nx {
        let mut last = NONE;
        for j in 0..ny {
            if heights[[i, j]].is_finite() {
                last = j;
            }
            in_row[[i, j]] = last;
        }
        let mut next = NONE;
        for j in (0..ny).rev() {
            if heights[[i, j]].is_finite() {
                next = j;
            }
            let before = in_row[[i, j]];
            if next != NONE && (before == NONE || next - j < j - before) {
                in_row[[i, j]] = next;
            }
        }
    }
    // Then along x the lower envelope of the parabolas d_y(i')^2 + (i - i')^2 dx^2.
    let mut filled = heights.to_owned();
    let mut envelope: Vec<(usize, f64)> = Vec::with_capacity(nx); // (row, from where it is lowest)
    for j in 0..ny {
        envelope.clear();
        let across = |i: usize| (in_row[[i, j]].abs_diff(j) as f64 * dy / dx).powi(2);
        for i in (0..nx).filter(|i| in_row[[*i, j]] != NONE) {
            let mut from = f64::NEG_INFINITY;
            while let Some(&(k, start)) = envelope.last() {
                let (a, b) = (i as f64, k as f64);
                from = ((across(i) + a * a) - (across(k) + b * b)) / (2.0 * (a - b));
                if from > start {
                    break;
                }
                envelope.pop();
                from = f64::NEG_INFINITY;
            }
            envelope.push((i, from));
        }
        let mut piece = 0;
        for i in 0..nx {
            while piece + 1 < envelope.len() && envelope[piece + 1].1 < i as f64 {
                piece += 1;
            }
            if !heights[[i, j]].is_finite() {
                let row = envelope[piece].0;
                filled[[i, j]] = heights[[row, in_row[[row, j]]]];
            }
        }
    }
    filled
}

fn harmonic(grid: &Grid, heights: ArrayView2<f64>) -> Result<Array2<f64>> {
    // Heights relative to their mean in units of their range: the tolerance is then a fraction of it.
    let [low, high] = extent(heights.iter().copied().filter(|z| z.is_finite()));
    let range = high - low;
    let mut filled = heights.to_owned();
    if range == 0.0 || !range.is_finite() {
        filled.mapv_inplace(|z| if z.is_finite() { z } else { low });
        return Ok(filled);
    }
    let start = coarse_to_fine(heights);
    let membrane = Membrane::new(grid, heights.mapv(|z| (z - low) / range).view());
    let mut z: Vec<f64> = membrane.cells().iter().map(|at| (start[*at] - low) / range).collect();
    membrane.solve(&mut z)?;
    for (at, z) in membrane.cells().iter().zip(&z) {
        // By the maximum principle, a membrane stays between its supports.
        filled[*at] = (low + range * z).clamp(low, high);
    }
    Ok(filled)
}

/// A start for the undefined points: means of the defined points over blocks that double in size.
fn coarse_to_fine(heights: ArrayView2<f64>) -> Array2<f64> {
    let (nx, ny) = heights.dim();
    if heights.iter().all(|z| z.is_finite()) || nx * ny == 1 {
        return heights.to_owned();
    }
    let coarse = Array2::from_shape_fn((nx.div_ceil(2), ny.div_ceil(2)), |(i, j)| {
        let block = [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(a, b)| heights.get((2 * i + a, 2 * j + b)));
        let defined = block.into_iter().flatten().filter(|z| z.is_finite());
        let (sum, count) = defined.fold((0.0, 0.0), |(sum, n), z| (sum + z, n + 1.0));
        sum / count // NaN where none is defined
    });
    let coarse = coarse_to_fine(coarse.view());
    Array2::from_shape_fn((nx, ny), |(i, j)| match heights[[i, j]] {
        z if z.is_finite() => z,
        _ => coarse[[i / 2, j / 2]],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holed(heights: &Array2<f64>, hole: impl Fn(usize, usize) -> bool) -> Array2<f64> {
        let mut holed = heights.clone();
        holed.indexed_iter_mut().filter(|((i, j), _)| hole(*i, *j)).for_each(|(_, z)| *z = f64::NAN);
        holed
    }

    #[test]
    fn harmonic_functions_are_filled_exactly() {
        // x, y and x y satisfy the five-point equation; a hole inside, cells of 1 x 0.5.
        let grid = Grid::new([40, 30], [40.0, 15.0]).unwrap();
        let z = Array2::from_shape_fn((40, 30), |(i, j)| {
            let (x, y) = (grid.x(i), grid.y(j));
            2.0 + 0.3 * x - 0.1 * y + 0.05 * x * y + 0.01 * (x * x - y * y)
        });
        let hole =
            |i: usize, j: usize| (5..33).contains(&i) && (4..25).contains(&j) && !(i + j).is_multiple_of(9);
        let filled = fill(&grid, holed(&z, hole).view(), Fill::Harmonic, 0.5).unwrap();
        let range = 40.0;
        for (a, b) in filled.iter().zip(&z) {
            // The residual (1e-12 of the range) is amplified by at most the hole's width squared.
            assert!((a - b).abs() < 1e-12 * range * 400.0, "{a} {b}");
        }
    }

    #[test]
    fn at_the_edge_of_the_map_the_slope_across_it_is_zero() {
        // Two rows at +-1 fade as cosh(kappa (4.5 - i)) towards the edge between cells 4 and "5",
        // f(i-1) + f(i+1) - 4 f(i) = 0: cosh kappa = 2.
        let grid = Grid::new([5, 2], [5.0, 2.0]).unwrap();
        let z = Array2::from_shape_fn((5, 2), |(_, j)| 2.0 * j as f64 - 1.0);
        let filled = fill(&grid, holed(&z, |i, _| i >= 2).view(), Fill::Harmonic, 0.7).unwrap();
        let kappa = 2f64.acosh();
        for i in 1..5 {
            let exact = (kappa * (4.5 - i as f64)).cosh() / (kappa * 3.5).cosh();
            assert!((filled[[i, 1]] - exact).abs() < 1e-11 && (filled[[i, 0]] + exact).abs() < 1e-11);
        }
        let level = Array2::from_elem((5, 2), 2.5);
        assert_eq!(fill(&grid, holed(&level, |i, _| i >= 2).view(), Fill::Harmonic, 0.7).unwrap(), level);
    }

    #[test]
    fn nearest_is_the_nearest_by_exhaustive_search() {
        let grid = Grid::new([13, 17], [13.0, 10.2]).unwrap();
        let z = Array2::from_shape_fn((13, 17), |(i, j)| (i * 100 + j) as f64);
        let hole = |i: usize, j: usize| !(i * 31 + j * 17).is_multiple_of(11);
        let filled = fill(&grid, holed(&z, hole).view(), Fill::Nearest, 1.0).unwrap();
        for ((i, j), got) in filled.indexed_iter() {
            let distance = |a: usize, b: usize| (grid.x(a) - grid.x(i)).hypot(grid.y(b) - grid.y(j));
            let best = (0..13)
                .flat_map(|a| (0..17).map(move |b| (a, b)))
                .filter(|(a, b)| !hole(*a, *b))
                .map(|(a, b)| distance(a, b))
                .fold(f64::INFINITY, f64::min);
            let (a, b) = (*got as usize / 100, *got as usize % 100);
            assert!(!hole(a, b) && distance(a, b) < best + 1e-12, "({i}, {j}) from ({a}, {b})");
        }
    }

    #[test]
    fn too_many_holes_are_refused_with_their_number() {
        let grid = Grid::new([4, 4], [1.0, 1.0]).unwrap();
        let z = holed(&Array2::zeros((4, 4)), |i, _| i < 2);
        let message =
            |z: &Array2<f64>, method, share| fill(&grid, z.view(), method, share).unwrap_err().to_string();
        assert!(message(&z, Fill::Harmonic, 0.25).contains("8 of 16"));
        assert!(message(&z, Fill::Error, 1.0).contains("8 of 16"));
        assert!(message(&Array2::from_elem((4, 4), f64::NAN), Fill::Nearest, 1.0).contains("16 of 16"));
        assert!(message(&Array2::zeros((4, 5)), Fill::Nearest, 1.0).contains("4 x 5"));
        assert!(message(&z, Fill::Harmonic, f64::NAN).contains("share"));
        assert!(fill(&grid, Array2::zeros((4, 4)).view(), Fill::Error, 0.0).is_ok());
    }
}
