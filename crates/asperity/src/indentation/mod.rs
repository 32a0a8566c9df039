//! Indentation in reverse: the relaxation function of a half-space from a record of load and depth over time.
//!
//! A rigid sphere, cone or pyramid is pressed into the body, held, retracted, in any order. The relation between depth and load is the
//! exact one-dimensional equivalent of [`crate::reference::Mdr`], including unloading and reloading. One channel is taken as
//! given, the one that the test controlled; the model is fitted to the other by least squares:
//!
//! ```text
//! E*(t) = E∞ + Σ E_i exp(-t/τ_i)        unknown: ln E∞, ln E_i, ln τ_i (and the depth of first touch)
//! minimise Σ (model - measured)²/v      v: variance of the noise of both channels
//! ```
//!
//! **Start.** While the contact grows the problem is linear (E. H. Lee & J. R. M. Radok, J. Appl. Mech. 27 (1960) 438):
//! with φ(d) the load at the depth d for E* = 1 ([`crate::reference::MdrProfile`])
//!
//! ```text
//! W = ∫ E*(t - s) dφ(s)        φ = ∫ C(t - s) dW(s)
//! ```
//!
//! so the best times of a logarithmic grid are found without time stepping.
//!
//! **Intervals.** 95 %, from an average over all numbers of terms, for solids and fluids, each with its probability (nested
//! sampling on a record that is linear in the moduli near the best fit). They therefore do not assume that the number of terms is
//! correct, nor that the record determines each parameter to a few percent. The seed is fixed: the same record gives the same
//! intervals. An interval that spans more than a factor of 10 is reported as "not determined by this record". Stated uncertainties of the
//! radius, the thickness and the scales of load and deflection are added in squares.

mod average;
mod baseline;
mod blocks;
mod check;
mod control;
mod free;
mod indenter;
mod judged;
mod least_squares;
mod model;
mod nested;
pub(crate) mod noise;
mod notes;
mod parameters;
mod power_law;
mod select;
#[cfg(test)]
mod shape_tests;
mod spectrum;
mod start;
mod stated;
#[cfg(test)]
mod tests;

use crate::error::{Error, Result};
use crate::layer::Interface;
use crate::material::{LongTime, Relaxation, RelaxationTerm};
use crate::reference::MdrProfile;

pub(crate) use baseline::{Baseline, Line, Start, start};
pub(crate) use least_squares::{covariance, damped_step};
pub(crate) use notes::{ALIKE, of_indenter, unlikely_radius};
pub(crate) use spectrum::{correlation, durbin_watson};
#[cfg(test)]
pub(crate) use tests::Noise as TestNoise;

pub use indenter::Indenter;
pub use power_law::{PowerLawFit, fit_power_law};

use average::Average;
use judged::Test;
use least_squares::Solution;
use stated::Stated;
pub(crate) use stated::{SENSITIVITY, check_shares};

/// A record of an indentation; three columns of one length. The body is undisturbed before the first row.
#[derive(Clone, Copy, Debug)]
pub struct IndentationRecord<'a> {
    /// Times \[s\], increasing.
    pub times: &'a [f64],
    /// Loads \[N\]; some may be negative because of noise.
    pub loads: &'a [f64],
    /// Depths \[m\] from first touch; below 0 before it.
    pub depths: &'a [f64],
}

/// The channel that the test controlled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Given {
    /// The depth; the model is fitted to the load.
    Depth,
    /// The load; the model is fitted to the depth.
    Load,
}

