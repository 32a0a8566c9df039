//! Factors of synthetic isotherms, and data that are refused.

use super::*;
use crate::material::series::tests::random;
use crate::material::{
    FitOptions, Relaxation, VerticalShift, fit_dma, fit_relaxation, fit_wlf, master_curve,
};

/// A transition over six decades.
fn polymer() -> Relaxation {
    let weights = [2e8, 5e8, 9e8, 7e8, 4e8, 1e8, 3e7, 6e6, 1e6];
    let terms: Vec<_> =
        weights.iter().enumerate().map(|(k, w)| (*w, 4.0 * 10f64.powi(k as i32 - 4))).collect();
    Relaxation::absolute(1e6, &terms).unwrap()
}

fn law() -> Shift {
    Shift::Wlf { c1: 9.0, c2: 80.0, reference: 310.0 }
}

const TEMPERATURES: [f64; 8] = [295.0, 300.0, 305.0, 310.0, 315.0, 320.0, 330.0, 340.0];

/// DMA sweeps from 0.1 to 100 Hz with 1 % scatter.
fn sweeps() -> Vec<Isotherm> {
    let mut random = random(8);
    let mut scatter = move || 1.0 + 0.01 * (random() + random() + random() + random() - 2.0) * 3f64.sqrt();
    let sweep = |temperature: f64| {
        let a = law().factor(temperature).unwrap();
        let x: Vec<f64> = (0..19).map(|k| 0.628 * 10f64.powf(f64::from(k) / 6.0)).collect();
        let (storage, loss): (Vec<_>, Vec<_>) =
            x.iter().map(|w| polymer().complex(w * a)).map(|(s, l)| (s * scatter(), l * scatter())).unzip();
        Isotherm { temperature, x, curves: vec![storage, loss] }
    };
    TEMPERATURES.map(sweep).to_vec()
}

#[test]
fn sweeps_at_eight_temperatures_give_the_law_and_the_material() {
    let found = estimate_shift(&sweeps(), Abscissa::Frequency, 310.0, ModulusChange::Neglected).unwrap();
    let table = found.shift;
    for t in TEMPERATURES {
        let error = (table.ln_factor(t).unwrap() - law().ln_factor(t).unwrap()) / LN_10;
        // 1 % of scatter on slopes of 1/4 and more, averaged over some 20 points and summed over
        // at most four pairs.
        assert!(error.abs() < 0.03, "{t} K: {error} decades");
    }
    let Shift::Table { points } = &table else { panic!("{table:?}") };
    let fit = fit_wlf(points, 310.0).unwrap();
    assert!(fit.rms < 0.02, "{fit:?}");
    let master = master_curve(&sweeps(), Abscissa::Frequency, &fit.shift).unwrap();
    assert!(master.x.windows(2).all(|p| p[0] < p[1]) && master.x.len() == 8 * 19);
    let options = FitOptions::default();
    let fit = fit_dma(&master.x, &master.curves[0], &master.curves[1], &options).unwrap();
    for t in [3e-4, 1e-2, 1.0, 1e2, 3e2] {
        let error = fit.function.value(t) / polymer().value(t) - 1.0;
        // 0.02 decades along slopes up to 1 are 5 %.
        assert!(error.abs() < 0.05, "{t} {error}");
    }
}

#[test]
fn relaxation_in_time_shifts_the_other_way() {
    let isotherms: Vec<Isotherm> = [300.0, 305.0, 310.0]
        .iter()
        .map(|temperature| {
            let a = law().factor(*temperature).unwrap();
            let x: Vec<f64> = (0..21).map(|k| 10f64.powf(-1.0 + 0.15 * f64::from(k))).collect();
            let curve = x.iter().map(|t| polymer().value(t / a)).collect();
            Isotherm { temperature: *temperature, x, curves: vec![curve] }
        })
        .collect();
    let table = estimate_shift(&isotherms, Abscissa::Time, 310.0, ModulusChange::Neglected).unwrap().shift;
    let error = table.ln_factor(300.0).unwrap() / law().ln_factor(300.0).unwrap() - 1.0;
    // No scatter; chords over 0.15 decades.
    assert!(error.abs() < 2e-3, "{error}");
    let master = master_curve(&isotherms, Abscissa::Time, &law()).unwrap();
    let fit = fit_relaxation(&master.x, &master.curves[0], &FitOptions::default()).unwrap();
    assert!(fit.misfit.max < 1e-3, "{:?}", fit.misfit);
}

