//! The plane profile g(x) that is equivalent to an indenter, and its integrals.
//!
//! ```text
//! g(x) = |x| int_0^|x| f'(r) / sqrt(x^2 - r^2) dr      f(r): the shape
//!
//! sphere       f = R - sqrt(R^2 - r^2)     g = x artanh(x/R)     2 int_0^a (d - g) dx = (a^2 + R^2) artanh(a/R) - a R
//! paraboloid   f = r^2/(2R)                g = x^2/R             (4/3) sqrt(R) d^(3/2)
//! cone         f = slope r                 g = (pi/2) slope x    (2/pi) d^2/slope
//! pyramid      faces that rise by slope    g = slope x/0.7453    0.7453 d^2/slope
//! ```
//!
//! (Popov and Hess 2015, eq. 3.4; the sphere is that of I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47, section 6.) A square pyramid is no
//! body of revolution, but its contacts at all depths are similar, so that a cone has the same load and stiffness at each; the factor is
//! that of G. G. Bilodeau, J. Appl. Mech. 59 (1992) 519. The row of springs interpolates linearly in g, so each integral here is over
//! a cell x0 < x < x1.

use std::f64::consts::FRAC_PI_2;

use crate::error::{Result, positive};
use crate::numbers::bisect;

/// The equivalent plane profile g(x) of a rigid indenter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MdrProfile {
    /// The sphere itself: g = x artanh(x/R), for contacts narrower than its equator.
    Sphere {
        /// Radius R \[m\].
        radius: f64,
    },
    /// The paraboloid r^2/(2R), which a sphere is near its apex: g = x^2/R.
    Paraboloid {
        /// Radius R \[m\].
        radius: f64,
    },
    /// The cone slope r: g = (pi/2) slope |x|.
    Cone {
        /// Rise per length, the cotangent of the half angle.
        slope: f64,
    },
    /// The square pyramid slope max(|x|, |y|): g = slope |x|/0.7453. Pressures and displacements are those of the cone with its load.
    Pyramid {
        /// Rise per length of a face, the cotangent of the angle between face and axis.
        slope: f64,
    },
}

/// Load over depth² of a square pyramid of slope 1 for E* = 1 (Bilodeau 1992).
const PYRAMID: f64 = 0.7453;
/// Largest x/R of the sphere's g; beyond, at depths above 3.8 R, it goes on along its tangent.
const EQUATOR: f64 = 0.999;

/// Points and weights of Gauss and Legendre on \[0, 1\].
const GAUSS: [[f64; 2]; 6] = [
    [0.033_765_242_898_423_99, 0.085_662_246_189_585_18],
    [0.169_395_306_766_867_74, 0.180_380_786_524_069_3],
    [0.380_690_406_958_401_55, 0.233_956_967_286_345_52],
    [0.619_309_593_041_598_4, 0.233_956_967_286_345_52],
    [0.830_604_693_233_132_3, 0.180_380_786_524_069_3],
    [0.966_234_757_101_576, 0.085_662_246_189_585_18],
];

/// int_a^b f dx of a smooth function.
fn integral(a: f64, b: f64, f: impl Fn(f64) -> f64) -> f64 {
    GAUSS.iter().map(|[x, weight]| weight * f(a + (b - a) * x)).sum::<f64>() * (b - a)
}

/// artanh(s) + s/(1 - s²), the slope of s artanh(s).
fn ball_slope(s: f64) -> f64 {
    let s = s.min(EQUATOR);
    s.atanh() + s / ((1.0 - s) * (1.0 + s))
}

/// s artanh(s).
fn ball(s: f64) -> f64 {
    let inside = s.min(EQUATOR);
    inside * inside.atanh() + (s - inside) * ball_slope(inside)
}

/// The s with s artanh(s) = height. The function is convex, so Newton's steps from above never pass the root.
fn ball_reach(height: f64) -> f64 {
    if height > ball(EQUATOR) {
        return EQUATOR + (height - ball(EQUATOR)) / ball_slope(EQUATOR);
    }
    let mut s = height.sqrt().min(EQUATOR);
    for _ in 0..60 {
        let step = (ball(s) - height) / ball_slope(s);
        if s <= 0.0 || step <= 1e-16 * s {
            break;
        }
        s -= step;
    }
    s
}

