//! Lanes of 256 bits: AVX2 and FMA.

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

use super::vector::{Kernel, Vector, tile_end};

/// Four f64.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x4(__m256d);

/// Eight f32.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F32x8(__m256);

/// Declares the arithmetic, given the names of the intrinsics.
macro_rules! arithmetic {
    ($vector:ident, $add:ident, $sub:ident, $mul:ident) => {
        impl Add for $vector {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                // SAFETY: plans with this vector are made where AVX2 and FMA were detected.
                $vector(unsafe { $add(self.0, other.0) })
            }
        }

        impl Sub for $vector {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                // SAFETY: plans with this vector are made where AVX2 and FMA were detected.
                $vector(unsafe { $sub(self.0, other.0) })
            }
        }

        impl Mul for $vector {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                // SAFETY: plans with this vector are made where AVX2 and FMA were detected.
                $vector(unsafe { $mul(self.0, other.0) })
            }
        }
    };
}

arithmetic!(F64x4, _mm256_add_pd, _mm256_sub_pd, _mm256_mul_pd);
arithmetic!(F32x8, _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps);

/// Declares splat, the fused products and the entry point, given the names of the intrinsics.
macro_rules! lane_methods {
    ($vector:ident, $scalar:ty, $splat:ident, $fmadd:ident, $fnmadd:ident) => {
        type Scalar = $scalar;
        const LANES: usize = size_of::<$vector>() / size_of::<$scalar>();

        #[inline(always)]
        fn splat(x: $scalar) -> Self {
            // SAFETY: plans with this vector are made where AVX2 and FMA were detected.
            $vector(unsafe { $splat(x) })
        }

        #[inline(always)]
        fn mul_add(self, b: Self, c: Self) -> Self {
            // SAFETY: plans with this vector are made where AVX2 and FMA were detected.
            $vector(unsafe { $fmadd(self.0, b.0, c.0) })
        }

        #[inline(always)]
        fn neg_mul_add(self, b: Self, c: Self) -> Self {
            // SAFETY: plans with this vector are made where AVX2 and FMA were detected.
            $vector(unsafe { $fnmadd(self.0, b.0, c.0) })
        }

        #[inline(always)]
        fn vectorize(kernel: impl Kernel) {
            #[target_feature(enable = "avx2,fma")]
            fn compiled(kernel: impl Kernel) {
                kernel.run();
            }
            // SAFETY: plans with this vector are made where AVX2 and FMA were detected.
            unsafe { compiled(kernel) }
        }
    };
}

// SAFETY: __m256d is four f64.
unsafe impl Vector for F64x4 {
    lane_methods!(F64x4, f64, _mm256_set1_pd, _mm256_fmadd_pd, _mm256_fnmadd_pd);

    #[inline(always)]
    fn transpose(from: &[f64], from_stride: usize, to: &mut [f64], to_stride: usize) {
        assert!(from.len() >= tile_end(4, from_stride) && to.len() >= tile_end(4, to_stride));
        // SAFETY: AVX was detected; the assertion bounds every row that is loaded or stored.
        unsafe {
            let row = |i: usize| _mm256_loadu_pd(from.as_ptr().add(i * from_stride));
            let (a, b, c, d) = (row(0), row(1), row(2), row(3));
            let (ab0, ab1) = (_mm256_unpacklo_pd(a, b), _mm256_unpackhi_pd(a, b));
            let (cd0, cd1) = (_mm256_unpacklo_pd(c, d), _mm256_unpackhi_pd(c, d));
            let to = to.as_mut_ptr();
            _mm256_storeu_pd(to, _mm256_permute2f128_pd::<0x20>(ab0, cd0));
            _mm256_storeu_pd(to.add(to_stride), _mm256_permute2f128_pd::<0x20>(ab1, cd1));
            _mm256_storeu_pd(to.add(2 * to_stride), _mm256_permute2f128_pd::<0x31>(ab0, cd0));
            _mm256_storeu_pd(to.add(3 * to_stride), _mm256_permute2f128_pd::<0x31>(ab1, cd1));
        }
    }
}

// SAFETY: __m256 is eight f32.
unsafe impl Vector for F32x8 {
    lane_methods!(F32x8, f32, _mm256_set1_ps, _mm256_fmadd_ps, _mm256_fnmadd_ps);

    #[inline(always)]
    fn transpose(from: &[f32], from_stride: usize, to: &mut [f32], to_stride: usize) {
        assert!(from.len() >= tile_end(8, from_stride) && to.len() >= tile_end(8, to_stride));
        // SAFETY: AVX was detected; the assertion bounds every row that is loaded or stored.
        unsafe { transpose_8x8(from.as_ptr(), from_stride, to.as_mut_ptr(), to_stride) }
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
