//! Indentation in reverse: the relaxation function of a half-space from a record of load and depth over time.
//!
//! A rigid sphere (or cone) is pressed into the body, held, retracted, in any order. Between depth and load stands the
//! exact one-dimensional equivalent of [`crate::reference::Mdr`], unloading and loading again included. One channel is
//! taken as given, the other is what the model has to meet by least squares:
//!
//! ```text
//! E*(t) = E∞ + Σ E_i exp(-t/τ_i)        unknown: ln E∞, ln E_i, ln τ_i (and the depth of first touch)
//! minimise Σ (model - measured)²          Levenberg-Marquardt; D. W. Marquardt, J. SIAM 11 (1963) 431
//! ```
//!
//! **Start.** While the contact grows the problem is linear (E. H. Lee & J. R. M. Radok, J. Appl. Mech. 27 (1960) 438):
//! with φ(d) the load at the depth d for E* = 1 (sphere (4/3) sqrt(R) d^(3/2))
//!
//! ```text
//! W = ∫ E*(t - s) dφ(s)        φ = ∫ C(t - s) dW(s)
//! ```
//!
//! so that the best times of a logarithmic grid are found without a march.
//!
//! **Intervals.** 95 % from the covariance of the least squares, (J'J)⁻¹ (Σ r_k² J_k J_k'/(1 - h_k)²) (J'J)⁻¹ with the
//! leverages h_k: it asks for independent errors but not for equal ones (HC3; J. G. MacKinnon & H. White, J. Econometrics
//! 29 (1985) 305), so that noise relative to the value does no harm. Parameters enter by their logarithms, so the
//! intervals are factors. [`IndentationFit::durbin_watson`] tells whether the errors look independent.

mod least_squares;
mod model;
mod start;
#[cfg(test)]
mod tests;

use crate::error::{Error, Result};
use crate::material::{LongTime, Relaxation};
use crate::reference::MdrProfile;

use least_squares::{Solution, solve};
use model::{Model, Parameters};

/// A record of an indentation; three columns of one length. The body is undisturbed before the first row.
#[derive(Clone, Copy, Debug)]
pub struct IndentationRecord<'a> {
    /// Times \[s\], increasing.
    pub times: &'a [f64],
    /// Loads \[N\]; noise may make some negative.
    pub loads: &'a [f64],
    /// Depths \[m\] from first touch; below 0 before it.
    pub depths: &'a [f64],
}

/// The channel that is taken as it was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Given {
    /// The depth; the model meets the load.
    Depth,
    /// The load; the model meets the depth.
    Load,
}

/// How to fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IndentationOptions {
    /// The channel taken as it is; by default the one with less scatter.
    pub given: Option<Given>,
    /// Number of terms, at most 6; by default as many as the record calls for (least Bayesian information criterion).
    pub terms: Option<usize>,
    /// What happens at times longer than the record; default: whatever fits better.
    pub long_time: LongTime,
    /// Whether the depth of first touch is fitted too; default no: it is 0.
    pub fit_touch: bool,
    /// Springs of the one-dimensional model out to the largest contact; default 150, at least 20. The load is then known
    /// to some 1/springs².
    pub springs: usize,
    /// Largest misfit (rms, over the largest value) before a record is refused, default 0.1.
    pub limit: f64,
}

impl Default for IndentationOptions {
    fn default() -> Self {
        IndentationOptions {
            given: None,
            terms: None,
            long_time: LongTime::Free,
            fit_touch: false,
            springs: 150,
            limit: 0.1,
        }
    }
}

/// A value with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The value.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether a value lies within.
    pub fn holds(&self, value: f64) -> bool {
        self.low <= value && value <= self.high
    }

    fn exact(value: f64) -> Self {
        Interval { value, low: value, high: value }
    }

    fn factor(logarithm: f64, half: f64) -> Self {
        Interval { value: logarithm.exp(), low: (logarithm - half).exp(), high: (logarithm + half).exp() }
    }
}

