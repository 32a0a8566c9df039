//! Sweeps over fields, eight cells at a time: one formula, compiled for every instruction set.
//!
//! A formula that is generic over [`F64x8`] reads like the scalar one; [`vectorize`] runs it in the widest vectors that the
//! processor has (one of 512 bits, two of 256 bits, or plain Rust). On all of them, sums run in eight lanes, cell n in lane n mod
//! 8, and nothing is contracted to fused multiply-adds, so the bits are the same on every processor.
//!
//! Loads and stores take the position of the first cell. Beyond the end of a field a load gives a chosen value and a store writes
//! nothing, so a field of any length is processed in steps of eight.
//!
//! Sets of cells are bits, one byte for eight cells: `set[n / 8] >> (n % 8) & 1`.
//!
//! ```
//! use asperity_sweep::simd::{F64x8, Work, vectorize};
//!
//! /// sum of max(p, 0)
//! struct Pushing<'a>(&'a [f64]);
//! impl Work for Pushing<'_> {
//!     type Yield = f64;
//!     #[inline(always)]
//!     fn run<V: F64x8>(self) -> f64 {
//!         let mut sum = V::splat(0.0);
//!         for n in (0..self.0.len()).step_by(8) {
//!             sum = sum + V::load(self.0, n, 0.0).larger(V::splat(0.0));
//!         }
//!         sum.sum()
//!     }
//! }
//! assert_eq!(vectorize(Pushing(&[1.0, -2.0, 3.0])), 4.0);
//! ```
//!
//! `unsafe` is used for the intrinsics, which need a suitable processor, and for loads and stores whose bounds were checked
//! immediately before.
#![allow(unsafe_code)]

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod dispatch;
mod portable;
#[cfg(test)]
mod tests;
mod vector;

pub use dispatch::{vectorize, vectorize_on};
pub use vector::{Cell, F64x8, Mask, Work};
