//! Selects the vectors of a sweep.

use super::portable;
use super::vector::Work;
#[cfg(target_arch = "x86_64")]
use super::{avx2, avx512};
use crate::instructions::Instructions;

/// Does the work in the widest vectors that this processor has.
pub fn vectorize<W: Work>(work: W) -> W::Yield {
    #[cfg(target_arch = "x86_64")]
    {
        if is_x86_feature_detected!("avx2") {
            if is_x86_feature_detected!("avx512f") {
                return avx512::run(work);
            }
            return avx2::run(work);
        }
    }
    portable::run(work)
}

/// Does the work on the given instructions; the bits do not depend on them.
///
/// # Panics
/// If the processor does not have them.
pub fn vectorize_on<W: Work>(instructions: Instructions, work: W) -> W::Yield {
    assert!(Instructions::available().contains(&instructions), "{instructions:?} is not available");
    match instructions {
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx512 => avx512::run(work),
        #[cfg(target_arch = "x86_64")]
        Instructions::Avx2 => avx2::run(work),
        _ => portable::run(work),
    }
}
