//! Shift factors from measured isotherms.
//!
//! 1. Each pair of neighbours in temperature gives the distance along ln x at which one curve continues the other, and its
//!    standard deviation ([`super::align`]). The first curve (relaxation modulus, compliance, storage modulus) determines it; the
//!    others are used too where the first is flat. If the moduli change with temperature by unknown factors
//!    ([`ModulusChange::Free`]), all curves are used together, and each pair has one factor for all of its curves.
//! 2. The WLF or the Arrhenius law through all distances, weighted by their variances, supports pairs that contain little
//!    information: each distance becomes the mean of the measured one and that of the law, weighted by one over their variances,
//!    where the accuracy of a law is taken as 0.6 decades and 60 % of the distance. Relaxation is faster at higher temperatures,
//!    so no distance is negative. A law cannot bridge a gap between two curves: the standard deviation is at least the gap.
//! 3. Distances add up from the reference to each temperature, and so do the variances of the measured ones. Where a law is known
//!    better than the measured distance, the errors of neighbouring pairs are those of one law and add up themselves. A factor that is uncertain by more than a
//!    decade and by more than half of its decades is refused.
//! 4. The factors by which moduli change are computed at the distances of the final shift ([`estimate_vertical`]).

use super::align::{self, Distance, Logs, Ordinate};
use super::master::{Abscissa, Isotherm, validate};
use super::shift::{Shift, minimise};
use crate::error::{Error, Result, kelvin, require};
use std::f64::consts::LN_10;

mod vertical;

pub use vertical::{VerticalEstimate, estimate_vertical};

/// Shift factors found from isotherms.
#[derive(Clone, Debug, PartialEq)]
pub struct ShiftEstimate {
    /// The factors as a table, a_T = 1 at the reference.
    pub shift: Shift,
    /// Standard deviation of each factor, in the order of the table \[decades\]; 0 at the reference.
    pub uncertainty: Vec<f64>,
}

/// The change of the moduli of isotherms with temperature, in addition to the times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ModulusChange {
    /// A small change as for a rubber, T/T_r, or a glass: it is not corrected, but counts as an uncertainty.
    #[default]
    Neglected,
    /// The curves have already been multiplied by their vertical shift factors.
    Corrected,
    /// By one unknown factor per isotherm, the same for all of its curves.
    Free,
}

/// Standard deviation of the logarithm of a factor beyond which it is refused: in decades, and as a share of the logarithm. A factor of
/// twelve decades that is known to two is known; the caller reports its uncertainty.
const MOST_UNCERTAIN: [f64; 2] = [1.0, 0.5];
/// Standard deviation of the distance of a pair by a law \[decades\], and per distance.
const LAW: [f64; 2] = [0.6, 0.6];
/// Rubbers have lower moduli \[Pa\].
const RUBBER: f64 = 1e8;
/// Root mean square distance (in the logarithm) of the other curves that contradicts the first: they differ by half of their
/// value.
const CONTRADICTION: f64 = 0.2;
/// Curves with more points are averaged over tenths of ln x.
const MOST_POINTS: usize = 100;
/// Assumed change of the modulus with temperature, relative to that of an ideal rubber: for a rubber, for a glass, and the
/// uncertainty after the correction for a rubber.
const RUBBERY: f64 = 1.0;
const GLASSY: f64 = 0.15;
/// A pair is flat, and all curves are used, if the uncertainty of the distance from the first curve is larger than this
/// \[decades\].
const FLAT: f64 = 1.0;

