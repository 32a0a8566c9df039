//! What acts on the surface, and the stress under a uniform tangential traction: closed forms.
//!
//! A traction q along x, that of the other body on this one, has with V and chi of the pressure and Omega = iint z ln(rho + z) - rho
//! (Cerruti; derived from the waves below, which satisfy equilibrium and compatibility)
//!
//! ```text
//! 2 pi s_xx = 2 V_x - z chi_xxx - 2 nu Omega_xyy      2 pi s_xy = V_y - z chi_xxy + 2 nu Omega_xxy
//! 2 pi s_yy = -z chi_xyy - 2 nu Omega_xxx             2 pi s_xz = V_z - z V_xx
//! 2 pi s_zz = -z V_xz                                 2 pi s_yz = -z V_xy
//! ```

use super::Component;
use super::coefficients::{self, Strip};

/// What acts on the surface.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Action {
    Pressure,
    /// A traction along x, along y.
    ShearX,
    ShearY,
}

impl Component {
    /// The same component with x and y exchanged.
    fn exchanged(self) -> Component {
        match self {
            Component::Xx => Component::Yy,
            Component::Yy => Component::Xx,
            Component::Xz => Component::Yz,
            Component::Yz => Component::Xz,
            Component::Zz | Component::Xy => self,
        }
    }
}

impl Action {
    /// Whether the stress is antisymmetric in x, in y.
    pub(super) fn is_odd(self, component: Component) -> [bool; 2] {
        let [x, y] = component.is_odd();
        match self {
            Action::Pressure => [x, y],
            Action::ShearX => [!x, y],
            Action::ShearY => [x, !y],
        }
    }

    /// G of a corner, see [`coefficients::corner`].
    pub(super) fn corner(self, component: Component, [x, y, z]: [f64; 3], poisson: f64, is_far: bool) -> f64 {
        match self {
            Action::Pressure => coefficients::corner(component, x, y, z, poisson, is_far),
            Action::ShearX => corner(component, x, y, z, poisson),
            Action::ShearY => corner(component.exchanged(), y, x, z, poisson),
        }
    }

    /// Of a strip, see [`coefficients::strip`].
    pub(super) fn strip(self, component: Component, x: f64, depth: f64, half: f64, poisson: f64) -> f64 {
        match self {
            Action::Pressure => coefficients::strip(component, x, depth, half, poisson),
            Action::ShearX => strip_along_x(component, x, depth, half, poisson),
            Action::ShearY => strip_along_y(component, x, depth, half),
        }
    }

    /// Of a wave, see [`coefficients::wave`].
    pub(super) fn wave(self, component: Component, [qx, qy]: [f64; 2], depth: f64, poisson: f64) -> f64 {
        match self {
            Action::Pressure => coefficients::wave(component, [qx, qy], depth, poisson),
            Action::ShearX => wave(component, [qx, qy], depth, poisson),
            Action::ShearY => wave(component.exchanged(), [qy, qx], depth, poisson),
        }
    }
}

/// G under a traction along x; functions of one coordinate, which the mixed difference removes, are left out where they would cancel.
fn corner(component: Component, x: f64, y: f64, z: f64, poisson: f64) -> f64 {
    let (x2, y2, z2) = (x * x, y * y, z * z);
    let r = (x2 + y2 + z2).sqrt();
    // Integrals of 1/rho along y and along x.
    let (along_y, along_x) = (libm::asinh(y / (x2 + z2).sqrt()), libm::asinh(x / (y2 + z2).sqrt()));
    match component {
        Component::Xx => {
            2.0 * along_y - z * y * (z * r - x2) / (r * (r + z) * (x2 + z2)) + 2.0 * poisson * y / (r + z)
        }
        Component::Yy => -z * y / (r * (r + z)) - 2.0 * poisson * (y / (r + z) - along_y),
        Component::Zz => y * z2 / (r * (x2 + z2)),
        Component::Xy => along_x - z * x / (r * (r + z)) - 2.0 * poisson * x / (r + z),
        Component::Xz => {
            let angle = libm::atan2(x * y, z * r);
            -angle.clamp(-std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2)
                + x * y * z / (r * (x2 + z2))
        }
        Component::Yz => -z / r,
    }
}

/// Plane strain under a traction along x (Johnson, Contact Mechanics, 1985, eqs 2.33).
fn strip_along_x(component: Component, x: f64, depth: f64, half: f64, poisson: f64) -> f64 {
    let Strip { theta, log, shear, difference } = Strip::of(x, depth, half);
    match component {
        Component::Xx => -log - shear,
        Component::Zz => shear,
        Component::Yy => -poisson * log,
        Component::Xz => -theta + difference,
        Component::Xy | Component::Yz => 0.0,
    }
}

/// Under a traction along y nothing but shear along y.
fn strip_along_y(component: Component, x: f64, depth: f64, half: f64) -> f64 {
    let Strip { theta, log, .. } = Strip::of(x, depth, half);
    match component {
        Component::Yz => -theta,
        Component::Xy => -0.5 * log,
        Component::Xx | Component::Yy | Component::Zz | Component::Xz => 0.0,
    }
}

/// Amplitude under the wave exp(i q.x) of a traction along x, without the factor i for each direction in which it is odd. Of a uniform
/// traction only s_xz is left.
fn wave(component: Component, [qx, qy]: [f64; 2], depth: f64, poisson: f64) -> f64 {
    let q = libm::hypot(qx, qy);
    if q == 0.0 {
        return if component == Component::Xz { -1.0 } else { 0.0 };
    }
    let (nx, ny, t) = (qx / q, qy / q, q * depth);
    let amplitude = match component {
        Component::Xx => nx * (2.0 - t * nx * nx + 2.0 * poisson * ny * ny),
        Component::Yy => nx * (2.0 * poisson * nx * nx - t * ny * ny),
        Component::Zz => nx * t,
        Component::Xy => ny * (1.0 - (t + 2.0 * poisson) * nx * nx),
        Component::Xz => nx * nx * t - 1.0,
        Component::Yz => -nx * ny * t,
    };
    amplitude * libm::exp(-t)
}
