//! A cylinder on an elastic half-space in plane strain: H. Hertz, J. reine angew. Math. 92 (1881) 156; K. L. Johnson,
//! Contact Mechanics (Cambridge, 1985), section 4.2(c).

use std::f64::consts::PI;

use super::hertz::check;
use crate::error::{Result, non_negative};

/// A cylinder of radius R on an elastic half-space, per length.
///
/// ```text
/// a^2 = 4 R W' / (pi E*),   p = p0 sqrt(1 - x^2/a^2),   p0 = 2 W' / (pi a)
/// ```
///
/// (Johnson 1985, eqs 4.43-4.45.) In plane strain displacements and approach are only known up to a constant: only differences of
/// displacements are determined.
///
/// ```
/// use asperity::reference::HertzLine;
/// let contact = HertzLine::under_load(1.0, 1.0, std::f64::consts::FRAC_PI_4)?;
/// assert!((contact.half_width - 1.0).abs() < 1e-15 && (contact.peak_pressure - 0.5).abs() < 1e-15);
/// // Inside, the surface takes the shape of the cylinder, x^2/(2R).
/// assert!((contact.displacement_difference(0.5) + 0.125).abs() < 1e-15);
/// # Ok::<(), asperity::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HertzLine {
    /// Radius of the cylinder R \[m\].
    pub radius: f64,
    /// Load per length W' \[N/m\].
    pub load_per_length: f64,
    /// Half the width of the contact a \[m\].
    pub half_width: f64,
    /// Pressure in the middle p0 \[Pa\].
    pub peak_pressure: f64,
}

impl HertzLine {
    /// From the load per length W' >= 0 \[N/m\].
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the radius or the modulus is not positive or the load is negative.
    pub fn under_load(radius: f64, contact_modulus: f64, load_per_length: f64) -> Result<Self> {
        check(radius, contact_modulus)?;
        non_negative("load per length", load_per_length, "N/m")?;
        let half_width = (4.0 * radius * load_per_length / (PI * contact_modulus)).sqrt();
        let peak_pressure = contact_modulus * half_width / (2.0 * radius);
        Ok(HertzLine { radius, load_per_length, half_width, peak_pressure })
    }

    /// Pressure at the distance x from the middle \[Pa\].
    pub fn pressure(&self, x: f64) -> f64 {
        let a = self.half_width;
        if x.abs() < a { self.peak_pressure * ((a - x) * (a + x)).sqrt() / a } else { 0.0 }
    }

    /// Displacement at the distance x from the middle minus that in the middle, u(x) - u(0) \[m\]; not positive:
    ///
    /// ```text
    /// |x| <= a:  -x^2 / (2 R),   |x| > a:  -(x^2 - |x| sqrt(x^2 - a^2) + a^2 acosh(|x|/a)) / (2 R)
    /// ```
    ///
    /// (the integral of du/dx = -(2 p0 / (E* a)) (x - sqrt(x^2 - a^2)), Johnson 1985, section 2.5).
    pub fn displacement_difference(&self, x: f64) -> f64 {
        let (a, x) = (self.half_width, x.abs());
        if a == 0.0 {
            return 0.0;
        }
        if x <= a {
            return -x * x / (2.0 * self.radius);
        }
        let root = ((x - a) * (x + a)).sqrt();
        // x^2 - x sqrt(x^2 - a^2) without cancellation.
        let shape = x * a * (a / (x + root));
        -(shape + a * a * ((x + root) / a).ln()) / (2.0 * self.radius)
    }

    /// Stresses \[s_xx, s_zz, s_xz\] at the distance x from the middle and the depth z >= 0 \[Pa\]; tension is positive, z points into
    /// the body. In plane strain s_yy = nu (s_xx + s_zz).
    ///
    /// ```text
    /// s_xx = -(p0/a) [m (1 + (z^2 + n^2)/(m^2 + n^2)) - 2 z],   s_zz = -(p0/a) m (1 - (z^2 + n^2)/(m^2 + n^2))
    /// s_xz = -(p0/a) n (m^2 - z^2)/(m^2 + n^2)
    /// m^2 = (s + (a^2 - x^2 + z^2))/2,  n^2 = (s - (a^2 - x^2 + z^2))/2,  s^2 = (a^2 - x^2 + z^2)^2 + 4 x^2 z^2
    /// ```
    ///
    /// with m of the sign of z and n of that of x (E. McEwen, Phil. Mag. 40 (1949) 454; Johnson 1985, eqs 4.49). The largest
    /// shear stress is 0.30028 p0, at x = 0 and z = 0.78616 a.
    ///
    /// ```
    /// let line = asperity::reference::HertzLine::under_load(1.0, 1.0, 1.0)?;
    /// let [xx, zz, xz] = line.stress(0.0, 0.78616 * line.half_width);
    /// assert!((0.5 * (xx - zz) / line.peak_pressure - 0.30028).abs() < 1e-5 && xz == 0.0);
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn stress(&self, x: f64, z: f64) -> [f64; 3] {
        let (a, p0) = (self.half_width, self.peak_pressure);
        if a == 0.0 {
            return [0.0; 3];
        }
        let (x, z) = (x / a, z / a);
        let difference = 1.0 - x * x + z * z;
        let sum = difference.hypot(2.0 * x * z);
        // The smaller of the two squares from m n = x z, without cancellation.
        let (m, n) = if difference >= 0.0 {
            let m = (0.5 * (sum + difference)).sqrt();
            (m, if m > 0.0 { x * z / m } else { 0.0 })
        } else {
            let n = (0.5 * (sum - difference)).sqrt();
            (x.abs() * z / n, n.copysign(x))
        };
        if sum == 0.0 {
            // The edge of the contact.
            return [0.0; 3];
        }
        let share = (z * z + n * n) / sum;
        [-p0 * (m * (1.0 + share) - 2.0 * z), -p0 * m * (1.0 - share), -p0 * n * (m * m - z * z) / sum]
    }
}