/// (1 + s²) artanh(s) - s, the load of the ball R = 1 with a contact of radius s.
fn ball_load(s: f64) -> f64 {
    if s < 0.2 {
        // Without the cancellation.
        let term = |k: i32| 1.0 / f64::from(2 * k + 1) + 1.0 / f64::from(2 * k - 1);
        return s.powi(3) * (1..12).rev().fold(0.0, |sum, k| term(k) + s * s * sum);
    }
    let inside = s.min(EQUATOR);
    let beyond = s - inside;
    // 2 int (d - g) dx grows by 2 x g' dx.
    (1.0 + inside * inside) * inside.atanh() - inside + beyond * (2.0 * inside + beyond) * ball_slope(inside)
}

impl MdrProfile {
    pub(crate) fn validate(&self) -> Result<()> {
        match self {
            MdrProfile::Sphere { radius } | MdrProfile::Paraboloid { radius } => {
                positive("radius", *radius, "m")
            }
            MdrProfile::Cone { slope } => positive("slope of the cone", *slope, ""),
            MdrProfile::Pyramid { slope } => positive("slope of the pyramid", *slope, ""),
        }
        .map(drop)
    }

    /// The radius of a sphere or paraboloid \[m\].
    pub fn radius(&self) -> Option<f64> {
        match self {
            MdrProfile::Sphere { radius } | MdrProfile::Paraboloid { radius } => Some(*radius),
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => None,
        }
    }

    /// The slope of the cone with this profile, of a cone or pyramid.
    pub fn cone(&self) -> Option<f64> {
        match self {
            MdrProfile::Cone { slope } => Some(*slope),
            MdrProfile::Pyramid { slope } => Some(slope / PYRAMID / FRAC_PI_2),
            MdrProfile::Sphere { .. } | MdrProfile::Paraboloid { .. } => None,
        }
    }

    /// What it is near the apex: a sphere is a paraboloid.
    pub(crate) fn apex(self) -> Self {
        match self {
            MdrProfile::Sphere { radius } => MdrProfile::Paraboloid { radius },
            other => other,
        }
    }

    /// The same kind with a radius or slope that many times as large.
    pub(crate) fn scaled(self, times: f64) -> Self {
        match self {
            MdrProfile::Sphere { radius } => MdrProfile::Sphere { radius: times * radius },
            MdrProfile::Paraboloid { radius } => MdrProfile::Paraboloid { radius: times * radius },
            MdrProfile::Cone { slope } => MdrProfile::Cone { slope: times * slope },
            MdrProfile::Pyramid { slope } => MdrProfile::Pyramid { slope: times * slope },
        }
    }

    /// dg/dx of a cone or pyramid.
    fn rise(&self) -> f64 {
        match self {
            MdrProfile::Cone { slope } => FRAC_PI_2 * slope,
            MdrProfile::Pyramid { slope } => slope / PYRAMID,
            MdrProfile::Sphere { .. } | MdrProfile::Paraboloid { .. } => 0.0,
        }
    }

    /// g(x) \[m\].
    pub fn height(&self, x: f64) -> f64 {
        match *self {
            MdrProfile::Sphere { radius } => radius * ball(x / radius),
            MdrProfile::Paraboloid { radius } => x * x / radius,
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => self.rise() * x,
        }
    }

    /// The x >= 0 if g(x) = height \[m\].
    pub fn reach(&self, height: f64) -> f64 {
        match *self {
            MdrProfile::Sphere { radius } => radius * ball_reach(height / radius),
            MdrProfile::Paraboloid { radius } => (height * radius).sqrt(),
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => height / self.rise(),
        }
    }

    /// Load at a depth \[m\] for E* = 1 \[m²\]: 2 int_0^a (depth - g) dx; its slope over the depth is 2 a.
    ///
    /// ```
    /// use asperity::reference::MdrProfile;
    /// // Sneddon's ball with a contact of half its radius: d = (a/2) ln((R + a)/(R - a)) = ln(3)/4, W = (5/8) ln(3) - 1/2.
    /// let ball = MdrProfile::Sphere { radius: 1.0 };
    /// let ln3 = 3f64.ln();
    /// assert!((ball.reach(0.25 * ln3) - 0.5).abs() < 1e-15);
    /// assert!((ball.unit_load(0.25 * ln3) - (0.625 * ln3 - 0.5)).abs() < 1e-15);
    /// ```
    pub fn unit_load(&self, depth: f64) -> f64 {
        let a = self.reach(depth);
        match *self {
            MdrProfile::Sphere { radius } => radius * radius * ball_load(a / radius),
            MdrProfile::Paraboloid { .. } => 4.0 / 3.0 * depth * a,
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => depth * a,
        }
    }

