//! Eight cells in plain Rust: the truth that the vectors are compared with.

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

use super::{Eight, Mask, Work};

pub(super) fn run<W: Work>(work: W) -> W::Yield {
    work.run::<Plain>()
}

#[derive(Clone, Copy)]
pub(super) struct Plain([f64; 8]);

#[derive(Clone, Copy)]
pub(super) struct Bits([bool; 8]);

macro_rules! arithmetic {
    ($($trait:ident $method:ident),+) => {$(
        impl $trait for Plain {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Plain(std::array::from_fn(|i| self.0[i].$method(other.0[i])))
            }
        }
    )+};
}
arithmetic!(Add add, Sub sub, Mul mul, Div div);

impl Eight for Plain {
    type Mask = Bits;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        Plain([x; 8])
    }
    #[inline(always)]
    fn from_array(cells: [f64; 8]) -> Self {
        Plain(cells)
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 8] {
        self.0
    }
    #[inline(always)]
    fn from_singles(cells: [f32; 8]) -> Self {
        Plain(cells.map(f64::from))
    }
    #[inline(always)]
    fn to_singles(self) -> [f32; 8] {
        self.0.map(|x| x as f32)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Plain(self.0.map(f64::abs))
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        Plain(std::array::from_fn(|i| if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        Plain(std::array::from_fn(|i| if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline(always)]
    fn less(self, other: Self) -> Bits {
        Bits(std::array::from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Bits {
        Bits(std::array::from_fn(|i| self.0[i] <= other.0[i]))
    }
    #[inline(always)]
    fn select(mask: Bits, yes: Self, no: Self) -> Self {
        Plain(std::array::from_fn(|i| if mask.0[i] { yes.0[i] } else { no.0[i] }))
    }
}

impl Mask for Bits {
    #[inline(always)]
    fn from_bits(bits: u8) -> Self {
        Bits(std::array::from_fn(|i| bits >> i & 1 == 1))
    }
    #[inline(always)]
    fn bits(self) -> u8 {
        self.0.iter().rev().fold(0, |bits, on| bits << 1 | u8::from(*on))
    }
}

impl BitAnd for Bits {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Bits(std::array::from_fn(|i| self.0[i] & other.0[i]))
    }
}

impl BitOr for Bits {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Bits(std::array::from_fn(|i| self.0[i] | other.0[i]))
    }
}

impl Not for Bits {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Bits(self.0.map(|on| !on))
    }
}
