//! Force curves: modulus and work of adhesion from load and depth of an indenter that touches an elastic body and is pulled off.
//!
//! The model is one curve of load over depth, without adhesion that of [`crate::reference::MdrProfile`] (ball, paraboloid, cone or pyramid), with
//! it that of [`crate::reference::AdhesiveSphere`], shifted by the load of the free sphere (baseline) and the
//! depth of first touch. Both channels have noise, and near pull-off the curve is steep. A row therefore counts with its distance
//! from the nearest point of the stable branch, in units of the noise of both channels:
//!
//! ```text
//! minimise  Σ_contact min_u [(W - F0 - W(u))²/σ_W² + (d - d0 - d(u))²/σ_d²] + Σ_free (W - F0)²/σ_W²
//! unknown:  ln E*, ln w, ln λ (Maugis), d0, F0
//! ```
//!
//! Of more than a thousand rows the fit takes means of neighbours, with their smaller noise.
//!
//! **Intervals.** 95 %. The scatter of the rows gives the covariance of the logarithms, wider where neighbouring residuals are alike.
//! Stated uncertainties are added in squares. They follow from scaling: the same curve belongs to E* ∝ R^(-1/2), w ∝ 1/R (of a deep ball and of
//! cones E* follows the load at the largest depth), and to E*, w ∝ the unit of load; λ and the range of the attraction depend on neither. An error of the deflection's scale
//! changes load and depth together, so the fit is repeated with it. Records seldom determine λ well, and then the sum of squares is far
//! from quadratic in it: its interval is that of the profile likelihood, and those of the other numbers are of all λ inside.

mod body;
mod notes;
mod rows;
mod search;
#[cfg(test)]
mod tests;

use crate::error::{Error, Result, positive, require};
use crate::indentation::{Interval, Line, SENSITIVITY, SampleLayer, WIDTH, check_shares};
use crate::numbers::extent;
use crate::reference::{AdhesiveModel, AdhesiveSphere, MdrProfile, carpick_alpha, maugis_lambda, tabor};
use rows::Rows;
use search::{Found, Problem};

/// Load and depth in the order of the measurement; two columns of one length.
#[derive(Clone, Copy, Debug)]
pub struct ForceRecord<'a> {
    /// Loads \[N\]; pressing is positive.
    pub loads: &'a [f64],
    /// Depths \[m\]; deeper is larger. Their zero is fitted.
    pub depths: &'a [f64],
}

/// What describes the contact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum ForceModel {
    /// No adhesion.
    #[default]
    Hertz,
    /// Small stiff spheres, attraction of long range.
    Dmt,
    /// Large soft spheres, attraction of short range.
    Jkr,
    /// Between the two, with one more unknown.
    Maugis,
}

/// The part of the record that is fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Branch {
    /// From the largest load to the end.
    #[default]
    Retraction,
    /// From the start to the largest load.
    Approach,
}

/// What the test controlled, which decides where the sphere comes off.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum PullOffControl {
    /// The load: pull-off is at the smallest load.
    Load,
    /// The displacement: pull-off is at the smallest depth.
    Displacement,
}

/// How rows count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Weights {
    /// By the noise of both channels, and by the scatter in contact and off it.
    #[default]
    Noise,
    /// All alike, without adhesion by their loads alone: plain least squares, as other programs do it.
    None,
}

/// Options of the fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ForceOptions {
    /// The model, default Hertz.
    pub model: ForceModel,
    /// The part that is fitted, default the retraction.
    pub branch: Branch,
    /// What the test controlled; default: the height of the cantilever where its spring constant is given, else the displacement.
    pub control: Option<PullOffControl>,
    /// How rows count, default by their noise.
    pub weights: Weights,
    /// Range of the attraction w/s0 \[m\]. Maugis' λ then follows from E* and w; by default it is fitted.
    pub range: Option<f64>,
    /// Standard uncertainty of the radius over the radius, or of the slope of a cone or pyramid over the slope; default 0.
    pub radius_uncertainty: f64,
    /// The thin sample of a fit without adhesion, if it is not as deep as a half-space.
    pub layer: Option<SampleLayer>,
    /// Standard uncertainty of the thickness of a thin sample over the thickness, default 0.
    pub thickness_uncertainty: f64,
    /// Spring constant of the cantilever whose deflection is the load \[N/m\].
    pub spring_constant: Option<f64>,
    /// Standard uncertainty of the scale of the load, that is of the spring constant, over its value, default 0.
    pub load_uncertainty: f64,
    /// Standard uncertainty of the scale of the deflection over its value, default 0; needs the spring constant.
    pub sensitivity_uncertainty: f64,
}

