//! The transform of one block: LANES complex signals of the same length, side by side.
//!
//! Forward by decimation in frequency (Gentleman & Sande 1966), back by decimation in time (Cooley &
//! Tukey 1965), in place: the spectrum between them lies in digit-reversed order and is never
//! sorted. After the first pass each of its parts is finished alone, depth first, so that the work
//! stays in the nearest cache. With a length m = R t the first pass takes the numbers j, j + t, j +
//! 2t, ..: where the signal is padded to twice its length the second half of them is zero, and the
//! last pass back need not compute them.
//!
//! The inverse transform is the forward one of the number with real and imaginary part exchanged.

use super::butterfly::{Butterfly, HalfOf, OfHalf, Whole};
use super::complex::{Complex, Root};
use super::factors::Factors;
use super::lane::{Lane, Real};
use super::parts::Parts;
use super::prefetch::{Ahead, For, prefetch};
use super::roots::root;

/// One pass: blocks of `span` numbers, each split into `radix` parts.
pub struct Stage<T> {
    radix: usize,
    span: usize,
    /// exp(-2 pi i j r / span), r = 1..radix, for every j of a part.
    roots: Vec<Root<T>>,
}

impl<T: Real> Stage<T> {
    fn new(radix: usize, span: usize) -> Self {
        let roots = (0..span / radix).flat_map(|j| (1..radix).map(move |r| root(j * r, span))).collect();
        Stage { radix, span, roots }
    }
}

/// A planned transform of `length` complex numbers.
pub struct Transform<T> {
    length: usize,
    /// Whether the signal fills at most the first half: the rest is taken as zero, and not computed.
    half: bool,
    first: Stage<T>,
    inner: Vec<Stage<T>>,
    leaf: usize,
}

impl<T: Real> Transform<T> {
    pub fn new(factors: &Factors, half: bool) -> Self {
        let mut span = factors.inner.iter().product::<usize>() * factors.leaf;
        let length = factors.first * span;
        let mut inner = Vec::with_capacity(factors.inner.len());
        for &radix in &factors.inner {
            inner.push(Stage::new(radix, span));
            span /= radix;
        }
        Transform { length, half, first: Stage::new(factors.first, length), inner, leaf: factors.leaf }
    }

    /// m.
    pub fn length(&self) -> usize {
        self.length
    }

    /// How many numbers the first pass reads and the last pass back writes: m, or m / 2.
    pub fn signal_length(&self) -> usize {
        if self.half { self.length / 2 } else { self.length }
    }

    /// Where every frequency lies in the digit-reversed spectrum.
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

    /// How many of the first pass's parts of the spectrum must be stored of a real, even one: the
    /// others, r > R/2, are the parts R - r read backwards.
    pub fn mirrored_length(&self) -> usize {
        (self.first.radix / 2 + 1) * (self.length / self.first.radix)
    }

    /// The span of the blocks that are finished at once.
    #[inline(always)]
    fn deepest(&self) -> usize {
        self.inner.last().map_or(self.leaf, |stage| stage.span)
    }

    /// How often [`Transform::convolve`] advances what it is given to ask for.
    pub fn steps(&self) -> usize {
        self.length / self.deepest()
    }

    /// buffer = the spectrum of `signal` (`signal_length` numbers), digit-reversed.
    #[inline(always)]
    pub fn forward<V: Lane<Scalar = T>>(&self, signal: &mut [Complex<V>], buffer: &mut [Complex<V>]) {
        self.open(signal, &mut [], buffer);
        for part in buffer.chunks_exact_mut(self.length / self.first.radix) {
            self.descend::<V, true, false>(part, &Plain, &mut Ahead::nothing());
        }
    }

    /// signal = m times the inverse of the digit-reversed spectrum in `buffer`, whose real and
    /// imaginary parts the caller has exchanged.
    #[inline(always)]
    pub fn inverse<V: Lane<Scalar = T>>(&self, buffer: &mut [Complex<V>], signal: &mut [Complex<V>]) {
        for part in buffer.chunks_exact_mut(self.length / self.first.radix) {
            self.descend::<V, false, true>(part, &Plain, &mut Ahead::nothing());
        }
        self.close(buffer, signal, &mut []);
    }

