//! Prony series from measured curves: relaxation E(t), creep C(t), and E'(omega), E''(omega) of a DMA.
//!
//! A passive material has only non-negative weights (S. Bernstein's theorem: E(t) is completely monotone), so the fit is a
//! non-negative least squares on a logarithmic grid of times (3 per decade, one decade beyond the data), each row weighted by one
//! over its value. Terms that the data do not require are then merged or left out, and the remaining times are refined. If the
//! fit cannot describe the data, no passive material can: such data are refused, with the position.

use crate::error::{Error, Result, non_negative, positive, require, significant};
use crate::material::data::{self, Curve, Kind, Reversal};
use crate::material::refine;
use crate::material::spectrum::{Problem, Row, Spectrum};
use crate::material::{Creep, CreepTerm, Relaxation, RelaxationTerm};

/// Behaviour at times longer than the data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum LongTime {
    /// The choice that fits best.
    #[default]
    Free,
    /// A solid: no flow term in a creep function.
    Solid,
    /// A fluid: no equilibrium modulus in a relaxation function.
    Fluid,
}

/// The moduli of a DMA that are fitted. One spectrum gives both. Measured moduli often contradict each other (Kramers-Kronig);
/// then the usual practice is to fit the storage modulus and to check the loss modulus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Moduli {
    /// Storage and loss modulus together.
    #[default]
    Both,
    /// The storage modulus.
    Storage,
    /// The loss modulus; the equilibrium modulus comes from the storage modulus.
    Loss,
}

/// Options of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Times of the grid per decade, default 3, from 0.5 to 20.
    pub per_decade: f64,
    /// Decades of the grid beyond the data on either side, default 1, at most 5.
    pub margin: f64,
    /// Default: the choice that fits best.
    pub long_time: LongTime,
    /// Largest relative misfit before the data are refused, default 0.1. It applies to the rms over all points, and to the mean
    /// of neighbouring points if their scatter does not explain it.
    pub limit: f64,
    /// Largest number of terms, at least 1; by default the number that the data require.
    pub max_terms: usize,
    /// The fit uses as few terms as possible with an rms misfit below this value, greater than 0; by default the data determine
    /// the number of terms (Bayesian information criterion).
    pub misfit: Option<f64>,
    /// Which moduli of a DMA are fitted, default both.
    pub moduli: Moduli,
    /// Weight of a residual of the loss modulus over one of the storage modulus, default 1; used if both are fitted.
    pub loss_weight: f64,
}

impl Default for FitOptions {
    fn default() -> Self {
        FitOptions {
            per_decade: 3.0,
            margin: 1.0,
            long_time: LongTime::Free,
            limit: 0.1,
            max_terms: usize::MAX,
            misfit: None,
            moduli: Moduli::Both,
            loss_weight: 1.0,
        }
    }
}

/// Largest number of times in the grid: its cost grows with the cube.
const MOST_TIMES: f64 = 300.0;

/// A function fitted to data, and the quality of the fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit<F> {
    /// The Prony series; `function.terms.len()` is the number of terms.
    pub function: F,
    /// Misfit between the fitted data and the function.
    pub misfit: Misfit,
    /// The same for each column: one of relaxation and creep, storage and loss modulus of a DMA, fitted or not.
    pub columns: Vec<Misfit>,
    /// First and last time that the data cover \[s\]; for a DMA 1/omega.
    pub window: [f64; 2],
    /// Relative scatter of the data, from the distances of neighbours (standard deviation).
    pub noise: f64,
    /// Relative standard deviations of modulus (or compliance) and time of each term, in the order of the terms, estimated from
    /// the misfit. They are large if neighbouring terms can replace each other, even if the curve is known well. Infinite if the
    /// data do not determine a term.
    pub uncertainty: Vec<[f64; 2]>,
    /// The largest change of the data in a direction that no passive material has; the fit passes through such scatter, and its
    /// misfit contains it.
    pub reversal: Option<Reversal>,
}

/// Relative distance between data and fit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Misfit {
    /// Largest |fit/data - 1|.
    pub max: f64,
    /// Root of the mean square of fit/data - 1.
    pub rms: f64,
    /// Position of the largest misfit: time \[s\] or angular frequency \[rad/s\].
    pub worst: f64,
}

impl<F> Fit<F> {
    /// The same fit as a function of another form.
    fn map<G>(self, form: impl FnOnce(F) -> Result<G>) -> Result<Fit<G>> {
        let Fit { function, misfit, columns, window, noise, uncertainty, reversal } = self;
        Ok(Fit { function: form(function)?, misfit, columns, window, noise, uncertainty, reversal })
    }

