//! The scalar types of the engine, each with its vectors of every instruction set.
//!
//! The engine is compiled here, once for each kind of vector, and not in every crate that uses it.

use super::vector::Scalar;

/// The scalar types of the engine: `f64` and `f32`.
pub trait Real: Scalar + sealed::Sealed {}

impl Real for f64 {}
impl Real for f32 {}

mod sealed {
    use asperity_sweep::Instructions;

    use super::super::Spectrum;
    use super::super::engine::{Convolve, Engine};
    use super::super::factors::Factors;
    use super::super::portable::Portable;
    #[cfg(target_arch = "x86_64")]
    use super::super::{avx2, avx512};

    pub trait Sealed: Sized {
        /// The engine in the vectors of an instruction set that is available.
        fn plan(
            instructions: Instructions,
            cells: [usize; 2],
            lengths: [usize; 2],
            factors: [&Factors; 2],
            spectra: Vec<Spectrum<'_>>,
        ) -> Box<dyn Convolve<Self>>;
    }

    macro_rules! planned {
        ($scalar:ty, $portable:ty, $avx2:ty, $avx512:ty) => {
            impl Sealed for $scalar {
                #[inline(never)]
                fn plan(
                    instructions: Instructions,
                    cells: [usize; 2],
                    lengths: [usize; 2],
                    factors: [&Factors; 2],
                    spectra: Vec<Spectrum<'_>>,
                ) -> Box<dyn Convolve<Self>> {
                    match instructions {
                        #[cfg(target_arch = "x86_64")]
                        Instructions::Avx512 => {
                            Box::new(Engine::<$avx512>::new(cells, lengths, factors, spectra))
                        }
                        #[cfg(target_arch = "x86_64")]
                        Instructions::Avx2 => {
                            Box::new(Engine::<$avx2>::new(cells, lengths, factors, spectra))
                        }
                        _ => Box::new(Engine::<$portable>::new(cells, lengths, factors, spectra)),
                    }
                }
            }
        };
    }
    planned!(f64, Portable<f64, 4>, avx2::F64x4, avx512::F64x8);
    planned!(f32, Portable<f32, 8>, avx2::F32x8, avx512::F32x16);
}
