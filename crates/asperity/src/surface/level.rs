//! Removing the form of a measured surface by least squares.
//!
//! A measured surface is usually tilted. [`level`] subtracts the mean, plane or quadratic that fits its defined points best;
//! undefined points stay undefined and are ignored.

use ndarray::parallel::prelude::*;
use ndarray::{Array2, ArrayView2};

use crate::error::{Result, require};

/// The form that is subtracted from measured heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Level {
    /// Nothing.
    #[default]
    None,
    /// The mean.
    Mean,
    /// The least-squares plane a + b x + c y.
    Plane,
    /// The least-squares polynomial a + b x + c y + d x^2 + e x y + f y^2.
    Quadratic,
}

/// Heights minus their least-squares form \[m\]; undefined points (not finite) become NaN.
///
/// A coefficient that the defined points do not determine (a single row has no slope across it)
/// is zero.
///
/// ```
/// use asperity::surface::{Level, level};
/// let tilted = ndarray::array![[0.0, 1.0, 2.0], [3.0, f64::NAN, 5.0]];
/// let flat = level(tilted.view(), Level::Plane)?;
/// assert!(flat[[0, 2]].abs() < 1e-14 && flat[[1, 1]].is_nan());
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if a form must be removed and no height is defined.
pub fn level(heights: ArrayView2<f64>, form: Level) -> Result<Array2<f64>> {
    let mut flat = heights.to_owned();
    flat.par_mapv_inplace(|z| if z.is_finite() { z } else { f64::NAN });
    let remove = match form {
        Level::None => return Ok(flat),
        Level::Mean => remove::<1>,
        Level::Plane => remove::<3>,
        Level::Quadratic => remove::<6>,
    };
    require(
        !flat.iter().all(|z| z.is_nan()),
        "number of defined heights",
        0,
        "1 at least, to level the surface",
    )?;
    // Twice: the second pass removes the rounding error of a form much larger than the roughness.
    remove(&mut flat);
    remove(&mut flat);
    Ok(flat)
}

/// Subtracts the least-squares form of the first T basis functions.
fn remove<const T: usize>(flat: &mut Array2<f64>) {
    let (form, shape) = (fit::<T>(flat.view()), flat.dim());
    flat.outer_iter_mut().into_par_iter().enumerate().for_each(|(i, mut row)| {
        for (j, z) in row.iter_mut().enumerate() {
            let b = basis((i, j), shape);
            *z -= (0..T).map(|t| form[t] * b[t]).sum::<f64>();
        }
    });
}

/// 1, x, y, x^2 - 1/3, x y, y^2 - 1/3 on \[-1, 1\] x \[-1, 1\]: nearly orthogonal, so the normal equations are well conditioned.
#[inline(always)]
fn basis((i, j): (usize, usize), (nx, ny): (usize, usize)) -> [f64; 6] {
    let centred = |i: usize, n: usize| (2 * i + 1) as f64 / n as f64 - 1.0;
    let (x, y) = (centred(i, nx), centred(j, ny));
    [1.0, x, y, x * x - 1.0 / 3.0, x * y, y * y - 1.0 / 3.0]
}

/// Coefficients of the first T basis functions by the normal equations.
fn fit<const T: usize>(heights: ArrayView2<f64>) -> [f64; 6] {
    // Rows are summed separately, then added in order: the same bits for any number of threads.
    let rows: Vec<([[f64; 6]; 6], [f64; 6])> = heights
        .outer_iter()
        .into_par_iter()
        .enumerate()
        .map(|(i, row)| {
            let mut matrix = [[0.0; 6]; 6];
            let mut right = [0.0; 6];
            for (j, z) in row.iter().enumerate().filter(|(_, z)| !z.is_nan()) {
                let b = basis((i, j), heights.dim());
                for r in 0..T {
                    right[r] += b[r] * z;
                    for c in 0..=r {
                        matrix[r][c] += b[r] * b[c];
                    }
                }
            }
            (matrix, right)
        })
        .collect();
    let mut matrix = [[0.0; 6]; 6];
    let mut right = [0.0; 6];
    for (of_row, right_of_row) in &rows {
        for r in 0..T {
            right[r] += right_of_row[r];
            (0..=r).for_each(|c| matrix[r][c] += of_row[r][c]);
        }
    }
    solve(matrix, right, T)
}

