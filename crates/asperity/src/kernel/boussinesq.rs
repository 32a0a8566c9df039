//! Love's influence coefficient: the displacement due to a uniformly loaded rectangle on an elastic half-space (Love 1929;
//! Johnson, Contact Mechanics, 1985, eq. 3.25).
//!
//! u(x, y) = (1/pi) integral over the rectangle of p / sqrt((x-x')^2 + (y-y')^2) for E* = 1.
//!
//! The closed form is a second difference of f(x, y) = x asinh(y/|x|) + y asinh(x/|y|). Far away the difference loses digits as
//! eps (distance/side)^2. From [`FAR`] sides on, the integral is therefore computed by a Gauss rule, whose error falls as
//! (side/distance)^(2 points).

use std::f64::consts::PI;

use super::gauss::{GAUSS_3, GAUSS_4, GAUSS_6};

/// Distance, in units of the longest side of the cell, from which the Gauss rule is more accurate.
const FAR: f64 = 6.0;

/// Influence coefficient K(x, y) \[m\]: the displacement at (x, y) from the centre of a cell of sides
/// `side` = \[dx, dy\] under unit pressure, for unit contact modulus.
///
/// Relative error below 1e-13 at any distance (compared with 60-digit arithmetic in the tests).
///
/// Source: SC17 eq. 8; Johnson 1985 eq. 3.25.
///
/// ```
/// // At the centre of a square cell of side s: 4 s ln(1 + sqrt 2) / pi.
/// let k = asperity::kernel::love(0.0, 0.0, [1.0, 1.0]);
/// assert!((k - 4.0 * (1.0 + 2f64.sqrt()).ln() / std::f64::consts::PI).abs() < 1e-15);
/// ```
pub fn love(x: f64, y: f64, side: [f64; 2]) -> f64 {
    OverRectangle { antiderivative: f, share: |_, _| 1.0 }.at(x.abs(), y.abs(), side)
}

/// (1/pi) times the integral over a rectangle of a function that falls off as 1/r.
pub(crate) struct OverRectangle {
    /// F with d²F/dx dy = the function, for short distances.
    pub(crate) antiderivative: fn(f64, f64) -> f64,
    /// The function times r, for long ones.
    pub(crate) share: fn(f64, f64) -> f64,
}

impl OverRectangle {
    /// At (x, y) from the centre of a rectangle of these sides.
    pub(crate) fn at(&self, x: f64, y: f64, side: [f64; 2]) -> f64 {
        let [dx, dy] = side;
        if libm::hypot(x, y) >= FAR * dx.max(dy) {
            return self.nearly_square(x, y, 0.5 * dx, 0.5 * dy);
        }
        // At short distances a long cell is divided into nearly square ones, so that both forms keep their digits.
        let parts = [(dx / dy).round().max(1.0), (dy / dx).round().max(1.0)];
        let [a, b] = [0.5 * dx / parts[0], 0.5 * dy / parts[1]];
        let mut k = 0.0;
        for m in 0..parts[0] as usize {
            for n in 0..parts[1] as usize {
                let px = x - (2.0 * m as f64 + 1.0 - parts[0]) * a;
                let py = y - (2.0 * n as f64 + 1.0 - parts[1]) * b;
                k += self.nearly_square(px, py, a, b);
            }
        }
        k
    }

    fn nearly_square(&self, x: f64, y: f64, a: f64, b: f64) -> f64 {
        let longest = 2.0 * a.max(b);
        let distance = (x * x + y * y).sqrt() / longest;
        let integral = if distance < FAR {
            self.closed_form(x, y, a, b)
        } else if distance < 60.0 {
            self.gauss(x, y, a, b, &GAUSS_6)
        } else if distance < 600.0 {
            self.gauss(x, y, a, b, &GAUSS_4)
        } else {
            self.gauss(x, y, a, b, &GAUSS_3)
        };
        integral / PI
    }

