//! Checks of measured curves before the fit: order, sign, noise, and passivity.

use crate::error::{Error, Result, increasing, require, significant};
use crate::material::spectrum::Kernel;
use crate::numbers::median;

/// Number of points above which a curve is averaged.
const MOST_POINTS: usize = 10_000_000;
/// Smallest number of points that determines the scatter.
const FEW_POINTS: usize = 20;
/// Widest range of times or frequencies.
const MOST_DECADES: f64 = 60.0;

/// A kind of curve: the names of its quantities, and what a material makes of them.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    /// "time" or "angular frequency"
    pub abscissa: &'static str,
    pub abscissa_unit: &'static str,
    /// "relaxation modulus"
    pub ordinate: &'static str,
    pub ordinate_unit: &'static str,
    pub kernel: Kernel,
    /// Where that of a passive material changes in one direction only.
    pub trend: Option<Trend>,
}

impl Kind {
    pub(super) const RELAXATION: Kind = Kind {
        abscissa: "time",
        abscissa_unit: "s",
        ordinate: "relaxation modulus",
        ordinate_unit: "Pa",
        kernel: Kernel::Relaxation,
        trend: Some(Trend::Falls),
    };
    pub(super) const CREEP: Kind = Kind {
        ordinate: "creep compliance",
        ordinate_unit: "1/Pa",
        kernel: Kernel::Creep,
        trend: Some(Trend::Rises),
        ..Kind::RELAXATION
    };
    pub(super) const STORAGE: Kind = Kind {
        abscissa: "angular frequency",
        abscissa_unit: "rad/s",
        ordinate: "storage modulus",
        ordinate_unit: "Pa",
        kernel: Kernel::Storage,
        trend: Some(Trend::Rises),
    };
    pub(super) const LOSS: Kind =
        Kind { ordinate: "loss modulus", kernel: Kernel::Loss, trend: None, ..Kind::STORAGE };
}

/// A measured curve.
#[derive(Clone, Copy)]
pub(super) struct Curve<'a> {
    pub kind: Kind,
    pub xs: &'a [f64],
    pub values: &'a [f64],
    /// Smallest scale of a value: residuals are relative to the larger of the two.
    pub floor: f64,
    /// Weight of its residuals in the sum of squares.
    pub weight: f64,
}

/// The direction in which the curve of a passive material changes along the abscissa.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Trend {
    Falls,
    Rises,
}

/// Checks that the abscissae increase strictly from a positive number (or from 0, where `zero`).
pub(super) fn check_abscissae(kind: Kind, xs: &[f64], zero: bool) -> Result<()> {
    let name = |n: usize| format!("{} of point {}", kind.abscissa, n + 1);
    require(
        (2..=MOST_POINTS).contains(&xs.len()),
        format!("number of points of the {}", kind.ordinate),
        xs.len(),
        format!("between 2 and {MOST_POINTS}"),
    )?;
    for (n, x) in xs.iter().enumerate() {
        let positive = *x >= f64::MIN_POSITIVE || (zero && n == 0 && *x == 0.0);
        if !(positive && x.is_finite()) {
            let least = if zero && n == 0 { "not less than" } else { "greater than" };
            let expected = format!("finite and {least} 0 {}", kind.abscissa_unit);
            return Err(Error::invalid(name(n), x, expected));
        }
    }
    increasing(xs.iter().copied(), name, |x| format!("{x:e} {}", kind.abscissa_unit))?;
    let first = if xs[0] > 0.0 { xs[0] } else { xs[1] };
    let decades = xs[xs.len() - 1].log10() - first.log10();
    require(
        decades <= MOST_DECADES,
        format!("range of the {}", kind.abscissa),
        format!("{decades:.0} decades"),
        format!("at most {MOST_DECADES} decades"),
    )
}