/// Options of the fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndentationOptions {
    /// The channel that the test controlled; by default the one whose history needs fewer straight pieces, or the one with less
    /// noise if both need the same number.
    pub given: Option<Given>,
    /// Number of terms, at most 6; by default the number with the smallest Bayesian information criterion.
    pub terms: Option<usize>,
    /// Behaviour at times longer than the record; default: the one that fits better.
    pub long_time: LongTime,
    /// Whether the depth of first touch is fitted too; default no: it is 0.
    pub fit_touch: bool,
    /// Springs of the one-dimensional model out to the largest contact; default 150, at least 20. The relative error of the load
    /// is then about 1/springs².
    pub springs: usize,
    /// The thin sample, if it is not as deep as a half-space.
    pub layer: Option<SampleLayer>,
    /// Largest misfit (rms, over the largest value) before a record is refused, default 0.1.
    pub limit: f64,
    /// Standard uncertainty of the radius over the radius, or of the slope of a cone or pyramid over the slope; default 0. The intervals contain this and
    /// the other uncertainties.
    pub radius_uncertainty: f64,
    /// Standard uncertainty of the thickness of a thin sample over the thickness, default 0.
    pub thickness_uncertainty: f64,
    /// Standard uncertainty of the scale of the load, such as that of a spring constant, over its value; default 0.
    pub load_uncertainty: f64,
    /// Spring constant of the cantilever whose deflection is the load \[N/m\].
    pub spring_constant: Option<f64>,
    /// Standard uncertainty of the scale of the deflection over its value, default 0; needs the spring constant.
    pub sensitivity_uncertainty: f64,
}

impl Default for IndentationOptions {
    fn default() -> Self {
        IndentationOptions {
            given: None,
            terms: None,
            long_time: LongTime::Free,
            fit_touch: false,
            springs: 150,
            layer: None,
            limit: 0.1,
            radius_uncertainty: 0.0,
            thickness_uncertainty: 0.0,
            load_uncertainty: 0.0,
            spring_constant: None,
            sensitivity_uncertainty: 0.0,
        }
    }
}

/// A thin sample: a layer of one material on a rigid base, such as a gel or a cell on glass.
///
/// The record is then described by the load of the indenter on the elastic layer ([`crate::reference::LayerContact`]) and the
/// same hereditary relation: layer and half-space differ in the weight and the profile of the springs of the one-dimensional
/// model. Unloading and reloading are therefore exact here too, provided that Poisson's ratio does not change with time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleLayer {
    /// Thickness \[m\].
    pub thickness: f64,
    /// Poisson's ratio, at most 0.5.
    pub poisson: f64,
    /// The interface to the rigid base.
    pub interface: Interface,
}

/// A value with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The value of the best fit.
    pub value: f64,
    /// Lower end; 0 if there is none.
    pub low: f64,
    /// Upper end; infinite if there is none.
    pub high: f64,
    /// Whether the record determines it: the ends differ by at most a factor of 10, or the upper end of an equilibrium modulus is
    /// below a twentieth of E*(0); see also [`IndentationFit::equilibrium`]. Otherwise `value` is one of many that fit equally well.
    pub determined: bool,
}

/// Half width of a 95 % interval in standard deviations.
pub(crate) const WIDTH: f64 = 1.959_964;
/// Largest ratio of the ends of an interval of a determined parameter.
const DETERMINED: f64 = 10.0;
/// An interval of the longest time that reaches beyond this number of lengths of the record is cut by the prior, which ends at
/// three: the record gives no upper end.
const UNENDING: f64 = 2.0;
/// An equilibrium modulus below this fraction of E*(0) counts as 0.
const NEGLIGIBLE: f64 = 0.05;

