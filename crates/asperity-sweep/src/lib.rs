//! Sweeps over fields: several arrays of cells walked together, in parallel, with sums whose order
//! never depends on the number of threads.
//!
//! A sweep halves its arrays down to blocks of [`BLOCK`] cells, works on each block, and merges the
//! blocks' sums pairwise up the same tree. The tree depends on the length alone, so the same field
//! gives the same bits on one thread and on many; nothing is allocated.

pub mod eights;
mod instructions;

use eights::{Work, vectorize};
pub use instructions::Instructions;
use rayon::prelude::*;

/// Cells in one block, a multiple of eight: a few arrays of it fit the second-level cache.
pub const BLOCK: usize = 8192;

/// A field of zeros, written by all threads: memory that a system hands out as zeros without writing them would be fetched
/// when it is first used, cell by cell in the middle of a solve, and twice where it is read first.
pub fn zeros<T: Default + Send>(cells: usize) -> Vec<T> {
    (0..cells).into_par_iter().with_min_len(BLOCK).map(|_| T::default()).collect()
}

/// Arrays that are walked together: slices and tuples of slices of one length.
pub trait Cells: Send + Sized {
    /// Number of cells.
    fn cells(&self) -> usize;
    /// The cells before `mid`, and from `mid` on.
    fn split(self, mid: usize) -> (Self, Self);
}

impl<T: Sync> Cells for &[T] {
    fn cells(&self) -> usize {
        self.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        self.split_at(mid)
    }
}

impl<T: Send> Cells for &mut [T] {
    fn cells(&self) -> usize {
        self.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        self.split_at_mut(mid)
    }
}

/// Cells that some sweeps have: never the first of a tuple, which knows their number.
impl<C: Cells> Cells for Option<C> {
    fn cells(&self) -> usize {
        self.as_ref().map_or(0, Cells::cells)
    }
    fn split(self, mid: usize) -> (Self, Self) {
        self.map(|cells| cells.split(mid)).unzip()
    }
}

/// A set of cells, eight in a byte (see [`eights`]).
pub struct Set<'a>(pub &'a [u8]);

/// A set of cells to be found.
pub struct SetMut<'a>(pub &'a mut [u8]);

impl Cells for Set<'_> {
    fn cells(&self) -> usize {
        8 * self.0.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at(mid / 8);
        (Set(first), Set(second))
    }
}

impl Cells for SetMut<'_> {
    fn cells(&self) -> usize {
        8 * self.0.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(mid / 8);
        (SetMut(first), SetMut(second))
    }
}

macro_rules! cells_of_tuple {
    ($($name:ident),+) => {
        impl<$($name: Cells),+> Cells for ($($name,)+) {
            fn cells(&self) -> usize {
                self.0.cells()
            }
            #[allow(non_snake_case)]
            fn split(self, mid: usize) -> (Self, Self) {
                let ($($name,)+) = self;
                $(let $name = $name.split(mid);)+
                (($($name.0,)+), ($($name.1,)+))
            }
        }
    };
}
cells_of_tuple!(A, B);
cells_of_tuple!(A, B, C);
cells_of_tuple!(A, B, C, D);
cells_of_tuple!(A, B, C, D, E);
cells_of_tuple!(A, B, C, D, E, F);
cells_of_tuple!(A, B, C, D, E, F, G);
cells_of_tuple!(A, B, C, D, E, F, G, H);

