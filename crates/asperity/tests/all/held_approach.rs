//! Stiff bodies under a held approach, steps of any length: what the solution does exactly, and how fast the rest converges.

use asperity::Drive;
use asperity::drive::March;
use asperity::load::{Course, Stage};
use asperity::material::{Creep, ReducedTime, Relaxation, Shift, ThermalCreep};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{Boundary, Control, Grid, History, Loading, Programme, SolverOptions, TimeGrid};

/// One relaxing term of 1 s whose modulus falls by `ratio`, to 1.
fn one(ratio: f64) -> Relaxation {
    Relaxation::absolute(1.0, &[(ratio - 1.0, 1.0)]).unwrap()
}

/// A rubber: thirteen terms over twelve decades, from 999.2 to 1.
fn rubber() -> Relaxation {
    let moduli = [300.0, 280.0, 200.0, 110.0, 55.0, 27.0, 13.0, 6.5, 3.3, 1.7, 0.9, 0.5, 0.3];
    let terms: Vec<(f64, f64)> = moduli.into_iter().zip(-6..).map(|(e, n)| (e, 10f64.powi(n))).collect();
    Relaxation::absolute(1.0, &terms).unwrap()
}

fn rough(n: usize) -> Simulation {
    let grid = Grid::new([n, n], [1.0, 1.0]).unwrap();
    let roughness = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.3),
        longest: 0.5,
        shortest: 0.15,
        roll_off: 0.5,
        seed: 3,
    };
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 2.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[sphere, Part::SelfAffine(roughness)]).unwrap();
    let solver = SolverOptions { tolerance: 1e-9, ..SolverOptions::default() };
    Simulation { solver, ..Simulation::new(grid, gap) }
}

fn sphere(n: usize) -> Simulation {
    let grid = Grid::new([n, n], [0.5, 0.5]).unwrap();
    let gap =
        undeformed_gap(&grid, &[Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] }])
            .unwrap();
    let solver = SolverOptions { tolerance: 1e-8, ..SolverOptions::default() };
    Simulation { solver, ..Simulation::new(grid, gap) }
}

fn approach(history: History) -> Programme {
    Loading { control: Control::Approach, history }.into()
}

fn rows(simulation: Simulation) -> Vec<Row> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    rows
}

/// Largest |W(t)/W(0) / (E*(t)/E*(0)) - 1|, with E*(t) at the reduced time of `clock`; every row is in contact.
fn off(rows: &[Row], relaxation: &Relaxation, clock: impl Fn(f64) -> f64) -> f64 {
    let exact = |t: f64| relaxation.value(clock(t)) / relaxation.value(0.0);
    rows.iter()
        .map(|row| {
            assert!(row.contact_area == rows[0].contact_area && row.load > 0.0, "{row:?}");
            (row.load / rows[0].load / exact(row.time()) - 1.0).abs()
        })
        .fold(0.0, f64::max)
}

#[test]
fn a_held_approach_relaxes_as_the_modulus_does_in_steps_of_any_length() {
    // Steps of all lengths, without an order.
    let lengths = (1..20).map(|n| 10f64.powf(f64::from(n * n * n % 11) - 6.0));
    let random: Vec<f64> = lengths
        .scan(0.0, |t, dt| {
            *t += dt;
            Some(*t)
        })
        .collect();
    for relaxation in [one(10.0), one(100.0), one(1000.0), rubber()] {
        for times in [
            TimeGrid::Uniform { end: 3.0, steps: 30 },
            TimeGrid::Uniform { end: 100.0, steps: 10 },
            TimeGrid::Uniform { end: 1e4, steps: 10 },
            TimeGrid::Logarithmic { end: 1e4, steps: 25, first: 1e-7 },
            TimeGrid::List(random.clone()),
            TimeGrid::Adaptive { end: 1e3, tolerance: 1e-2, first: 1.0 },
        ] {
            let adaptive = times.is_adaptive();
            let rows = rows(Simulation {
                creep: relaxation.to_creep().unwrap(),
                loading: approach(History::Step { value: 0.03 }),
                times,
                ..rough(16)
            });
            // The solver's tolerance, which holds for each row alone.
            let error = off(&rows, &relaxation, |t| t);
            assert!(error < 1e-7, "{error:e}");
            // Exact but for what the solver leaves of u, which is large against the displacement of a stiff body.
            let stated = rows.iter().filter_map(|row| row.time_error).fold(0.0, f64::max);
            assert!(stated < 1e-4, "{stated:e}");
            assert!(!adaptive || rows.len() < 80, "{} rows", rows.len());
        }
    }
}

