//! Elastic spheres that adhere: DMT, JKR and Maugis' transition between them, each as one curve of load over approach.
//!
//! With K = 4 E*/3 and the bars
//!
//! ```text
//! a = ā (π w R²/K)^(1/3)      load = P̄ π w R      approach = δ̄ (π² w² R/K²)^(1/3)
//!
//! DMT      P̄ = ā³ - 2                            δ̄ = ā²
//! JKR      P̄ = ā³ - √6 ā^(3/2)                   δ̄ = ā² - (2/3) √6 ā^(1/2)
//! Maugis   P̄ = ā³ - λ ā² [s + m² arctan s]       δ̄ = ā² - (4/3) λ ā s       m = c/a, s = (m² - 1)^(1/2)
//!          1 = (λ ā²/2) [s + (m² - 2) arctan s] + (4/3) λ² ā [s arctan s - m + 1]
//! ```
//!
//! The traction of Maugis' model is s0 up to the gap w/s0, out to the radius c; λ = 2 s0 (R/(π w K²))^(1/3). λ → 0 is DMT, λ → ∞ is JKR.
//! His last equation is quadratic in ā, so m gives a point of the curve without iteration.
//!
//! Sources: K. L. Johnson, K. Kendall & A. D. Roberts, Proc. R. Soc. A 324 (1971) 301; B. V. Derjaguin, V. M. Muller & Yu. P. Toporov,
//! J. Colloid Interface Sci. 53 (1975) 314; D. Maugis, J. Colloid Interface Sci. 150 (1992) 243; D. Tabor, J. Colloid Interface Sci. 58
//! (1977) 2; R. W. Carpick, D. F. Ogletree & M. Salmeron, J. Colloid Interface Sci. 211 (1999) 395.

use std::f64::consts::PI;

use crate::error::{Result, non_negative, positive};
use crate::numbers::bisect;

/// The model of an adhesive sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AdhesiveModel {
    /// No adhesion; the work of adhesion only sets the units of the bars.
    Hertz,
    /// Derjaguin, Muller & Toporov: small stiff spheres, forces of long range.
    Dmt,
    /// Johnson, Kendall & Roberts: large soft spheres, forces of short range.
    Jkr,
    /// Maugis: a constant traction up to a gap.
    Maugis {
        /// λ, greater than 0; (9/(2π))^(1/3) = 1.13 times Tabor's number of the range w/s0.
        lambda: f64,
    },
}

/// A point of the curve, in bars, with the derivatives along its parameter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BarPoint {
    pub radius: f64,
    pub load: f64,
    pub depth: f64,
    pub load_slope: f64,
    pub depth_slope: f64,
}

/// Smallest radius of the contact on the stable branch of JKR under control of the approach: ā^(3/2) = 1/√6.
const JKR_END: f64 = 0.550_321_208_149_104_4;
/// Largest and smallest s of Maugis' curve.
const MAUGIS: [f64; 2] = [1e-7, 1e7];

impl AdhesiveModel {
    /// The point of the curve at a parameter that grows with the approach: ā of JKR, δ̄ of Hertz and DMT, -ln s of Maugis.
    pub(crate) fn at(self, u: f64) -> BarPoint {
        match self {
            AdhesiveModel::Hertz | AdhesiveModel::Dmt => {
                let pull = if self == AdhesiveModel::Dmt { 2.0 } else { 0.0 };
                let radius = u.max(0.0).sqrt();
                BarPoint {
                    radius,
                    load: radius.powi(3) - pull,
                    depth: u,
                    load_slope: 1.5 * radius,
                    depth_slope: 1.0,
                }
            }
            AdhesiveModel::Jkr => {
                let (a, root, six) = (u, u.sqrt(), 6f64.sqrt());
                BarPoint {
                    radius: a,
                    load: a.powi(3) - six * a * root,
                    depth: a * a - 2.0 / 3.0 * six * root,
                    load_slope: 3.0 * a * a - 1.5 * six * root,
                    depth_slope: 2.0 * a - six / (3.0 * root),
                }
            }
            AdhesiveModel::Maugis { lambda } => maugis(lambda, (-u).exp()),
        }
    }