    /// F(x+a,y+b) - F(x-a,y+b) - F(x+a,y-b) + F(x-a,y-b).
    fn closed_form(&self, x: f64, y: f64, a: f64, b: f64) -> f64 {
        let f = self.antiderivative;
        f(x + a, y + b) - f(x - a, y + b) - f(x + a, y - b) + f(x - a, y - b)
    }

    /// Over the rectangle of half-sides a, b by a product Gauss-Legendre rule.
    fn gauss<const N: usize>(&self, x: f64, y: f64, a: f64, b: f64, rule: &[(f64, f64); N]) -> f64 {
        let mut sum = 0.0;
        for (s, ws) in rule {
            let dx = x - a * s;
            for (t, wt) in rule {
                let dy = y - b * t;
                sum += ws * wt * (self.share)(dx, dy) / (dx * dx + dy * dy).sqrt();
            }
        }
        a * b * sum
    }
}

fn f(x: f64, y: f64) -> f64 {
    sheared(x, y) + sheared(y, x)
}

/// u asinh(v/|u|): an antiderivative of 1/r is this and the same with u and v exchanged.
pub(crate) fn sheared(u: f64, v: f64) -> f64 {
    if u == 0.0 { 0.0 } else { u * libm::asinh(v / u.abs()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (x, y, side, K) with K from 60-digit arithmetic.
    const EXACT: [(f64, f64, [f64; 2], f64); 22] = [
        (0.0, 0.0, [1.0, 1.0], 1.1221997046783603),
        (1.0, 0.0, [1.0, 1.0], 0.33042149328895688),
        (5.0, 3.0, [1.0, 1.0], 0.054_657_094_883_300_48),
        (5.75, 0.0, [1.0, 1.0], 0.055_427_820_460_765_53),
        (6.0, 0.0, [1.0, 1.0], 0.053_112_900_362_948_49),
        (6.0, 6.0, [1.0, 1.0], 0.037_534_994_639_939_48),
        (59.0, 7.0, [1.0, 1.0], 0.005_357_570_575_399_603),
        (61.0, 1.0, [1.0, 1.0], 0.005_217_552_221_885_887),
        (599.0, 10.0, [1.0, 1.0], 0.000_531_328_171_888_802_5),
        (601.0, 3.0, [1.0, 1.0], 0.000_529_627_216_858_054_9),
        (4095.0, 4095.0, [1.0, 1.0], 5.496_436_613_404_347e-5),
        (100000.0, 1.0, [1.0, 1.0], 3.1830988616920147e-6),
        (0.0, 0.0, [1.0, 0.25], 0.490_925_898_672_049_4),
        (0.0, 1.5, [1.0, 0.25], 0.052_226_386_440_593_66),
        (3.0, 0.25, [1.0, 0.25], 0.026670873877761528),
        (0.0, 4.0, [1.0, 0.25], 0.019849300806245775),
        (0.0, 2.0, [8.0, 1.0], 0.926_292_904_487_272_6),
        (16.0, 3.0, [8.0, 1.0], 0.15949118140364876),
        (0.0, 700.0, [8.0, 1.0], 0.0036378080919214561),
        (0.0, 1.0, [0.03125, 1.0], 0.010927379134270486),
        (0.3125, 0.0, [0.03125, 1.0], 0.024856743981306126),
        (1.40625, 2.0, [1.40625, 1.0], 0.1844398957273871),
    ];

    #[test]
    fn coefficients_hold_thirteen_digits_at_any_distance_and_aspect() {
        for (x, y, side, exact) in EXACT {
            for (x, y) in [(x, y), (-x, y), (x, -y)] {
                let error = (love(x, y, side) / exact - 1.0).abs();
                assert!(error < 1e-13, "K({x}, {y}, {side:?}) is off by {error:e}");
            }
        }
    }

    #[test]
    fn coefficients_scale_with_length() {
        // Lengths times 2^-20 give K times 2^-20 exactly.
        let s = 2f64.powi(-20);
        for (x, y, side, _) in EXACT {
            assert_eq!(love(x * s, y * s, [side[0] * s, side[1] * s]), s * love(x, y, side));
        }
    }
}
