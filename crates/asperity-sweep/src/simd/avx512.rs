//! Eight cells in one vector of 512 bits (AVX-512F).

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

use super::vector::{F64x8, Mask, Work};

pub(super) fn run<W: Work>(work: W) -> W::Yield {
    #[target_feature(enable = "avx512f,avx2")]
    fn compiled<W: Work>(work: W) -> W::Yield {
        work.run::<Avx512F64x8>()
    }
    // SAFETY: `vectorize` and `vectorize_on` call this only if AVX-512F and AVX2 were detected.
    unsafe { compiled(work) }
}

#[derive(Clone, Copy)]
pub(super) struct Avx512F64x8(__m512d);

#[derive(Clone, Copy)]
pub(super) struct Avx512Mask(u8);

macro_rules! arithmetic {
    ($($trait:ident $method:ident $intrinsic:ident),+) => {$(
        impl $trait for Avx512F64x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: a `Avx512F64x8` exists only below `run`, where AVX-512F was detected.
                Avx512F64x8(unsafe { $intrinsic(self.0, other.0) })
            }
        }
    )+};
}
arithmetic!(Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd, Div div _mm512_div_pd);

impl F64x8 for Avx512F64x8 {
    type Mask = Avx512Mask;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: called below `run`, where AVX-512F was detected.
        Avx512F64x8(unsafe { _mm512_set1_pd(x) })
    }
    #[inline(always)]
    fn from_array(cells: [f64; 8]) -> Self {
        // SAFETY: as in `splat`; the array holds the eight that are loaded.
        Avx512F64x8(unsafe { _mm512_loadu_pd(cells.as_ptr()) })
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 8] {
        let mut cells = [0.0; 8];
        // SAFETY: as in `splat`; the array takes the eight that are stored.
        unsafe { _mm512_storeu_pd(cells.as_mut_ptr(), self.0) };
        cells
    }
    #[inline(always)]
    fn from_singles(cells: [f32; 8]) -> Self {
        // SAFETY: as in `splat`; the array holds the eight that are loaded.
        Avx512F64x8(unsafe { _mm512_cvtps_pd(_mm256_loadu_ps(cells.as_ptr())) })
    }
    #[inline(always)]
    fn to_singles(self) -> [f32; 8] {
        let mut cells = [0.0; 8];
        // SAFETY: as in `splat`; the array takes the eight that are stored.
        unsafe { _mm256_storeu_ps(cells.as_mut_ptr(), _mm512_cvtpd_ps(self.0)) };
        cells
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: as in `splat`.
        Avx512F64x8(unsafe { _mm512_abs_pd(self.0) })
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: as in `splat`.
        Avx512F64x8(unsafe { _mm512_max_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        // SAFETY: as in `splat`.
        Avx512F64x8(unsafe { _mm512_min_pd(self.0, other.0) })
    }
    #[inline(always)]
    fn less(self, other: Self) -> Avx512Mask {
        // SAFETY: as in `splat`.
        Avx512Mask(unsafe { _mm512_cmp_pd_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Avx512Mask {
        // SAFETY: as in `splat`.
        Avx512Mask(unsafe { _mm512_cmp_pd_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(mask: Avx512Mask, yes: Self, no: Self) -> Self {
        // SAFETY: as in `splat`.
        Avx512F64x8(unsafe { _mm512_mask_blend_pd(mask.0, no.0, yes.0) })
    }
}

impl Mask for Avx512Mask {
    #[inline(always)]
    fn from_bits(bits: u8) -> Self {
        Avx512Mask(bits)
    }
    #[inline(always)]
    fn bits(self) -> u8 {
        self.0
    }
}

macro_rules! bits {
    ($($trait:ident $method:ident),+) => {$(
        impl $trait for Avx512Mask {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Avx512Mask(self.0.$method(other.0))
            }
        }
    )+};
}
bits!(BitAnd bitand, BitOr bitor);

impl Not for Avx512Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Avx512Mask(!self.0)
    }
}
