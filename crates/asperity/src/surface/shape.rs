//! Smooth shapes: the gap h(x, y) between a body and a flat that it touches at its centre.
//!
//! ```text
//! sphere       r^2 / (2 R)                       the paraboloid of Hertz's theory
//! ellipsoid    x^2 / (2 Rx) + y^2 / (2 Ry)
//! cylinder     x^2 / (2 R), straight along y
//! cone         slope r
//! wedge        slope |x|, straight along y
//! flat punch   0 inside, never touching outside
//! wave         A (1 - cos(2 pi x / lx) cos(2 pi y / ly))
//! ```
//!
//! K. L. Johnson, Contact Mechanics (Cambridge, 1985), sections 4.1, 3.8, 5.2 and 13.2.

use std::f64::consts::TAU;

use crate::error::{Result, positive, require};

/// A smooth shape, placed with its centre on the centre of the domain or at an offset from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// h = r^2 / (2 radius): the paraboloid that approximates a sphere if the contact is small compared with the radius. An
    /// infinite radius is a flat.
    Sphere {
        /// Radius R \[m\].
        radius: f64,
    },
    /// h = x^2 / (2 radius_x) + y^2 / (2 radius_y). With an infinite radius the shape is straight along that axis: one infinite
    /// radius gives a cylinder, two give a flat.
    Ellipsoid {
        /// Principal radius along x \[m\].
        radius_x: f64,
        /// Principal radius along y \[m\].
        radius_y: f64,
    },
    /// h = x^2 / (2 radius): a cylinder along y. An infinite radius is a flat.
    Cylinder {
        /// Radius R \[m\].
        radius: f64,
    },
    /// h = slope |x|: a wedge along y.
    Wedge {
        /// Rise per length, the cotangent of the half angle.
        slope: f64,
    },
    /// h = slope r.
    Cone {
        /// Rise per length, the cotangent of the cone's half angle.
        slope: f64,
    },
    /// h = 0 if a cell's centre lies inside (its edge included), [`f64::INFINITY`] outside.
    FlatPunch(Punch),
    /// h = amplitude (1 - cos(2 pi x / lx) cos(2 pi y / ly)), a crest at the centre.
    ///
    /// An infinite wavelength is straight along that axis: `[l, INFINITY]` is the wave amplitude (1 - cos(2 pi x / l)) of
    /// Westergaard, two finite ones the double wave of Johnson, Greenwood and Higginson (two crests on each lx x ly). The height
    /// from trough to crest is twice the amplitude. A periodic domain should contain a whole number of waves.
    Wave {
        /// Amplitude A \[m\].
        amplitude: f64,
        /// Wavelengths \[lx, ly\] \[m\], not both infinite.
        wavelength: [f64; 2],
    },
}

/// Outline of a flat punch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Punch {
    /// r <= radius.
    Circle {
        /// Radius \[m\].
        radius: f64,
    },
    /// |x| <= size\[0\] / 2 and |y| <= size\[1\] / 2.
    Rectangle {
        /// Edges along x and y \[m\].
        size: [f64; 2],
    },
}