    /// How much more load a paraboloid carries at this depth \[m\] than the ball of its radius, over that of the ball; `None` for other
    /// indenters.
    ///
    /// ```
    /// use asperity::reference::MdrProfile;
    /// let ball = MdrProfile::Sphere { radius: 1.0 };
    /// // To first order a tenth of d/R.
    /// assert!((ball.paraboloid_excess(1e-3).unwrap() / 1e-4 - 1.0).abs() < 1e-2);
    /// ```
    pub fn paraboloid_excess(&self, depth: f64) -> Option<f64> {
        let radius = self.radius()?;
        let [ball, paraboloid] = [MdrProfile::Sphere { radius }, MdrProfile::Paraboloid { radius }]
            .map(|profile| profile.unit_load(depth));
        Some(paraboloid / ball - 1.0)
    }

    /// Radius of the elastic contact under a load: (3 R W C / 4)^(1/3) or (2 W C / (pi slope))^(1/2).
    pub(super) fn elastic_radius(&self, load: f64, compliance: f64) -> f64 {
        let unit = load * compliance;
        match *self {
            MdrProfile::Sphere { radius } => {
                let [low, high] = bisect([0.0, EQUATOR], 60, |s| radius * radius * ball_load(s) < unit);
                radius * 0.5 * (low + high)
            }
            MdrProfile::Paraboloid { radius } => (0.75 * radius * unit).cbrt(),
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => (unit / self.rise()).sqrt(),
        }
    }

    /// Mean of (g - g(x0)) / (g(x1) - g(x0)) over x0 < x < x1: the centre of weight of a cell that is linear in g.
    pub(super) fn lean(&self, x0: f64, x1: f64) -> f64 {
        match self {
            MdrProfile::Sphere { .. } => {
                let [g0, g1] = [x0, x1].map(|x| self.height(x));
                match g1 > g0 {
                    true => integral(0.0, 1.0, |t| self.height(x0 + t * (x1 - x0)) - g0) / (g1 - g0),
                    false => 0.5,
                }
            }
            MdrProfile::Paraboloid { .. } => (x1 + 2.0 * x0) / (3.0 * (x0 + x1)),
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => 0.5,
        }
    }

    /// int_x0^x1 g'(x) / sqrt(x^2 - r^2) dx for r <= x0.
    pub(super) fn slope_seen(&self, x0: f64, x1: f64, r: f64) -> f64 {
        let root = |x: f64| ((x - r) * (x + r)).max(0.0).sqrt();
        match *self {
            // x² = r² + s²: dx/sqrt(x² - r²) = ds/x.
            MdrProfile::Sphere { radius } => integral(root(x0), root(x1), |s| {
                let x = r.hypot(s);
                if x > 0.0 { ball_slope(x / radius) / x } else { 2.0 / radius }
            }),
            MdrProfile::Paraboloid { radius } => 2.0 / radius * (root(x1) - root(x0)),
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => {
                self.rise() * ((x1 + root(x1)) / (x0 + root(x0))).ln()
            }
        }
    }

    /// int_x0^x1 (1, g(x)) / sqrt(r^2 - x^2) dx for x1 <= r.
    pub(super) fn weights_seen(&self, x0: f64, x1: f64, r: f64) -> [f64; 2] {
        let root = |x: f64| ((r - x) * (r + x)).max(0.0).sqrt();
        let angle = |x: f64| (x / r).min(1.0).asin();
        let ones = angle(x1) - angle(x0);
        let heights = match *self {
            // x = r sin(angle)
            MdrProfile::Sphere { .. } => integral(angle(x0), angle(x1), |t| self.height(r * t.sin())),
            MdrProfile::Paraboloid { radius } => {
                (r * r * ones - x1 * root(x1) + x0 * root(x0)) / (2.0 * radius)
            }
            MdrProfile::Cone { .. } | MdrProfile::Pyramid { .. } => self.rise() * (root(x0) - root(x1)),
        };
        [ones, heights]
    }
}
