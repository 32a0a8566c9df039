//! The answers about a seal: leak, opening pressure, pressure inside, over the inlet pressure and over time.

use asperity::finding::Finding;
use asperity::seal::{CELLS, Conductance, Opens, SealFlow, SealState, bounds, flow, opening};
use rayon::prelude::*;

use super::sweep::{PatchFinding, SealError, SealSweep};
use super::{SealPlan, findings, refine};
use crate::answer::{Answer, Validity};

/// Inlet pressures of the curve.
const INLETS: usize = 24;
/// Largest share of the leak at an inlet pressure of the curve that the sweep may leave open, a factor of two: the leak goes with the cube
/// of the gap, so that the gap is then known to a quarter.
pub(super) const COARSE: f64 = 0.5;
/// By how much the inlet pressure is raised to say how the leak grows with it.
const RAISE: f64 = 1.1;

/// A number of all seeds.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Least.
    pub least: f64,
    /// Largest.
    pub largest: f64,
}

impl Spread {
    /// That of these numbers; not known where one of them is not.
    pub fn of(values: &[f64]) -> Spread {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        if mean.is_nan() {
            return Spread { mean, least: mean, largest: mean };
        }
        Spread {
            mean,
            least: values.iter().copied().fold(f64::INFINITY, f64::min),
            largest: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// The same times a factor.
    #[must_use]
    pub fn times(&self, factor: f64) -> Spread {
        Spread { mean: factor * self.mean, least: factor * self.least, largest: factor * self.largest }
    }
}

/// A leak \[m^3/s; gas kg/s\] over something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Over {
    /// Inlet pressure \[Pa\], or time \[s\].
    pub at: f64,
    /// The leak.
    pub leak: Spread,
    /// The mean leak if the fluid did not open the contact.
    pub one_way: f64,
    /// The least and the largest mean leak that the pressures of the sweep allow.
    pub bounds: [f64; 2],
}

impl Over {
    /// Whether the pressures of the sweep leave the leak open by more than a factor of two.
    pub fn is_coarse(&self) -> bool {
        self.open() > COARSE
    }

    /// The share of the leak that the pressures of the sweep leave open.
    pub(super) fn open(&self) -> f64 {
        refine::share(std::iter::once(self.bounds))
    }

    /// The same with leaks times a factor.
    #[must_use]
    pub fn times(&self, factor: f64) -> Over {
        Over {
            at: self.at,
            leak: self.leak.times(factor),
            one_way: factor * self.one_way,
            bounds: self.bounds.map(|leak| factor * leak),
        }
    }
}

/// The answers.
#[derive(Clone, Debug)]
pub struct SealAnswer {
    /// The seal.
    pub plan: SealPlan,
    /// The runs of the patch.
    pub sweep: SealSweep,
    /// The flow of each seed at the last time.
    pub flows: Vec<SealFlow>,
    /// Leak of the whole seal \[m^3/s; gas kg/s\].
    pub leak: Spread,
    /// The same if the fluid did not open the contact.
    pub one_way: Spread,
    /// Between which values the pressures of the sweep leave its mean.
    pub one_way_bounds: [f64; 2],
    /// The least and the largest mean leak that the pressures of the sweep allow.
    pub bounds: [f64; 2],
    /// When each seed opens.
    pub opens: Vec<Opens>,
    /// Largest inlet pressure \[Pa\] at which the seed is tight for certain; `None` unless that is known of all.
    pub opening: Option<Spread>,
    /// The leak where the inlet lies a tenth higher above the outlet, over the leak; NaN where nothing leaks, or the profile is not known.
    pub growth: f64,
    /// Of a gas: the largest Knudsen number of all seeds, at the critical gap where the pressure falls the most; NaN otherwise.
    pub knudsen: f64,
    /// Leak over inlet pressure at the last time.
    pub by_inlet: Vec<Over>,
    /// Leak over time.
    pub by_time: Vec<Over>,
    /// What must be known of them.
    pub findings: Vec<Finding>,
}

impl SealAnswer {
    /// The answers of a sweep.
    ///
    /// # Errors
    /// [`SealError::Core`]: the pressures do not fit the seal.
    pub fn of(plan: &SealPlan, sweep: SealSweep) -> Result<SealAnswer, SealError> {
        let [inlet, outlet] = plan.ends;
        let last = sweep.times.len() - 1;
        let sigmas = |time: usize| -> asperity::Result<Vec<Conductance>> {
            (0..sweep.seeds.len()).map(|seed| sweep.conductance(plan, seed, time)).collect()
        };
        let all = |inlet: f64, time: usize| -> asperity::Result<(Vec<SealFlow>, Over)> {
            let (mut flows, mut open) = (vec![], vec![]);
            for sigma in sigmas(time)? {
                flows.push(flow(&sigma, &plan.profile, [inlet, outlet])?);
                open.push(bounds(&sigma, &plan.profile, [inlet, outlet])?);
            }
            let rate = plan.leak_of_flow(sweep.times[time])?;
            let leak = spread(&flows, |flow| rate * flow.flow);
            let one_way = spread(&flows, |flow| rate * flow.one_way).mean;
            let bounds =
                [0, 1].map(|end| rate * open.iter().map(|ends| ends[end]).sum::<f64>() / open.len() as f64);
            Ok((flows, Over { at: inlet, leak, one_way, bounds }))
        };
        let (flows, now) = all(inlet, last)?;
        let rate = plan.leak_of_flow(sweep.times[last])?;
        let one_way = spread(&flows, |flow| rate * flow.one_way);
        let mut one_way_bounds = [0.0; 2];
        for sigma in sigmas(last)? {
            for (bound, sigma) in one_way_bounds.iter_mut().zip([sigma.low(), sigma.high()]) {
                *bound += rate * flow(&sigma, &plan.profile, [inlet, outlet])?.one_way / flows.len() as f64;
            }
        }
        let raised = outlet + RAISE * (inlet - outlet);
        let reach = plan.reach();
        let growth = match raised <= reach {
            true => all(raised, last)?.1.leak.mean / now.leak.mean,
            false => f64::NAN,
        };
        let start = plan.profile.inlets().map_or(outlet, |[from, _]| from.max(outlet));
        let inlets = (1..=INLETS).into_par_iter();
        let inlets = inlets.map(|n| (start + (reach - start) * n as f64 / INLETS as f64).min(reach));
        let by_inlet: asperity::Result<Vec<Over>> = inlets.map(|inlet| Ok(all(inlet, last)?.1)).collect();
        let by_time: asperity::Result<Vec<Over>> = (0..=last)
            .into_par_iter()
            .map(|time| Ok(Over { at: sweep.times[time], ..all(inlet, time)?.1 }))
            .collect();
        let sigmas = sigmas(last)?;
        let opens: Vec<Opens> = sigmas.iter().map(|sigma| opening(sigma, &plan.profile, outlet)).collect();
        let known: Option<Vec<f64>> = opens.iter().map(|opens| pressure(opens, outlet)).collect();
        // Of seeds of which some leak at every pressure and some do not a mean says nothing.
        let always = opens.iter().filter(|opens| matches!(opens, Opens::Always)).count();
        let known = known.filter(|known| always == 0 || always == known.len());
        let knudsen = flows.iter().zip(&sigmas).filter_map(|(flow, sigma)| knudsen(sigma, flow));
        let knudsen = knudsen.fold(f64::NAN, f64::max);
        let by_inlet = by_inlet?;
        let mut findings = findings::of(plan, &sweep, &sigmas, &flows, &now)?;
        findings.extend(findings::of_curve(&by_inlet));
        Ok(SealAnswer {
            plan: plan.clone(),
            leak: now.leak,
            bounds: now.bounds,
            one_way,
            one_way_bounds,
            opening: known.map(|known| Spread::of(&known)),
            growth,
            knudsen,
            by_inlet,
            by_time: by_time?,
            opens,
            flows,
            findings,
            sweep,
        })
    }

