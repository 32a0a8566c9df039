//! How far the surfaces recede in a step.

use asperity_sweep::{each, sums};

use crate::operator::Bed;

/// κ max(p - p_0, 0), p the pressure at the end of the step: κ = `scale`, in each cell times that of `cells` where there are any.
#[derive(Clone, Debug, Default)]
pub(crate) struct Recession {
    pub(crate) scale: f64,
    pub(crate) cells: Option<Vec<f64>>,
    pub(crate) threshold: f64,
}

impl Recession {
    pub(crate) fn is_none(&self) -> bool {
        self.scale == 0.0
    }

    /// κ of all cells.
    pub(crate) fn per_pressure(&self) -> Bed<'_> {
        Bed { scale: self.scale, cells: self.cells.as_deref() }
    }

    /// The bed that stands for it in a contact of compliance c, where all pressures count.
    pub(crate) fn bed(&self, compliance: f64) -> Bed<'_> {
        let scale = if self.is_none() { 0.0 } else { self.scale / compliance };
        Bed { scale, cells: self.cells.as_deref() }
    }

    /// Adds the depth under a pressure to a gap.
    pub(crate) fn add(&self, pressure: &[f64], gap: &mut [f64]) {
        let threshold = self.threshold;
        each(gap, (pressure, self.per_pressure()), |h, (p, k)| *h += depth(p, k, threshold));
    }

    /// Σ ∫ p dz of a pressure that grows with the depth z, from 0 \[Pa m\].
    pub(crate) fn work(&self, pressure: &[f64]) -> f64 {
        if self.is_none() {
            return 0.0;
        }
        let threshold = self.threshold;
        let of = |(p, k): (f64, f64)| [0.5 * (p + threshold) * depth(p, k, threshold)];
        let [work] = sums((pressure, self.per_pressure()), of);
        work
    }
}

/// κ max(p - p_0, 0) of a cell.
#[inline(always)]
pub(crate) fn depth(pressure: f64, per_pressure: f64, threshold: f64) -> f64 {
    if pressure > threshold { per_pressure * (pressure - threshold) } else { 0.0 }
}
