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
mod store;
mod sweep;

use asperity::seal::Profile;

pub use answer::{MILLILITRES_A_YEAR, Over, SealAnswer, Spread};
pub use sweep::{SealError, SealSweep, SeedSweep, sweep};

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
    /// Viscosity of the liquid \[Pa s\].
    pub viscosity: f64,
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
        let at = |inlet: f64| self.profile.largest(inlet).unwrap_or(0.0);
        let ends = [self.ends[0], self.reach()].map(at);
        ends[0].max(ends[1]) - self.ends[1]
    }
}
