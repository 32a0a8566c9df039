//! Linear viscoelastic materials: creep, relaxation, models. Knows time, no space.
//!
//! A material is its creep function, a [`Creep`] (Prony series of retarded terms), or equally its
//! relaxation function, a [`Relaxation`]; each converts into the other exactly. A [`Material`] is
//! such a function together with the measure in which its moduli are meant (Young's or shear
//! modulus); a [`Body`] closes it with Poisson's ratio or the bulk modulus and yields the contact
//! creep compliance C(t), all that the contact needs to know.

mod body;
mod convert;
mod creep;
mod data;
mod fit;
mod fractional;
mod master;
mod mittag_leffler;
mod models;
mod nnls;
mod prony_sum;
mod quadrature;
mod reduced_time;
mod refine;
mod relaxation;
mod series;
mod shift;
mod spectrum;

pub use body::{Body, Lateral, pair_creep, pair_hardness};
pub use creep::{Creep, CreepTerm};
pub use fit::{Fit, FitOptions, LongTime, Misfit, fit_creep, fit_dma, fit_relaxation};
pub use fractional::{Approximation, Fractional};
pub use master::{Abscissa, Isotherm, MasterCurve, estimate_shift, master_curve};
pub use models::{Material, Modulus};
pub use reduced_time::ReducedTime;
pub use relaxation::{Relaxation, RelaxationTerm};
pub use shift::{GAS_CONSTANT, Shift, ShiftFit, fit_arrhenius, fit_wlf};