impl Shape {
    /// The name used in messages and case files.
    pub fn name(&self) -> &'static str {
        match self {
            Shape::Sphere { .. } => "sphere",
            Shape::Ellipsoid { .. } => "ellipsoid",
            Shape::Cylinder { .. } => "cylinder",
            Shape::Wedge { .. } => "wedge",
            Shape::Cone { .. } => "cone",
            Shape::FlatPunch(_) => "flat punch",
            Shape::Wave { .. } => "wave",
        }
    }

    /// Whether the pressure under it grows without end somewhere as the cells shrink: with the distance r as r^-1/2 at the edge of a flat
    /// punch, as ln(1/r) at the tip of a cone or a wedge (K. L. Johnson, Contact Mechanics, 1985, sections 2.8, 5.2).
    ///
    /// ```
    /// use asperity::surface::Shape;
    /// assert!(Shape::Cone { slope: 0.1 }.has_singular_pressure() && !Shape::Sphere { radius: 1.0 }.has_singular_pressure());
    /// ```
    pub fn has_singular_pressure(&self) -> bool {
        match self {
            Shape::Wedge { .. } | Shape::Cone { .. } | Shape::FlatPunch(_) => true,
            Shape::Sphere { .. } | Shape::Ellipsoid { .. } | Shape::Cylinder { .. } | Shape::Wave { .. } => {
                false
            }
        }
    }

    /// Gap h \[m\] at the offset (x, y) \[m\] from the shape's centre.
    ///
    /// ```
    /// use asperity::surface::Shape;
    /// let wave = Shape::Wave { amplitude: 1e-6, wavelength: [1e-3, f64::INFINITY] };
    /// assert_eq!(wave.gap(0.0, 0.3), 0.0);                     // crest
    /// assert!((wave.gap(0.5e-3, 0.0) - 2e-6).abs() < 1e-20);   // trough
    /// ```
    pub fn gap(&self, x: f64, y: f64) -> f64 {
        match self {
            Shape::Sphere { radius } => (x * x + y * y) / (2.0 * radius),
            Shape::Ellipsoid { radius_x, radius_y } => x * x / (2.0 * radius_x) + y * y / (2.0 * radius_y),
            Shape::Cylinder { radius } => x * x / (2.0 * radius),
            Shape::Wedge { slope } => slope * x.abs(),
            Shape::Cone { slope } => slope * (x * x + y * y).sqrt(),
            Shape::FlatPunch(punch) => {
                if punch.covers(x, y) {
                    0.0
                } else {
                    f64::INFINITY
                }
            }
            Shape::Wave { amplitude, wavelength: [lx, ly] } => {
                amplitude * (1.0 - libm::cos(TAU * x / lx) * libm::cos(TAU * y / ly))
            }
        }
    }

    /// [`slope`](Self::slope), of the tip of a cone and the edge of a wedge the mean over a cell of sides `cell` \[m\].
    pub(crate) fn slope_over(&self, x: f64, y: f64, cell: [f64; 2]) -> [f64; 2] {
        match self {
            Shape::Wedge { slope } => [slope * (2.0 * x / cell[0]).clamp(-1.0, 1.0), 0.0],
            Shape::Cone { .. } => {
                let share = ((x * x + y * y).sqrt() / (0.5 * cell[0].min(cell[1]))).min(1.0);
                self.slope(x, y).map(|s| s * share)
            }
            _ => self.slope(x, y),
        }
    }

    /// Slopes \[dh/dx, dh/dy\] at the offset (x, y) \[m\] from the shape's centre; 0 on the tip of a cone or the edge of a wedge,
    /// and under a punch.
    ///
    /// ```
    /// use asperity::surface::Shape;
    /// assert_eq!(Shape::Sphere { radius: 2.0 }.slope(0.1, -0.2), [0.05, -0.1]);
    /// ```
    pub fn slope(&self, x: f64, y: f64) -> [f64; 2] {
        let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
        match self {
            Shape::Sphere { radius } => [x / radius, y / radius],
            Shape::Ellipsoid { radius_x, radius_y } => [x / radius_x, y / radius_y],
            Shape::Cylinder { radius } => [x / radius, 0.0],
            Shape::Wedge { slope } => [slope * sign(x), 0.0],
            Shape::Cone { slope } => {
                let r = (x * x + y * y).sqrt();
                if r > 0.0 { [slope * x / r, slope * y / r] } else { [0.0; 2] }
            }
            Shape::FlatPunch(_) => [0.0; 2],
            Shape::Wave { amplitude, wavelength: [lx, ly] } => {
                let (sin_x, cos_x) = libm::sincos(TAU * x / lx);
                let (sin_y, cos_y) = libm::sincos(TAU * y / ly);
                [amplitude * TAU / lx * sin_x * cos_y, amplitude * TAU / ly * cos_x * sin_y]
            }
        }
    }

    /// Checks the shape's numbers.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if a radius or wavelength is not positive (infinity is accepted), the
    /// slope or a punch's size is not positive, or the amplitude is not finite.
    pub fn validate(&self) -> Result<()> {
        match self {
            Shape::Sphere { radius } => radius_or_flat("radius of the sphere", *radius),
            Shape::Ellipsoid { radius_x, radius_y } => {
                radius_or_flat("radius of the ellipsoid along x", *radius_x)?;
                radius_or_flat("radius of the ellipsoid along y", *radius_y)
            }
            Shape::Cylinder { radius } => radius_or_flat("radius of the cylinder", *radius),
            Shape::Wedge { slope } => positive("slope of the wedge", *slope, "").map(drop),
            Shape::Cone { slope } => positive("slope of the cone", *slope, "").map(drop),
            Shape::FlatPunch(Punch::Circle { radius }) => radius_or_flat("radius of the flat punch", *radius),
            Shape::FlatPunch(Punch::Rectangle { size }) => {
                radius_or_flat("size of the flat punch along x", size[0])?;
                radius_or_flat("size of the flat punch along y", size[1])
            }
            Shape::Wave { amplitude, wavelength } => {
                require(amplitude.is_finite(), "amplitude of the wave", amplitude, "finite, in m")?;
                radius_or_flat("wavelength along x", wavelength[0])?;
                radius_or_flat("wavelength along y", wavelength[1])?;
                require(
                    !wavelength.iter().all(|l| l.is_infinite()),
                    "wavelength of the wave",
                    "infinite along x and y",
                    "finite along one axis at least",
                )?;
                Ok(())
            }
        }
    }
}