/// Relative scatter of a curve (standard deviation), from the distances between each point and the cubic through its four
/// neighbours, in logarithms where all are positive: curves over decades are smooth in these. Because of the median, single
/// outliers have no effect. 0 for fewer than 5 points.
pub(super) fn noise(xs: &[f64], values: &[f64]) -> f64 {
    if xs.len() < 5 {
        return 0.0;
    }
    let distance = |(x, v): (&[f64], &[f64])| {
        let positive = x.iter().chain(v).all(|number| *number > 0.0);
        let logarithms = |numbers: &[f64]| -> Vec<f64> { numbers.iter().map(|n| n.ln()).collect() };
        match positive {
            true => from_cubic(&logarithms(x), &logarithms(v)),
            // Relative to the largest of the five.
            false => from_cubic(x, v) / v.iter().copied().fold(f64::MIN_POSITIVE, f64::max),
        }
    };
    let mut distances: Vec<f64> = xs.windows(5).zip(values.windows(5)).map(distance).collect();
    // The median of the absolute value of a normal variable is 0.6745 of its standard deviation.
    median(&mut distances) / 0.6745
}

/// Distance of the third of five points from the cubic through the others (Lagrange), over its standard deviation where each
/// value has the standard deviation 1.
fn from_cubic(x: &[f64], v: &[f64]) -> f64 {
    let others = [0, 1, 3, 4];
    let weight = |i: usize| -> f64 {
        others.iter().filter(|j| **j != i).map(|j| (x[2] - x[*j]) / (x[i] - x[*j])).product()
    };
    let weights = others.map(weight);
    let cubic: f64 = others.iter().zip(weights).map(|(i, w)| w * v[*i]).sum();
    (v[2] - cubic).abs() / (1.0 + weights.iter().map(|w| w * w).sum::<f64>()).sqrt()
}

/// Means over a hundredth of a decade, as (abscissa, value, count), if there are more than 1000 points (instruments sample evenly
/// in time): the cost of the fit is then independent of the number of points. Curves over more than six decades have about 600
/// means, but at least 20 per decade: the curvature of any Prony series over such a bin is below 1e-3.
pub(super) fn thin(xs: &[f64], values: &[f64]) -> Vec<(f64, f64, f64)> {
    let points = xs.iter().zip(values);
    if xs.len() <= 1000 {
        return points.map(|(x, value)| (*x, *value, 1.0)).collect();
    }
    let first = xs.iter().copied().find(|x| *x > 0.0).unwrap_or(1.0);
    let decades = (xs[xs.len() - 1] / first).log10();
    let per_decade = (600.0 / decades).clamp(20.0, 100.0);
    let mut bins: Vec<(f64, f64, f64)> = vec![];
    let mut current = None;
    for (x, value) in points {
        let bin = (per_decade * x.log10()).floor();
        match bins.last_mut() {
            Some(last) if current == Some(bin) => {
                last.2 += 1.0;
                last.0 += (x - last.0) / last.2;
                last.1 += (value - last.1) / last.2;
            }
            _ => bins.push((*x, *value, 1.0)),
        }
        current = Some(bin);
    }
    bins
}

/// A place where a curve changes in the direction in which that of a passive material does not, by more than its own scatter explains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reversal {
    /// "relaxation modulus", "creep compliance" or "storage modulus".
    pub quantity: &'static str,
    /// Largest relative distance of a value from the extreme one before it.
    pub share: f64,
    /// The part of it that scatter explains.
    pub allowed: f64,
    /// Number of the first point beyond that, from 0.
    pub point: usize,
    /// Number of the point with the extreme value before it.
    pub extreme: usize,
}

