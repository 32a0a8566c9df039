//! Eight cells in two vectors of 256 bits (AVX2).

use std::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

use super::vector::{F64x8, Mask, Work};

pub(super) fn run<W: Work>(work: W) -> W::Yield {
    #[target_feature(enable = "avx2")]
    fn compiled<W: Work>(work: W) -> W::Yield {
        work.run::<Avx2F64x8>()
    }
    // SAFETY: `vectorize` and `vectorize_on` call this only if AVX2 was detected.
    unsafe { compiled(work) }
}

/// Cells 0..4 and 4..8.
#[derive(Clone, Copy)]
pub(super) struct Avx2F64x8(__m256d, __m256d);

/// All bits of a cell, or none.
#[derive(Clone, Copy)]
pub(super) struct Avx2Mask(__m256d, __m256d);

macro_rules! both {
    ($($trait:ident $method:ident $type:ident $intrinsic:ident),+) => {$(
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: the type exists only below `run`, where AVX2 was detected.
                unsafe { $type($intrinsic(self.0, other.0), $intrinsic(self.1, other.1)) }
            }
        }
    )+};
}
both!(Add add Avx2F64x8 _mm256_add_pd, Sub sub Avx2F64x8 _mm256_sub_pd, Mul mul Avx2F64x8 _mm256_mul_pd);
both!(Div div Avx2F64x8 _mm256_div_pd, BitAnd bitand Avx2Mask _mm256_and_pd, BitOr bitor Avx2Mask _mm256_or_pd);

impl Not for Avx2Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: the type exists only below `run`, where AVX2 was detected.
        unsafe {
            let all = _mm256_castsi256_pd(_mm256_set1_epi64x(-1));
            Avx2Mask(_mm256_xor_pd(self.0, all), _mm256_xor_pd(self.1, all))
        }
    }
}

impl F64x8 for Avx2F64x8 {
    type Mask = Avx2Mask;

    #[inline(always)]
    fn splat(x: f64) -> Self {
        // SAFETY: called below `run`, where AVX2 was detected.
        let half = unsafe { _mm256_set1_pd(x) };
        Avx2F64x8(half, half)
    }
    #[inline(always)]
    fn from_array(cells: [f64; 8]) -> Self {
        // SAFETY: as in `splat`; the array holds the eight that are loaded.
        unsafe { Avx2F64x8(_mm256_loadu_pd(cells.as_ptr()), _mm256_loadu_pd(cells.as_ptr().add(4))) }
    }
    #[inline(always)]
    fn to_array(self) -> [f64; 8] {
        let mut cells = [0.0; 8];
        // SAFETY: as in `splat`; the array takes the eight that are stored.
        unsafe {
            _mm256_storeu_pd(cells.as_mut_ptr(), self.0);
            _mm256_storeu_pd(cells.as_mut_ptr().add(4), self.1);
        }
        cells
    }
    #[inline(always)]
    fn from_singles(cells: [f32; 8]) -> Self {
        // SAFETY: as in `splat`; the array holds the eight that are loaded.
        unsafe {
            let low = _mm_loadu_ps(cells.as_ptr());
            let high = _mm_loadu_ps(cells.as_ptr().add(4));
            Avx2F64x8(_mm256_cvtps_pd(low), _mm256_cvtps_pd(high))
        }
    }
    #[inline(always)]
    fn to_singles(self) -> [f32; 8] {
        let mut cells = [0.0; 8];
        // SAFETY: as in `splat`; the array takes the eight that are stored.
        unsafe {
            _mm_storeu_ps(cells.as_mut_ptr(), _mm256_cvtpd_ps(self.0));
            _mm_storeu_ps(cells.as_mut_ptr().add(4), _mm256_cvtpd_ps(self.1));
        }
        cells
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: as in `splat`.
        unsafe {
            let sign = _mm256_set1_pd(-0.0);
            Avx2F64x8(_mm256_andnot_pd(sign, self.0), _mm256_andnot_pd(sign, self.1))
        }
    }
    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        // SAFETY: as in `splat`.
        unsafe { Avx2F64x8(_mm256_max_pd(self.0, other.0), _mm256_max_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        // SAFETY: as in `splat`.
        unsafe { Avx2F64x8(_mm256_min_pd(self.0, other.0), _mm256_min_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn less(self, other: Self) -> Avx2Mask {
        // SAFETY: as in `splat`.
        unsafe {
            Avx2Mask(
                _mm256_cmp_pd::<_CMP_LT_OQ>(self.0, other.0),
                _mm256_cmp_pd::<_CMP_LT_OQ>(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn at_most(self, other: Self) -> Avx2Mask {
        // SAFETY: as in `splat`.
        unsafe {
            Avx2Mask(
                _mm256_cmp_pd::<_CMP_LE_OQ>(self.0, other.0),
                _mm256_cmp_pd::<_CMP_LE_OQ>(self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn select(mask: Avx2Mask, yes: Self, no: Self) -> Self {
        // SAFETY: as in `splat`.
        unsafe { Avx2F64x8(_mm256_blendv_pd(no.0, yes.0, mask.0), _mm256_blendv_pd(no.1, yes.1, mask.1)) }
    }
}

impl Mask for Avx2Mask {
    #[inline(always)]
    fn from_bits(bits: u8) -> Self {
        // SAFETY: called below `run`, where AVX2 was detected.
        unsafe {
            let every = _mm256_set1_epi64x(i64::from(bits));
            let of = |weights: __m256i| {
                _mm256_castsi256_pd(_mm256_cmpeq_epi64(_mm256_and_si256(every, weights), weights))
            };
            Avx2Mask(of(_mm256_setr_epi64x(1, 2, 4, 8)), of(_mm256_setr_epi64x(16, 32, 64, 128)))
        }
    }
    #[inline(always)]
    fn bits(self) -> u8 {
        // SAFETY: as in `from_bits`.
        let (low, high) = unsafe { (_mm256_movemask_pd(self.0), _mm256_movemask_pd(self.1)) };
        (low | high << 4) as u8
    }
}
