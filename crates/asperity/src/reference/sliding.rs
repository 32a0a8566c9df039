//! Closed forms for sliding over a viscoelastic half-space: a sphere that slides slowly or fast, and waves in full contact.
//!
//! With the complex compliance C~ = C' - i C'' and the modulus E* = E' + i E'' = 1/C~ the friction force of a steady
//! pressure p that moves in +x is
//!
//! ```text
//! F = int d2q/(2 pi)^2 q_x (2/|q|) C''(q_x v) |p^(q)|^2,   in full contact p^ = (|q|/2) E* h^
//! ```
//!
//! (B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840, with the whole surface in contact).

use std::f64::consts::{PI, TAU};

use super::HertzSphere;
use crate::error::{Error, Result, non_negative, positive};
use crate::material::{Creep, Relaxation};
use crate::sliding::Direction;
use crate::surface::Surface;
use crate::surface::statistics::PowerSpectrum;

/// The paraboloid r^2/(2R) that slides under a constant load, far from the speeds of the largest loss.
///
/// The Hertzian pressure, that of the relaxed body in slow sliding and that of the glassy body in fast sliding, has the transform
/// p^ = 2 pi p0 (sin qa - qa cos qa)/(a q^3), and C'' = q_x v sum C_j lambda_j or sum C_j/lambda_j / (q_x v):
///
/// ```text
/// slow:  F = v (sum C_j lambda_j) pi^2 p0^2 a / 3,   fast:  F = (4 pi^2 / 15) p0^2 a^3 (sum C_j / lambda_j) / v
/// ```
///
/// ```
/// use asperity::material::{Creep, CreepTerm};
/// use asperity::reference::SlidingSphere;
/// let terms = vec![CreepTerm { compliance: 0.9, retardation_time: 1.0 }];
/// let creep = Creep { instantaneous: 0.1, terms, fluidity: 0.0 };
/// let sphere = SlidingSphere::under_load(1.0, &creep, 4.0 / 3.0)?;
/// assert!((sphere.slow_friction(1e-3) / (4.0 / 3.0) / 0.9e-3 - 1.0).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SlidingSphere {
    /// Contact at rest.
    pub relaxed: HertzSphere,
    /// Contact at the highest speeds.
    pub glassy: HertzSphere,
    creep: Creep,
}

impl SlidingSphere {
    /// From the load >= 0 \[N\] and the contact creep compliance of a solid.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the radius is not positive, the load negative, the creep function of a fluid or without an
    /// instantaneous compliance.
    pub fn under_load(radius: f64, creep: &Creep, load: f64) -> Result<Self> {
        creep.validate_solid()?;
        positive("instantaneous compliance", creep.instantaneous, "1/Pa")?;
        let relaxed = HertzSphere::under_load(radius, 1.0 / creep.long_time(), load)?;
        let glassy = HertzSphere::under_load(radius, 1.0 / creep.instantaneous, load)?;
        Ok(SlidingSphere { relaxed, glassy, creep: creep.clone() })
    }

    /// Friction force at the speed v \[m/s\], to first order in v lambda_j / a \[N\].
    pub fn slow_friction(&self, v: f64) -> f64 {
        let HertzSphere { peak_pressure: p0, contact_radius: a, .. } = self.relaxed;
        let rate: f64 = self.creep.terms.iter().map(|c| c.compliance * c.retardation_time).sum();
        v.abs() * rate * PI * PI * p0 * p0 * a / 3.0
    }

    /// Friction force at the speed v \[m/s\], to first order in a / (v lambda_j) \[N\].
    pub fn fast_friction(&self, v: f64) -> f64 {
        let HertzSphere { peak_pressure: p0, contact_radius: a, .. } = self.glassy;
        let rate: f64 = self.creep.terms.iter().map(|c| c.compliance / c.retardation_time).sum();
        4.0 * PI * PI / 15.0 * p0 * p0 * a.powi(3) * rate / v.abs()
    }
}

/// A rigid wave h cos(q x), q = 2 pi / wavelength, that slides in +x over a half-space and touches all of it.
///
/// ```text
/// p - mean = (q h / 2) [E'(q v) cos(q x) + E''(q v) sin(q x)],   friction stress = (q^2 h^2 / 4) E''(q v)
/// ```
///
/// with x in the frame of the wave: the pressure is ahead of the crests. The contact is full if the mean pressure is not below
/// the [amplitude](Self::pressure_amplitude).
#[derive(Clone, Debug, PartialEq)]
pub struct FullContactWave {
    /// Amplitude h \[m\].
    pub amplitude: f64,
    /// Wavelength \[m\].
    pub wavelength: f64,
    relaxation: Relaxation,
}

