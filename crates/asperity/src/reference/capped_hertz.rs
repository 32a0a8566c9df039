//! The paraboloid r^2/(2R) on an elastic half-space whose pressure cannot exceed the hardness H.
//!
//! ```text
//! r < c:      p = H, gap <= 0 (the overlap is flattened)
//! c < r < a:  0 <= p <= H, gap = 0
//! r > a:      p = 0, gap >= 0
//! ```
//!
//! The displacement of a ring of pressure is a complete elliptic integral of the first kind (K. L.
//! Johnson, Contact Mechanics (Cambridge, 1985), section 3.8; A. E. H. Love, Phil. Trans. R. Soc. A 228
//! (1929) 377):
//!
//! ```text
//! u(r) = (4 / (pi E*)) int p(s) s / (r + s) K(k') ds,   k' = |r - s| / (r + s)
//! ```
//!
//! With r^2 = c^2 cos^2 phi + a^2 sin^2 phi the pressure is smooth in phi on \[0, pi/2\], square roots at both rims included.
//! Chebyshev polynomials in phi with gap = 0 at their collocation points, p = H at c and p = 0 at a give a linear system for p, H
//! and the approach, for given c/a. Its error falls exponentially with the degree. The cap is reversible and does not depend on
//! the history.

use std::f64::consts::{FRAC_PI_2, PI};

use super::HertzSphere;
use super::elliptic::elliptic;
use super::quadrature::{fixed_rule, integrate_to, root};
use crate::error::{Result, positive};
use crate::linear::solve;

/// Degree of the Chebyshev polynomial: 28 and 32 agree to 1e-12.
const DEGREE: usize = 32;

/// A sphere on an elastic body of hardness H under a load.
///
/// ```
/// use asperity::reference::{CappedHertz, HertzSphere};
/// let hertz = HertzSphere::under_load(1.0, 1.0, 1.0)?;
/// let capped = CappedHertz::under_load(1.0, 1.0, 0.6 * hertz.peak_pressure, 1.0)?;
/// assert!((capped.contact_radius / hertz.contact_radius - 1.0818114225139).abs() < 1e-10);
/// assert!((capped.approach / hertz.approach - 1.0683530963953).abs() < 1e-10);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CappedHertz {
    /// Radius of the contact a \[m\].
    pub contact_radius: f64,
    /// Radius of the part at the hardness c \[m\].
    pub capped_radius: f64,
    /// Approach \[m\].
    pub approach: f64,
    radius: f64,
    contact_modulus: f64,
    hardness: f64,
    form: Form,
}

#[derive(Clone, Debug, PartialEq)]
enum Form {
    /// The hardness is not reached.
    Elastic(HertzSphere),
    /// A disc at the hardness inside an annulus below it.
    Annulus(Annulus),
    /// The annulus is too thin to be resolved: the whole contact is at the hardness.
    Plastic,
}

impl CappedHertz {
    /// From the hardness \[Pa\] (infinite: Hertz) and the load W >= 0 \[N\].
    ///
    /// Below about H / p0 = 0.2 the annulus is thinner than 1e-12 of the contact, and the fully plastic limit is used: a = sqrt(W
    /// / (pi H)), approach = a^2 / (2 R) + 4 H a / (pi E*).
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the radius, the modulus or the hardness is not
    /// positive or the load is negative.
    pub fn under_load(radius: f64, contact_modulus: f64, hardness: f64, load: f64) -> Result<Self> {
        let hertz = HertzSphere::under_load(radius, contact_modulus, load)?;
        if hardness != f64::INFINITY {
            positive("hardness", hardness, "Pa")?;
        }
        let of = |contact_radius, capped_radius, approach, form| {
            Ok(CappedHertz {
                contact_radius,
                capped_radius,
                approach,
                radius,
                contact_modulus,
                hardness,
                form,
            })
        };
        if hardness >= hertz.peak_pressure {
            return of(hertz.contact_radius, 0.0, hertz.approach, Form::Elastic(hertz));
        }
        // x = ln(c^2 / (a^2 - c^2)) grows as the hardness falls against Hertz's peak pressure.
        let target = hardness / hertz.peak_pressure;
        let missing = |x: f64| target - Annulus::new(x).hardness_over_peak();
        let (elastic, plastic) = (-60.0, 27.0);
        let x = root(elastic, plastic, missing);
        if x == plastic {
            let a = (load / (PI * hardness)).sqrt();
            let approach = a * a / (2.0 * radius) + 4.0 * hardness * a / (PI * contact_modulus);
            return of(a, a, approach, Form::Plastic);
        }
        let annulus = Annulus::new(x);
        let a = (load * radius / (contact_modulus * annulus.load)).cbrt();
        of(a, a * annulus.inner2.sqrt(), annulus.approach * a * a / radius, Form::Annulus(annulus))
    }

