//! Cone and flat punch on an elastic half-space: I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47;
//! K. L. Johnson, Contact Mechanics (Cambridge, 1985), sections 3.8 and 5.2.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::error::{Result, non_negative, positive, require};
use crate::load::History;
use crate::material::Creep;

use super::hereditary::hereditary;

/// The cone slope r on an elastic half-space.
///
/// ```text
/// approach = (pi/2) slope a,   W = (pi/2) slope E* a^2,   p = (slope E* / 2) acosh(a/r)
/// ```
///
/// (Sneddon 1965, eqs 6.3-6.5.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SneddonCone {
    /// Rise per length.
    pub slope: f64,
    /// Contact modulus E* \[Pa\].
    pub contact_modulus: f64,
    /// Load W \[N\].
    pub load: f64,
    /// Radius of the contact a \[m\].
    pub contact_radius: f64,
    /// Approach \[m\].
    pub approach: f64,
}

impl SneddonCone {
    /// From the load W >= 0 \[N\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the slope or the modulus is not positive or the load is negative.
    pub fn under_load(slope: f64, contact_modulus: f64, load: f64) -> Result<Self> {
        positive("slope of the cone", slope, "")?;
        positive("contact modulus", contact_modulus, "Pa")?;
        non_negative("load", load, "N")?;
        let a = (load / (FRAC_PI_2 * slope * contact_modulus)).sqrt();
        Ok(SneddonCone { slope, contact_modulus, load, contact_radius: a, approach: FRAC_PI_2 * slope * a })
    }

    /// From the approach \[m\]; a negative approach means no contact.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the slope or the modulus is not positive or the approach not finite.
    pub fn under_approach(slope: f64, contact_modulus: f64, approach: f64) -> Result<Self> {
        positive("slope of the cone", slope, "")?;
        require(approach.is_finite(), "approach", approach, "finite, in m")?;
        let a = approach.max(0.0) / (FRAC_PI_2 * slope);
        let contact = Self::under_load(slope, contact_modulus, FRAC_PI_2 * slope * contact_modulus * a * a)?;
        Ok(SneddonCone { contact_radius: a, approach, ..contact })
    }

    /// Pressure at the distance r from the axis \[Pa\]; infinite on it.
    pub fn pressure(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        if r < a { 0.5 * self.slope * self.contact_modulus * (a / r).acosh() } else { 0.0 }
    }

    /// Mean pressure, slope E* / 2 at any load \[Pa\].
    pub fn mean_pressure(&self) -> f64 {
        0.5 * self.slope * self.contact_modulus
    }

    /// Normal displacement of the half-space at the distance r \[m\] (Sneddon 1965, eq. 6.6).
    pub fn displacement(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        if r <= a {
            self.approach.max(0.0) - self.slope * r.min(a)
        } else {
            // sqrt(r^2 - a^2) - r = -a^2 / (sqrt(r^2 - a^2) + r)
            let root = ((r - a) * (r + a)).sqrt();
            self.slope * a * ((a / r).asin() - a / (root + r))
        }
    }
}

/// The flat circular punch on an elastic half-space.
///
/// ```text
/// W = 2 E* a approach,   p = W / (2 pi a^2 sqrt(1 - r^2/a^2))
/// ```
///
/// (Sneddon 1965, eqs 6.1-6.2; Johnson 1985, eqs 3.34-3.36.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CircularPunch {
    /// Radius a \[m\].
    pub radius: f64,
    /// Load W \[N\].
    pub load: f64,
    /// Approach \[m\].
    pub approach: f64,
}

impl CircularPunch {
    /// From the load W >= 0 \[N\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the radius or the modulus is not positive or the load is negative.
    pub fn under_load(radius: f64, contact_modulus: f64, load: f64) -> Result<Self> {
        positive("radius of the flat punch", radius, "m")?;
        positive("contact modulus", contact_modulus, "Pa")?;
        non_negative("load", load, "N")?;
        Ok(CircularPunch { radius, load, approach: load / (2.0 * contact_modulus * radius) })
    }

    /// Under the load of `history` just after t \[s\], on a body of contact creep compliance C(t): approach = (1 / 2a) int C(t -
    /// s) dW(s), for any history that keeps the contact full, W > 0 (E. H. Lee and J. R. M. Radok, J. Appl. Mech. 27 (1960) 438).
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the radius is not positive, the history or the creep is invalid, or t is
    /// negative.
    pub fn viscoelastic(radius: f64, creep: &Creep, history: &History, t: f64) -> Result<Self> {
        positive("radius of the flat punch", radius, "m")?;
        creep.validate()?;
        history.validate()?;
        non_negative("time", t, "s")?;
        let approach = hereditary(creep, history, t) / (2.0 * radius);
        Ok(CircularPunch { radius, load: history.after(t), approach })
    }

    /// Pressure at the distance r from the axis \[Pa\]; infinite at the edge.
    pub fn pressure(&self, r: f64) -> f64 {
        let a = self.radius;
        if r <= a { self.load / (2.0 * PI * a * ((a - r) * (a + r)).sqrt()) } else { 0.0 }
    }