    /// signal = m times the inverse of (spectrum times transform of signal), in place.
    ///
    /// `signal` may be shorter than `signal_length`; `margin` has that length and takes what is
    /// missing; `spectrum` is real, even, digit-reversed, of `mirrored_length`; `ahead` is advanced
    /// meanwhile.
    #[inline(always)]
    pub fn convolve<V: Lane<Scalar = T>>(
        &self,
        signal: &mut [Complex<V>],
        margin: &mut [Complex<V>],
        buffer: &mut [Complex<V>],
        spectrum: &[V],
        ahead: &mut Ahead<Complex<V>>,
    ) {
        let radix = self.first.radix;
        let part_length = self.length / radix;
        let whole = signal.len() / part_length * part_length;
        if whole < self.signal_length() {
            let rest = signal.len() - whole;
            margin[whole..][..rest].copy_from_slice(&signal[whole..]);
            margin[whole + rest..].fill(Complex::zero());
        }
        self.open(signal, margin, buffer);
        for (r, part) in buffer.chunks_exact_mut(part_length).enumerate() {
            let stored = r.min(radix - r);
            let spectrum = &spectrum[stored * part_length..][..part_length];
            if stored == r {
                self.descend::<V, true, true>(part, &Product(spectrum), ahead);
            } else {
                self.descend::<V, true, true>(part, &MirroredProduct(spectrum), ahead);
            }
        }
        self.close(buffer, signal, margin);
        if whole < signal.len() {
            let rest = signal.len() - whole;
            signal[whole..].copy_from_slice(&margin[whole..][..rest]);
        }
    }

    /// The first pass: from the signal (its missing parts in the margin) into the buffer.
    #[inline(always)]
    fn open<V: Lane<Scalar = T>>(
        &self,
        signal: &mut [Complex<V>],
        margin: &mut [Complex<V>],
        buffer: &mut [Complex<V>],
    ) {
        let length = self.length / self.first.radix;
        let roots = &self.first.roots;
        match (self.first.radix, self.half) {
            (8, true) => first_pass::<V, OfHalf<8>, 4, 8>(
                Parts::of_signal(signal, margin, length),
                Parts::of(buffer),
                roots,
            ),
            (8, false) => first_pass::<V, Whole<8>, 8, 8>(
                Parts::of_signal(signal, margin, length),
                Parts::of(buffer),
                roots,
            ),
            (_, true) => first_pass::<V, OfHalf<4>, 2, 4>(
                Parts::of_signal(signal, margin, length),
                Parts::of(buffer),
                roots,
            ),
            (_, false) => first_pass::<V, Whole<4>, 4, 4>(
                Parts::of_signal(signal, margin, length),
                Parts::of(buffer),
                roots,
            ),
        }
    }

    /// The last pass: from the buffer into the signal (its missing parts into the margin).
    #[inline(always)]
    fn close<V: Lane<Scalar = T>>(
        &self,
        buffer: &mut [Complex<V>],
        signal: &mut [Complex<V>],
        margin: &mut [Complex<V>],
    ) {
        let length = self.length / self.first.radix;
        let roots = &self.first.roots;
        match (self.first.radix, self.half) {
            (8, true) => last_pass::<V, HalfOf<8>, 4, 8>(
                Parts::of(buffer),
                Parts::of_signal(signal, margin, length),
                roots,
            ),
            (8, false) => last_pass::<V, Whole<8>, 8, 8>(
                Parts::of(buffer),
                Parts::of_signal(signal, margin, length),
                roots,
            ),
            (_, true) => last_pass::<V, HalfOf<4>, 2, 4>(
                Parts::of(buffer),
                Parts::of_signal(signal, margin, length),
                roots,
            ),
            (_, false) => last_pass::<V, Whole<4>, 4, 4>(
                Parts::of(buffer),
                Parts::of_signal(signal, margin, length),
                roots,
            ),
        }
    }

    /// Finishes one part of the first pass: the inner stages on the way down (`DOWN`), the leaves,
    /// the inner stages on the way up (`UP`), depth first.
    ///
    /// The recursion is written as a loop over the deepest blocks: a stage runs before the first,
    /// and again after the last, of the deepest blocks that it covers.
    #[inline(always)]
    fn descend<V: Lane<Scalar = T>, const DOWN: bool, const UP: bool>(
        &self,
        part: &mut [Complex<V>],
        leaf: &impl Leaf<V>,
        ahead: &mut Ahead<Complex<V>>,
    ) {
        let deepest = self.deepest();
        let mut start = 0;
        while start < part.len() {
            let end = start + deepest;
            ahead.advance();
            if DOWN {
                for stage in self.inner.iter().filter(|stage| start.is_multiple_of(stage.span)) {
                    decimate_in_frequency(stage, &mut part[start..start + stage.span]);
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
                    decimate_in_time(stage, &mut part[end - stage.span..end]);
                }
            }
            start = end;
        }
    }
}

/// y(r) = exp(-2 pi i j r / m) times the DFT of x(j + q t) over q.
#[inline(always)]
fn first_pass<V: Lane, B: Butterfly<V, P, R>, const P: usize, const R: usize>(
    signal: Parts<V, P>,
    mut buffer: Parts<V, R>,
    roots: &[Root<V::Scalar>],
) {
    for (j, w) in (0..signal.length()).zip(roots.chunks_exact(R - 1)) {
        let mut y = B::transform(signal.load(j));
        for r in 1..R {
            y[r] = y[r].rotated(w[r - 1]);
        }
        buffer.store(j, y);
    }
}

