//! Wear: what sliding takes off the surfaces, by Archard's law in each cell (Archard, J. Appl. Phys. 24, 1953, 981).
//!
//! ```text
//! dz/ds = k max(p - p_0, 0)      z depth, s sliding distance, k = K/H coefficient [m²/N], p_0 threshold
//! ```
//!
//! Each step is implicit: the surfaces recede by κ max(p - p_0, 0), p the pressure at its end and κ = k ds. To the contact that is a bed
//! of springs of compliance κ ([`Bed`](crate::operator)): any step is stable, and the certificate holds. The worn volume is k W s exactly where W is the
//! load at the end of each step; where it is worn has an error of first order in the step, which is estimated.
//!
//! Depths are those of the body, which moves with the contact, and of the counterbody. Where nothing moves on the grid both stay in place.

mod cycles;
mod depth;
mod law;
mod recession;
mod solver;
#[cfg(test)]
mod tests;

pub use law::Wear;

pub(crate) use cycles::Cycles;
pub(crate) use depth::Depth;
pub(crate) use law::Sliding;
pub(crate) use recession::{Recession, depth};
pub(crate) use solver::RecedingSolver;
