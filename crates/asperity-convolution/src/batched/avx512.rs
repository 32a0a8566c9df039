//! Lanes of 512 bits: AVX-512F.

use std::arch::x86_64::*;
use std::ops::{Add, Mul, Sub};

use super::avx2::transpose_8x8;
use super::vector::{Kernel, Vector, tile_end};

/// Eight f64.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F64x8(__m512d);

/// Sixteen f32.
#[derive(Clone, Copy)]
#[repr(transparent)]
pub struct F32x16(__m512);

/// Declares the arithmetic, given the names of the intrinsics.
macro_rules! arithmetic {
    ($vector:ident, $add:ident, $sub:ident, $mul:ident) => {
        impl Add for $vector {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                // SAFETY: plans with this vector are made where AVX-512F was detected.
                $vector(unsafe { $add(self.0, other.0) })
            }
        }

        impl Sub for $vector {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                // SAFETY: plans with this vector are made where AVX-512F was detected.
                $vector(unsafe { $sub(self.0, other.0) })
            }
        }

        impl Mul for $vector {
            type Output = Self;
            #[inline(always)]
            fn mul(self, other: Self) -> Self {
                // SAFETY: plans with this vector are made where AVX-512F was detected.
                $vector(unsafe { $mul(self.0, other.0) })
            }
        }
    };
}

arithmetic!(F64x8, _mm512_add_pd, _mm512_sub_pd, _mm512_mul_pd);
arithmetic!(F32x16, _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps);

/// Declares splat, the fused products and the entry point, given the names of the intrinsics.
macro_rules! lane_methods {
    ($vector:ident, $scalar:ty, $splat:ident, $fmadd:ident, $fnmadd:ident) => {
        type Scalar = $scalar;
        const LANES: usize = size_of::<$vector>() / size_of::<$scalar>();

        #[inline(always)]
        fn splat(x: $scalar) -> Self {
            // SAFETY: plans with this vector are made where AVX-512F was detected.
            $vector(unsafe { $splat(x) })
        }

        #[inline(always)]
        fn mul_add(self, b: Self, c: Self) -> Self {
            // SAFETY: plans with this vector are made where AVX-512F was detected.
            $vector(unsafe { $fmadd(self.0, b.0, c.0) })
        }

        #[inline(always)]
        fn neg_mul_add(self, b: Self, c: Self) -> Self {
            // SAFETY: plans with this vector are made where AVX-512F was detected.
            $vector(unsafe { $fnmadd(self.0, b.0, c.0) })
        }

        #[inline(always)]
        fn vectorize(kernel: impl Kernel) {
            #[target_feature(enable = "avx512f,avx2,fma")]
            fn compiled(kernel: impl Kernel) {
                kernel.run();
            }
            // SAFETY: plans with this vector are made where AVX-512F, AVX2 and FMA were detected.
            unsafe { compiled(kernel) }
        }
    };
}

// SAFETY: __m512d is eight f64.
unsafe impl Vector for F64x8 {
    lane_methods!(F64x8, f64, _mm512_set1_pd, _mm512_fmadd_pd, _mm512_fnmadd_pd);

    #[inline(always)]
    fn transpose(from: &[f64], from_stride: usize, to: &mut [f64], to_stride: usize) {
        assert!(from.len() >= tile_end(8, from_stride) && to.len() >= tile_end(8, to_stride));
        // SAFETY: AVX-512F was detected; the assertion bounds every row that is loaded or stored.
        unsafe {
            let from = from.as_ptr();
            let to = to.as_mut_ptr();
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
}

// SAFETY: __m512 is sixteen f32.
unsafe impl Vector for F32x16 {
    lane_methods!(F32x16, f32, _mm512_set1_ps, _mm512_fmadd_ps, _mm512_fnmadd_ps);

    #[inline(always)]
    fn transpose(from: &[f32], from_stride: usize, to: &mut [f32], to_stride: usize) {
        assert!(from.len() >= tile_end(16, from_stride) && to.len() >= tile_end(16, to_stride));
        for i in [0, 8] {
            for j in [0, 8] {
                // SAFETY: AVX was detected; the assertion bounds the four 8 x 8 blocks.
                unsafe {
                    let from = from.as_ptr().add(i * from_stride + j);
                    let to = to.as_mut_ptr().add(j * to_stride + i);
                    transpose_8x8(from, from_stride, to, to_stride);
                }
            }
        }
    }
}
