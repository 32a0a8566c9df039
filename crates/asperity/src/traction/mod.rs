//! Tractions on the surfaces that depend on the gap between them: adhesion, fluid pressure.
//!
//! The total traction is t = b + q with the traction b of the law and the contact pressure q >= 0, q g = 0. Given b the contact is
//! the same convex problem with another gap and load, so one loop around the unchanged contact solver serves every law:
//!
//! ```text
//! b = that of the last row
//! repeat:
//!     h' = h + c K b                                    one convolution
//!     q, w = contact of c K, h', load W/A - Σ b or approach w
//!     g = h' + c K q - w,   B = b(g, q),   f = B - b
//!     stop where Σ|f| <= tolerance (Σ|B| + Σ q), in which a force counts as none below 1e-4 of the largest one so far
//!     b = extrapolation of the last passes where it lowers the residual, else a plain step
//! ```
//!
//! Under a prescribed load W a pass in which Σ b alone exceeds W/A leaves no load to the contact. Then the approach is searched at
//! which the tractions carry W; an attraction that falls with the gap carries none stably, so there the surfaces are pulled off. After convergence the
//! state holds t and U = K t: what the bodies remember is the total traction.
//!
//! Each attempt at a row begins with the b of the last row, not with that of the attempt before: where several equilibria
//! exist the row is on the branch that is connected with the last one.
//!
//! | file | content |
//! |---|---|
//! | `solver` | the loop |
//! | `search` | the approach at which the tractions carry a load |
//! | `adhesion`, `scale` | adhesion, and what is known of it before a run |
//! | `fluid` | the pressure of a fluid in the gap |

mod adhesion;
mod fluid;
mod scale;
mod search;
mod solver;
#[cfg(test)]
mod tests;

pub use adhesion::{Adhesion, AdhesionLaw, FINE_TRAP, LARGEST_TRAP, own_response};
pub use fluid::{Action, FluidPressure, OpeningPressure, Pockets};
pub use scale::AdhesionScale;
pub(crate) use solver::TractionSolver;
use solver::Tractions;

use crate::error::Result;
use crate::grid::Grid;
use crate::quantities::Quantity;
use crate::simulation::Simulation;
use crate::time::Instant;

/// A law of tractions, of which each run starts its own.
pub trait TractionLaw: std::fmt::Debug + Send + Sync {
    /// The tractions of a run on this grid.
    fn start(&self, grid: &Grid) -> Box<dyn SurfaceTraction>;

    /// Tolerances of the loop and of the contact of a pass, where that of a contact alone would be `contact`.
    fn tolerances(&self, contact: f64) -> [f64; 2] {
        [contact, 0.1 * contact]
    }

    /// The law of adhesion, where it is one.
    fn as_adhesion(&self) -> Option<&Adhesion> {
        None
    }

    /// The fluid, where it is one.
    fn as_fluid(&self) -> Option<&FluidPressure> {
        None
    }

    /// The quantities that every row has.
    fn quantities(&self) -> Vec<Quantity> {
        vec![]
    }

    /// Times in (0, end) at which the law has a kink \[s\]; steps end there.
    fn breaks(&self, _end: f64) -> Vec<f64> {
        vec![]
    }

    /// Memory that it takes besides the loop \[bytes\].
    fn bytes(&self, _grid: &Grid) -> usize {
        0
    }

    /// What can be known to be wrong before the first solve.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid), whose parameter is a key of the case.
    fn check(&self, _simulation: &Simulation) -> Result<()> {
        Ok(())
    }
}

/// Tractions on the surfaces that depend on the gap.
pub trait SurfaceTraction: Send {
    /// The instant that is solved for.
    fn begin(&mut self, _at: &Instant) {}

    /// A solve begins, of bodies with this compliance \[1/Pa\], whose mean pressure rises by `rise` \[Pa\]: changes the traction of the
    /// last row by what follows at once.
    fn begin_solve(&mut self, _compliance: f64, _rise: f64, _traction: &mut [f64]) {}

    /// A loop begins: what was counted in the loop before is forgotten.
    fn begin_loop(&mut self) {}

    /// Writes the traction \[Pa\] that acts on each cell, or would act if it opened, over that of the pass; tension is negative. `gap` is
    /// g >= 0 \[m\], infinite where nothing can touch, `contact` the contact pressure q \[Pa\].
    ///
    /// # Errors
    /// Those of the law.
    fn bound(&mut self, gap: &[f64], contact: &[f64], out: &mut [f64]) -> Result<()>;

    /// The potential energy of these tractions per area of a cell \[Pa m\], Σ γ(g) with b = -dγ/dg; `None` where they have none.
    /// Where it is known, no pass may raise the total energy.
    fn energy(&self, _gap: &[f64]) -> Option<f64> {
        None
    }

    /// The least and the largest traction \[Pa\].
    fn limits(&self) -> [f64; 2] {
        [f64::NEG_INFINITY, f64::INFINITY]
    }

    /// Whether the last pass satisfies what its traction alone does not tell.
    fn is_settled(&self) -> bool {
        true
    }

    /// Whether γ is concave: then no plain pass raises the energy, and no surfaces that are apart hold a load in tension stably.
    fn is_attraction(&self) -> bool {
        false
    }

    /// Whether cells in contact press with b + q, because what acts on open cells is displaced where they close; else with q.
    fn is_displaced(&self) -> bool {
        false
    }

    /// A number of the law after the last pass.
    fn quantity(&self, _quantity: Quantity) -> Option<f64> {
        None
    }

    /// The step stands: what the law remembers of it is kept.
    fn commit(&mut self) {}

    /// The fields that the law remembers from row to row.
    fn memory(&self) -> Vec<&[f64]> {
        vec![]
    }

    /// The same, to be taken back.
    fn memory_mut(&mut self) -> Vec<&mut [f64]> {
        vec![]
    }
}
