//! The sweep: it processes blocks in parallel and merges their results up a fixed tree.

use rayon::prelude::*;

use crate::cells::Cells;
use crate::merge::Merge;
use crate::simd::{Work, vectorize};

/// Cells in one block, a multiple of eight: a few arrays of this size fit into the second-level cache.
pub const BLOCK: usize = 8192;

/// A field of zeros, written by all threads. Otherwise, the system would only reserve the memory and provide each page at its
/// first use, in the middle of a solve, and twice if it is read first.
pub fn zeros<T: Default + Send>(cells: usize) -> Vec<T> {
    (0..cells).into_par_iter().with_min_len(BLOCK).map(|_| T::default()).collect()
}

/// Does `work` on a thread of the pool. A sweep that is entered from outside of the pool wakes its threads and waits for them each time: in a
/// run of small grids that is a tenth of the time.
pub fn in_pool<R: Send>(work: impl FnOnce() -> R + Send) -> R {
    rayon::scope(|_| work())
}

/// Applies `block` to every block of the cells and merges the results.
pub fn sweep<C: Cells, M: Merge>(cells: C, block: &(impl Fn(C) -> M + Sync)) -> M {
    let n = cells.cells();
    if n <= BLOCK {
        return block(cells);
    }
    let (first, second) = cells.split((n / 2).next_multiple_of(BLOCK));
    let (mut first, mut second, mut a, mut b) = (Some(first), Some(second), None, None);
    both(&mut || a = first.take().map(|cells| sweep(cells, block)), &mut || {
        b = second.take().map(|cells| sweep(cells, block))
    });
    match (a, b) {
        (Some(a), Some(b)) => a.merge(b),
        _ => unreachable!("both halves have run"),
    }
}

/// Runs both, on two threads if available. Not generic, so that the threading code is compiled once.
fn both(first: &mut (dyn FnMut() + Send), second: &mut (dyn FnMut() + Send)) {
    rayon::join(first, second);
}

/// Runs a kernel over all of its cells, in the widest vectors of the processor and on all threads, and merges the results of the
/// blocks in a fixed order.
pub fn run<K: Cells + Work>(kernel: K) -> K::Yield
where
    K::Yield: Merge,
{
    sweep(kernel, &|part: K| vectorize(part))
}

/// Sums over `n` cells in eight interleaved lanes: the order suits vector units, and is fixed here.
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

#[cfg(test)]
mod tests {
    use super::*;

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
