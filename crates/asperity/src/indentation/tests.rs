use super::*;
use crate::reference::{Mdr, MdrTarget};

/// Numbers of a normal distribution: a linear congruential generator and Box & Muller.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    }

    pub(crate) fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

const SPHERE: MdrProfile = MdrProfile::Paraboloid { radius: 5e-3 };

/// Pressed within 1 s, held until 15 s, retracted until 17 s, then free until 20 s.
fn trapezoid(t: f64) -> f64 {
    if t < 1.0 { t } else { (1.0 - (t - 15.0) / 2.0).clamp(0.0, 1.0) }
}

/// The exact record of a body: the given channel is `peak` times the trapezoid, the other follows from ten steps between the
/// rows.
fn record(
    profile: MdrProfile,
    truth: &Relaxation,
    given: Given,
    peak: f64,
    rows: usize,
) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let mut springs = Mdr::new(profile, truth, profile.reach(1e-4), 400).unwrap();
    let times: Vec<f64> = (0..rows).map(|k| 20.0 * k as f64 / (rows - 1) as f64).collect();
    let (mut loads, mut depths) = (vec![], vec![]);
    for (n, t) in times.iter().enumerate() {
        let start = if n == 0 { 0.0 } else { times[n - 1] };
        let substeps = if n == 0 { 1 } else { 10 };
        let mut state = None;
        for k in 1..=substeps {
            let now = start + (t - start) * k as f64 / substeps as f64;
            let target = match given {
                Given::Depth => MdrTarget::Approach(peak * trapezoid(now)),
                Given::Load => MdrTarget::Load(peak * trapezoid(now)),
            };
            state = Some(springs.step((t - start) / substeps as f64, target).unwrap());
        }
        let state = state.unwrap();
        loads.push(state.load);
        depths.push(state.approach);
    }
    (times, loads, depths)
}

fn noisy(values: &[f64], share: f64, noise: &mut Noise) -> Vec<f64> {
    let largest = values.iter().fold(0.0, |m: f64, v| m.max(*v));
    values.iter().map(|v| v + share * largest * noise.normal()).collect()
}

fn one_term() -> Relaxation {
    Relaxation::absolute(2e6, &[(3e6, 2.5)]).unwrap()
}

fn two_terms() -> Relaxation {
    Relaxation::absolute(2e6, &[(3e6, 0.4), (1.5e6, 6.0)]).unwrap()
}

fn fit_of(
    profile: MdrProfile,
    columns: (&[f64], &[f64], &[f64]),
    options: IndentationOptions,
) -> Result<IndentationFit> {
    let (times, loads, depths) = columns;
    fit_indentation(profile, &IndentationRecord { times, loads, depths }, &options)
}

#[test]
fn exact_records_give_the_material_back() {
    for profile in [SPHERE, MdrProfile::Cone { slope: 0.1 }] {
        for (given, peak) in [(Given::Depth, 1e-4), (Given::Load, 0.5)] {
            for truth in [one_term(), two_terms()] {
                let (times, loads, depths) = record(profile, &truth, given, peak, 400);
                let options = IndentationOptions { given: Some(given), ..IndentationOptions::default() };
                let fit = fit_of(profile, (&times, &loads, &depths), options).unwrap();
                // The model's own steps: 150 springs, one or two steps between the rows.
                assert!(fit.relative_rms < 1e-3, "{given:?} {fit:?}");
                assert_eq!(fit.terms.len(), truth.terms.len(), "{profile:?} {given:?} {fit:?}");
                assert!((fit.equilibrium.value / truth.equilibrium - 1.0).abs() < 5e-3, "{given:?} {fit:?}");
                for ([modulus, time], term) in fit.terms.iter().zip(&truth.terms) {
                    assert!((modulus.value / term.modulus - 1.0).abs() < 0.02, "{given:?} {fit:?}");
                    assert!((time.value / term.relaxation_time - 1.0).abs() < 0.02, "{given:?} {fit:?}");
                }
            }
        }
    }
}

