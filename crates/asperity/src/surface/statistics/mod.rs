//! Numbers that describe a rough surface.
//!
//! | what | type | undefined points |
//! |---|---|---|
//! | Sa, Sq, Ssk, Sku, Sp, Sv, Sz | [`HeightStatistics`] | left out |
//! | Sdq, Sdr | [`SlopeStatistics`] | left out with their neighbours |
//! | bearing-area curve, height distribution | [`BearingCurve`], [`height_distribution`] | left out |
//! | spectral moments, Nayak's parameter | [`SpectralMoments`] | refused |
//! | lay | [`SpectralLay`] | refused |
//! | radially averaged power spectrum | [`RadialSpectrum`] | refused |
//! | autocorrelation, Sal, Str | [`Autocorrelation`] | refused |
//! | Hurst exponent | [`SelfAffineFit`] | refused |
//! | all of these but the correlation and the curves | [`Summary`] | as above; filled for the spectrum |
//!
//! Amplitudes, slopes and lengths in SI units; the parameters of ISO 25178-2 are of the surface as
//! given, so level it first.

mod bearing;
mod correlation;
mod fit;
mod heights;
mod power;
mod slopes;
mod summary;

pub use bearing::{BearingCurve, height_distribution};
pub use correlation::{Autocorrelation, Extent};
pub use fit::SelfAffineFit;
pub use heights::{HeightStatistics, mean, rms_height};
pub use power::{PowerSpectrum, RadialSpectrum, Rings, SpectralLay, SpectralMoments, Wave, rms_gradient};
pub use slopes::SlopeStatistics;
pub use summary::{Summary, Waves};