#[test]
fn a_held_approach_follows_the_clocks_of_bodies_that_change_their_temperature() {
    let relaxation = rubber();
    let shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 };
    let temperatures = [(0.0, 300.0), (30.0, 300.0), (30.0, 345.0), (60.0, 330.0)];
    let clock = ReducedTime::new(shift, &temperatures).unwrap();
    let thermal = vec![ThermalCreep { creep: relaxation.to_creep().unwrap(), clock: clock.clone() }];
    let held = Simulation {
        creep: Creep::default(),
        thermal,
        loading: approach(History::Step { value: 0.03 }),
        ..rough(16)
    };
    for times in [
        TimeGrid::Uniform { end: 100.0, steps: 10 },
        TimeGrid::Adaptive { end: 100.0, tolerance: 1e-3, first: 1.0 },
    ] {
        let rows = rows(Simulation { times, ..held.clone() });
        let error = off(&rows, &relaxation, |t| clock.value(t));
        assert!(error < 1e-7, "{error:e}");
    }
    // Two bodies at two temperatures that stay: the pair is one material in laboratory time.
    let (first, second) = (one(100.0).to_creep().unwrap(), one(1000.0).to_creep().unwrap());
    let body = |creep: &Creep, shift: Shift, temperature| ThermalCreep {
        creep: creep.clone(),
        clock: ReducedTime::new(shift, &[(0.0, temperature)]).unwrap(),
    };
    let (wlf, arrhenius) = (
        Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 },
        Shift::Arrhenius { activation_energy: 1e5, reference: 300.0 },
    );
    let pair = first
        .stretched(wlf.factor(320.0).unwrap())
        .sum(&second.stretched(arrhenius.factor(290.0).unwrap()))
        .to_relaxation()
        .unwrap();
    let thermal = vec![body(&first, wlf, 320.0), body(&second, arrhenius, 290.0)];
    let rows = rows(Simulation { thermal, times: TimeGrid::Uniform { end: 100.0, steps: 10 }, ..held });
    let error = off(&rows, &pair, |t| t);
    assert!(error < 1e-7, "{error:e}");
}

#[test]
fn two_bodies_whose_clocks_change_against_each_other_relax_at_a_held_approach() {
    // Of two such bodies no closed form is known; in many short steps the rates hardly change within one.
    let wlf = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 };
    let clock = |to| ReducedTime::new(wlf.clone(), &[(0.0, 300.0), (1.0, to), (2.0, 300.0)]).unwrap();
    let thermal = vec![
        ThermalCreep { creep: one(100.0).to_creep().unwrap(), clock: clock(310.0) },
        ThermalCreep { creep: one(20.0).to_creep().unwrap(), clock: clock(295.0) },
    ];
    let at = |steps| {
        let times = TimeGrid::Uniform { end: 2.0, steps };
        let loading = approach(History::Step { value: 0.03 });
        let rows = rows(Simulation {
            creep: Creep::default(),
            thermal: thermal.clone(),
            times,
            loading,
            ..rough(16)
        });
        assert!(
            rows.windows(2)
                .all(|pair| pair[1].load < pair[0].load && pair[1].contact_area == pair[0].contact_area)
        );
        rows[steps / 2].load / rows[0].load
    };
    let [coarse, middle, fine] = [10, 20, 160].map(at);
    // Second order in the change of the rates.
    let order = ((coarse - fine) / (middle - fine)).abs().log2();
    assert!(order > 1.7 && (coarse / fine - 1.0).abs() < 0.05, "{coarse} {middle} {fine}");
}

