//! Invariants of the stress tensor: von Mises, Tresca, the largest principal stress.

/// Numbers of a stress tensor that do not depend on the axes \[Pa\].
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Invariants {
    /// von Mises: sqrt(3 J2).
    pub mises: f64,
    /// Tresca, the largest shear stress: (s1 - s3)/2.
    pub tresca: f64,
    /// The largest principal stress s1; positive in tension.
    pub tension: f64,
    /// -(xx + yy + zz)/3; positive in compression.
    pub pressure: f64,
}

/// The invariants of (xx, yy, zz, xy, xz, yz), from J2 and J3 of the deviator: with theta the Lode angle,
/// s1 = m + 2 sqrt(J2/3) cos(theta) and s3 = m + 2 sqrt(J2/3) cos(theta + 2 pi/3).
///
/// ```
/// // Uniaxial tension of 2 MPa.
/// let found = asperity::stress::invariants([2e6, 0.0, 0.0, 0.0, 0.0, 0.0]);
/// assert!((found.mises - 2e6).abs() < 1e-6 && (found.tresca - 1e6).abs() < 1e-6 && (found.tension - 2e6).abs() < 1e-6);
/// ```
pub fn invariants([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Invariants {
    let mean = (xx + yy + zz) / 3.0;
    let (a, b, c) = (xx - mean, yy - mean, zz - mean);
    let (d, e, f) = (xy, xz, yz);
    let j2 = 0.5 * (a * a + b * b + c * c) + d * d + e * e + f * f;
    if j2 <= 0.0 {
        return Invariants { tension: mean, pressure: -mean, ..Invariants::default() };
    }
    let j3 = a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e);
    let root = j2.sqrt();
    let cosine = 1.5 * 3.0_f64.sqrt() * j3 / (j2 * root);
    let theta = libm::acos(cosine.clamp(-1.0, 1.0)) / 3.0;
    let radius = 2.0 * root / 3.0_f64.sqrt();
    let third = std::f64::consts::TAU / 3.0;
    let (s1, s3) = (radius * libm::cos(theta), radius * libm::cos(theta + third));
    Invariants { mises: 3.0_f64.sqrt() * root, tresca: 0.5 * (s1 - s3), tension: mean + s1, pressure: -mean }
}
