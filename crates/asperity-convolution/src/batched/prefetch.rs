//! Prefetching of memory. It does not change the results.

/// The purpose of a prefetch.
#[derive(Clone, Copy, PartialEq)]
pub enum Purpose {
    /// To be read immediately: into the first-level cache.
    Reading,
    /// To be read later: into the second-level cache.
    ReadingLater,
    /// To be written.
    Writing,
}

/// Prefetches the cache lines of `count` items from `start` on, which need not be a valid address.
#[inline(always)]
pub fn prefetch<T>(what: Purpose, start: *const T, count: usize) {
    #[cfg(target_arch = "x86_64")]
    for line in (0..count * size_of::<T>()).step_by(64) {
        use std::arch::x86_64::{_MM_HINT_ET0, _MM_HINT_T0, _MM_HINT_T1, _mm_prefetch};
        let line = start.wrapping_byte_add(line).cast();
        // SAFETY: a prefetch is a hint; it accesses nothing and may name any address.
        unsafe {
            match what {
                Purpose::Reading => _mm_prefetch::<_MM_HINT_T0>(line),
                Purpose::ReadingLater => _mm_prefetch::<_MM_HINT_T1>(line),
                Purpose::Writing => _mm_prefetch::<_MM_HINT_ET0>(line),
            }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (what, start, count);
}

/// A range of memory that is prefetched in steps, to be read later.
pub struct PrefetchAhead<T> {
    next: *const T,
    step: usize,
}

impl<T> PrefetchAhead<T> {
    /// `count` items from `start` on, in this number of steps.
    pub fn of(start: *const T, count: usize, steps: usize) -> Self {
        PrefetchAhead { next: start, step: count.div_ceil(steps) }
    }

    /// Nothing.
    pub fn nothing() -> Self {
        PrefetchAhead { next: std::ptr::null(), step: 0 }
    }

    /// Prefetches the next step.
    #[inline(always)]
    pub fn advance(&mut self) {
        prefetch(Purpose::ReadingLater, self.next, self.step);
        self.next = self.next.wrapping_add(self.step);
    }
}
