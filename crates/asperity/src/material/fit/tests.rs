//! Fits of synthetic data: the fit recovers the curve, and non-physical data are refused.

use super::*;
use crate::material::series::tests::random;

fn logspace(first: f64, last: f64, count: usize) -> Vec<f64> {
    let step = (last / first).log10() / (count - 1) as f64;
    (0..count).map(|k| first * 10f64.powf(step * k as f64)).collect()
}

/// Normal deviates by Box & Muller.
fn normal(seed: u64) -> impl FnMut() -> f64 {
    let mut random = random(seed);
    move || (-2.0 * (1.0 - random()).ln()).sqrt() * (std::f64::consts::TAU * random()).cos()
}

/// 13 terms, one per decade, with uneven weights.
fn thirteen() -> Relaxation {
    let weights = [3.0, 8.0, 20.0, 60.0, 90.0, 40.0, 25.0, 10.0, 6.0, 3.0, 1.5, 0.8, 0.3];
    let terms: Vec<_> =
        weights.iter().enumerate().map(|(k, w)| (1e6 * w, 2.3 * 10f64.powi(k as i32 - 7))).collect();
    Relaxation::absolute(0.5e6, &terms).unwrap()
}

#[test]
fn thirteen_noisy_terms_are_recovered_to_the_noise() {
    let (truth, mut normal) = (thirteen(), normal(11));
    let times = logspace(1e-7, 1e6, 400);
    let moduli: Vec<f64> = times.iter().map(|t| truth.value(*t) * (1.0 + 0.02 * normal())).collect();
    let fit = fit_relaxation(&times, &moduli, &FitOptions::default()).unwrap();
    // The scatter of the scatter of 400 points: 1/sqrt(800), and twice that of a median.
    assert!((fit.noise / 0.02 - 1.0).abs() < 0.2, "{}", fit.noise);
    // The remainder is the noise, minus the part that 26 parameters absorb.
    assert!((fit.misfit.rms / 0.02 - 1.0).abs() < 0.1, "{:?}", fit.misfit);
    // About 14 points per parameter pair: the curve is known to 0.02 sqrt(26/400), 3 sigma of it.
    let error = times.iter().map(|t| (fit.function.value(*t) / truth.value(*t) - 1.0).abs());
    let error = error.fold(0.0, f64::max);
    assert!(error < 0.015, "{error}");
    assert!(fit.function.terms.len() <= 14, "{}", fit.function.terms.len());
}

#[test]
fn exact_data_give_the_material_back() {
    let (truth, options) = (thirteen(), FitOptions::default());
    let times = logspace(1e-7, 1e6, 200);
    let moduli: Vec<f64> = times.iter().map(|t| truth.value(*t)).collect();
    let compliances: Vec<f64> = times.iter().map(|t| truth.to_creep().unwrap().value(*t)).collect();
    let omega = logspace(1e-6, 1e7, 200);
    let (storage, loss): (Vec<_>, Vec<_>) = omega.iter().map(|w| truth.complex(*w)).unzip();
    let fits = [
        fit_relaxation(&times, &moduli, &options).unwrap().function,
        fit_creep(&times, &compliances, &options).unwrap().function.to_relaxation().unwrap(),
        fit_dma(&omega, &storage, &loss, &options).unwrap().function,
    ];
    for fit in fits {
        assert_eq!(fit.terms.len(), 13);
        for (fitted, term) in fit.terms.iter().zip(&truth.terms) {
            // Levenberg-Marquardt stops at residuals of 1e-7 at most; terms a decade apart are
            // known some hundred times less well than the curve.
            assert!((fitted.modulus / term.modulus - 1.0).abs() < 1e-4, "{fitted:?} {term:?}");
            assert!((fitted.relaxation_time / term.relaxation_time - 1.0).abs() < 1e-4, "{fitted:?}");
        }
    }
}