#[test]
fn a_load_then_a_held_approach_give_the_load_of_the_elastic_contact_seen_through_the_modulus() {
    // W0 for 20 s, then the approach is held: W(t) = int E*(t - s) dL(s) with L = W0 C(s) up to 20 s. By quadrature with
    // mpmath: load over W0 at some times.
    let oracle: [(Relaxation, [(f64, f64); 4]); 3] = [
        (
            one(100.0),
            [
                (20.2, 0.028129242292525947 / 0.032974),
                (22.0, 0.00986422753692772 / 0.032974),
                (30.0, 0.0062483538240739695 / 0.032974),
                (1000.0, 0.0062471404265265615 / 0.032974),
            ],
        ),
        (
            one(1000.0),
            [
                (20.2, 0.24725106502008315 / 0.30061),
                (22.0, 0.046084816138816584 / 0.30061),
                (30.0, 0.006260498393863954 / 0.30061),
                (1000.0, 0.006247134340439047 / 0.30061),
            ],
        ),
        (
            rubber(),
            [
                (20.2, 0.05589128349631677 / 0.056615),
                (22.0, 0.05306694696751517 / 0.056615),
                (30.0, 0.04690774416205341 / 0.056615),
                (1000.0, 0.020226297813888957 / 0.056615),
            ],
        ),
    ];
    for (relaxation, exact) in oracle {
        let creep = relaxation.to_creep().unwrap();
        let programme = Programme::new(vec![
            Stage {
                duration: Some(20.0),
                ..Stage::new(Control::Load, History::Step { value: 0.03 * creep.value(0.0).recip() / 100.0 })
            },
            Stage { duration: Some(980.0), ..Stage::new(Control::Approach, Course::Hold) },
            Stage::new(Control::Load, Course::Hold),
        ]);
        for first in [vec![20.0], vec![0.2, 1.0, 4.0, 20.0]] {
            let mut times = first;
            times.extend([20.2, 22.0, 30.0, 1000.0, 3000.0]);
            let rows = rows(Simulation {
                creep: creep.clone(),
                loading: programme.clone(),
                times: TimeGrid::List(times),
                ..sphere(24)
            });
            for (t, ratio) in exact {
                let row = rows.iter().find(|row| row.time() == t).unwrap();
                // Nine digits are known of W0; the solver's tolerance.
                assert!(
                    (row.load / rows[0].load / ratio - 1.0).abs() < 1e-6,
                    "{t}: {}",
                    row.load / rows[0].load
                );
            }
            // Back under load the contact grows again, or stands where all has relaxed.
            let [before, last] = [rows[rows.len() - 2], rows[rows.len() - 1]];
            assert!((last.load / before.load - 1.0).abs() < 1e-9);
            assert!(last.approach >= before.approach * (1.0 - 1e-7));
        }
    }
}