    /// Pressure at the distance r from the axis \[Pa\].
    pub fn pressure(&self, r: f64) -> f64 {
        if r >= self.contact_radius {
            return 0.0;
        }
        match &self.form {
            Form::Elastic(hertz) => hertz.pressure(r),
            _ if r <= self.capped_radius => self.hardness,
            Form::Annulus(annulus) => {
                let unit = self.contact_modulus * self.contact_radius / self.radius;
                annulus.pressure(annulus.angle(r / self.contact_radius)) * unit
            }
            Form::Plastic => self.hardness,
        }
    }

    /// Normal displacement of the half-space at the distance r from the axis \[m\].
    pub fn displacement(&self, r: f64) -> f64 {
        let a = self.contact_radius;
        match &self.form {
            Form::Elastic(hertz) => hertz.displacement(r),
            Form::Annulus(annulus) => annulus.displacement(r / a) * a * a / self.radius,
            Form::Plastic => self.hardness / self.contact_modulus * a * disc(r / a, 1.0),
        }
    }

    /// Flattened overlap at the distance r, approach - r^2/(2R) - displacement, at least 0 \[m\].
    pub fn overlap(&self, r: f64) -> f64 {
        if r >= self.capped_radius {
            return 0.0;
        }
        self.approach - r * r / (2.0 * self.radius) - self.displacement(r)
    }

    /// Area of the contact, pi a^2 \[m^2\].
    pub fn contact_area(&self) -> f64 {
        PI * self.contact_radius * self.contact_radius
    }

    /// Area at the hardness, pi c^2 \[m^2\].
    pub fn capped_area(&self) -> f64 {
        PI * self.capped_radius * self.capped_radius
    }
}

/// Displacement E* u / p at r of a disc of radius c under uniform pressure p.
fn disc(r: f64, c: f64) -> f64 {
    let (inside, k) = if r <= c { (true, r / c) } else { (false, c / r) };
    let integrals = elliptic(((1.0 - k) * (1.0 + k)).sqrt());
    // Outside: r (E - k'^2 K) = r k^2 B.
    let scaled = if inside { c * integrals.e } else { c * k * integrals.b };
    4.0 / PI * scaled
}

/// The contact in units of a, E* a / R (pressure), a^2 / R (displacement), E* a^3 / R (load).
#[derive(Clone, Debug, PartialEq)]
struct Annulus {
    /// c^2 and 1 - c^2.
    inner2: f64,
    width2: f64,
    /// Chebyshev coefficients of the pressure over phi.
    coefficients: Vec<f64>,
    hardness: f64,
    approach: f64,
    load: f64,
}

impl Annulus {
    /// At x = ln(c^2 / (1 - c^2)).
    fn new(x: f64) -> Self {
        let mut annulus = Annulus {
            inner2: 1.0 / (1.0 + (-x).exp()),
            width2: 1.0 / (1.0 + x.exp()),
            coefficients: vec![],
            hardness: 0.0,
            approach: 0.0,
            load: 0.0,
        };
        let [mut solution] = annulus.collocate();
        annulus.approach = solution.pop().unwrap_or(f64::NAN);
        annulus.hardness = solution.pop().unwrap_or(f64::NAN);
        annulus.coefficients = solution;
        let rim = fixed_rule(0.0, FRAC_PI_2).map(|(p, w)| w * annulus.pressure(p.x) * annulus.area(p.x));
        annulus.load = PI * annulus.inner2 * annulus.hardness + 2.0 * PI * rim.sum::<f64>();
        annulus
    }

    /// H over the peak pressure of the uncapped contact under the same load.
    fn hardness_over_peak(&self) -> f64 {
        let a = (0.75 * self.load).cbrt();
        self.hardness / (2.0 * a / PI)
    }

    /// r at phi.
    fn r(&self, phi: f64) -> f64 {
        (self.inner2 + self.width2 * phi.sin().powi(2)).sqrt()
    }

    /// r dr / dphi.
    fn area(&self, phi: f64) -> f64 {
        self.width2 * phi.sin() * phi.cos()
    }

    /// phi at r, between the rims.
    fn angle(&self, r: f64) -> f64 {
        ((r * r - self.inner2) / self.width2).clamp(0.0, 1.0).sqrt().asin()
    }