    /// The parameter of the last stable point when the sphere is pulled off by a spring of this stiffness in bars: 0 for control of the
    /// load, infinite for control of the approach. There dP̄ + k̄ dδ̄ = 0.
    pub(crate) fn end(self, stiffness: f64) -> f64 {
        let falls = |u: f64| {
            let point = self.at(u);
            match stiffness.is_finite() {
                true => point.load_slope + stiffness * point.depth_slope <= 0.0,
                false => point.depth_slope <= 0.0,
            }
        };
        let ends = match self {
            // Without adhesion the curve goes on: the sphere leaves without a force.
            AdhesiveModel::Hertz => return f64::NEG_INFINITY,
            AdhesiveModel::Dmt => return 0.0,
            AdhesiveModel::Jkr => [2.0, JKR_END],
            AdhesiveModel::Maugis { .. } => {
                let [first, last] = MAUGIS.map(|s| -s.ln());
                // From the pressed end: the first interval in which the branch ends.
                let steps = 400;
                let u = |k: i32| first + (last - first) * f64::from(k) / f64::from(steps);
                match (0..=steps).find(|k| falls(u(*k))) {
                    Some(0) => return first,
                    Some(k) => [u(k - 1), u(k)],
                    // Stable until the contact is a point.
                    None => return last,
                }
            }
        };
        bisect(ends, 60, |u| !falls(u))[0]
    }

    /// A parameter on the stable branch whose approach is at least this one, in bars.
    pub(crate) fn beyond(self, depth: f64) -> f64 {
        let end = self.end(f64::INFINITY);
        let (mut u, grow): (f64, fn(f64) -> f64) = match self {
            AdhesiveModel::Hertz | AdhesiveModel::Dmt => return depth.max(0.0) + 1.0,
            AdhesiveModel::Jkr => (2.0, |u| 1.5 * u),
            AdhesiveModel::Maugis { .. } => (end + 0.5, |u| u + 0.5),
        };
        let most = if self == AdhesiveModel::Jkr { 1e8 } else { -MAUGIS[0].ln() };
        while self.at(u).depth < depth && u < most {
            u = grow(u);
        }
        u
    }
}

/// Maugis' curve at s = (m² - 1)^(1/2), with derivatives along -ln s.
fn maugis(lambda: f64, s: f64) -> BarPoint {
    let (arc, m) = (s.atan(), (1.0 + s * s).sqrt());
    // Without the cancellation at small s.
    let first = match s < 0.2 {
        true => {
            (1..12).rev().fold(0.0, |sum, k| {
                let n = f64::from(2 * k);
                1.0 / (n + 1.0) + 1.0 / (n - 1.0) - s * s * sum
            }) * s.powi(3)
        }
        false => s + (s * s - 1.0) * arc,
    };
    let second = s * arc - s * s / (m + 1.0);
    let reach = s + (1.0 + s * s) * arc;
    // first ā² λ/2 + second ā 4 λ²/3 = 1
    let (p, q) = (0.5 * lambda * first, 4.0 / 3.0 * lambda * lambda * second);
    let a = 2.0 / (q + (q * q + 4.0 * p).sqrt());
    let first_slope = 2.0 * s * arc + 2.0 * s * s / (m * m);
    let second_slope = arc + s / (m * m) - s / m;
    let a_slope = -(0.5 * lambda * first_slope * a * a + 4.0 / 3.0 * lambda * lambda * second_slope * a)
        / (2.0 * p * a + q);
    let load_slope =
        3.0 * a * a * a_slope - lambda * (2.0 * a * a_slope * reach + a * a * (2.0 + 2.0 * s * arc));
    let depth_slope = 2.0 * a * a_slope - 4.0 / 3.0 * lambda * (a_slope * s + a);
    BarPoint {
        radius: a,
        load: a.powi(3) - lambda * a * a * reach,
        depth: a * a - 4.0 / 3.0 * lambda * a * s,
        load_slope: -s * load_slope,
        depth_slope: -s * depth_slope,
    }
}

/// Load, approach and radius of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdhesivePoint {
    /// Load \[N\]; tension is negative.
    pub load: f64,
    /// Approach \[m\], from the first touch of the undeformed surfaces.
    pub approach: f64,
    /// Radius of the contact \[m\].
    pub contact_radius: f64,
}

/// A rigid sphere (the paraboloid r²/(2R)) on an elastic half-space, with adhesion.
///
/// ```
/// use asperity::reference::{AdhesiveModel, AdhesiveSphere};
/// let sphere = AdhesiveSphere::new(AdhesiveModel::Jkr, 10e-6, 1e6, 0.05)?;
/// let pull_off = sphere.pull_off(0.0).load;
/// assert!((pull_off / (-1.5 * std::f64::consts::PI * 0.05 * 10e-6) - 1.0).abs() < 1e-12);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdhesiveSphere {
    model: AdhesiveModel,
    load_unit: f64,
    depth_unit: f64,
    radius_unit: f64,
}

impl AdhesiveSphere {
    /// From the radius R \[m\], the contact modulus E* \[Pa\] and the work of adhesion w \[J/m²\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if one of them, or λ, is not finite and greater than 0.
    pub fn new(model: AdhesiveModel, radius: f64, contact_modulus: f64, work: f64) -> Result<Self> {
        positive("radius", radius, "m")?;
        positive("contact modulus", contact_modulus, "Pa")?;
        positive("work of adhesion", work, "J/m2")?;
        if let AdhesiveModel::Maugis { lambda } = model {
            positive("Maugis' lambda", lambda, "")?;
        }
        Ok(Self::of(model, radius, contact_modulus, work))
    }