impl Interval {
    /// Whether a value lies within.
    pub fn holds(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    /// A value without uncertainty.
    pub(crate) fn exact(value: f64) -> Self {
        Interval { value, low: value, high: value, determined: true }
    }

    pub(crate) fn new(value: f64, [low, high]: [f64; 2]) -> Self {
        Interval { value, low, high, determined: high <= DETERMINED * low }
    }
}

/// The result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct IndentationFit {
    /// Contact relaxation modulus E*(t) \[Pa\]: E(t)/(1 - ν²), 2 G(t)/(1 - ν).
    pub relaxation: Relaxation,
    /// E∞ \[Pa\]; 0 for a fluid, with its upper bound. Not determined, with the lower end 0, if the interval of the longest
    /// relaxation time reaches beyond twice the length of the record.
    pub equilibrium: Interval,
    /// E*(0) \[Pa\].
    pub instantaneous: Interval,
    /// E_i \[Pa\] and τ_i \[s\] of each term, in the order of `relaxation`.
    pub terms: Vec<[Interval; 2]>,
    /// Depth of first touch \[m\]; 0 if it was not fitted.
    pub touch: Interval,
    /// Load of the free indenter at first touch \[N\], and its slope over the depth \[N/m\]: from the rows before first touch; 0 where there are none.
    pub baseline: Interval,
    /// See `baseline`.
    pub tilt: Interval,
    /// The channel that was taken as given.
    pub given: Given,
    /// Model of the other channel at each of `rows` \[N or m\]. If the load is given and less than 2 % of the largest, it
    /// is the depth of the surface, which is not compared with that of the indenter.
    pub predicted: Vec<f64>,
    /// Numbers of the rows that `predicted` belongs to: all; of a record of more than 2000 rows, the middle row of each group of rows
    /// whose mean was fitted.
    pub rows: Vec<usize>,
    /// Root mean square of model minus measurement \[N or m\], over all rows of the record.
    pub rms: f64,
    /// The same over the largest measured value.
    pub relative_rms: f64,
    /// Σ (r_k - r_(k-1))²/Σ r_k² of the residuals r: near 2 for independent errors; well below 2 if the model deviates
    /// systematically from the record or the noise is not white. The intervals are then wider according to the correlation of
    /// neighbours.
    pub durbin_watson: f64,
    /// Probability of each number of terms, from 0 on.
    pub numbers: Vec<f64>,
    /// Step and length of the record \[s\]; one step in ten may be shorter. Terms outside this range are extrapolation.
    pub window: [f64; 2],
    /// Notes for the user, in sentences.
    pub notes: Vec<String>,
}

/// The channel that the test of a record controlled: the one whose history needs fewer straight pieces, or the one with less noise if
/// both need the same number.
///
/// # Errors
/// [`Error::Invalid`] for a record that [`fit_indentation`] refuses.
pub fn controlled(record: &IndentationRecord) -> Result<Given> {
    check::columns(record)?;
    check::signs(record, 0)?;
    Ok(control::controlled(record.times, record.loads, record.depths))
}

