//! The displacement around a point load on a stack, less that of a half-space of the top layer.
//!
//! With a = lim q C(q) for short waves, b for long ones (0 on a rigid base), and d the thickness of the top layer,
//!
//! ```text
//! C(q) = a/q + (b - a) e^(-q d)/q + rest(q)
//! k(r) = (1/2 pi) int C(q) J0(q r) q dq = a/(2 pi r) + (b - a)/(2 pi sqrt(r^2 + d^2)) + k_rest(r).
//! ```
//!
//! The first term is that of the half-space, whose integral over a cell is known. The rest of C is finite at q = 0 and decays
//! as e^(-q d), so the other two are smooth: they vary over distances of d and more. q rest(q) vanishes at both ends, and in
//! ln q it is analytic on a strip around the real axis. So it is a short Fourier series in ln q, whose terms have known
//! integrals (A. J. S. Hamilton, Mon. Not. R. Astron. Soc. 312 (2000) 257):
//!
//! ```text
//! q rest(q) = sum of c_m q^(i w_m)   =>   r k_rest(r) = (1/2 pi) sum of c_m r^(-i w_m) int t^(i w_m) J0(t) dt
//! int t^(iw) J0(t) dt = 2^(iw) G((1 + iw)/2) / G((1 - iw)/2), of modulus 1 (G: the gamma function).
//! ```
//!
//! The map keeps errors as they are: q C(q) to rounding gives r k(r) to rounding, at every distance. Near r = 0 k_rest is a
//! polynomial in r^2, from the moments of rest.

use std::f64::consts::TAU;

use rayon::prelude::*;

use super::Stack;
use super::compliance::is_short;
use crate::error::{Error, Result};

/// Spacing of ln q at first, and the finest.
const SPACING: f64 = 0.06;
const FINEST: f64 = 0.01;
/// Share of a + b that the last coefficients of the series may have.
const CUT: f64 = 1e-11;
/// q d up to which rest(q) counts, and the share of the long waves below which it does not.
const SHORTEST: f64 = 100.0;
const LONGEST: f64 = 1e-17;
/// Distance over d up to which the polynomial holds, and its terms.
const NEAR: f64 = 0.125;
const TERMS: usize = 9;
/// Spacing of ln r in the table: interpolation by six points is exact to 1e-12.
const STEP: f64 = 0.01;

/// k(r) - a/(2 pi r) of one stack, times `scale`.
pub(super) struct Smooth {
    /// Thickness of the top layer \[m\].
    pub(super) thickness: f64,
    /// (b - a)/(2 pi).
    image: f64,
    /// Coefficients of k_rest in (r/d)^2.
    near: [f64; TERMS],
    /// r k_rest(r) at ln(r / (NEAR d)) = (n - 2) STEP.
    far: Vec<f64>,
}

impl Smooth {
    /// For distances up to `reach` \[m\]; `None` for a stack without layers, which has nothing else.
    ///
    /// # Errors
    /// [`Error::Invalid`] where the stack's layers differ too much for the series.
    pub(super) fn new(stack: &Stack, scale: f64, reach: f64) -> Result<Option<Self>> {
        let Some(top) = stack.layers().first() else { return Ok(None) };
        let d = top.thickness;
        let mut spacing = SPACING;
        let series = loop {
            let series = Series::new(stack, scale, spacing);
            if series.is_resolved() {
                break series;
            }
            spacing *= 0.5;
            if spacing < FINEST {
                return Err(Error::invalid(
                    "response of the layers over the wave number",
                    "too steep",
                    "smooth: the layers differ too much in thickness or stiffness for a free domain; take a periodic one",
                ));
            }
        };
        let nodes = (libm::log((reach / (NEAR * d)).max(1.0)) / STEP) as usize + 6;
        let far = (0..nodes).into_par_iter();
        Ok(Some(Smooth {
            thickness: d,
            image: scale * (stack.long_waves() - stack.short_waves()) / TAU,
            near: series.moments(d),
            far: far.map(|n| series.at(libm::log(NEAR * d) + (n as f64 - 2.0) * STEP)).collect(),
        }))
    }