    /// The answers as those of a run: means of all seeds, the leak first, with what the findings say of them.
    pub fn answers(&self) -> Vec<Answer> {
        let [rate, per_metre] = if self.plan.is_gas() { ["kg/s", "kg/(m s)"] } else { ["m3/s", "m2/s"] };
        let leak = self.leak.mean;
        let standard = self.plan.standard().map(|factor| ("seal_leak_standard", factor * leak, "Pa m3/s"));
        let opening = self.opening.map_or(f64::NAN, |opening| opening.mean);
        let numbers = [
            ("seal_leak", leak, rate),
            ("seal_leak_per_metre", leak / self.plan.length, per_metre),
            ("seal_leak_one_way", self.one_way.mean, rate),
            ("seal_opening_pressure", opening, "Pa"),
            ("leak_growth", self.growth, "1"),
        ];
        let answer = |(name, value, unit): (&str, f64, &'static str)| Answer {
            validity: self.validity(name),
            ..Answer::new(name, value, unit)
        };
        standard.into_iter().chain(numbers).map(answer).collect()
    }

    /// What the findings say of an answer: those of the seal, and those of the patch about its leak or when it is tight. One that not every
    /// run of the patch has is named.
    pub fn validity(&self, name: &str) -> Validity {
        let of_patch = if name == "seal_opening_pressure" { "tight_from" } else { "leak_rate" };
        let of = |found: &PatchFinding| {
            let validity = Validity::of(of_patch, std::iter::once(&found.finding));
            if found.runs == found.of { validity } else { validity.of_a_part() }
        };
        let own = Validity::of(name, self.findings.iter());
        self.sweep.findings.iter().map(of).fold(own, Validity::and)
    }

    /// Whether every seed is in this state.
    pub fn is(&self, state: SealState) -> bool {
        self.flows.iter().all(|flow| flow.state == state)
    }

    /// Places across the seal \[m\], the contact pressure there, and the pressure of the fluid of each seed \[Pa\].
    pub fn inside(&self) -> (Vec<f64>, Vec<f64>, Vec<Vec<f64>>) {
        let width = self.plan.profile.width();
        let x = (0..CELLS).map(|n| (n as f64 + 0.5) / CELLS as f64 * width).collect();
        let p0 = self.plan.profile.pressures(CELLS, self.plan.ends[0]).unwrap_or_default();
        let middle =
            |flow: &SealFlow| flow.pressure.windows(2).map(|ends| 0.5 * (ends[0] + ends[1])).collect();
        (x, p0, self.flows.iter().map(middle).collect())
    }
}

/// A number of all seeds.
fn spread(flows: &[SealFlow], of: impl Fn(&SealFlow) -> f64) -> Spread {
    Spread::of(&flows.iter().map(of).collect::<Vec<_>>())
}

fn knudsen(sigma: &Conductance, flow: &SealFlow) -> Option<f64> {
    let choke = flow.choke?;
    sigma.knudsen(choke.pressed, choke.fluid)
}

/// The inlet pressure up to which a seal is tight for certain; that of the outlet if it leaks at all.
fn pressure(opens: &Opens, outlet: f64) -> Option<f64> {
    match opens {
        Opens::Between(low, _) => Some(*low),
        Opens::Always => Some(outlet),
        Opens::Never | Opens::Unknown => None,
    }
}
