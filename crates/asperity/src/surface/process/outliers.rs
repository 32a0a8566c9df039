//! Spikes of optical instruments: points far from the straight line through their neighbours, in every direction.
//!
//! In each of eight directions u (along the axes and diagonals, `radius` cells long) a height is compared with its neighbours,
//!
//! ```text
//! e_u = z(0) - (z(u) + z(-u))/2      or, where -u is outside or undefined,     z(0) - (2 z(u) - z(2 u))
//! sigma_u = 1.4826 median |e_u|      the standard deviation of a normal e (P. J. Rousseeuw and C. Croux, J. Am. Stat. Assoc. 88
//!                                    (1993) 1273)
//! ```
//!
//! and becomes undefined if it lies on one side in all directions, by more than threshold sigma_u in each. On a Gaussian surface e_u
//! is normal whatever the spectrum and the lay, so that a point is removed by chance with a probability of less than that of a
//! normal number beyond the threshold: 2e-9 for 6. (The distance from the median around a point is not normal: it is large at each
//! summit of a smooth surface.) Steps, ridges and scratches stay: along them e_u is small. A spike may be up to `radius + 1` cells
//! wide. A tilt has no influence.

use ndarray::ArrayView2;
use ndarray::parallel::prelude::*;

use super::Surface;
use crate::error::{Result, positive, require};
use crate::numbers::median;

/// Criteria for outliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outliers {
    /// Robust standard deviations from the line through the neighbours. Default 6.
    pub threshold: f64,
    /// Distance of the neighbours in cells, 1 to 10: spikes up to one cell wider are found. Default 2.
    pub radius: usize,
}

impl Default for Outliers {
    fn default() -> Self {
        Outliers { threshold: 6.0, radius: 2 }
    }
}

/// Directions to the neighbours, in units of the radius; the second half is opposite to the first.
const DIRECTIONS: [[isize; 2]; 8] = [[1, 0], [0, 1], [1, 1], [1, -1], [-1, 0], [0, -1], [-1, -1], [-1, 1]];
/// Robust standard deviations are those of about this number of points.
const SAMPLE: usize = 200_000;

/// The surface with its outliers undefined; fill them next.
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if the threshold is not positive or the radius not between 1 and 10.
pub fn remove_outliers(surface: &Surface, outliers: Outliers) -> Result<Surface> {
    positive("threshold of the outliers", outliers.threshold, "(standard deviations)")?;
    require(
        (1..=10).contains(&outliers.radius),
        "radius of the outliers' neighbourhood",
        outliers.radius,
        "between 1 and 10 cells",
    )?;
    let heights = surface.heights();
    let radius = outliers.radius as isize;
    let directions = DIRECTIONS.map(|[x, y]| [radius * x, radius * y]);
    // Of pairs, and of lines that end at the point.
    let pairs = directions.map(|u| deviation(heights, |at| pair(heights, at, u)));
    let ends = directions.map(|u| deviation(heights, |at| end(heights, at, u)));
    let one = |at: [usize; 2]| {
        let mut side = 0.0;
        for (k, u) in directions.into_iter().enumerate() {
            let (away, sigma) = match pair(heights, at, u) {
                Some(_) if k >= 4 => continue,
                Some(away) => (away, pairs[k]),
                None => match end(heights, at, u) {
                    Some(away) => (away, ends[k]),
                    None => continue,
                },
            };
            let beyond = away.abs() > outliers.threshold * sigma;
            if !beyond || side * away < 0.0 {
                return false;
            }
            side = away;
        }
        side != 0.0
    };
    let mut cleaned = surface.clone();
    cleaned.heights.outer_iter_mut().into_par_iter().enumerate().for_each(|(i, mut row)| {
        row.iter_mut().enumerate().filter(|(j, _)| one([i, *j])).for_each(|(_, z)| *z = f64::NAN);
    });
    Ok(cleaned)
}

/// The height `steps` times `u` from a point, if there is one.
fn height(heights: ArrayView2<f64>, at: [usize; 2], u: [isize; 2], steps: isize) -> Option<f64> {
    let there = |k: usize| at[k].checked_add_signed(steps * u[k]);
    heights.get([there(0)?, there(1)?]).copied().filter(|z| !z.is_nan())
}

/// The height less the mean of both neighbours.
fn pair(heights: ArrayView2<f64>, at: [usize; 2], u: [isize; 2]) -> Option<f64> {
    let of = |steps| height(heights, at, u, steps);
    Some(of(0)? - 0.5 * (of(1)? + of(-1)?))
}

/// The height less that of the line through two neighbours on one side.
fn end(heights: ArrayView2<f64>, at: [usize; 2], u: [isize; 2]) -> Option<f64> {
    let of = |steps| height(heights, at, u, steps);
    Some(of(0)? - (2.0 * of(1)? - of(2)?))
}

