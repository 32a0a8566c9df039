//! The plane profile g(x) that is equivalent to a body of revolution, and its integrals.
//!
//! ```text
//! g(x) = |x| int_0^|x| f'(r) / sqrt(x^2 - r^2) dr      f(r): the shape, f = r^2/(2R) or slope r
//! ```
//!
//! (Popov and Hess 2015, eq. 3.4.) The row of springs interpolates linearly in g, so each integral here is over a cell x0 < x <
//! x1.

use std::f64::consts::FRAC_PI_2;

use crate::error::{Result, positive};

/// The equivalent plane profile g(x) of a rigid body of revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MdrProfile {
    /// The paraboloid r^2/(2R): g = x^2/R.
    Sphere {
        /// Radius R \[m\].
        radius: f64,
    },
    /// The cone slope r: g = (pi/2) slope |x|.
    Cone {
        /// Rise per length.
        slope: f64,
    },
}

impl MdrProfile {
    pub(crate) fn validate(&self) -> Result<()> {
        match self {
            MdrProfile::Sphere { radius } => positive("radius", *radius, "m"),
            MdrProfile::Cone { slope } => positive("slope of the cone", *slope, ""),
        }
        .map(drop)
    }

    /// g(x) \[m\].
    pub fn height(&self, x: f64) -> f64 {
        match self {
            MdrProfile::Sphere { radius } => x * x / radius,
            MdrProfile::Cone { slope } => FRAC_PI_2 * slope * x,
        }
    }

    /// The x >= 0 if g(x) = height \[m\].
    pub fn reach(&self, height: f64) -> f64 {
        match self {
            MdrProfile::Sphere { radius } => (height * radius).sqrt(),
            MdrProfile::Cone { slope } => height / (FRAC_PI_2 * slope),
        }
    }

    /// Load at a depth \[m\] for E* = 1 \[m²\]: 2 int_0^a (depth - g) dx.
    pub(crate) fn unit_load(&self, depth: f64) -> f64 {
        let a = self.reach(depth);
        match self {
            MdrProfile::Sphere { .. } => 4.0 / 3.0 * depth * a,
            MdrProfile::Cone { .. } => depth * a,
        }
    }

    /// Radius of the elastic contact under a load: (3 R W C / 4)^(1/3) or (2 W C / (pi slope))^(1/2).
    pub(super) fn elastic_radius(&self, load: f64, compliance: f64) -> f64 {
        match self {
            MdrProfile::Sphere { radius } => (0.75 * radius * load * compliance).cbrt(),
            MdrProfile::Cone { slope } => (load * compliance / (FRAC_PI_2 * slope)).sqrt(),
        }
    }

    /// Mean of (g - g(x0)) / (g(x1) - g(x0)) over x0 < x < x1: the centre of weight of a cell that is linear in g.
    pub(super) fn lean(&self, x0: f64, x1: f64) -> f64 {
        match self {
            MdrProfile::Sphere { .. } => (x1 + 2.0 * x0) / (3.0 * (x0 + x1)),
            MdrProfile::Cone { .. } => 0.5,
        }
    }

    /// int_x0^x1 g'(x) / sqrt(x^2 - r^2) dx for r <= x0.
    pub(super) fn slope_seen(&self, x0: f64, x1: f64, r: f64) -> f64 {
        let root = |x: f64| ((x - r) * (x + r)).max(0.0).sqrt();
        match self {
            MdrProfile::Sphere { radius } => 2.0 / radius * (root(x1) - root(x0)),
            MdrProfile::Cone { slope } => FRAC_PI_2 * slope * ((x1 + root(x1)) / (x0 + root(x0))).ln(),
        }
    }

    /// int_x0^x1 (1, g(x)) / sqrt(r^2 - x^2) dx for x1 <= r.
    pub(super) fn weights_seen(&self, x0: f64, x1: f64, r: f64) -> [f64; 2] {
        let root = |x: f64| ((r - x) * (r + x)).max(0.0).sqrt();
        let angle = |x: f64| (x / r).min(1.0).asin();
        let ones = angle(x1) - angle(x0);
        let heights = match self {
            MdrProfile::Sphere { radius } => (r * r * ones - x1 * root(x1) + x0 * root(x0)) / (2.0 * radius),
            MdrProfile::Cone { slope } => FRAC_PI_2 * slope * (root(x0) - root(x1)),
        };
        [ones, heights]
    }
}