#[test]
fn what_cannot_be_shifted_is_told() {
    let isotherm = |temperature: f64, x: &[f64], curve: &[f64]| Isotherm {
        temperature,
        x: x.to_vec(),
        curves: vec![curve.to_vec()],
    };
    let says = |isotherms: &[Isotherm], reference: f64, words: &str| {
        let error = estimate_shift(isotherms, Abscissa::Time, reference, ModulusChange::Neglected)
            .unwrap_err()
            .to_string();
        assert!(error.contains(words), "{error}");
    };
    let x = [1.0, 2.0, 4.0, 8.0];
    let high = isotherm(300.0, &x, &[9e9, 8e9, 7e9, 6e9]);
    let low = isotherm(400.0, &x, &[4e6, 3e6, 2e6, 1e6]);
    says(&[high.clone(), low.clone()], 300.0, "isotherms at 300.00 K (26.85 °C) and 400.00 K");
    let flat = |t: f64| isotherm(t, &x, &[1e9; 4]);
    says(&[flat(300.0), flat(310.0)], 300.0, "slope");
    let next = isotherm(310.0, &x, &[7e9, 6e9, 5e9, 4e9]);
    says(&[high.clone(), next.clone()], 305.0, "one of the isotherms: 300 K, 310 K");
    says(&[high.clone(), high.clone()], 300.0, "300 K twice");
    says(std::slice::from_ref(&high), 300.0, "number of isotherms is 1");
    says(&[isotherm(300.0, &[1.0, 1.0], &[1.0, 1.0])], 300.0, "abscissa of point 2");
    says(&[isotherm(300.0, &[1.0, 2.0], &[1.0, -1.0])], 300.0, "point 2 of the isotherm at 300 K");
    says(&[isotherm(300.0, &x, &[1.0])], 300.0, "number of values");
    says(&[], 300.0, "number of isotherms is 0");
    assert!(estimate_shift(&[high, next], Abscissa::Time, 310.0, ModulusChange::Neglected).is_ok());
}

/// Relaxation of the polymer over three decades from 0.1 s at the given temperatures.
fn relaxing(temperatures: &[f64]) -> Vec<Isotherm> {
    let isotherm = |temperature: &f64| {
        let a = law().factor(*temperature).unwrap();
        let x: Vec<f64> = (0..21).map(|k| 10f64.powf(-1.0 + 0.15 * f64::from(k))).collect();
        let curve = x.iter().map(|t| polymer().value(t / a)).collect();
        Isotherm { temperature: *temperature, x, curves: vec![curve] }
    };
    temperatures.iter().map(isotherm).collect()
}

#[test]
fn the_uncertainty_grows_from_the_reference_and_holds_the_error() {
    let temperatures = [295.0, 302.0, 310.0, 320.0, 332.0];
    let found =
        estimate_shift(&relaxing(&temperatures), Abscissa::Time, 310.0, ModulusChange::Neglected).unwrap();
    assert_eq!(found.uncertainty[2], 0.0);
    assert!(found.uncertainty[0] > found.uncertainty[1] && found.uncertainty[4] > found.uncertainty[3]);
    for (t, uncertainty) in temperatures.iter().zip(&found.uncertainty) {
        let error = (found.shift.ln_factor(*t).unwrap() - law().ln_factor(*t).unwrap()) / LN_10;
        // Three standard deviations, and the digits at the reference.
        assert!(error.abs() <= 3.0 * uncertainty + 1e-9, "{t} K: {error}, {uncertainty}");
    }
}

