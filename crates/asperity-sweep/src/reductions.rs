//! Reductions of whole fields, by name: in parallel, in the widest vectors, and with the same bits for any number of threads and
//! on every processor.

use crate::merge::{Max, Min};
use crate::sweep::run;

/// Declares a reduction of one or more fields, eight cells at a time. The arguments describe one sweep over a block: the initial
/// value, the value of cells beyond the end, the step, the result of the block, and the final result from all blocks.
macro_rules! reduction {
    ($(#[$doc:meta])* $name:ident($first:ident $(, $next:ident)*) -> $result:ty {
        from $start:expr, beyond $beyond:expr, |$value:ident| $step:expr, $yield:ty: $end:expr, $tell:expr
    }) => {
        $(#[$doc])*
        pub fn $name($first: &[f64] $(, $next: &[f64])*) -> $result {
            kernel! {
                struct Reduction<'a> { cells { $first: &'a [f64] $(, $next: &'a [f64])* } }
                fn run<V>(self) -> $yield {
                    let mut $value = V::splat($start);
                    for n in (0..self.$first.len()).step_by(8) {
                        let $first = V::load(self.$first, n, $beyond);
                        $(let $next = V::load(self.$next, n, $beyond);)*
                        $value = $step;
                    }
                    $end
                }
            }
            $tell(run(Reduction { $first $(, $next)* }))
        }
    };
}

reduction! {
    /// Sum of the cells.
    sum(x) -> f64 { from 0.0, beyond 0.0, |sum| sum + x, f64: sum.sum(), |sum| sum }
}

reduction! {
    /// Sum of the products of the cells of two fields of the same length.
    dot(a, b) -> f64 { from 0.0, beyond 0.0, |sum| sum + a * b, f64: sum.sum(), |sum| sum }
}

reduction! {
    /// Smallest cell; infinity if there is none. NaN does not count.
    minimum(x) -> f64 {
        from f64::INFINITY, beyond f64::INFINITY, |least| x.smaller(least), Min: Min(least.least()), |min: Min| min.0
    }
}

reduction! {
    /// Largest cell; minus infinity if there is none. NaN does not count.
    maximum(x) -> f64 {
        from f64::NEG_INFINITY, beyond f64::NEG_INFINITY, |most| x.larger(most), Max: Max(most.largest()), |max: Max| max.0
    }
}

reduction! {
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
    count_positive(x) -> usize {
        from 0.0, beyond 0.0, |cells| cells + V::count(V::splat(0.0).less(x)), f64: cells.sum(), |cells| cells as usize
    }
}

reduction! {
    /// Number of cells that are neither infinite nor NaN.
    count_finite(x) -> usize {
        from 0.0, beyond f64::INFINITY, |cells| cells + V::count(x.abs().less(V::splat(f64::INFINITY))),
        f64: cells.sum(), |cells| cells as usize
    }
}

reduction! {
    /// True if every cell is 0, of either sign.
    is_zero(x) -> bool {
        from 0.0, beyond 0.0, |others| others + V::count(!x.abs().at_most(V::splat(0.0))),
        f64: others.sum(), |others| others == 0.0
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
