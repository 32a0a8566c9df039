//! Linear viscoelastic materials: creep, relaxation, models. This module depends on time, not on space.
//!
//! A material is its creep function, a [`Creep`] (Prony series of retarded terms), or equally its relaxation function, a
//! [`Relaxation`]; each converts into the other exactly. A [`Material`] is such a function together with the kind of its moduli
//! (Young's or shear modulus). A [`Body`] adds Poisson's ratio or the bulk modulus and gives the contact creep compliance C(t),
//! which is all that the contact needs.
//!
//! Such a function comes from
//! - named models: the constructors of [`Material`];
//! - a Prony table, in moduli or relative to the instantaneous or the relaxed modulus: those of
//!   [`Relaxation`];
//! - fractional models, as Prony sums to a stated error: [`Fractional`];
//! - measured curves: [`fit_relaxation`], [`fit_creep`], [`fit_dma`]; or [`CreepTable`] as it is;
//! - curves at several temperatures: [`master_curve`], with a [`Shift`] that is given or
//!   [estimated](estimate_shift), and a [`VerticalShift`] of the moduli.
//!
//! A temperature that changes during the run gives a [`ReducedTime`] for a [`ThermalCreep`]; a constant one scales the times:
//! [`Material::stretched`].

mod align;
mod body;
mod convert;
mod creep;
mod data;
mod dual;
mod estimate;
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
mod table;
mod temperature;
mod thermal;
mod vertical;

pub use body::{Body, Lateral, PoissonCreep, pair_hardness};
pub use creep::{Creep, CreepTerm};
pub use data::Reversal;
pub(crate) use dual::Dual;
pub use estimate::{ModulusChange, ShiftEstimate, VerticalEstimate, estimate_shift, estimate_vertical};
pub use fit::{Fit, FitOptions, LongTime, Misfit, Moduli, beyond, fit_creep, fit_dma, fit_relaxation};
pub use fractional::{Approximation, Fractional};
pub use master::{Abscissa, Isotherm, MasterCurve, master_curve};
pub use models::{Material, Modulus};
pub(crate) use nnls::{dot, solve as least_squares};
pub(crate) use quadrature::integrate;
pub use reduced_time::ReducedTime;
pub use relaxation::{Relaxation, RelaxationTerm};
pub use shift::{GAS_CONSTANT, Shift, ShiftFit, fit_arrhenius, fit_wlf};
pub use table::CreepTable;
pub use temperature::TemperatureFactors;
pub use thermal::ThermalCreep;
pub use vertical::VerticalShift;