/// The shift factors with which isotherms at neighbouring temperatures continue each other, as a table with a_T = 1 at the
/// `reference` temperature \[K\], which must be that of an isotherm, and the uncertainty of each factor.
///
/// [`fit_wlf`](crate::material::fit_wlf) and [`fit_arrhenius`](crate::material::fit_arrhenius) turn the table into a law.
///
/// ```
/// use asperity::material::{Abscissa, Isotherm, ModulusChange, estimate_shift};
/// // Power-law relaxation t^-0.3, ten times as fast at the warmer temperature.
/// let x: Vec<f64> = (0..13).map(|k| 10f64.powf(k as f64 / 4.0)).collect();
/// let curve = |a: f64| vec![x.iter().map(|t| 1e6 / (1.0 + (t / a).powf(0.3))).collect()];
/// let cold = Isotherm { temperature: 290.0, x: x.clone(), curves: curve(10.0) };
/// let warm = Isotherm { temperature: 300.0, x: x.clone(), curves: curve(1.0) };
/// let found = estimate_shift(&[cold, warm], Abscissa::Time, 300.0, ModulusChange::Neglected)?;
/// assert!((found.shift.factor(290.0)? / 10.0 - 1.0).abs() < 0.01);
/// // A modulus in proportion to the temperature would shift the curve as well: 0.034/0.25/ln 10 decades.
/// assert!(found.uncertainty[0] < 0.1);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] as [`master_curve`](crate::material::master_curve); for fewer than two isotherms; if a factor is uncertain
/// by more than a decade and half of its decades, naming the pair of isotherms with the least information.
pub fn estimate_shift(
    isotherms: &[Isotherm],
    abscissa: Abscissa,
    reference: f64,
    moduli: ModulusChange,
) -> Result<ShiftEstimate> {
    let sorted = sorted(isotherms)?;
    let temperatures: Vec<f64> = sorted.iter().map(|isotherm| isotherm.temperature).collect();
    let Some(anchor) = temperatures.iter().position(|t| *t == reference) else {
        let known: Vec<String> = temperatures.iter().map(|t| kelvin(*t)).collect();
        let expected = format!("one of the isotherms: {}", known.join(", "));
        return Err(Error::invalid("reference temperature", kelvin(reference), expected));
    };
    let measured: Vec<Distance> =
        sorted.windows(2).map(|pair| between(pair[0], pair[1], abscissa, moduli)).collect();
    let found = with_law(&temperatures, &measured);
    let sums = |of: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let sum = (0..found.len()).scan(0.0, |sum, pair| {
            *sum += of(pair);
            Some(*sum)
        });
        std::iter::once(0.0).chain(sum).collect()
    };
    let by_law = |pair: usize| measured[pair].deviation > doubt(found[pair].value);
    let deviation = |pair: usize| found[pair].deviation;
    // Relaxation is faster at higher temperatures: ln a_T falls by the distance from pair to pair.
    let moved = sums(&|pair| found[pair].value);
    let together = sums(&|pair| if by_law(pair) { deviation(pair) } else { 0.0 });
    let variance = sums(&|pair| if by_law(pair) { 0.0 } else { deviation(pair) * deviation(pair) });
    let points: Vec<(f64, f64)> =
        (0..sorted.len()).map(|k| (temperatures[k], moved[anchor] - moved[k])).collect();
    let from_anchor = |sums: &[f64], k: usize| (sums[k] - sums[anchor]).abs();
    let decades = |k: usize| (from_anchor(&together, k).powi(2) + from_anchor(&variance, k)).sqrt() / LN_10;
    let uncertainty: Vec<f64> = (0..sorted.len()).map(decades).collect();
    let [most, share] = MOST_UNCERTAIN;
    let known = |((_, ln), decades): (&(f64, f64), &f64)| *decades <= most.max(share * (ln / LN_10).abs());
    if !points.iter().zip(&uncertainty).all(known) {
        return Err(uncertain(&sorted, &measured, &uncertainty));
    }
    Ok(ShiftEstimate { shift: Shift::Table { points }, uncertainty })
}

/// At least two isotherms, in order of temperature, without duplicates.
fn sorted(isotherms: &[Isotherm]) -> Result<Vec<&Isotherm>> {
    validate(isotherms, 2)?;
    let mut sorted: Vec<&Isotherm> = isotherms.iter().collect();
    sorted.sort_by(|a, b| a.temperature.total_cmp(&b.temperature));
    require(sorted.len() >= 2, "number of isotherms", sorted.len(), "at least 2")?;
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0].temperature == pair[1].temperature) {
        let value = format!("{} twice", kelvin(pair[0].temperature));
        return Err(Error::invalid("temperature of the isotherms", value, "each once"));
    }
    Ok(sorted)
}