/// The way back of [`first_pass`], on exchanged parts; exchanges them for good.
#[inline(always)]
fn last_pass<V: Lane, B: Butterfly<V, R, P>, const P: usize, const R: usize>(
    buffer: Parts<V, R>,
    mut signal: Parts<V, P>,
    roots: &[Root<V::Scalar>],
) {
    for (j, w) in (0..signal.length()).zip(roots.chunks_exact(R - 1)) {
        let mut x = buffer.load(j);
        for r in 1..R {
            x[r] = x[r].rotated(w[r - 1]);
        }
        let mut y = B::transform(x);
        for q in 0..P {
            y[q] = y[q].swapped();
        }
        signal.store(j, y);
    }
}

/// One stage down, in place.
#[inline(always)]
fn decimate_in_frequency<V: Lane>(stage: &Stage<V::Scalar>, block: &mut [Complex<V>]) {
    match stage.radix {
        8 => radix_down::<V, 8>(block, &stage.roots),
        5 => radix_down::<V, 5>(block, &stage.roots),
        4 => radix_down::<V, 4>(block, &stage.roots),
        _ => radix_down::<V, 3>(block, &stage.roots),
    }
}

/// One stage up, in place.
#[inline(always)]
fn decimate_in_time<V: Lane>(stage: &Stage<V::Scalar>, block: &mut [Complex<V>]) {
    match stage.radix {
        8 => radix_up::<V, 8>(block, &stage.roots),
        5 => radix_up::<V, 5>(block, &stage.roots),
        4 => radix_up::<V, 4>(block, &stage.roots),
        _ => radix_up::<V, 3>(block, &stage.roots),
    }
}

#[inline(always)]
fn radix_down<V: Lane, const R: usize>(block: &mut [Complex<V>], roots: &[Root<V::Scalar>])
where
    Whole<R>: Butterfly<V, R, R>,
{
    let mut parts = Parts::<V, R>::of(block);
    for (j, w) in (0..parts.length()).zip(roots.chunks_exact(R - 1)) {
        let mut y = Whole::<R>::transform(parts.load(j));
        for r in 1..R {
            y[r] = y[r].rotated(w[r - 1]);
        }
        parts.store(j, y);
    }
}

#[inline(always)]
fn radix_up<V: Lane, const R: usize>(block: &mut [Complex<V>], roots: &[Root<V::Scalar>])
where
    Whole<R>: Butterfly<V, R, R>,
{
    let mut parts = Parts::<V, R>::of(block);
    for (j, w) in (0..parts.length()).zip(roots.chunks_exact(R - 1)) {
        let mut x = parts.load(j);
        for r in 1..R {
            x[r] = x[r].rotated(w[r - 1]);
        }
        parts.store(j, Whole::<R>::transform(x));
    }
}

/// The leaves of a block, which starts at position `start` of its part.
#[inline(always)]
fn run_leaves<V: Lane, const R: usize>(block: &mut [Complex<V>], start: usize, leaf: &impl Leaf<V>)
where
    Whole<R>: Butterfly<V, R, R>,
{
    let (leaves, _) = block.as_chunks_mut::<R>();
    for (n, numbers) in leaves.iter_mut().enumerate() {
        *numbers = leaf.at(*numbers, start + n * R);
    }
}

/// What happens at the leaves, where R numbers and their transform are in registers.
trait Leaf<V: Lane> {
    /// With the R numbers x from position `at` of a part on.
    fn at<const R: usize>(&self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>;
}

/// The transform alone.
struct Plain;

impl<V: Lane> Leaf<V> for Plain {
    #[inline(always)]
    fn at<const R: usize>(&self, x: [Complex<V>; R], _: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        Whole::<R>::transform(x)
    }
}

/// The spectrum is asked for so many bytes before it is needed.
const SPECTRUM_AHEAD: usize = 4096;

/// Transform, times the spectrum, transform back on exchanged parts.
struct Product<'a, V>(&'a [V]);

impl<V: Lane> Leaf<V> for Product<'_, V> {
    #[inline(always)]
    fn at<const R: usize>(&self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        let spectrum = &self.0[at..at + R];
        prefetch(For::Reading, spectrum.as_ptr().wrapping_byte_add(SPECTRUM_AHEAD), R);
        let mut y = Whole::<R>::transform(x);
        for k in 0..R {
            y[k] = y[k].times(spectrum[k]).swapped();
        }
        Whole::<R>::transform(y)
    }
}

/// The same with the spectrum read backwards.
struct MirroredProduct<'a, V>(&'a [V]);

impl<V: Lane> Leaf<V> for MirroredProduct<'_, V> {
    #[inline(always)]
    fn at<const R: usize>(&self, x: [Complex<V>; R], at: usize) -> [Complex<V>; R]
    where
        Whole<R>: Butterfly<V, R, R>,
    {
        let end = self.0.len() - at;
        let spectrum = &self.0[end - R..end];
        let mut y = Whole::<R>::transform(x);
        for k in 0..R {
            y[k] = y[k].times(spectrum[R - 1 - k]).swapped();
        }
        Whole::<R>::transform(y)
    }
}
