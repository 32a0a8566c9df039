//! Lanes of 256 bits: AVX2 and FMA.

use std::arch::x86_64::*;

use super::intrinsics::vector;

vector! {
    /// Four f64.
    F64x4(__m256d): 4 of f64, with "avx2,fma",
    splat: _mm256_set1_pd, mul_add: _mm256_fmadd_pd, neg_mul_add: _mm256_fnmadd_pd, transpose: transpose_4x4,
    Add add: _mm256_add_pd, Sub sub: _mm256_sub_pd, Mul mul: _mm256_mul_pd
}

vector! {
    /// Eight f32.
    F32x8(__m256): 8 of f32, with "avx2,fma",
    splat: _mm256_set1_ps, mul_add: _mm256_fmadd_ps, neg_mul_add: _mm256_fnmadd_ps, transpose: transpose_8x8,
    Add add: _mm256_add_ps, Sub sub: _mm256_sub_ps, Mul mul: _mm256_mul_ps
}

/// The 4 x 4 transpose in f64: pairs, then halves.
///
/// # Safety
/// AVX must be available; four rows of four scalars, a stride apart, must be readable at `from` and writable at `to`.
#[inline(always)]
unsafe fn transpose_4x4(from: *const f64, from_stride: usize, to: *mut f64, to_stride: usize) {
    // SAFETY: as the caller promises.
    unsafe {
        let row = |i: usize| _mm256_loadu_pd(from.add(i * from_stride));
        let (a, b, c, d) = (row(0), row(1), row(2), row(3));
        let (ab0, ab1) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
        let (cd0, cd1) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
        _mm256_storeu_pd(to, _mm256_permute2f128_pd::<0x20>(ab0, cd0));
        _mm256_storeu_pd(to.add(to_stride), _mm256_permute2f128_pd::<0x20>(ab1, cd1));
        _mm256_storeu_pd(to.add(2 * to_stride), _mm256_permute2f128_pd::<0x31>(ab0, cd0));
        _mm256_storeu_pd(to.add(3 * to_stride), _mm256_permute2f128_pd::<0x31>(ab1, cd1));
    }
}

/// The 8 x 8 transpose in f32: pairs, then fours, then halves.
///
/// # Safety
/// AVX must be available; eight rows of eight scalars, a stride apart, must be readable at `from` and writable at `to`.
#[inline(always)]
pub unsafe fn transpose_8x8(from: *const f32, from_stride: usize, to: *mut f32, to_stride: usize) {
    // SAFETY: as the caller promises.
    unsafe {
        let row = |i: usize| _mm256_loadu_ps(from.add(i * from_stride));
        // Columns 0, 1, 4, 5 and 2, 3, 6, 7 of rows i and i + 1, interleaved.
        let low = |i: usize| _mm256_unpacklo_ps(row(i), row(i + 1));
        let high = |i: usize| _mm256_unpackhi_ps(row(i), row(i + 1));
        let (l0, l2, l4, l6) = (low(0), low(2), low(4), low(6));
        let (h0, h2, h4, h6) = (high(0), high(2), high(4), high(6));
        // Columns c and c + 4 of four rows.
        let top = [
            _mm256_shuffle_ps::<0x44>(l0, l2),
            _mm256_shuffle_ps::<0xEE>(l0, l2),
            _mm256_shuffle_ps::<0x44>(h0, h2),
            _mm256_shuffle_ps::<0xEE>(h0, h2),
        ];
        let bottom = [
            _mm256_shuffle_ps::<0x44>(l4, l6),
            _mm256_shuffle_ps::<0xEE>(l4, l6),
            _mm256_shuffle_ps::<0x44>(h4, h6),
            _mm256_shuffle_ps::<0xEE>(h4, h6),
        ];
        for c in 0..4 {
            let near = _mm256_permute2f128_ps::<0x20>(top[c], bottom[c]);
            let far = _mm256_permute2f128_ps::<0x31>(top[c], bottom[c]);
            _mm256_storeu_ps(to.add(c * to_stride), near);
            _mm256_storeu_ps(to.add((c + 4) * to_stride), far);
        }
    }
}
