//! Complex numbers in lanes, with separate real and imaginary parts.

use std::ops::{Add, Sub};

use super::vector::Vector;

/// re + i im, in every lane. Whole cache lines.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
pub struct Complex<V> {
    pub re: V,
    pub im: V,
}

/// cos + i sin of an angle, the same for all lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Root<T> {
    pub re: T,
    pub im: T,
}

impl<V: Vector> Add for Complex<V> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Complex { re: self.re + other.re, im: self.im + other.im }
    }
}

impl<V: Vector> Sub for Complex<V> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Complex { re: self.re - other.re, im: self.im - other.im }
    }
}

impl<V: Vector> Complex<V> {
    /// 0.
    #[inline(always)]
    pub fn zero() -> Self {
        let zero = V::splat(V::Scalar::default());
        Complex { re: zero, im: zero }
    }

    /// self + i other.
    #[inline(always)]
    pub fn plus_i(self, other: Self) -> Self {
        Complex { re: self.re - other.im, im: self.im + other.re }
    }

    /// self - i other.
    #[inline(always)]
    pub fn minus_i(self, other: Self) -> Self {
        Complex { re: self.re + other.im, im: self.im - other.re }
    }

    /// self + c other, c real.
    #[inline(always)]
    pub fn plus_times(self, c: V, other: Self) -> Self {
        Complex { re: c.mul_add(other.re, self.re), im: c.mul_add(other.im, self.im) }
    }

    /// self - c other, c real.
    #[inline(always)]
    pub fn minus_times(self, c: V, other: Self) -> Self {
        Complex { re: c.neg_mul_add(other.re, self.re), im: c.neg_mul_add(other.im, self.im) }
    }

    /// self + i c other, c real.
    #[inline(always)]
    pub fn plus_i_times(self, c: V, other: Self) -> Self {
        Complex { re: c.neg_mul_add(other.im, self.re), im: c.mul_add(other.re, self.im) }
    }

    /// self - i c other, c real.
    #[inline(always)]
    pub fn minus_i_times(self, c: V, other: Self) -> Self {
        Complex { re: c.mul_add(other.im, self.re), im: c.neg_mul_add(other.re, self.im) }
    }

    /// c self, c real.
    #[inline(always)]
    pub fn times(self, c: V) -> Self {
        Complex { re: self.re * c, im: self.im * c }
    }

    /// self + other*.
    #[inline(always)]
    pub fn plus_conjugate(self, other: Self) -> Self {
        Complex { re: self.re + other.re, im: self.im - other.im }
    }

    /// self - other*.
    #[inline(always)]
    pub fn minus_conjugate(self, other: Self) -> Self {
        Complex { re: self.re - other.re, im: self.im + other.im }
    }

    /// (self - other)*.
    #[inline(always)]
    pub fn conjugate_minus(self, other: Self) -> Self {
        Complex { re: self.re - other.re, im: other.im - self.im }
    }

    /// self w.
    #[inline(always)]
    pub fn rotated(self, w: Root<V::Scalar>) -> Self {
        let (c, s) = (V::splat(w.re), V::splat(w.im));
        Complex { re: s.neg_mul_add(self.im, self.re * c), im: s.mul_add(self.re, self.im * c) }
    }

    /// self w*.
    #[inline(always)]
    pub fn rotated_back(self, w: Root<V::Scalar>) -> Self {
        let (c, s) = (V::splat(w.re), V::splat(w.im));
        Complex { re: s.mul_add(self.im, self.re * c), im: s.neg_mul_add(self.re, self.im * c) }
    }

    /// im + i re. Swapping before and after turns a forward transform into an inverse one.
    #[inline(always)]
    pub fn swapped(self) -> Self {
        Complex { re: self.im, im: self.re }
    }
}

/// The scalars of `numbers`: all lanes of one real part, all lanes of its imaginary part, and so on.
#[inline(always)]
pub fn scalars<V: Vector>(numbers: &[Complex<V>]) -> &[V::Scalar] {
    const { assert!(size_of::<Complex<V>>() == 2 * V::LANES * size_of::<V::Scalar>(), "padded") };
    // SAFETY: a Complex is two V one after the other, and a V has the layout of LANES scalars.
    unsafe { std::slice::from_raw_parts(numbers.as_ptr().cast(), 2 * V::LANES * numbers.len()) }
}

/// As [`scalars`], but mutable.
#[inline(always)]
pub fn scalars_mut<V: Vector>(numbers: &mut [Complex<V>]) -> &mut [V::Scalar] {
    const { assert!(size_of::<Complex<V>>() == 2 * V::LANES * size_of::<V::Scalar>(), "padded") };
    // SAFETY: as in `scalars`; any bit pattern of V is valid; the borrow is exclusive.
    unsafe { std::slice::from_raw_parts_mut(numbers.as_mut_ptr().cast(), 2 * V::LANES * numbers.len()) }
}

/// Exchanges lanes and positions of `LANES` complex numbers: lane j of to\[i\] is lane i of from\[j\].
#[inline(always)]
pub fn transpose<V: Vector>(from: &[Complex<V>], to: &mut [Complex<V>]) {
    let stride = 2 * V::LANES;
    let (from, to) = (scalars(from), scalars_mut(to));
    V::transpose(from, stride, to, stride);
    V::transpose(&from[V::LANES..], stride, &mut to[V::LANES..], stride);
}
