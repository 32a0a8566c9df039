//! Lanes of 512 bits: AVX-512F.

use std::arch::x86_64::*;

use super::avx2::transpose_8x8;
use super::intrinsics::vector;

vector! {
    /// Eight f64.
    F64x8(__m512d): 8 of f64, with "avx512f,avx2,fma",
    splat: _mm512_set1_pd, mul_add: _mm512_fmadd_pd, neg_mul_add: _mm512_fnmadd_pd, transpose: transpose_f64,
    Add add: _mm512_add_pd, Sub sub: _mm512_sub_pd, Mul mul: _mm512_mul_pd
}

vector! {
    /// Sixteen f32.
    F32x16(__m512): 16 of f32, with "avx512f,avx2,fma",
    splat: _mm512_set1_ps, mul_add: _mm512_fmadd_ps, neg_mul_add: _mm512_fnmadd_ps, transpose: transpose_f32,
    Add add: _mm512_add_ps, Sub sub: _mm512_sub_ps, Mul mul: _mm512_mul_ps
}

/// The 8 x 8 transpose in f64.
///
/// # Safety
/// AVX-512F must be available; eight rows of eight scalars, a stride apart, must be readable at `from` and writable at `to`.
#[inline(always)]
unsafe fn transpose_f64(from: *const f64, from_stride: usize, to: *mut f64, to_stride: usize) {
    // SAFETY: as the caller promises.
    unsafe {
        // Columns c..c+4 of rows i and i + 4: the loads already exchange the 4 x 4 blocks.
        let rows = |i: usize, c: usize| {
            let near = _mm512_castpd256_pd512(_mm256_loadu_pd(from.add(i * from_stride + c)));
            _mm512_insertf64x4::<1>(near, _mm256_loadu_pd(from.add((i + 4) * from_stride + c)))
        };
        let first = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13);
        let second = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
        for c in [0, 4] {
            let (a, b, e, d) = (rows(0, c), rows(1, c), rows(2, c), rows(3, c));
            let (ab0, ab1) = (_mm512_unpacklo_pd(a, b), _mm512_unpackhi_pd(a, b));
            let (ed0, ed1) = (_mm512_unpacklo_pd(e, d), _mm512_unpackhi_pd(e, d));
            let store = |k: usize, v: __m512d| _mm512_storeu_pd(to.add((c + k) * to_stride), v);
            store(0, _mm512_permutex2var_pd(ab0, first, ed0));
            store(1, _mm512_permutex2var_pd(ab1, first, ed1));
            store(2, _mm512_permutex2var_pd(ab0, second, ed0));
            store(3, _mm512_permutex2var_pd(ab1, second, ed1));
        }
    }
}

/// The 16 x 16 transpose in f32, in four blocks of 8 x 8.
///
/// # Safety
/// AVX must be available; sixteen rows of sixteen scalars, a stride apart, must be readable at `from` and writable at `to`.
#[inline(always)]
unsafe fn transpose_f32(from: *const f32, from_stride: usize, to: *mut f32, to_stride: usize) {
    for i in [0, 8] {
        for j in [0, 8] {
            // SAFETY: as the caller promises.
            unsafe {
                transpose_8x8(
                    from.add(i * from_stride + j),
                    from_stride,
                    to.add(j * to_stride + i),
                    to_stride,
                );
            }
        }
    }
}
