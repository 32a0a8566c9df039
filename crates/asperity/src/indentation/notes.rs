//! Notes that the user should know before relying on a fit.

use super::average::EXCLUDED;
use super::{IndentationFit, IndentationOptions, Interval, PowerLawFit, UNENDING};
use crate::reference::MdrProfile;

/// Durbin-Watson number below which residuals are correlated.
pub(crate) const ALIKE: f64 = 1.5;
/// Probability of the number of terms of the best fit below which others are reported.
const SURE: f64 = 0.5;
/// Smallest probability of another number that is reported.
const LIKELY: f64 = 0.1;

/// A shortest time whose interval begins below this number of steps of the record may be any shorter one.
const FIRST: f64 = 1.2;
/// Difference of ball and paraboloid that is never told.
const SAME: f64 = 1e-3;
/// Radius of the contact over that of the ball beyond which strains are not small.
const WIDE: f64 = 0.4;

/// Share of the largest load in the first row that is told.
const PRESSED: f64 = 0.2;

const EQUILIBRIUM: &str = "the equilibrium modulus";

/// Implausible radii [m]: a unit is missing.
const RADII: std::ops::Range<f64> = 1e-9..0.5;

/// A radius that looks like one in another unit.
pub(crate) fn unlikely_radius(radius: f64) -> Option<String> {
    (!RADII.contains(&radius)).then(|| {
        format!("the radius is {radius:e} m, which is unlikely for an indenter: numbers without a unit are in metres")
    })
}

/// What the shape of the indenter does at this depth, beside a relative misfit.
pub(crate) fn of_indenter(profile: MdrProfile, depth: f64, misfit: f64, layered: bool) -> Vec<String> {
    let mut notes = vec![];
    if let (Some(radius), Some(excess)) = (profile.radius(), profile.paraboloid_excess(depth)) {
        notes.extend(unlikely_radius(radius));
        let share = depth / radius;
        let percent = 100.0 * excess;
        if excess > misfit.max(SAME) {
            notes.push(match profile {
                MdrProfile::Paraboloid { .. } => format!(
                    "at the largest depth, {share:.2} of the radius, the paraboloid carries {percent:.1} % more load than the ball of this radius: \
                     for a ball take the indenter `sphere`"
                ),
                _ => format!(
                    "at the largest depth, {share:.2} of the radius, the paraboloid of Hertz's formula carries {percent:.1} % more load than the \
                     ball, which is fitted"
                ),
            });
        }
        let wide = profile.reach(depth) / radius;
        if wide > WIDE {
            notes.push(format!(
                "the contact is {wide:.2} times as wide as the ball: strains are of that order, and the theory is that of small strains; moduli \
                 of soft bodies that stiffen come out too large"
            ));
        }
    }
    if layered && matches!(profile, MdrProfile::Pyramid { .. }) {
        notes.push(
            "on a thin sample the pyramid is taken as the cone with its load on a half-space: an estimate where the contact is as wide as the \
             sample is thick"
                .to_owned(),
        );
    }
    notes
}

/// Residuals that follow each other.
fn correlated(durbin_watson: f64) -> Option<String> {
    (durbin_watson < ALIKE).then(|| {
        format!(
            "the residuals follow each other (Durbin-Watson number {durbin_watson:.2}, near 2 where they are independent): the model \
             bends away from the record (friction, drift, adhesion, a substrate) or the noise is not white; the \
             intervals are wider for it, but a systematic error is not in them"
        )
    })
}

/// What a power law with this exponent means for a Prony series that describes the record worse.
pub(super) fn of_better(fit: &IndentationFit, exponent: f64) -> String {
    let terms = fit.terms.len();
    format!(
        "a power law t^-{exponent:.3} describes the record better with two numbers than the series with {terms} term{} (Bayesian information \
         criterion): such a body has no modulus at once and none in equilibrium, and those given here are those of the steps and of the \
         length of the record; use the model `power-law`",
        if terms == 1 { "" } else { "s" }
    )
}

/// A record that begins under load: it may be the hold of a test whose ramp is missing.
pub(super) fn of_start(loads: &[f64]) -> Option<String> {
    let share = loads[0] / loads.iter().copied().fold(0.0, f64::max);
    (share > PRESSED).then(|| {
        format!(
            "the record begins at {:.0} % of its largest load, which is taken as applied at once in its first row: if a ramp came before, its \
             relaxation is missing and the moduli of short times come out too small; fit ramp and hold as one record",
            100.0 * share
        )
    })
}

