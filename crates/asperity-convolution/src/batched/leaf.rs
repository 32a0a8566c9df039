//! The leaves of a transform: R numbers are transformed in registers and multiplied by the spectrum there.

use super::butterfly::{Butterfly, Whole};
use super::complex::Complex;
use super::prefetch::{Purpose, prefetch};
use super::vector::Vector;

/// The leaves of a block, which starts at position `start` of its part.
#[inline(always)]
pub fn run_leaves<V: Vector, const R: usize>(block: &mut [Complex<V>], start: usize, leaf: &mut impl Leaf<V>)
where
    Whole<R>: Butterfly<V, R, R>,
{
    let (leaves, _) = block.as_chunks_mut::<R>();
    for (n, numbers) in leaves.iter_mut().enumerate() {
        *numbers = leaf.at(*numbers, start + n * R);
    }
}

/// The operation at the leaves, where R numbers and their transform are in registers.
pub trait Leaf<V: Vector> {
    /// Processes the R numbers x from position `at` of a part on.
    fn at<const R: usize>(&mut self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>;
}

/// Only the transform.
pub struct Plain;

impl<V: Vector> Leaf<V> for Plain {
    #[inline(always)]
    fn at<const R: usize>(&mut self, x: [Complex<V>; R], _: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        Whole::<R>::transform(x)
    }
}

/// Sum of S |y|^2 over the numbers y of a spectrum, lane by lane; real and imaginary parts have separate sums.
#[derive(Clone, Copy)]
pub struct Energy<V> {
    re: V,
    im: V,
}

impl<V: Vector> Energy<V> {
    #[inline(always)]
    pub fn zero() -> Self {
        let zero = V::splat(V::Scalar::default());
        Energy { re: zero, im: zero }
    }

    #[inline(always)]
    fn add(&mut self, y: Complex<V>, product: Complex<V>) {
        self.re = y.re.mul_add(product.re, self.re);
        self.im = y.im.mul_add(product.im, self.im);
    }

    /// The sum of each lane.
    #[inline(always)]
    pub fn total(self) -> V {
        self.re + self.im
    }
}

/// Distance in bytes by which the spectrum is prefetched.
const SPECTRUM_AHEAD: usize = 4096;

/// Transforms, multiplies by the spectrum, and transforms back with exchanged real and imaginary parts. If `MIRRORED`, the spectrum
/// is read backwards.
pub struct Product<'a, V, const MIRRORED: bool>(pub &'a [V], pub &'a mut Energy<V>);

impl<V: Vector, const MIRRORED: bool> Leaf<V> for Product<'_, V, MIRRORED> {
    #[inline(always)]
    fn at<const R: usize>(&mut self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        let start = if MIRRORED { self.0.len() - at - R } else { at };
        let spectrum = &self.0[start..start + R];
        if !MIRRORED {
            prefetch(Purpose::Reading, spectrum.as_ptr().wrapping_byte_add(SPECTRUM_AHEAD), R);
        }
        let mut y = Whole::<R>::transform(x);
        for k in 0..R {
            let product = y[k].times(spectrum[if MIRRORED { R - 1 - k } else { k }]);
            self.1.add(y[k], product);
            y[k] = product.swapped();
        }
        Whole::<R>::transform(y)
    }
}