impl FullContactWave {
    /// From the contact creep compliance of a solid.
    ///
    /// # Errors
    /// [`Error::Invalid`] if a length is not positive or the creep function is that of a fluid.
    pub fn new(amplitude: f64, wavelength: f64, creep: &Creep) -> Result<Self> {
        positive("amplitude of the wave", amplitude, "m")?;
        positive("wavelength", wavelength, "m")?;
        creep.validate_solid()?;
        Ok(FullContactWave { amplitude, wavelength, relaxation: creep.to_relaxation()? })
    }

    fn wave_number(&self) -> f64 {
        TAU / self.wavelength
    }

    /// Friction force per area in steady sliding, positive against the motion \[Pa\].
    pub fn friction_stress(&self, v: f64) -> f64 {
        self.scale() * self.modulus(v).1
    }

    /// Amplitude of the pressure in steady sliding \[Pa\].
    pub fn pressure_amplitude(&self, v: f64) -> f64 {
        let (storage, loss) = self.modulus(v);
        0.5 * self.wave_number() * self.amplitude * storage.hypot(loss)
    }

    /// Pressure minus its mean, at the distance x ahead of a crest, in steady sliding \[Pa\].
    pub fn pressure(&self, x: f64, v: f64) -> f64 {
        let ((storage, loss), (sin, cos)) = (self.modulus(v), (self.wave_number() * x).sin_cos());
        let ahead = if v < 0.0 { -sin } else { sin };
        0.5 * self.wave_number() * self.amplitude * (storage * cos + loss * ahead)
    }

    /// Friction force per area at the time t after a start at the speed v, if the body has relaxed below the wave at rest \[Pa\]:
    ///
    /// ```text
    /// (q^2 h^2 / 4) sum_i E_i Re{i s_i},   s_i = -i w tau_i / (1 - i w tau_i) (1 - exp(-t/tau_i + i w t)),   w = q v
    /// ```
    ///
    /// # Errors
    /// [`Error::Invalid`] if the time is negative.
    pub fn friction_stress_after_start(&self, v: f64, t: f64) -> Result<f64> {
        non_negative("time", t, "s")?;
        let w = self.wave_number() * v.abs();
        let (sin, cos) = (w * t).sin_cos();
        let terms = self.relaxation.terms.iter().map(|term| {
            let (x, decay) = (w * term.relaxation_time, (-t / term.relaxation_time).exp());
            // i s = x / (1 - i x) (1 - exp(...)), real part.
            term.modulus * x / (1.0 + x * x) * ((1.0 - decay * cos) + x * decay * sin)
        });
        let dashpot = if t > 0.0 { self.relaxation.viscosity * w } else { 0.0 };
        Ok(self.scale() * (terms.sum::<f64>() + dashpot))
    }

    fn scale(&self) -> f64 {
        0.25 * (self.wave_number() * self.amplitude).powi(2)
    }