/// The result of a fit.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceFit {
    /// The model.
    pub model: ForceModel,
    /// Contact modulus E* \[Pa\].
    pub contact_modulus: Interval,
    /// Work of adhesion w \[J/m²\]; 0 for Hertz.
    pub work: Interval,
    /// Maugis' λ.
    pub lambda: Option<Interval>,
    /// Range of the attraction w/s0 \[m\] that λ stands for; `None` for the other models.
    pub range: Option<Interval>,
    /// The transition parameter of Carpick, Ogletree & Salmeron, 0 for DMT and 1 for JKR; of Maugis' model.
    pub alpha: Option<f64>,
    /// Depth of first touch \[m\], in the zero of the record.
    pub touch: Interval,
    /// Load of the free sphere at first touch \[N\], and its slope over the depth \[N/m\]; 0 where the record does not show it.
    pub baseline: Interval,
    /// See `baseline`.
    pub tilt: Interval,
    /// Load at pull-off of the model under the control of the test \[N\], without the baseline.
    pub pull_off_force: f64,
    /// Smallest load of the fitted rows \[N\], without the baseline.
    pub smallest_load: f64,
    /// Tabor's number of the fit: from λ, or from the range, 0.3 nm where none is given.
    pub tabor: f64,
    /// Largest radius of the contact \[m\].
    pub contact_radius: f64,
    /// Number of rows in contact and of free ones.
    pub used: [usize; 2],
    /// Numbers of the rows that were fitted, and the load of the nearest point of the curve at each \[N\], the baseline included.
    pub rows: Vec<usize>,
    /// See `rows`.
    pub predicted: Vec<f64>,
    /// Root mean square of the distance from the curve, each channel over its range.
    pub relative_rms: f64,
    /// Near 2 for independent errors, as in [`crate::indentation::IndentationFit`].
    pub durbin_watson: f64,
    /// Notes for the user, in sentences.
    pub notes: Vec<String>,
}

/// Range of the attraction between solids where none is given \[m\].
const ATOMIC: f64 = 0.3e-9;
/// A change of the deflection's scale for its effect on the result.
const CHANGE: f64 = 1e-3;
/// Part of the depths in contact by which first touch may lie before the first row.
const BEFORE: f64 = 0.1;
/// Largest relative distance from the curve.
const MISFIT: f64 = 0.1;

