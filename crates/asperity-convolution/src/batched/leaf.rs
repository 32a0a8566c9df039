//! The leaves of a transform: R numbers whose transform is taken in registers, and there multiplied by the spectrum.

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

/// What happens at the leaves, where R numbers and their transform are in registers.
pub trait Leaf<V: Vector> {
    /// With the R numbers x from position `at` of a part on.
    fn at<const R: usize>(&mut self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>;
}

/// The transform alone.
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

/// Sum of S |y|^2 over the numbers y of a spectrum, lane by lane; real and imaginary parts are summed apart.
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

/// The spectrum is prefetched so many bytes before it is needed.
const SPECTRUM_AHEAD: usize = 4096;

/// Transform, times the spectrum, transform back on exchanged parts.
pub struct Product<'a, V>(pub &'a [V], pub &'a mut Energy<V>);

impl<V: Vector> Leaf<V> for Product<'_, V> {
    #[inline(always)]
    fn at<const R: usize>(&mut self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        let spectrum = &self.0[at..at + R];
        prefetch(Purpose::Reading, spectrum.as_ptr().wrapping_byte_add(SPECTRUM_AHEAD), R);
        let mut y = Whole::<R>::transform(x);
        for k in 0..R {
            let product = y[k].times(spectrum[k]);
            self.1.add(y[k], product);
            y[k] = product.swapped();
        }
        Whole::<R>::transform(y)
    }
}

/// The same with the spectrum read backwards.
pub struct MirroredProduct<'a, V>(pub &'a [V], pub &'a mut Energy<V>);

impl<V: Vector> Leaf<V> for MirroredProduct<'_, V> {
    #[inline(always)]
    fn at<const R: usize>(&mut self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        let end = self.0.len() - at;
        let spectrum = &self.0[end - R..end];
        let mut y = Whole::<R>::transform(x);
        for k in 0..R {
            let product = y[k].times(spectrum[R - 1 - k]);
            self.1.add(y[k], product);
            y[k] = product.swapped();
        }
        Whole::<R>::transform(y)
    }
}
