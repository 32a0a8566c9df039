//! The declaration of a sweep kernel.

/// Declares a sweep kernel: fields with the same number of cells, which are processed together, and numbers that are the same for
/// all cells. The first field must have all cells. With a [`Work`](crate::simd::Work) that handles a part of the cells,
/// [`run`](crate::run()) applies it to all of them.
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
