//! Closed forms and one-dimensional solutions to check against.
//!
//! Independent of the solver: nothing here uses a grid or a convolution.
//!
//! | case | type | source |
//! |---|---|---|
//! | elastic sphere, ellipsoid, cylinder | [`HertzSphere`], [`HertzEllipse`], [`HertzLine`] | Hertz 1881 |
//! | elastic sphere with hardness | [`CappedHertz`] | ring displacements of Love 1929 |
//! | elastic cone, flat punch; punch under any history | [`SneddonCone`], [`CircularPunch`] | Sneddon 1965 |
//! | elastic waves; wave on a viscoelastic body | [`Westergaard`], [`JohnsonWave`], [`WestergaardStep`] | Westergaard 1939, Johnson et al. 1985 |
//! | sphere on a viscoelastic body, contact growing then shrinking | [`Ting`] | Ting 1966 |
//! | sphere, cone on a viscoelastic body, any history | [`Mdr`] | Popov & Hess 2015 |

mod capped_hertz;
mod elliptic;
mod hereditary;
mod hertz;
mod mdr;
mod quadrature;
mod sneddon;
mod ting;
mod westergaard;

pub use capped_hertz::CappedHertz;
pub use elliptic::{Elliptic, elliptic};
pub use hertz::{HertzEllipse, HertzLine, HertzSphere};
pub use mdr::{Mdr, MdrOptions, MdrProfile, MdrState, MdrTarget};
pub use sneddon::{CircularPunch, SneddonCone};
pub use ting::{Ting, TingState};
pub use westergaard::{JohnsonWave, Westergaard, WestergaardStep};
