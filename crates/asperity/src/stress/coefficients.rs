//! The stress under a uniformly loaded rectangle or strip, and under a wave of pressure: closed forms.

use std::f64::consts::FRAC_1_PI;

use super::Component;

/// Stress at (x, y, `depth`) under unit pressure on the rectangle |x'| <= a, |y'| <= b, `half` = \[a, b\].
///
/// The second mixed difference of G(x, y) over the corners, divided by 2 pi (derived from Love's potentials, G_xy their
/// integrand). (x, y) must not lie on the lines x = +-a, y = +-b where the depth is 0. Absolute error below 1e-12.
///
/// ```
/// use asperity::stress::{Component, rectangle};
/// // Under the middle of a square at a depth of half its side.
/// let zz = rectangle(Component::Zz, [0.0, 0.0], 1.0, [1.0, 1.0], 0.3);
/// assert!((zz + 0.7008859302811946).abs() < 1e-14);
/// ```
pub fn rectangle(component: Component, [x, y]: [f64; 2], depth: f64, half: [f64; 2], poisson: f64) -> f64 {
    let [a, b] = half;
    let is_far = depth > (x.abs() + a).max(y.abs() + b);
    let g = |x: f64, y: f64| corner(component, x, y, depth, poisson, is_far);
    (g(x + a, y + b) - g(x - a, y + b) - g(x + a, y - b) + g(x - a, y - b)) / std::f64::consts::TAU
}

/// G of a corner at (x, y) from the point at depth z; neither x nor y is 0 if z is.
///
/// At depths beyond the corners (`is_far`) G tends to functions of one coordinate, which the mixed difference removes: -(1 - 2
/// nu) ln 2z - 1 for xy, y/z for xz and x/z for yz. They are omitted there, so that their rounding errors do not dominate a
/// stress that decays as 1/z^3 or faster. All corners of a rectangle use the same form.
pub(super) fn corner(component: Component, x: f64, y: f64, z: f64, poisson: f64, is_far: bool) -> f64 {
    let (x2, y2, z2) = (x * x, y * y, z * z);
    let r = (x2 + y2 + z2).sqrt();
    // R - z without cancellation.
    let below = (x2 + y2) / (r + z);
    let solid_angle =
        || libm::atan2(x * y, z * r).clamp(-std::f64::consts::FRAC_PI_2, std::f64::consts::FRAC_PI_2);
    let along = |u2: f64, v2: f64| libm::atan2(x * y * below, u2 * r + z * v2);
    // y z^2/(R (x^2 + z^2)), or that minus y/z.
    let shear = |x2: f64, y: f64| match is_far {
        false => y * z2 / (r * (x2 + z2)),
        true => -y * (r * x2 + z2 * below) / (z * r * (x2 + z2)),
    };
    match component {
        Component::Zz => -solid_angle() - x * y * z / r * (1.0 / (x2 + z2) + 1.0 / (y2 + z2)),
        Component::Xx => {
            -2.0 * poisson * solid_angle() - (1.0 - 2.0 * poisson) * along(x2, y2)
                + x * y * z / (r * (x2 + z2))
        }
        Component::Yy => {
            -2.0 * poisson * solid_angle() - (1.0 - 2.0 * poisson) * along(y2, x2)
                + x * y * z / (r * (y2 + z2))
        }
        Component::Xy if is_far => -(1.0 - 2.0 * poisson) * libm::log1p(0.5 * below / z) + below / r,
        Component::Xy => -(1.0 - 2.0 * poisson) * libm::log(r + z) - z / r,
        Component::Xz => shear(x2, y),
        Component::Yz => shear(y2, x),
    }
}