/// Fits a force curve. Without adhesion the indenter is any; with it, it is a sphere, which the models take as a paraboloid.
///
/// ```
/// use asperity::force_curve::{ForceModel, ForceOptions, ForceRecord, fit_force_curve};
/// use asperity::reference::{AdhesiveModel, AdhesiveSphere, MdrProfile};
/// // A sphere of 10 um on 1 MPa (E*) with 50 mJ/m², pulled off from 1.2 um on.
/// let truth = AdhesiveSphere::new(AdhesiveModel::Jkr, 10e-6, 1e6, 0.05)?;
/// let depths: Vec<f64> = (0..300).map(|k| 1.2e-6 - 6e-9 * f64::from(k)).collect();
/// let mut loads = vec![];
/// for depth in &depths {
///     loads.push(truth.at_approach(*depth)?.map_or(0.0, |point| point.load));
/// }
/// let options = ForceOptions { model: ForceModel::Jkr, ..ForceOptions::default() };
/// let sphere = MdrProfile::Sphere { radius: 10e-6 };
/// let fit = fit_force_curve(sphere, &ForceRecord { loads: &loads, depths: &depths }, &options)?;
/// assert!((fit.contact_modulus.value / 1e6 - 1.0).abs() < 1e-3 && (fit.work.value / 0.05 - 1.0).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] if the columns differ in length or have fewer than 20 rows on the chosen branch, a number is not finite, the record shows no
/// contact or, for a model with adhesion, no attraction or the indenter is no sphere, or no curve of the model comes near it.
pub fn fit_force_curve(
    profile: MdrProfile,
    record: &ForceRecord,
    options: &ForceOptions,
) -> Result<ForceFit> {
    check(profile, options)?;
    let radius = profile.radius().unwrap_or(1.0);
    let (rows, body) = Rows::new(profile, record, options)?;
    let rows = rows.alike(options);
    let mut fitted = rows.averaged();
    let mut found = Problem::new(&body, &fitted, options).solve()?;
    for _ in 0..options.weights.rounds() {
        fitted = fitted.weighted(found.scatter);
        found = Problem::new(&body, &fitted, options).solve_from(&found.at)?;
    }
    let problem = Problem::new(&body, &fitted, options);
    let whole = Problem::new(&body, &rows, options);
    let misfit = whole.misfit(&found.at);
    // Noise is no misfit.
    let noise = (rows.noise[0] / rows.spans[0]).hypot(rows.noise[1] / rows.spans[1]);
    require(
        misfit <= MISFIT.max(2.0 * noise),
        "misfit of the force curve",
        format!("{:.1} % of its range (rms)", 100.0 * misfit),
        format!(
            "at most {:.0} %: check indenter, units, the signs of load and depth, and the model",
            100.0 * MISFIT
        ),
    )?;
    require_touch(problem.shifts(&found.at).touch, &rows, options)?;
    // Of ln E* and ln w, one for an error of the deflection's scale.
    let by_deflection = match (options.spring_constant, options.sensitivity_uncertainty > 0.0) {
        (Some(stiffness), true) => {
            let changed = fitted.with_deflection(CHANGE, stiffness);
            let moved = Problem::new(&body, &changed, options).solve_from(&found.at)?;
            [0, 1].map(|k| (moved.logarithms()[k] - found.logarithms()[k]) / CHANGE)
        }
        _ => [0.0; 2],
    };
    let stated = |by_radius: f64, by_load: f64, by_deflection: f64| {
        let parts = [
            by_radius * options.radius_uncertainty,
            by_load * options.load_uncertainty,
            by_deflection * options.sensitivity_uncertainty,
        ];
        parts.iter().map(|part| part * part).sum::<f64>()
    };
    let [modulus, work] = found.logarithms().map(f64::exp);
    let adhesive = options.model != ForceModel::Hertz;
    // Where λ is fitted, the interval of a number is that of all λ within its own.
    let (family, closed) = match problem.free_lambda() {
        true => {
            let (family, closed) = problem.profile(&found)?;
            (Some(family), closed)
        }
        false => (None, [true; 2]),
    };
    let members: Vec<&Found> = family.as_ref().map_or(vec![&found], |family| family.iter().collect());
    let interval = |value: f64, direction: &[f64], stated: f64| {
        let ends = members.iter().map(|found| {
            let middle: f64 = direction.iter().zip(&found.at).map(|(x, at)| x * at).sum();
            let half = WIDTH * (found.variance(&direction[..direction.len().min(2)]) + stated).sqrt();
            [middle - half, middle + half]
        });
        let [low, high] =
            ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)]);
        // Relative to the sum at the best fit, whose value is given.
        let own: f64 = direction.iter().zip(&found.at).map(|(x, at)| x * at).sum();
        logarithmic(value, [low - own, high - own])
    };
    // Of ln E* for one of the size of the indenter; with adhesion by scaling.
    let shifts = problem.shifts(&found.at);
    let deepest = rows.depths[1] - shifts.touch;
    let [by_size, by_thickness] = match adhesive {
        true => [-0.5, 0.0],
        false => body::exponents(profile, options.layer, deepest)?,
    };
    let of_thickness = (by_thickness * options.thickness_uncertainty).powi(2);
    let contact_modulus = interval(modulus, &[1.0], stated(by_size, 1.0, by_deflection[0]) + of_thickness);
    let work = match adhesive {
        true => interval(work, &[0.0, 1.0], stated(1.0, 1.0, by_deflection[1])),
        false => Interval::exact(0.0),
    };
    let model = problem.model(&found.at);
    let (mut lambda, mut range, mut alpha) = (None, None, None);
    if let Some(AdhesiveModel::Maugis { lambda: value }) = model {
        // λ ∝ (w/E*)^(2/3)/range, and neither λ nor the range depends on the scales of radius and load.
        let of = maugis_lambda(radius, modulus, work.value, 1.0) / value;
        let open = |x: Interval, [below, above]: [bool; 2]| {
            let (low, high) = (if below { x.low } else { 0.0 }, if above { x.high } else { f64::INFINITY });
            Interval::new(x.value, [low, high])
        };
        (lambda, range) = match &family {
            Some([_, low, high]) => {
                let ends = [low, high].map(|found| found.at[2].exp());
                let [below, above] = closed;
                let across = interval(of, &[-2.0 / 3.0, 2.0 / 3.0, -1.0], 0.0);
                (Some(open(Interval::new(value, ends), closed)), Some(open(across, [above, below])))
            }
            None => (Some(interval(value, &[-2.0 / 3.0, 2.0 / 3.0], 0.0)), Some(Interval::exact(of))),
        };
        alpha = Some(carpick_alpha(value));
    }
    let linear = |value: f64, deviation: f64| {
        let half = WIDTH * deviation;
        Interval { value, low: value - half, high: value + half, determined: half.is_finite() }
    };
    let [of_touch, of_baseline, of_tilt] = problem.shift_deviations(&found);
    let line = Line { load: shifts.load - shifts.slope * shifts.touch, slope: shifts.slope };
    let sphere = model.map(|model| AdhesiveSphere::of(model, radius, modulus, problem.work(&found.at)));
    let nearest = whole.nearest(&found.at);
    let smallest_load = rows.pressed(line).fold(f64::INFINITY, f64::min);
    let mut fit = ForceFit {
        model: options.model,
        contact_modulus,
        work,
        lambda,
        range,
        alpha,
        touch: linear(shifts.touch, of_touch),
        baseline: linear(shifts.load, of_baseline),
        tilt: linear(shifts.slope, of_tilt),
        pull_off_force: sphere.map_or(0.0, |sphere| sphere.pull_off(options.stiffness()).load),
        smallest_load,
        tabor: match model {
            Some(AdhesiveModel::Maugis { lambda }) => lambda / maugis_lambda(1.0, 1.0, 1.0, 1.0),
            Some(_) => tabor(radius, modulus, work.value, options.range.unwrap_or(ATOMIC)),
            None => 0.0,
        },
        contact_radius: nearest.contact_radius,
        used: [rows.contact.len(), rows.free.len()],
        rows: rows.numbers(),
        predicted: nearest.loads,
        relative_rms: misfit,
        durbin_watson: found.durbin_watson,
        notes: vec![],
    };
    fit.notes = notes::notes(&fit, profile, deepest, &rows, line, options);
    Ok(fit)
}