/// The distance in ln t by which the colder isotherm lags behind the warmer one.
fn between(cold: &Isotherm, warm: &Isotherm, abscissa: Abscissa, moduli: ModulusChange) -> Distance {
    let pairs = pairs(cold, warm, abscissa);
    let share = |pair: &[Logs; 2]| match (moduli, is_rubber(pair)) {
        (ModulusChange::Corrected, true) | (ModulusChange::Neglected, false) => GLASSY,
        _ => RUBBERY,
    };
    let change = (warm.temperature / cold.temperature).ln();
    let of =
        |pair: &[Logs; 2]| align::distance(std::slice::from_ref(pair), Ordinate::Held(change * share(pair)));
    match (moduli, pairs.split_first()) {
        (ModulusChange::Free, _) => align::distance(&pairs, Ordinate::Free),
        (_, Some((first, others))) => {
            let first = of(first);
            if first.deviation <= FLAT * LN_10 {
                // The scatter of a flat curve can appear as a distance, which the other curves then contradict.
                let contradicted = !others.is_empty() && align::apart(others, first.value) > CONTRADICTION;
                let deviation = if contradicted { f64::INFINITY } else { first.deviation };
                return Distance { deviation, ..first };
            }
            others.iter().map(of).fold(first, mean)
        }
        (_, None) => align::distance(&[], Ordinate::Free),
    }
}

/// Each quantity of both isotherms.
fn pairs(cold: &Isotherm, warm: &Isotherm, abscissa: Abscissa) -> Vec<[Logs; 2]> {
    let of = |curve: usize| [cold, warm].map(|isotherm| logs(isotherm, abscissa, curve));
    (0..cold.curves.len()).map(of).collect()
}

/// Whether moduli are those of a rubber, which grow with the absolute temperature (elasticity of entropy); those of a glass
/// change about seven times less.
fn is_rubber([first, second]: &[Logs; 2]) -> bool {
    let count = (first.len() + second.len()) as f64;
    let mean = first.iter().chain(second).map(|point| point.1).sum::<f64>() / count;
    // The logarithm of a compliance is negative; its absolute value is that of the inverse, a modulus.
    mean.abs() < RUBBER.ln()
}

/// ln t or -ln omega, increasing, and the logarithm of the values.
fn logs(isotherm: &Isotherm, abscissa: Abscissa, curve: usize) -> Logs {
    let points = isotherm.x.iter().zip(&isotherm.curves[curve]).map(|(x, value)| (x.ln(), value.ln()));
    let points: Logs = match abscissa {
        Abscissa::Time => points.collect(),
        Abscissa::Frequency => points.rev().map(|(x, y)| (-x, y)).collect(),
    };
    match points.len() > MOST_POINTS {
        true => points.chunk_by(|a, b| bin(a.0) == bin(b.0)).map(average).collect(),
        false => points,
    }
}

/// Tenths of ln x.
fn bin(x: f64) -> i64 {
    (10.0 * x).floor() as i64
}

fn average(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    let sum = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    (sum(|point| point.0), sum(|point| point.1))
}

/// The mean of two independent values, weighted by one over their variances.
fn mean(a: Distance, b: Distance) -> Distance {
    let weight = |d: Distance| 1.0 / (d.deviation * d.deviation).max(1e-12);
    let (wa, wb) = (weight(a), weight(b));
    if wa + wb == 0.0 {
        return a;
    }
    let value = (wa * a.value + wb * b.value) / (wa + wb);
    Distance { value, deviation: (wa + wb).sqrt().recip(), ..a }
}

/// The measured distances, each averaged with that of a law through all of them, and never negative.
fn with_law(temperatures: &[f64], measured: &[Distance]) -> Vec<Distance> {
    let law = law(temperatures, measured);
    let averaged = measured.iter().enumerate().map(|(k, distance)| match &law {
        Some(law) => mean(*distance, Distance { value: law[k], deviation: doubt(law[k]), ..*distance }),
        None => *distance,
    });
    averaged
        .map(|distance| {
            let distance = Distance { value: distance.value.max(0.0), ..distance };
            Distance { deviation: distance.deviation.max(distance.gap()), ..distance }
        })
        .collect()
}