    /// Normal displacement of the half-space at the distance r \[m\]:
    /// (2 approach / pi) asin(a/r) outside (Johnson 1985, eq. 3.37).
    pub fn displacement(&self, r: f64) -> f64 {
        self.approach * (self.radius / r).min(1.0).asin() / FRAC_PI_2
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::{integrate, integrate_to};
    use super::*;
    use crate::material::CreepTerm;

    // The formulas have a few operations each.
    const ROUNDING: f64 = 2e-15;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= ROUNDING * b.abs()
    }

    #[test]
    fn the_cone_has_sneddons_numbers() {
        // E* = 1, slope 0.1, W = 1; p / (E* slope) at r / a.
        let cone = SneddonCone::under_load(0.1, 1.0, 1.0).unwrap();
        assert!(close(cone.contact_radius, 2.52313252202016));
        assert!(close(cone.approach, 0.3963327297606011) && close(cone.mean_pressure(), 0.05));
        for (share, p) in [
            (0.1, 1.496_611_423_063_190_5),
            (0.25, 1.031_718_534_447_780_3),
            (0.5, 0.658_478_948_462_408_3),
            (0.75, 0.397_682_730_611_952_85),
            (0.9, 0.233_572_654_051_631),
        ] {
            let got = cone.pressure(share * cone.contact_radius) / 0.1;
            assert!((got / p - 1.0).abs() < 1e-14, "{share}: {got} {p}"); // acosh near 1 loses a digit
        }
        let again = SneddonCone::under_approach(0.1, 1.0, cone.approach).unwrap();
        assert!(close(again.load, 1.0));
    }

    #[test]
    fn pressures_carry_the_load_and_displacements_are_continuous() {
        let cone = SneddonCone::under_load(0.2, 3.0, 2.0).unwrap();
        let a = cone.contact_radius;
        let load = integrate(0.0, a, |r| 2.0 * PI * r * cone.pressure(r));
        assert!((load / 2.0 - 1.0).abs() < 1e-13);
        assert!((cone.displacement(a * (1.0 + 1e-12)) / cone.displacement(a) - 1.0).abs() < 1e-5);
        // Far away any load is a point load: u = W / (pi E* r) (1 + O(a^2/r^2)).
        let far = 1e4 * a;
        assert!((cone.displacement(far) * PI * 3.0 * far / 2.0 - 1.0).abs() < 1e-7);

        let punch = CircularPunch::under_load(0.7, 3.0, 2.0).unwrap();
        let edge =
            |above: f64| 2.0 * PI * (0.7 - above) * 2.0 / (2.0 * PI * 0.7 * (above * (1.4 - above)).sqrt());
        assert!((integrate_to(1e-14, 0.0, 0.7, |p| edge(p.below)) / 2.0 - 1.0).abs() < 1e-13);
        assert!((punch.displacement(far) * PI * 3.0 * far / 2.0 - 1.0).abs() < 1e-7);
    }

    #[test]
    fn the_flat_punch_has_sneddons_numbers() {
        let punch = CircularPunch::under_load(1.0, 1.0, 1.0).unwrap();
        assert!(close(punch.approach, 0.5) && close(punch.pressure(0.0), 0.15915494309189535));
        assert!(close(punch.displacement(2.0), 1.0 / 6.0) && close(punch.displacement(0.3), 0.5));
    }

    #[test]
    fn a_viscoelastic_punch_remembers_its_loads() {
        // E*(t) = 2 + 2 exp(-t/0.5), so C(t) = 1/4 + (1 - exp(-t))/4; W jumps by 1 at 0, rises by 1
        // over [1, 2], falls by 1 at 3; the integral with 30 digits.
        let creep = Creep {
            instantaneous: 0.25,
            terms: vec![CreepTerm { compliance: 0.25, retardation_time: 1.0 }],
            fluidity: 0.0,
        };
        let points = vec![(0.0, 1.0), (1.0, 1.0), (2.0, 2.0), (3.0, 2.0), (3.0, 1.0)];
        let history = History::Table { points };
        for (t, delta) in [
            (0.0, 0.125),
            (0.5, 0.17418366753592082),
            (1.0, 0.2040150698535697),
            (1.5, 0.2979250624455254),
            (2.0, 0.4040680197418537),
            (2.5, 0.4418143127264872),
            (2.999999, 0.4647085614207424),
            (3.0, 0.3397085967121633),
            (3.5, 0.30441101434572293),
            (4.0, 0.283001948426745),
            (6.0, 0.25446632803769353),
            (10.0, 0.250081803651497),
        ] {
            let punch = CircularPunch::viscoelastic(1.0, &creep, &history, t).unwrap();
            assert!((punch.approach / delta - 1.0).abs() < 1e-14, "{t}: {} {delta}", punch.approach);
        }
    }

    #[test]
    fn absurd_numbers_are_named() {
        for (result, word) in [
            (SneddonCone::under_load(-0.1, 1.0, 1.0).map(drop), "slope"),
            (SneddonCone::under_approach(0.1, 1.0, f64::NAN).map(drop), "approach"),
            (CircularPunch::under_load(0.0, 1.0, 1.0).map(drop), "flat punch"),
            (CircularPunch::under_load(1.0, 1.0, -1.0).map(drop), "load"),
        ] {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