impl Punch {
    /// Whether the offset (x, y) \[m\] from the centre of the punch lies under it. The edge does, to 1 part in 1e12, so that the
    /// result for cells whose centre is on the edge does not depend on rounding.
    pub fn covers(&self, x: f64, y: f64) -> bool {
        const EDGE: f64 = 1.0 + 1e-12;
        match self {
            Punch::Circle { radius } => (x * x + y * y).sqrt() <= radius * EDGE,
            Punch::Rectangle { size } => x.abs() <= 0.5 * size[0] * EDGE && y.abs() <= 0.5 * size[1] * EDGE,
        }
    }
}

/// A length > 0 that may be infinite: straight along that axis.
fn radius_or_flat(what: &str, value: f64) -> Result<()> {
    require(value > 0.0, what, value, "greater than 0 m (inf for a straight line)")
}

#[cfg(test)]
mod tests {
    use super::*;

    // Rounding of a few operations on numbers of order one.
    const ROUNDING: f64 = 1e-15;

    #[test]
    fn an_infinite_radius_is_flat() {
        assert_eq!(Shape::Sphere { radius: f64::INFINITY }.gap(3.0, 4.0), 0.0);
        let cylinder = Shape::Ellipsoid { radius_x: 2.0, radius_y: f64::INFINITY };
        assert_eq!(cylinder.gap(2.0, 7.0), 1.0);
    }

    #[test]
    fn an_ellipsoid_of_equal_radii_is_the_sphere() {
        let (sphere, ellipsoid) =
            (Shape::Sphere { radius: 3.0 }, Shape::Ellipsoid { radius_x: 3.0, radius_y: 3.0 });
        assert!((sphere.gap(0.3, -0.7) - ellipsoid.gap(0.3, -0.7)).abs() < ROUNDING);
    }

    #[test]
    fn the_cone_rises_by_its_slope() {
        assert!((Shape::Cone { slope: 0.1 }.gap(3.0, -4.0) - 0.5).abs() < ROUNDING);
    }

    #[test]
    fn the_edge_belongs_to_the_punch() {
        let circle = Shape::FlatPunch(Punch::Circle { radius: 0.3 });
        assert_eq!(circle.gap(0.1 + 0.2, 0.0), 0.0); // 0.30000000000000004
        assert_eq!(circle.gap(0.301, 0.0), f64::INFINITY);
        let rectangle = Shape::FlatPunch(Punch::Rectangle { size: [2.0, 1.0] });
        assert_eq!(rectangle.gap(-1.0, 0.5), 0.0);
        assert_eq!(rectangle.gap(0.0, 0.6), f64::INFINITY);
    }

    #[test]
    fn the_double_wave_has_two_crests_of_johnsons_curvature() {
        let (a, l) = (0.01, 1.0);
        let wave = Shape::Wave { amplitude: a, wavelength: [l, l] };
        assert!(wave.gap(0.5, 0.5).abs() < ROUNDING);
        // Near a crest h = r^2 / (2 R), R = l^2 / (4 pi^2 A); the next term is r^2/l^2 smaller.
        let (r, radius) = (1e-4, l * l / (TAU * TAU * a));
        assert!((wave.gap(r, 0.0) * 2.0 * radius / (r * r) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn absurd_numbers_are_named() {
        for (shape, word) in [
            (Shape::Sphere { radius: 0.0 }, "radius of the sphere"),
            (Shape::Sphere { radius: f64::NAN }, "radius of the sphere"),
            (Shape::Ellipsoid { radius_x: 1.0, radius_y: -1.0 }, "along y"),
            (Shape::Cone { slope: f64::INFINITY }, "slope"),
            (Shape::FlatPunch(Punch::Circle { radius: -1.0 }), "flat punch"),
            (Shape::Wave { amplitude: f64::NAN, wavelength: [1.0, 1.0] }, "amplitude"),
            (Shape::Wave { amplitude: 1.0, wavelength: [0.0, 1.0] }, "along x"),
            (Shape::Wave { amplitude: 1.0, wavelength: [f64::INFINITY; 2] }, "infinite"),
        ] {
            let message = shape.validate().unwrap_err().to_string();
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