impl Weights {
    /// How often rows are weighted by their scatter about the curve.
    fn rounds(self) -> usize {
        match self {
            Weights::Noise => 2,
            Weights::None => 0,
        }
    }
}

impl ForceOptions {
    /// Of the spring that pulls \[N/m\].
    fn stiffness(&self) -> f64 {
        match (self.control, self.spring_constant) {
            (Some(PullOffControl::Load), _) => 0.0,
            (Some(PullOffControl::Displacement), _) | (None, None) => f64::INFINITY,
            (None, Some(stiffness)) => stiffness,
        }
    }
}

/// Refuses a first touch that the record does not show.
fn require_touch(touch: f64, rows: &Rows, options: &ForceOptions) -> Result<()> {
    let [smallest, largest] = extent(rows.contact.iter().chain(&rows.free).map(|row| row[1]));
    // A branch with attraction holds first touch.
    let slack = BEFORE * (rows.depths[1] - rows.depths[0]);
    require(
        options.model != ForceModel::Hertz || (smallest - slack..largest).contains(&touch),
        "depth of first touch",
        format!("{touch:.3e} m, outside of the record ({smallest:.3e} m to {largest:.3e} m)"),
        "inside: the load of the free sphere is not known; keep the rows before contact, or subtract their load and start the record at first \
         touch",
    )
}

fn check(profile: MdrProfile, options: &ForceOptions) -> Result<()> {
    profile.validate()?;
    require(
        options.model == ForceModel::Hertz || profile.radius().is_some(),
        "indenter of a model with adhesion",
        "a cone or a pyramid",
        "a sphere; without adhesion use the model `hertz`",
    )?;
    require(
        options.model == ForceModel::Hertz || options.layer.is_none(),
        "sample of a model with adhesion",
        "a thin one",
        "a half-space: there is no closed form of adhesion on a thin sample; without adhesion use the model `hertz`",
    )?;
    for (what, value, unit) in
        [("range", options.range, "m"), ("spring constant", options.spring_constant, "N/m")]
    {
        if let Some(value) = value {
            positive(what, value, unit)?;
        }
    }
    let sources = [
        ("radius", options.radius_uncertainty),
        ("thickness", options.thickness_uncertainty),
        ("load", options.load_uncertainty),
        (SENSITIVITY, options.sensitivity_uncertainty),
    ];
    check_shares(&sources, options.spring_constant)
}

/// From the ends of the logarithm less that of the value.
fn logarithmic(value: f64, ends: [f64; 2]) -> Interval {
    let [low, high] = ends.map(f64::exp);
    Interval::new(value, [value * low, if high.is_finite() { value * high } else { f64::INFINITY }])
}

fn invalid<T>(what: &str, value: impl std::fmt::Display, expected: impl Into<String>) -> Result<T> {
    Err(Error::invalid(what, value, expected))
}

/// Refuses a depth that does not grow with the load.
fn turned<T>() -> Result<T> {
    invalid(
        "depth of the force curve",
        "not larger where the load is larger",
        "larger where the sphere is pressed deeper: depth = height less deflection; turn the sign of the column",
    )
}
