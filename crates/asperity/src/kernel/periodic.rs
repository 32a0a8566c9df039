//! The periodic half-space: a pressure wave cos(q.x) of unit amplitude displaces the surface by
//! (2/|q|) cos(q.x) for E* = 1 (Westergaard 1939; Johnson, Contact Mechanics, 1985, eq. 13.7).

/// 2/|q|; 0 for the mean, which a half-space does not determine.
///
/// `q` is the wave vector \[rad/m\]; the result is in metres.
///
/// ```
/// assert_eq!(asperity::kernel::wave_kernel(3.0, 4.0), 0.4);
/// assert_eq!(asperity::kernel::wave_kernel(0.0, 0.0), 0.0);
/// ```
pub fn wave_kernel(qx: f64, qy: f64) -> f64 {
    let q = libm::hypot(qx, qy);
    if q > 0.0 { 2.0 / q } else { 0.0 }
}
