//! The displacement around a point load or line load on a stack, minus that of a half-space of the top layer's material.
//!
//! With a = lim q C(q) for short waves, b for long ones (0 on a rigid base), and d the thickness of the top layer,
//!
//! ```text
//! C(q) = a/q + (b - a) e^(-q d)/q + rest(q)
//! point   k(r) = (1/2 pi) int C(q) J0(q r) q dq = a/(2 pi r) + (b - a)/(2 pi sqrt(r^2 + d^2)) + k_rest(r)
//! line    k(x) = (1/pi) int C(q) cos(q x) dq = -(a/pi) ln|x| - (b - a)/(2 pi) ln(x^2 + d^2) + k_rest(x) + b times a constant
//! ```
//!
//! (plane strain for the line). The constant is infinite, so if the base is a half-space, the displacements due to a line load
//! are only known up to a constant; on a rigid base there is no such constant. The first term is that of the half-space, whose
//! integral over a cell is known. The rest of C is finite at q = 0 and decays as e^(-q d), so the other two terms are smooth:
//! they vary over distances of at least d. k_rest follows from a series ([`super::series`]), and near the load from a polynomial
//! in the moments of rest.

use std::f64::consts::{PI, TAU};

use rayon::prelude::*;

use super::Stack;
use super::series::Series;
use crate::error::{Error, Result};

/// Initial and finest spacing of ln q.
const SPACING: f64 = 0.06;
const FINEST: f64 = 0.01;
/// Distance over d up to which the polynomial is used, and its number of terms.
const NEAR: f64 = 0.125;
const TERMS: usize = 9;
/// Spacing of ln r in the table: interpolation by six points is exact to 1e-12.
const STEP: f64 = 0.01;

/// Position of a unit load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Load {
    /// At a point.
    Point,
    /// Along a line.
    Line,
}

/// k(r) of one stack, times `scale`, minus that of the half-space of its top layer.
pub(super) struct Smooth {
    load: Load,
    /// Thickness of the top layer \[m\].
    pub(super) thickness: f64,
    /// (b - a)/(2 pi).
    image: f64,
    /// Coefficients of k_rest in (r/d)^2.
    near: [f64; TERMS],
    /// r k_rest(r) of a point, k_rest(x) of a line, at ln(r / (NEAR d)) = (n - 2) STEP.
    far: Vec<f64>,
}

impl Smooth {
    /// For distances up to `reach` \[m\]; `None` for a stack without layers, whose k(r) is that of the half-space.
    ///
    /// # Errors
    /// [`Error::Invalid`] if the layers of the stack differ too much for the series.
    pub(super) fn new(stack: &Stack, load: Load, scale: f64, reach: f64) -> Result<Option<Self>> {
        let Some(top) = stack.layers().first() else { return Ok(None) };
        let d = top.thickness;
        let series = resolved(stack, scale)?;
        let near = moments(&series, load, d);
        let nodes = (libm::log((reach / (NEAR * d)).max(1.0)) / STEP) as usize + 6;
        let ln_r = |n: usize| libm::log(NEAR * d) + (n as f64 - 2.0) * STEP;
        let far = match load {
            Load::Point => {
                let terms = series.of_point();
                (0..nodes).into_par_iter().map(|n| terms.at(ln_r(n)) / TAU).collect()
            }
            Load::Line => {
                let terms = series.of_line();
                // The series gives k_rest up to a constant, which follows from the polynomial.
                let constant = polynomial(&near, NEAR) - terms.at(ln_r(2)) / PI;
                (0..nodes).into_par_iter().map(|n| terms.at(ln_r(n)) / PI + constant).collect()
            }
        };
        let image = scale * (stack.long_waves() - stack.short_waves()) / TAU;
        Ok(Some(Smooth { load, thickness: d, image, near, far }))
    }

    /// Its value at the distance r, up to the reach. For a line, it has ln(r/d) in place of ln r.
    pub(super) fn value(&self, r: f64) -> f64 {
        let ratio = r / self.thickness;
        let image = match self.load {
            Load::Point => self.image / (self.thickness * (1.0 + ratio * ratio).sqrt()),
            Load::Line => -self.image * libm::log1p(ratio * ratio),
        };
        if ratio < NEAR {
            return image + polynomial(&self.near, ratio);
        }
        let place = libm::log(ratio / NEAR) / STEP;
        let n = (place as usize).min(self.far.len() - 6);
        let rest = six_points(&self.far[n..n + 6], place - n as f64);
        match self.load {
            Load::Point => image + rest / r,
            Load::Line => image + rest,
        }
    }
}

/// The series of a stack, as fine as necessary.
fn resolved(stack: &Stack, scale: f64) -> Result<Series> {
    let mut spacing = SPACING;
    loop {
        let series = Series::new(stack, scale, spacing);
        if series.is_resolved() {
            return Ok(series);
        }
        spacing *= 0.5;
        if spacing < FINEST {
            return Err(Error::invalid(
                "response of the layers over the wave number",
                "too steep",
                "smooth: the layers differ too much in thickness or stiffness for a free domain; take a periodic one",
            ));
        }
    }
}

