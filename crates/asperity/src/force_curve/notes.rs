//! Notes that the user should know before relying on a fit.

use super::rows::Rows;
use super::{ATOMIC, Branch, ForceFit, ForceModel, ForceOptions};
use crate::indentation::{ALIKE, Baseline, Line, of_indenter, unlikely_radius};
use crate::reference::MdrProfile;

/// Noise of the depth over its range beyond which the rows are no longer near their points of the curve.
const NOISY: f64 = 0.02;

/// Tabor numbers at which JKR begins to hold and DMT ceases to.
const SOFT: f64 = 3.0;
const STIFF: f64 = 0.3;
/// A bend of the baseline below this fraction of the loads is not told.
const BENT: f64 = 0.01;
/// Smallest number of rows with attraction.
const FEW: usize = 10;
/// Radius of the contact over that of the sphere beyond which the paraboloid is another body: its load is 4 % off.
const WIDE: f64 = 0.3;
/// Relative distance of measured and modelled pull-off force that is told.
const PULL: f64 = 0.1;
/// Spring constant over contact stiffness: outside, one of deflection and depth is a small difference or below its noise.
const CANTILEVER: [f64; 2] = [0.01, 100.0];

/// `deepest`: the largest depth from first touch \[m\].
pub(super) fn notes(
    fit: &ForceFit,
    profile: MdrProfile,
    deepest: f64,
    rows: &Rows,
    line: Line,
    options: &ForceOptions,
) -> Vec<String> {
    let mut notes = vec![];
    let adhesive = fit.model != ForceModel::Hertz;
    let numbers = [("the modulus", &fit.contact_modulus), ("the work of adhesion", &fit.work)];
    notes.extend(numbers.into_iter().filter(|(_, interval)| !interval.determined).map(|(what, _)| {
        format!("{what} is not determined by this record: its 95 % interval spans more than a factor of 10")
    }));
    if fit.lambda.is_some_and(|lambda| !lambda.determined) {
        notes.push(format!(
            "the transition parameter lambda is not determined by this record (alpha {:.2}, 0 for DMT and 1 for JKR): give the range of \
             the attraction, or use the model `{}`",
            fit.alpha.unwrap_or_default(),
            if fit.alpha > Some(0.5) { "jkr" } else { "dmt" }
        ));
    }
    let range = match options.range {
        Some(range) => format!("the given range of {range:.2e} m"),
        None => format!("a range of {:.1} nm, usual between solids; give yours", 1e9 * ATOMIC),
    };
    let (rule, or) = match fit.model {
        ForceModel::Jkr if fit.tabor < STIFF => (format!("JKR holds above {SOFT}"), " or `dmt`"),
        ForceModel::Jkr if fit.tabor < SOFT => (format!("JKR holds above {SOFT}"), ""),
        ForceModel::Dmt if fit.tabor > SOFT => (format!("DMT holds below {STIFF}"), " or `jkr`"),
        ForceModel::Dmt if fit.tabor > STIFF => (format!("DMT holds below {STIFF}"), ""),
        _ => (String::new(), ""),
    };
    if !rule.is_empty() {
        let tabor = fit.tabor;
        notes.push(format!(
            "Tabor's number is {tabor:.2e} with {range}, and {rule}: use the model `maugis`{or}"
        ));
    }
    notes.extend(of_baseline(rows));
    if rows.paused > 0 {
        notes.push(format!(
            "{} rows of a pause under load are left out: an elastic body does not relax; fit approach and pause by the model `viscoelastic` or \
             `power-law`",
            rows.paused
        ));
    }
    let share = rows.noise[1] / rows.spans[1];
    if share > NOISY {
        notes.push(format!(
            "the noise of the depth is {:.1} % of its range: the fit makes the body up to as many per cent too stiff, and the intervals are too \
             narrow; average more rows, or press deeper",
            100.0 * share
        ));
    }
    let attracted = rows.pressed(line).filter(|load| *load < -rows.noise[0]).count();
    if adhesive && attracted < FEW {
        notes.push(format!(
            "{attracted} rows show attraction, and the work of adhesion rests on them: record at least {FEW}, with more points per second \
             or a slower retraction"
        ));
    }
    // A load at which the sphere came off, other than that of the model. Where rows are far apart the last one lies before pull-off.
    if adhesive && rows.baseline != Baseline::Unknown && options.branch == Branch::Retraction {
        let measured = rows.pressed(line).last().unwrap_or(fit.smallest_load);
        let far = |load: f64| {
            (load - fit.pull_off_force).abs() > PULL * fit.pull_off_force.abs() + 5.0 * rows.noise[0]
        };
        if far(measured) && far(fit.smallest_load) {
            notes.push(format!(
                "the sphere came off at {measured:.3e} N, and the model under this control comes off at {:.3e} N: the control is another \
                 one, or the material relaxes",
                fit.pull_off_force
            ));
        }
    }
    match profile.radius() {
        Some(radius) if adhesive => {
            notes.extend(unlikely_radius(radius));
            if fit.contact_radius > WIDE * radius {
                notes.push(format!(
                    "the contact is {:.2} times as wide as the sphere: the model takes the sphere as a paraboloid, good below {WIDE}, whose load \
                     without adhesion is {:.1} % larger at this depth",
                    fit.contact_radius / radius,
                    100.0 * profile.paraboloid_excess(deepest.max(0.0)).unwrap_or_default()
                ));
            }
        }
        _ => notes.extend(of_indenter(profile, deepest, fit.relative_rms, options.layer.is_some())),
    }
    if fit.durbin_watson < ALIKE {
        notes.push(format!(
            "the residuals follow each other (Durbin-Watson number {:.2}, near 2 where they are independent): the model bends away from the \
             record (relaxation, plastic flow, drift of the baseline, a substrate) or the noise is not white; the intervals are wider for it, \
             but a systematic error is not in them",
            fit.durbin_watson
        ));
    }
    if let Some(spring) = options.spring_constant {
        // dW/dd = 2 E* a
        let ratio = spring / (2.0 * fit.contact_modulus.value * fit.contact_radius);
        if ratio < CANTILEVER[0] {
            notes.push(format!(
                "the cantilever is {:.0} times as soft as the contact at the largest load: the depth is a small difference of height and \
                 deflection, and an error of 1 % of the sensitivity changes it by more than itself; use a stiffer cantilever",
                1.0 / ratio
            ));
        } else if ratio > CANTILEVER[1] {
            notes.push(format!(
                "the cantilever is {ratio:.0} times as stiff as the contact at the largest load: its deflection is a small part of the height; use \
                 a softer cantilever"
            ));
        }
    }
    notes
}

/// What is not known about the load of the free sphere.
fn of_baseline(rows: &Rows) -> Option<String> {
    match rows.baseline {
        Baseline::Unknown => Some(
            "the load of the free sphere is taken as 0: the fitted part of the record does not show the free sphere, so its load is not fitted"
                .to_owned(),
        ),
        Baseline::Flat => Some(
            "the load of the free sphere is taken as the same at all depths: the record shows it too shortly for a slope; a tilt of it would change \
             the modulus and is not in the intervals"
                .to_owned(),
        ),
        Baseline::Tilted if rows.bend > BENT * rows.spans[0] => Some(format!(
            "the load of the free sphere bends away from a straight line by {:.3e} N: the same bend under the contact changes the modulus \
             and the work of adhesion and is not in the intervals; leave out the rows far from the body",
            rows.bend
        )),
        Baseline::Tilted => None,
    }
}
