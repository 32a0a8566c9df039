//! Roots of unity, with the same bits on every machine.

use super::complex::Root;
use super::vector::Scalar;

/// exp(-2 pi i k / n), from an angle in the first octant: accurately rounded, and exact if the value is 0 or 1.
pub fn root<T: Scalar>(k: usize, n: usize) -> Root<T> {
    let k = k % n;
    // The quarter turn, then the rest as an angle of at most an eighth of a turn in either direction.
    let quarter = (8 * k + n) / (2 * n);
    let rest = 4 * k as i64 - (quarter * n) as i64;
    let angle = std::f64::consts::FRAC_PI_2 * rest as f64 / n as f64;
    let (sin, cos) = libm::sincos(angle);
    let (cos, sin) = match quarter % 4 {
        0 => (cos, sin),
        1 => (-sin, cos),
        2 => (-cos, -sin),
        _ => (sin, -cos),
    };
    Root { re: T::nearest(cos), im: T::nearest(-sin) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_the_cosine_and_sine() {
        for n in [1, 2, 3, 4, 5, 8, 15, 16, 80, 1536, 4097] {
            for k in 0..2 * n {
                let w: Root<f64> = root(k, n);
                let angle = 2.0 * std::f64::consts::PI * (k % n) as f64 / n as f64;
                // The angle of the expected value is rounded too: 6.3 * 2^-53.
                assert!((w.re - angle.cos()).abs() < 2e-15 && (w.im + angle.sin()).abs() < 2e-15);
            }
        }
        assert_eq!(root::<f64>(3, 4), Root { re: 0.0, im: 1.0 });
        assert_eq!(root::<f64>(8, 16), Root { re: -1.0, im: 0.0 });
    }
}
