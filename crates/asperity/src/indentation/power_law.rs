//! A power law in place of a Prony series, as of cells and soft glasses: two numbers for all times of the record.
//!
//! ```text
//! E*(t) = E1 (t/1 s)^-α        0 < α < 1        unknown: ln E1, α (and the depth of first touch)
//! ```
//!
//! It has neither a modulus at once nor one in equilibrium. The springs carry it as a sum of exponentials: with t^-α = (1/Γ(α)) ∫ s^(α-1)
//! exp(-s t) ds, the trapezoidal rule in ln s of step h is exact to 2 |Γ(α + 2πi/h)|/Γ(α) (below 4e-5 here),
//!
//! ```text
//! t^-α = (h/Γ(α)) Σ_k r_k^α exp(-r_k t)        r_k = exp(k h)
//! ```
//!
//! The terms slower than the record are added up to a spring, those faster than its steps to one dashpot-like term, both exactly.
//! Under a given depth, a first row with a load is left out: a power law has no finite load at once.

use std::f64::consts::LN_10;

use super::judged::Test;
use super::least_squares::{Solution, solve};
use super::model::Model;
use super::parameters::Law;
use super::select::information;
use super::spectrum::deviation;
use super::stated::Stated;
use super::{Given, IndentationOptions, IndentationRecord, Interval, notes};
use crate::error::{Error, Result};
use crate::material::{Relaxation, RelaxationTerm, dot};
use crate::reference::MdrProfile;

/// Steps of the sum per decade.
const PER_DECADE: f64 = 3.0;
/// Slowest rate times the length of the record, and fastest rate times its shortest step.
const REACH: [f64; 2] = [1e-4, 1e2];
/// Exponents that a body may have: outside it is elastic, or a liquid.
const EXPONENTS: [f64; 2] = [1e-3, 0.98];
/// Exponents from which the search starts.
const STARTS: [f64; 9] = [0.01, 0.03, 0.06, 0.12, 0.2, 0.3, 0.45, 0.6, 0.8];
/// Half width of an interval in standard deviations: more than 1.96, because the noise itself is only known approximately, as for the
/// Prony series.
const WIDE: f64 = 2.17;
/// Springs for a comparison with another law.
const FEW: usize = 60;
/// Decrease of the information criterion that is strong evidence.
const STRONG: f64 = 6.0;

/// The result of a fit of a power law.
#[derive(Clone, Debug, PartialEq)]
pub struct PowerLawFit {
    /// E1: contact relaxation modulus E* 1 s after a step \[Pa\].
    pub modulus: Interval,
    /// α, 0 of an elastic body, 1 of a liquid.
    pub exponent: Interval,
    /// Depth of first touch \[m\]; 0 if it was not fitted.
    pub touch: Interval,
    /// See [`super::IndentationFit`].
    pub baseline: Interval,
    /// See [`super::IndentationFit`].
    pub tilt: Interval,
    /// See [`super::IndentationFit`].
    pub given: Given,
    /// See [`super::IndentationFit`].
    pub predicted: Vec<f64>,
    /// See [`super::IndentationFit`].
    pub rows: Vec<usize>,
    /// See [`super::IndentationFit`].
    pub rms: f64,
    /// See [`super::IndentationFit`].
    pub relative_rms: f64,
    /// See [`super::IndentationFit`].
    pub durbin_watson: f64,
    /// Step and length of the record \[s\]; beyond them the power law is extrapolation.
    pub window: [f64; 2],
    /// Notes for the user, in sentences.
    pub notes: Vec<String>,
}

/// ln E1, α, \[depth of first touch over the largest depth\]; the sum is made for times between these \[s\].
#[derive(Clone, Copy, Debug)]
struct PowerLaw {
    touch: bool,
    times: [f64; 2],
}

impl Law for PowerLaw {
    fn len(&self) -> usize {
        2 + usize::from(self.touch)
    }

    fn fits_touch(&self) -> bool {
        self.touch
    }

    fn body(&self, at: &[f64]) -> Result<Relaxation> {
        let [low, high] = EXPONENTS;
        match (low..=high).contains(&at[1]) {
            true => Ok(sum(at[0].exp(), at[1], self.times)),
            false => {
                Err(Error::invalid("exponent of the power law", at[1], format!("between {low} and {high}")))
            }
        }
    }
}