#[test]
fn isotherms_far_apart_are_continued_with_their_uncertainty() {
    // Twenty kelvin and more apart: three decades of time each, three decades of shift and more.
    let temperatures = [293.0, 313.0, 340.0, 377.0];
    let found =
        estimate_shift(&relaxing(&temperatures), Abscissa::Time, 313.0, ModulusChange::Neglected).unwrap();
    for (t, uncertainty) in temperatures.iter().zip(&found.uncertainty) {
        let error = (found.shift.ln_factor(*t).unwrap() - law().ln_factor(*t).unwrap()) / LN_10;
        // The estimate states its uncertainty, and that is less than a decade.
        assert!(error.abs() < 1.0 && *uncertainty <= 1.0, "{t} K: {error}, {uncertainty}");
    }
}

#[test]
fn a_flat_pair_follows_the_law_of_the_others() {
    // Rubbery at the two warmest temperatures: the modulus changes by less than its own change with temperature.
    let temperatures = [295.0, 300.0, 305.0, 310.0, 318.0, 326.0, 380.0, 390.0];
    let found =
        estimate_shift(&relaxing(&temperatures), Abscissa::Time, 310.0, ModulusChange::Neglected).unwrap();
    let step = |shift: &Shift| (shift.ln_factor(380.0).unwrap() - shift.ln_factor(390.0).unwrap()) / LN_10;
    // Half of the assumed accuracy of the law.
    assert!((step(&found.shift) - step(&law())).abs() < 0.3, "{found:?}");
}

/// The sweeps with moduli that are `factor(T)` times as large.
fn stiffened(factor: impl Fn(f64) -> f64) -> Vec<Isotherm> {
    let mut isotherms = sweeps();
    for isotherm in &mut isotherms {
        let factor = factor(isotherm.temperature);
        isotherm.curves.iter_mut().flatten().for_each(|value| *value *= factor);
    }
    isotherms
}

#[test]
fn both_moduli_tell_times_and_factors_of_moduli() {
    let truth = |t: f64| 1.0 + 0.01 * (t - 310.0);
    let isotherms = stiffened(truth);
    let found = estimate_shift(&isotherms, Abscissa::Frequency, 310.0, ModulusChange::Free).unwrap();
    let vertical =
        estimate_vertical(&isotherms, Abscissa::Frequency, &found.shift, &found.uncertainty).unwrap();
    for ((t, decades), share) in TEMPERATURES.iter().zip(&found.uncertainty).zip(&vertical.uncertainty) {
        let error = (found.shift.ln_factor(*t).unwrap() - law().ln_factor(*t).unwrap()) / LN_10;
        // Three standard deviations; otherwise 45 % of change would appear as a tenth of a decade.
        assert!(error.abs() <= 3.0 * decades + 1e-9 && *decades < 0.2, "{t} K: {error} of {decades} decades");
        let error = (vertical.vertical.factor(*t).unwrap() * truth(*t)).ln();
        assert!(error.abs() <= 3.0 * share + 1e-9 && *share < 0.2, "{t} K: {error} of {share}");
    }
    // Without them the shift in time absorbs the change: by more than three of its standard deviations at the highest
    // temperature.
    let without = estimate_shift(&isotherms, Abscissa::Frequency, 310.0, ModulusChange::Neglected).unwrap();
    let error = (without.shift.ln_factor(340.0).unwrap() - law().ln_factor(340.0).unwrap()) / LN_10;
    assert!(error.abs() > 0.1, "{error}");
}

#[test]
fn factors_of_a_known_shift_are_found_and_those_of_density_are_corrected() {
    let density = VerticalShift::Density { reference: 310.0, expansion: 0.0 };
    let isotherms = stiffened(|t| 1.0 / density.factor(t).unwrap());
    let found = estimate_vertical(&isotherms, Abscissa::Frequency, &law(), &[]).unwrap();
    for (t, share) in TEMPERATURES.iter().zip(&found.uncertainty) {
        let error = found.vertical.factor(*t).unwrap() / density.factor(*t).unwrap() - 1.0;
        // 1 % of scatter over some 20 points a pair, seven pairs.
        assert!(error.abs() <= 3.0 * share + 1e-9 && error.abs() < 0.03, "{t} K: {error} of {share}");
    }
    let apart = Shift::Wlf { c1: 60.0, c2: 80.0, reference: 310.0 };
    let refused = estimate_vertical(&isotherms, Abscissa::Frequency, &apart, &[]).unwrap_err().to_string();
    assert!(refused.contains("factor between the moduli"), "{refused}");
}

