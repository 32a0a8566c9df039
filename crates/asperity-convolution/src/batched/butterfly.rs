//! The discrete Fourier transforms of 2, 3, 4, 5 and 8 numbers, of which long transforms consist: X(k) = sum over q of x(q)
//! exp(-2 pi i q k / R).
//!
//! The long transform of a domain padded with zeros needs two more variants: one where the second half of the input is zero
//! (`OfHalf`), and one where only the first half of the output is needed (`HalfOf`).

use std::f64::consts::FRAC_1_SQRT_2;

use super::complex::Complex;
use super::vector::{Scalar, Vector};

/// A constant in all lanes.
#[inline(always)]
fn constant<V: Vector>(c: f64) -> V {
    V::splat(V::Scalar::nearest(c))
}

/// A transform of R numbers, of which only P are non-zero or only P are needed.
pub trait Butterfly<V, const IN: usize, const OUT: usize> {
    /// X of x.
    fn transform(x: [Complex<V>; IN]) -> [Complex<V>; OUT];
}

/// The whole transform.
pub struct Whole<const R: usize>;

/// The transform of a signal whose second half is zero.
pub struct OfHalf<const R: usize>;

/// The first half of the transform.
pub struct HalfOf<const R: usize>;

impl<V: Vector> Butterfly<V, 1, 1> for Whole<1> {
    #[inline(always)]
    fn transform(x: [Complex<V>; 1]) -> [Complex<V>; 1] {
        x
    }
}

impl<V: Vector> Butterfly<V, 2, 2> for Whole<2> {
    #[inline(always)]
    fn transform([a, b]: [Complex<V>; 2]) -> [Complex<V>; 2] {
        [a + b, a - b]
    }
}

impl<V: Vector> Butterfly<V, 1, 2> for OfHalf<2> {
    #[inline(always)]
    fn transform([a]: [Complex<V>; 1]) -> [Complex<V>; 2] {
        [a, a]
    }
}

impl<V: Vector> Butterfly<V, 2, 1> for HalfOf<2> {
    #[inline(always)]
    fn transform([a, b]: [Complex<V>; 2]) -> [Complex<V>; 1] {
        [a + b]
    }
}

impl<V: Vector> Butterfly<V, 3, 3> for Whole<3> {
    #[inline(always)]
    fn transform([a, b, c]: [Complex<V>; 3]) -> [Complex<V>; 3] {
        const SIN_60: f64 = 0.866_025_403_784_438_6;
        let (sum, difference) = (b + c, b - c);
        let middle = a.minus_times(constant(0.5), sum);
        let sin = constant(SIN_60);
        [a + sum, middle.minus_i_times(sin, difference), middle.plus_i_times(sin, difference)]
    }
}

impl<V: Vector> Butterfly<V, 4, 4> for Whole<4> {
    #[inline(always)]
    fn transform([a, b, c, d]: [Complex<V>; 4]) -> [Complex<V>; 4] {
        dft4_of_halves([a + c, b + d], [a - c, b - d])
    }
}

impl<V: Vector> Butterfly<V, 2, 4> for OfHalf<4> {
    #[inline(always)]
    fn transform(x: [Complex<V>; 2]) -> [Complex<V>; 4] {
        dft4_of_halves(x, x)
    }
}

impl<V: Vector> Butterfly<V, 4, 2> for HalfOf<4> {
    #[inline(always)]
    fn transform([a, b, c, d]: [Complex<V>; 4]) -> [Complex<V>; 2] {
        [(a + c) + (b + d), (a - c).minus_i(b - d)]
    }
}

/// From the sums s(q) = x(q) + x(q + 2) and the differences d(q) = x(q) - x(q + 2).
#[inline(always)]
fn dft4_of_halves<V: Vector>(s: [Complex<V>; 2], d: [Complex<V>; 2]) -> [Complex<V>; 4] {
    [s[0] + s[1], d[0].minus_i(d[1]), s[0] - s[1], d[0].plus_i(d[1])]
}

impl<V: Vector> Butterfly<V, 5, 5> for Whole<5> {
    #[inline(always)]
    fn transform([a, b, c, d, e]: [Complex<V>; 5]) -> [Complex<V>; 5] {
        const COS_72: f64 = 0.309_016_994_374_947_45;
        const SIN_72: f64 = 0.951_056_516_295_153_5;
        const MINUS_COS_144: f64 = 0.809_016_994_374_947_5;
        const SIN_144: f64 = 0.587_785_252_292_473_1;
        let (cos_72, minus_cos_144) = (constant(COS_72), constant(MINUS_COS_144));
        let (sin_72, sin_144) = (constant(SIN_72), constant(SIN_144));
        let (be, cd) = (b + e, c + d);
        let (b_e, c_d) = (b - e, c - d);
        let even_1 = a.plus_times(cos_72, be).minus_times(minus_cos_144, cd);
        let even_2 = a.plus_times(cos_72, cd).minus_times(minus_cos_144, be);
        let odd_1 = b_e.times(sin_72).plus_times(sin_144, c_d);
        let odd_2 = b_e.times(sin_144).minus_times(sin_72, c_d);
        [
            a + (be + cd),
            even_1.minus_i(odd_1),
            even_2.minus_i(odd_2),
            even_2.plus_i(odd_2),
            even_1.plus_i(odd_1),
        ]
    }
}