    pub(crate) fn of(model: AdhesiveModel, radius: f64, contact_modulus: f64, work: f64) -> Self {
        let k = 4.0 / 3.0 * contact_modulus;
        let radius_unit = (PI * work * radius * radius / k).cbrt();
        AdhesiveSphere {
            model,
            load_unit: PI * work * radius,
            depth_unit: radius_unit * radius_unit / radius,
            radius_unit,
        }
    }

    /// π w R \[N\] and (π² w² R/K²)^(1/3) \[m\].
    pub(crate) fn units(&self) -> [f64; 2] {
        [self.load_unit, self.depth_unit]
    }

    fn point(&self, u: f64) -> AdhesivePoint {
        let point = self.model.at(u);
        AdhesivePoint {
            load: self.load_unit * point.load,
            approach: self.depth_unit * point.depth,
            contact_radius: self.radius_unit * point.radius,
        }
    }

    /// The last stable contact when a spring of this stiffness \[N/m\] pulls it off: 0 for control of the load, infinite for control of the
    /// approach. Contacts without adhesion end at the first touch.
    ///
    /// Under control of the approach, contacts of DMT's and Maugis' models with small λ are followed until the contact is a point; the
    /// attraction beyond is not included.
    pub fn pull_off(&self, stiffness: f64) -> AdhesivePoint {
        self.point(
            self.model
                .end(stiffness.max(0.0) * self.depth_unit / self.load_unit)
                .max(-1e300)
                .max(self.first()),
        )
    }

    /// The first parameter with a contact.
    fn first(&self) -> f64 {
        if self.model == AdhesiveModel::Hertz { 0.0 } else { f64::NEG_INFINITY }
    }

    /// The contact at an approach \[m\] on the branch that is stable under control of the approach; `None` beyond pull-off.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the approach is not finite.
    pub fn at_approach(&self, approach: f64) -> Result<Option<AdhesivePoint>> {
        non_negative("size of the approach", approach.abs(), "m")?;
        let depth = approach / self.depth_unit;
        let ends = [self.model.end(f64::INFINITY).max(self.first()), self.model.beyond(depth)];
        let touches = |u: f64| self.model.at(u).depth <= depth;
        Ok(touches(ends[0]).then(|| self.point(bisect(ends, 200, touches)[0])))
    }
}

/// Tabor's number (R w²/(E*² z³))^(1/3) from the range z \[m\] of the attraction: JKR holds above 3 to 5, DMT below 0.1 to 0.3.
pub fn tabor(radius: f64, contact_modulus: f64, work: f64, range: f64) -> f64 {
    (radius * work * work / (contact_modulus * contact_modulus * range.powi(3))).cbrt()
}

/// Maugis' λ of the range w/s0 \[m\]: 2 (w/range) (R/(π w K²))^(1/3), that is (9/(2π))^(1/3) times [Tabor's number](tabor).
pub fn maugis_lambda(radius: f64, contact_modulus: f64, work: f64, range: f64) -> f64 {
    (4.5 / PI).cbrt() * tabor(radius, contact_modulus, work, range)
}

