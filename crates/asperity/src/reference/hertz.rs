//! Elastic bodies with smooth surfaces of second order: H. Hertz, J. reine angew. Math. 92 (1881) 156; K. L. Johnson, Contact
//! Mechanics (Cambridge, 1985), sections 4.1-4.2.
//!
//! E* is the contact modulus of the pair, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2. "Sphere" means the
//! paraboloid r^2/(2R).

use std::f64::consts::PI;

use super::elliptic::elliptic;
use super::quadrature::root;
use crate::error::{Result, non_negative, positive, require};

/// The paraboloid r^2/(2R) on an elastic half-space.
///
/// ```text
/// a^3 = 3 R W / (4 E*),   approach = a^2 / R,   p = p0 sqrt(1 - r^2/a^2),   p0 = 2 E* a / (pi R)
/// ```
///
/// (Johnson 1985, eqs 4.22-4.24.)
///
/// ```
/// use asperity::reference::HertzSphere;
/// let contact = HertzSphere::under_load(0.01, 1e9, 10.0)?;
/// assert!((contact.contact_radius / 4.217163326508746e-4 - 1.0).abs() < 1e-14);
/// assert!((contact.approach / 1.7784466522450314e-5 - 1.0).abs() < 1e-14);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzSphere {
    /// Radius of the sphere R \[m\].
    pub radius: f64,
    /// Contact modulus E* \[Pa\].
    pub contact_modulus: f64,
    /// Load W \[N\].
    pub load: f64,
    /// Radius of the contact a \[m\].
    pub contact_radius: f64,
    /// Pressure in the middle p0 \[Pa\].
    pub peak_pressure: f64,
    /// Approach \[m\].
    pub approach: f64,
}

impl HertzSphere {
    /// From the load W >= 0 \[N\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the radius or the modulus is not positive or the load is negative.
    pub fn under_load(radius: f64, contact_modulus: f64, load: f64) -> Result<Self> {
        check(radius, contact_modulus)?;
        non_negative("load", load, "N")?;
        let contact =
            Self::of_radius(radius, contact_modulus, (0.75 * radius * load / contact_modulus).cbrt());
        Ok(HertzSphere { load, ..contact })
    }

    /// From the approach \[m\]; a negative approach means no contact.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the radius or the modulus is not positive or the approach not finite.
    pub fn under_approach(radius: f64, contact_modulus: f64, approach: f64) -> Result<Self> {
        check(radius, contact_modulus)?;
        require(approach.is_finite(), "approach", approach, "finite, in m")?;
        let contact = Self::of_radius(radius, contact_modulus, (approach.max(0.0) * radius).sqrt());
        Ok(HertzSphere { approach, ..contact })
    }

    fn of_radius(radius: f64, contact_modulus: f64, a: f64) -> Self {
        HertzSphere {
            radius,
            contact_modulus,
            load: 4.0 * contact_modulus * a * a * (a / (3.0 * radius)),
            contact_radius: a,
            peak_pressure: 2.0 * contact_modulus * a / (PI * radius),
            approach: a * a / radius,
        }
    }

    /// Pressure at the distance r from the axis \[Pa\].
    pub fn pressure(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        if r < a { self.peak_pressure * ((a - r) * (a + r)).sqrt() / a } else { 0.0 }
    }

    /// Normal displacement of the half-space at the distance r \[m\] (Johnson 1985, eqs 3.41a, 3.42a).
    pub fn displacement(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        if a == 0.0 {
            0.0
        } else if r <= a {
            self.approach - r * r / (2.0 * self.radius)
        } else {
            let root = ((r - a) * (r + a)).sqrt();
            ((2.0 * a * a - r * r) * (a / r).asin() + a * root) / (PI * self.radius)
        }
    }

    /// Elastic energy, int W d(approach) = (2/5) W approach \[J\].
    pub fn energy(&self) -> f64 {
        0.4 * self.load * self.approach.max(0.0)
    }
}