    /// A sentence with the numbers if a run from `first` to `last` \[s\] leaves the fitted window.
    ///
    /// ```
    /// use asperity::material::{FitOptions, fit_relaxation};
    /// let fit = fit_relaxation(&[1.0, 10.0, 100.0], &[3e6, 2e6, 1e6], &FitOptions::default())?;
    /// assert_eq!(fit.beyond(1.0, 50.0), None);
    /// assert!(fit.beyond(0.1, 50.0).unwrap().contains("from 0.1 s to 50 s"));
    /// # Ok::<(), asperity::Error>(())
    /// ```
    pub fn beyond(&self, first: f64, last: f64) -> Option<String> {
        beyond(self.window, [first, last])
    }
}

/// A sentence with the numbers if a `run` between two times \[s\] leaves the `window` for which a material is known.
pub fn beyond(window: [f64; 2], run: [f64; 2]) -> Option<String> {
    // Rounding of 1/omega is not extrapolation.
    (run[0] < window[0] * (1.0 - 1e-9) || run[1] > window[1] * (1.0 + 1e-9)).then(|| {
        let covered = 100.0 * covered(run, window);
        let [first, last, start, end] =
            [run[0], run[1], window[0], window[1]].map(|time| significant(time, 4));
        format!(
            "the run needs the material from {first} s to {last} s, but it is known only from \
             {start} s to {end} s ({covered:.0} % of these decades); beyond them it is an extrapolation"
        )
    })
}

/// The fraction of the decades from `run[0]` to `run[1]` that is inside `data`.
fn covered(run: [f64; 2], data: [f64; 2]) -> f64 {
    let inside = (run[1].min(data[1]) / run[0].max(data[0])).ln().max(0.0);
    match (run[1] / run[0]).ln() {
        decades if decades > 0.0 => inside / decades,
        _ => 0.0,
    }
}

/// Fits E(t) \[Pa\] at increasing times \[s\] (0 may be the first) of a relaxation test.
///
/// ```
/// use asperity::material::{FitOptions, Relaxation, fit_relaxation};
/// let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)])?;
/// let times: Vec<f64> = (0..60).map(|k| 10f64.powf(-0.5 + 0.06 * k as f64)).collect();
/// let moduli: Vec<f64> = times.iter().map(|t| pmma.value(*t)).collect();
/// let fit = fit_relaxation(&times, &moduli, &FitOptions::default())?;
/// // Exact data give the material back.
/// assert!(fit.misfit.max < 1e-5 && fit.function.terms.len() == 2);
/// assert!((fit.function.terms[0].relaxation_time / 8.93 - 1.0).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// [`Error::Invalid`] naming the point: fewer than two points, times out of order or repeated, values that are not positive or
/// grow with time by more than their scatter and than a passive material that runs through them explains, or a misfit of every
/// passive material above `options.limit`.
pub fn fit_relaxation(times: &[f64], moduli: &[f64], options: &FitOptions) -> Result<Fit<Relaxation>> {
    options.validate()?;
    data::check_abscissae(Kind::RELAXATION, times, true)?;
    let curve = Curve::new(Kind::RELAXATION, times, moduli, false)?;
    let window = window(times);
    // A term much faster than the first time is invisible there, with a factor exp(-10), and would fit the noise of one point
    // with any size; half the first time is still visible (unless t = 0 is measured).
    let margin = 10f64.powf(options.margin);
    let fastest = if times[0] == 0.0 { margin } else { margin.min(2.0) };
    let problem = Problem {
        rows: curve.rows(),
        constant: options.long_time != LongTime::Fluid,
        flow: false,
        range: [window[0] / fastest, window[1] * margin],
    };
    options.solve(&problem, &[curve], window)?.map(relaxation)
}

/// Fits C(t) \[1/Pa\] at increasing times \[s\] of a creep test, for any compliance (uniaxial or shear). The first point may be
/// (0, 0): then there is no instantaneous compliance.
///
/// ```
/// use asperity::material::{FitOptions, Material, Modulus, fit_creep};
/// let burgers = Material::burgers(Modulus::Shear, 1e9, 500.0, 2e9, 3.0)?;
/// let times: Vec<f64> = (0..50).map(|k| 10f64.powf(-1.0 + 0.06 * k as f64)).collect();
/// let compliances: Vec<f64> = times.iter().map(|t| burgers.creep().value(*t)).collect();
/// let fit = fit_creep(&times, &compliances, &FitOptions::default())?;
/// assert!(fit.misfit.max < 1e-5);
/// assert!((fit.function.fluidity * 500e9 - 1.0).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// As [`fit_relaxation`], for a compliance that falls with time.
pub fn fit_creep(times: &[f64], compliances: &[f64], options: &FitOptions) -> Result<Fit<Creep>> {
    options.validate()?;
    data::check_abscissae(Kind::CREEP, times, true)?;
    let from_zero = times[0] == 0.0 && compliances.first() == Some(&0.0);
    let (kept, values) = if from_zero { (&times[1..], &compliances[1..]) } else { (times, compliances) };
    let curve = Curve::new(Kind::CREEP, kept, values, false)?;
    let (window, margin) = (window(times), 10f64.powf(options.margin));
    let problem = Problem {
        rows: curve.rows(),
        constant: !from_zero,
        flow: options.long_time != LongTime::Solid,
        range: [window[0] / margin, window[1] * margin],
    };
    options.solve(&problem, &[curve], window)?.map(creep)
}

