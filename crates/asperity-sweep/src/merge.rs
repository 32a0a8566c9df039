//! The results of the blocks of a sweep, and how the results of two neighbours are merged.

/// The result of a block, and how the results of two neighbours are merged.
pub trait Merge: Send {
    /// The result of both blocks; `self` comes first.
    fn merge(self, next: Self) -> Self;
}

impl Merge for () {
    fn merge(self, _: Self) {}
}

/// Sums.
impl<const K: usize> Merge for [f64; K] {
    fn merge(self, next: Self) -> Self {
        std::array::from_fn(|k| self[k] + next[k])
    }
}

impl Merge for f64 {
    fn merge(self, next: Self) -> Self {
        self + next
    }
}

/// The larger of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Max(pub f64);

/// The smaller of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Min(pub f64);

impl Merge for Max {
    fn merge(self, next: Self) -> Self {
        Max(larger(self.0, next.0))
    }
}

impl Merge for Min {
    fn merge(self, next: Self) -> Self {
        Min(smaller(self.0, next.0))
    }
}

impl<A: Merge, B: Merge> Merge for (A, B) {
    fn merge(self, next: Self) -> Self {
        (self.0.merge(next.0), self.1.merge(next.1))
    }
}

impl<A: Merge, B: Merge, C: Merge> Merge for (A, B, C) {
    fn merge(self, next: Self) -> Self {
        (self.0.merge(next.0), self.1.merge(next.1), self.2.merge(next.2))
    }
}

/// The larger, as one instruction (no special treatment of NaN).
#[inline(always)]
pub fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The smaller, as one instruction (no special treatment of NaN).
#[inline(always)]
pub fn smaller(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