/// Standard deviation of a distance by a law \[ln\].
fn doubt(distance: f64) -> f64 {
    LAW[0] * LN_10 + LAW[1] * distance
}

/// The distances of the pairs by the law through the measured ones; `None` if fewer than two of them are known or relaxation is
/// not faster at higher temperatures.
fn law(temperatures: &[f64], measured: &[Distance]) -> Option<Vec<f64>> {
    let known = measured.iter().filter(|distance| distance.deviation < FLAT * LN_10).count();
    if known < 2 {
        return None;
    }
    let coldest = temperatures[0];
    // ln a_T about the coldest temperature: WLF for a given c2, then Arrhenius.
    let wlf = |u: f64| move |t: f64| (t - coldest) / (u.exp() + t - coldest);
    let arrhenius = |t: f64| 1.0 / coldest - 1.0 / t;
    let squares_of_wlf = |u: f64| scaled(temperatures, measured, &wlf(u)).1;
    let best = minimise(0.0, 1e4f64.ln(), 300, squares_of_wlf);
    let [wlf, arrhenius] =
        [scaled(temperatures, measured, &wlf(best)), scaled(temperatures, measured, &arrhenius)];
    // Two distances do not determine three constants.
    let (law, _) = if known > 2 && wlf.1 < arrhenius.1 { wlf } else { arrhenius };
    law.iter().all(|distance| *distance >= 0.0 && distance.is_finite()).then_some(law)
}

/// The differences of `form` between neighbours, times the factor that brings them closest to the measured distances, and
/// the weighted sum of squares.
fn scaled(temperatures: &[f64], measured: &[Distance], form: &dyn Fn(f64) -> f64) -> (Vec<f64>, f64) {
    let steps: Vec<f64> = temperatures.windows(2).map(|pair| form(pair[1]) - form(pair[0])).collect();
    let weight = |d: &Distance| 1.0 / (d.deviation * d.deviation + doubt(d.value.max(0.0)).powi(2));
    let (mut above, mut below) = (0.0, 0.0);
    for (step, distance) in steps.iter().zip(measured).filter(|(_, d)| d.deviation.is_finite()) {
        above += weight(distance) * step * distance.value;
        below += weight(distance) * step * step;
    }
    let factor = above / below;
    let squares = steps.iter().zip(measured).filter(|(_, d)| d.deviation.is_finite());
    let squares = squares.map(|(step, d)| weight(d) * (factor * step - d.value).powi(2)).sum();
    (steps.iter().map(|step| factor * step).collect(), squares)
}

/// Names the pair with the least information.
fn uncertain(sorted: &[&Isotherm], measured: &[Distance], uncertainty: &[f64]) -> Error {
    let worst = (0..measured.len()).max_by(|a, b| measured[*a].deviation.total_cmp(&measured[*b].deviation));
    let worst = worst.unwrap_or(0);
    let largest = uncertainty.iter().copied().fold(0.0, f64::max);
    let decades = measured[worst].deviation / LN_10;
    let shown = |decades: f64| match decades < 10.0 {
        true => format!("{decades:.1} decades"),
        false => "more than 10 decades".to_owned(),
    };
    let at = |k: usize| format!("{:.2} K ({:.2} °C)", sorted[k].temperature, sorted[k].temperature - 273.15);
    Error::invalid(
        format!(
            "distance along the logarithm of time of the isotherms at {} and {}",
            at(worst),
            at(worst + 1)
        ),
        format!("uncertain by {}, and shift factors by {}", shown(decades), shown(largest)),
        format!(
            "known to {} decade, or to {} of its decades: curves with a slope, at temperatures so close that neighbours overlap; measure \
             between them, leave an isotherm out, or give the shift (a table of factors, or the constants of a law)",
            MOST_UNCERTAIN[0], MOST_UNCERTAIN[1]
        ),
    )
}

#[cfg(test)]
mod tests;
