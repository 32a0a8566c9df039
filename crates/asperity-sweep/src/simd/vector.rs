//! Eight `f64` as one value, for any vectors of the processor, and traits that are generic over it.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

/// Eight `f64`, one for each of eight neighbouring cells.
pub trait F64x8:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self>
{
    /// Which of the eight.
    type Mask: Mask;

    /// x for every cell.
    fn splat(x: f64) -> Self;

    /// From eight numbers.
    fn from_array(cells: [f64; 8]) -> Self;

    /// The eight numbers.
    fn to_array(self) -> [f64; 8];

    /// From eight `f32`, exactly.
    fn from_singles(cells: [f32; 8]) -> Self;

    /// The nearest `f32`s.
    fn to_singles(self) -> [f32; 8];

    /// |x|
    fn abs(self) -> Self;

    /// `if self > other { self } else { other }`
    fn larger(self, other: Self) -> Self;

    /// `if self < other { self } else { other }`
    fn smaller(self, other: Self) -> Self;

    /// self < other; false for NaN.
    fn less(self, other: Self) -> Self::Mask;

    /// self <= other; false for NaN.
    fn at_most(self, other: Self) -> Self::Mask;

    /// `yes` where `mask`, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// Cells `at`..`at + 8` of a field; `beyond` past its end.
    #[inline(always)]
    fn load<T: Cell>(field: &[T], at: usize, beyond: f64) -> Self {
        match field.get(at..).and_then(<[T]>::first_chunk) {
            Some(cells) => T::widen(*cells),
            None => T::widen(partial(field, at, T::nearest(beyond))),
        }
    }

    /// Stores into cells `at`..`at + 8` of a field, as far as they exist.
    #[inline(always)]
    fn store<T: Cell>(self, field: &mut [T], at: usize) {
        let cells = T::narrow(self);
        match field.get_mut(at..).and_then(<[T]>::first_chunk_mut) {
            Some(eight) => *eight = cells,
            None => store_partial(field, at, &cells),
        }
    }

    /// ((0 + 1) + (2 + 3)) + ((4 + 5) + (6 + 7))
    #[inline(always)]
    fn sum(self) -> f64 {
        let [a, b, c, d, e, f, g, h] = self.to_array();
        ((a + b) + (c + d)) + ((e + f) + (g + h))
    }

    /// The largest of the eight.
    #[inline(always)]
    fn largest(self) -> f64 {
        self.to_array().into_iter().reduce(|m, x| if x > m { x } else { m }).unwrap_or(f64::NAN)
    }

    /// The smallest of the eight.
    #[inline(always)]
    fn least(self) -> f64 {
        self.to_array().into_iter().reduce(|m, x| if x < m { x } else { m }).unwrap_or(f64::NAN)
    }

    /// self where `mask`, else 0.
    #[inline(always)]
    fn only(self, mask: Self::Mask) -> Self {
        Self::select(mask, self, Self::splat(0.0))
    }

    /// 1 where `mask`, else 0.
    #[inline(always)]
    fn count(mask: Self::Mask) -> Self {
        Self::select(mask, Self::splat(1.0), Self::splat(0.0))
    }

    /// max(0, min(self, `top`)); 0 for NaN.
    #[inline(always)]
    fn clip(self, top: Self) -> Self {
        let raised = self.larger(Self::splat(0.0));
        Self::select(raised.less(top), raised, top)
    }
}

/// A subset of eight cells.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Cell n from bit n.
    fn from_bits(bits: u8) -> Self;

    /// Cell n in bit n.
    fn bits(self) -> u8;
}

/// The number type of a field: `f64` or `f32`.
pub trait Cell: Copy + Default + Into<f64> + Send + Sync + 'static {
    /// The nearest.
    fn nearest(x: f64) -> Self;
    /// Eight of them as `f64`, exactly.
    fn widen<V: F64x8>(cells: [Self; 8]) -> V;
    /// The nearest eight.
    fn narrow<V: F64x8>(eight: V) -> [Self; 8];
}

impl Cell for f64 {
    #[inline(always)]
    fn nearest(x: f64) -> f64 {
        x
    }
    #[inline(always)]
    fn widen<V: F64x8>(cells: [f64; 8]) -> V {
        V::from_array(cells)
    }
    #[inline(always)]
    fn narrow<V: F64x8>(eight: V) -> [f64; 8] {
        eight.to_array()
    }
}

impl Cell for f32 {
    #[inline(always)]
    fn nearest(x: f64) -> f32 {
        x as f32
    }
    #[inline(always)]
    fn widen<V: F64x8>(cells: [f32; 8]) -> V {
        V::from_singles(cells)
    }
    #[inline(always)]
    fn narrow<V: F64x8>(eight: V) -> [f32; 8] {
        eight.to_singles()
    }
}

#[cold]
#[inline(never)]
fn partial<T: Cell>(field: &[T], at: usize, beyond: T) -> [T; 8] {
    let mut cells = [beyond; 8];
    let rest = field.get(at..).unwrap_or_default();
    cells.iter_mut().zip(rest).for_each(|(cell, x)| *cell = *x);
    cells
}

#[cold]
#[inline(never)]
fn store_partial<T: Cell>(field: &mut [T], at: usize, cells: &[T; 8]) {
    let rest = field.get_mut(at..).unwrap_or_default();
    rest.iter_mut().zip(cells).for_each(|(x, cell)| *x = *cell);
}

/// A sweep over cells for any [`F64x8`]. `run`, and everything that it calls, is `#[inline(always)]`.
pub trait Work {
    /// The result of the sweep.
    type Yield;
    /// Does the work.
    fn run<V: F64x8>(self) -> Self::Yield;
}