/// What a block yields and how two neighbours' yields become one.
pub trait Merge: Send {
    /// The yield of both blocks; `self` comes first.
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

/// Applies `block` to every block of the cells and merges what they yield.
pub fn sweep<C: Cells, M: Merge>(cells: C, block: &(impl Fn(C) -> M + Sync)) -> M {
    let n = cells.cells();
    if n <= BLOCK {
        return block(cells);
    }
    let (first, second) = cells.split((n / 2).next_multiple_of(BLOCK));
    let (mut first, mut second) = (Half::Cells(first), Half::Cells(second));
    both(&mut || first.sweep(block), &mut || second.sweep(block));
    match (first, second) {
        (Half::Yield(a), Half::Yield(b)) => a.merge(b),
        _ => unreachable!("both halves have run"),
    }
}

/// Half of a field, before and after it is swept.
enum Half<C, M> {
    Cells(C),
    Swept,
    Yield(M),
}

impl<C: Cells, M: Merge> Half<C, M> {
    fn sweep(&mut self, block: &(impl Fn(C) -> M + Sync)) {
        if let Half::Cells(cells) = std::mem::replace(self, Half::Swept) {
            *self = Half::Yield(sweep(cells, block));
        }
    }
}

/// Runs both, on two threads where there are. Not generic, so that the machinery of threads is compiled once.
fn both(first: &mut (dyn FnMut() + Send), second: &mut (dyn FnMut() + Send)) {
    rayon::join(first, second);
}

/// Declares a sweep kernel: fields of one number of cells, which are walked together, and numbers that are the same for all
/// cells. The first field must have all cells. With a [`Work`](eights::Work) that handles a part of the
/// cells, [`run`] applies it to all of them.
#[macro_export]
macro_rules! kernel {
    ($(#[$doc:meta])* $view:vis struct $name:ident<$life:lifetime> {
        cells { $first:ident: $first_type:ty $(, $field:ident: $type:ty)* $(,)? }
        $(numbers { $($number:ident: $number_type:ty),* $(,)? })?
    }) => {
        $(#[$doc])*
        $view struct $name<$life> {
            $view $first: $first_type,
            $($view $field: $type,)*
            $($($view $number: $number_type,)*)?
        }
        impl<$life> $crate::Cells for $name<$life> {
            fn cells(&self) -> usize {
                $crate::Cells::cells(&self.$first)
            }
            fn split(self, mid: usize) -> (Self, Self) {
                let $first = $crate::Cells::split(self.$first, mid);
                $(let $field = $crate::Cells::split(self.$field, mid);)*
                (
                    $name { $first: $first.0, $($field: $field.0,)* $($($number: self.$number,)*)? },
                    $name { $first: $first.1, $($field: $field.1,)* $($($number: self.$number,)*)? },
                )
            }
        }
    };
}

/// Runs a kernel over all of its cells, in the widest vectors of the processor and on all threads, and merges what the blocks
/// yield in a fixed order.
pub fn run<K: Cells + Work>(kernel: K) -> K::Yield
where
    K::Yield: Merge,
{
    sweep(kernel, &|part: K| vectorize(part))
}

/// Sums over `n` cells in eight interleaved strands: the order that vector units prefer, fixed here.
#[inline(always)]
pub fn strands<const K: usize>(n: usize, mut term: impl FnMut(usize) -> [f64; K]) -> [f64; K] {
    let mut strand = [[0.0; K]; 8];
    let whole = n - n % 8;
    let mut i = 0;
    while i < whole {
        for (lane, sums) in strand.iter_mut().enumerate() {
            let t = term(i + lane);
            for k in 0..K {
                sums[k] += t[k];
            }
        }
        i += 8;
    }
    for (lane, sums) in strand.iter_mut().enumerate().take(n - whole) {
        let t = term(whole + lane);
        for k in 0..K {
            sums[k] += t[k];
        }
    }
    let [a, b, c, d, e, f, g, h] = strand;
    std::array::from_fn(|k| ((a[k] + b[k]) + (c[k] + d[k])) + ((e[k] + f[k]) + (g[k] + h[k])))
}

/// sum of the cells.
pub fn sum(field: &[f64]) -> f64 {
    sweep(field, &|f: &[f64]| strands(f.len(), |i| [f[i]]))[0]
}

/// Smallest cell; infinity where there is none.
pub fn minimum(field: &[f64]) -> f64 {
    sweep(field, &|f: &[f64]| Min(f.iter().fold(f64::INFINITY, |m, v| smaller(*v, m)))).0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_have_the_same_bits_for_any_number_of_threads() {
        let field: Vec<f64> = (0..100_003).map(|i| (i as f64).sin() * 10f64.powi(i % 17)).collect();
        let on = |threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| sum(&field))
        };
        assert_eq!(on(1).to_bits(), on(2).to_bits());
        assert_eq!(on(1).to_bits(), on(7).to_bits());
    }

    #[test]
    fn a_sweep_meets_every_cell_once() {
        let mut seen = vec![0u8; 3 * BLOCK + 5];
        let index: Vec<usize> = (0..seen.len()).collect();
        let total = sweep((&mut seen[..], &index[..]), &|(seen, index): (&mut [u8], &[usize])| {
            seen.iter_mut().for_each(|s| *s += 1);
            index.iter().map(|i| *i as f64).sum::<f64>()
        });
        assert!(seen.iter().all(|s| *s == 1));
        let n = index.len() as f64;
        assert_eq!(total, n * (n - 1.0) / 2.0);
    }
}