/// What a record tells of its material.
#[derive(Clone, Debug, PartialEq)]
pub struct IndentationFit {
    /// Contact relaxation modulus E*(t) \[Pa\]: E(t)/(1 - ν²), 2 G(t)/(1 - ν).
    pub relaxation: Relaxation,
    /// E∞ \[Pa\]; 0 without an interval for a fluid.
    pub equilibrium: Interval,
    /// E*(0) \[Pa\].
    pub instantaneous: Interval,
    /// E_i \[Pa\] and τ_i \[s\] of each term, in the order of `relaxation`.
    pub terms: Vec<[Interval; 2]>,
    /// Depth of first touch \[m\]; 0 where it was not fitted.
    pub touch: Interval,
    /// The channel that was taken as it is.
    pub given: Given,
    /// Model of the other channel at each row that was used \[N or m\]. Where the load is given and less than 2 % of the
    /// largest, the depth of the surface: it is not compared with that of the indenter.
    pub predicted: Vec<f64>,
    /// Numbers of the rows that were used: every k-th of a long record.
    pub rows: Vec<usize>,
    /// Root of the mean square of model less measurement \[N or m\].
    pub rms: f64,
    /// The same over the largest measured value.
    pub relative_rms: f64,
    /// Σ (r_k - r_(k-1))²/Σ r_k² of the residuals r: near 2 for independent errors; well below where the model bends away
    /// from the record or the noise is not white, and the intervals are too narrow.
    pub durbin_watson: f64,
    /// Shortest step and length of the record \[s\]: terms beyond are extrapolation.
    pub window: [f64; 2],
}

/// Fewer rows tell nothing.
const FEWEST: usize = 10;
/// More rows are thinned to about this number.
const MANY: usize = 2000;
const MOST: usize = 10_000_000;
/// Larger numbers, and a load or depth less than one over it, nobody measures.
const LARGEST: f64 = 1e30;
/// More terms no single record determines.
const MOST_TERMS: usize = 6;
/// Loads below minus this share of the largest are no noise.
const PULL: f64 = 0.05;
/// A term whose standard deviation (of a logarithm) is larger is not determined: its 95 % interval spans a factor of 50.
const UNKNOWN: f64 = 1.0;
/// Misfit that the model itself has, over the largest value.
const MODEL_ERROR: f64 = 2e-5;

/// Fits the contact relaxation modulus of a half-space to a record of its indentation by a rigid body of revolution.
///
/// ```
/// use asperity::indentation::{IndentationOptions, IndentationRecord, fit_indentation};
/// use asperity::material::Relaxation;
/// use asperity::reference::{Mdr, MdrProfile, MdrTarget};
/// // A sphere of 5 mm pressed 0.1 mm deep in 1 s, held until 20 s.
/// let profile = MdrProfile::Sphere { radius: 5e-3 };
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
/// [`Error::Invalid`] where the columns differ in length or have fewer than 10 rows, a number is not finite, times do not
/// increase, nothing is pressed, loads pull, more terms are asked for than the record determines, or every material of
/// this kind stays further from the record than `options.limit`.
pub fn fit_indentation(
    profile: MdrProfile,
    record: &IndentationRecord,
    options: &IndentationOptions,
) -> Result<IndentationFit> {
    check_options(options)?;
    check(record)?;
    let kept = thinned(record.times.len());
    let pick = |column: &[f64]| kept.iter().map(|row| column[*row]).collect::<Vec<f64>>();
    let [times, loads, depths] = [record.times, record.loads, record.depths].map(pick);
    let given = options.given.unwrap_or_else(|| quieter(&times, &loads, &depths));
    let model = Model::new(profile, times, loads, depths, given, options)?;
    let (solution, parameters) = match options.terms {
        Some(terms) => best_of(&model, terms, options.long_time)?,
        None => as_many_as_needed(&model, options.long_time)?,
    };
    let relative_rms = solution.rms();
    if relative_rms > options.limit {
        return Err(Error::invalid(
            "misfit of the record",
            format!("{:.1} % of the largest value (rms)", 100.0 * relative_rms),
            format!(
                "at most {:.1} %: check radius, units and the depth of first touch, and whether the body is a half-space",
                100.0 * options.limit
            ),
        ));
    }
    if let Some(worst) = parameters.worst(&solution.deviations).filter(|(_, deviation)| *deviation > UNKNOWN)
    {
        let (name, deviation) = worst;
        return Err(Error::invalid(
            format!("number of terms ({})", parameters.terms),
            format!(
                "too large for the record: {name} is known to {}",
                if deviation.is_finite() && deviation < 20.0 {
                    format!("a factor of {:.0} only", (1.96 * deviation).exp())
                } else {
                    "nothing".to_owned()
                }
            ),
            "smaller, or a record that is longer or has more points in the beginning",
        ));
    }
    let predicted = model.predict(&parameters, &solution.at)?;
    Ok(report(&model, solution, &parameters, kept, predicted))
}