#[test]
fn storage_and_loss_of_a_fit_obey_kramers_and_kronig() {
    // E'(w) - E'(0) = (2/pi) w^2 P int_0^inf [E''(u)/u] / (w^2 - u^2) du, with noisy data in and the
    // fit's E'' integrated; u = w exp(y), the pole taken out by symmetry in y.
    let (truth, mut normal) = (thirteen(), normal(2));
    let omega = logspace(1e-6, 1e7, 120);
    let (storage, loss): (Vec<_>, Vec<_>) = omega
        .iter()
        .map(|w| truth.complex(*w))
        .map(|(e1, e2)| (e1 * (1.0 + 0.01 * normal()), e2 * (1.0 + 0.01 * normal())))
        .unzip();
    let fit = fit_dma(&omega, &storage, &loss, &FitOptions::default()).unwrap().function;
    for w in [1e-3, 1.0, 1e4] {
        let step = 0.05;
        let integral: f64 = (0..800)
            .map(|k| step * (f64::from(k) + 0.5))
            .map(|y: f64| {
                let (above, below) = (fit.complex(w * y.exp()).1, fit.complex(w * (-y).exp()).1);
                // 1/(1 - e^2y) above and 1/(1 - e^-2y) = 1 - 1/(1 - e^2y) below.
                let kernel = -1.0 / (2.0 * y).exp_m1();
                above * kernel + below * (1.0 - kernel)
            })
            .sum();
        let storage = fit.equilibrium + 2.0 / std::f64::consts::PI * step * integral;
        // Midpoint rule of a smooth integrand with strip pi/2 around y = 0.
        assert!((storage / fit.complex(w).0 - 1.0).abs() < 1e-6, "{w}");
    }
}

#[test]
fn an_elastic_curve_has_no_terms() {
    let times = logspace(1.0, 1e3, 30);
    let fit = fit_relaxation(&times, &[5e6; 30], &FitOptions::default()).unwrap();
    assert!(fit.function.terms.is_empty() && (fit.function.equilibrium / 5e6 - 1.0).abs() < 1e-12);
}

#[test]
fn a_creep_test_from_zero_has_no_instantaneous_compliance() {
    let kelvin_voigt =
        Creep { terms: vec![CreepTerm { compliance: 1e-6, retardation_time: 2.0 }], ..Creep::default() };
    let times: Vec<f64> = (0..40).map(|k| 0.25 * f64::from(k)).collect();
    let values: Vec<f64> = times.iter().map(|t| kelvin_voigt.value(*t)).collect();
    let fit = fit_creep(&times, &values, &FitOptions::default()).unwrap();
    assert_eq!(fit.function.instantaneous, 0.0);
    assert!(fit.misfit.max < 1e-6, "{:?}", fit.misfit);
}

#[test]
fn long_times_follow_the_option() {
    let times = logspace(1e-2, 1e2, 50);
    let moduli: Vec<f64> = times.iter().map(|t| 1e6 * (0.1 + (-t).exp())).collect();
    let fluid = FitOptions { long_time: LongTime::Fluid, ..FitOptions::default() };
    assert_eq!(fit_relaxation(&times, &moduli, &fluid).unwrap().function.equilibrium, 0.0);
    let compliances: Vec<f64> = times.iter().map(|t| 1e-6 * (1.0 + t)).collect();
    let solid = FitOptions { long_time: LongTime::Solid, ..FitOptions::default() };
    let fit = fit_creep(&times, &compliances, &solid).unwrap();
    assert!(fit.function.fluidity == 0.0 && fit.misfit.max < 0.05, "{:?}", fit.misfit);
}

#[test]
fn evenly_sampled_records_of_any_length_are_fitted() {
    let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)]).unwrap();
    let mut normal = normal(4);
    let times: Vec<f64> = (1..200_000).map(|k| 0.005 * f64::from(k)).collect();
    let moduli: Vec<f64> = times.iter().map(|t| pmma.value(*t) * (1.0 + 0.01 * normal())).collect();
    let fit = fit_relaxation(&times, &moduli, &FitOptions::default()).unwrap();
    assert!((fit.misfit.rms / 0.01 - 1.0).abs() < 0.02, "{:?}", fit.misfit);
    for t in [0.1, 1.0, 10.0, 100.0, 1000.0] {
        // 0.01/sqrt(points per decade), and the sampling starts with one point per 5 ms.
        let error = (fit.function.value(t) / pmma.value(t) - 1.0).abs();
        assert!(error < 2e-3, "{t} {error}");
    }
}

