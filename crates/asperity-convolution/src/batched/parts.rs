//! R equal parts of a block of numbers. A butterfly of radix R takes one number from each part.

use std::marker::PhantomData;

use super::complex::Complex;

/// R ranges of `length` numbers, which are read and written across: number j of every range.
pub struct Parts<'a, V, const R: usize> {
    starts: [*mut Complex<V>; R],
    length: usize,
    block: PhantomData<&'a mut [Complex<V>]>,
}

impl<'a, V: Copy, const R: usize> Parts<'a, V, R> {
    /// A block in R consecutive parts.
    #[inline(always)]
    pub fn of(block: &'a mut [Complex<V>]) -> Self {
        let length = block.len() / R;
        let start = block.as_mut_ptr();
        let mut starts = [start; R];
        for q in 1..R {
            starts[q] = start.wrapping_add(q * length);
        }
        Parts { starts, length, block: PhantomData }
    }

    /// The first R ranges of `length` numbers of a signal. Beyond the end of the signal, those at the same position of `margin`
    /// are used.
    ///
    /// # Panics
    /// If the margin is too short as well.
    #[inline(always)]
    pub fn of_signal(signal: &'a mut [Complex<V>], margin: &'a mut [Complex<V>], length: usize) -> Self {
        let mut starts = [signal.as_mut_ptr(); R];
        for q in 0..R {
            let end = (q + 1) * length;
            let source = if end <= signal.len() { &mut *signal } else { &mut *margin };
            assert!(end <= source.len());
            starts[q] = source.as_mut_ptr().wrapping_add(q * length);
        }
        Parts { starts, length, block: PhantomData }
    }

    /// Numbers in a part.
    #[inline(always)]
    pub fn length(&self) -> usize {
        self.length
    }

    /// Number j of every part.
    #[inline(always)]
    pub fn load(&self, j: usize) -> [Complex<V>; R] {
        assert!(j < self.length);
        // SAFETY: every start has `length` numbers behind it that are borrowed for 'a.
        let mut numbers = unsafe { [*self.starts[0].add(j); R] };
        for q in 1..R {
            // SAFETY: as above.
            numbers[q] = unsafe { *self.starts[q].add(j) };
        }
        numbers
    }

    /// Stores number j of every part.
    #[inline(always)]
    pub fn store(&mut self, j: usize, numbers: [Complex<V>; R]) {
        assert!(j < self.length);
        for q in 0..R {
            // SAFETY: every start has `length` numbers behind it that are borrowed mutably for 'a.
            unsafe { *self.starts[q].add(j) = numbers[q] };
        }
    }
}
