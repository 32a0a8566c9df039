//! The conductance of the surface over the pressure that presses it: sigma(p).
//!
//! Between the last pressure of a sweep that leaks, p_a, and the first one that is tight, p_s, sigma falls as (p_s - p)^3.45 (Dapp and
//! Mueser, EPL 109, 44001, 2015). Nothing is extrapolated: outside of the sweep sigma is held, and [`Conductance::ends`] says where that
//! begins. What the sweep leaves open between its pressures is known: [`Conductance::low`] and [`Conductance::high`] are the least and the
//! largest sigma that its points allow.

use super::curve::Curve;
use super::gas::SealGas;
use crate::error::{Error, Result};

/// Exponent with which the conductance vanishes where the last path closes.
const CLOSING: f64 = 3.45;

/// sigma(p) \[m^3\] from a sweep over the pressure p \[Pa\], and the fluid that flows.
#[derive(Clone, Debug, PartialEq)]
pub struct Conductance {
    /// sigma at the pressures that leak.
    sigma: Curve,
    /// sigma below the first pressure over that at it.
    below: f64,
    /// The first pressure that is tight.
    tight: Option<f64>,
    /// The gas that flows; `None` for a liquid.
    gas: Option<SealGas>,
    /// Which sigma of those that the points allow.
    choice: Choice,
}

/// A sigma of those that the points of a sweep allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Low,
    Likely,
    High,
}

impl Conductance {
    /// The conductance of a sweep for a liquid: pressure \[Pa\] and sigma \[m^3\], 0 where it is tight. A tight pressure below one that
    /// leaks is scatter and left out.
    ///
    /// # Errors
    /// [`Error::Invalid`]: pressures that do not increase from above 0, a negative or infinite sigma, no pressure.
    pub fn new(sweep: &[(f64, f64)]) -> Result<Self> {
        for (n, (pressure, sigma)) in sweep.iter().enumerate() {
            let before = if n == 0 { 0.0 } else { sweep[n - 1].0 };
            if !(pressure.is_finite() && *pressure > before) {
                let expected = format!("a pressure above {before} Pa, that before it");
                return Err(Error::invalid("the pressure of the sweep", pressure, expected).of("sweep"));
            }
            if !(sigma.is_finite() && *sigma >= 0.0) {
                return Err(Error::invalid("the conductance", sigma, "a number of 0 or more").of("sweep"));
            }
        }
        if sweep.is_empty() {
            return Err(Error::invalid("the number of pressures of the sweep", 0, "one or more").of("sweep"));
        }
        let last = sweep.iter().rposition(|(_, sigma)| *sigma > 0.0);
        let tight = sweep.get(last.map_or(0, |last| last + 1)).map(|point| point.0);
        let leaking: Vec<(f64, f64)> = sweep.iter().copied().filter(|point| point.1 > 0.0).collect();
        Ok(Conductance {
            sigma: Curve::through(&leaking),
            below: 1.0,
            tight,
            gas: None,
            choice: Choice::Likely,
        })
    }

    /// The same for a gas.
    #[must_use]
    pub fn of_gas(self, gas: SealGas) -> Self {
        Conductance { gas: Some(gas), ..self }
    }

    /// The same with sigma below the first pressure of the sweep times `factor`: what the unknown there may change.
    #[must_use]
    pub fn with_below(&self, factor: f64) -> Self {
        Conductance { below: factor, ..self.clone() }
    }

    /// The least sigma that the sweep allows: the last path closes right above the last pressure that leaks.
    #[must_use]
    pub fn low(&self) -> Self {
        let tight = self.last_leaking().filter(|_| self.tight.is_some()).or(self.tight);
        Conductance { tight, choice: Choice::Low, ..self.clone() }
    }

    /// The largest sigma that the sweep allows: up to the first pressure that is tight it falls as it does before.
    #[must_use]
    pub fn high(&self) -> Self {
        Conductance { choice: Choice::High, ..self.clone() }
    }

    /// The first pressure that is tight \[Pa\]; `None` where all of the sweep leaks.
    pub fn sealing_pressure(&self) -> Option<f64> {
        self.tight
    }

    /// The last pressure that leaks \[Pa\]; `None` where none does.
    pub fn last_leaking(&self) -> Option<f64> {
        self.sigma.pressures.last().copied()
    }

    /// The pressures between which sigma is known: first and last of the sweep, or no end where it is tight.
    pub fn ends(&self) -> [f64; 2] {
        let first = self.sigma.pressures.first().copied().or(self.tight).unwrap_or(f64::INFINITY);
        let last = if self.tight.is_some() { f64::INFINITY } else { self.last_leaking().unwrap_or(0.0) };
        [first, last]
    }

    /// sigma \[m^3\] at a pressure \[Pa\].
    pub fn at(&self, pressure: f64) -> f64 {
        let [first, _] = self.ends();
        let Some(last) = self.last_leaking() else { return 0.0 };
        let held = || match self.choice {
            Choice::Low => self.sigma.bounds(pressure)[0],
            Choice::Likely => self.sigma.at(pressure),
            Choice::High => self.sigma.bounds(pressure)[1],
        };
        match self.tight {
            _ if pressure < first => self.below * held(),
            Some(tight) if pressure >= tight => 0.0,
            Some(_) if pressure > last && self.choice == Choice::High => self.sigma.beyond(pressure),
            Some(tight) if pressure > last => held() * ((tight - pressure) / (tight - last)).powf(CLOSING),
            _ => held(),
        }
    }

    /// The pressures of the sweep around this one \[Pa\], between which sigma is not known; `None` outside of it.
    pub fn around(&self, pressure: f64) -> Option<[f64; 2]> {
        let known = &self.sigma.pressures;
        let after = known.partition_point(|known| *known <= pressure);
        let to = known.get(after).copied().or(self.tight.filter(|tight| pressure < *tight))?;
        Some([*known.get(after.checked_sub(1)?)?, to])
    }

    /// The surface where it is pressed with `pressed` \[Pa\].
    pub(super) fn pressed(&self, pressed: f64) -> Pressed<'_> {
        let sigma = self.at(pressed);
        match &self.gas {
            Some(gas) if sigma > 0.0 => Pressed {
                sigma: sigma * gas.rest(pressed),
                gas: Some((gas, gas.critical_gap(pressed, sigma))),
            },
            _ => Pressed { sigma, gas: None },
        }
    }

    /// Mean free path over critical gap, of a gas, where the surface is pressed with `pressed` and the fluid has the pressure `fluid` \[Pa\].
    pub fn knudsen(&self, pressed: f64, fluid: f64) -> Option<f64> {
        self.gas.as_ref().map(|gas| gas.knudsen(pressed, self.at(pressed), fluid))
    }

    /// Pressures between which sigma is smooth, falling.
    pub(super) fn breaks(&self) -> impl Iterator<Item = f64> + '_ {
        self.tight.into_iter().chain(self.sigma.pressures.iter().rev().copied())
    }
}

/// The surface under a pressure.
#[derive(Clone, Copy)]
pub(super) struct Pressed<'a> {
    /// sigma, of a gas times r.
    sigma: f64,
    /// The gas and the critical gap.
    gas: Option<(&'a SealGas, f64)>,
}

impl Pressed<'_> {
    /// k of F = -k dP/dx where the fluid has the pressure `fluid` \[Pa\].
    pub(super) fn flux(&self, fluid: f64) -> f64 {
        self.gas.map_or(self.sigma, |(gas, critical_gap)| self.sigma * gas.density(critical_gap, fluid))
    }
}