    /// Its value at the distance r, up to the reach.
    pub(super) fn value(&self, r: f64) -> f64 {
        let ratio = r / self.thickness;
        let image = self.image / (self.thickness * (1.0 + ratio * ratio).sqrt());
        if ratio < NEAR {
            return image + self.near.iter().rev().fold(0.0, |sum, c| sum * ratio * ratio + c);
        }
        let place = libm::log(ratio / NEAR) / STEP;
        let n = (place as usize).min(self.far.len() - 6);
        image + six_points(&self.far[n..n + 6], place - n as f64) / r
    }
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

/// q rest(q) as a Fourier series in ln q.
struct Series {
    /// ln q of the first node, and their spacing.
    first: f64,
    spacing: f64,
    /// q rest(q) at the nodes.
    values: Vec<f64>,
    /// c_m times the integral of its term, (real, imaginary), m >= 0.
    terms: Vec<[f64; 2]>,
    /// The largest of the last |c_m| over a + b.
    left: f64,
}

impl Series {
    fn new(stack: &Stack, scale: f64, spacing: f64) -> Self {
        let d = stack.layers()[0].thickness;
        let (total, contrast) = (total(stack), stack.contrast());
        let first = libm::log(LONGEST / (total * contrast));
        let count = ((libm::log(SHORTEST / d) - first) / spacing) as usize | 1;
        let (a, b) = (stack.short_waves(), stack.long_waves());
        let nodes: Vec<f64> = (0..count).map(|n| libm::exp(first + n as f64 * spacing)).collect();
        let rest = |q: &f64| {
            let decayed = libm::expm1(-q * d);
            // q C - b - (a - b)(1 - e^(-q d))
            scale
                * match is_short(q * d) {
                    true => (a - b) * libm::exp(-q * d),
                    false => (q * stack.compliance(*q) - b) + (a - b) * decayed,
                }
        };
        let values: Vec<f64> = nodes.par_iter().map(rest).collect();
        // Angles are whole parts of a turn, so that one table serves all.
        let turn: Vec<[f64; 2]> = (0..count)
            .map(|n| TAU * n as f64 / count as f64)
            .map(|angle| [libm::cos(angle), libm::sin(angle)])
            .collect();
        let coefficient = |m: usize| {
            let sum = values.iter().enumerate().fold([0.0; 2], |[re, im], (n, v)| {
                let [cos, sin] = turn[n * m % count];
                [re + v * cos, im - v * sin]
            });
            sum.map(|s| s / count as f64)
        };
        let coefficients: Vec<[f64; 2]> = (0..=count / 2).into_par_iter().map(coefficient).collect();
        let size =
            |list: &[[f64; 2]]| list.iter().fold(0.0, |most: f64, c| most.max(libm::hypot(c[0], c[1])));
        let left = size(&coefficients[coefficients.len() * 9 / 10..]) / (scale * (a + b));
        let turned = |(m, [re, im]): (usize, [f64; 2])| {
            let phase = bessel_phase(frequency(m, spacing, count));
            let (cos, sin) = (libm::cos(phase), libm::sin(phase));
            [re * cos - im * sin, re * sin + im * cos]
        };
        let terms = coefficients.into_iter().enumerate().map(turned).collect();
        Series { first, spacing, values, terms, left }
    }

    fn is_resolved(&self) -> bool {
        self.left < CUT
    }

    /// r k_rest(r) at ln r.
    fn at(&self, ln_r: f64) -> f64 {
        let count = self.values.len();
        let sum: f64 = self.terms.iter().enumerate().fold(0.0, |sum, (m, [re, im])| {
            let angle = frequency(m, self.spacing, count) * (ln_r + self.first);
            let both = if m == 0 { 1.0 } else { 2.0 };
            sum + both * (re * libm::cos(angle) + im * libm::sin(angle))
        });
        sum / TAU
    }

    /// Coefficients of k_rest in (r/d)^2: J0(q r) = sum of (-1)^j (q r/2)^(2j) / j!^2.
    fn moments(&self, d: f64) -> [f64; TERMS] {
        let mut near = [0.0; TERMS];
        for (n, value) in self.values.iter().enumerate() {
            let q = libm::exp(self.first + n as f64 * self.spacing);
            let mut power = value * q * self.spacing / TAU;
            for (j, sum) in near.iter_mut().enumerate() {
                *sum += power;
                power *= -(0.5 * q * d) * (0.5 * q * d) / ((j + 1) * (j + 1)) as f64;
            }
        }
        near
    }
}

/// w_m.
fn frequency(m: usize, spacing: f64, count: usize) -> f64 {
    TAU * m as f64 / (spacing * count as f64)
}

/// Thickness of all layers \[m\].
fn total(stack: &Stack) -> f64 {
    stack.layers().iter().map(|layer| layer.thickness).sum()
}

/// The argument of int t^(iw) J0(t) dt: w ln 2 + 2 Im ln G(1/2 + iw/2).
fn bessel_phase(w: f64) -> f64 {
    w * std::f64::consts::LN_2 + 2.0 * gamma_phase(0.5 * w)
}

/// Im ln G(1/2 + iy): by Stirling's series from 10.5 + iy, whose next term is below 1e-16.
fn gamma_phase(y: f64) -> f64 {
    const UP: usize = 10;
    let x = 0.5 + UP as f64;
    let square = x * x + y * y;
    let argument = libm::atan2(y, x);
    // 1/z = (x - iy)/|z|^2, and its odd powers.
    let [re, im] = [x / square, -y / square];
    let [re2, im2] = [re * re - im * im, 2.0 * re * im];
    let coefficients = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
    ];
    let (mut power, mut series) = ([re, im], 0.0);
    for c in coefficients {
        series += c * power[1];
        power = [power[0] * re2 - power[1] * im2, power[0] * im2 + power[1] * re2];
    }
    // Im [(z - 1/2) ln z - z] + series - sum of arg(1/2 + k + iy)
    let stirling = y * 0.5 * libm::log(square) + (x - 0.5) * argument - y + series;
    (0..UP).fold(stirling, |phase, k| phase - libm::atan2(y, 0.5 + k as f64))
}

