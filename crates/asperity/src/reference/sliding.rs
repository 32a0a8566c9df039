//! Sliding over a viscoelastic half-space in full contact.
//!
//! With the modulus E* = E' + i E'' the friction force of a steady pressure p = (|q|/2) E* h that moves in +x is, per area,
//!
//! ```text
//! sum over the waves of (1/2) |q| q_x |A_q|^2 E''(q_x v)
//! ```
//!
//! (B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840, with the whole surface in contact).

use crate::error::{Result, require};
use crate::material::Creep;
use crate::sliding::Direction;
use crate::surface::Surface;
use crate::surface::statistics::PowerSpectrum;

/// Friction force per area \[Pa\] of a rigid periodic surface that slides in full contact over a half-space, positive
/// against the motion:
///
/// ```text
/// sum over the waves of (1/2) |q| q_e |A_q|^2 E''(q_e v),   q_e = q.e, e the direction
/// ```
///
/// This is exact on every periodic grid. Waves at the Nyquist frequency of an axis have no slope along it. The contact is full
/// only if the mean pressure is large enough, which the caller must ensure.
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) if a point of the surface is undefined, the velocity or its direction not finite, or the creep function
/// that of a fluid.
pub fn full_contact_friction(
    surface: &Surface,
    creep: &Creep,
    velocity: f64,
    direction: Direction,
) -> Result<f64> {
    creep.validate_solid()?;
    let [cos, sin] = direction.unit();
    require(
        velocity.is_finite() && cos.is_finite() && sin.is_finite(),
        "velocity",
        format!("{velocity} m/s, {direction:?}"),
        "finite, and its direction too",
    )?;
    let waves = PowerSpectrum::of(surface)?;
    let stress = waves.waves().filter(|wave| wave.power > 0.0).map(|wave| {
        let along = (wave.wave_vector[0] * cos + wave.wave_vector[1] * sin).abs();
        0.5 * wave.wave_number * along * wave.power * creep.modulus(along * velocity.abs()).1
    });
    Ok(stress.sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;
    use crate::material::Relaxation;
    use ndarray::Array2;
    use std::f64::consts::TAU;

    /// Two relaxing terms.
    fn solid() -> Creep {
        Relaxation::absolute(1.0, &[(3.0, 0.5), (2.0, 5.0)]).unwrap().to_creep().unwrap()
    }

    #[test]
    fn the_sine_has_its_friction() {
        let grid = Grid::new([24, 4], [1.0, 1.0]).unwrap();
        let wave = Array2::from_shape_fn((24, 4), |(i, _)| 0.01 * (TAU * grid.x(i)).cos());
        let wave = Surface::new(grid, wave).unwrap();
        // (v, friction stress), 12 digits.
        for (v, stress) in [
            (0.001, 7.1253200969e-05),
            (0.01, 0.000657346670897),
            (0.1, 0.00141714276864),
            (1.0, 0.000918538406943),
            (10.0, 0.000100435504944),
        ] {
            let [there, back] =
                [v, -v].map(|v| full_contact_friction(&wave, &solid(), v, Direction::X).unwrap());
            assert!((there / stress - 1.0).abs() < 1e-11 && there == back, "{v}: {there} {back}");
        }
    }

    #[test]
    fn waves_of_a_grid_add_their_friction() {
        let grid = Grid::new([24, 18], [2.0, 1.5]).unwrap();
        let creep = solid();
        // Two waves along x and one oblique; their amplitudes do not matter for exactness.
        let height = |(i, j): (usize, usize)| {
            let (x, y) = (grid.x(i), grid.y(j));
            0.01 * (TAU / 2.0 * x).cos()
                + 0.004 * (3.0 * TAU / 2.0 * x + 0.3).sin()
                + 0.002 * (TAU * (x + y / 1.5)).cos()
        };
        let surface = Surface::new(grid, Array2::from_shape_fn((24, 18), height)).unwrap();
        for v in [0.01, 0.3, -4.0_f64] {
            // (q h/2)^2 E''(q v).
            let line = |h: f64, l: f64| {
                let q = TAU / l;
                0.25 * (q * h).powi(2) * creep.modulus(q * v.abs()).1
            };
            // The oblique wave: |q| q_x E''(q_x v) h^2/4.
            let oblique =
                0.25 * 0.002f64.powi(2) * TAU.hypot(TAU / 1.5) * TAU * creep.modulus(TAU * v.abs()).1;
            let sum = line(0.01, 2.0) + line(0.004, 2.0 / 3.0) + oblique;
            let got = full_contact_friction(&surface, &creep, v, Direction::X).unwrap();
            assert!((got / sum - 1.0).abs() < 1e-12, "{v}: {got} {sum}"); // rounding of the transform
            let across = full_contact_friction(&surface, &creep, v, Direction::Y).unwrap();
            let qy = TAU / 1.5;
            let alone = 0.25 * 0.002f64.powi(2) * TAU.hypot(qy) * qy * creep.modulus(qy * v.abs()).1;
            assert!((across / alone - 1.0).abs() < 1e-12, "{v}: {across} {alone}");
        }
        assert_eq!(full_contact_friction(&surface, &Creep::elastic(1.0), 1.0, Direction::X).unwrap(), 0.0);
    }

    #[test]
    fn absurd_numbers_are_named() {
        let fluid = Creep { fluidity: 1.0, ..solid() };
        let flat = Surface::new(Grid::new([2, 2], [1.0, 1.0]).unwrap(), Array2::zeros((2, 2))).unwrap();
        for (creep, velocity, direction, word) in [
            (fluid, 1.0, Direction::X, "fluidity"),
            (Creep::elastic(0.0), 1.0, Direction::X, "compliance at long times"),
            (solid(), f64::NAN, Direction::X, "velocity"),
            (solid(), 1.0, Direction::Angle(f64::INFINITY), "direction"),
        ] {
            let message = full_contact_friction(&flat, &creep, velocity, direction).unwrap_err().to_string();
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