/// The elliptic paraboloid x^2/(2 Rx) + y^2/(2 Ry) on an elastic half-space.
///
/// The contact is an ellipse with semi-axes a >= b, the longer one along the axis of the larger
/// radius. With k'= b/a and the complete elliptic integrals B, D, K of modulus k
/// ([`elliptic`](super::elliptic()))
///
/// ```text
/// R_small / R_large = k'^2 D / B,   a^3 = 3 W R_small B / (pi k'^2 E*),
/// p = p0 sqrt(1 - x^2/a^2 - y^2/b^2),   W = (2/3) pi a b p0,   approach = (p0 / E*) b K
/// ```
///
/// (Johnson 1985, eqs 4.25-4.32.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzEllipse {
    /// Semi-axes of the contact along x and y \[m\].
    pub semi_axes: [f64; 2],
    /// Load W \[N\].
    pub load: f64,
    /// Pressure in the middle p0 \[Pa\].
    pub peak_pressure: f64,
    /// Approach \[m\].
    pub approach: f64,
}

impl HertzEllipse {
    /// From the load W >= 0 \[N\] and the radii along x and y \[m\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a radius or the modulus is not positive and finite, the load is
    /// negative, or one radius exceeds the other by more than 1e12 (a line contact, which has no
    /// approach).
    pub fn under_load(radii: [f64; 2], contact_modulus: f64, load: f64) -> Result<Self> {
        check(radii[0], contact_modulus)?;
        check(radii[1], contact_modulus)?;
        non_negative("load", load, "N")?;
        let (small, large) = (radii[0].min(radii[1]), radii[0].max(radii[1]));
        require(
            small / large >= 1e-12,
            "ratio of the principal radii",
            small / large,
            "1e-12 at least; beyond, use the line contact",
        )?;
        let ratio = axis_ratio(small / large);
        let integrals = elliptic(ratio);
        let a = (3.0 * load * small * integrals.b / (PI * ratio * ratio * contact_modulus)).cbrt();
        let b = ratio * a;
        let peak_pressure = if load > 0.0 { 1.5 * load / (PI * a * b) } else { 0.0 };
        Ok(HertzEllipse {
            semi_axes: if radii[0] >= radii[1] { [a, b] } else { [b, a] },
            load,
            peak_pressure,
            approach: peak_pressure / contact_modulus * b * integrals.k,
        })
    }

    /// Pressure at (x, y) from the middle \[Pa\].
    pub fn pressure(&self, x: f64, y: f64) -> f64 {
        let [ax, ay] = self.semi_axes;
        let inside = 1.0 - (x / ax).powi(2) - (y / ay).powi(2);
        if inside > 0.0 { self.peak_pressure * inside.sqrt() } else { 0.0 }
    }
}

/// k' = b/a from R_small/R_large = k'^2 D(k')/B(k'), by the logarithm of k'.
fn axis_ratio(radii: f64) -> f64 {
    let mismatch = |log: f64| {
        let integrals = elliptic(log.exp());
        2.0 * log + (integrals.d / integrals.b).ln() - radii.ln()
    };
    root(radii.ln(), 0.0, mismatch).exp().min(1.0)
}

pub(super) fn check(radius: f64, contact_modulus: f64) -> Result<()> {
    positive("radius", radius, "m")?;
    positive("contact modulus", contact_modulus, "Pa").map(drop)
}

#[cfg(test)]
mod tests {
    use super::super::HertzLine;
    use super::super::quadrature::integrate;
    use super::*;

