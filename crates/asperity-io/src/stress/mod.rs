//! The stress below the surface of a result: computed from its stored pressures, and stored with it.
//!
//! A [`StressPlan`] says which body, depths and times; it comes from `[stress]` of a case or from the words of a command.
//! [`evaluate`] goes through the stored pressures, one at a time, and adds the arrays of [`crate::store::StressSet`] to the
//! result. [`Below`] is what it found, to be shown. [`section`] looks at one time more closely, and
//! [`crate::export::volume`] writes it for ParaView.

mod below;
mod evaluate;
mod plan;
mod pressures;
mod ratio;
mod section;
mod yielding;

pub use below::{Below, Instant};
pub use evaluate::{LAYERED, ROLLS_ALONG_LINE, StressError, evaluate, of_result, refuse_layers};
pub(crate) use evaluate::{boundary, depths};
pub use plan::{Depths, StressBody, StressDescription, StressPlan, bodies_of};
pub(crate) use plan::{POISSON_CREEP, SETUP};
pub(crate) use pressures::Pressures;
pub use ratio::{ChangingRatio, Ratio};
pub use section::{Section, below_at, section};
pub use yielding::{FirstYield, first_yield};
