//! The declaration of the vectors of an instruction set, from the names of its intrinsics.

/// Declares a [`Vector`](super::vector::Vector): the register that it wraps, its lanes, the instructions that a plan detects before
/// it uses the vector, the intrinsic of each operation, and the function that transposes a square tile.
macro_rules! vector {
    (
        $(#[$doc:meta])*
        $vector:ident($register:ty): $lanes:literal of $scalar:ty, with $instructions:literal,
        splat: $splat:ident, mul_add: $mul_add:ident, neg_mul_add: $neg_mul_add:ident, transpose: $transpose:ident,
        $($operator:ident $operate:ident: $intrinsic:ident),+
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct $vector($register);

        $(impl std::ops::$operator for $vector {
            type Output = Self;

            #[inline(always)]
            fn $operate(self, other: Self) -> Self {
                // SAFETY: plans with this vector are made only after its instructions were detected.
                $vector(unsafe { $intrinsic(self.0, other.0) })
            }
        })+

        // SAFETY: the register has the layout of its lanes.
        unsafe impl $crate::batched::vector::Vector for $vector {
            type Scalar = $scalar;
            const LANES: usize = $lanes;

            #[inline(always)]
            fn splat(x: $scalar) -> Self {
                // SAFETY: plans with this vector are made only after its instructions were detected.
                $vector(unsafe { $splat(x) })
            }

            #[inline(always)]
            fn mul_add(self, b: Self, c: Self) -> Self {
                // SAFETY: as in `splat`.
                $vector(unsafe { $mul_add(self.0, b.0, c.0) })
            }

            #[inline(always)]
            fn neg_mul_add(self, b: Self, c: Self) -> Self {
                // SAFETY: as in `splat`.
                $vector(unsafe { $neg_mul_add(self.0, b.0, c.0) })
            }

            #[inline(always)]
            fn transpose(from: &[$scalar], from_stride: usize, to: &mut [$scalar], to_stride: usize) {
                let end = |stride| $crate::batched::vector::tile_end($lanes, stride);
                assert!(from.len() >= end(from_stride) && to.len() >= end(to_stride));
                // SAFETY: as in `splat`; the assertion bounds every row that is loaded or stored.
                unsafe { $transpose(from.as_ptr(), from_stride, to.as_mut_ptr(), to_stride) }
            }

            #[inline(always)]
            fn vectorize(kernel: impl $crate::batched::vector::Kernel) {
                #[target_feature(enable = $instructions)]
                fn compiled(kernel: impl $crate::batched::vector::Kernel) {
                    kernel.run();
                }
                // SAFETY: as in `splat`.
                unsafe { compiled(kernel) }
            }
        }
    };
}

pub(super) use vector;