#[cfg(test)]
mod tests {
    use super::super::quadrature::integrate;
    use super::*;

    #[test]
    fn the_pressure_carries_the_load_and_makes_the_slope() {
        let (modulus, radius) = (3.0, 1.0);
        let line = HertzLine::under_load(radius, modulus, 2.0).unwrap();
        let a = line.half_width;
        let load = 2.0 * integrate(0.0, a, |x| line.pressure(x));
        assert!((load / 2.0 - 1.0).abs() < 1e-14); // rounding
        // u(x) - u(y) = -(2 / (pi E*)) int p(s) ln((x - s) / (y - s)) ds outside the contact.
        let (x, y) = (2.5 * a, 1.25 * a);
        let sum = integrate(-a, a, |s| line.pressure(s) * ((x - s) / (y - s)).ln());
        let got = line.displacement_difference(x) - line.displacement_difference(y);
        assert!((got + 2.0 / (PI * modulus) * sum).abs() < 1e-14, "{got} {sum}"); // rounding
        assert_eq!(line.displacement_difference(-x), line.displacement_difference(x));
    }

    #[test]
    fn the_displacement_is_continuous_at_the_edge_and_logarithmic_far_away() {
        let line = HertzLine::under_load(1.0, 1.0, 1.0).unwrap();
        let a = line.half_width;
        let across = line.displacement_difference(a * (1.0 + 1e-12)) - line.displacement_difference(a);
        assert!(across.abs() < 1e-11); // the slope is -a/R
        // u(x) - u(y) = -(2 W' / (pi E*)) ln(x / y), next term of order (a/x)^2.
        let far = line.displacement_difference(1e5 * a) - line.displacement_difference(1e4 * a);
        assert!((far + 2.0 / PI * 10f64.ln()).abs() < 1e-7);
        assert_eq!(HertzLine::under_load(1.0, 1.0, 0.0).unwrap().displacement_difference(1.0), 0.0);
    }

    #[test]
    fn the_stress_is_that_of_the_line_loads() {
        // A. Flamant 1892 (Johnson 1985, eqs 2.23): s_zz = -(2 P/pi) z^3/r^4, s_xx with x^2 z, s_xz with x z^2.
        let line = HertzLine::under_load(1.0, 1.0, 1.0).unwrap();
        let (a, p0) = (line.half_width, line.peak_pressure);
        for (x, z) in [(0.0, 0.3), (0.2, 0.786), (-0.7, 0.4), (1.3, 0.5), (-2.0, 0.6), (1.0, 0.7), (0.5, 3.0)]
        {
            let (x, z) = (x * a, z * a);
            // s = a sin(angle) removes the square root at the ends.
            let sum = |f: &dyn Fn(f64) -> f64| {
                integrate(-0.5 * PI, 0.5 * PI, |angle: f64| {
                    let d = x - a * angle.sin();
                    let r2 = d * d + z * z;
                    -2.0 / PI * p0 * a * angle.cos().powi(2) * f(d) * z / (r2 * r2)
                })
            };
            let expected = [sum(&|d| d * d), sum(&|_| z * z), sum(&|d| d * z)];
            for (found, expected) in line.stress(x, z).iter().zip(expected) {
                // The quadrature's error for points of the integrand at a distance of 0.3 of its length.
                assert!((found - expected).abs() < 1e-9 * p0, "{x} {z}: {found} {expected}");
            }
        }
        let [xx, zz, xz] = line.stress(0.5 * a, 0.0);
        let p = line.pressure(0.5 * a);
        assert!((xx + p).abs() < 1e-15 && (zz + p).abs() < 1e-15 && xz == 0.0);
        assert_eq!(line.stress(a, 0.0), [0.0; 3]);
        assert!(line.stress(1.5 * a, 0.0).iter().all(|stress| *stress == 0.0));
    }

    #[test]
    fn absurd_numbers_are_named() {
        for (result, word) in [
            (HertzLine::under_load(-1.0, 1.0, 1.0), "radius"),
            (HertzLine::under_load(1.0, 0.0, 1.0), "contact modulus"),
            (HertzLine::under_load(1.0, 1.0, f64::INFINITY), "load per length"),
        ] {
            assert!(result.unwrap_err().to_string().contains(word));
        }
    }
}