impl<V: Vector> Butterfly<V, 8, 8> for Whole<8> {
    #[inline(always)]
    fn transform([a, b, c, d, e, f, g, h]: [Complex<V>; 8]) -> [Complex<V>; 8] {
        dft8_of_halves([a + e, b + f, c + g, d + h], [a - e, b - f, c - g, d - h])
    }
}

impl<V: Vector> Butterfly<V, 4, 8> for OfHalf<8> {
    #[inline(always)]
    fn transform(x: [Complex<V>; 4]) -> [Complex<V>; 8] {
        dft8_of_halves(x, x)
    }
}

impl<V: Vector> Butterfly<V, 8, 4> for HalfOf<8> {
    #[inline(always)]
    fn transform(x: [Complex<V>; 8]) -> [Complex<V>; 4] {
        // The four others are not used, so the compiler drops them.
        let [x0, x1, x2, x3, ..] = Whole::<8>::transform(x);
        [x0, x1, x2, x3]
    }
}

/// From the sums s(q) = x(q) + x(q + 4) and the differences d(q) = x(q) - x(q + 4): the even
/// outputs are the transform of s, the odd ones that of d(q) exp(-i pi q / 4).
#[inline(always)]
fn dft8_of_halves<V: Vector>(s: [Complex<V>; 4], d: [Complex<V>; 4]) -> [Complex<V>; 8] {
    let [x0, x2, x4, x6] = Whole::<4>::transform(s);
    let (near, far) = (d[0].minus_i(d[2]), d[0].plus_i(d[2]));
    let (difference, sum) = (d[1] - d[3], d[1] + d[3]);
    let (m, p) = (difference.minus_i(sum), difference.plus_i(sum));
    let r = constant(FRAC_1_SQRT_2);
    [
        x0,
        near.plus_times(r, m),
        x2,
        far.minus_times(r, p),
        x4,
        near.minus_times(r, m),
        x6,
        far.plus_times(r, p),
    ]
}

#[cfg(test)]
mod tests {
    use super::super::portable::Portable;
    use std::f64::consts::PI;

    use super::*;

    type Number = Complex<Portable<f64, 4>>;

    fn number(re: f64, im: f64) -> Number {
        Complex { re: Portable::splat(re), im: Portable::splat(im) }
    }

    fn parts(z: &Number) -> (f64, f64) {
        let scalars = super::super::complex::scalars(std::slice::from_ref(z));
        (scalars[0], scalars[4])
    }

    fn sample<const R: usize>() -> [Number; R] {
        std::array::from_fn(|q| number((q * q) as f64 - 3.5, 1.0 / (1.0 + q as f64)))
    }

    /// The defining sum.
    fn assert_transform(x: &[Number], transform: &[Number], length: usize) {
        for (k, z) in transform.iter().enumerate() {
            let (mut re, mut im) = (0.0, 0.0);
            for (q, x) in x.iter().enumerate() {
                let (sin, cos) = (-2.0 * PI * (q * k % length) as f64 / length as f64).sin_cos();
                let (a, b) = parts(x);
                re += a * cos - b * sin;
                im += a * sin + b * cos;
            }
            let (a, b) = parts(z);
            // A sum of at most 8 numbers of size 50.
            assert!((a - re).abs() < 1e-13 && (b - im).abs() < 1e-13, "{length}, {k}: {a} {re}, {b} {im}");
        }
    }

    #[test]
    fn butterflies_are_the_defining_sum() {
        assert_transform(&sample::<1>(), &Whole::<1>::transform(sample()), 1);
        assert_transform(&sample::<2>(), &Whole::<2>::transform(sample()), 2);
        assert_transform(&sample::<3>(), &Whole::<3>::transform(sample()), 3);
        assert_transform(&sample::<4>(), &Whole::<4>::transform(sample()), 4);
        assert_transform(&sample::<5>(), &Whole::<5>::transform(sample()), 5);
        assert_transform(&sample::<8>(), &Whole::<8>::transform(sample()), 8);
    }

    #[test]
    fn pruned_butterflies_are_the_defining_sum() {
        assert_transform(&sample::<1>(), &OfHalf::<2>::transform(sample()), 2);
        assert_transform(&sample::<2>(), &HalfOf::<2>::transform(sample()), 2);
        assert_transform(&sample::<2>(), &OfHalf::<4>::transform(sample()), 4);
        assert_transform(&sample::<4>(), &OfHalf::<8>::transform(sample()), 8);
        assert_transform(&sample::<4>(), &HalfOf::<4>::transform(sample()), 4);
        assert_transform(&sample::<8>(), &HalfOf::<8>::transform(sample()), 8);
    }
}
