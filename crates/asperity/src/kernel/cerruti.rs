//! The half-space under tangential tractions: the displacements in the plane of the surface (Cerruti 1882; Johnson, Contact
//! Mechanics, 1985, eq. 3.76).
//!
//! ```text
//! u_x = c/π ∫ { [y² + x²/(1-ν)] q_x + ν/(1-ν) x y q_y } / r³ dA,     u_y the same with x and y exchanged
//! ```
//!
//! Here c is the contact compliance of the normal direction, so that both directions creep by the same C(t): for ν = 0 a tangential
//! traction displaces the surface as a pressure does ([`love`](super::love)). In waves, with the longitudinal part along q,
//!
//! ```text
//! u^ = c (2/|q|) [ 1/(1-ν) - ν/(1-ν) q q'/|q|² ] q^.
//! ```
//!
//! Of two bodies with the shear moduli G and Poisson's ratios ν, c (1/(1-ν)) and c ν/(1-ν) add up: the pair answers as one body
//! with the mean of both ν, weighted by 1/G.

use super::boussinesq::{OverRectangle, sheared};

/// Displacements u_x due to q_x, u_x due to q_y (and u_y due to q_x), and u_y due to q_y.
pub(crate) type Tangential = [f64; 3];

/// The tangential half-space of Poisson's ratio ν, for unit contact compliance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cerruti {
    pub(crate) poisson: f64,
}

impl Cerruti {
    /// 1/(1-ν).
    pub(crate) fn transverse(self) -> f64 {
        1.0 / (1.0 - self.poisson)
    }

    /// At (x, y) from the centre of a cell of sides `side` under unit traction \[m\].
    pub(crate) fn influence(self, x: f64, y: f64, side: [f64; 2]) -> Tangential {
        let square = |x: f64, y: f64| x * x / (x * x + y * y);
        let across = OverRectangle { antiderivative: sheared, share: |x, y| y * y / (x * x + y * y) };
        let along = OverRectangle { antiderivative: |x, y| sheared(y, x), share: square };
        let both = OverRectangle {
            antiderivative: |x, y| -libm::hypot(x, y),
            share: |x, y| x * y / (x * x + y * y),
        };
        let [across, along, both] = [across, along, both].map(|integral| integral.at(x, y, side));
        let w = self.transverse();
        [across + w * along, (w - 1.0) * both, w * across + along]
    }

    /// Under waves of unit traction \[m\]; 0 for the mean, which a half-space does not determine.
    pub(crate) fn symbol(self, qx: f64, qy: f64) -> Tangential {
        let square = qx * qx + qy * qy;
        if square == 0.0 {
            return [0.0; 3];
        }
        let (length, w) = (2.0 / square.sqrt(), self.transverse());
        let less = (w - 1.0) / square;
        [length * (w - less * qx * qx), -length * less * qx * qy, length * (w - less * qy * qy)]
    }

    /// The inverse of the symbol \[1/m\].
    pub(crate) fn inverse(self, qx: f64, qy: f64) -> Tangential {
        let square = qx * qx + qy * qy;
        if square == 0.0 {
            return [0.0; 3];
        }
        let (half, nu) = (0.5 * square.sqrt(), self.poisson);
        let more = nu / square;
        [half * (1.0 - nu + more * qx * qx), half * more * qx * qy, half * (1.0 - nu + more * qy * qy)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::gauss::tests::{BESIDE, over_cell};
    use crate::kernel::love;

    #[test]
    fn coefficients_are_the_integral_over_the_cell() {
        for nu in [0.0, 0.3, 0.5] {
            let w = 1.0 / (1.0 - nu);
            for (x, y, side) in BESIDE {
                let exact = over_cell((x, y), side, |x, y| {
                    let weight = 1.0 / std::f64::consts::PI / libm::hypot(x, y).powi(3);
                    [y * y + w * x * x, (w - 1.0) * x * y, w * y * y + x * x].map(|part| weight * part)
                });
                let found = Cerruti { poisson: nu }.influence(x, y, side);
                for (f, e) in found.iter().zip(exact) {
                    assert!((f - e).abs() < 1e-12 * exact[0].max(exact[2]), "{nu} {x} {y}: {f} {e}");
                }
            }
        }
    }

    #[test]
    fn without_lateral_contraction_a_traction_acts_as_a_pressure() {
        let body = Cerruti { poisson: 0.0 };
        for (x, y) in [(0.0, 0.0), (1.0, 2.0), (9.0, -4.0)] {
            let [xx, xy, yy] = body.influence(x, y, [1.0, 1.0]);
            let k = love(x, y, [1.0, 1.0]);
            // Two roundings of the parts.
            assert!((xx / k - 1.0).abs() < 1e-14 && (yy / k - 1.0).abs() < 1e-14 && xy == 0.0);
        }
    }

    #[test]
    fn the_inverse_undoes_the_symbol() {
        for nu in [0.0, 0.3, 0.5] {
            let body = Cerruti { poisson: nu };
            let ([a, b, d], [e, f, g]) = (body.symbol(3.0, -1.5), body.inverse(3.0, -1.5));
            for (found, exact) in [(a * e + b * f, 1.0), (a * f + b * g, 0.0), (b * f + d * g, 1.0)] {
                // Roundings of sums of three terms of size 1.
                assert!((found - exact).abs() < 1e-14, "{nu}: {found}");
            }
        }
    }
}