/// Root mean square error of the load from `start` on, over the load and a tenth of the relaxed one.
fn orders(
    relaxation: &Relaxation,
    points: &[(f64, f64)],
    start: f64,
    steps: [usize; 3],
    fine: usize,
) -> [f64; 3] {
    let end = points[points.len() - 1].0;
    let run = |steps: usize| {
        rows(Simulation {
            creep: relaxation.to_creep().unwrap(),
            loading: approach(History::Table { points: points.to_vec() }),
            times: TimeGrid::Uniform { end, steps },
            ..sphere(32)
        })
    };
    let best = run(fine);
    let relaxed = 4.0 / 3.0 * 0.04f64.powf(1.5) * relaxation.equilibrium;
    steps.map(|steps| {
        let found = run(steps);
        let error = |row: &Row| {
            let exact = best.iter().find(|b| (b.time() - row.time()).abs() < 1e-9 * end).unwrap().load;
            (row.load - exact).abs() / (exact + 0.1 * relaxed)
        };
        // On the rows of the coarsest steps.
        let every = end / (fine / (fine / steps).max(1)).min(16) as f64;
        let common = |row: &&Row| {
            row.time() >= start && (row.time() / every).fract().min(1.0 - (row.time() / every).fract()) < 1e-6
        };
        let errors: Vec<f64> = found.iter().filter(common).map(error).collect();
        (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
    })
}

#[test]
fn a_ramp_and_hold_are_of_second_order_however_stiff_the_body() {
    for relaxation in [one(100.0), one(1000.0)] {
        let ramp = [(0.0, 0.0), (5.0, 0.04), (8.0, 0.04)];
        let errors = orders(&relaxation, &ramp, 5.0, [16, 32, 64], 512);
        println!("{errors:?}");
        for pair in errors.windows(2) {
            assert!((pair[0] / pair[1]).log2() > 1.6, "{errors:?}");
        }
        assert!(errors[2] < 0.02, "{errors:?}");
    }
}

#[test]
fn pressed_held_retracted_and_touched_again_nothing_is_lost_that_is_there() {
    // Loads of a sphere on the row of springs, by 2000 springs; approach linear through the knots.
    let knots = vec![
        (0.0, 0.0),
        (20.0, 0.04),
        (80.0, 0.04),
        (100.0, 0.0),
        (120.0, 0.0),
        (140.0, 0.04),
        (180.0, 0.04),
    ];
    let springs: [(f64, &[(f64, f64)]); 2] = [
        (
            100.0,
            &[
                (10.0, 0.0568),
                (20.0, 0.08783),
                (25.0, 0.011187),
                (80.0, 0.0106667),
                (90.0, 0.0),
                (135.0, 0.04678),
                (140.0, 0.08502),
                (180.0, 0.0106667),
            ],
        ),
        (
            1000.0,
            &[
                (10.0, 0.5389),
                (20.0, 0.7893),
                (25.0, 0.015913),
                (80.0, 0.0106667),
                (90.0, 0.0),
                (130.0, 0.0),
                (140.0, 0.4142),
                (180.0, 0.0106667),
            ],
        ),
    ];
    for (ratio, loads) in springs {
        for times in [
            TimeGrid::Uniform { end: 180.0, steps: 360 },
            TimeGrid::Adaptive { end: 180.0, tolerance: 1e-2, first: 1.0 },
        ] {
            let adaptive = times.is_adaptive();
            let mut march = March::new(Simulation {
                creep: one(ratio).to_creep().unwrap(),
                loading: approach(History::Table { points: knots.clone() }),
                times,
                include: loads.iter().map(|l| l.0).collect(),
                ..sphere(48)
            })
            .unwrap();
            let (mut compared, mut count) = (0, 0);
            let largest = loads.iter().map(|l| l.1).fold(0.0, f64::max);
            while let Some(row) = march.advance().unwrap().map(|step| step.row()) {
                count += 1;
                if adaptive {
                    assert!(row.time_error.is_some_and(|error| (0.0..=1e-2).contains(&error)), "{row:?}");
                }
                for (t, load) in loads.iter().filter(|l| l.0 == row.time()) {
                    let found = row.load;
                    // 1 % of the grid (20 cells to the radius), 1 % of the steps; of what is relaxed the grid's alone.
                    let allowed = 0.01 * load + 0.01 * largest * f64::from(u8::from(*load > 0.02));
                    assert!((found - load).abs() <= allowed.max(1e-12), "{ratio} {t}: {found} {load}");
                    compared += 1;
                }
            }
            println!("{ratio} {count} rows");
            assert_eq!(compared, loads.len());
        }
    }
}

/// The largest errors of load and largest pressure in the rows of adaptive steps, over their largest values; the reference
/// takes each step in eight. And the number of rows.
fn errors_of_adaptive_steps(base: &Simulation, end: f64, tolerance: f64) -> ([f64; 2], usize) {
    let times = TimeGrid::Adaptive { end, tolerance, first: end };
    let found = rows(Simulation { times, ..base.clone() });
    let parts = found.windows(2).filter(|pair| pair[1].time() > pair[0].time()).flat_map(|pair| {
        let [a, b] = [pair[0].time(), pair[1].time()];
        (1..=8).map(move |n| if n == 8 { b } else { a + (b - a) * f64::from(n) / 8.0 })
    });
    let fine = rows(Simulation { times: TimeGrid::List(parts.collect()), ..base.clone() });
    let largest = |of: fn(&Row) -> f64| fine.iter().map(of).fold(0.0, f64::max);
    let (load, peak) = (largest(|row| row.load), largest(|row| row.max_pressure));
    let mut worst = [0.0_f64; 2];
    for row in &found {
        let same = |other: &&Row| (other.time() - row.time()).abs() <= 1e-12 * row.time();
        let exact = fine.iter().rfind(same).unwrap();
        worst[0] = worst[0].max((row.load - exact.load).abs() / load);
        worst[1] = worst[1].max((row.max_pressure - exact.max_pressure).abs() / peak);
        assert!(row.time_error.is_some_and(|error| error.is_finite()), "{row:?}");
    }
    (worst, found.len())
}

#[test]
fn adaptive_steps_hold_their_tolerance_in_load_and_largest_pressure() {
    let press = vec![(0.0, 0.0), (2.0, 0.04), (6.0, 0.04), (7.0, 0.036), (9.0, 0.036)];
    let held = vec![(0.0, 0.02)];
    for (control, points, end) in [(Control::Approach, press, 9.0), (Control::Load, held, 300.0)] {
        for relaxation in [one(100.0), rubber()] {
            let base = Simulation {
                creep: relaxation.to_creep().unwrap(),
                loading: Loading { control, history: History::Table { points: points.clone() } }.into(),
                boundary: Boundary::Free,
                ..sphere(24)
            };
            for tolerance in [1e-2, 1e-3] {
                let ([load, pressure], rows) = errors_of_adaptive_steps(&base, end, tolerance);
                println!("{control:?} {tolerance}: {rows} rows, {load} {pressure}");
                // The largest pressure is that of one cell of the rim, which a step may meet as it begins to touch.
                let within = load <= tolerance && pressure <= 2.0 * tolerance;
                assert!(within, "{control:?} {tolerance}: {load} {pressure}");
            }
        }
    }
}

/// In a contact of a few cells a whole ring of cells touches at once. Cells that touch move faster than their displacement over
/// the step says; without that in the estimate the load is wrong by up to 4 tolerances here.
#[test]
fn a_ring_of_cells_that_touches_shortens_the_steps() {
    let points = vec![(0.0, 0.0), (2.0, 0.0125), (6.0, 0.0125), (7.0, 0.0109), (9.0, 0.0109)];
    for ratio in [100.0, 1000.0] {
        let base = Simulation {
            // a relaxation time far below the steps
            creep: Relaxation::absolute(1.0, &[(ratio - 1.0, 1.0 / ratio)]).unwrap().to_creep().unwrap(),
            loading: approach(History::Table { points: points.clone() }),
            ..sphere(16)
        };
        for tolerance in [1e-2, 1e-3] {
            let ([load, _], rows) = errors_of_adaptive_steps(&base, 9.0, tolerance);
            println!("{ratio} {tolerance}: {rows} rows, {load}");
            assert!(load <= tolerance, "{ratio} {tolerance}: {load}");
            // The retreat alone lasts 1000 relaxation times.
            assert!(rows < 450, "{rows} rows");
        }
    }
}
