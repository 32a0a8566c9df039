//! Periodic flat strips on an elastic half-space in plane strain: K. L. Johnson, Contact Mechanics (Cambridge, 1985), sections
//! 2.8 and 13.2 (the pressure of a single flat strip, made periodic like that of Westergaard).

use std::f64::consts::PI;

use crate::error::{Error, Result, non_negative, positive};

/// Rigid flat strips of width 2a and period l that press a half-space with the mean pressure pm:
///
/// ```text
/// p(x) = pm cos(pi x/l) / sqrt(sin^2(pi a/l) - sin^2(pi x/l))                       |x| < a
/// u(x) = -(2 pm l / (pi E*)) ln sin(pi a/l)                                         |x| <= a
/// u(x) = -(2 pm l / (pi E*)) [ln sin(pi a/l) + acosh(sin(pi |x|/l) / sin(pi a/l))]  a < |x| <= l/2
/// ```
///
/// with x the distance from the middle of a strip and u measured from its mean over a period.
///
/// ```
/// use asperity::reference::StripPunch;
/// let punch = StripPunch::under_pressure(0.25, 1.0, 1.0, 1.0)?;
/// assert!((punch.pressure(0.0) - 2f64.sqrt()).abs() < 1e-15);
/// // ln(2) / pi
/// assert!((punch.displacement(0.1) - 0.220635600152652).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripPunch {
    /// Half the width of a strip a \[m\].
    pub half_width: f64,
    /// Period l \[m\].
    pub period: f64,
    /// Contact modulus E* \[Pa\].
    pub contact_modulus: f64,
    /// Mean pressure pm \[Pa\].
    pub mean_pressure: f64,
}

impl StripPunch {
    /// From the mean pressure >= 0 \[Pa\].
    ///
    /// # Errors
    /// [`Error::Invalid`] if a length or the modulus is not positive, a strip is as wide as the period or the pressure is
    /// negative.
    pub fn under_pressure(
        half_width: f64,
        period: f64,
        contact_modulus: f64,
        mean_pressure: f64,
    ) -> Result<Self> {
        positive("half width of the strip", half_width, "m")?;
        positive("period", period, "m")?;
        positive("contact modulus", contact_modulus, "Pa")?;
        non_negative("mean pressure", mean_pressure, "Pa")?;
        if half_width >= 0.5 * period {
            let expected = format!("less than half of the period, {} m", 0.5 * period);
            return Err(Error::invalid("half width of the strip", format!("{half_width} m"), expected));
        }
        Ok(StripPunch { half_width, period, contact_modulus, mean_pressure })
    }

    /// Pressure at the distance x from the middle of a strip \[Pa\]; infinite at its edges.
    pub fn pressure(&self, x: f64) -> f64 {
        let x = self.wrapped(x);
        if x > self.half_width {
            return 0.0;
        }
        let (plus, minus) =
            (PI * (self.half_width + x) / self.period, PI * (self.half_width - x) / self.period);
        // sin^2 A - sin^2 B = sin(A + B) sin(A - B)
        self.mean_pressure * (PI * x / self.period).cos() / (plus.sin() * minus.sin()).sqrt()
    }

    /// Displacement from its mean at the distance x from the middle of a strip \[m\].
    pub fn displacement(&self, x: f64) -> f64 {
        let x = self.wrapped(x);
        let sine = |x: f64| (PI * x / self.period).sin();
        let edge = sine(self.half_width);
        let beyond = if x > self.half_width { (sine(x) / edge).max(1.0).acosh() } else { 0.0 };
        let scale = 2.0 * self.mean_pressure * self.period / (PI * self.contact_modulus);
        -scale * (edge.ln() + beyond)
    }

    /// Distance from the middle of the nearest strip.
    fn wrapped(&self, x: f64) -> f64 {
        (x - self.period * (x / self.period).round()).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{integrate, integrate_to};
    use super::*;

    #[test]
    fn the_pressure_has_its_mean_and_the_displacement_none() {
        for share in [0.05, 0.2, 0.45] {
            let punch = StripPunch::under_pressure(0.7 * share, 0.7, 2.0, 3.0).unwrap();
            let a = punch.half_width;
            // By the distance from the edge, where the pressure is singular.
            let near = |p: super::super::quadrature::Point| {
                let (plus, minus) = (PI * (a + p.x) / 0.7, PI * p.below / 0.7);
                3.0 * (PI * p.x / 0.7).cos() / (plus.sin() * minus.sin()).sqrt()
            };
            let half = integrate_to(1e-14, 0.0, a, near);
            assert!((2.0 * half / 0.7 / 3.0 - 1.0).abs() < 1e-13); // rounding of a hundred terms
            assert!(
                (punch.pressure(0.3 * a)
                    / near(super::super::quadrature::Point { x: 0.3 * a, above: 0.3 * a, below: 0.7 * a })
                    - 1.0)
                    .abs()
                    < 1e-14
            );
            let mean = a * punch.displacement(0.0) + integrate(a, 0.35, |x| punch.displacement(x));
            assert!(mean.abs() < 1e-13 * punch.displacement(0.0), "{mean}");
            assert_eq!(punch.displacement(0.9 * a), punch.displacement(0.0));
            assert!(punch.displacement(1.1 * a) < punch.displacement(a));
            assert_eq!((punch.pressure(0.35), punch.pressure(0.7)), (0.0, punch.pressure(0.0)));
        }
    }

    #[test]
    fn each_wave_of_pressure_displaces_by_two_over_its_modulus_and_wave_number() {
        let punch = StripPunch::under_pressure(0.2, 1.0, 1.0, 1.0).unwrap();
        let a = punch.half_width;
        for n in [1.0, 2.0, 5.0] {
            let q = 2.0 * PI * n;
            let near = |p: super::super::quadrature::Point| {
                let (plus, minus) = (PI * (a + p.x), PI * p.below);
                (PI * p.x).cos() / (plus.sin() * minus.sin()).sqrt() * (q * p.x).cos()
            };
            let pressure = 2.0 * integrate_to(1e-14, 0.0, a, near);
            let u = |x: f64| punch.displacement(x) * (q * x).cos();
            let displacement = 2.0 * (integrate(0.0, a, u) + integrate(a, 0.5, u));
            // Rounding of two integrals.
            assert!((displacement - 2.0 / q * pressure).abs() < 1e-13, "{n}: {displacement} {pressure}");
        }
    }

    #[test]
    fn absurd_numbers_are_named() {
        for (result, word) in [
            (StripPunch::under_pressure(0.5, 1.0, 1.0, 1.0), "less than half of the period"),
            (StripPunch::under_pressure(0.0, 1.0, 1.0, 1.0), "half width"),
            (StripPunch::under_pressure(0.1, f64::NAN, 1.0, 1.0), "period"),
            (StripPunch::under_pressure(0.1, 1.0, -1.0, 1.0), "contact modulus"),
            (StripPunch::under_pressure(0.1, 1.0, 1.0, -1.0), "mean pressure"),
        ] {
            assert!(result.unwrap_err().to_string().contains(word));
        }
    }
}
