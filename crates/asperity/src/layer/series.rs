//! The response of a stack over the wave number as a Fourier series in ln q, whose terms have known transforms.
//!
//! q rest(q) vanishes for short and for long waves, and in ln q it is analytic on a strip around the real axis. It is therefore a
//! short Fourier series in ln q (A. J. S. Hamilton, Mon. Not. R. Astron. Soc. 312 (2000) 257):
//!
//! ```text
//! q rest(q) = sum of c_m q^(i w_m)
//! point   r k_rest(r) = (1/2 pi) sum of c_m r^(-i w_m) int t^(i w_m) J0(t) dt
//! line    k_rest(x) = (1/pi) (-c_0 ln x + sum of c_m x^(-i w_m) int t^(i w_m - 1) cos t dt) + a constant,   m not 0
//!
//! int t^(iw) J0(t) dt = 2^(iw) G((1 + iw)/2) / G((1 - iw)/2), of modulus 1 (G: the gamma function)
//! int t^(iw - 1) cos t dt = G(iw) cosh(pi w/2), of modulus sqrt(pi/(2 w tanh(pi w/2)))
//! ```
//!
//! These maps do not amplify errors: if q C(q) is accurate to rounding, so are r k(r) of a point and k(x) of a line, at every
//! distance. (The modulus for a line is at most 1/w_1, about 10.)

use std::f64::consts::{FRAC_PI_2, LN_2, TAU};

use rayon::prelude::*;

use super::Stack;
use super::compliance::is_short;

/// Largest ratio of the last coefficients of the series to a + b.
pub(super) const CUT: f64 = 1e-11;
/// Largest q d at which rest(q) matters, and the fraction of the long waves below which it does not.
const SHORTEST: f64 = 100.0;
const LONGEST: f64 = 1e-17;

/// q rest(q) and its coefficients.
pub(super) struct Series {
    /// ln q of the first node, and their spacing.
    first: f64,
    pub(super) spacing: f64,
    /// q rest(q) at the nodes.
    values: Vec<f64>,
    /// c_m q_1^(i w_m) with q_1 the first node, (real, imaginary), m >= 0.
    coefficients: Vec<[f64; 2]>,
    /// The largest of the last |c_m| over a + b.
    pub(super) left: f64,
}

impl Series {
    pub(super) fn new(stack: &Stack, scale: f64, spacing: f64) -> Self {
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
        // Angles are integer fractions of a turn, so one table is enough.
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
        Series { first, spacing, values, coefficients, left }
    }

    pub(super) fn is_resolved(&self) -> bool {
        self.left < CUT
    }

    /// q and q rest(q) at the nodes.
    pub(super) fn nodes(&self) -> impl Iterator<Item = (f64, f64)> {
        let q = |n: usize| libm::exp(self.first + n as f64 * self.spacing);
        self.values.iter().enumerate().map(move |(n, value)| (q(n), *value))
    }

    /// 2 pi r k_rest(r) of a point.
    pub(super) fn of_point(&self) -> Terms {
        Terms { logarithm: 0.0, ..self.transformed(|w| (1.0, bessel_phase(w))) }
    }

    /// pi k_rest(x) of a line, up to a constant.
    pub(super) fn of_line(&self) -> Terms {
        let integral = |w: f64| match w > 0.0 {
            true => ((FRAC_PI_2 / (w * libm::tanh(FRAC_PI_2 * w))).sqrt(), gamma_phase(0.0, w)),
            false => (0.0, 0.0),
        };
        Terms { logarithm: self.coefficients[0][0], ..self.transformed(integral) }
    }

    /// The terms times integrals, which are given by modulus and argument for each w.
    fn transformed(&self, integral: impl Fn(f64) -> (f64, f64)) -> Terms {
        let count = self.values.len();
        let term = |(m, [re, im]): (usize, &[f64; 2])| {
            let w = TAU * m as f64 / (self.spacing * count as f64);
            let (modulus, phase) = integral(w);
            let both = if m == 0 { modulus } else { 2.0 * modulus };
            let (cos, sin) = (both * libm::cos(phase), both * libm::sin(phase));
            (w, [re * cos - im * sin, re * sin + im * cos])
        };
        let terms = self.coefficients.iter().enumerate().map(term).collect();
        Terms { first: self.first, terms, logarithm: 0.0 }
    }
}