    fn pressure(&self, phi: f64) -> f64 {
        chebyshev(phi).zip(&self.coefficients).map(|(t, c)| t * c).sum()
    }

    /// Rows: gap = 0 at DEGREE + 1 points, p(c) = H, p(a) = 0. Columns: coefficients, H, approach.
    fn collocate(&self) -> [Vec<f64>; 1] {
        let n = DEGREE + 1;
        let mut rows = Vec::with_capacity(n + 2);
        for i in 0..n {
            let phi = 0.5 * FRAC_PI_2 * (1.0 - (PI * (i as f64 + 0.5) / n as f64).cos());
            let r = self.r(phi);
            let mut row = vec![0.0; n + 3];
            // The kernel is logarithmic at phi: integrate up to it from both sides.
            let below = fixed_rule(0.0, phi).map(|(p, w)| (p.x, p.below, w));
            let above = fixed_rule(phi, FRAC_PI_2).map(|(p, w)| (p.x, p.above, w));
            for (at, distance, weight) in below.chain(above) {
                let sum = r + self.r(at);
                let complementary = self.width2 * distance.sin() * (phi + at).sin() / (sum * sum);
                let kernel = 4.0 / PI * weight * self.area(at) / sum * elliptic(complementary.abs()).k;
                // Points that are rounded to phi have weights far below rounding.
                if kernel.is_finite() {
                    row.iter_mut().zip(chebyshev(at)).for_each(|(m, t)| *m += kernel * t);
                }
            }
            row[n] = disc(r, self.inner2.sqrt());
            row[n + 1] = -1.0;
            row[n + 2] = -0.5 * r * r;
            rows.push(row);
        }
        for (end, hardness) in [(0.0, -1.0), (FRAC_PI_2, 0.0)] {
            let mut row: Vec<f64> = chebyshev(end).collect();
            row.extend([hardness, 0.0, 0.0]);
            rows.push(row);
        }
        solve(rows)
    }

    /// Displacement at any r.
    fn displacement(&self, r: f64) -> f64 {
        let phi = if r * r <= self.inner2 { 0.0 } else { self.angle(r) };
        let ring = |at: f64, distance: f64| {
            let s = self.r(at);
            // Inside the annulus |r^2 - s^2| keeps its digits as a product of sines.
            let inside = r * r > self.inner2 && r < 1.0;
            let difference =
                if inside { self.width2 * distance.sin() * (phi + at).sin() } else { (r - s) * (r + s) };
            let complementary = difference.abs() / ((r + s) * (r + s));
            let kernel = self.area(at) / (r + s) * elliptic(complementary).k;
            if kernel.is_finite() { self.pressure(at) * kernel } else { 0.0 }
        };
        let below = integrate_to(1e-13, 0.0, phi, |p| ring(p.x, p.below));
        let above = integrate_to(1e-13, phi, FRAC_PI_2, |p| ring(p.x, p.above));
        self.hardness * disc(r, self.inner2.sqrt()) + 4.0 / PI * (below + above)
    }
}