#[test]
fn noisy_records_hold_the_truth_in_their_intervals() {
    let mut noise = Noise(7);
    let (times, loads, depths) = record(SPHERE, &two_terms(), Given::Depth, 1e-4, 1000);
    let noisy_loads = noisy(&loads, 0.01, &mut noise);
    let options = IndentationOptions { terms: Some(2), ..IndentationOptions::default() };
    let fit = fit_of(SPHERE, (&times, &noisy_loads, &depths), options).unwrap();
    assert_eq!(fit.given, Given::Depth);
    // 1 % of white noise, detected as such.
    assert!((fit.relative_rms - 0.01).abs() < 0.001 && (fit.durbin_watson - 2.0).abs() < 0.2, "{fit:?}");
    assert!(fit.equilibrium.holds(2e6) && fit.instantaneous.holds(6.5e6), "{fit:?}");
    for ([modulus, time], term) in fit.terms.iter().zip(&two_terms().terms) {
        assert!(modulus.holds(term.modulus) && time.holds(term.relaxation_time), "{fit:?}");
        assert!(modulus.high < 1.5 * modulus.low, "{fit:?}");
    }
    // The load is given, the depth is noisy: one term is sufficient.
    let (times, loads, depths) = record(SPHERE, &one_term(), Given::Load, 0.5, 1000);
    let noisy_depths = noisy(&depths, 0.01, &mut noise);
    let fit = fit_of(SPHERE, (&times, &loads, &noisy_depths), IndentationOptions::default()).unwrap();
    assert_eq!((fit.given, fit.terms.len()), (Given::Load, 1));
    assert!(
        fit.equilibrium.holds(2e6) && fit.terms[0][0].holds(3e6) && fit.terms[0][1].holds(2.5),
        "{fit:?}"
    );
}

#[test]
fn intervals_cover_the_truth_as_often_as_they_say() {
    // 80 records of 250 rows with 1 % of noise, three parameters each: of 240 intervals 228 +- 3.4 hold the truth where
    // they are independent; 5 standard deviations of a third as many allow for their correlation.
    let (times, loads, depths) = record(SPHERE, &one_term(), Given::Depth, 1e-4, 250);
    let mut noise = Noise(11);
    let mut held = 0;
    for _ in 0..80 {
        let loads = noisy(&loads, 0.01, &mut noise);
        let options = IndentationOptions {
            given: Some(Given::Depth),
            terms: Some(1),
            long_time: LongTime::Solid,
            springs: 60,
            ..IndentationOptions::default()
        };
        let fit = fit_of(SPHERE, (&times, &loads, &depths), options).unwrap();
        let [modulus, time] = fit.terms[0];
        held +=
            [(fit.equilibrium, 2e6), (modulus, 3e6), (time, 2.5)].iter().filter(|(i, x)| i.holds(*x)).count();
    }
    assert!((210..=240).contains(&held), "{held} of 240");
}

#[test]
fn the_controlled_channel_is_found_from_its_ramps_and_holds() {
    let mut noise = Noise(21);
    for profile in [SPHERE, MdrProfile::Cone { slope: 0.1 }] {
        for (given, peak) in [(Given::Depth, 1e-4), (Given::Load, 0.5)] {
            let (times, loads, depths) = record(profile, &one_term(), given, peak, 400);
            // Also where the controlled channel is the noisier one.
            for (of_load, of_depth) in [(0.0, 0.0), (0.001, 0.015), (0.015, 0.001), (0.01, 0.01)] {
                let loads = noisy(&loads, of_load, &mut noise);
                let depths = noisy(&depths, of_depth, &mut noise);
                let found = control::controlled(&times, &loads, &depths);
                assert_eq!(found, given, "{profile:?} {of_load} {of_depth}");
            }
        }
    }
}

#[test]
fn what_a_record_does_not_determine_is_told() {
    // Pressed for only 1 s, with terms of 0.4 and 6 s: the record does not determine the equilibrium modulus.
    let (times, loads, depths) = record(SPHERE, &two_terms(), Given::Depth, 1e-4, 1000);
    let loads = noisy(&loads, 0.01, &mut Noise(13));
    let rows = 75; // 1.5 s
    let columns = (&times[..rows], &loads[..rows], &depths[..rows]);
    let fit = fit_of(SPHERE, columns, IndentationOptions::default()).unwrap();
    assert!(!fit.equilibrium.determined && fit.equilibrium.holds(2e6), "{fit:?}");
    assert!(fit.instantaneous.determined && fit.instantaneous.holds(6.5e6), "{fit:?}");
    let told =
        fit.notes.iter().any(|note| note.contains("equilibrium modulus is not determined by this record"));
    assert!(told, "{:?}", fit.notes);
    // The seed is fixed.
    assert_eq!(fit, fit_of(SPHERE, columns, IndentationOptions::default()).unwrap());
}

#[test]
fn a_body_that_still_relaxes_has_no_known_equilibrium() {
    // 20 s, and a term of 100 s that takes half of what is left.
    let truth = Relaxation::absolute(1e6, &[(3e6, 0.4), (1e6, 100.0)]).unwrap();
    let (times, loads, depths) = record(SPHERE, &truth, Given::Depth, 1e-4, 500);
    let loads = noisy(&loads, 0.005, &mut Noise(17));
    let fit = fit_of(SPHERE, (&times, &loads, &depths), IndentationOptions::default()).unwrap();
    assert!(!fit.equilibrium.determined && fit.equilibrium.holds(1e6), "{fit:?}");
    assert!(fit.notes.iter().any(|note| note.contains("the body may relax further")), "{:?}", fit.notes);
}