impl FitOptions {
    fn validate(&self) -> Result<()> {
        require(
            (0.5..=20.0).contains(&self.per_decade),
            "times per decade of the fit",
            self.per_decade,
            "from 0.5 to 20",
        )?;
        non_negative("margin of the fit", self.margin, "decades")?;
        require(self.margin <= 5.0, "margin of the fit", self.margin, "at most 5 decades")?;

        require(self.max_terms > 0, "most terms of the fit", 0, "1 at least")?;
        if let Some(misfit) = self.misfit {
            positive("misfit to be held by the fit", misfit, "")?;
            require(
                misfit < 0.5,
                "misfit to be held by the fit",
                misfit,
                "a share below 0.5, such as 0.02 for 2 %",
            )?;
        }
        positive("weight of the loss modulus", self.loss_weight, "")?;
        positive("largest misfit of the fit", self.limit, "").map(|_| ())
    }

    /// Fits the curves and computes the misfit at every point of every curve.
    fn solve(&self, problem: &Problem, curves: &[Curve], window: [f64; 2]) -> Result<Fit<Spectrum>> {
        let count = (problem.range[1] / problem.range[0]).log10() * self.per_decade;
        require(
            count <= MOST_TIMES,
            "number of times of the fit",
            format!("{count:.0}"),
            format!("at most {MOST_TIMES}: fewer per decade, or data over fewer decades"),
        )?;
        let spectrum = match self.misfit {
            Some(misfit) => problem.fit_within(self.per_decade, misfit),
            None => problem.fit(self.per_decade, self.max_terms),
        };
        let columns: Vec<Misfit> = curves.iter().map(|curve| curve.misfit(&spectrum)).collect();
        let misfit = together(curves, &columns);
        if let Some(wanted) = self.misfit.filter(|wanted| misfit.rms > wanted * (1.0 + 1e-9)) {
            return Err(Error::invalid(
                "misfit to be held by the fit",
                format!("{:.3} %", 100.0 * wanted),
                format!(
                    "at least {:.3} %, which the best passive material reaches with {} times per decade",
                    100.0 * misfit.rms,
                    self.per_decade
                ),
            ));
        }
        let reversal = self.judge(curves, &spectrum, misfit);
        let reversal = reversal.map_err(|fault| self.too_few(problem, curves, &spectrum).unwrap_or(fault))?;
        let noise = curves.iter().map(Curve::noise).fold(0.0, f64::max);
        let uncertainty = refine::uncertainty(problem, &spectrum);
        Ok(Fit { function: spectrum, misfit, columns, window, noise, uncertainty, reversal })
    }

    /// The first reversal of the curves.
    ///
    /// # Errors
    /// Where the spectrum, with this misfit, is too far from the data.
    fn judge(&self, curves: &[Curve], spectrum: &Spectrum, misfit: Misfit) -> Result<Option<Reversal>> {
        let reversals = curves.iter().map(|curve| curve.reversal_about(spectrum, self.limit));
        let reversals: Vec<Option<Reversal>> = reversals.collect::<Result<_>>()?;
        for curve in curves {
            curve.check_misfit(&curve.residuals(spectrum), self.limit)?;
        }
        require(
            misfit.rms <= self.limit,
            "rms misfit of the fit",
            format!("{:.2} % ({:.2} % at {:.4e})", 100.0 * misfit.rms, 100.0 * misfit.max, misfit.worst),
            format!(
                "at most {:.2} % (the largest misfit allowed): fit a narrower window, allow more terms, leave \
                     outliers out, or allow a larger misfit where the data scatter as much",
                100.0 * self.limit
            ),
        )?;
        Ok(reversals.into_iter().flatten().next())
    }