impl<'a> Curve<'a> {
    /// A curve with one finite, positive (or not negative, where `zero`) value for each abscissa.
    pub(super) fn new(kind: Kind, xs: &'a [f64], values: &'a [f64], zero: bool) -> Result<Self> {
        let curve = Curve { kind, xs, values, floor: 0.0, weight: 1.0 };
        require(
            values.len() == xs.len(),
            format!("number of values of the {}", kind.ordinate),
            values.len(),
            format!("{}, one for each {}", xs.len(), kind.abscissa),
        )?;
        let valid =
            |value: &f64| value.is_finite() && (*value >= f64::MIN_POSITIVE || (zero && *value == 0.0));
        if let Some(n) = values.iter().position(|value| !valid(value)) {
            let bound = if zero { "not less than" } else { "greater than" };
            return Err(curve.wrong(n, format!("finite and {bound} 0, as for every passive material")));
        }
        Ok(curve)
    }

    /// The error of point `n`: "relaxation modulus of point 3 (time 0.5 s) is 2e6 Pa, but must be ...".
    pub(super) fn wrong(&self, n: usize, expected: String) -> Error {
        let Kind { abscissa, abscissa_unit, ordinate, ordinate_unit, .. } = self.kind;
        let point = format!("{ordinate} of point {} ({abscissa} {:e} {abscissa_unit})", n + 1, self.xs[n]);
        Error::invalid(point, format!("{:e} {ordinate_unit}", self.values[n]), expected)
    }

    /// Its scatter.
    pub(super) fn noise(&self) -> f64 {
        noise(self.xs, self.values)
    }

    /// The reversal of a curve with a trend. Its scatter explains the distance of the two extremes of N normal deviates, and at least
    /// `limit`, the misfit that a fit may have: sweeps of a master curve often differ by a few per cent. The scatter of a few points
    /// cannot be distinguished from the curvature of their curve.
    pub(super) fn reversal(&self, limit: f64) -> Option<Reversal> {
        let (trend, values) = (self.kind.trend?, self.values);
        let extremes = 2.0 * (1.0 + (2.0 * (values.len() as f64).ln()).sqrt());
        let scatter = if self.is_short() { 0.0 } else { extremes * self.noise() };
        // A fall by the whole value is not scatter.
        let allowed = scatter.max(limit.min(0.5));
        let (mut found, mut extreme): (Option<Reversal>, usize) = (None, 0);
        for (point, value) in values.iter().enumerate() {
            let share = match trend {
                Trend::Falls => value / values[extreme] - 1.0,
                Trend::Rises => 1.0 - value / values[extreme],
            };
            if share > allowed {
                let first = Reversal { quantity: self.kind.ordinate, share, allowed, point, extreme };
                let found = found.get_or_insert(first);
                found.share = found.share.max(share);
            }
            if share < 0.0 {
                extreme = point;
            }
        }
        found
    }

    /// Whether it has too few points to determine its scatter.
    pub(super) fn is_short(&self) -> bool {
        self.xs.len() < FEW_POINTS
    }

    /// The error for such a reversal.
    pub(super) fn reversed(&self, found: Reversal) -> Error {
        let (not, side) = match self.kind.trend {
            Some(Trend::Falls) => ("not rise", "above"),
            _ => ("not fall", "below"),
        };
        let Kind { abscissa, abscissa_unit, ordinate_unit, .. } = self.kind;
        let expected = format!(
            "not more than {:.1} % {side} the {:e} {ordinate_unit} at {abscissa} {:e} {abscissa_unit}: in a passive material it does {not}",
            100.0 * found.allowed,
            self.values[found.extreme],
            self.xs[found.extreme]
        );
        self.wrong(found.point, expected)
    }