    // The formulas have a few operations each.
    const ROUNDING: f64 = 4e-15;

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() <= ROUNDING * b.abs()
    }

    #[test]
    fn the_sphere_has_hertz_numbers() {
        // (E*, R, W, a, p0, delta, p(a/2), u(2a), energy), from the closed forms with 50 digits.
        #[rustfmt::skip]
        let rows = [
            (1.0, 1.0, 1.0, 0.9085602964160698, 0.5784074490866206, 0.8254818122236567, 0.5009155446471677, 0.17995137164949557, 0.33019272488946266),
            (4.0, 1.0, 1.0, 0.5723571212766659, 1.4574954410404608, 0.3275926742761121, 1.2622280778410435, 0.07141374916488243, 0.13103706971044482),
            (1e9, 0.01, 10.0, 0.0004217163326508746, 26847295.5695891, 1.7784466522450314e-05, 23250439.98617357, 3.876934776004933e-06, 7.113786608980126e-05),
        ];
        for (modulus, radius, load, a, p0, delta, p_half, u_two, energy) in rows {
            let contact = HertzSphere::under_load(radius, modulus, load).unwrap();
            assert!(close(contact.contact_radius, a) && close(contact.peak_pressure, p0));
            assert!(close(contact.approach, delta) && close(contact.load, load), "{contact:?}");
            assert!(close(contact.pressure(0.5 * a), p_half) && close(contact.energy(), energy));
            // (2 - r^2/a^2) asin(a/r) + ... cancels a digit at r = 2a
            assert!((contact.displacement(2.0 * a) / u_two - 1.0).abs() < 20.0 * ROUNDING);
            let again = HertzSphere::under_approach(radius, modulus, delta).unwrap();
            assert!(close(again.load, load));
        }
        assert_eq!(HertzSphere::under_approach(1.0, 1.0, -1.0).unwrap().load, 0.0);
        assert_eq!(HertzSphere::under_load(1.0, 1.0, 0.0).unwrap().displacement(1.0), 0.0);
    }

    #[test]
    fn the_ellipse_has_hertz_numbers() {
        // (E*, R1, R2, W, a, b, p0, delta), from the elliptic integrals with 50 digits.
        #[rustfmt::skip]
        let rows = [
            (1.0, 2.0, 1.0, 1.0, 1.27582079819839, 0.8045271111364719, 0.46516927900902955, 0.7305616135556928),
            (1.0, 10.0, 1.0, 1.0, 2.6508501071522375, 0.5891501619083792, 0.3057244791872769, 0.5248992711677862),
            (1.0, 4.0, 1.0, 1.0, 1.7648285860998647, 0.70573203551967, 0.38335313986009906, 0.6383563452687743),
            (1e9, 0.03, 0.01, 10.0, 0.0007172736314290259, 0.0003461761811948083, 19229116.83178711, 1.4566588460387405e-05),
        ];
        for (modulus, r1, r2, load, a, b, p0, delta) in rows {
            let near = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-14; // and the root of the axis ratio
            let contact = HertzEllipse::under_load([r1, r2], modulus, load).unwrap();
            assert!(near(contact.semi_axes[0], a) && near(contact.semi_axes[1], b), "{contact:?}");
            assert!(near(contact.peak_pressure, p0) && near(contact.approach, delta), "{contact:?}");
            let turned = HertzEllipse::under_load([r2, r1], modulus, load).unwrap();
            assert_eq!(turned.semi_axes, [contact.semi_axes[1], contact.semi_axes[0]]);
        }
    }

    #[test]
    fn a_round_ellipse_is_the_sphere_and_a_long_one_the_cylinder() {
        let sphere = HertzSphere::under_load(0.3, 2.0, 5.0).unwrap();
        let round = HertzEllipse::under_load([0.3, 0.3], 2.0, 5.0).unwrap();
        assert!(close(round.semi_axes[0], sphere.contact_radius));
        assert!((round.approach / sphere.approach - 1.0).abs() < 1e-14);
        // The middle of a long ellipse carries W' = p0 pi b / 2, like a separate cylinder.
        let long = HertzEllipse::under_load([1e8, 1.0], 1.0, 1e3).unwrap();
        let [_, b] = long.semi_axes;
        let line = HertzLine::under_load(1.0, 1.0, 0.5 * PI * b * long.peak_pressure).unwrap();
        assert!((line.half_width / b - 1.0).abs() < 1e-6); // k'^2 ln k' with k' = 1e-5 ... 1e-4
        assert!((line.peak_pressure / long.peak_pressure - 1.0).abs() < 1e-6);
    }

    #[test]
    fn the_pressure_carries_the_load() {
        let sphere = HertzSphere::under_load(1.0, 3.0, 2.0).unwrap();
        let a = sphere.contact_radius;
        let load = integrate(0.0, a, |r| 2.0 * PI * r * sphere.pressure(r));
        assert!((load / 2.0 - 1.0).abs() < 1e-14);
    }

    #[test]
    fn absurd_numbers_are_named() {
        for (result, word) in [
            (HertzSphere::under_load(0.0, 1.0, 1.0).map(drop), "radius"),
            (HertzSphere::under_load(1.0, f64::NAN, 1.0).map(drop), "contact modulus"),
            (HertzSphere::under_load(1.0, 1.0, -1.0).map(drop), "load"),
            (HertzEllipse::under_load([1.0, f64::INFINITY], 1.0, 1.0).map(drop), "radius"),
            (HertzEllipse::under_load([1.0, 1e13], 1.0, 1.0).map(drop), "line contact"),
        ] {
            let message = result.unwrap_err().to_string();
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