#[test]
fn noise_relative_to_the_value_and_an_unknown_touch_do_no_harm() {
    let mut noise = Noise(3);
    let (times, loads, depths) = record(SPHERE, &one_term(), Given::Depth, 1e-4, 600);
    let loads: Vec<f64> = loads.iter().map(|load| load * (1.0 + 0.01 * noise.normal())).collect();
    let shifted: Vec<f64> = depths.iter().map(|depth| depth + 4e-6).collect();
    let options = IndentationOptions { terms: Some(1), fit_touch: true, ..IndentationOptions::default() };
    let fit = fit_of(SPHERE, (&times, &loads, &shifted), options).unwrap();
    assert!(fit.touch.holds(4e-6), "{fit:?}");
    assert!(
        fit.equilibrium.holds(2e6) && fit.terms[0][0].holds(3e6) && fit.terms[0][1].holds(2.5),
        "{fit:?}"
    );
}

#[test]
fn a_fluid_and_an_elastic_body_are_known_as_such() {
    let fluid = Relaxation::absolute(0.0, &[(3e6, 2.5)]).unwrap();
    for (given, peak) in [(Given::Depth, 1e-4), (Given::Load, 0.05)] {
        let (times, loads, depths) = record(SPHERE, &fluid, given, peak, 300);
        let options =
            IndentationOptions { given: Some(given), terms: Some(1), ..IndentationOptions::default() };
        let fit = fit_of(SPHERE, (&times, &loads, &depths), options).unwrap();
        assert_eq!(fit.relaxation.equilibrium, 0.0, "{given:?} {fit:?}");
        assert!((fit.terms[0][1].value / 2.5 - 1.0).abs() < 0.01, "{given:?} {fit:?}");
    }
    let elastic = Relaxation::absolute(2e6, &[]).unwrap();
    let (times, loads, depths) = record(SPHERE, &elastic, Given::Depth, 1e-4, 300);
    let loads = noisy(&loads, 0.01, &mut Noise(5));
    let fit = fit_of(SPHERE, (&times, &loads, &depths), IndentationOptions::default()).unwrap();
    assert!(fit.terms.is_empty() && fit.equilibrium.holds(2e6), "{fit:?}");
}

#[test]
fn what_tells_nothing_is_refused_with_the_reason() {
    let (times, loads, depths) = record(SPHERE, &one_term(), Given::Depth, 1e-4, 100);
    type Columns<'a> = [&'a mut Vec<f64>; 3];
    let said = |change: &dyn Fn(Columns), options: IndentationOptions| {
        let (mut times, mut loads, mut depths) = (times.clone(), loads.clone(), depths.clone());
        change([&mut times, &mut loads, &mut depths]);
        fit_of(SPHERE, (&times, &loads, &depths), options).unwrap_err().to_string()
    };
    let default = IndentationOptions::default();
    let few = said(&|columns| columns.into_iter().for_each(|c| c.truncate(9)), default);
    assert!(few.contains("number of rows"), "{few}");
    let late = said(&|[t, _, _]| t[5] = t[4], default);
    assert!(late.contains("time of row 6") && late.contains("greater than the one before it"), "{late}");
    let missing = said(&|[_, w, _]| w[3] = f64::NAN, default);
    assert!(missing.contains("load of row 4"), "{missing}");
    let pulled = said(&|[_, w, _]| w[60] = -0.2 * w[10], default);
    assert!(pulled.contains("adhesion"), "{pulled}");
    let turned = said(&|[_, _, d]| d.iter_mut().for_each(|d| *d = -*d), default);
    assert!(turned.contains("largest depth") && turned.contains("sign"), "{turned}");
    let many = said(&|_| {}, IndentationOptions { terms: Some(4), ..default });
    assert!(many.contains("number of terms (4)") && many.contains("known to"), "{many}");
    let wild = said(
        &|[_, w, _]| {
            let mut noise = Noise(1);
            let most = w.iter().copied().fold(0.0, f64::max);
            w.iter_mut().for_each(|w| *w = (0.5 * most * (1.0 + noise.normal().clamp(-1.0, 1.0))).max(0.0));
        },
        IndentationOptions { given: Some(Given::Depth), ..default },
    );
    assert!(wild.contains("misfit"), "{wild}");
    let flat = fit_of(MdrProfile::Paraboloid { radius: 0.0 }, (&times, &loads, &depths), default);
    assert!(flat.unwrap_err().to_string().contains("radius"));
}

