//! What the stated uncertainties of a test do to the material: the fit is repeated with each quantity slightly changed.
//!
//! ```text
//! variance of ln E = Σ (u d ln E/d ln x)²        x: radius or slope, thickness, scale of the load, scale of the deflection
//! ```
//!
//! The load of the free indenter, which is taken off the record, is such a quantity too, with the uncertainty that its rows give it.
//!
//! On a half-space d ln E/d ln R is -1/2 for a sphere and 1 for the slope of a cone; a layer has no such rule.

use super::free::Free;
use super::least_squares::{Solution, solve};
use super::model::Model;
use super::parameters::Law;
use super::{IndentationOptions, Interval, WIDTH};
use crate::error::{Result, non_negative, require};
use crate::material::Relaxation;
use crate::reference::MdrProfile;

/// A change for its effect on the result: large compared with where the search ends, and the effect is linear to its square.
const CHANGE: f64 = 1e-2;

/// The fit of a changed test: the numbers of its law, its relaxation function, and the depth of first touch.
pub(super) struct Fitted {
    pub(super) at: Vec<f64>,
    pub(super) relaxation: Relaxation,
    pub(super) touch: f64,
}

/// The fit with a quantity that many times as large.
type Refit<'a> = &'a dyn Fn(f64) -> Result<Fitted>;

/// A relative uncertainty, and the fits with more and less of its quantity.
struct Source {
    uncertainty: f64,
    sides: [Fitted; 2],
}

/// All stated uncertainties.
pub(super) struct Stated(Vec<Source>);

pub(super) fn check(options: &IndentationOptions) -> Result<()> {
    let sources = [
        ("radius", options.radius_uncertainty),
        ("thickness", options.thickness_uncertainty),
        ("load", options.load_uncertainty),
        (SENSITIVITY, options.sensitivity_uncertainty),
    ];
    check_shares(&sources, options.spring_constant)?;
    require(
        options.thickness_uncertainty == 0.0 || options.layer.is_some(),
        "relative uncertainty of the thickness",
        options.thickness_uncertainty,
        "0 without a thin sample",
    )
}

/// The name of the scale of the deflection, which needs a spring constant.
pub(crate) const SENSITIVITY: &str = "sensitivity";

/// Checks the relative uncertainties of these quantities of a test.
///
/// # Errors
/// [`Error::Invalid`](crate::Error::Invalid) that names the quantity.
pub(crate) fn check_shares(sources: &[(&str, f64)], spring_constant: Option<f64>) -> Result<()> {
    for (quantity, value) in sources {
        let what = format!("relative uncertainty of the {quantity}");
        non_negative(&what, *value, "")?;
        require(*value < 1.0, what.clone(), value, "less than 1")?;
        require(
            *quantity != SENSITIVITY || *value == 0.0 || spring_constant.is_some(),
            what,
            value,
            "0 without a spring constant: it changes the depth by the deflection",
        )?;
    }
    Ok(())
}

impl Stated {
    /// Fits again, from the best fit on.
    pub(super) fn new<L: Law>(
        model: &Model,
        best: &Solution<L>,
        options: &IndentationOptions,
        free: &Free,
    ) -> Result<Stated> {
        let profile = model.profile();
        let fit = |profile: MdrProfile, options: &IndentationOptions, columns: [Vec<f64>; 2]| {
            let changed = model.with(profile, options, columns)?;
            let found = solve(&changed, best.parameters, best.at.clone())?;
            let touch = found.touch() * changed.depth_scale();
            Ok(Fitted { relaxation: found.parameters.body(&found.at)?, touch, at: found.at })
        };
        let columns = || [model.loads.clone(), model.depths.clone()];
        let of_radius = |times: f64| fit(profile.scaled(times), options, columns());
        let of_thickness = |times: f64| {
            let mut changed = *options;
            changed.layer.iter_mut().for_each(|layer| layer.thickness *= times);
            fit(profile, &changed, columns())
        };
        let of_load = |times: f64| {
            let [loads, depths] = columns();
            fit(profile, options, [loads.iter().map(|load| times * load).collect(), depths])
        };
        let of_deflection = |times: f64| {
            let [loads, depths] = columns();
            let stiffness = options.spring_constant.unwrap_or(f64::INFINITY);
            let moved = depths.iter().zip(&loads).map(|(d, load)| d - (times - 1.0) * load / stiffness);
            fit(profile, options, [loads.iter().map(|load| times * load).collect(), moved.collect()])
        };
        // One standard deviation of the baseline for a change of 1 %.
        let of_baseline = |part: usize, times: f64| {
            let [loads, depths] = columns();
            let moved = loads.iter().zip(&depths).map(|(load, depth)| match *load == 0.0 {
                true => 0.0,
                false => load + (times - 1.0) / CHANGE * free.change(part, *depth),
            });
            fit(profile, options, [moved.collect(), depths.clone()])
        };
        let [of_offset, of_tilt] = [0, 1].map(|part| move |times: f64| of_baseline(part, times));
        let share = |part: usize| if free.deviations[part] > 0.0 { CHANGE } else { 0.0 };
        let sources: [(f64, Refit); 6] = [
            (share(0), &of_offset),
            (share(1), &of_tilt),
            (options.radius_uncertainty, &of_radius),
            (options.thickness_uncertainty, &of_thickness),
            (options.load_uncertainty, &of_load),
            (options.sensitivity_uncertainty, &of_deflection),
        ];
        let stated = sources.into_iter().filter(|(uncertainty, _)| *uncertainty > 0.0);
        let source = |(uncertainty, fit): (f64, Refit)| {
            Ok(Source { uncertainty, sides: [fit(1.0 + CHANGE)?, fit(1.0 - CHANGE)?] })
        };
        Ok(Stated(stated.map(source).collect::<Result<_>>()?))
    }

    /// Standard deviation of a number of the fit.
    fn deviation(&self, of: impl Fn(&Fitted) -> f64) -> f64 {
        let parts = self.0.iter().map(|source| {
            let [up, down] = source.sides.each_ref().map(&of);
            source.uncertainty * (up - down) / (2.0 * CHANGE)
        });
        parts.map(|part| part * part).sum::<f64>().sqrt()
    }

    /// The interval of a positive number with its part.
    pub(super) fn widen(&self, interval: Interval, of: impl Fn(&Fitted) -> f64) -> Interval {
        if self.0.is_empty() {
            return interval;
        }
        let Interval { value, low, high, .. } = interval;
        let half = WIDTH * self.deviation(|fitted| of(fitted).ln());
        let apart = |ratio: f64| ratio.ln().hypot(half).exp();
        Interval::new(value, [value / apart(value / low), value * apart(high / value)])
    }

    /// The equilibrium modulus, whose upper bound alone has a part where it is 0.
    pub(super) fn widen_equilibrium(&self, interval: Interval) -> Interval {
        match interval.value > 0.0 {
            true => self.widen(interval, |fitted| fitted.relaxation.equilibrium),
            false => {
                let half = WIDTH * self.deviation(|fitted| fitted.relaxation.instantaneous().ln());
                Interval { high: interval.high * half.exp(), ..interval }
            }
        }
    }

    /// The interval of a number of any sign with its part.
    pub(super) fn widen_both_ways(
        &self,
        Interval { value, low, high, determined }: Interval,
        of: impl Fn(&Fitted) -> f64,
    ) -> Interval {
        let half = WIDTH * self.deviation(of);
        Interval {
            value,
            low: value - (value - low).hypot(half),
            high: value + (high - value).hypot(half),
            determined,
        }
    }
}