#[cfg(test)]
mod tests {
    use super::super::{Base, Interface, Layer};
    use super::*;
    use crate::layer::kernel::GAUSS_4;

    fn layer(thickness: f64, shear: f64, poisson: f64) -> Layer {
        Layer { thickness, shear, poisson, interface: Interface::Bonded }
    }

    fn stack(layers: &[Layer], base: Base) -> Stack {
        Stack::new(layers.to_vec(), base).unwrap()
    }

    fn half_space(shear: f64) -> Base {
        Base::HalfSpace { shear, poisson: 0.3 }
    }

    /// (1/2 pi) int (q C - a) J0(q r) dq by panels that resolve the layers and the Bessel function.
    fn by_quadrature(stack: &Stack, r: f64) -> f64 {
        let d = stack.layers()[0].thickness;
        let finest = stack.layers().iter().map(|l| l.thickness).fold(0.0, f64::max);
        let panel = (0.02 / (finest * stack.contrast().powf(0.7))).min(0.3 / r);
        let count = (45.0 / (d * panel)).ceil() as usize;
        let value = |q: f64| (q * stack.compliance(q) - stack.short_waves()) * libm::j0(q * r);
        let of_panel = |n: usize| -> f64 {
            let at = |s: f64| panel * (n as f64 + 0.5 + 0.5 * s);
            GAUSS_4.iter().map(|(s, weight)| 0.5 * panel * weight * value(at(*s))).sum()
        };
        (0..count).map(of_panel).sum::<f64>() / TAU
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
            let smooth = Smooth::new(&stack, 1.0, 200.0).unwrap().unwrap();
            for r in [0.0, 0.05 * d, 0.1249 * d, 0.1251 * d, 0.3, 1.0, 3.7, 20.0, 150.0] {
                let (value, exact) = (smooth.value(r), by_quadrature(&stack, r));
                // Against the half-space of the softest material: roundings of q C(q), and of the sum over 1e4 panels.
                let unit = stack.short_waves().max(stack.long_waves()) / (TAU * r.max(d));
                assert!((value - exact).abs() < 3e-12 * unit, "{stack:?} at {r}: {value} {exact}");
            }
        }
    }

    #[test]
    fn a_layer_of_the_material_of_its_base_adds_nothing() {
        let smooth =
            Smooth::new(&stack(&[layer(1.0, 1.0, 0.3)], half_space(1.0)), 1.0, 100.0).unwrap().unwrap();
        for r in [0.0, 0.1, 1.0, 10.0, 90.0] {
            // Roundings of q C(q), at all the waves of the series.
            assert!(smooth.value(r).abs() < 1e-13, "{r}: {}", smooth.value(r));
        }
    }

    #[test]
    fn layers_that_differ_by_many_decades_are_resolved() {
        // The series must not depend on its spacing: half of it gives the same numbers.
        for stack in [
            stack(&[layer(1e-3, 1e8, 0.2)], half_space(1.0)),
            stack(&[layer(1e-3, 1.0, 0.5)], half_space(1e8)),
            stack(&[layer(1e-6, 1e4, 0.3), layer(1.0, 1.0, 0.5)], Base::Rigid),
            stack(&[layer(1.0, 1e4, 0.3), layer(1e-2, 1.0, 0.1)], Base::Rigid),
        ] {
            let d = stack.layers()[0].thickness;
            let [coarse, fine] = [SPACING, 0.5 * SPACING].map(|spacing| Series::new(&stack, 1.0, spacing));
            assert!(coarse.is_resolved(), "{stack:?}: {:e}", coarse.left);
            for r in [0.2 * d, d, 10.0 * d, 1e3 * d] {
                let [a, b] = [&coarse, &fine].map(|series| series.at(libm::log(r)));
                let unit = stack.short_waves().max(stack.long_waves());
                assert!((a - b).abs() < CUT * unit, "{stack:?} at {r}: {a} {b}");
            }
        }
    }

    const GAMMA: [(f64, f64); 4] = [
        (0.01, -0.019_632_296_103_485_85),
        (0.7, -0.881_880_425_746_324_6),
        (3.3, 0.652_640_169_640_344),
        (31.0, 75.454_947_506_674_82),
    ];

    #[test]
    fn the_phase_of_the_gamma_function_has_its_digits() {
        // Im ln G(1/2 + iy) = arg; |G(1/2 + iy)|^2 = pi / cosh(pi y). Values from 30-digit arithmetic.
        for (y, exact) in GAMMA {
            assert!((gamma_phase(y) - exact).abs() < 1e-14 * (1.0 + y * y.ln().abs()), "{y}");
        }
    }
}