#[test]
fn any_numbers_are_answered() {
    let mut noise = Noise(9);
    let wild = [0.0, 1.0, -1.0, 1e300, -1e300, 1e-300, 5e-324, 1e-9, 1e9, f64::MAX];
    for round in 0..300 {
        let n = 10 + round % 20;
        let mut draw = |tame: f64| -> Vec<f64> {
            (0..n)
                .map(|_| match noise.uniform() < tame {
                    true => noise.uniform(),
                    false => wild[(noise.uniform() * wild.len() as f64) as usize],
                })
                .collect()
        };
        let (mut times, loads, depths) = (draw(0.5 + 0.5 * (round % 2) as f64), draw(0.9), draw(0.9));
        if round % 3 > 0 {
            times.sort_by(f64::total_cmp);
        }
        let options = IndentationOptions {
            terms: [None, Some(1), Some(2)][round % 3],
            fit_touch: round % 5 == 0,
            springs: 20,
            limit: 1e300,
            ..IndentationOptions::default()
        };
        let profile = match round % 7 {
            0 => MdrProfile::Cone { slope: wild[(round / 7) % wild.len()] },
            1 => MdrProfile::Paraboloid { radius: wild[(round / 7) % wild.len()] },
            _ => SPHERE,
        };
        match fit_of(profile, (&times, &loads, &depths), options) {
            Ok(fit) => assert!(fit.rms.is_finite() && fit.relaxation.validate().is_ok(), "{round}"),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

/// Scaling of a half-space: E ∝ R^(-1/2), and to the unit of load. A layer that is bonded seems softer the thinner it is taken.
#[test]
fn stated_uncertainties_widen_the_intervals() {
    let mut noise = Noise(5);
    let (times, loads, depths) = record(SPHERE, &one_term(), Given::Depth, 1e-4, 300);
    let loads = noisy(&loads, 0.01, &mut noise);
    let fixed = IndentationOptions { terms: Some(1), given: Some(Given::Depth), ..Default::default() };
    let fit = |options| fit_of(SPHERE, (&times, &loads, &depths), options).unwrap();
    let plain = fit(fixed);
    let half = |of: Interval| (of.high / of.value).ln() / WIDTH;
    let added = |wide: Interval, narrow: Interval| (half(wide).powi(2) - half(narrow).powi(2)).sqrt();
    let stated = fit(IndentationOptions { radius_uncertainty: 0.08, load_uncertainty: 0.03, ..fixed });
    // The search ends where the sum of squares falls by 1e-4 or less.
    for (wide, narrow) in [
        (stated.equilibrium, plain.equilibrium),
        (stated.instantaneous, plain.instantaneous),
        (stated.terms[0][0], plain.terms[0][0]),
    ] {
        assert!((added(wide, narrow) - 0.05).abs() < 1e-3, "{}", added(wide, narrow));
    }
    assert!((stated.terms[0][1].high / plain.terms[0][1].high - 1.0).abs() < 1e-3, "{stated:?}");
    // 1e-4 m in a load of 1 N: the deflection of a cantilever of 1e4 N/m. It changes what the fit of the same rows, changed, says.
    let spring = IndentationOptions { spring_constant: Some(1e4), ..fixed };
    let stated = fit(IndentationOptions { sensitivity_uncertainty: 0.02, ..spring });
    let moved: Vec<f64> = depths.iter().zip(&loads).map(|(d, w)| d - 0.02 * w / 1e4).collect();
    let more: Vec<f64> = loads.iter().map(|w| 1.02 * w).collect();
    let there = fit_of(SPHERE, (&times, &more, &moved), spring).unwrap();
    let by = (there.equilibrium.value / plain.equilibrium.value).ln().abs();
    // Linear to a tenth at 2 %.
    assert!((added(stated.equilibrium, plain.equilibrium) / by - 1.0).abs() < 0.1, "{by} {stated:?}");
    let sample = |thickness| Some(SampleLayer { thickness, poisson: 0.5, interface: Interface::Bonded });
    let thin = IndentationOptions { layer: sample(1e-3), ..fixed };
    let [plain, thinner] = [1e-3, 0.98e-3].map(|d| fit(IndentationOptions { layer: sample(d), ..thin }));
    let stated = fit(IndentationOptions { thickness_uncertainty: 0.02, ..thin });
    let by = (plain.equilibrium.value / thinner.equilibrium.value).ln();
    assert!(by > 0.0 && (added(stated.equilibrium, plain.equilibrium) / by - 1.0).abs() < 0.1, "{by}");
    for (options, word) in [
        (IndentationOptions { thickness_uncertainty: 0.1, ..fixed }, "thickness"),
        (IndentationOptions { sensitivity_uncertainty: 0.1, ..fixed }, "sensitivity"),
        (IndentationOptions { radius_uncertainty: f64::NAN, ..fixed }, "radius"),
    ] {
        let error = fit_of(SPHERE, (&times, &loads, &depths), options).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    }
}
