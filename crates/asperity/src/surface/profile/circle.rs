//! Removal of a circular form: heights minus the circle that fits them best.
//!
//! ```text
//! z = z0 + s (sqrt(R^2 - (x - x0)^2) - R),    s = 1 where the profile bulges out, -1 where it is hollow
//! ```
//!
//! Least squares by Gauss and Newton in x0, z0 and, unless it is given, R; starting from the parabola that fits best. A tilt of
//! the profile is a shift of x0.

use super::parameters::check;
use crate::error::{Error, Result, positive};

/// Number of steps of the fit; each step doubles the number of correct digits.
const STEPS: usize = 50;

/// Heights \[m\] minus a circle of this radius, or of the radius that fits best; and the radius \[m\], negative for a concave
/// form.
///
/// # Errors
/// [`Error::Invalid`] for fewer than four or undefined heights, a straight profile without a given radius, and a circle that is
/// smaller than the profile.
pub fn remove_circle(heights: &[f64], spacing: f64, radius: Option<f64>) -> Result<(Vec<f64>, f64)> {
    positive("spacing of the profile", spacing, "m")?;
    check(heights, 4)?;
    if let Some(radius) = radius {
        positive("radius of the circle", radius, "m")?;
    }
    let half = 0.5 * spacing * heights.len() as f64;
    // In units of half the length, x from -1 to 1.
    let x: Vec<f64> = (0..heights.len()).map(|i| (2 * i + 1) as f64 / heights.len() as f64 - 1.0).collect();
    let z: Vec<f64> = heights.iter().map(|z| z / half).collect();
    let [_, slope, bend] = fit(&x, &z, |x| [1.0, x, x * x]);
    let sign = if bend <= 0.0 { 1.0 } else { -1.0 };
    let small = |r: f64| {
        Error::invalid(
            "radius of the circle",
            format!("{:e} m", r * half),
            format!("more than half the length of the profile, {half:e} m"),
        )
    };
    let mut r = match radius {
        Some(radius) => radius / half,
        None if bend.abs() <= 1e-12 * z.iter().fold(0.0, |most: f64, z| most.max(z.abs())) || bend == 0.0 => {
            return Err(Error::invalid(
                "radius of the circle",
                "not found",
                "given: the profile is straight",
            ));
        }
        None => 0.5 / bend.abs(),
    };
    // The slope of the parabola at the middle is that of the circle there.
    let mut x0 = sign * slope * r;
    let root = |x0: f64, r: f64, x: f64| r * r - (x - x0) * (x - x0);
    let reaches = |x0: f64, r: f64| [-1.0, 1.0].iter().all(|end| root(x0, r, *end) > 0.0);
    if radius.is_none() {
        r = r.max(1.01 * (1.0 + x0.abs()));
    }
    let mut z0 = 0.0;
    for _ in 0..STEPS {
        if !reaches(x0, r) {
            return Err(small(r));
        }
        let model = |x: f64| z0 + sign * (root(x0, r, x).sqrt() - r);
        let rest: Vec<f64> = x.iter().zip(&z).map(|(x, z)| z - model(*x)).collect();
        let along = |x: f64| sign * (x - x0) / root(x0, r, x).sqrt();
        let by_radius =
            |x: f64| if radius.is_some() { 0.0 } else { sign * (r / root(x0, r, x).sqrt() - 1.0) };
        let [dz, dx, dr] = fit(&x, &rest, |x| [1.0, along(x), by_radius(x)]);
        (z0, x0, r) = (z0 + dz, x0 + dx, r + dr);
        if dz.abs() + dx.abs() + (dr / r).abs() < 1e-13 * (1.0 + x0.abs()) {
            break;
        }
    }
    if !reaches(x0, r) {
        return Err(small(r));
    }
    let flat = x.iter().zip(&z).map(|(x, z)| half * (z - z0 - sign * (root(x0, r, *x).sqrt() - r)));
    Ok((flat.collect(), sign * r * half))
}

/// Coefficients of three functions that fit z best, by the normal equations; 0 if a function adds nothing.
fn fit(x: &[f64], z: &[f64], basis: impl Fn(f64) -> [f64; 3]) -> [f64; 3] {
    let mut m = [[0.0; 4]; 3];
    for (x, z) in x.iter().zip(z) {
        let b = basis(*x);
        for r in 0..3 {
            (0..3).for_each(|c| m[r][c] += b[r] * b[c]);
            m[r][3] += b[r] * z;
        }
    }
    let scale = [0, 1, 2].map(|k| m[k][k]);
    for k in 0..3 {
        if m[k][k] <= 1e-13 * scale[k] || scale[k] == 0.0 {
            m[k] = [0.0; 4];
            continue;
        }
        for r in 0..3 {
            if r != k {
                let factor = m[r][k] / m[k][k];
                (0..4).for_each(|c| m[r][c] -= factor * m[k][c]);
            }
        }
    }
    [0, 1, 2].map(|k| if m[k][k] == 0.0 { 0.0 } else { m[k][3] / m[k][k] })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn round(radius: f64, tilt: f64) -> Vec<f64> {
        (0..400)
            .map(|i| {
                let x = (f64::from(i) - 150.0) * 1e-5;
                radius.signum() * ((radius * radius - x * x).sqrt() - radius.abs()) + tilt * x + 3e-3
            })
            .collect()
    }

    #[test]
    fn a_circle_is_found_and_removed() {
        for radius in [5e-3, -8e-3, 0.4] {
            let (flat, found) = remove_circle(&round(radius, 0.0), 1e-5, None).unwrap();
            // 4 mm of heights in metres: rounding of 1e-3 over a sagitta.
            assert!((found / radius - 1.0).abs() < 1e-8, "{radius} {found}");
            assert!(flat.iter().all(|z| z.abs() < 1e-13), "{radius}");
            let (flat, same) = remove_circle(&round(radius, 0.0), 1e-5, Some(radius.abs())).unwrap();
            assert!(same == radius.abs() * radius.signum() || (same / radius - 1.0).abs() < 1e-12);
            assert!(flat.iter().all(|z| z.abs() < 1e-13));
        }
        // A small tilt rotates the circle about its centre.
        let (flat, _) = remove_circle(&round(0.4, 1e-4), 1e-5, Some(0.4)).unwrap();
        assert!(flat.iter().all(|z| z.abs() < 1e-10));
    }

    #[test]
    fn what_has_no_circle_is_refused() {
        let straight: Vec<f64> = (0..100).map(|i| 1e-6 * f64::from(i)).collect();
        assert!(remove_circle(&[0.0; 100], 1e-5, None).unwrap_err().to_string().contains("straight"));
        assert!(
            remove_circle(&straight, 1e-5, Some(1e-4)).unwrap_err().to_string().contains("half the length")
        );
        assert!(remove_circle(&[0.0, f64::NAN, 0.0, 0.0], 1e-5, None).is_err());
    }
}
