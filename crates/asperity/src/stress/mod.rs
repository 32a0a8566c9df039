//! The stress below the surface of a half-space under a given pressure, and under tangential tractions (`shear`).
//!
//! Coordinates: z points into the body, tension is positive. With Love's potentials V = iint p/rho and chi = iint p ln(rho + z)
//! over the surface (Love 1929; Johnson, Contact Mechanics, 1985, section 3.1), rho the distance,
//!
//! ```text
//! 2 pi s_zz = V_z - z V_zz       2 pi s_xz = -z V_xz       2 pi s_yz = -z V_yz
//! 2 pi s_xx = 2 nu V_z - (1 - 2 nu) chi_xx - z V_xx        (s_yy: x and y exchanged)
//! 2 pi s_xy = -(1 - 2 nu) chi_xy - z V_xy
//! ```
//!
//! The stress does not depend on the modulus, and depends on Poisson's ratio nu only in xx, yy, xy. If Poisson's ratio is
//! constant in time, the stress of a viscoelastic body at time t therefore follows only from the pressure at time t
//! (correspondence principle), and can be computed from any stored pressure. With a constant bulk modulus nu changes in time, and
//! the stress needs the pressures from the beginning on ([`PressureHistory`]). The second body has the same stress with its own
//! nu, with z into this body.
//!
//! Every component is a convolution of the pressure. A free domain uses the exact stress of a uniformly loaded cell
//! ([`rectangle`]; for a line contact, in plane strain, that of a [`strip`]), a periodic one the closed form of a wave
//! ([`wave`]). They are symmetric or antisymmetric in each direction, so only a quarter of their spectrum is stored, as real
//! numbers.

mod coefficients;
mod convolve;
mod depths;
mod history;
mod invariants;
mod quantity;
mod shear;
mod slab;
mod survey;

pub use coefficients::{rectangle, strip, wave};
pub use convolve::SubsurfaceStress;
pub use depths::{automatic_depths, check_depth, check_depths, contact_box, spaced_depths, unseen_depths};
pub use history::PressureHistory;
pub use invariants::{Invariants, invariants};
pub use quantity::StressQuantity;
pub use survey::{Extreme, OrthogonalShear, Rolling, Survey, SurveyOptions, survey, survey_with};

/// A component of the stress tensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Component {
    /// Normal stress along x.
    Xx,
    /// Normal stress along y.
    Yy,
    /// Normal stress along z.
    Zz,
    /// Shear stress in the plane.
    Xy,
    /// Shear stress on planes parallel to the surface, along x.
    Xz,
    /// Shear stress on planes parallel to the surface, along y.
    Yz,
}

impl Component {
    /// All six, in the order of [`SubsurfaceStress::at`].
    pub const ALL: [Component; 6] =
        [Component::Xx, Component::Yy, Component::Zz, Component::Xy, Component::Xz, Component::Yz];

    /// "xx", "yy", ...
    pub fn name(self) -> &'static str {
        match self {
            Component::Xx => "xx",
            Component::Yy => "yy",
            Component::Zz => "zz",
            Component::Xy => "xy",
            Component::Xz => "xz",
            Component::Yz => "yz",
        }
    }

    /// Whether the stress under a single load is antisymmetric in x, in y.
    pub(self) fn is_odd(self) -> [bool; 2] {
        match self {
            Component::Xx | Component::Yy | Component::Zz => [false, false],
            Component::Xy => [true, true],
            Component::Xz => [true, false],
            Component::Yz => [false, true],
        }
    }
}

#[cfg(test)]
mod tests;