/// Fits the contact relaxation modulus of a half-space, as a Prony series, to a record of its indentation by a rigid indenter.
///
/// ```
/// use asperity::indentation::{IndentationOptions, IndentationRecord, fit_indentation};
/// use asperity::material::Relaxation;
/// use asperity::reference::{Mdr, MdrProfile, MdrTarget};
/// // A sphere of 5 mm pressed 0.1 mm deep in 1 s, held until 20 s.
/// let profile = MdrProfile::Paraboloid { radius: 5e-3 };
/// let truth = Relaxation::absolute(2e6, &[(3e6, 4.0)])?;
/// let mut springs = Mdr::new(profile, &truth, 1e-3, 300)?;
/// let times: Vec<f64> = (0..=200).map(|k| 0.1 * k as f64).collect();
/// let depths: Vec<f64> = times.iter().map(|t| 1e-4 * t.min(1.0)).collect();
/// let mut loads = vec![];
/// for depth in &depths {
///     let dt = if loads.is_empty() { 0.0 } else { 0.1 };
///     loads.push(springs.step(dt, MdrTarget::Approach(*depth))?.load);
/// }
/// let record = IndentationRecord { times: &times, loads: &loads, depths: &depths };
/// let fit = fit_indentation(profile, &record, &IndentationOptions::default())?;
/// assert_eq!(fit.relaxation.terms.len(), 1);
/// assert!((fit.terms[0][1].value / 4.0 - 1.0).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if the columns differ in length or have fewer than 10 rows, a number is not finite, times do not increase,
/// there is no indentation, loads are tensile, more terms are requested than the record determines, or the misfit of every
/// material of this kind exceeds `options.limit`.
pub fn fit_indentation(
    profile: MdrProfile,
    record: &IndentationRecord,
    options: &IndentationOptions,
) -> Result<IndentationFit> {
    let test = Test::new(profile, record, options)?;
    let model = &test.model;
    let mut best = select::select(model, options.terms, options.long_time)?;
    let mut judged = test.judge(&best, options.limit)?;
    if options.terms.is_some() {
        require_known(&best)?;
    }
    let mut average = Average::new(model, &best, &judged.residuals, options)?;
    // A number of terms that is practically excluded gives way to the most probable one, if the record determines that.
    if options.terms.is_none()
        && let Some(terms) = average.instead_of(best.parameters.terms)
        && let Ok(other) = select::best_of(model, terms, options.long_time)
        && select::is_known(&other)
        && let Ok(beside) = test.judge(&other, options.limit)
    {
        let again = Average::new(model, &other, &beside.residuals, options)?;
        if again.numbers()[terms] > average.numbers()[best.parameters.terms] {
            (best, judged, average) = (other, beside, again);
        }
    }
    let stated = Stated::new(model, &best, options, &test.free)?;

    let relaxation = best.relaxation();
    let instantaneous = average.interval(relaxation.instantaneous(), |draw| Some(draw.instantaneous()));
    let instantaneous = stated.widen(instantaneous, |fitted| fitted.relaxation.instantaneous());
    let equilibrium = average.interval(relaxation.equilibrium, |draw| Some(draw.equilibrium));
    let mut equilibrium = stated.widen_equilibrium(equilibrium);
    equilibrium.determined |= equilibrium.high <= NEGLIGIBLE * instantaneous.value;
    let term = |(k, term): (usize, &RelaxationTerm)| {
        [
            stated.widen(average.term(term.modulus, k, 0), |fitted| fitted.relaxation.terms[k].modulus),
            stated.widen(average.term(term.relaxation_time, k, 1), |fitted| {
                fitted.relaxation.terms[k].relaxation_time
            }),
        ]
    };
    let terms: Vec<[Interval; 2]> = relaxation.terms.iter().enumerate().map(term).collect();
    // A body whose longest time has no end within the prior may relax to any smaller modulus.
    let relaxes = terms.last().is_some_and(|[_, time]| time.high > UNENDING * model.window()[1]);
    if relaxes {
        (equilibrium.low, equilibrium.determined) = (0.0, false);
    }
    let touch = match best.parameters.touch {
        true => average.interval(best.touch(), |draw| Some(draw.touch)),
        false => Interval::exact(0.0),
    };
    let [value, low, high] = [touch.value, touch.low, touch.high].map(|x| model.depth_scale() * x);
    let touch =
        stated.widen_both_ways(Interval { value, low, high, determined: true }, |fitted| fitted.touch);
    let [touch, baseline, tilt] = test.free.intervals(touch);
    let mut fit = IndentationFit {
        terms,
        relaxation,
        equilibrium,
        instantaneous,
        touch,
        baseline,
        tilt,
        given: test.given,
        predicted: judged.predicted,
        rms: judged.rms,
        relative_rms: judged.relative_rms,
        durbin_watson: judged.durbin_watson,
        numbers: average.numbers(),
        window: model.window(),
        notes: vec![],
        rows: test.rows.clone(),
    };
    fit.notes = notes::notes(&fit, options);
    fit.notes.extend(notes::of_start(&test.whole.loads));
    let exponent = if best.parameters.terms > 0 { power_law::better(model, &best) } else { None };
    fit.notes.extend(exponent.map(|exponent| notes::of_better(&fit, exponent)));
    let layered = options.layer.is_some();
    fit.notes.extend(notes::of_indenter(profile, model.depth_scale(), fit.relative_rms, layered));
    Ok(fit)
}

/// Refuses more terms than the record determines.
fn require_known(best: &Solution) -> Result<()> {
    let worst = best.parameters.worst(&best.deviations).filter(|(_, deviation)| *deviation > select::UNKNOWN);
    let Some((name, deviation)) = worst else { return Ok(()) };
    let known = match deviation < 20.0 {
        true => format!("a factor of {:.0} only", (1.96 * deviation).exp()),
        false => "nothing".to_owned(),
    };
    Err(Error::invalid(
        format!("number of terms ({})", best.parameters.terms),
        format!("too large for the record: {name} is known to {known}"),
        "smaller, or a record that is longer or has more points in the beginning",
    ))
}