/// Stress at the distance x from the middle of a strip |x'| <= a, infinite along y, at `depth` z under unit pressure: plane
/// strain, s_yy = nu (s_xx + s_zz), no stress xy or yz. (x, z) must not be an edge of the strip.
///
/// ```text
/// pi s_zz = -theta - c,   pi s_xx = -theta + c,   pi s_xz = -4 a x z^2 / (r1^2 r2^2)
/// c = 2 a z (z^2 - x^2 + a^2) / (r1^2 r2^2),   r^2 = (x +- a)^2 + z^2
/// ```
///
/// theta is the angle under which the strip is seen (Johnson, Contact Mechanics, 1985, section 2.5, eqs 2.31). All terms are free
/// of cancellation, so even far from the strip the error is a rounding error of the largest component.
///
/// ```
/// use asperity::stress::{Component, strip};
/// // On the axis at a depth of half the width theta is a right angle: s_zz = -1/2 - 1/pi.
/// let zz = strip(Component::Zz, 0.0, 1.0, 1.0, 0.3);
/// assert!((zz + 0.5 + 1.0 / std::f64::consts::PI).abs() < 1e-15);
/// ```
pub fn strip(component: Component, x: f64, depth: f64, half: f64, poisson: f64) -> f64 {
    let Strip { theta, shear, difference, .. } = Strip::of(x, depth, half);
    match component {
        Component::Zz => -theta - difference,
        Component::Xx => -theta + difference,
        Component::Yy => -2.0 * poisson * theta,
        Component::Xz => shear,
        Component::Xy | Component::Yz => 0.0,
    }
}

/// The angle under which the strip is seen, ln(r1^2/r2^2), [z^2/r^2] and [z u/r^2] between its edges, all over pi; in steps that neither
/// overflow nor underflow.
pub(super) struct Strip {
    pub(super) theta: f64,
    pub(super) log: f64,
    pub(super) shear: f64,
    pub(super) difference: f64,
}

impl Strip {
    pub(super) fn of(x: f64, depth: f64, half: f64) -> Strip {
        let (right, left, z2) = (x + half, x - half, depth * depth);
        let (far, near) = (right * right + z2, left * left + z2);
        let product = right * left;
        // Free of cancellation far from the strip.
        let log = match x < 0.0 {
            true => -libm::log1p(-4.0 * half * x / far),
            false => libm::log1p(4.0 * half * x / near),
        };
        Strip {
            theta: libm::atan2(2.0 * half * depth, z2 + product) * FRAC_1_PI,
            log: FRAC_1_PI * log,
            shear: -4.0 * half * x / far * (z2 / near) * FRAC_1_PI,
            difference: 2.0 * half * depth / far * ((z2 - product) / near) * FRAC_1_PI,
        }
    }
}

/// Amplitude of the stress at `depth` under the pressure wave exp(i q.x) of unit amplitude, without the factor i that it has
/// for each direction in which the component is odd (xz and yz: i, xy: i^2).
///
/// With n = q/|q| and t = |q| z, for zz: -(1 + t) exp(-t). A uniform pressure (q = 0) gives zz = -1 and
/// xx = yy = -nu/(1 - nu): no mean lateral strain, the consistent choice on a periodic domain.
pub fn wave(component: Component, [qx, qy]: [f64; 2], depth: f64, poisson: f64) -> f64 {
    let q = libm::hypot(qx, qy);
    if q == 0.0 {
        return match component {
            Component::Zz => -1.0,
            Component::Xx | Component::Yy => -poisson / (1.0 - poisson),
            Component::Xy | Component::Xz | Component::Yz => 0.0,
        };
    }
    let (nx, ny, t) = (qx / q, qy / q, q * depth);
    let amplitude = match component {
        Component::Zz => -(1.0 + t),
        Component::Xx => -(nx * nx * (1.0 - t) + 2.0 * poisson * ny * ny),
        Component::Yy => -(ny * ny * (1.0 - t) + 2.0 * poisson * nx * nx),
        Component::Xy => nx * ny * (1.0 - 2.0 * poisson - t),
        Component::Xz => nx * t,
        Component::Yz => ny * t,
    };
    amplitude * libm::exp(-t)
}
