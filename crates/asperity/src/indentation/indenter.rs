//! The indenters of tests.

use std::f64::consts::FRAC_PI_2;

use crate::error::{Error, Result};
use crate::reference::MdrProfile;

/// A kind of rigid indenter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Indenter {
    /// A ball, to any depth up to its radius (I. N. Sneddon 1965).
    #[default]
    Sphere,
    /// The paraboloid r²/(2R), which a ball is near its apex.
    Paraboloid,
    /// A cone.
    Cone,
    /// A square pyramid.
    Pyramid,
}

impl Indenter {
    /// Whether it has a radius; else it has an angle.
    pub fn is_round(self) -> bool {
        matches!(self, Indenter::Sphere | Indenter::Paraboloid)
    }

    /// Its profile, from its radius \[m\] or from its half angle \[rad\]: between axis and flank of a cone, between axis and face (not edge)
    /// of a pyramid.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the angle is not between 0 and 90 degrees.
    pub fn profile(self, size: f64) -> Result<MdrProfile> {
        if !(self.is_round() || size > 0.0 && size < FRAC_PI_2) {
            return Err(Error::invalid(
                "half angle of the indenter",
                format!("{} degrees", size.to_degrees()),
                "greater than 0 and less than 90 degrees",
            ));
        }
        let slope = 1.0 / size.tan();
        Ok(match self {
            Indenter::Sphere => MdrProfile::Sphere { radius: size },
            Indenter::Paraboloid => MdrProfile::Paraboloid { radius: size },
            Indenter::Cone => MdrProfile::Cone { slope },
            Indenter::Pyramid => MdrProfile::Pyramid { slope },
        })
    }

    /// The kind of a profile.
    pub fn of(profile: MdrProfile) -> Self {
        match profile {
            MdrProfile::Sphere { .. } => Indenter::Sphere,
            MdrProfile::Paraboloid { .. } => Indenter::Paraboloid,
            MdrProfile::Cone { .. } => Indenter::Cone,
            MdrProfile::Pyramid { .. } => Indenter::Pyramid,
        }
    }
}
