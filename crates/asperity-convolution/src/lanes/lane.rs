//! A vector of lanes: the same operation on a few independent numbers.
//!
//! Lanes never mix: lane n holds row (or column) n of a block, so a transform of the block is the
//! scalar transform with every number replaced by a vector. Each operation rounds as IEEE 754 says,
//! hence every implementation, of any width, gives the same bits.

use std::fmt::Debug;
use std::ops::{Add, Mul, Sub};

use super::portable::Portable;
#[cfg(target_arch = "x86_64")]
use super::{avx2, avx512};

/// The scalars that the engine computes with: `f64` and `f32`.
pub trait Real: sealed::Sealed + Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// Lanes on any processor.
    type Portable: Lane<Scalar = Self>;
    /// Lanes of 256 bits, fused multiply-add.
    #[cfg(target_arch = "x86_64")]
    type Avx2: Lane<Scalar = Self>;
    /// Lanes of 512 bits.
    #[cfg(target_arch = "x86_64")]
    type Avx512: Lane<Scalar = Self>;

    /// The nearest scalar.
    fn nearest(x: f64) -> Self;
    /// The same number.
    fn widened(self) -> f64;
}

mod sealed {
    use asperity_sweep::Instructions;
    use ndarray::ArrayView2;

    use super::super::engine::{Convolve, plan};
    use super::super::factors::Factors;

    /// The scalars, and the engine of each. The engine is compiled here, and not with every crate that plans one.
    pub trait Sealed: Sized {
        /// The engine in the lanes of an instruction set that is available.
        fn plan(
            instructions: Instructions,
            cells: [usize; 2],
            lengths: [usize; 2],
            factors: [&Factors; 2],
            spectra: &[ArrayView2<f64>],
        ) -> Box<dyn Convolve<Self>>;
    }

    macro_rules! compiled {
        ($scalar:ty) => {
            impl Sealed for $scalar {
                #[inline(never)]
                fn plan(
                    instructions: Instructions,
                    cells: [usize; 2],
                    lengths: [usize; 2],
                    factors: [&Factors; 2],
                    spectra: &[ArrayView2<f64>],
                ) -> Box<dyn Convolve<Self>> {
                    plan::<$scalar>(instructions, cells, lengths, factors, spectra)
                }
            }
        };
    }
    compiled!(f64);
    compiled!(f32);
}

impl Real for f64 {
    type Portable = Portable<f64, 4>;
    #[cfg(target_arch = "x86_64")]
    type Avx2 = avx2::F64x4;
    #[cfg(target_arch = "x86_64")]
    type Avx512 = avx512::F64x8;

    #[inline(always)]
    fn nearest(x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn widened(self) -> f64 {
        self
    }
}

impl Real for f32 {
    type Portable = Portable<f32, 8>;
    #[cfg(target_arch = "x86_64")]
    type Avx2 = avx2::F32x8;
    #[cfg(target_arch = "x86_64")]
    type Avx512 = avx512::F32x16;

    #[inline(always)]
    fn nearest(x: f64) -> f32 {
        x as f32
    }

    #[inline(always)]
    fn widened(self) -> f64 {
        self.into()
    }
}

/// The most lanes of any implementation.
pub const MAX_LANES: usize = 16;

/// A vector of `LANES` scalars.
///
/// # Safety
/// The type has the layout of `[Scalar; LANES]` (its alignment may be stricter), any bit pattern of
/// it is valid, and `LANES` is even and at most [`MAX_LANES`]. Where it needs instructions that not
/// every processor has, the engine plans with it only after detecting them (`Instructions`).
pub unsafe trait Lane:
    Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + 'static
{
    /// What one lane holds.
    type Scalar: Real;
    /// How many lanes there are.
    const LANES: usize;

    /// x in every lane.
    fn splat(x: Self::Scalar) -> Self;
    /// self b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// self b - c, rounded once.
    fn mul_sub(self, b: Self, c: Self) -> Self;
    /// c - self b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;

    /// to\[j, i\] = from\[i, j\] for `LANES` x `LANES` scalars; the rows of either side are a stride apart.
    ///
    /// # Panics
    /// Where a side is shorter than its last row's end.
    fn transpose(from: &[Self::Scalar], from_stride: usize, to: &mut [Self::Scalar], to_stride: usize);

    /// The lanes, one by one.
    #[inline(always)]
    fn scalars_mut(&mut self) -> &mut [Self::Scalar] {
        // SAFETY: a lane has the layout of LANES scalars, and any bit pattern of it is valid.
        unsafe { std::slice::from_raw_parts_mut(std::ptr::from_mut(self).cast(), Self::LANES) }
    }

    /// Runs `kernel` compiled for the instructions of this lane.
    fn vectorize(kernel: impl Kernel);
}

/// Work that [`Lane::vectorize`] compiles for a processor: `run` and all that it calls is
/// `#[inline(always)]`.
pub trait Kernel {
    /// Does it.
    fn run(self);
}

/// Where the last of `lanes` rows ends: what [`Lane::transpose`] reads and writes at most.
#[inline(always)]
pub fn tile_end(lanes: usize, stride: usize) -> usize {
    (lanes - 1) * stride + lanes
}