#[test]
fn a_power_law_alone_does_not_tell_times_from_moduli() {
    let isotherm = |temperature: f64, a: f64| Isotherm {
        temperature,
        x: (0..13).map(|k| 10f64.powf(f64::from(k) / 4.0)).collect(),
        curves: vec![(0..13).map(|k| 1e7 * (10f64.powf(f64::from(k) / 4.0) / a).powf(-0.3)).collect()],
    };
    let both = [isotherm(300.0, 10.0), isotherm(310.0, 1.0)];
    assert!(estimate_shift(&both, Abscissa::Time, 310.0, ModulusChange::Neglected).is_ok());
    let refused = estimate_shift(&both, Abscissa::Time, 310.0, ModulusChange::Free).unwrap_err().to_string();
    assert!(refused.contains("uncertain"), "{refused}");
}

#[test]
fn a_glass_whose_sweeps_do_not_overlap_is_refused() {
    // One decade each, five decades and more apart; 0.5 % of scatter.
    let law = Shift::Wlf { c1: 13.5, c2: 60.0, reference: 333.15 };
    let mut random = random(3);
    let mut scatter = move || 1.0 + 0.01 * (random() - 0.5);
    let weights = (-24..26).map(|k| (-0.1 * f64::from(k * k) / 4.0).exp());
    let terms: Vec<_> =
        weights.zip(-24..26).map(|(w, k)| (4e8 * w, 10f64.powf(0.5 * f64::from(k)))).collect();
    let glass = Relaxation::absolute(3e6, &terms).unwrap();
    let mut isotherm = |temperature: f64| {
        let a = law.factor(temperature).unwrap();
        let x: Vec<f64> = (0..6).map(|k| 6.0 * 10f64.powf(0.2 * f64::from(k))).collect();
        let (storage, loss): (Vec<_>, Vec<_>) =
            x.iter().map(|w| glass.complex(w * a)).map(|(s, l)| (s * scatter(), l * scatter())).unzip();
        Isotherm { temperature, x, curves: vec![storage, loss] }
    };
    let isotherms = [296.15, 303.15, 310.15, 317.15].map(&mut isotherm);
    let refused =
        estimate_shift(&isotherms, Abscissa::Frequency, 296.15, ModulusChange::Neglected).unwrap_err();
    assert!(refused.to_string().contains("or give the shift"), "{refused}");
}

#[test]
fn flat_sweeps_of_a_glass_are_shifted_with_their_uncertainty() {
    // Sweeps every 8 K, as of instruments: at the coldest the modulus changes by less than its scatter of 1 %.
    let law = law();
    let glass: Vec<f64> = (0..10).map(|k| 274.0 + 8.0 * f64::from(k)).collect();
    let mut random = random(5);
    let mut scatter = move || 1.0 + 0.01 * (random() + random() + random() + random() - 2.0) * 3f64.sqrt();
    let sweep = |temperature: &f64| {
        let a = law.factor(*temperature).unwrap();
        let x: Vec<f64> = (0..10).map(|k| 0.628 * 10f64.powf(f64::from(k) / 3.0)).collect();
        let storage = x.iter().map(|w| polymer().complex(w * a).0 * scatter()).collect();
        Isotherm { temperature: *temperature, x, curves: vec![storage] }
    };
    let sweeps: Vec<Isotherm> = glass.iter().map(sweep).collect();
    let found = estimate_shift(&sweeps, Abscissa::Frequency, 314.0, ModulusChange::Neglected).unwrap();
    assert!(found.uncertainty.iter().any(|decades| *decades > 1.0), "{found:?}");
    let zero = law.ln_factor(314.0).unwrap();
    for (t, uncertainty) in glass.iter().zip(&found.uncertainty) {
        let error = (found.shift.ln_factor(*t).unwrap() - law.ln_factor(*t).unwrap() + zero) / LN_10;
        // Three standard deviations.
        assert!(error.abs() <= 3.0 * uncertainty + 1e-9, "{t} K: {error}, {uncertainty}");
    }
}
