//! Reductions of whole fields, by name: in parallel, in the widest vectors, and with the same bits for any number of threads and
//! on every processor.

use crate::cells::Cells;
use crate::merge::{Max, Min};
use crate::simd::{F64x8, Work};
use crate::sweep::run;

/// Sum of the cells.
pub fn sum(field: &[f64]) -> f64 {
    run(SumOf { field, term: Value })
}

/// Number of cells above 0.
///
/// ```
/// use asperity_sweep::{count_finite, count_positive, dot, is_zero, maximum, minimum, sum};
/// let field = [0.0, 2.0, -1.0, f64::INFINITY];
/// assert_eq!((count_positive(&field), count_finite(&field)), (2, 3));
/// assert_eq!((minimum(&field), maximum(&field[..3]), sum(&field[..3])), (-1.0, 2.0, 1.0));
/// assert_eq!(dot(&field[..3], &field[..3]), 5.0);
/// assert!(is_zero(&field[..1]) && !is_zero(&field));
/// ```
pub fn count_positive(field: &[f64]) -> usize {
    run(SumOf { field, term: IsPositive }) as usize
}

/// Number of cells that are neither infinite nor NaN.
pub fn count_finite(field: &[f64]) -> usize {
    run(SumOf { field, term: IsFinite }) as usize
}

/// True where every cell is 0, of either sign.
pub fn is_zero(field: &[f64]) -> bool {
    run(SumOf { field, term: IsNotZero }) == 0.0
}

/// Sum of the products of the cells of two fields of one length.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    run(Dot { a, b })
}

/// Smallest cell; infinity where there is none. NaN does not count.
pub fn minimum(field: &[f64]) -> f64 {
    run(Minimum { field }).0
}

/// Largest cell; minus infinity where there is none. NaN does not count.
pub fn maximum(field: &[f64]) -> f64 {
    run(Maximum { field }).0
}

/// What a cell adds to a sum; 0 for a cell that is [`BEYOND`](Self::BEYOND).
trait Term: Copy + Send {
    const BEYOND: f64 = 0.0;
    fn of<V: F64x8>(self, x: V) -> V;
}

#[derive(Clone, Copy)]
struct Value;

#[derive(Clone, Copy)]
struct IsPositive;

#[derive(Clone, Copy)]
struct IsFinite;

#[derive(Clone, Copy)]
struct IsNotZero;

impl Term for Value {
    #[inline(always)]
    fn of<V: F64x8>(self, x: V) -> V {
        x
    }
}

impl Term for IsPositive {
    #[inline(always)]
    fn of<V: F64x8>(self, x: V) -> V {
        V::count(V::splat(0.0).less(x))
    }
}

impl Term for IsFinite {
    const BEYOND: f64 = f64::INFINITY;
    #[inline(always)]
    fn of<V: F64x8>(self, x: V) -> V {
        V::count(x.abs().less(V::splat(f64::INFINITY)))
    }
}

impl Term for IsNotZero {
    #[inline(always)]
    fn of<V: F64x8>(self, x: V) -> V {
        V::count(!x.abs().at_most(V::splat(0.0)))
    }
}

struct SumOf<'a, T> {
    field: &'a [f64],
    term: T,
}

impl<T: Term> Cells for SumOf<'_, T> {
    fn cells(&self) -> usize {
        self.field.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        let (first, second) = self.field.split_at(mid);
        (SumOf { field: first, term: self.term }, SumOf { field: second, term: self.term })
    }
}

impl<T: Term> Work for SumOf<'_, T> {
    type Yield = f64;

    #[inline(always)]
    fn run<V: F64x8>(self) -> f64 {
        let mut sum = V::splat(0.0);
        for n in (0..self.field.len()).step_by(8) {
            sum = sum + self.term.of(V::load(self.field, n, T::BEYOND));
        }
        sum.sum()
    }
}

kernel! {
    struct Dot<'a> {
        cells { a: &'a [f64], b: &'a [f64] }
    }
}

impl Work for Dot<'_> {
    type Yield = f64;

    #[inline(always)]
    fn run<V: F64x8>(self) -> f64 {
        let mut sum = V::splat(0.0);
        for n in (0..self.a.len()).step_by(8) {
            sum = sum + V::load(self.a, n, 0.0) * V::load(self.b, n, 0.0);
        }
        sum.sum()
    }
}

kernel! {
    struct Minimum<'a> {
        cells { field: &'a [f64] }
    }
}

impl Work for Minimum<'_> {
    type Yield = Min;

    #[inline(always)]
    fn run<V: F64x8>(self) -> Min {
        let mut least = V::splat(f64::INFINITY);
        for n in (0..self.field.len()).step_by(8) {
            least = V::load(self.field, n, f64::INFINITY).smaller(least);
        }
        Min(least.least())
    }
}

kernel! {
    struct Maximum<'a> {
        cells { field: &'a [f64] }
    }
}

impl Work for Maximum<'_> {
    type Yield = Max;

    #[inline(always)]
    fn run<V: F64x8>(self) -> Max {
        let mut largest = V::splat(f64::NEG_INFINITY);
        for n in (0..self.field.len()).step_by(8) {
            largest = V::load(self.field, n, f64::NEG_INFINITY).larger(largest);
        }
        Max(largest.largest())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::{strands, sweep};

    fn rough(cells: i32) -> Vec<f64> {
        (0..cells).map(|i| f64::from(i).sin() * 10f64.powi(i % 17)).collect()
    }

    #[test]
    fn sums_have_the_same_bits_for_any_number_of_threads() {
        let field = rough(100_003);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| [sum(&field), dot(&field, &field)].map(f64::to_bits))
        };
        assert_eq!(on(1), on(2));
        assert_eq!(on(1), on(7));
    }

    #[test]
    fn sums_run_in_eight_strands() {
        for cells in [0, 1, 7, 8, 9, 20_003] {
            let field = rough(cells);
            let strands = sweep(&field[..], &|f: &[f64]| strands(f.len(), |i| [f[i], f[i] * f[i]]));
            assert_eq!([sum(&field), dot(&field, &field)], strands, "{cells}");
        }
    }

    #[test]
    fn reductions_are_those_of_the_cells() {
        for cells in [0, 1, 7, 8, 9, 20_003] {
            let mut field = rough(cells);
            field.iter_mut().step_by(5).for_each(|x| *x = 0.0);
            field.iter_mut().skip(3).step_by(7).for_each(|x| *x = f64::INFINITY);
            field.iter_mut().skip(2).step_by(11).for_each(|x| *x = f64::NAN);
            assert_eq!(count_positive(&field), field.iter().filter(|x| **x > 0.0).count());
            assert_eq!(count_finite(&field), field.iter().filter(|x| x.is_finite()).count());
            assert_eq!(minimum(&field), field.iter().copied().fold(f64::INFINITY, f64::min));
            assert_eq!(maximum(&field), field.iter().copied().fold(f64::NEG_INFINITY, f64::max));
            assert_eq!(is_zero(&field), cells < 2);
        }
        let mut field = vec![-0.0; 20_003];
        assert!(is_zero(&field));
        field[20_002] = f64::NAN;
        assert!(!is_zero(&field));
    }
}