/// Cholesky's L L' x = r; a column that depends on the previous ones gets x = 0.
fn solve(mut m: [[f64; 6]; 6], mut x: [f64; 6], terms: usize) -> [f64; 6] {
    let mut depends = [true; 6];
    for k in 0..terms {
        let whole = m[k][k];
        let pivot = whole - (0..k).map(|c| m[k][c] * m[k][c]).sum::<f64>();
        // Products of nearly orthogonal functions: a true pivot is of the size of the diagonal.
        depends[k] = pivot <= 1e-10 * whole.max(m[0][0] * m[0][0] * 1e-10);
        if depends[k] {
            for row in m.iter_mut() {
                row[k] = 0.0;
            }
            continue;
        }
        m[k][k] = pivot.sqrt();
        for r in k + 1..terms {
            m[r][k] = (m[r][k] - (0..k).map(|c| m[r][c] * m[k][c]).sum::<f64>()) / m[k][k];
        }
    }
    for k in 0..terms {
        let known = (0..k).map(|c| m[k][c] * x[c]).sum::<f64>();
        x[k] = if depends[k] { 0.0 } else { (x[k] - known) / m[k][k] };
    }
    for k in (0..terms).rev() {
        let known = (k + 1..terms).map(|r| m[r][k] * x[r]).sum::<f64>();
        x[k] = if depends[k] { 0.0 } else { (x[k] - known) / m[k][k] };
    }
    x[terms..].fill(0.0);
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quadratic of size one with a hole and a small roughness.
    fn surface(roughness: f64) -> Array2<f64> {
        let mut z = Array2::from_shape_fn((17, 12), |(i, j)| {
            let (x, y) = (i as f64, j as f64);
            let rough = if (3 * i + 5 * j) % 7 < 3 { roughness } else { -roughness };
            3.0 - 0.2 * x + 0.7 * y + 0.03 * x * x - 0.02 * x * y + 0.05 * y * y + rough
        });
        z[[4, 5]] = f64::NAN;
        z[[16, 0]] = f64::INFINITY;
        z
    }

    fn largest(z: &Array2<f64>) -> f64 {
        z.iter().filter(|z| !z.is_nan()).fold(0.0, |m, z| m.max(z.abs()))
    }

    #[test]
    fn a_quadratic_is_removed_whole() {
        let flat = level(surface(0.0).view(), Level::Quadratic).unwrap();
        assert!(largest(&flat) < 1e-13, "{}", largest(&flat)); // heights up to 15, rounded
        assert_eq!(flat.iter().filter(|z| z.is_nan()).count(), 2);
    }

    #[test]
    fn what_is_left_is_orthogonal_to_the_form() {
        for (form, terms) in [(Level::Mean, 1), (Level::Plane, 3), (Level::Quadratic, 6)] {
            let flat = level(surface(1e-3).view(), form).unwrap();
            assert!(largest(&flat) > 1e-4);
            for t in 0..terms {
                let moment: f64 = flat
                    .indexed_iter()
                    .filter(|(_, z)| !z.is_nan())
                    .map(|(at, z)| z * basis(at, flat.dim())[t])
                    .sum();
                // 200 terms of size up to ten: rounding of the sum
                assert!(moment.abs() < 1e-12 * largest(&flat).max(1.0), "{form:?} {t}: {moment:e}");
            }
        }
    }

    #[test]
    fn roughness_survives_a_tilt_a_million_times_larger() {
        let rough = |(i, j): (usize, usize)| 1e-6 * ((i * 7 + j * 3) % 5) as f64;
        let level_of = |tilt: f64| {
            let z =
                Array2::from_shape_fn((30, 20), |(i, j)| rough((i, j)) + tilt * (i as f64 - 2.0 * j as f64));
            level(z.view(), Level::Plane).unwrap()
        };
        let (flat, tilted) = (level_of(0.0), level_of(1.0));
        // 1e-6 on heights of 40: 40 eps = 1e-14
        assert!(flat.iter().zip(&tilted).all(|(a, b)| (a - b).abs() < 5e-14));
    }

    #[test]
    fn a_single_row_or_point_is_levelled_too() {
        let row = Array2::from_shape_fn((1, 9), |(_, j)| 2.0 + 3.0 * j as f64);
        assert!(largest(&level(row.view(), Level::Quadratic).unwrap()) < 1e-13);
        let point = Array2::from_elem((1, 1), 5.0);
        assert_eq!(level(point.view(), Level::Plane).unwrap()[[0, 0]], 0.0);
    }

    #[test]
    fn nothing_defined_cannot_be_levelled() {
        let holes = Array2::from_elem((3, 3), f64::NAN);
        assert!(level(holes.view(), Level::Mean).is_err());
        assert!(level(holes.view(), Level::None).is_ok());
    }
}
