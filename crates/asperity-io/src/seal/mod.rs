//! A whole seal: the case is a patch of it, run at several mean pressures; the march of [`asperity::seal`] does the rest.
//!
//! ```text
//! sweep/       a study of the patch: mean pressures that are equally far apart in their logarithm, each with every seed
//! refined/     the same at further pressures: where the patch closes, and where the leak needs them
//! seal.json    the answers, the pressure in the seal and the sweep; SI
//! seal.csv     the leak over the inlet pressure; SI
//! ```

mod answer;
mod findings;
mod fluid;
mod refine;
mod store;
mod sweep;

use asperity::seal::Profile;

pub use answer::{Over, SealAnswer, Spread};
pub use store::yearly;
pub use sweep::{PatchFinding, SealError, SealSweep, SeedSweep, State, label, sweep};

use crate::leakage::Leak;

/// What a case says of its seal.
#[derive(Clone, Debug, PartialEq)]
pub struct SealPlan {
    /// The contact pressure.
    pub profile: Profile,
    /// Length across the flow \[m\].
    pub length: f64,
    /// Mean pressures of the sweep, a quarter of them where the patch closes; up to so many more are added until the leak stands.
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

/// The sweep begins at the largest pressure over this.
pub(crate) const RANGE: f64 = 300.0;
/// The share of the pressures that lies where the patch closes.
const CLOSING: usize = 4;

impl SealPlan {
    /// Pressures with which the sweep begins.
    pub fn first_pressures(&self) -> usize {
        self.pressures - self.closing_pressures()
    }

    /// The ratio of two neighbours of them.
    pub(crate) fn first_ratio(&self) -> f64 {
        RANGE.powf(1.0 / (self.first_pressures() - 1) as f64)
    }

    /// Pressures where the patch closes.
    pub(crate) fn closing_pressures(&self) -> usize {
        self.pressures / CLOSING
    }

    /// Runs of the patch, at least and at most.
    pub fn runs(&self) -> [usize; 2] {
        [self.first_pressures(), self.first_pressures() + self.pressures]
            .map(|pressures| self.seeds * pressures)
    }

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