/// A Fourier series in ln r, and a multiple of ln r.
pub(super) struct Terms {
    first: f64,
    /// w_m, and the factor of r^(-i w_m) q_1^(-i w_m), of which the real part is used.
    terms: Vec<(f64, [f64; 2])>,
    /// The factor of -ln r.
    logarithm: f64,
}

impl Terms {
    /// Its value at ln r.
    pub(super) fn at(&self, ln_r: f64) -> f64 {
        self.terms.iter().fold(-self.logarithm * ln_r, |sum, (w, [re, im])| {
            let angle = w * (ln_r + self.first);
            sum + (re * libm::cos(angle) + im * libm::sin(angle))
        })
    }
}

/// Thickness of all layers \[m\].
fn total(stack: &Stack) -> f64 {
    stack.layers().iter().map(|layer| layer.thickness).sum()
}

/// The argument of int t^(iw) J0(t) dt: w ln 2 + 2 Im ln G(1/2 + iw/2).
fn bessel_phase(w: f64) -> f64 {
    w * LN_2 + 2.0 * gamma_phase(0.5, 0.5 * w)
}

/// Im ln G(s + iy), 0 <= s <= 1: by Stirling's series from s + 10 + iy, whose next term is below 1e-16.
fn gamma_phase(s: f64, y: f64) -> f64 {
    const UP: usize = 10;
    let x = s + UP as f64;
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
    // Im [(z - 1/2) ln z - z] + series - sum of arg(s + k + iy)
    let stirling = y * 0.5 * libm::log(square) + (x - 0.5) * argument - y + series;
    (0..UP).fold(stirling, |phase, k| phase - libm::atan2(y, s + k as f64))
}

#[cfg(test)]
mod tests {
    use super::super::Base;
    use super::super::samples::{half_space, layer, stack};
    use super::*;

    #[test]
    fn layers_that_differ_by_many_decades_are_resolved() {
        // The series must not depend on its spacing: half the spacing gives the same numbers.
        for stack in [
            stack(&[layer(1e-3, 1e8, 0.2)], half_space(1.0)),
            stack(&[layer(1e-3, 1.0, 0.5)], half_space(1e8)),
            stack(&[layer(1e-6, 1e4, 0.3), layer(1.0, 1.0, 0.5)], Base::Rigid),
            stack(&[layer(1.0, 1e4, 0.3), layer(1e-2, 1.0, 0.1)], Base::Rigid),
        ] {
            let d = stack.layers()[0].thickness;
            let [coarse, fine] = [0.06, 0.03].map(|spacing| Series::new(&stack, 1.0, spacing));
            assert!(coarse.is_resolved(), "{stack:?}: {:e}", coarse.left);
            for r in [0.2 * d, d, 10.0 * d, 1e3 * d] {
                let [a, b] = [&coarse, &fine].map(|series| series.of_point().at(libm::log(r)) / TAU);
                let unit = stack.short_waves().max(stack.long_waves());
                assert!((a - b).abs() < CUT * unit, "{stack:?} at {r}: {a} {b}");
                // That of a line is only known up to a constant.
                let line = |series: &Series| {
                    let terms = series.of_line();
                    terms.at(libm::log(r)) - terms.at(libm::log(d))
                };
                let [a, b] = [line(&coarse), line(&fine)];
                assert!((a - b).abs() < 10.0 * CUT * unit, "line, {stack:?} at {r}: {a} {b}");
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
            assert!((gamma_phase(0.5, y) - exact).abs() < 1e-14 * (1.0 + y * y.ln().abs()), "{y}");
        }
    }

    #[test]
    fn the_phase_turns_as_the_gamma_function_does() {
        // G(z + 1) = z G(z), and |arg| of G(iy) from -pi/2 at 0: arg G(1 + iy) = arg G(iy) + pi/2.
        for y in [0.03, 0.4, 2.0, 30.0] {
            let (below, above) = (gamma_phase(0.0, y), gamma_phase(1.0, y));
            assert!((above - below - FRAC_PI_2).abs() < 1e-14 * (1.0 + y * y.ln().abs()), "{y}");
        }
        // arg G(1 + i) of 30-digit arithmetic.
        assert!((gamma_phase(1.0, 1.0) + 0.301_640_320_467_533_2).abs() < 1e-15);
    }
}
