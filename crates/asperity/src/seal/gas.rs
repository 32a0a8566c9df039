//! A gas in a seal. Its density is in proportion to its pressure, and in narrow gaps it slips along the walls: with the absolute pressure
//! P_a = P + reference
//!
//! ```text
//! F = -sigma(p0 - P) r Q(D(P_a, h_c)) P_a dP/dx,   leak = F C/(12 mu R_s T) [kg/s]
//! ```
//!
//! Q is the factor of the rarefaction at the critical gap h_c of the patch ([`Rarefaction::factor`]), and r is what is left: the leak of
//! the gas through the patch over the one that sigma and h_c give. It is 1 in the continuum and depends weakly on the pressure
//! ([`gas_flow`](crate::leakage::gas_flow)), so that the r at the pressures of the patch serves for all.

use super::curve::Curve;
use crate::error::Result;
use crate::leakage::{Gas, Rarefaction, plate};

/// Pressure \[Pa\] below which a gas counts as a vacuum.
const VACUUM: f64 = 1e-200;

/// A gas, and how it flows through the patch.
#[derive(Clone, Debug, PartialEq)]
pub struct SealGas {
    gas: Gas,
    law: Rarefaction,
    reference: f64,
    /// D/(P h) \[1/(Pa m)\].
    scale: f64,
    /// h_c over sigma^(1/3).
    narrow: Curve,
    /// r.
    rest: Curve,
}

/// The flow of a gas through the patch at a pressure that leaks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GasPoint {
    /// Pressure that presses the patch \[Pa\].
    pub pressure: f64,
    /// Its conductance sigma \[m^3\].
    pub sigma: f64,
    /// Its critical gap \[m\].
    pub critical_gap: f64,
    /// Its leak \[kg/s\].
    pub leak_rate: f64,
}

impl SealGas {
    /// The gas and its law; the absolute pressure \[Pa\] around the seal when its contact pressure is stated; and the leaks through a
    /// patch with the sides `size` \[m\], along and across the flow, between the absolute pressures `ends` of inlet and outlet.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) if the pressures are not positive and falling.
    pub fn new(
        gas: Gas,
        law: Rarefaction,
        reference: f64,
        points: &[GasPoint],
        size: [f64; 2],
        ends: [f64; 2],
    ) -> Result<Self> {
        let narrow = |point: &GasPoint| (point.pressure, point.critical_gap / point.sigma.cbrt());
        let rest = |point: &GasPoint| {
            let plates = plate(&gas, law, point.critical_gap, size, ends)?;
            let expected = plates * point.sigma / point.critical_gap.powi(3);
            Ok((point.pressure, point.leak_rate / expected))
        };
        let narrow: Vec<_> = points.iter().map(narrow).collect();
        let rest: Result<Vec<_>> = points.iter().map(rest).collect();
        let (narrow, rest) = (Curve::through(&narrow), Curve::through(&rest?));
        Ok(SealGas { gas, law, reference, scale: gas.inverse_knudsen_scale(), narrow, rest })
    }

    /// h_c where the surface is pressed with `pressed` and conducts `sigma`.
    pub(super) fn critical_gap(&self, pressed: f64, sigma: f64) -> f64 {
        self.narrow.at(pressed) * sigma.cbrt()
    }

    /// r where the surface is pressed with `pressed`.
    pub(super) fn rest(&self, pressed: f64) -> f64 {
        self.rest.at(pressed)
    }

    /// Q P_a at a critical gap and a pressure of the fluid.
    pub(super) fn density(&self, critical_gap: f64, fluid: f64) -> f64 {
        let absolute = (fluid + self.reference).max(VACUUM);
        self.law.factor(self.scale * absolute * critical_gap) * absolute
    }

    /// Mean free path over critical gap where the surface is pressed with `pressed` and conducts `sigma`.
    pub(super) fn knudsen(&self, pressed: f64, sigma: f64, fluid: f64) -> f64 {
        self.gas.knudsen(fluid + self.reference, self.critical_gap(pressed, sigma))
    }
}
