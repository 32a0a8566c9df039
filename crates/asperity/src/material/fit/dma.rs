//! Storage and loss modulus of a dynamic mechanical analysis.
//!
//! One relaxation spectrum gives both moduli (J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed., 1980, chapter 3).
//! Measured moduli often contradict each other, for example because a master curve was shifted by the storage modulus only, or
//! because one modulus contains the compliance of the instrument. Either modulus may therefore be fitted separately. Where the
//! storage modulus is that of a passive material, the fit of both runs between them, and its misfit states by how much they contradict each
//! other. Data that it misses by more than [`CONTRADICTION`] are refused, and the error states the misfit of each modulus fitted separately.

use super::{Fit, FitOptions, LongTime, Misfit, Moduli, relaxation, together};
use crate::error::{Error, Result};
use crate::material::Relaxation;
use crate::material::data::{Curve, Kind, check_abscissae};
use crate::material::spectrum::{Kernel, Problem, Spectrum};

/// Largest misfit of moduli that contradict each other, as a multiple of that of data that do not: 30 % by default. Measured pairs are
/// reported to contradict each other by 10 % to 25 %; more than that is no scatter, but another unit, column or temperature.
const CONTRADICTION: f64 = 3.0;

/// Fits storage and loss modulus E', E'' \[Pa\] at increasing angular frequencies \[rad/s\] (2 pi f) of a
/// dynamic mechanical analysis by one relaxation function: both, or the one that [`FitOptions::moduli`] names.
///
/// ```
/// use asperity::material::{FitOptions, Moduli, Relaxation, fit_dma};
/// let rubber = Relaxation::absolute(1e6, &[(5e8, 1e-4), (8e7, 1e-2), (3e6, 2.0)])?;
/// let omega: Vec<f64> = (0..40).map(|k| 10f64.powf(-2.0 + 0.2 * k as f64)).collect();
/// let (storage, mut loss): (Vec<_>, Vec<_>) = omega.iter().map(|w| rubber.complex(*w)).unzip();
/// let fit = fit_dma(&omega, &storage, &loss, &FitOptions::default())?;
/// assert!(fit.misfit.max < 1e-4);
/// assert!((fit.function.value(0.1) / rubber.value(0.1) - 1.0).abs() < 1e-4);
/// // A loss modulus that is 40 % too high belongs to no passive material with this storage modulus: the fit lies between them.
/// loss.iter_mut().for_each(|value| *value *= 1.4);
/// let fit = fit_dma(&omega, &storage, &loss, &FitOptions::default())?;
/// assert!(fit.columns.iter().all(|misfit| misfit.rms > 0.05 && misfit.rms < 0.3));
/// let options = FitOptions { moduli: Moduli::Storage, ..FitOptions::default() };
/// let fit = fit_dma(&omega, &storage, &loss, &options)?;
/// assert!(fit.columns[0].rms < 1e-4 && (fit.columns[1].rms - 0.4 / 1.4).abs() < 1e-3);
/// # Ok::<(), asperity::Error>(())
/// ```
///
/// # Errors
/// As [`fit_relaxation`](crate::material::fit_relaxation): frequencies out of order, negative moduli, a storage modulus that
/// falls with frequency, and pairs E', E'' that are far from those of every passive material (Kramers & Kronig).
pub fn fit_dma(
    omega: &[f64],
    storage: &[f64],
    loss: &[f64],
    options: &FitOptions,
) -> Result<Fit<Relaxation>> {
    options.validate()?;
    check_abscissae(Kind::STORAGE, omega, false)?;
    let stored = Curve::new(Kind::STORAGE, omega, storage, false)?;
    let lost = Curve::new(Kind::LOSS, omega, loss, true)?;
    // A loss below a thousandth of the stored energy is below the accuracy of instruments.
    let floor = 1e-3 * storage.iter().copied().fold(f64::INFINITY, f64::min);
    let curves = [stored, Curve { floor, weight: options.loss_weight, ..lost }];
    let window = [1.0 / omega[omega.len() - 1], 1.0 / omega[0]];
    let fit = match options {
        FitOptions { moduli: Moduli::Both, misfit: None, .. } => both(&curves, window, options),
        _ => solve(&curves, window, options),
    };
    fit?.map(relaxation)
}

