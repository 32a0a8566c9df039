//! Sweeps over fields: several arrays of cells are processed together, in parallel, and the order of sums never depends on the
//! number of threads.
//!
//! A sweep halves its arrays down to blocks of [`BLOCK`] cells, works on each block, and merges the blocks' sums pairwise up the
//! same tree. The tree depends only on the length, so the same field gives the same bits on one thread and on many; nothing is
//! allocated.

mod cells;
mod fields;
mod instructions;
#[macro_use]
mod kernel;
mod merge;
mod reductions;
pub mod simd;
mod sweep;

pub use cells::{Cells, Set, SetMut};
pub use fields::{Fields, add, each, each_with_sums, sums};
pub use instructions::Instructions;
pub use merge::{Max, Merge, Min, larger, smaller};
pub use reductions::{count_finite, count_positive, dot, is_zero, maximum, minimum, sum};
pub use sweep::{BLOCK, in_pool, run, strands, sweep, zeros};