/// T_0 ... T_DEGREE of phi mapped from \[0, pi/2\] to \[-1, 1\].
fn chebyshev(phi: f64) -> impl Iterator<Item = f64> {
    let x = phi / (0.5 * FRAC_PI_2) - 1.0;
    std::iter::successors(Some((1.0, x)), move |(a, b)| Some((*b, 2.0 * x * b - a)))
        .map(|(t, _)| t)
        .take(DEGREE + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_agrees_with_an_independent_collocation() {
        // Rows of (H/pH, a/aH, c/aH, delta/deltaH, overlap(0)/deltaH, [p/pH at r/aH]), computed with two resolutions that differ
        // by less than 1e-11.
        #[rustfmt::skip]
        let rows = [
            (0.95, 1.0003208392528373, 0.3822437365165019, 1.0003138162503002, 0.010435786770926846, [(0.2, 0.95), (0.4, 0.9283043311236363), (0.6, 0.8018038489345699), (0.8, 0.6009427109757717), (1.0, 0.025342297472344826), (1.1, 0.0)]),
            (0.9, 1.0018731953433053, 0.5342709525422805, 1.0017900607777481, 0.029597342808564638, [(0.2, 0.9), (0.4, 0.9), (0.6, 0.8157972838272729), (0.8, 0.6059823451442978), (1.0, 0.06137518178956626), (1.1, 0.0)]),
            (0.6, 1.0818114225139117, 1.0211370236835526, 1.0683530963952788, 0.2632503608032368, [(0.2, 0.6), (0.4, 0.6), (0.6, 0.6), (0.8, 0.6), (1.0, 0.6), (1.1, 0.0)]),
            (0.4, 1.2919629256424454, 1.2900175843246167, 1.2519097992831445, 0.5944118189202424, [(0.2, 0.4), (0.4, 0.4), (0.6, 0.4), (0.8, 0.4), (1.0, 0.4), (1.1, 0.4)]),
        ];
        let hertz = HertzSphere::under_load(2.0, 3.0, 0.5).unwrap();
        for (hardness, a, c, delta, overlap, pressures) in rows {
            let capped = CappedHertz::under_load(2.0, 3.0, hardness * hertz.peak_pressure, 0.5).unwrap();
            let near = |x: f64, y: f64| (x - y).abs() < 1e-10;
            assert!(near(capped.contact_radius / hertz.contact_radius, a), "{hardness}");
            assert!(near(capped.capped_radius / hertz.contact_radius, c), "{hardness}");
            assert!(near(capped.approach / hertz.approach, delta), "{hardness}");
            assert!(near(capped.overlap(0.0) / hertz.approach, overlap), "{hardness}");
            for (r, p) in pressures {
                let got = capped.pressure(r * hertz.contact_radius) / hertz.peak_pressure;
                assert!(near(got, p), "{hardness} {r}: {got} {p}");
            }
        }
    }

    #[test]
    fn the_contact_conditions_hold_between_the_collocation_points() {
        let hertz = HertzSphere::under_load(1.0, 1.0, 1.0).unwrap();
        let capped = CappedHertz::under_load(1.0, 1.0, 0.7 * hertz.peak_pressure, 1.0).unwrap();
        let (a, c) = (capped.contact_radius, capped.capped_radius);
        let gap = |r: f64| r * r / 2.0 + capped.displacement(r) - capped.approach;
        for n in 1..20 {
            let share = f64::from(n) / 20.0;
            assert!(
                gap(c + share * (a - c)).abs() < 1e-11 * capped.approach,
                "{share}: {}",
                gap(c + share * (a - c))
            );
            assert!(gap(share * c) < 0.0 && gap(a * (1.0 + share)) > 0.0);
            let p = capped.pressure(c + share * (a - c)) / (0.7 * hertz.peak_pressure);
            assert!((0.0..1.0).contains(&p));
        }
        assert!((capped.displacement(1e4) * PI * 1e4 - 1.0).abs() < 1e-7); // a point load far away
    }

    #[test]
    fn the_ends_are_hertz_and_the_fully_plastic_limit() {
        let hertz = HertzSphere::under_load(1.0, 1.0, 1.0).unwrap();
        let at = |share: f64| CappedHertz::under_load(1.0, 1.0, share * hertz.peak_pressure, 1.0).unwrap();
        assert_eq!(at(1.0).approach, hertz.approach);
        assert_eq!(at(f64::INFINITY).contact_radius, hertz.contact_radius);
        // Hertz's theory is approached with the square of the capped share, c^2 / a^2 ~ 2 (1 - H/p0).
        let nearly = at(1.0 - 1e-5);
        assert!((nearly.approach / hertz.approach - 1.0).abs() < 1e-8);
        assert!((nearly.pressure(0.5) / hertz.pressure(0.5) - 1.0).abs() < 1e-8);
        // The annulus has nearly vanished at H/pH = 0.25, so the limit is reached to within its width.
        let (thin, h) = (at(0.25), 0.25 * hertz.peak_pressure);
        let a = (1.0 / (PI * h)).sqrt();
        assert!((thin.contact_radius / a - 1.0).abs() < 1e-6);
        assert!((thin.approach / (a * a / 2.0 + 4.0 / PI * h * a) - 1.0).abs() < 1e-6);
        let flat = at(0.05);
        assert_eq!(flat.contact_radius, flat.capped_radius);
        assert!((flat.contact_area() * 0.05 * hertz.peak_pressure - 1.0).abs() < 1e-14);
        assert!(flat.overlap(0.0) > flat.overlap(0.5 * flat.contact_radius));
    }

    #[test]
    fn absurd_numbers_are_named() {
        for hardness in [0.0, -1.0, f64::NAN] {
            let message = CappedHertz::under_load(1.0, 1.0, hardness, 1.0).unwrap_err().to_string();
            assert!(message.contains("hardness"), "{message}");
        }
        assert!(CappedHertz::under_load(1.0, 1.0, 1.0, -1.0).is_err());
        assert_eq!(CappedHertz::under_load(1.0, 1.0, 1.0, 0.0).unwrap().contact_radius, 0.0);
    }
}