/// Fits with `terms` terms: a solid, a fluid, or the better of both.
fn best_of(model: &Model, terms: usize, long_time: LongTime) -> Result<(Solution, Parameters)> {
    let solids = match (long_time, terms) {
        (LongTime::Solid, _) | (_, 0) => &[true][..],
        (LongTime::Fluid, _) => &[false],
        (LongTime::Free, _) => &[true, false],
    };
    let mut best: Option<(Solution, Parameters)> = None;
    let mut refused = None;
    for solid in solids {
        // An equilibrium modulus that is known to 30 % and bears a share of the load is not 0.
        let known = |(solution, of): &(Solution, Parameters)| {
            let share = solution.at[0].exp() / of.relaxation(&solution.at).instantaneous();
            of.solid && solution.deviations[0] < 0.3 && share > 1e-3
        };
        if best.as_ref().is_some_and(known) {
            break;
        }
        let parameters = Parameters { solid: *solid, terms, touch: model.fits_touch() };
        let found = start::start(model, &parameters).and_then(|start| solve(model, &parameters, start));
        match found {
            Err(error) => refused = Some(error),
            Ok(solution) => {
                let better = best
                    .as_ref()
                    .is_none_or(|(other, of)| information(&solution, &parameters) < information(other, of));
                if better {
                    best = Some((solution, parameters));
                }
            }
        }
    }
    match (best, refused) {
        (Some(best), _) => Ok(best),
        (None, Some(error)) => Err(error),
        (None, None) => Err(Error::invalid("number of terms", terms, "one that can be fitted")),
    }
}

/// Adds terms while that lowers the information criterion and each is determined.
fn as_many_as_needed(model: &Model, long_time: LongTime) -> Result<(Solution, Parameters)> {
    let mut best = best_of(model, usize::from(long_time == LongTime::Fluid), long_time)?;
    let first = best.1.terms;
    for terms in first + 1..=MOST_TERMS {
        let Ok(next) = best_of(model, terms, long_time) else { break };
        let known = next.1.worst(&next.0.deviations).is_none_or(|(_, deviation)| deviation <= UNKNOWN);
        if !known || information(&next.0, &next.1) >= information(&best.0, &best.1) {
            break;
        }
        best = next;
    }
    Ok(best)
}

/// Bayesian information criterion, n ln(Σ r²/n) + k ln n.
fn information(solution: &Solution, parameters: &Parameters) -> f64 {
    let n = solution.residuals.len() as f64;
    let mean = solution.rms().powi(2).max(MODEL_ERROR * MODEL_ERROR);
    n * mean.ln() + parameters.len() as f64 * n.ln()
}

fn report(
    model: &Model,
    solution: Solution,
    parameters: &Parameters,
    rows: Vec<usize>,
    predicted: Vec<f64>,
) -> IndentationFit {
    let half = |k: usize| {
        let freedom = solution.residuals.len() - parameters.len();
        least_squares::quantile(freedom) * solution.deviations[k]
    };
    let at = |k: usize| Interval::factor(solution.at[k], half(k));
    let equilibrium = if parameters.solid { at(0) } else { Interval::exact(0.0) };
    let first = usize::from(parameters.solid);
    let n = parameters.terms;
    let mut terms: Vec<[Interval; 2]> = (0..n).map(|k| [at(first + k), at(first + n + k)]).collect();
    terms.sort_by(|a, b| a[1].value.total_cmp(&b[1].value));
    let relaxation = parameters.relaxation(&solution.at);
    // ln E(0) = ln sum exp(ln E_k): its gradient is the share of each modulus.
    let whole = relaxation.instantaneous();
    let share = |k: usize| if k < first + n { solution.at[k].exp() / whole } else { 0.0 };
    let variance: f64 = (0..parameters.len())
        .flat_map(|i| (0..parameters.len()).map(move |j| (i, j)))
        .map(|(i, j)| share(i) * share(j) * solution.covariance[i][j])
        .sum();
    let freedom = solution.residuals.len() - parameters.len();
    let spread = least_squares::quantile(freedom) * variance.max(0.0).sqrt();
    let touch = match parameters.touch {
        true => {
            let (value, half) =
                (model.depth_scale() * solution.at[first + 2 * n], model.depth_scale() * half(first + 2 * n));
            Interval { value, low: value - half, high: value + half }
        }
        false => Interval::exact(0.0),
    };
    let squares: f64 = solution.residuals.iter().map(|r| r * r).sum();
    let jumps: f64 = solution.residuals.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
    IndentationFit {
        relaxation,
        equilibrium,
        instantaneous: Interval::factor(whole.ln(), spread),
        terms,
        touch,
        given: model.given(),
        predicted,
        rows,
        rms: solution.rms() * model.scale(),
        relative_rms: solution.rms(),
        durbin_watson: if squares > 0.0 { jumps / squares } else { 2.0 },
        window: model.window(),
    }
}

