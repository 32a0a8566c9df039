//! Eight cells in plain Rust: the reference for the vectors.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

use super::vector::{F64x8, Mask, Work};

pub(super) fn run<W: Work>(work: W) -> W::Yield {
    work.run::<PortableF64x8>()
}

#[derive(Clone, Copy)]
pub(super) struct PortableF64x8([f64; 8]);

#[derive(Clone, Copy)]
pub(super) struct PortableMask([bool; 8]);

macro_rules! both {
    ($($trait:ident $method:ident $type:ident),+) => {$(
        impl $trait for $type {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $type(std::array::from_fn(|i| self.0[i].$method(other.0[i])))
            }
        }
    )+};
}
both!(Add add PortableF64x8, Sub sub PortableF64x8, Mul mul PortableF64x8, Div div PortableF64x8);
both!(BitAnd bitand PortableMask, BitOr bitor PortableMask);

impl F64x8 for PortableF64x8 {
    type Mask = PortableMask;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        PortableF64x8([x; 8])
    }
    #[inline(always)]
    fn from_array(cells: [f64; 8]) -> Self {
        PortableF64x8(cells)
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 8] {
        self.0
    }
    #[inline(always)]
    fn from_singles(cells: [f32; 8]) -> Self {
        PortableF64x8(cells.map(f64::from))
    }
    #[inline(always)]
    fn to_singles(self) -> [f32; 8] {
        self.0.map(|x| x as f32)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        PortableF64x8(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        PortableF64x8(std::array::from_fn(|i| if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        PortableF64x8(std::array::from_fn(|i| if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn less(self, other: Self) -> PortableMask {
        PortableMask(std::array::from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> PortableMask {
        PortableMask(std::array::from_fn(|i| self.0[i] <= other.0[i]))
    }
    #[inline(always)]
    fn select(mask: PortableMask, yes: Self, no: Self) -> Self {
        PortableF64x8(std::array::from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

impl Mask for PortableMask {
    #[inline(always)]
    fn from_bits(bits: u8) -> Self {
        PortableMask(std::array::from_fn(|i| bits >> i & 1 == 1))
    }
    #[inline(always)]
    fn bits(self) -> u8 {
        self.0.iter().rev().fold(0, |bits, on| bits << 1 | u8::from(*on))
    }
}

impl Not for PortableMask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        PortableMask(self.0.map(|on| !on))
    }
}