/// Coefficients of k_rest in (r/d)^2, from the moments of rest: J0(q r) = sum of (-1)^j (q r/2)^(2j) / j!^2 of a point, cos(q x) = sum
/// of (-1)^j (q x)^(2j) / (2j)! of a line.
fn moments(series: &Series, load: Load, d: f64) -> [f64; TERMS] {
    let mut near = [0.0; TERMS];
    for (q, value) in series.nodes() {
        let mut power = match load {
            Load::Point => value * q * series.spacing / TAU,
            Load::Line => value * series.spacing / PI,
        };
        for (j, sum) in near.iter_mut().enumerate() {
            *sum += power;
            let over = match load {
                Load::Point => 4 * (j + 1) * (j + 1),
                Load::Line => (2 * j + 1) * (2 * j + 2),
            };
            power *= -(q * d) * (q * d) / over as f64;
        }
    }
    near
}

/// The sum of c_j ratio^(2j).
fn polynomial(coefficients: &[f64], ratio: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * ratio * ratio + c)
}

/// Interpolation at t in \[0, 1\] of values at -2, -1, 0, 1, 2, 3.
fn six_points(values: &[f64], t: f64) -> f64 {
    let [a, b, c, d, e, f] = [t + 2.0, t + 1.0, t, t - 1.0, t - 2.0, t - 3.0];
    let (ab, ef) = (a * b, e * f);
    let (left, right) = (ab * c, d * ef);
    (-b * c * right * values[0] + left * d * e * values[5]) / 120.0
        + (a * c * right * values[1] - left * d * f * values[4]) / 24.0
        + (-ab * right * values[2] + left * ef * values[3]) / 12.0
}

#[cfg(test)]
mod tests {
    use super::super::samples::{half_space, layer, stack};
    use super::super::{Base, Interface, Layer};
    use super::*;
    use crate::kernel::gauss::GAUSS_4;

    /// (1/2 pi) int (q C - a) J0(q r) dq of a point; of a line (1/pi) int rest(q) cos(q x) dq and the logarithm of the image. By panels
    /// that resolve the layers and the oscillation.
    fn by_quadrature(stack: &Stack, load: Load, r: f64) -> f64 {
        let d = stack.layers()[0].thickness;
        let (a, b) = (stack.short_waves(), stack.long_waves());
        let finest = stack.layers().iter().map(|l| l.thickness).fold(0.0, f64::max);
        let panel = (0.02 / (finest * stack.contrast().powf(0.7))).min(0.3 / r);
        let count = (45.0 / (d * panel)).ceil() as usize;
        let value = |q: f64| match load {
            Load::Point => 0.5 * (q * stack.compliance(q) - a) * libm::j0(q * r),
            Load::Line => ((q * stack.compliance(q) - b) + (a - b) * libm::expm1(-q * d)) / q * (q * r).cos(),
        };
        let of_panel = |n: usize| -> f64 {
            let at = |s: f64| panel * (n as f64 + 0.5 + 0.5 * s);
            GAUSS_4.iter().map(|(s, weight)| 0.5 * panel * weight * value(at(*s))).sum()
        };
        let image = match load {
            Load::Point => 0.0,
            Load::Line => (a - b) / TAU * (r * r / (d * d)).ln_1p(),
        };
        (0..count).map(of_panel).sum::<f64>() / PI + image
    }

    #[test]
    fn the_series_equals_the_integral_at_every_distance() {
        let rigid = Base::Rigid;
        let slip = Layer { interface: Interface::Slip, ..layer(0.5, 3.0, 0.2) };
        for stack in [
            stack(&[layer(1.0, 1.0, 0.3)], rigid),
            stack(&[layer(1.0, 1.0, 0.5)], rigid),
            stack(&[layer(1.0, 4.0, 0.25)], half_space(1.0)),
            stack(&[layer(1.0, 1.0, 0.5)], half_space(30.0)),
            stack(&[layer(1.0, 1e3, 0.2)], half_space(1.0)),
            stack(&[slip, layer(1.0, 1.0, 0.5), layer(0.7, 2.0, 0.3)], rigid),
            stack(&[layer(0.1, 2.0, 0.4), layer(3.0, 1.0, 0.49)], half_space(5.0)),
        ] {
            let d = stack.layers()[0].thickness;
            for load in [Load::Point, Load::Line] {
                let smooth = Smooth::new(&stack, load, 1.0, 200.0).unwrap().unwrap();
                for r in [0.0, 0.05 * d, 0.1249 * d, 0.1251 * d, 0.3, 1.0, 3.7, 20.0, 150.0] {
                    let (value, exact) = (smooth.value(r), by_quadrature(&stack, load, r));
                    // Against the half-space of the softest material: roundings of q C(q), those of a line up to 10 times, and of the
                    // sum over 1e4 panels.
                    let unit = stack.short_waves().max(stack.long_waves());
                    let limit = match load {
                        Load::Point => 3e-12 * unit / (TAU * r.max(d)),
                        Load::Line => 1e-11 * unit / PI,
                    };
                    assert!((value - exact).abs() < limit, "{load:?} {stack:?} at {r}: {value} {exact}");
                }
            }
        }
    }

    #[test]
    fn a_layer_of_the_material_of_its_base_adds_nothing() {
        for (load, rounding) in [(Load::Point, 1e-13), (Load::Line, 1e-12)] {
            let same = stack(&[layer(1.0, 1.0, 0.3)], half_space(1.0));
            let smooth = Smooth::new(&same, load, 1.0, 100.0).unwrap().unwrap();
            for r in [0.0, 0.1, 1.0, 10.0, 90.0] {
                // Roundings of q C(q), at all the waves of the series; those of a line count up to 10 times.
                assert!(smooth.value(r).abs() < rounding, "{load:?} {r}: {}", smooth.value(r));
            }
        }
    }
}