/// Fits both moduli, also where they contradict each other but the storage modulus alone is that of a passive material.
fn both(curves: &[Curve; 2], window: [f64; 2], options: &FitOptions) -> Result<Fit<Spectrum>> {
    solve(curves, window, options).or_else(|refusal| {
        let wide = FitOptions { limit: CONTRADICTION * options.limit, ..*options };
        let storage = FitOptions { moduli: Moduli::Storage, ..*options };
        let through = solve(curves, window, &storage).and_then(|alone| {
            // Scatter of the storage modulus is judged by its own fit.
            solve(curves, window, &wide).map(|fit| Fit { reversal: alone.reversal, ..fit })
        });
        through.map_err(|_| alone(curves, window, options).unwrap_or(refusal))
    })
}

/// Fits the requested moduli, and computes the misfit of both.
fn solve(curves: &[Curve; 2], window: [f64; 2], options: &FitOptions) -> Result<Fit<Spectrum>> {
    let fitted = of(curves, options.moduli);
    let margin = 10f64.powf(options.margin);
    let problem = Problem {
        rows: fitted.iter().flat_map(Curve::rows).collect(),
        // The loss modulus does not determine the equilibrium modulus.
        constant: options.long_time != LongTime::Fluid && options.moduli != Moduli::Loss,
        flow: false,
        range: [window[0] / margin, window[1] * margin],
    };
    let mut fit = options.solve(&problem, fitted, window)?;
    if options.moduli == Moduli::Loss && options.long_time != LongTime::Fluid {
        fit.function.constant = equilibrium(&curves[0], &fit.function);
    }
    fit.columns = curves.iter().map(|curve| curve.misfit(&fit.function)).collect();
    Ok(fit)
}

fn of<'a, 'c>(curves: &'a [Curve<'c>; 2], moduli: Moduli) -> &'a [Curve<'c>] {
    match moduli {
        Moduli::Both => curves,
        Moduli::Storage => &curves[..1],
        Moduli::Loss => &curves[1..],
    }
}

/// The constant that brings the storage modulus of a spectrum closest to the measured one, relative residuals squared.
fn equilibrium(storage: &Curve<'_>, spectrum: &Spectrum) -> f64 {
    let (mut above, mut below) = (0.0, 0.0);
    for (x, value) in storage.xs.iter().zip(storage.values) {
        above += (value - spectrum.value(Kernel::Storage, *x)) / (value * value);
        below += 1.0 / (value * value);
    }
    (above / below).max(0.0)
}

/// The error that refuses both moduli together, with the misfit of each fitted separately; `None` if neither can be fitted, if
/// both are fitted together except at a few points, or if the storage modulus falls with frequency.
fn alone(curves: &[Curve; 2], window: [f64; 2], options: &FitOptions) -> Option<Error> {
    let any = FitOptions { limit: f64::MAX, ..*options };
    let both = solve(curves, window, &any).ok()?;
    // Both are fitted except at a few points: the error that names these points is more useful.
    if both.misfit.rms <= options.limit {
        return None;
    }
    let single = |moduli: Moduli| solve(curves, window, &FitOptions { moduli, ..*options }).ok();
    let falls = curves[0].reversal(options.limit).is_some();
    if falls && single(Moduli::Storage).is_none() {
        return None;
    }
    let shares = |misfit: &Misfit| format!("{:.1} %", 100.0 * misfit.rms);
    let reached: Vec<String> = [(Moduli::Storage, 0, "storage"), (Moduli::Loss, 1, "loss")]
        .into_iter()
        .filter_map(|(moduli, column, name)| {
            let fit = single(moduli)?;
            let other = shares(&fit.columns[1 - column]);
            let rest = if column == 0 { "loss" } else { "storage" };
            Some(format!(
                "the {name} modulus alone is fitted to {} (and then misses the {rest} modulus by {other})",
                shares(&together(of(curves, moduli), &[fit.columns[column]]))
            ))
        })
        .collect();
    if reached.is_empty() {
        return None;
    }
    let [storage, loss] = [0, 1].map(|column| shares(&both.columns[column]));
    Some(Error::invalid(
        "rms misfit of storage and loss modulus together",
        format!("{storage} and {loss}"),
        format!(
            "at most {:.0} % at any five neighbouring points; {}; they contradict each other, no passive material has both (Kramers-Kronig): fit one and look at \
             the other",
            100.0 * CONTRADICTION * options.limit,
            reached.join(", ")
        ),
    ))
}
