//! Poisson's ratio of the body whose stress is computed.

use std::fmt;

use asperity::material::{Body, Creep, PoissonCreep};
use asperity::stress::{PressureHistory, SubsurfaceStress};
use asperity::{Boundary, Grid};
use serde::{Deserialize, Serialize};

/// Poisson's ratio of a body. As JSON it is a number, or the functions of a [`ChangingRatio`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Ratio {
    /// Constant in time.
    Constant(f64),
    /// Of a viscoelastic body of constant bulk modulus: it changes with time, and the stress follows from the pressures of all
    /// rows up to its time.
    Changing(ChangingRatio),
}

/// Poisson's ratio that changes with time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChangingRatio {
    /// How.
    #[serde(flatten)]
    pub creep: PoissonCreep,
    /// Contact creep compliance of the pair \[1/Pa\]: pressures follow it between two rows.
    pub contact: Creep,
}

impl ChangingRatio {
    /// The history of the pressures on a grid, from the beginning on.
    ///
    /// # Errors
    /// As [`PressureHistory::new`].
    pub fn history(&self, grid: Grid) -> asperity::Result<PressureHistory> {
        PressureHistory::new(&self.creep, &self.contact, grid)
    }
}

impl Ratio {
    /// That of a body in a pair with the contact creep compliance `contact`, if no temperature changes it; `None` where it is not known.
    pub fn of(body: &Body, contact: Option<&Creep>) -> Option<Ratio> {
        let changing = || {
            let (creep, contact) = (body.poisson_creep().ok()?, contact?.clone());
            Some(Ratio::Changing(ChangingRatio { creep, contact }))
        };
        body.poisson().map(Ratio::Constant).or_else(changing)
    }

    /// The ratio where it is constant.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Ratio::Constant(ratio) => Some(*ratio),
            Ratio::Changing(_) => None,
        }
    }

    /// The transforms for a body of this ratio.
    ///
    /// # Errors
    /// As [`SubsurfaceStress::new`].
    pub fn transforms(&self, grid: Grid, boundary: Boundary) -> asperity::Result<SubsurfaceStress> {
        // That of a history does not count.
        SubsurfaceStress::new(grid, boundary, self.constant().unwrap_or(0.0))
    }

    /// Bytes that transforms, six components and what is kept of earlier pressures take.
    pub fn bytes(&self, grid: &Grid, boundary: Boundary, tractions: bool) -> usize {
        let transforms = SubsurfaceStress::bytes(grid, boundary, tractions);
        match self {
            Ratio::Constant(_) => transforms,
            // A second pressure and its transform, and the fields that they are made from.
            Ratio::Changing(ChangingRatio { creep, contact }) => {
                transforms + PressureHistory::bytes(creep, contact, grid) + 8 * 7 * grid.len()
            }
        }
    }
}

impl From<f64> for Ratio {
    fn from(ratio: f64) -> Self {
        Ratio::Constant(ratio)
    }
}

impl fmt::Display for Ratio {
    /// "0.3", or "0.406 at once to 0.452 in the end".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Ratio::Constant(ratio) => write!(f, "{ratio}"),
            Ratio::Changing(ChangingRatio { creep: PoissonCreep { ratio, .. }, .. }) => {
                write!(f, "{:.3} at once to {:.3} in the end", ratio.instantaneous, ratio.long_time())
            }
        }
    }
}