/// E1 t^-α as a sum of exponentials for times from `times[0]` to `times[1]`.
fn sum(modulus: f64, exponent: f64, times: [f64; 2]) -> Relaxation {
    let step = LN_10 / PER_DECADE;
    let first = ((REACH[0].ln() - times[1].ln()) / step).floor();
    let last = ((REACH[1].ln() - times[0].ln()) / step).ceil();
    let scale = modulus * step / libm::tgamma(exponent);
    let rate = |k: f64| (k * step).exp();
    let count = (last - first) as usize;
    let term = |n: usize| {
        let rate = rate(last - n as f64);
        RelaxationTerm { modulus: scale * rate.powf(exponent), relaxation_time: 1.0 / rate }
    };
    // Geometric series: Σ r^α below the first rate, and Σ r^(α-1), the viscosity, above the last one.
    let slower = scale * rate(first).powf(exponent) / (exponent * step).exp_m1();
    let viscosity = scale * rate(last).powf(exponent - 1.0) / ((1.0 - exponent) * step).exp_m1();
    let fast = 1.0 / rate(last + 1.0);
    let fastest = RelaxationTerm { modulus: viscosity / fast, relaxation_time: fast };
    let terms = std::iter::once(fastest).chain((0..=count).map(term)).collect();
    Relaxation { equilibrium: slower, terms, viscosity: 0.0 }
}

/// Fits a power law to a record of the indentation of a half-space by a rigid indenter.
///
/// Of the options, `terms` and `long_time` have no effect: a power law has neither.
///
/// ```
/// use asperity::indentation::{IndentationOptions, IndentationRecord, fit_power_law};
/// use asperity::reference::MdrProfile;
/// // A cone, d = t: W = (2/π) ∫ (t - s)^-α d(s²) = (2/π) 2 t^(2 - α)/((1 - α)(2 - α)), with α = 1/5.
/// let times: Vec<f64> = (0..=100).map(|k| 0.02 * f64::from(k)).collect();
/// let load = |t: &f64| 4.0 / std::f64::consts::PI * t.powf(1.8) / (0.8 * 1.8);
/// let loads: Vec<f64> = times.iter().map(load).collect();
/// let record = IndentationRecord { times: &times, loads: &loads, depths: &times };
/// let fit = fit_power_law(MdrProfile::Cone { slope: 1.0 }, &record, &IndentationOptions::default())?;
/// assert!((fit.modulus.value - 1.0).abs() < 1e-3 && (fit.exponent.value - 0.2).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// As [`super::fit_indentation`].
pub fn fit_power_law(
    profile: MdrProfile,
    record: &IndentationRecord,
    options: &IndentationOptions,
) -> Result<PowerLawFit> {
    let mut test = Test::new(profile, record, options)?;
    if test.given == Given::Depth {
        test = test.without_first();
    }
    let model = &test.model;
    let best = best(model, options.springs)?;
    let judged = test.judge(&best, options.limit)?;
    let stated = Stated::new(model, &best, options, &test.free)?;
    // Correlated residuals determine less; the rows and their means both count, as for the Prony series.
    let numbers = best.parameters.len();
    let scatter = deviation(&best.residuals, numbers).max(deviation(&judged.residuals, numbers));
    let own = (dot(&best.residuals, &best.residuals) / (best.residuals.len() - numbers) as f64).sqrt();
    let wider = if own > 0.0 { WIDE * (scatter / own).max(1.0) } else { WIDE };
    let half = |k: usize| wider * best.deviations[k];
    let modulus = best.at[0].exp();
    let modulus = Interval::new(modulus, [modulus * (-half(0)).exp(), modulus * half(0).exp()]);
    let exponent = {
        let ends = [best.at[1] - half(1), best.at[1] + half(1)];
        let plain = Interval { value: best.at[1], low: ends[0], high: ends[1], determined: true };
        let wide = stated.widen_both_ways(plain, |fitted| fitted.at[1]);
        let [low, high] = [wide.low.max(0.0), wide.high.min(1.0)];
        // Half of its range is no knowledge of it.
        Interval { low, high, determined: high - low < 0.5, ..wide }
    };
    let scale = model.depth_scale();
    let touch = match best.parameters.touch {
        true => {
            let (value, half) = (scale * best.touch(), scale * half(2));
            let plain = Interval { value, low: value - half, high: value + half, determined: true };
            stated.widen_both_ways(plain, |fitted| fitted.touch)
        }
        false => Interval::exact(0.0),
    };
    let [touch, baseline, tilt] = test.free.intervals(touch);
    let mut fit = PowerLawFit {
        modulus: stated.widen(modulus, |fitted| fitted.at[0].exp()),
        exponent,
        touch,
        baseline,
        tilt,
        given: test.given,
        predicted: judged.predicted,
        rms: judged.rms,
        relative_rms: judged.relative_rms,
        durbin_watson: judged.durbin_watson,
        window: model.window(),
        notes: vec![],
        rows: test.rows.clone(),
    };
    fit.notes = notes::of_power_law(&fit);
    fit.notes.extend(notes::of_start(&test.whole.loads));
    fit.notes.extend(notes::of_indenter(
        profile,
        model.depth_scale(),
        fit.relative_rms,
        options.layer.is_some(),
    ));
    Ok(fit)
}