fn check_options(options: &IndentationOptions) -> Result<()> {
    if options.terms.is_some_and(|terms| terms > MOST_TERMS) {
        let terms = options.terms.unwrap_or_default();
        return Err(Error::invalid("number of terms", terms, format!("at most {MOST_TERMS}")));
    }
    if !(20..=10_000).contains(&options.springs) {
        return Err(Error::invalid("number of springs", options.springs, "between 20 and 10000"));
    }
    if !(options.limit > 0.0 && options.limit.is_finite()) {
        return Err(Error::invalid("largest misfit", options.limit, "finite and greater than 0"));
    }
    if options.terms == Some(0) && options.long_time == LongTime::Fluid {
        return Err(Error::invalid("number of terms", 0, "at least 1 for a fluid"));
    }
    Ok(())
}

/// What no record of an indentation is.
fn check(record: &IndentationRecord) -> Result<()> {
    let n = record.times.len();
    for (name, column) in [("loads", record.loads), ("depths", record.depths)] {
        if column.len() != n {
            return Err(Error::invalid(
                format!("number of {name}"),
                column.len(),
                format!("{n}, that of the times"),
            ));
        }
    }
    if !(FEWEST..=MOST).contains(&n) {
        return Err(Error::invalid(
            "number of rows of the record",
            n,
            format!("between {FEWEST} and {MOST}"),
        ));
    }
    let columns = [("time", "s", record.times), ("load", "N", record.loads), ("depth", "m", record.depths)];
    for (name, unit, column) in columns {
        if let Some((row, value)) =
            column.iter().enumerate().find(|(_, value)| value.is_nan() || value.abs() > LARGEST)
        {
            return Err(Error::invalid(
                format!("{name} of row {}", row + 1),
                value,
                format!("a number, at most {LARGEST:e} {unit}"),
            ));
        }
    }
    if let Some(row) = record.times.windows(2).position(|pair| pair[1] <= pair[0]) {
        return Err(Error::invalid(
            format!("time of row {}", row + 2),
            format!("{} s", record.times[row + 1]),
            format!("later than the row before, {} s", record.times[row]),
        ));
    }
    let largest = |column: &[f64]| column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (name, unit, column) in [("load", "N", record.loads), ("depth", "m", record.depths)] {
        if largest(column) < 1.0 / LARGEST {
            return Err(Error::invalid(
                format!("largest {name}"),
                format!("{} {unit}", largest(column)),
                "greater than 0: pressing is positive (turn the sign of the column)",
            ));
        }
    }
    let most = largest(record.loads);
    if let Some((row, load)) = record.loads.iter().enumerate().find(|(_, load)| **load < -PULL * most) {
        return Err(Error::invalid(
            format!("load of row {}", row + 1),
            format!("{load} N"),
            format!(
                "above -{:.0} % of the largest ({most:e} N): adhesion is not part of the model",
                100.0 * PULL
            ),
        ));
    }
    let pressed = record.loads.iter().filter(|load| **load > 0.02 * most).count();
    if pressed < FEWEST {
        return Err(Error::invalid(
            "number of rows in contact",
            pressed,
            format!("at least {FEWEST} with more than 2 % of the largest load"),
        ));
    }
    Ok(())
}

/// Rows of a record that are used: all, or every k-th and the last.
fn thinned(rows: usize) -> Vec<usize> {
    let every = rows.div_ceil(MANY).max(1);
    let mut kept: Vec<usize> = (0..rows).step_by(every).collect();
    if kept.last() != Some(&(rows - 1)) {
        kept.push(rows - 1);
    }
    kept
}

/// The channel with less scatter over its range: the one that the instrument controls.
fn quieter(times: &[f64], loads: &[f64], depths: &[f64]) -> Given {
    if scatter(times, depths) <= scatter(times, loads) { Given::Depth } else { Given::Load }
}

/// Median distance of a value from the line between its neighbours, over the largest value.
fn scatter(times: &[f64], values: &[f64]) -> f64 {
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let mut distances: Vec<f64> = (1..values.len() - 1)
        .map(|k| {
            let share = (times[k] - times[k - 1]) / (times[k + 1] - times[k - 1]);
            (values[k] - values[k - 1] - share * (values[k + 1] - values[k - 1])).abs() / largest
        })
        .collect();
    let middle = distances.len() / 2;
    *distances.select_nth_unstable_by(middle, f64::total_cmp).1
}
