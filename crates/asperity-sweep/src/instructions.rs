//! The vector instructions of a processor.

/// Vector instructions. All give the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instructions {
    /// Vectors of 512 bits (AVX-512F).
    Avx512,
    /// Vectors of 256 bits with fused multiply-add (AVX2, FMA).
    Avx2,
    /// Code that the compiler generates from plain Rust: NEON on aarch64. Slow on x86-64 without FMA.
    Portable,
}

impl Instructions {
    /// Those available on this processor, fastest first.
    pub fn available() -> Vec<Self> {
        let mut found = Vec::new();
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
            if is_x86_feature_detected!("avx512f") {
                found.push(Instructions::Avx512);
            }
            found.push(Instructions::Avx2);
        }
        found.push(Instructions::Portable);
        found
    }
}