/// The robust standard deviation of e_u over the surface; infinite if no point has one.
fn deviation(heights: ArrayView2<f64>, of: impl Fn([usize; 2]) -> Option<f64> + Sync) -> f64 {
    let [nx, ny] = [heights.nrows(), heights.ncols()];
    // Whole rows, evenly spread.
    let every = (nx * ny).div_ceil(SAMPLE);
    let rows: Vec<usize> = (0..nx).step_by(every.min(nx)).collect();
    let sizes = rows
        .into_par_iter()
        .flat_map_iter(|i| (0..ny).filter_map(|j| of([i, j]).map(f64::abs)).collect::<Vec<_>>());
    let mut sizes: Vec<f64> = sizes.collect();
    if sizes.is_empty() {
        return f64::INFINITY;
    }
    let robust = 1.4826 * median(&mut sizes);
    // Heights in coarse steps: most deviations are zero. The mean deviation of a normal e is sqrt(2/pi) sigma.
    let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
    if robust > 0.0 { robust } else { 1.2533 * mean }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use ndarray::Array2;

    /// A long wave with fine roughness of amplitude 0.01.
    fn wave() -> Array2<f64> {
        Array2::from_shape_fn((40, 30), |(i, j)| {
            0.05 * (0.1 * i as f64).sin()
                + 0.001 * j as f64
                + 0.01 * (((i * 13 + j * 7) % 11) as f64 / 5.0 - 1.0)
        })
    }

    #[test]
    fn spikes_go_and_the_surface_stays() {
        let mut spiked = wave();
        for at in [(3, 4), (20, 29), (39, 0)] {
            spiked[at] += 5.0;
        }
        spiked[[10, 10]] = f64::NAN;
        let grid = Grid::new([40, 30], [1.0, 1.0]).unwrap();
        let cleaned = remove_outliers(&Surface::new(grid, spiked).unwrap(), Outliers::default()).unwrap();
        assert_eq!(cleaned.undefined(), 4);
        for at in [(3, 4), (20, 29), (39, 0), (10, 10)] {
            assert!(cleaned.heights()[at].is_nan());
        }
    }

    #[test]
    fn a_step_is_no_outlier_and_a_lone_spike_on_a_plane_is() {
        let grid = Grid::new([20, 20], [1.0, 1.0]).unwrap();
        let step = Array2::from_shape_fn((20, 20), |(i, _)| if i < 10 { 0.0 } else { 1.0 });
        let surface = Surface::new(grid, step).unwrap();
        assert_eq!(remove_outliers(&surface, Outliers::default()).unwrap(), surface);
        let mut flat = Array2::zeros((20, 20));
        flat[[7, 7]] = 1.0;
        let cleaned = remove_outliers(&Surface::new(grid, flat).unwrap(), Outliers::default()).unwrap();
        assert_eq!(cleaned.undefined(), 1);
    }

    #[test]
    fn numbers_outside_their_domain_are_named() {
        let grid = Grid::new([2, 2], [1.0, 1.0]).unwrap();
        let nothing = Surface::new(grid, Array2::from_elem((2, 2), f64::NAN)).unwrap();
        assert_eq!(remove_outliers(&nothing, Outliers::default()).unwrap().undefined(), 4);
        for outliers in [Outliers { threshold: 0.0, radius: 2 }, Outliers { threshold: 3.0, radius: 0 }] {
            assert!(remove_outliers(&nothing, outliers).is_err());
        }
    }

    /// A self-affine surface of 1024 x 1024 cells.
    fn rough(hurst: f64, shortest: f64, seed: u64) -> Array2<f64> {
        use super::super::super::{Roughness, SelfAffine};
        let grid = Grid::new([1024, 1024], [1.024e-3, 1.024e-3]).unwrap();
        let roughness = Roughness::RmsHeight(1e-6);
        let (longest, roll_off) = (5e-4, 2e-4);
        SelfAffine { hurst, roughness, longest, shortest, roll_off, seed }.heights(&grid).unwrap()
    }

    fn removed(heights: Array2<f64>) -> Vec<(usize, usize)> {
        let grid = Grid::new([heights.nrows(), heights.ncols()], [1.0, 1.0]).unwrap();
        let cleaned = remove_outliers(&Surface::new(grid, heights).unwrap(), Outliers::default()).unwrap();
        cleaned.heights().indexed_iter().filter(|(_, z)| z.is_nan()).map(|(at, _)| at).collect()
    }

    #[test]
    fn the_summits_of_gaussian_surfaces_stay() {
        // Smooth waves of 64 cells down to white noise; the expected number of points beyond 6 deviations is 0.002 of each surface.
        for (hurst, shortest, seed) in [(0.8, 6.4e-5, 1), (0.8, 8e-6, 2), (0.3, 2e-6, 3), (1.0, 2.0e-5, 4)] {
            let mut z = rough(hurst, shortest, seed);
            assert_eq!(removed(z.clone()), [], "{hurst} {shortest}");
            // A lay along x: the same surface, eight times as long.
            if seed == 2 {
                let between = |i: usize, j: usize| {
                    let share = (i % 8) as f64 / 8.0;
                    z[[i / 8, j]] * (1.0 - share) + z[[i / 8 + 1, j]] * share
                };
                assert_eq!(removed(Array2::from_shape_fn((1024, 1024), |(i, j)| between(i, j))), [], "lay");
            }
            // One point and a square of 2 x 2, ten deviations of the pairs of the roughest direction high, and a pit in a corner.
            let step = DIRECTIONS.map(|[x, y]| deviation(z.view(), |at| pair(z.view(), at, [2 * x, 2 * y])));
            let high = 40.0 * step.iter().fold(0.0, |m: f64, s| m.max(*s));
            let spikes = [(0, 0), (300, 500), (700, 200), (700, 201), (701, 200), (701, 201)];
            for at in spikes {
                z[at] += if at == (0, 0) { -high } else { high };
            }
            assert_eq!(removed(z), spikes, "{hurst} {shortest}");
        }
    }
}
