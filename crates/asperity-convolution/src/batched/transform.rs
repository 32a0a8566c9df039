//! The transform of one block, that is LANES complex signals of the same length, side by side.
//!
//! Forward by decimation in frequency (Gentleman & Sande 1966), back by decimation in time (Cooley & Tukey 1965), in place: the
//! spectrum between them is in digit-reversed order and is never sorted. After the first pass each part is finished separately,
//! depth first, so that the data stay in the first-level cache. With a length m = R t the first pass takes the numbers j, j + t,
//! j + 2t, ..: if the signal is padded to twice its length, the second half of them is zero, and the last pass back need not
//! compute them.
//!
//! The inverse transform is the forward transform with real and imaginary parts exchanged.

use super::complex::Complex;
use super::factors::Factors;
use super::leaf::{Energy, Leaf, Plain, Product, run_leaves};
use super::prefetch::PrefetchAhead;
use super::stage::Stage;
use super::vector::{Scalar, Vector};

/// A planned transform of `length` complex numbers.
pub struct Transform<T> {
    length: usize,
    /// Whether the signal fills at most the first half: the rest is taken as zero and not computed.
    half: bool,
    first: Stage<T>,
    inner: Vec<Stage<T>>,
    leaf: usize,
}

impl<T: Scalar> Transform<T> {
    pub fn new(factors: &Factors, half: bool) -> Self {
        let mut span = factors.inner.iter().product::<usize>() * factors.leaf;
        let length = factors.first * span;
        let mut inner = Vec::with_capacity(factors.inner.len());
        for &radix in &factors.inner {
            inner.push(Stage::new(radix, span));
            span /= radix;
        }
        let half = half && factors.first.is_multiple_of(2);
        Transform { length, half, first: Stage::new(factors.first, length), inner, leaf: factors.leaf }
    }

    /// m.
    pub fn length(&self) -> usize {
        self.length
    }

    /// Number of values that the first pass reads and the last pass back writes: m or m / 2.
    pub fn signal_length(&self) -> usize {
        if self.half { self.length / 2 } else { self.length }
    }

    /// Position of every frequency in the digit-reversed spectrum.
    pub fn positions(&self) -> Vec<usize> {
        let radices = || {
            let inner = self.inner.iter().map(|stage| stage.radix);
            std::iter::once(self.first.radix).chain(inner).chain([self.leaf])
        };
        let position = |mut frequency: usize| {
            let (mut span, mut position) = (self.length, 0);
            for radix in radices() {
                span /= radix;
                position += frequency % radix * span;
                frequency /= radix;
            }
            position
        };
        (0..self.length).map(position).collect()
    }

    /// Number of parts of the first pass that must be stored for a real, even spectrum: the others, r > R/2, are the parts R - r
    /// read backwards.
    pub fn mirrored_length(&self) -> usize {
        (self.first.radix / 2 + 1) * (self.first.part())
    }

    /// The span of the blocks that are finished at once.
    #[inline(always)]
    fn deepest(&self) -> usize {
        self.inner.last().map_or(self.leaf, |stage| stage.span)
    }

    /// Number of prefetch steps in [`Transform::convolve`].
    pub fn steps(&self) -> usize {
        self.length / self.deepest()
    }

    /// buffer = the spectrum of `signal` (`signal_length` numbers), digit-reversed.
    #[inline(always)]
    pub fn forward<V: Vector<Scalar = T>>(&self, signal: &mut [Complex<V>], buffer: &mut [Complex<V>]) {
        self.first.outer_pass::<V, false>(self.half, signal, &mut [], buffer);
        for part in buffer.chunks_exact_mut(self.first.part()) {
            self.descend::<V, true, false>(part, &mut Plain, &mut PrefetchAhead::nothing());
        }
    }

