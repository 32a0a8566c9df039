//! Notes that the user should know before relying on a fit.

use super::{IndentationFit, IndentationOptions, Interval, UNENDING};

/// Durbin-Watson number below which residuals are correlated.
pub(crate) const ALIKE: f64 = 1.5;
/// Probability of the number of terms of the best fit below which others are reported.
const SURE: f64 = 0.5;
/// Smallest probability of another number that is reported.
const LIKELY: f64 = 0.1;

const EQUILIBRIUM: &str = "the equilibrium modulus";

/// Implausible radii [m]: a unit is missing.
const RADII: std::ops::Range<f64> = 1e-9..0.5;

/// A radius that looks like one in another unit.
pub(crate) fn unlikely_radius(radius: f64) -> Option<String> {
    (!RADII.contains(&radius)).then(|| {
        format!("the radius is {radius:e} m, which is unlikely for an indenter: numbers without a unit are in metres")
    })
}

pub(super) fn notes(fit: &IndentationFit, options: &IndentationOptions) -> Vec<String> {
    let relaxes = fit.terms.last().map(|[_, time]| time.high).filter(|high| *high > UNENDING * fit.window[1]);
    let mut notes: Vec<String> = relaxes
        .map(|high| {
            format!(
                "the equilibrium modulus is not determined by this record: the record ends after {:.3e} s, and the longest relaxation \
                 time may be {high:.3e} s, so the body may relax further; hold it longer",
                fit.window[1]
            )
        })
        .into_iter()
        .collect();
    let open = undetermined(fit).into_iter().filter(|what| relaxes.is_none() || what != EQUILIBRIUM);
    notes.extend(open.map(|what| {
        format!(
            "{what} is not determined by this record: its 95 % interval spans more than a factor of 10, and \
                 the value of the best fit is one of many that fit as well"
        )
    }));
    if options.terms.is_none() {
        notes.extend(number_of_terms(fit));
    }
    if fit.durbin_watson < ALIKE {
        notes.push(format!(
            "the residuals follow each other (Durbin-Watson number {:.2}, near 2 where they are independent): the model \
             bends away from the record (friction, drift, adhesion, a substrate) or the noise is not white; the \
             intervals are wider for it, but a systematic error is not in them",
            fit.durbin_watson
        ));
    }
    let [step, length] = fit.window;
    for (k, [_, time]) in fit.terms.iter().enumerate() {
        let k = k + 1;
        if time.value < step {
            notes.push(format!(
                "the time of term {k} ({:.3e} s) is shorter than the steps of the record ({step:.3e} s)",
                time.value
            ));
        } else if time.value > length {
            notes.push(format!(
                "the time of term {k} ({:.3e} s) is longer than the record ({length:.3e} s)",
                time.value
            ));
        }
    }
    notes
}

fn undetermined(fit: &IndentationFit) -> Vec<String> {
    let ends = [("the modulus at once", &fit.instantaneous), (EQUILIBRIUM, &fit.equilibrium)];
    let ends = ends.into_iter().map(|(name, interval)| (name.to_owned(), interval));
    let terms = fit.terms.iter().enumerate().flat_map(|(k, [modulus, time])| {
        let k = k + 1;
        [(format!("the modulus of term {k}"), modulus), (format!("the time of term {k}"), time)]
    });
    let open = |(name, interval): (String, &Interval)| (!interval.determined).then_some(name);
    ends.chain(terms).filter_map(open).collect()
}

fn number_of_terms(fit: &IndentationFit) -> Option<String> {
    let own = fit.terms.len();
    if fit.numbers[own] >= SURE {
        return None;
    }
    let likely = fit.numbers.iter().enumerate().filter(|(n, share)| *n == own || **share >= LIKELY);
    let shares: Vec<String> = likely.map(|(n, share)| format!("{n}: {:.0} %", 100.0 * share)).collect();
    Some(format!(
        "the number of terms is not determined by this record (probabilities {}): the intervals of the terms hold if there \
         are {own}",
        shares.join(", ")
    ))
}
