//! Selection of the number of terms of a fit.

use super::check::MOST_TERMS;
use super::least_squares::{Solution, solve};
use super::model::Model;
use super::parameters::{Law, Parameters};
use super::start;
use crate::error::{Error, Result};
use crate::material::LongTime;

/// A parameter with a larger standard deviation (of the logarithm) is not determined: it is uncertain by a factor of 7 or more.
pub(super) const UNKNOWN: f64 = 1.0;
/// Error of the model itself, over the largest value.
pub(super) const MODEL_ERROR: f64 = 2e-5;

/// The best fit, with `terms` terms or the number needed.
pub(super) fn select(model: &Model, terms: Option<usize>, long_time: LongTime) -> Result<Solution> {
    match terms {
        Some(terms) => best_of(model, terms, long_time),
        None => as_many_as_needed(model, long_time),
    }
}

/// Whether the record determines each number of a fit.
pub(super) fn is_known(solution: &Solution) -> bool {
    solution.parameters.worst(&solution.deviations).is_none_or(|(_, deviation)| deviation <= UNKNOWN)
}

/// Fits with `terms` terms: a solid, a fluid, or the better of both.
pub(super) fn best_of(model: &Model, terms: usize, long_time: LongTime) -> Result<Solution> {
    let solids = match (long_time, terms) {
        (LongTime::Solid, _) | (_, 0) => &[true][..],
        (LongTime::Fluid, _) => &[false],
        (LongTime::Free, _) => &[true, false],
    };
    let mut best: Option<Solution> = None;
    let mut refused = None;
    for solid in solids {
        // An equilibrium modulus that is known to 30 % and carries a part of the load is not 0.
        let known = |solution: &Solution| {
            let share = solution.at[0].exp() / solution.relaxation().instantaneous();
            solution.parameters.solid && solution.deviations[0] < 0.3 && share > 1e-3
        };
        if best.as_ref().is_some_and(known) {
            break;
        }
        let parameters = Parameters { solid: *solid, terms, touch: model.fit_touch };
        let found = start::start(model, parameters).and_then(|start| solve(model, parameters, start));
        match found {
            Err(error) => refused = Some(error),
            Ok(next) => {
                let is_better = |other: &Solution| information(model, &next) < information(model, other);
                if best.as_ref().is_none_or(is_better) {
                    best = Some(next);
                }
            }
        }
    }
    let unknown = || Error::invalid("number of terms", terms, "one that can be fitted");
    best.ok_or_else(|| refused.unwrap_or_else(unknown))
}

/// Adds terms while this lowers the information criterion and each term is determined.
fn as_many_as_needed(model: &Model, long_time: LongTime) -> Result<Solution> {
    let mut best = best_of(model, usize::from(long_time == LongTime::Fluid), long_time)?;
    for terms in best.parameters.terms + 1..=MOST_TERMS {
        let Ok(next) = best_of(model, terms, long_time) else { break };
        if !is_known(&next) || information(model, &next) >= information(model, &best) {
            break;
        }
        best = next;
    }
    Ok(best)
}

/// Bayesian information criterion of m residuals, means of n rows in all: m ln(Σ r²/m) + k ln n.
pub(super) fn information<L: Law>(model: &Model, solution: &Solution<L>) -> f64 {
    let mean = solution.rms().powi(2).max(MODEL_ERROR * MODEL_ERROR);
    solution.residuals.len() as f64 * mean.ln() + solution.parameters.len() as f64 * model.rows().ln()
}