    /// E' and E'' at the frequency of the wave.
    fn modulus(&self, v: f64) -> (f64, f64) {
        let omega = self.wave_number() * v.abs();
        if omega > 0.0 { self.relaxation.complex(omega) } else { (self.relaxation.equilibrium, 0.0) }
    }
}

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
/// [`Error::Invalid`] if a point of the surface is undefined, the velocity or its direction not finite, or the creep function
/// that of a fluid.
pub fn full_contact_friction(
    surface: &Surface,
    creep: &Creep,
    velocity: f64,
    direction: Direction,
) -> Result<f64> {
    creep.validate_solid()?;
    let [cos, sin] = direction.unit();
    if !(velocity.is_finite() && cos.is_finite() && sin.is_finite()) {
        return Err(Error::invalid(
            "velocity",
            format!("{velocity} m/s, {direction:?}"),
            "finite, and its direction too",
        ));
    }
    let waves = PowerSpectrum::of(surface)?;
    let stress = waves.waves().filter(|wave| wave.power > 0.0).map(|wave| {
        let along = (wave.wave_vector[0] * cos + wave.wave_vector[1] * sin).abs();
        0.5 * wave.wave_number * along * wave.power * creep.modulus(along * velocity.abs()).1
    });
    Ok(stress.sum())
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;
    use crate::Grid;
    use crate::material::CreepTerm;
    use ndarray::Array2;

    fn zener(instantaneous: f64, compliance: f64) -> Creep {
        let terms = vec![CreepTerm { compliance, retardation_time: 1.0 }];
        Creep { instantaneous, terms, fluidity: 0.0 }
    }

    /// Two relaxing terms.
    fn solid() -> Creep {
        Relaxation::absolute(1.0, &[(3.0, 0.5), (2.0, 5.0)]).unwrap().to_creep().unwrap()
    }

    #[test]
    fn the_sphere_has_its_limits() {
        // (C_inf/C0, mu/v slow, mu v fast) for W = 4/3 and the rest 1.
        for (ratio, slow, fast) in [(2.0, 0.5, 0.503968419958), (10.0, 0.9, 1.55119297682)] {
            let w = 4.0 / 3.0;
            let sphere = SlidingSphere::under_load(1.0, &zener(1.0 / ratio, 1.0 - 1.0 / ratio), w).unwrap();
            // The digits of the numbers.
            assert!((sphere.slow_friction(0.1) / w / (0.1 * slow) - 1.0).abs() < 1e-11);
            assert!((sphere.fast_friction(-20.0) / w * 20.0 / fast - 1.0).abs() < 1e-11);
        }
        assert_eq!(
            SlidingSphere::under_load(1.0, &Creep::elastic(1.0), 1.0).unwrap().slow_friction(1.0),
            0.0
        );
    }

    #[test]
    fn the_sine_has_its_friction_and_its_pressure() {
        let wave = FullContactWave::new(0.01, 1.0, &solid()).unwrap();
        // (v, friction stress, amplitude of the pressure), 12 digits.
        for (v, stress, amplitude) in [
            (0.001, 7.1253200969e-05, 0.0315604096353),
            (0.01, 0.000657346670897, 0.0426399180048),
            (0.1, 0.00141714276864, 0.106915586183),
            (1.0, 0.000918538406943, 0.182123441168),
            (10.0, 0.000100435504944, 0.188426649043),
        ] {
            assert!((wave.friction_stress(v) / stress - 1.0).abs() < 1e-11, "{v}");
            assert!((wave.pressure_amplitude(v) / amplitude - 1.0).abs() < 1e-11, "{v}");
            // Friction is the mean of pressure times slope of the gap, -dh/dx.
            let q = TAU;
            let mean = integrate(0.0, 1.0, |x| wave.pressure(x, v) * 0.01 * q * (q * x).sin());
            assert!((mean - stress).abs() < 1e-13 * amplitude, "{v}: {mean}"); // rounding of the terms
            assert_eq!(
                (wave.friction_stress(-v), wave.pressure(-0.1, -v)),
                (wave.friction_stress(v), wave.pressure(0.1, v))
            );
        }
        assert_eq!(wave.friction_stress(0.0), 0.0);
    }

    #[test]
    fn the_start_of_sliding_overshoots() {
        let wave = FullContactWave::new(0.01, 1.0, &solid()).unwrap();
        for (t, stress) in [
            (0.1, 0.000291221823559),
            (0.5, 0.00116136039511),
            (1.0, 0.00183024778425),
            (2.0, 0.00244143423291),
            (5.0, 0.00162706136893),
            (10.0, 0.00133993216967),
            (40.0, 0.0014169513827),
        ] {
            let got = wave.friction_stress_after_start(0.1, t).unwrap();
            assert!((got / stress - 1.0).abs() < 1e-11, "{t}: {got}"); // the digits of the numbers
        }
        assert_eq!(wave.friction_stress_after_start(0.1, 0.0).unwrap(), 0.0);
        let late = wave.friction_stress_after_start(0.1, 1e3).unwrap();
        assert!((late / wave.friction_stress(0.1) - 1.0).abs() < 1e-13);
        assert!(wave.friction_stress_after_start(0.1, -1.0).is_err());
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
        for v in [0.01, 0.3, -4.0] {
            let line = |h: f64, l: f64| FullContactWave::new(h, l, &creep).unwrap().friction_stress(v);
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
        for (result, word) in [
            (SlidingSphere::under_load(1.0, &fluid, 1.0).map(drop), "fluidity"),
            (SlidingSphere::under_load(1.0, &zener(0.0, 1.0), 1.0).map(drop), "instantaneous compliance"),
            (FullContactWave::new(0.0, 1.0, &solid()).map(drop), "amplitude"),
            (FullContactWave::new(1.0, 1.0, &Creep::elastic(0.0)).map(drop), "compliance at long times"),
            (full_contact_friction(&flat, &solid(), f64::NAN, Direction::X).map(drop), "velocity"),
            (
                full_contact_friction(&flat, &solid(), 1.0, Direction::Angle(f64::INFINITY)).map(drop),
                "direction",
            ),
        ] {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