pub(super) fn of_power_law(fit: &PowerLawFit) -> Vec<String> {
    let mut notes = vec![];
    let [step, length] = fit.window;
    if !fit.modulus.determined {
        notes.push(
            "the modulus at 1 s is not determined by this record: its 95 % interval spans more than a factor of 10"
                .to_owned(),
        );
    }
    if !fit.exponent.determined {
        notes.push(
            "the exponent is not determined by this record: its 95 % interval spans more than half of its range"
                .to_owned(),
        );
    }
    if fit.exponent.low == 0.0 {
        notes.push("the exponent may be 0: an elastic body describes the record as well".to_owned());
    }
    if fit.exponent.high == 1.0 {
        notes.push("the exponent may be 1: a liquid describes the record as well".to_owned());
    }
    if !(step..=length).contains(&1.0) {
        notes.push(format!(
            "the record has times from {step:.3e} s to {length:.3e} s: the modulus at 1 s is an extrapolation"
        ));
    }
    notes.extend(correlated(fit.durbin_watson));
    notes
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
    notes.extend(at_the_ends(fit));
    notes.extend(correlated(fit.durbin_watson));
    let [step, length] = fit.window;
    if let Some([_, time]) = fit.terms.first()
        && time.value >= step
        && time.low < FIRST * step
    {
        notes.push(format!(
            "the shortest relaxation time may be that of the steps of the record ({step:.3e} s): the modulus at once is the one after such a \
             step, and the body may be stiffer before"
        ));
    }
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

/// The numbers of the fit with their names.
fn named(fit: &IndentationFit) -> impl Iterator<Item = (String, &Interval)> {
    let ends = [("the modulus at once", &fit.instantaneous), (EQUILIBRIUM, &fit.equilibrium)];
    let ends = ends.into_iter().map(|(name, interval)| (name.to_owned(), interval));
    let terms = fit.terms.iter().enumerate().flat_map(|(k, [modulus, time])| {
        let k = k + 1;
        [(format!("the modulus of term {k}"), modulus), (format!("the time of term {k}"), time)]
    });
    ends.chain(terms)
}

fn undetermined(fit: &IndentationFit) -> Vec<String> {
    named(fit).filter(|(_, interval)| !interval.determined).map(|(name, _)| name).collect()
}

/// Values of the best fit that most of the likely materials have all larger, or all smaller.
fn at_the_ends(fit: &IndentationFit) -> Option<String> {
    let at_an_end = |x: &Interval| {
        x.determined && x.value > 0.0 && x.low < x.high && (x.value == x.low || x.value == x.high)
    };
    let names: Vec<String> =
        named(fit).filter(|(_, interval)| at_an_end(interval)).map(|(name, _)| name).collect();
    let others = "materials with other numbers of terms, which are as probable, lie on one side";
    match names.as_slice() {
        [] => None,
        [name] => Some(format!(
            "{name} of the best fit lies at the end of its interval: {others} of it; take the interval, not the value"
        )),
        names => Some(format!(
            "{} of the best fit lie at the ends of their intervals: {others} of them; take the intervals, not the values",
            names.join(", ")
        )),
    }
}

fn number_of_terms(fit: &IndentationFit) -> Option<String> {
    let own = fit.terms.len();
    if fit.numbers[own] >= SURE {
        return None;
    }
    if fit.numbers[own] < EXCLUDED {
        let most = (0..fit.numbers.len()).max_by(|a, b| fit.numbers[*a].total_cmp(&fit.numbers[*b]))?;
        return Some(format!(
            "{own} terms are practically excluded (probability {:.2}), and the record does not determine the numbers of {most} (probability {:.2}): do \
             not take the terms as those of the material; E(0) and E(inf) have their intervals from all numbers of terms",
            fit.numbers[own], fit.numbers[most]
        ));
    }
    let likely = fit.numbers.iter().enumerate().filter(|(n, share)| *n == own || **share >= LIKELY);
    let shares: Vec<String> = likely.map(|(n, share)| format!("{n}: {:.0} %", 100.0 * share)).collect();
    Some(format!(
        "the number of terms is not determined by this record (probabilities {}): the intervals of the terms hold if there \
         are {own}",
        shares.join(", ")
    ))
}
