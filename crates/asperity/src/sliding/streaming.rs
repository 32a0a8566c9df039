//! The compliance that a wave of pressure sees whose material streams by.
//!
//! In the frame of the contact a wave exp(i q.x) stands still; a point of the material that moves with velocity -v sees it
//! with the angular frequency q.v. Its displacement has the amplitude K^(q) C~(q.v) with
//!
//! C~(ω) = C0 + Σ C_j / (1 - i ω λ_j).
//!
//! C~(0) is the relaxed compliance, C~(∞) the instantaneous one. The imaginary part is what is lost: max sin δ, δ = arg C~, is
//! the contraction of the metric iteration (see [`super`]).

use rustfft::num_complex::Complex64;

use crate::error::{Result, require};
use crate::material::Creep;
use crate::simulation::Simulation;

/// The creep functions of the bodies whose material streams through the contact; each with how fast its clock runs.
#[derive(Clone, Debug)]
pub struct Streaming {
    parts: Vec<(Creep, f64)>,
}

impl Streaming {
    /// The bodies of a simulation, at the temperature that they have at the start.
    ///
    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) where the material flows, has no instantaneous compliance, or its temperature changes.
    pub fn new(simulation: &Simulation) -> Result<Self> {
        let mut parts = vec![(simulation.creep.clone(), 1.0)];
        for body in &simulation.thermal {
            let end = simulation.times.end();
            let rate = body.clock.elapsed(0.0, 1e-9 * end) / (1e-9 * end);
            let later = body.clock.elapsed(0.0, end) / end;
            let changes = (later / rate - 1.0).abs() > 1e-6;
            let (what, value) = ("temperature of a steady state", "one that changes in time");
            require(!changes, what, value, "a constant temperature")?;
            parts.push((body.creep.clone(), rate));
        }
        let streaming = Streaming { parts };
        require(
            streaming.parts.iter().all(|(creep, _)| creep.fluidity <= 0.0),
            "material of a steady state of motion",
            "one that flows (fluidity above 0)",
            "a solid: a fluid has no steady sliding state, as the bodies sink into each other for ever",
        )?;
        let (instantaneous, relaxed) = (streaming.instantaneous(), streaming.relaxed());
        require(
            instantaneous > 1e-6 * relaxed,
            "instantaneous compliance over the relaxed one",
            format!("{:e}", instantaneous / relaxed),
            "more than 1e-6: a body in motion needs an instantaneous compliance; add one of a thousandth of the relaxed \
             compliance at least (a Kelvin-Voigt material has none)",
        )?;
        Ok(streaming)
    }

    /// The same bodies with this share of what they yield in time yielded at once: C(∞) is kept.
    pub(super) fn hastened(&self, share: f64) -> Streaming {
        let mut hastened = self.clone();
        for (creep, _) in &mut hastened.parts {
            for term in &mut creep.terms {
                creep.instantaneous += share * term.compliance;
                term.compliance *= 1.0 - share;
            }
        }
        hastened
    }

    /// C(0+) \[1/Pa\].
    pub fn instantaneous(&self) -> f64 {
        self.parts.iter().map(|(creep, _)| creep.instantaneous).sum()
    }

    /// C(∞) \[1/Pa\].
    pub fn relaxed(&self) -> f64 {
        self.parts.iter().map(|(creep, _)| creep.long_time()).sum()
    }

    /// C~(ω) \[1/Pa\] at the angular frequency ω \[rad/s\].
    pub fn at(&self, omega: f64) -> Complex64 {
        let mut sum = Complex64::ZERO;
        for (creep, rate) in &self.parts {
            sum += creep.instantaneous;
            for term in &creep.terms {
                // C / (1 - i x) = C (1 + i x) / (1 + x²)
                let x = omega * term.retardation_time / rate;
                sum += term.compliance / (1.0 + x * x) * Complex64::new(1.0, x);
            }
        }
        sum
    }

    /// Compliances \[1/Pa\] and retardation times \[s\] of all branches, by the clocks of their bodies.
    pub fn branches(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let of = |(creep, rate): &(Creep, f64)| {
            let rate = *rate;
            creep
                .terms
                .iter()
                .map(move |term| (term.compliance, term.retardation_time / rate))
                .collect::<Vec<_>>()
        };
        self.parts.iter().flat_map(of)
    }
}
