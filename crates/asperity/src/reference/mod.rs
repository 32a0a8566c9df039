//! Closed forms and one-dimensional solutions for checks.
//!
//! They are independent of the solver: nothing here uses a convolution, and only the matrix ([`Dense`]), [`gauss_seidel`], [`Persson`]
//! and [`full_contact_friction`] use a grid.
//!
//! | case | type | source |
//! |---|---|---|
//! | elastic sphere, ellipsoid, cylinder | [`HertzSphere`], [`HertzEllipse`], [`HertzLine`] | Hertz 1881 |
//! | elastic sphere with adhesion: DMT, JKR, Maugis | [`AdhesiveSphere`] | Maugis 1992 |
//! | elastic sphere with hardness | [`CappedHertz`] | ring displacements of Love 1929 |
//! | elastic cone, flat punch; punch under any history | [`SneddonCone`], [`CircularPunch`] | Sneddon 1965 |
//! | elastic waves; wave on a viscoelastic body | [`Westergaard`], [`WestergaardStep`] | Westergaard 1939 |
//! | sphere on a viscoelastic body, contact growing then shrinking | [`Ting`] | Ting 1966 |
//! | sphere, cone on a viscoelastic body, any history | [`Mdr`] | Popov & Hess 2015 |
//! | sphere, cone on an elastic layer on a rigid base | [`LayerContact`] | Lebedev & Ufliand 1958 |
//! | cylinder that rolls or slides on a viscoelastic body | [`HunterCylinder`] | Hunter 1961 |
//! | waves that slide on a viscoelastic body in full contact | [`full_contact_friction`] | Persson 2001 |
//! | friction and contact area of a rough surface, an estimate | [`Persson`] | Persson 2001, Yang & Persson 2008 |
//! | any elastic contact on a small grid | [`Dense`], [`gauss_seidel`] | Wilton et al. 1984 |

mod adhesive_sphere;
mod bessel;
mod capped_hertz;
mod dense;
mod elliptic;
mod gauss_seidel;
mod hereditary;
mod hertz;
mod hunter;
mod layer_contact;
mod line_hertz;
mod mdr;
mod persson;
mod quadrature;
mod sliding;
mod sneddon;
mod ting;
mod westergaard;

pub(crate) use adhesive_sphere::BarPoint;
pub use adhesive_sphere::{
    AdhesiveModel, AdhesivePoint, AdhesiveSphere, carpick_alpha, maugis_lambda, tabor,
};
pub use capped_hertz::CappedHertz;
pub use dense::Dense;
pub use elliptic::{Elliptic, elliptic};
pub use gauss_seidel::gauss_seidel;
pub use hertz::{HertzEllipse, HertzSphere};
pub use hunter::HunterCylinder;
pub use layer_contact::LayerContact;
pub(crate) use layer_contact::SpringProfile;
pub use line_hertz::HertzLine;
pub use mdr::{Mdr, MdrOptions, MdrProfile, MdrState, MdrTarget};
pub use persson::{Correction, Magnification, Persson, PerssonFriction};
pub use sliding::full_contact_friction;
pub use sneddon::{CircularPunch, SneddonCone};
pub use ting::{Ting, TingState};
pub use westergaard::{Westergaard, WestergaardStep};
