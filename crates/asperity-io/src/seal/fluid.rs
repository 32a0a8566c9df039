//! The fluid of a seal: what the patch tells of its flow, and leaks from the F of the march.

use asperity::leakage::{Gas, Rarefaction, standard};
use asperity::seal::{Conductance, GasPoint, SealGas};

use super::{SealPlan, SealSweep};
use crate::leakage::Fluid;

/// cm^3/min at 0 degC and one atmosphere in 1 Pa m^3/s at 0 degC.
const SCCM: f64 = 60e6 / 101_325.0;

/// A gas at a time.
struct GasAt {
    gas: Gas,
    law: Rarefaction,
    /// Absolute pressures \[Pa\] at inlet and outlet.
    ends: [f64; 2],
}

impl SealPlan {
    fn gas(&self, time: f64) -> asperity::Result<Option<GasAt>> {
        let Some(Fluid::Gas { kind, temperature, inlet, outlet, rarefaction }) = self.leak.fluid else {
            return Ok(None);
        };
        let gas = self.leak.gas(kind, temperature, time)?;
        Ok(Some(GasAt { gas, law: rarefaction, ends: [inlet, outlet] }))
    }

    /// Whether a gas flows.
    pub fn is_gas(&self) -> bool {
        matches!(self.leak.fluid, Some(Fluid::Gas { .. }))
    }

    /// The SI unit of its leak.
    pub fn unit(&self) -> &'static str {
        if self.is_gas() { "kg/s" } else { "m3/s" }
    }

    /// The leak of the whole seal \[m^3/s; gas kg/s\] where F is 1, at a time \[s\].
    pub(super) fn leak_of_flow(&self, time: f64) -> asperity::Result<f64> {
        let of = |viscosity: f64| self.length / (12.0 * viscosity);
        Ok(match (self.gas(time)?, self.leak.fluid) {
            (Some(at), _) => of(at.gas.viscosity) / at.gas.specific_energy(),
            (None, Some(Fluid::Liquid { viscosity, .. })) => of(viscosity),
            (None, _) => f64::NAN,
        })
    }

    /// The leak \[Pa m^3/s at 0 degC\] of a gas that leaks 1 kg/s; `None` of a liquid.
    pub fn standard(&self) -> Option<f64> {
        let at = self.gas(0.0).ok()??;
        Some(standard(1.0, &at.gas))
    }

    /// The leak \[cm^3/min at 0 degC and one atmosphere\] of a gas that leaks 1 kg/s; `None` of a liquid.
    pub fn sccm(&self) -> Option<f64> {
        self.standard().map(|standard| SCCM * standard)
    }

    /// The absolute pressure \[Pa\] around the seal when its contact pressure is stated, of a gas.
    pub fn around(&self) -> Option<f64> {
        let at = self.gas(0.0).ok()??;
        Some(at.ends[1] - self.ends[1])
    }
}

impl SealSweep {
    /// What the n-th seed conducts of the fluid of the seal at a stored time.
    ///
    /// # Errors
    /// The sweep makes no conductance, or its leaks no gas.
    pub fn conductance(&self, plan: &SealPlan, seed: usize, time: usize) -> asperity::Result<Conductance> {
        let dry = self.seeds[seed].conductance(time)?;
        let Some(GasAt { gas, law, ends }) = plan.gas(self.times[time])? else { return Ok(dry) };
        let points = self.seeds[seed].points.iter().map(|(pressure, states)| (*pressure, states[time]));
        let leaking = points.filter(|(_, state)| state.sigma > 0.0).map(|(pressure, state)| GasPoint {
            pressure,
            sigma: state.sigma,
            critical_gap: state.critical_gap,
            leak_rate: state.leak_rate,
        });
        let size = [self.size[plan.patch], self.size[1 - plan.patch]];
        let reference = ends[1] - plan.ends[1];
        let gas = SealGas::new(gas, law, reference, &leaking.collect::<Vec<_>>(), size, ends)?;
        Ok(dry.of_gas(gas))
    }
}
