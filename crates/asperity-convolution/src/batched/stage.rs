//! One pass of a transform, on blocks of m numbers, each in R parts of m/R.

use super::butterfly::{Butterfly, HalfOf, OfHalf, Whole};
use super::complex::{Complex, Root};
use super::parts::Parts;
use super::roots::root;
use super::vector::{Scalar, Vector};

/// A pass of radix R on blocks of `span` = m numbers.
pub struct Stage<T> {
    pub radix: usize,
    pub span: usize,
    /// exp(-2 pi i j r / m), r = 1..R, for every j of a part.
    roots: Vec<Root<T>>,
}

impl<T: Scalar> Stage<T> {
    pub fn new(radix: usize, span: usize) -> Self {
        let roots = (0..span / radix).flat_map(|j| (1..radix).map(move |r| root(j * r, span))).collect();
        Stage { radix, span, roots }
    }

    /// Number of values in a part.
    #[inline(always)]
    pub fn part(&self) -> usize {
        self.span / self.radix
    }

    /// The first pass reads the signal (and its missing parts from the margin) and writes the buffer; the last one (`BACK`) reads the
    /// buffer and writes the signal (and its missing parts into the margin). With `half`, the second half of the signal is zero, or
    /// not needed.
    #[inline(always)]
    pub fn outer_pass<V: Vector<Scalar = T>, const BACK: bool>(
        &self,
        half: bool,
        signal: &mut [Complex<V>],
        margin: &mut [Complex<V>],
        buffer: &mut [Complex<V>],
    ) {
        match (self.radix, half) {
            (8, true) => self.outer_pass_of::<V, OfHalf<8>, HalfOf<8>, BACK, 4, 8>(signal, margin, buffer),
            (8, false) => self.outer_pass_of::<V, Whole<8>, Whole<8>, BACK, 8, 8>(signal, margin, buffer),
            (5, _) => self.outer_pass_of::<V, Whole<5>, Whole<5>, BACK, 5, 5>(signal, margin, buffer),
            (4, true) => self.outer_pass_of::<V, OfHalf<4>, HalfOf<4>, BACK, 2, 4>(signal, margin, buffer),
            (4, false) => self.outer_pass_of::<V, Whole<4>, Whole<4>, BACK, 4, 4>(signal, margin, buffer),
            (3, _) => self.outer_pass_of::<V, Whole<3>, Whole<3>, BACK, 3, 3>(signal, margin, buffer),
            (_, true) => self.outer_pass_of::<V, OfHalf<2>, HalfOf<2>, BACK, 1, 2>(signal, margin, buffer),
            (_, false) => self.outer_pass_of::<V, Whole<2>, Whole<2>, BACK, 2, 2>(signal, margin, buffer),
        }
    }

    /// An inner pass in place: by decimation in frequency on the way down, in time on the way up (`UP`).
    #[inline(always)]
    pub fn inner_pass<V: Vector<Scalar = T>, const UP: bool>(&self, block: &mut [Complex<V>]) {
        match self.radix {
            8 => self.inner_pass_of::<V, UP, 8>(block),
            5 => self.inner_pass_of::<V, UP, 5>(block),
            4 => self.inner_pass_of::<V, UP, 4>(block),
            _ => self.inner_pass_of::<V, UP, 3>(block),
        }
    }

    /// y(j, r) = exp(-2 pi i j r / m) times the transform of x(j + q m/R) over q; `BACK` is the inverse, which exchanges real and imaginary
    /// parts finally.
    #[inline(always)]
    fn outer_pass_of<V, First, Last, const BACK: bool, const P: usize, const R: usize>(
        &self,
        signal: &mut [Complex<V>],
        margin: &mut [Complex<V>],
        buffer: &mut [Complex<V>],
    ) where
        V: Vector<Scalar = T>,
        First: Butterfly<V, P, R>,
        Last: Butterfly<V, R, P>,
    {
        let mut signal = Parts::<V, P>::of_signal(signal, margin, self.part());
        let mut buffer = Parts::<V, R>::of(buffer);
        for (j, w) in (0..buffer.length()).zip(self.roots.chunks_exact(R - 1)) {
            if BACK {
                let mut x = Last::transform(rotated(buffer.load(j), w));
                for q in 0..P {
                    x[q] = x[q].swapped();
                }
                signal.store(j, x);
            } else {
                buffer.store(j, rotated(First::transform(signal.load(j)), w));
            }
        }
    }

    #[inline(always)]
    fn inner_pass_of<V: Vector<Scalar = T>, const UP: bool, const R: usize>(&self, block: &mut [Complex<V>])
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        let mut parts = Parts::<V, R>::of(block);
        for (j, w) in (0..parts.length()).zip(self.roots.chunks_exact(R - 1)) {
            let x = parts.load(j);
            parts.store(
                j,
                match UP {
                    true => Whole::<R>::transform(rotated(x, w)),
                    false => rotated(Whole::<R>::transform(x), w),
                },
            );
        }
    }
}

/// y(r) w^r, r = 1..R.
#[inline(always)]
fn rotated<V: Vector, const R: usize>(mut y: [Complex<V>; R], roots: &[Root<V::Scalar>]) -> [Complex<V>; R] {
    for r in 1..R {
        y[r] = y[r].rotated(roots[r - 1]);
    }
    y
}
