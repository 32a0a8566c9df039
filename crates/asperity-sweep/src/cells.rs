//! Arrays that a sweep processes together, and how they are divided.

/// Arrays that a sweep processes together: slices and tuples of slices of one length.
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

/// Optional cells. They are never the first element of a tuple, because the first determines the number of cells.
impl<C: Cells> Cells for Option<C> {
    fn cells(&self) -> usize {
        self.as_ref().map_or(0, Cells::cells)
    }
    fn split(self, mid: usize) -> (Self, Self) {
        self.map(|cells| cells.split(mid)).unzip()
    }
}

/// The numbers of cells that follow one another.
impl Cells for std::ops::Range<usize> {
    fn cells(&self) -> usize {
        self.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        let middle = self.start + mid;
        (self.start..middle, middle..self.end)
    }
}

/// A set of cells, eight in a byte (see [`crate::simd`]).
pub struct Set<'a>(pub &'a [u8]);

/// A set of cells that a sweep determines.
pub struct SetMut<'a>(pub &'a mut [u8]);

impl Cells for Set<'_> {
    fn cells(&self) -> usize {
        8 * self.0.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at(mid.div_ceil(8));
        (Set(first), Set(second))
    }
}

impl Cells for SetMut<'_> {
    fn cells(&self) -> usize {
        8 * self.0.len()
    }
    fn split(self, mid: usize) -> (Self, Self) {
        let (first, second) = self.0.split_at_mut(mid.div_ceil(8));
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
