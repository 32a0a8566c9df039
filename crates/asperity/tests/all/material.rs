//! Materials from outside: the reference numbers for PMMA, and any input whatsoever.

use asperity::material::*;
use proptest::collection::vec;
use proptest::num::f64::ANY;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Numbers of ordinary and of any size.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![4 => (-12.0..12.0f64).prop_map(|d| 10f64.powf(d)), 1 => ANY, 1 => Just(0.0)]
}

fn pairs(most: usize) -> impl Strategy<Value = Vec<(f64, f64)>> {
    vec((number(), number()), 0..most)
}

#[test]
fn pmma_creeps_as_the_reference_says() {
    // D(t) of SC17 eq. (23) in 1/MPa, converted with more digits by another program.
    let terms = [(4.4740623274467175e-05, 9.936295903145377), (6.0727249803689646e-05, 133.87048745620586)];
    let rows = [
        (0.0, 0.0004013744989441442),
        (10.0, 0.0004341321352071854),
        (50.0, 0.00046475038622793364),
        (100.0, 0.0004780684899735997),
        (200.0, 0.0004932104906804132),
        (500.0, 0.000505392552089546),
        (1000.0, 0.0005068077586017327),
    ];
    let pmma = Relaxation::absolute(1973.0, &[(254.776, 8.93), (263.6628, 117.96)]).unwrap();
    let creep = Material::prony(Modulus::Young, pmma).unwrap().creep().clone();
    // All are given with 16 digits; the weights lose the digit by which root and pole agree.
    let same = |found: f64, given: f64| (found / given - 1.0).abs() < 1e-14;
    assert_eq!(creep.terms.len(), terms.len());
    for (term, (compliance, time)) in creep.terms.iter().zip(terms) {
        assert!(same(term.compliance, compliance) && same(term.retardation_time, time), "{term:?}");
    }
    for (t, compliance) in rows {
        assert!(same(creep.value(t), compliance), "{t}");
    }
}

proptest! {
    // A fixed seed: the same cases in every run.
    #![proptest_config(ProptestConfig {
        cases: 300,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_prony_table_converts_or_is_refused(
        equilibrium in number(), viscosity in number(), terms in pairs(8), bulk in number()
    ) {
        let terms = terms.iter().map(|&(modulus, relaxation_time)| RelaxationTerm { modulus, relaxation_time });
        let relaxation = Relaxation { equilibrium, viscosity, terms: terms.collect() };
        if let Ok(creep) = relaxation.to_creep() {
            prop_assert!(creep.validate().is_ok() && creep.value(1.0) >= 0.0);
            if let Ok(material) = Material::prony(Modulus::Young, relaxation) {
                let lateral = Lateral::BulkModulus(bulk);
                let body = Body { name: "any".into(), material, lateral, hardness: None };
                if let Ok(creep) = body.contact_creep() {
                    prop_assert!(creep.validate().is_ok());
                }
            }
        }
    }

    #[test]
    fn any_table_is_fitted_or_refused(points in pairs(12), third in vec(number(), 0..12)) {
        let (mut x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        x.sort_by(f64::total_cmp);
        let options = FitOptions::default();
        if let Ok(fit) = fit_relaxation(&x, &y, &options) {
            prop_assert!(fit.function.validate().is_ok() && fit.misfit.max.is_finite());
        }
        if let Ok(fit) = fit_creep(&x, &y, &options) {
            prop_assert!(fit.function.validate().is_ok() && fit.misfit.max.is_finite());
        }
        if let Ok(fit) = fit_dma(&x, &y, &third, &options) {
            prop_assert!(fit.function.validate().is_ok() && fit.misfit.max.is_finite());
        }
        let _ = CreepTable::new(&x, &y).map(|table| table.integral(1.0));
    }

    #[test]
    fn any_temperature_history_is_integrated_or_refused(
        c1 in number(), c2 in number(), reference in number(), temperatures in pairs(6), t in number()
    ) {
        let mut temperatures = temperatures;
        temperatures.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(first) = temperatures.first_mut() {
            first.0 = 0.0;
        }
        for shift in [
            Shift::Wlf { c1, c2, reference },
            Shift::Arrhenius { activation_energy: c1, reference },
            Shift::Table { points: vec![(c1, c2), (reference, c1)] },
        ] {
            if let Ok(clock) = ReducedTime::new(shift, &temperatures) {
                prop_assert!(clock.value(t) >= 0.0 || t.is_nan());
            }
        }
    }

    #[test]
    fn any_fractional_model_is_summed_or_refused(
        modulus in number(), other in number(), time in number(), order in 0.001..1.0f64
    ) {
        for model in [
            Fractional::Springpot { modulus, time, order },
            Fractional::Maxwell { modulus, time, order },
            Fractional::Zener { equilibrium: modulus, instantaneous: other, time, order },
        ] {
            if let Ok(sum) = model.to_prony([0.1, 10.0], 1e-2) {
                prop_assert!(sum.error <= 1e-2 && sum.creep.validate().is_ok());
            }
        }
    }
}