#[test]
fn what_no_passive_material_can_do_is_refused_with_its_place() {
    let options = FitOptions::default();
    let refused = |result: Result<()>, words: &[&str]| {
        let error = result.unwrap_err().to_string();
        for word in words {
            assert!(error.contains(word), "{error}");
        }
    };
    let times = logspace(1e-2, 1e2, 41);
    let relaxing: Vec<f64> = times.iter().map(|t| 1e6 * (1.0 + (-t).exp())).collect();
    let fit = |moduli: &[f64]| fit_relaxation(&times, moduli, &options).map(|_| ());
    let mut growing = relaxing.clone();
    growing[30] *= 1.5;
    refused(fit(&growing), &["relaxation modulus of point 31 (time 1e1 s)", "does not rise"]);
    let mut negative = relaxing.clone();
    negative[7] = -1.0;
    refused(fit(&negative), &["relaxation modulus of point 8", "-1e0 Pa"]);
    negative[7] = f64::NAN;
    refused(fit(&negative), &["relaxation modulus of point 8", "NaN"]);
    refused(fit(&relaxing[1..]), &["number of values", "41"]);
    // A drop that is faster than any relaxation: from 2 to 1 within a tenth of a decade.
    let dropping: Vec<f64> = times.iter().map(|t| if *t < 1.0 { 2e6 } else { 1e6 }).collect();
    refused(fit(&dropping), &["passive material", "%"]);
    // Creep that falls.
    let falling: Vec<f64> = times.iter().map(|t| 1e-6 * (2.0 - t / 100.0)).collect();
    refused(fit_creep(&times, &falling, &options).map(|_| ()), &["creep compliance", "does not fall"]);
    // Storage that falls with frequency, loss that is negative, and a pair that breaks Kramers-Kronig.
    let solid = Relaxation::absolute(1e6, &[(1e6, 1.0)]).unwrap();
    let (storage, loss): (Vec<_>, Vec<_>) = times.iter().map(|w| solid.complex(*w)).unzip();
    let dma = |s: &[f64], l: &[f64]| fit_dma(&times, s, l, &options).map(|_| ());
    let reversed: Vec<f64> = storage.iter().rev().copied().collect();
    refused(dma(&reversed, &loss), &["storage modulus of point", "does not fall"]);
    let mut negative = loss.clone();
    negative[3] = -1.0;
    refused(dma(&storage, &negative), &["loss modulus of point 4"]);
    let tripled: Vec<f64> = loss.iter().map(|l| 3.0 * l).collect();
    refused(dma(&storage, &tripled), &["no passive material", "the storage modulus alone is fitted to 0.0"]);
    assert!(dma(&storage, &loss).is_ok());
}

#[test]
fn a_run_beyond_the_data_is_told_so() {
    let times = logspace(1.0, 100.0, 20);
    let moduli: Vec<f64> = times.iter().map(|t| 1e6 * (1.0 + (-t / 9.0).exp())).collect();
    let fit = fit_relaxation(&times, &moduli, &FitOptions::default()).unwrap();
    assert_eq!(fit.beyond(1.0, 100.0), None);
    let words = fit.beyond(0.1, 1e3).unwrap();
    assert!(words.contains("0.1 s to 1000 s") && words.contains("1 s to 100 s"), "{words}");
}

#[test]
fn the_uncertainty_of_a_term_is_its_scatter_over_many_experiments() {
    // PMMA with 0.1 % of noise, 40 times: the terms scatter as the first fit predicts.
    let pmma = Relaxation::absolute(1973e6, &[(254.776e6, 8.93), (263.6628e6, 117.96)]).unwrap();
    let times = logspace(0.3, 3000.0, 80);
    let mut normal = normal(7);
    let (mut found, mut said) = (vec![], vec![]);
    for _ in 0..40 {
        let moduli: Vec<f64> = times.iter().map(|t| pmma.value(*t) * (1.0 + 1e-3 * normal())).collect();
        let fit = fit_relaxation(&times, &moduli, &FitOptions::default()).unwrap();
        if fit.function.terms.len() == 2 {
            found.push(fit.function.terms[1].relaxation_time.ln());
            said.push(fit.uncertainty[1][1]);
        }
    }
    assert!(found.len() > 30, "{}", found.len());
    let count = found.len() as f64;
    let mean = found.iter().sum::<f64>() / count;
    let scatter = (found.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (count - 1.0)).sqrt();
    let said = said.iter().sum::<f64>() / count;
    // A standard deviation from 30 samples is known to 13 %; three of them.
    assert!((scatter / said).ln().abs() < 0.4, "{scatter} {said}");
}

#[test]
fn fewer_terms_than_the_data_call_for_cost_misfit() {
    let truth = thirteen();
    let times = logspace(1e-7, 1e6, 200);
    let moduli: Vec<f64> = times.iter().map(|t| truth.value(*t)).collect();
    let misfit = |max_terms: usize| {
        let options = FitOptions { max_terms, limit: 1.0, ..FitOptions::default() };
        let fit = fit_relaxation(&times, &moduli, &options).unwrap();
        assert!(fit.function.terms.len() <= max_terms, "{}", fit.function.terms.len());
        fit.misfit.rms
    };
    let [all, nine, five] = [20, 9, 5].map(misfit);
    assert!(all < 1e-6 && all < nine && nine < five && five < 0.3, "{all} {nine} {five}");
}

