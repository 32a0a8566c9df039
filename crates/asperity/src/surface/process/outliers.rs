//! Spikes of optical instruments: points far from the median of their neighbourhood.
//!
//! With m the median of the defined heights of the (2 radius + 1)^2 cells around a point, d = z - m, and sigma = 1.4826 median
//! |d| (the standard deviation of a normal d; P. J. Rousseeuw and C. Croux, J. Am. Stat. Assoc. 88 (1993) 1273), a point becomes
//! undefined if |d| > threshold sigma. At an edge the neighbourhood is one-sided, so a tilt has an effect there: level the
//! surface first.

use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2, s};

use super::Surface;
use crate::error::{Result, positive, require};

/// Criteria for outliers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outliers {
    /// Robust standard deviations from the local median. Default 6.
    pub threshold: f64,
    /// Cells of the neighbourhood to each side, 1 to 10. Default 2.
    pub radius: usize,
}

impl Default for Outliers {
    fn default() -> Self {
        Outliers { threshold: 6.0, radius: 2 }
    }
}

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
    let deviations = deviations(surface.heights(), outliers.radius);
    let mut sizes: Vec<f64> = deviations.iter().filter(|d| !d.is_nan()).map(|d| d.abs()).collect();
    if sizes.is_empty() {
        return Ok(surface.clone());
    }
    let robust = 1.4826 * median(&mut sizes);
    // Heights in coarse steps: most deviations are zero. The mean deviation of a normal d is
    // sqrt(2/pi) sigma.
    let mean = sizes.iter().sum::<f64>() / sizes.len() as f64;
    let sigma = if robust > 0.0 { robust } else { 1.2533 * mean };
    let mut cleaned = surface.clone();
    cleaned.heights.zip_mut_with(&deviations, |z, d| {
        if d.abs() > outliers.threshold * sigma {
            *z = f64::NAN;
        }
    });
    Ok(cleaned)
}

/// Heights minus the median around them.
fn deviations(heights: ArrayView2<f64>, radius: usize) -> Array2<f64> {
    let ny = heights.ncols();
    let mut deviations = Array2::zeros(heights.dim());
    deviations.outer_iter_mut().into_par_iter().enumerate().for_each_init(
        || Vec::with_capacity((2 * radius + 1).pow(2)),
        |around, (i, mut row)| {
            let mut j = 0;
            while j < ny {
                if radius <= LARGEST_IN_LANES
                    && let Some(medians) = lanes::medians(heights, radius, (i, j))
                {
                    for (lane, median) in medians.into_iter().enumerate() {
                        row[j + lane] = heights[[i, j + lane]] - median;
                    }
                    j += lanes::LANES;
                } else {
                    row[j] = deviation(heights, radius, (i, j), around);
                    j += 1;
                }
            }
        },
    );
    deviations
}

/// The height at a point minus the median of the defined heights around it.
fn deviation(heights: ArrayView2<f64>, radius: usize, (i, j): (usize, usize), around: &mut Vec<f64>) -> f64 {
    let (nx, ny) = heights.dim();
    let z = heights[[i, j]];
    if z.is_nan() {
        return z;
    }
    let rows = i.saturating_sub(radius)..(i + radius + 1).min(nx);
    let columns = j.saturating_sub(radius)..(j + radius + 1).min(ny);
    around.clear();
    around.extend(heights.slice(s![rows, columns]).iter().copied().filter(|z| !z.is_nan()));
    z - median(around)
}

/// The median (the upper one of an even number); reorders the values, of which there is at least one.
fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Neighbourhoods up to this radius are compared lane by lane; the number of comparisons grows with the fourth power of the
/// radius.
const LARGEST_IN_LANES: usize = 3;

/// Medians of several neighbouring points at once, one to a lane of the vector unit.
///
/// Forgetful selection: of any n/2 + 2 of the n values (n odd), the smallest and the largest cannot be the median. They are
/// dropped and the next value is added, until three are left.
mod lanes {
    use ndarray::ArrayView2;

    pub const LANES: usize = 8;
    /// Values of one neighbourhood, (2 * 3 + 1)^2, of which n/2 + 2 are held at a time.
    const HELD: usize = 49 / 2 + 2;

    type Lanes = [f64; LANES];

    /// The medians around (i, j) ... (i, j + LANES - 1); `None` if a neighbourhood is cut off by the edge or holds
    /// an undefined point.
    pub fn medians(heights: ArrayView2<f64>, radius: usize, (i, j): (usize, usize)) -> Option<Lanes> {
        let (nx, ny) = heights.dim();
        if i < radius || i + radius >= nx || j < radius || j + LANES - 1 + radius >= ny {
            return None;
        }
        let side = 2 * radius + 1;
        let line = |a: usize| heights.row(i + a - radius).to_slice()?.get(j - radius..j + radius + LANES);
        // NaN plus anything is NaN.
        let mut sum = 0.0;
        for a in 0..side {
            sum += line(a)?.iter().sum::<f64>();
        }
        if sum.is_nan() {
            return None;
        }
        let mut held = [[0.0; LANES]; HELD];
        let (mut count, mut most) = (0, side * side / 2 + 2);
        for a in 0..side {
            for window in line(a)?.windows(LANES) {
                *held.get_mut(count)? = window.try_into().ok()?;
                count += 1;
                if count == most {
                    count = drop_ends(&mut held[..count]);
                    // On either side of the median, one value fewer remains to be added.
                    most -= 1;
                }
            }
        }
        Some(held[0])
    }

    /// Drops the smallest and the largest; returns the remaining number.
    fn drop_ends(held: &mut [Lanes]) -> usize {
        let n = held.len();
        // Pairs in order: the smallest is among the first halves, the largest among the second.
        let half = n / 2;
        for k in 0..half {
            order(held, k, n - 1 - k);
        }
        for k in 1..n.div_ceil(2) {
            order(held, 0, k);
        }
        for k in half..n - 1 {
            order(held, k, n - 1);
        }
        held[0] = held[n - 2];
        n - 2
    }

    #[inline(always)]
    fn order(held: &mut [Lanes], a: usize, b: usize) {
        let (x, y) = (held[a], held[b]);
        for l in 0..LANES {
            held[a][l] = if y[l] < x[l] { y[l] } else { x[l] };
            held[b][l] = if y[l] < x[l] { x[l] } else { y[l] };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

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

    #[test]
    fn medians_in_lanes_are_the_medians() {
        // Unstructured, with holes and equal heights; every radius with lanes, and one without.
        let heights = Array2::from_shape_fn((23, 41), |(i, j)| match (i * 31 + j * 17) % 53 {
            0 => f64::NAN,
            n => ((n * n * 7 + i * j) % 29) as f64 - 11.0,
        });
        let around = &mut Vec::new();
        for radius in 1..=4 {
            let found = deviations(heights.view(), radius);
            for (at, found) in found.indexed_iter() {
                let expected = deviation(heights.view(), radius, at, around);
                assert!(*found == expected || (found.is_nan() && expected.is_nan()), "{radius} {at:?}");
            }
        }
        let lanes = (3..20).flat_map(|i| (3..30).map(move |j| (i, j)));
        assert!(lanes.filter(|at| lanes::medians(heights.view(), 1, *at).is_some()).count() > 20);
    }
}