/// The transition parameter α of Carpick, Ogletree & Salmeron, 0 for DMT and 1 for JKR: λ = -0.924 ln(1 - 1.02 α), good to 1 %.
pub fn carpick_alpha(lambda: f64) -> f64 {
    ((1.0 - (-lambda / 0.924).exp()) / 1.02).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In bars: R, w and K such that the units are 1.
    fn bars(model: AdhesiveModel) -> AdhesiveSphere {
        let sphere = AdhesiveSphere::new(model, 1.0, 0.75, 1.0 / PI).unwrap();
        assert!((sphere.load_unit - 1.0).abs() < 1e-14 && (sphere.depth_unit - 1.0).abs() < 1e-14);
        sphere
    }

    fn near(found: f64, expected: f64) {
        // The numbers are written to 12 digits.
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }

    /// Johnson, Kendall & Roberts in the bars of the module, evaluated independently: [δ̄, P̄].
    #[test]
    fn jkr_is_the_closed_form_with_both_pull_offs() {
        let sphere = bars(AdhesiveModel::Jkr);
        for [depth, load] in [
            [-0.904_700_538_379, f64::NAN],
            [-0.632_993_161_855, -1.449_489_742_78],
            [-0.263_241_858_351, -1.470_140_984_41],
            [1.690_598_923_24, 1.071_796_769_72],
        ] {
            let point = sphere.at_approach(depth).unwrap().unwrap();
            near(point.approach, depth);
            if load.is_finite() {
                near(point.load, load);
            }
        }
        let load = sphere.pull_off(0.0);
        near(load.load, -1.5);
        near(load.approach, -0.436_790_232_368);
        near(load.contact_radius, 1.144_714_242_55);
        let depth = sphere.pull_off(f64::INFINITY);
        // The load has a vertical tangent there: 1e-8 of the radius.
        assert!((depth.load + 5.0 / 6.0).abs() < 1e-7, "{depth:?}");
        near(depth.approach, -0.908_560_296_416);
        assert_eq!(sphere.at_approach(-0.9086).unwrap(), None);
        near(sphere.at_approach(1.100_642_416_3).unwrap().unwrap().load, 0.0);
        // A spring between them pulls off between them, later for a stiffer one.
        let loads = [0.5, 2.0, 50.0].map(|k| sphere.pull_off(k).load);
        assert!(-1.5 < loads[0] && loads[0] < loads[1] && loads[1] < loads[2] && loads[2] < -5.0 / 6.0);
    }

    /// Maugis' equations solved for m at given ā by bracketing in another program: λ, pull-off P̄, and points [δ̄, P̄].
    #[test]
    fn maugis_is_the_solution_by_iteration() {
        for (lambda, pull_off, points) in [
            (
                0.1,
                -1.950_594_892_12,
                [
                    [0.160_773_368_51, -1.608_323_716_43],
                    [1.198_075_446_44, -0.167_858_379_871],
                    [3.486_802_895_74, 5.176_441_349_86],
                ],
            ),
            (
                1.0,
                -1.600_734_911_25,
                [
                    [-0.336_627_778_272, -1.579_627_020_6],
                    [0.249_094_986_696, -1.18990420785],
                    [2.349_036_358_48, 2.456_207_783_08],
                ],
            ),
            (
                5.0,
                -1.506_349_967_72,
                [
                    [-0.811_275_280_78, -1.271_897_682_1],
                    [-0.139_357_079_593, -1.422_762_116_04],
                    [1.751_673_113_18, 1.191_449_096_45],
                ],
            ),
        ] {
            let sphere = bars(AdhesiveModel::Maugis { lambda });
            near(sphere.pull_off(0.0).load, pull_off);
            for [depth, load] in points {
                near(sphere.at_approach(depth).unwrap().unwrap().load, load);
            }
        }
    }

    #[test]
    fn maugis_tends_to_dmt_and_to_jkr() {
        for depth in [0.3, 1.0, 4.0] {
            let load = |model| bars(model).at_approach(depth).unwrap().unwrap().load;
            // The cohesive zone reaches to the radius c ∝ λ^(-1/2) and lifts by (4/3) λ c ∝ λ^(1/2); towards JKR it falls as λ^(-4/3).
            let dmt = (load(AdhesiveModel::Maugis { lambda: 1e-8 }) - load(AdhesiveModel::Dmt)).abs();
            let jkr = (load(AdhesiveModel::Maugis { lambda: 200.0 }) - load(AdhesiveModel::Jkr)).abs();
            assert!(dmt < 1e-3 && jkr < 1e-3, "{depth} {dmt} {jkr}");
        }
        near(bars(AdhesiveModel::Dmt).pull_off(0.0).load, -2.0);
        near(bars(AdhesiveModel::Hertz).pull_off(0.0).load, 0.0);
    }

    #[test]
    fn derivatives_along_the_curve_are_those_of_differences() {
        for (model, u) in [
            (AdhesiveModel::Jkr, 0.9),
            (AdhesiveModel::Dmt, 0.7),
            (AdhesiveModel::Hertz, 0.7),
            (AdhesiveModel::Maugis { lambda: 0.3 }, -1.2),
            (AdhesiveModel::Maugis { lambda: 3.0 }, 2.5),
        ] {
            let (at, h) = (model.at(u), 1e-5);
            let [up, down] = [h, -h].map(|h| model.at(u + h));
            // Central differences: h² and rounding over h.
            assert!(
                ((up.load - down.load) / (2.0 * h) - at.load_slope).abs()
                    < 1e-7 * (1.0 + at.load_slope.abs())
            );
            assert!(
                ((up.depth - down.depth) / (2.0 * h) - at.depth_slope).abs()
                    < 1e-7 * (1.0 + at.depth_slope.abs())
            );
        }
    }

    #[test]
    fn numbers_of_the_transition() {
        // λ = 1 of a sphere: range = w/s0 with λ = 2 s0 (R/(π w K²))^(1/3).
        let (radius, modulus, work): (f64, f64, f64) = (1e-6, 1e9, 0.1);
        let s0 = 0.5 / (radius / (PI * work * (4.0 / 3.0 * modulus) * (4.0 / 3.0 * modulus))).cbrt();
        near(maugis_lambda(radius, modulus, work, work / s0), 1.0);
        near(carpick_alpha(1e3), 1.0 / 1.02);
        assert!(carpick_alpha(0.01) < 0.011);
    }
}
