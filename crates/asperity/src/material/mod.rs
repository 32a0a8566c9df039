//! Linear viscoelastic materials: creep, relaxation, models. Knows time, no space.

mod creep;
mod relaxation;

pub use creep::{Creep, CreepTerm};
pub use relaxation::{Relaxation, RelaxationTerm};