#[test]
fn too_few_terms_are_blamed_and_not_the_data() {
    let truth = thirteen();
    let times = logspace(1e-7, 1e6, 200);
    let moduli: Vec<f64> = times.iter().map(|t| truth.value(*t)).collect();
    let error = |max_terms: usize, moduli: &[f64]| {
        let options = FitOptions { max_terms, ..FitOptions::default() };
        fit_relaxation(&times, moduli, &options).err().map(|error| error.to_string())
    };
    let few = error(3, &moduli).unwrap();
    assert!(few.contains("most terms of the fit") && !few.contains("point"), "{few}");
    assert_eq!(error(20, &moduli), None);
    // A modulus that doubles is wrong with any number of terms.
    let wrong: Vec<f64> =
        moduli.iter().enumerate().map(|(n, m)| if n < 100 { *m } else { 2.0 * m }).collect();
    assert!(error(3, &wrong).unwrap().contains("point"));
}

#[test]
fn bad_options_are_named() {
    let bad = |options: FitOptions, words: &str| {
        let error = fit_relaxation(&[1.0, 2.0], &[2.0, 1.0], &options).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    let default = FitOptions::default();
    bad(FitOptions { per_decade: 0.0, ..default }, "times per decade");
    bad(FitOptions { per_decade: f64::NAN, ..default }, "times per decade");
    bad(FitOptions { margin: -1.0, ..default }, "margin");
    bad(FitOptions { margin: 100.0, ..default }, "margin");
    bad(FitOptions { limit: 0.0, ..default }, "misfit");
    bad(FitOptions { max_terms: 0, ..default }, "most terms");
}

#[test]
fn one_modulus_of_two_that_contradict_each_other_is_fitted() {
    let truth = thirteen();
    let omega = logspace(1e-6, 1e7, 200);
    let (storage, loss): (Vec<f64>, Vec<f64>) =
        omega.iter().map(|w| truth.complex(*w)).map(|(e1, e2)| (e1, 1.5 * e2)).unzip();
    let fit = |moduli: Moduli| {
        fit_dma(&omega, &storage, &loss, &FitOptions { moduli, ..FitOptions::default() }).unwrap()
    };
    let found = fit(Moduli::Storage);
    // Exact storage moduli give the terms back; the loss modulus is short of the data by 1/1.5 - 1.
    assert!(
        found.columns[0].max < 1e-5 && (found.columns[1].rms - 1.0 / 3.0).abs() < 1e-4,
        "{:?}",
        found.columns
    );
    assert_eq!(found.misfit, found.columns[0]);
    let found = fit(Moduli::Loss);
    assert!(found.columns[1].max < 1e-5 && found.columns[0].rms > 0.1, "{:?}", found.columns);
    // Where they agree, the loss modulus alone gives the storage modulus too, with the constant taken from that.
    let loss: Vec<f64> = loss.iter().map(|value| value / 1.5).collect();
    let options = FitOptions { moduli: Moduli::Loss, ..FitOptions::default() };
    let found = fit_dma(&omega, &storage, &loss, &options).unwrap();
    assert!((found.function.equilibrium / truth.equilibrium - 1.0).abs() < 1e-3, "{:?}", found.function);
    assert!(found.columns[0].max < 1e-3, "{:?}", found.columns);
}

#[test]
fn the_fewest_terms_hold_a_misfit() {
    let truth = thirteen();
    let times = logspace(1e-7, 1e6, 200);
    let moduli: Vec<f64> = times.iter().map(|t| truth.value(*t)).collect();
    let fit = |misfit: f64| {
        let options = FitOptions { misfit: Some(misfit), ..FitOptions::default() };
        fit_relaxation(&times, &moduli, &options).map(|fit| (fit.misfit.rms, fit.function.terms.len()))
    };
    let (coarse, few) = fit(0.05).unwrap();
    let (fine, more) = fit(0.005).unwrap();
    assert!(coarse <= 0.05 && fine <= 0.005 && few < more && more <= 13, "{coarse} {few} {fine} {more}");
    // No passive material fits data with two per cent of scatter to a tenth of that.
    let mut normal = normal(5);
    let scattered: Vec<f64> = moduli.iter().map(|value| value * (1.0 + 0.02 * normal())).collect();
    let options = FitOptions { misfit: Some(0.002), ..FitOptions::default() };
    let refused = fit_relaxation(&times, &scattered, &options).unwrap_err().to_string();
    assert!(refused.contains("misfit to be held"), "{refused}");
}

#[test]
fn a_fit_of_moduli_that_contradict_each_other_lies_between_them() {
    // E' = w^n and E'' = tan(n pi/2) w^n of a power law, with a loss modulus k times too high. The law times
    // c = (1 + 1/k)/(1 + 1/k^2) is a passive material and minimises (c - 1)^2 + (c/k - 1)^2 among its multiples: a fit is at least as close.
    let (n, omega) = (0.2, logspace(1e-6, 1e6, 241));
    let tangent = (n * std::f64::consts::FRAC_PI_2).tan();
    let storage: Vec<f64> = omega.iter().map(|w| 1e7 * w.powf(n)).collect();
    let both = |k: f64| {
        let loss: Vec<f64> = storage.iter().map(|value| k * tangent * value).collect();
        fit_dma(&omega, &storage, &loss, &FitOptions::default())
    };
    for k in [1.0, 1.3, 1.5, 0.7] {
        let fit = both(k).unwrap();
        let c = (1.0 + 1.0 / k) / (1.0 + 1.0 / (k * k));
        let multiple = (((c - 1.0).powi(2) + (c / k - 1.0).powi(2)) / 2.0).sqrt();
        // The discrete spectrum follows a power law to 2 %.
        assert!(fit.misfit.rms < multiple + 0.02, "{k}: {:?} {multiple}", fit.misfit);
        // In the middle, far from the ends, which bend, it lies between both moduli.
        for (w, law) in omega.iter().zip(&storage).filter(|(w, _)| (1e-3..1e3).contains(*w)) {
            let (found, lost) = fit.function.complex(*w);
            let [least, most] = [k.min(1.0) - 0.03, k.max(1.0) + 0.03];
            for ratio in [found / law, lost / law / tangent] {
                assert!(ratio > least && ratio < most, "{k} {w}: {ratio}");
            }
        }
    }
    // A loss modulus with a scatter of a factor of 1.35 beside: fitted through, and above what a fit of one curve may have.
    let mut normal = normal(3);
    let loss: Vec<f64> = storage.iter().map(|value| 1.2 * tangent * value * (0.3 * normal()).exp()).collect();
    let fit = fit_dma(&omega, &storage, &loss, &FitOptions::default()).unwrap();
    assert!(
        fit.columns[0].rms < 0.1 && fit.columns[1].rms > 0.2 && fit.misfit.rms > 0.1,
        "{:?}",
        fit.columns
    );
    // c/k - 1 is -50 %.
    let refused = both(2.6).unwrap_err().to_string();
    assert!(refused.contains("30 %") && refused.contains("the storage modulus alone is fitted"), "{refused}");
}

#[test]
fn sweeps_that_overlap_with_scatter_are_fitted_through_and_told() {
    // Points of another sweep, 18 % lower, stand between those of a smooth one: the storage modulus falls by more than its scatter.
    let (truth, omega) = (thirteen(), logspace(1e-6, 1e7, 200));
    let low = |n: usize| if [100, 102, 104].contains(&n) { 0.82 } else { 1.0 };
    let storage: Vec<f64> = omega.iter().enumerate().map(|(n, w)| truth.complex(*w).0 * low(n)).collect();
    let loss: Vec<f64> = omega.iter().map(|w| truth.complex(*w).1).collect();
    let options = FitOptions { moduli: Moduli::Storage, ..FitOptions::default() };
    let fit = fit_dma(&omega, &storage, &loss, &options).unwrap();
    let found = fit.reversal.unwrap();
    // The modulus rises by up to 8 % from point to point.
    assert!(found.share > 0.1 && found.share < 0.18 && found.allowed == 0.1, "{found:?}");
    // Between the two sweeps, and three points in 200 do not move the curve elsewhere.
    let error = |w: &f64| (fit.function.complex(*w).0 / truth.complex(*w).0 - 1.0).abs();
    assert!(omega.iter().map(error).fold(0.0, f64::max) < 0.18);
    assert!(omega[..85].iter().chain(&omega[120..]).map(error).fold(0.0, f64::max) < 0.03);
    assert!(fit.misfit.max < 0.2 && fit.misfit.rms < 0.05, "{:?}", fit.misfit);
    // Ten such points in a row belong to no scatter.
    let lower = |n: usize| if (100..110).contains(&n) { 0.6 } else { 1.0 };
    let storage: Vec<f64> = omega.iter().enumerate().map(|(n, w)| truth.complex(*w).0 * lower(n)).collect();
    let refused = fit_dma(&omega, &storage, &loss, &options).unwrap_err().to_string();
    assert!(refused.contains("passive material"), "{refused}");
}
