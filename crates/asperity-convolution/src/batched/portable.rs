//! Lanes in plain Rust. They are the reference for the other vectors, and are compiled to NEON on aarch64, where the compiler
//! vectorises the loops and `mul_add` is an instruction.
//!
//! Without such an instruction (x86-64 processors older than 2013), `mul_add` is a correctly rounded library call, which is slow
//! but gives the same bits. If inlined everywhere, these calls would be half of the code of the crate.

use std::ops::{Add, Mul, Sub};

use super::vector::{Kernel, Scalar, Vector, tile_end};

/// N scalars.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Portable<T, const N: usize>([T; N]);

macro_rules! portable {
    ($scalar:ty, $($operator:ident $operate:ident),+) => {
        $(impl<const N: usize> $operator for Portable<$scalar, N> {
            type Output = Self;

            #[inline(always)]
            fn $operate(self, other: Self) -> Self {
                Portable(std::array::from_fn(|i| self.0[i].$operate(other.0[i])))
            }
        })+

        // SAFETY: a transparent array of scalars, on which every operation is plain Rust.
        unsafe impl<const N: usize> Vector for Portable<$scalar, N>
        where
            $scalar: Scalar,
        {
            type Scalar = $scalar;
            const LANES: usize = N;

            #[inline(always)]
            fn splat(x: $scalar) -> Self {
                Portable([x; N])
            }

            #[cfg_attr(target_arch = "x86_64", inline(never))]
            #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
            fn mul_add(self, b: Self, c: Self) -> Self {
                Portable(std::array::from_fn(|i| self.0[i].mul_add(b.0[i], c.0[i])))
            }

            #[cfg_attr(target_arch = "x86_64", inline(never))]
            #[cfg_attr(not(target_arch = "x86_64"), inline(always))]
            fn neg_mul_add(self, b: Self, c: Self) -> Self {
                Portable(std::array::from_fn(|i| (-self.0[i]).mul_add(b.0[i], c.0[i])))
            }

            #[inline(always)]
            fn transpose(from: &[$scalar], from_stride: usize, to: &mut [$scalar], to_stride: usize) {
                assert!(from.len() >= tile_end(N, from_stride) && to.len() >= tile_end(N, to_stride));
                for i in 0..N {
                    for j in 0..N {
                        to[j * to_stride + i] = from[i * from_stride + j];
                    }
                }
            }

            #[inline(never)]
            fn vectorize(kernel: impl Kernel) {
                kernel.run();
            }
        }
    };
}

portable!(f64, Add add, Sub sub, Mul mul);
portable!(f32, Add add, Sub sub, Mul mul);
