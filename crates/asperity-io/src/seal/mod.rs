//! A whole seal: the case is a patch of it, run at several mean pressures; the march of [`asperity::seal`] does the rest.
//!
//! ```text
//! sweep/       a study of the patch: mean pressures that are equally far apart in their logarithm, each with every seed
//! refined/     the same between the pressures at which the patch closes
//! seal.json    the answers, the pressure in the seal and the sweep; SI
//! seal.csv     the leak over the inlet pressure; SI
//! ```

mod answer;
mod findings;
mod fluid;
mod store;
mod sweep;

use asperity::seal::Profile;

pub use answer::{Over, SealAnswer, Spread};
pub use store::yearly;
pub use sweep::{SealError, SealSweep, SeedSweep, State, sweep};

use crate::leakage::Leak;

/// What a case says of its seal.
#[derive(Clone, Debug, PartialEq)]
pub struct SealPlan {
    /// The contact pressure.
    pub profile: Profile,
    /// Length across the flow \[m\].
    pub length: f64,
    /// Mean pressures of the sweep.
    pub pressures: usize,
    /// Seeds of the roughness.
    pub seeds: usize,
    /// The first random roughness of the case.
    pub rough: Option<Rough>,
    /// The axis of the domain along which the fluid flows.
    pub patch: usize,
    /// Pressures \[Pa\] at inlet and outlet, counted as the contact pressure is.
    pub ends: [f64; 2],
    /// The fluid; there is one.
    pub leak: Leak,
    /// Names of the surfaces that were windowed.
    pub windowed: Vec<String>,
}

/// A random roughness.
#[derive(Clone, Debug, PartialEq)]
pub struct Rough {
    /// Path of the key of its seed.
    pub key: String,
    /// The seed in the case.
    pub seed: u64,
    /// The longest wave \[m\], where the case gives it.
    pub longest: Option<f64>,
}

/// The answers show inlet pressures up to so many times the pressure drop.
const REACH: f64 = 1.5;

impl SealPlan {
    /// The largest inlet pressure that the answers show \[Pa\].
    pub fn reach(&self) -> f64 {
        let [inlet, outlet] = self.ends;
        let most = self.profile.inlets().map_or(f64::INFINITY, |[_, most]| most);
        (outlet + REACH * (inlet - outlet)).min(most)
    }

    /// The largest p0 - P in the seal \[Pa\] at these inlet pressures: the sweep goes up to it.
    pub fn largest(&self) -> f64 {
        let tables = self.profile.inlets_of_tables().unwrap_or_default();
        let shown = tables.into_iter().filter(|inlet| *inlet < self.reach());
        let largest =
            shown.chain([self.ends[0], self.reach()]).filter_map(|inlet| self.profile.largest(inlet));
        largest.fold(0.0, f64::max) - self.ends[1]
    }
}