    /// signal = m times the inverse of the digit-reversed spectrum in `buffer`, whose real and
    /// imaginary parts the caller has exchanged.
    #[inline(always)]
    pub fn inverse<V: Vector<Scalar = T>>(&self, buffer: &mut [Complex<V>], signal: &mut [Complex<V>]) {
        for part in buffer.chunks_exact_mut(self.first.part()) {
            self.descend::<V, false, true>(part, &mut Plain, &mut PrefetchAhead::nothing());
        }
        self.first.outer_pass::<V, true>(self.half, signal, &mut [], buffer);
    }

    /// signal = m times the inverse of (spectrum times transform of signal), in place.
    ///
    /// `signal` may be shorter than `signal_length`; `margin` has that length and holds the missing part. `spectrum` is real,
    /// even, digit-reversed, of `mirrored_length`. `energy` sums S |y|^2 over the transform y, and `ahead` prefetches at the same
    /// time.
    #[inline(always)]
    pub fn convolve<V: Vector<Scalar = T>>(
        &self,
        signal: &mut [Complex<V>],
        margin: &mut [Complex<V>],
        buffer: &mut [Complex<V>],
        spectrum: &[V],
        energy: &mut Energy<V>,
        ahead: &mut PrefetchAhead<Complex<V>>,
    ) {
        let radix = self.first.radix;
        let part_length = self.first.part();
        let whole = signal.len() / part_length * part_length;
        if whole < self.signal_length() {
            let rest = signal.len() - whole;
            margin[whole..][..rest].copy_from_slice(&signal[whole..]);
            margin[whole + rest..].fill(Complex::zero());
        }
        self.first.outer_pass::<V, false>(self.half, signal, margin, buffer);
        for (r, part) in buffer.chunks_exact_mut(part_length).enumerate() {
            let stored = r.min(radix - r);
            let spectrum = &spectrum[stored * part_length..][..part_length];
            if stored == r {
                self.descend::<V, true, true>(part, &mut Product::<V, false>(spectrum, energy), ahead);
            } else {
                self.descend::<V, true, true>(part, &mut Product::<V, true>(spectrum, energy), ahead);
            }
        }
        self.first.outer_pass::<V, true>(self.half, signal, margin, buffer);
        if whole < signal.len() {
            let rest = signal.len() - whole;
            signal[whole..].copy_from_slice(&margin[whole..][..rest]);
        }
    }

    /// Finishes one part of the first pass: the inner stages on the way down (`DOWN`), the leaves,
    /// the inner stages on the way up (`UP`), depth first.
    ///
    /// The recursion is written as a loop over the deepest blocks: a stage runs before the first,
    /// and again after the last, of the deepest blocks that it covers.
    #[inline(always)]
    fn descend<V: Vector<Scalar = T>, const DOWN: bool, const UP: bool>(
        &self,
        part: &mut [Complex<V>],
        leaf: &mut impl Leaf<V>,
        ahead: &mut PrefetchAhead<Complex<V>>,
    ) {
        let deepest = self.deepest();
        let mut start = 0;
        while start < part.len() {
            let end = start + deepest;
            ahead.advance();
            if DOWN {
                for stage in self.inner.iter().filter(|stage| start.is_multiple_of(stage.span)) {
                    stage.inner_pass::<V, false>(&mut part[start..start + stage.span]);
                }
            }
            let leaves = &mut part[start..end];
            match self.leaf {
                8 => run_leaves::<V, 8>(leaves, start, leaf),
                5 => run_leaves::<V, 5>(leaves, start, leaf),
                4 => run_leaves::<V, 4>(leaves, start, leaf),
                3 => run_leaves::<V, 3>(leaves, start, leaf),
                2 => run_leaves::<V, 2>(leaves, start, leaf),
                _ => run_leaves::<V, 1>(leaves, start, leaf),
            }
            if UP {
                for stage in self.inner.iter().rev().filter(|stage| end.is_multiple_of(stage.span)) {
                    stage.inner_pass::<V, true>(&mut part[end - stage.span..end]);
                }
            }
            start = end;
        }
    }
}