    /// The error of a spectrum that is too far from the data only because it may have so few terms.
    fn too_few(&self, problem: &Problem, curves: &[Curve], spectrum: &Spectrum) -> Option<Error> {
        if self.misfit.is_some() || spectrum.terms.len() < self.max_terms {
            return None;
        }
        let misfit = |spectrum: &Spectrum| {
            together(curves, &curves.iter().map(|curve| curve.misfit(spectrum)).collect::<Vec<_>>())
        };
        let free = problem.fit(self.per_decade, usize::MAX);
        self.judge(curves, &free, misfit(&free)).ok()?;
        let [few, many] = [spectrum, &free].map(|spectrum| 100.0 * misfit(spectrum).rms);
        let terms = free.terms.len();
        Some(Error::invalid(
            "most terms of the fit",
            self.max_terms,
            format!("more: so few deviate from the data by {few:.1} % rms, and {terms} by {many:.1} %"),
        ))
    }
}

/// The misfit of several columns as one.
fn together(curves: &[Curve], columns: &[Misfit]) -> Misfit {
    let mut all = Misfit { max: 0.0, rms: 0.0, worst: 0.0 };
    let (mut squares, mut count) = (0.0, 0.0);
    for (curve, column) in curves.iter().zip(columns) {
        squares += curve.xs.len() as f64 * column.rms * column.rms;
        count += curve.xs.len() as f64;
        if column.max >= all.max {
            (all.max, all.worst) = (column.max, column.worst);
        }
    }
    all.rms = (squares / count).sqrt();
    all
}

/// Largest residual of a point where a curve reverses, as a multiple of the misfit that a fit may have (the range of scatter that is
/// usual for its rms): a point further away is wrong.
const FARTHEST: f64 = 3.0;

impl Curve<'_> {
    fn rows(&self) -> Vec<Row> {
        // The mean of n points has the weight of n points.
        let row = |(x, value, count): (f64, f64, f64)| Row {
            kernel: self.kind.kernel,
            x,
            value,
            weight: self.weight * count.sqrt() / value.max(self.floor),
            count,
        };
        data::thin(self.xs, self.values).into_iter().map(row).collect()
    }

    /// The largest change of the curve in the wrong direction.
    ///
    /// # Errors
    /// Where this is no scatter about the spectrum: a point is too far from it, or all of them are, or a few points do not show
    /// their scatter.
    fn reversal_about(&self, spectrum: &Spectrum, limit: f64) -> Result<Option<Reversal>> {
        let Some(found) = self.reversal(limit) else { return Ok(None) };
        let Misfit { rms, max, .. } = self.misfit(spectrum);
        match !self.is_short() && rms <= limit && max <= FARTHEST * limit {
            true => Ok(Some(found)),
            false => Err(self.reversed(found)),
        }
    }

    fn misfit(&self, spectrum: &Spectrum) -> Misfit {
        let mut misfit = Misfit { max: 0.0, rms: 0.0, worst: 0.0 };
        let residuals = self.residuals(spectrum);
        for (r, x) in residuals.iter().zip(self.xs) {
            misfit.rms += r * r / residuals.len() as f64;
            if r.abs() > misfit.max {
                (misfit.max, misfit.worst) = (r.abs(), *x);
            }
        }
        Misfit { rms: misfit.rms.sqrt(), ..misfit }
    }

    /// Relative residuals (fit - value) at all points.
    fn residuals(&self, spectrum: &Spectrum) -> Vec<f64> {
        let residual =
            |(x, value): (&f64, &f64)| (spectrum.value(self.kind.kernel, *x) - value) / value.max(self.floor);
        self.xs.iter().zip(self.values).map(residual).collect()
    }
}

/// First positive and last time.
fn window(times: &[f64]) -> [f64; 2] {
    [if times[0] > 0.0 { times[0] } else { times[1] }, times[times.len() - 1]]
}

pub(super) fn relaxation(spectrum: Spectrum) -> Result<Relaxation> {
    let terms = spectrum.terms.iter();
    let relaxation = Relaxation {
        equilibrium: spectrum.constant,
        terms: terms.map(|&(relaxation_time, modulus)| RelaxationTerm { modulus, relaxation_time }).collect(),
        viscosity: 0.0,
    };
    relaxation.validate()?;
    Ok(relaxation)
}

fn creep(spectrum: Spectrum) -> Result<Creep> {
    let terms = spectrum.terms.iter();
    let creep = Creep {
        instantaneous: spectrum.constant,
        terms: terms
            .map(|&(retardation_time, compliance)| CreepTerm { compliance, retardation_time })
            .collect(),
        fluidity: spectrum.flow,
    };
    creep.validate()?;
    Ok(creep)
}

mod dma;
#[cfg(test)]
mod tests;

pub use dma::fit_dma;
