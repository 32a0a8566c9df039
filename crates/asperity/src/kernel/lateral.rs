//! What pressure and tangential tractions of a half-space do to each other (Johnson, Contact Mechanics, 1985, eqs. 3.75 and 3.76).
//!
//! A pressure draws the surface towards itself, and a tangential traction lowers the surface ahead of it and lifts it behind:
//!
//! ```text
//! u = -β c/π ∫ p r/r² dA      tangential displacement under a pressure,        u^ =  2 i β c q/|q|² p^
//! u =  β c/π ∫ q·r/r² dA      normal displacement under a traction,            u^ = -2 i β c q·q^/|q|²
//! ```
//!
//! with the contact compliance c = (1 - ν)/(2 G) and Dundurs' β = (1 - 2 ν)/(2 (1 - ν)) of a body on a rigid one; of two bodies c β is
//! the difference of both.

use super::boussinesq::OverRectangle;

/// -(1/π) times the integral of r/r² over a cell of sides `side`, at (x, y) from its centre \[m\].
pub(crate) fn lateral(x: f64, y: f64, side: [f64; 2]) -> [f64; 2] {
    let component = |x: f64, y: f64, side| {
        let share = |x: f64, y: f64| x / (x * x + y * y).sqrt();
        -OverRectangle { antiderivative, share }.at(x, y, side)
    };
    [component(x, y, side), component(y, x, [side[1], side[0]])]
}

/// The imaginary part of 2 i q/|q|² \[m\].
pub(crate) fn lateral_symbol(qx: f64, qy: f64) -> [f64; 2] {
    let square = qx * qx + qy * qy;
    if square == 0.0 { [0.0; 2] } else { [2.0 * qx / square, 2.0 * qy / square] }
}

/// y ln r + x atan(y/x): d²/dx dy of it is x/r².
fn antiderivative(x: f64, y: f64) -> f64 {
    let along = if y == 0.0 { 0.0 } else { y * libm::hypot(x, y).ln() };
    let across = if x == 0.0 { 0.0 } else { x * libm::atan(y / x) };
    along + across
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::gauss::tests::{BESIDE, over_cell};
    use std::f64::consts::{PI, TAU};

    #[test]
    fn coefficients_are_the_integral_over_the_cell() {
        for (x, y, side) in BESIDE {
            let exact = over_cell((x, y), side, |x, y| [x, y].map(|part| -part / PI / (x * x + y * y)));
            let found = lateral(x, y, side);
            for (f, e) in found.iter().zip(exact) {
                assert!((f - e).abs() < 1e-12 * exact[0].abs().max(exact[1].abs()), "{x} {y}: {f} {e}");
            }
        }
    }

    #[test]
    fn a_pressure_on_a_long_strip_moves_both_sides_towards_it_by_half_of_its_width() {
        // -(1/π) ∫ x/r² dy = -1 on the right, 1 on the left, over a width of 1; a strip of length L lacks 4 x/(π L).
        for (x, exact) in [(2.0, -1.0), (-7.0, 1.0), (0.0, 0.0), (0.25, -0.5)] {
            assert!((lateral(x, 0.0, [1.0, 4e4])[0] - exact).abs() < 1e-3, "{x}");
        }
        // The slope of that is -2 p: in waves, i q (2 i/q).
        assert!((TAU * lateral_symbol(TAU, 0.0)[0] - 2.0).abs() < 1e-15);
    }
}