    /// Refuses a curve from which the best passive material deviates systematically: the mean of up to five neighbouring relative
    /// residuals exceeds `limit` (or 5 standard deviations of such a mean).
    pub(super) fn check_misfit(&self, residuals: &[f64], limit: f64) -> Result<()> {
        let window = residuals.len().div_ceil(4).min(5);
        let allowed = limit.max(5.0 * self.noise() / (window as f64).sqrt());
        let means = residuals.windows(window).map(|r| r.iter().sum::<f64>() / window as f64);
        match means.enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs())) {
            Some((start, mean)) if mean.is_nan() || mean.abs() > allowed => {
                let expected = format!(
                    "within {} % of a passive material; the nearest one lies {:.1} % {} the data there",
                    significant(100.0 * allowed, 2),
                    100.0 * mean.abs(),
                    if mean > 0.0 { "above" } else { "below" }
                );
                Err(self.wrong(start + window / 2, expected))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scatter_is_measured_and_an_outlier_is_not_scatter() {
        let xs: Vec<f64> = (1..200).map(f64::from).collect();
        let mut values: Vec<f64> = xs.iter().map(|x| 5.0 * x.powf(-0.3)).collect();
        values[50] *= 2.0;
        // A power law only has rounding errors.
        assert!(noise(&xs, &values) < 1e-14);
        // Six points per decade of a curve that falls by a decade, without and with 1 % of scatter.
        let xs: Vec<f64> = (0..60).map(|k| 10f64.powf(f64::from(k) / 6.0)).collect();
        let smooth: Vec<f64> = xs.iter().map(|x| 1.0 + 9.0 / (1.0 + (x / 1e5).sqrt())).collect();
        assert!(noise(&xs, &smooth) < 1e-3, "{}", noise(&xs, &smooth));
        // A peak, four points per decade.
        let coarse: Vec<f64> = (0..16).map(|k| 10f64.powf(f64::from(k) / 4.0)).collect();
        let peak: Vec<f64> = coarse.iter().map(|x| x / 100.0 / (1.0 + (x / 100.0).powi(2))).collect();
        assert!(noise(&coarse, &peak) < 0.01, "{}", noise(&coarse, &peak));
        let sign = |k: usize| if (k * 7919) % 13 < 6 { 1.0 } else { -1.0 };
        let rough: Vec<f64> = smooth.iter().enumerate().map(|(k, v)| v * (1.0 + 0.01 * sign(k))).collect();
        assert!((5e-3..0.02).contains(&noise(&xs, &rough)), "{}", noise(&xs, &rough));
    }

    #[test]
    fn thinning_keeps_the_mean() {
        let xs: Vec<f64> = (1..50_000).map(f64::from).collect();
        let values: Vec<f64> = xs.iter().map(|x| 2.0 * x).collect();
        let bins = thin(&xs, &values);
        assert!(bins.len() < 470, "{}", bins.len());
        assert_eq!(bins.iter().map(|b| b.2).sum::<f64>(), 49_999.0);
        // Means of a straight line lie on it, up to the rounding of 600 updates.
        assert!(bins.iter().all(|(x, value, _)| (value / x - 2.0).abs() < 1e-12));
    }

    #[test]
    fn few_points_that_rise_are_refused_though_their_scatter_is_unknown() {
        let xs = [0.1, 1.0, 10.0, 100.0, 1000.0];
        let curve = |values| Curve::new(Kind::RELAXATION, &xs, values, false).unwrap();
        assert!(curve(&[3.0, 2.0, 1.5, 1.2, 1.1]).reversal(0.1).is_none());
        let rises = curve(&[3.0, 2.0, 1.5, 1.9, 1.1]);
        let error = rises.reversed(rises.reversal(0.1).unwrap());
        assert!(error.to_string().contains("point 4 (time 1e2 s)"), "{error}");
    }

    #[test]
    fn disorder_is_named_with_its_place() {
        let says = |xs: &[f64], words: &str| {
            let error = check_abscissae(Kind::RELAXATION, xs, true).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        };
        says(&[1.0], "number of points of the relaxation modulus is 1");
        says(&[], "number of points");
        says(&[1.0, 1.0], "time of point 2 is 1e0 s, but must be greater than the one before it");
        says(&[1.0, 3.0, 2.0], "time of point 3 is 2e0 s");
        says(&[0.0, 0.0], "time of point 2 is 0");
        says(&[-1.0, 0.0], "time of point 1 is -1");
        says(&[1.0, f64::NAN], "time of point 2 is NaN");
        says(&[1e-40, 1e40], "80 decades");
    }
}
