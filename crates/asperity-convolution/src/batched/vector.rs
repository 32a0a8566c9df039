//! A vector of lanes: it applies the same operation to a few independent numbers.
//!
//! Lanes never mix: lane n holds row (or column) n of a block, so a transform of the block is the scalar transform with every
//! number replaced by a vector. Each operation rounds according to IEEE 754, so every implementation, of any width, gives the
//! same bits.

use std::fmt::Debug;
use std::ops::{Add, Mul, Sub};

/// What one lane holds: `f64` or `f32`.
pub trait Scalar: Copy + Debug + Default + PartialEq + Send + Sync + 'static {
    /// The nearest scalar.
    fn nearest(x: f64) -> Self;
    /// The same number.
    fn widened(self) -> f64;
}

impl Scalar for f64 {
    #[inline(always)]
    fn nearest(x: f64) -> f64 {
        x
    }

    #[inline(always)]
    fn widened(self) -> f64 {
        self
    }
}

impl Scalar for f32 {
    #[inline(always)]
    fn nearest(x: f64) -> f32 {
        x as f32
    }

    #[inline(always)]
    fn widened(self) -> f64 {
        self.into()
    }
}

/// Largest number of lanes of any implementation.
pub const MAX_LANES: usize = 16;

/// A vector of `LANES` scalars.
///
/// # Safety
/// The type has the layout of `[Scalar; LANES]` (its alignment may be stricter), any bit pattern of it is valid, and `LANES` is
/// even and at most [`MAX_LANES`]. If it needs instructions that not every processor has, the engine uses it only after detecting
/// them (`Instructions`).
pub unsafe trait Vector:
    Copy + Send + Sync + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + 'static
{
    /// What one lane holds.
    type Scalar: Scalar;
    /// Number of lanes.
    const LANES: usize;

    /// x in every lane.
    fn splat(x: Self::Scalar) -> Self;
    /// self b + c, rounded once.
    fn mul_add(self, b: Self, c: Self) -> Self;
    /// c - self b, rounded once.
    fn neg_mul_add(self, b: Self, c: Self) -> Self;

    /// to\[j, i\] = from\[i, j\] for `LANES` x `LANES` scalars; the rows of either side are a stride apart.
    ///
    /// # Panics
    /// If a side ends before its last row.
    fn transpose(from: &[Self::Scalar], from_stride: usize, to: &mut [Self::Scalar], to_stride: usize);

    /// The lanes, one by one.
    #[inline(always)]
    fn scalars_mut(&mut self) -> &mut [Self::Scalar] {
        // SAFETY: a lane has the layout of LANES scalars, and any bit pattern of it is valid.
        unsafe { std::slice::from_raw_parts_mut(std::ptr::from_mut(self).cast(), Self::LANES) }
    }

    /// Runs `kernel` compiled for the instructions of this vector.
    fn vectorize(kernel: impl Kernel);
}

/// Work that [`Vector::vectorize`] compiles for a processor: `run` and everything that it calls is `#[inline(always)]`.
pub trait Kernel {
    /// Does the work.
    fn run(self);
}

/// End of the last of `lanes` rows, up to which [`Vector::transpose`] reads and writes.
#[inline(always)]
pub fn tile_end(lanes: usize, stride: usize) -> usize {
    (lanes - 1) * stride + lanes
}
