//! The declaration of a sweep kernel.

/// Declares a sweep kernel: fields with the same number of cells, which are processed together, numbers that are the same for all
/// cells, and the operation on a part of the cells, eight at a time in vectors `V`. The first field must have all cells.
/// [`run`](crate::run()) applies it to all of them and merges the results.
///
/// ```
/// use asperity_sweep::{kernel, run};
/// kernel! {
///     /// a x + y.
///     struct Combination<'a> {
///         cells { y: &'a mut [f64], x: &'a [f64] }
///         numbers { a: f64 }
///     }
///     fn run<V>(self) {
///         for n in (0..self.y.len()).step_by(8) {
///             (V::splat(self.a) * V::load(self.x, n, 0.0) + V::load(self.y, n, 0.0)).store(self.y, n);
///         }
///     }
/// }
/// let mut y = [1.0, 2.0];
/// run(Combination { y: &mut y, x: &[3.0, 4.0], a: 2.0 });
/// assert_eq!(y, [7.0, 10.0]);
/// ```
#[macro_export]
macro_rules! kernel {
    ($(#[$doc:meta])* $view:vis struct $name:ident<$life:lifetime> {
        cells { $first:ident: $first_type:ty $(, $field:ident: $type:ty)* $(,)? }
        $(numbers { $($number:ident: $number_type:ty),* $(,)? })?
    }
    fn run<$vector:ident>($self:ident) $(-> $yield:ty)? $work:block) => {
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
        impl $crate::simd::Work for $name<'_> {
            type Yield = $crate::kernel!(@yield $($yield)?);

            #[inline(always)]
            fn run<$vector: $crate::simd::F64x8>($self) -> Self::Yield $work
        }
    };
    (@yield) => { () };
    (@yield $yield:ty) => { $yield };
}
