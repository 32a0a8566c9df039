//! The mean driver of the displacements under a load: the driver of waves that creep differently.
//!
//! Under load control u runs linearly in L = ∫ C dW where space and time separate (see [`super::shape`]). Where waves creep
//! differently, L is that of a mean creep function: the mean of the C_k(t) of the waves, each with the weight |p^|² that it has in the
//! pressure that the load brings first.
//!
//! While the approach is held, u changes outside of the contact only, because the pressure relaxes. It runs as the pressure of the
//! mean then, Σ A_i (1 - exp(-s/τ_i)) with A_i = E_i (L - q_i). Otherwise u runs linearly in time.

use crate::error::Result;
use crate::history::relaxation::load_cell::LoadCell;
use crate::history::relaxation::rules::{Driver, Rules, Share};
use crate::history::relaxation::shape::{fading_share, moment};
use crate::history::relaxation::{growing, soon};
use crate::material::{Creep, CreepTerm, Dual};
use crate::step::{Load, Loader, Piece, Saver};

/// A term of the other sign below this share of the largest is rounding.
const ROUNDING: f64 = 1e-12;

/// How u runs over a step.
pub(super) enum Run {
    /// Linearly in time, or in L.
    Linear(Driver),
    /// As a sum of terms (A, τ) that relax.
    Relaxing(Vec<(f64, f64)>),
}

pub(super) struct Mean {
    dual: Dual,
    rules: Rules,
    cell: LoadCell,
}

impl Mean {
    /// Of a creep function, after a first step of length `x` in which the load ran from 0 to `load`.
    pub(super) fn new(creep: Creep, x: f64, load: f64) -> Result<Self> {
        let dual = Dual::of(creep)?;
        let mut mean = Mean { rules: Rules::new(dual.states()), cell: LoadCell::at_rest(&dual), dual };
        mean.run(Load::Total(load), x);
        mean.close(load);
        Ok(mean)
    }

    /// The row has ended.
    pub(super) fn begin(&mut self) {
        self.cell.begin();
    }

    /// How u runs over a step of length `x`.
    pub(super) fn run(&mut self, imposed: Load, x: f64) -> Run {
        let load = match imposed {
            Load::Total(load) => Some(load),
            Load::Apart => Some(0.0),
            Load::Approach | Load::Held => None,
        };
        let driver = self.cell.driver(&self.dual, load, x);
        self.rules.set(&self.dual, x, driver, &self.cell.shape);
        let start = &self.cell.start;
        let states = self.dual.relaxation.terms.iter().zip(&start.states);
        let relaxing = states.map(|(e, q)| (e.modulus * (start.driver - q), e.relaxation_time));
        let relaxing: Vec<(f64, f64)> = relaxing.collect();
        let most = relaxing.iter().fold(0.0, |most: f64, (a, _)| most.max(*a));
        let one_way = most > 0.0 && relaxing.iter().all(|(a, _)| *a >= -ROUNDING * most);
        match imposed == Load::Held && x > 0.0 && one_way {
            true => Run::Relaxing(relaxing),
            false => Run::Linear(driver),
        }
    }

    /// The step under way ends under this load.
    pub(super) fn close(&mut self, load: f64) {
        self.cell.close(load, Some(&self.rules));
    }

    /// How long the first step of a smooth piece may be \[s\], at most `longest`.
    pub(super) fn first_step(&mut self, piece: &Piece, longest: f64) -> f64 {
        let relaxed = if piece.is_after_jump { soon(&self.dual, longest, 1.0) } else { longest };
        let Some(slope) = piece.load_rate(1e-3 * longest) else { return relaxed };
        self.cell.go_on(&self.dual, slope);
        growing(&self.dual, &self.cell.shape, self.cell.end.driver, [relaxed, longest], 1.0)
    }

    /// What a state with the relaxation time `tau` takes over a step of length `x` in which u runs so.
    pub(super) fn share(&self, run: &Run, tau: f64, x: f64) -> Share {
        match run {
            Run::Relaxing(terms) => fading_share(terms, tau, x),
            Run::Linear(Driver::Time) => linear(x / tau),
            Run::Linear(Driver::Load(change)) => {
                let gap = |j: usize| self.dual.creep.terms[j].retardation_time / tau - 1.0;
                self.cell.shape.share_of(&self.dual, tau, gap, x, *change)
            }
        }
    }

    /// Saves the creep function and the load as a cell.
    pub(super) fn save<'a>(&'a self, to: &mut Saver<'a>) {
        let creep = &self.dual.creep;
        let terms = creep.terms.iter().flat_map(|t| [t.compliance, t.retardation_time]);
        to.value("instantaneous", &creep.instantaneous);
        to.value("terms", &terms.collect::<Vec<f64>>());
        self.cell.save_own(to);
    }

    /// What [`Mean::save`] gave.
    pub(super) fn load(from: &mut Loader<'_>) -> Result<Self> {
        let terms = from.numbers("terms")?;
        let terms = terms.chunks_exact(2);
        let terms = terms.map(|t| CreepTerm { compliance: t[0], retardation_time: t[1] }).collect();
        let creep = Creep { instantaneous: from.get("instantaneous")?, terms, fluidity: 0.0 };
        let mut mean = Mean::new(creep, 0.0, 0.0)?;
        mean.cell.load_own(from)?;
        Ok(mean)
    }
}

/// u linear in time.
pub(super) fn linear(y: f64) -> Share {
    Share { taken: moment(1, y), left: moment(0, y) / y }
}
