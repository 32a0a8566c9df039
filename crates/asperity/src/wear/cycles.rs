//! How many cycles of slip a computed one stands for.

use super::Wear;
use crate::simulation::Simulation;
use crate::step::saved;

/// The factor may change by this much from cycle to cycle.
const CHANGE: f64 = 2.0;
/// A cycle ends this share of it before its end.
const ROUNDING: f64 = 1e-9;

/// Of constant number, or such that the place of a given share of what a cycle wears is uncertain.
pub(crate) struct Cycles {
    most: f64,
    tolerance: Option<f64>,
    /// Of the load along the surfaces \[s\]; `None` where it has none.
    period: Option<f64>,
    /// For how many the present one stands.
    pub(crate) factor: f64,
    /// Cycles so far, and computed ones that are over.
    total: f64,
    over: f64,
    /// What this one has worn so far, and how much of it may be in the wrong place \[m³\].
    volume: f64,
    uncertain: f64,
    /// What one cycle wears by the last computed one that is over, 0 before \[m³\].
    before: f64,
}

saved! {
    Cycles {
        "cycles": factor, total, over, volume, uncertain, before;
    }
}

impl Cycles {
    pub(crate) fn of(law: &Wear, simulation: &Simulation) -> Self {
        let period = simulation.tangential.as_ref().and_then(|tangential| tangential.period());
        let factor = if law.cycles_tolerance.is_some() { 1.0 } else { law.cycles };
        Cycles {
            most: law.cycles,
            tolerance: law.cycles_tolerance,
            period,
            factor,
            total: 0.0,
            over: 0.0,
            volume: 0.0,
            uncertain: 0.0,
            before: 0.0,
        }
    }

    /// Whether no cycle can be compared with another one yet, although they stand for more.
    pub(crate) fn are_alone(&self) -> bool {
        self.period.is_some() && self.tolerance.is_none() && self.over < 2.0 && self.factor > 1.0
    }

    /// Cycles so far; NaN where the load has no period.
    pub(crate) fn total(&self) -> f64 {
        if self.period.is_some() { self.total } else { f64::NAN }
    }

    /// Takes in a row at the end of a step, and what it has worn. Returns the volume that is uncertain because a computed cycle that is over
    /// wears another volume than the cycles that it stands for.
    pub(crate) fn take_in(&mut self, [start, time]: [f64; 2], [volume, uncertain]: [f64; 2]) -> f64 {
        let Some(period) = self.period else { return 0.0 };
        let mut error = 0.0;
        self.total += self.factor * (time - start) / period;
        self.volume += volume;
        self.uncertain += uncertain;
        if time >= (self.over + 1.0 - ROUNDING) * period {
            self.over = (time / period + ROUNDING).floor();
            let one = self.volume / self.factor;
            // The volume of a cycle goes on to change as it did since the cycle before; the first one is a start, unlike the others.
            error = match self.before {
                0.0 => 0.0,
                before if self.over > 2.0 => 0.5 * (self.factor - 1.0) * (one - before).abs(),
                before => 1.5 * (self.factor - 1.0) * (one - before).abs(),
            };
            self.before = one;
            self.uncertain += error;
            if let (Some(tolerance), true) = (self.tolerance, self.volume > 0.0) {
                let fits = tolerance * self.volume / self.uncertain;
                let change = if fits.is_nan() { CHANGE } else { fits.clamp(1.0 / CHANGE, CHANGE) };
                self.factor = (self.factor * change).clamp(1.0, self.most);
            }
            (self.volume, self.uncertain) = (0.0, 0.0);
        }
        error
    }
}