/// The exponent and the relative misfit (rms, weighted) of a power law that describes the record better than a Prony series, by the Bayesian
/// information criterion; `None` if it does not.
pub(super) fn better(model: &Model, series: &Solution) -> Option<f64> {
    let rows = match model.given {
        Given::Depth => model.without_first(),
        Given::Load => model.clone(),
    };
    let law = best(&rows, FEW).ok()?;
    let residuals = rows.residuals(series.parameters, &series.at).ok()?;
    let series = Solution { residuals, at: series.at.clone(), deviations: vec![], ..*series };
    (information(&rows, &law) + STRONG < information(&rows, &series)).then_some(law.at[1])
}

/// The power law that fits best.
fn best(model: &Model, springs: usize) -> Result<Solution<PowerLaw>> {
    let steps = model.times.windows(2).map(|pair| pair[1] - pair[0]);
    let length = model.window()[1];
    let shortest = steps.fold(length, f64::min).max(1e-12 * length);
    let law = PowerLaw { touch: model.fit_touch, times: [shortest, length] };
    let starts = STARTS.iter().filter_map(|exponent| start(model, law, *exponent));
    let start = starts.min_by(|a, b| a.0.total_cmp(&b.0)).ok_or_else(|| {
        Error::invalid(
            "record of the indentation",
            "one whose load does not grow with the depth",
            "an indentation from first touch on (check the signs of load and depth)",
        )
    })?;
    solve(&model.with_springs(springs), law, start.1)
}

/// The sum of squares and the numbers for this exponent, with a modulus to match.
fn start(model: &Model, law: PowerLaw, exponent: f64) -> Option<(f64, Vec<f64>)> {
    let coarse = model.with_springs(FEW.min(40));
    let at = |modulus: f64| {
        let mut at = vec![modulus.ln(), exponent];
        at.resize(law.len(), 0.0);
        at
    };
    let largest = |column: &[f64]| column.iter().copied().fold(0.0, f64::max);
    let (load, depth) = (largest(&model.loads), model.depth_scale());
    let mut modulus = load / model.unit_load(depth).0 * (0.5 * law.times[1]).powf(exponent);
    // A load is proportional to the modulus; a depth needs a few steps.
    for _ in 0..3 {
        let predicted = coarse.of_compared(&coarse.predict(law, &at(modulus)).ok()?.values);
        let measured = coarse.of_compared(coarse.measured());
        let ratio = dot(&predicted, &measured) / dot(&predicted, &predicted);
        modulus *= match model.given {
            Given::Depth => ratio,
            Given::Load => model.unit_load(depth / ratio).0 / model.unit_load(depth).0,
        };
        if !(modulus > 0.0 && modulus.is_finite()) {
            return None;
        }
    }
    let residuals = coarse.residuals(law, &at(modulus)).ok()?;
    Some((dot(&residuals, &residuals), at(modulus)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_the_power_law_over_its_times() {
        for exponent in [0.001, 0.05, 0.3, 0.7, 0.98] {
            let relaxation = sum(3.0, exponent, [1e-3, 1e3]);
            relaxation.validate().unwrap();
            for k in 0..=60 {
                let t = 10f64.powf(-3.0 + 0.1 * f64::from(k));
                let error = relaxation.value(t) / (3.0 * t.powf(-exponent)) - 1.0;
                // The rule has 4e-5, and of the slowest terms 1e-4 of a term has relaxed.
                assert!(error.abs() < 1e-4, "{exponent} {t} {error}");
            }
            // A ramp from t = 0: ∫ E dt = 3 t^(1 - α)/(1 - α).
            for t in [1e-3, 1.0] {
                let part = |term: &RelaxationTerm| {
                    -term.modulus * term.relaxation_time * (-t / term.relaxation_time).exp_m1()
                };
                let ramp = relaxation.equilibrium * t + relaxation.terms.iter().map(part).sum::<f64>();
                let exact = 3.0 * t.powf(1.0 - exponent) / (1.0 - exponent);
                assert!((ramp / exact - 1.0).abs() < 1e-4, "{exponent} {t} {}", ramp / exact - 1.0);
            }
        }
    }
}
