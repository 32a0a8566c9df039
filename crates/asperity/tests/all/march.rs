//! The march against exact histories, invariants that hold on every grid, and itself.

use asperity::Drive;
use asperity::contact::Outcome;
use asperity::drive::March;
use asperity::material::{Creep, CreepTerm, Relaxation, RelaxationTerm};
use asperity::operator::half_space;
use asperity::simulation::{Scheme, Simulation};
use asperity::step::{Checkpoint, Row};
use asperity::surface::{Part, Punch, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{
    Boundary, ContactState, Control, Error, Grid, History, Loading, Method, Prescribed, Problem, Programme,
    Solver, SolverOptions, TimeGrid,
};
use ndarray::Array2;

/// E*(t) = 2 + 2 exp(-t/0.5), C(t) = 1/4 + 1/4 (1 - exp(-t)): the solid of the oracles.
fn zener() -> Creep {
    Creep {
        instantaneous: 0.25,
        terms: vec![CreepTerm { compliance: 0.25, retardation_time: 1.0 }],
        fluidity: 0.0,
    }
}

fn relaxation() -> Relaxation {
    Relaxation {
        equilibrium: 2.0,
        terms: vec![RelaxationTerm { modulus: 2.0, relaxation_time: 0.5 }],
        viscosity: 0.0,
    }
}

fn rough(cells: [usize; 2]) -> Simulation {
    let grid = Grid::new(cells, [1.0, 1.0 * cells[1] as f64 / cells[0] as f64]).unwrap();
    let roughness = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.3),
        longest: 0.5,
        shortest: 0.1,
        roll_off: 0.5,
        seed: 3,
    };
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 2.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[sphere, Part::SelfAffine(roughness)]).unwrap();
    Simulation { creep: zener(), solver: tight(), ..Simulation::new(grid, gap) }
}

fn sphere(n: usize, size: f64) -> Simulation {
    let grid = Grid::new([n, n], [size, size]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[part]).unwrap();
    Simulation { creep: zener(), ..Simulation::new(grid, gap) }
}

fn tight() -> SolverOptions {
    SolverOptions { tolerance: 1e-10, ..SolverOptions::default() }
}

fn load(history: History) -> Programme {
    Loading { control: Control::Load, history }.into()
}

fn run(simulation: Simulation) -> (Vec<Row>, Array2<f64>) {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    let pressure = march.last().unwrap().pressure().to_owned();
    (rows, pressure)
}

fn elastic(simulation: &Simulation, compliance: f64, prescribed: Prescribed) -> (ContactState, Outcome) {
    let mut operator = half_space(simulation.grid, simulation.boundary);
    let mut state = ContactState::new(simulation.grid.len());
    let problem = Problem {
        gap: simulation.gap.as_slice().unwrap(),
        compliance,
        hardness: simulation.hardness.into(),
        prescribed,
    };
    let outcome = Solver::new(Method::ProjectedCg, &*operator)
        .solve(&mut *operator, &problem, &simulation.solver, &mut state, None)
        .unwrap();
    (state, outcome)
}

fn area(state: &ContactState, grid: &Grid) -> f64 {
    state.pressure.iter().filter(|p| **p > 0.0).count() as f64 * grid.cell_area()
}

#[test]
fn growing_contact_equals_one_elastic_solve() {
    // Ramp and hold: at every time approach and contact set are those of the elastic problem with
    // C(0) and the load int C dW / C(0). Exact on any grid for a piecewise linear load.
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let base = Simulation { boundary, ..rough([40, 33]) };
        let ramp = History::Ramp { value: 0.3, duration: 2.0 };
        let times = TimeGrid::List(vec![0.3, 1.0, 2.0, 2.7, 9.0]);
        let (rows, _) = run(Simulation { loading: load(ramp), times, ..base.clone() });
        let creep = zener();
        for row in &rows[1..] {
            let t = row.time();
            let ramped = creep.integral(t) - creep.integral((t - 2.0).max(0.0));
            let effective = 0.15 * ramped / creep.instantaneous;
            let (state, _) = elastic(&base, creep.instantaneous, Prescribed::Load(effective));
            assert!((row.approach / state.approach - 1.0).abs() < 1e-7, "{boundary:?} t = {t}");
            assert_eq!(row.contact_area, area(&state, &base.grid), "{boundary:?} t = {t}");
        }
    }
}

#[test]
fn held_approach_relaxes_every_cell_like_the_modulus() {
    let base = rough([32, 32]);
    let loading = Loading { control: Control::Approach, history: History::Step { value: 0.05 } };
    let (state, _) = elastic(&base, zener().instantaneous, Prescribed::Approach(0.05));
    for steps in [1, 20] {
        let times = TimeGrid::Uniform { end: 2.0, steps };
        let (rows, pressure) = run(Simulation { loading: loading.clone().into(), times, ..base.clone() });
        let factor = relaxation().value(2.0) / relaxation().value(0.0);
        assert_eq!(rows[0].contact_area, rows[steps].contact_area);
        for (p, p0) in pressure.iter().zip(&state.pressure) {
            assert_eq!(*p > 0.0, *p0 > 0.0);
            // Exact in any steps but for the solver, whose tolerance is relative to the mean pressure.
            assert!((p - factor * p0).abs() < 1e-6 * rows[0].max_pressure, "{p} {p0}");
        }
        assert!((rows[steps].load / rows[0].load / factor - 1.0).abs() < 1e-8);
    }
}

#[test]
fn at_long_times_the_contact_is_the_relaxed_elastic_one_capped_or_not() {
    for hardness in [f64::INFINITY, 1.5] {
        for boundary in [Boundary::Free, Boundary::Periodic] {
            let base = Simulation { hardness, boundary, ..rough([36, 36]) };
            let (state, _) = elastic(&base, zener().long_time(), Prescribed::Load(0.2));
            let times = TimeGrid::Logarithmic { end: 200.0, steps: 60, first: 0.01 };
            let (rows, pressure) =
                run(Simulation { loading: load(History::Step { value: 0.2 }), times, ..base });
            let peak = state.pressure.iter().copied().fold(0.0, f64::max);
            for (p, e) in pressure.iter().zip(&state.pressure) {
                assert!((p - e).abs() < 1e-6 * peak, "{hardness} {boundary:?}: {p} against {e}");
            }
            assert!((rows.last().unwrap().approach / state.approach - 1.0).abs() < 1e-7);
        }
    }
}

#[test]
fn a_flat_punch_follows_the_creep_integral_through_jumps_and_unloading() {
    // W jumps by 1 at 0, ramps by 1 over [1, 2], jumps by -1 at 3; the approach of a unit punch is (1/2) int C(t - s) dW(s).
    let grid = Grid::new([48, 48], [2.4, 2.4]).unwrap();
    let punch = Part::Shape { shape: Shape::FlatPunch(Punch::Circle { radius: 1.0 }), center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[punch]).unwrap();
    let points = vec![(0.0, 1.0), (1.0, 1.0), (2.0, 2.0), (3.0, 2.0), (3.0, 1.0)];
    let simulation = Simulation {
        creep: zener(),
        loading: load(History::Table { points }),
        times: TimeGrid::List(vec![0.5, 1.5, 2.5, 3.5, 4.0, 6.0, 10.0]),
        solver: tight(),
        ..Simulation::new(grid, gap)
    };
    let (rows, _) = run(simulation);
    let oracle = [
        (0.0, 0.125),
        (0.5, 0.17418366753592082),
        (1.0, 0.2040150698535697),
        (1.5, 0.2979250624455254),
        (2.0, 0.4040680197418537),
        (2.5, 0.4418143127264872),
        (3.0, 0.4647086464340116),
        (3.0, 0.3397085967121633),
        (3.5, 0.30441101434572293),
        (4.0, 0.283001948426745),
        (6.0, 0.25446632803769353),
        (10.0, 0.250081803651497),
    ];
    assert_eq!(rows.len(), oracle.len());
    // In time the march is exact for any step; the grid's punch is a little off a circle: one factor.
    let factor = rows[0].approach / oracle[0].1;
    assert!((factor - 1.0).abs() < 0.02, "{factor}");
    for (row, (t, delta)) in rows.iter().zip(oracle) {
        assert_eq!(row.time(), t);
        // The value before the jump at 3 s is the oracle's at 2.999999 s, prolonged.
        assert!((row.approach / (factor * delta) - 1.0).abs() < 1e-6, "t = {t}: {}", row.approach / factor);
    }
}

#[test]
fn triangular_load_follows_ting_while_the_contact_shrinks() {
    // Ting's solution in high precision (t, a, approach, largest pressure) for R = W0 = t0 = 1.
    let oracle = [
        (0.5, 0.4844898432716986, 0.23473040823343505, 0.927664608905338),
        (1.0, 0.6353548723995163, 0.4036758138818056, 1.040995764935268),
        (1.25, 0.6091865166254746, 0.375790548771818, 0.898089405814992),
        (1.5, 0.5522081150543112, 0.3288971169956224, 0.7594286407751805),
        (1.75, 0.44731972871928344, 0.260018352185578, 0.5915239952982976),
    ];
    let simulation = Simulation {
        loading: load(History::Triangle { peak: 1.0, rise: 1.0, fall: 1.0 }),
        times: TimeGrid::Uniform { end: 2.0, steps: 80 },
        ..sphere(97, 1.6)
    };
    let mut march = March::new(simulation).unwrap();
    let mut met = 0;
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        let Some((t, a, delta, p0)) = oracle.iter().find(|o| (o.0 - row.time()).abs() < 1e-9) else {
            continue;
        };
        met += 1;
        // h^2 errors of approach and peak: (dx/a)^2 is 7e-4 at the largest contact, 1.4e-3 at the least.
        assert!((row.approach / delta - 1.0).abs() < 1.5e-3, "approach at {t}: {}", row.approach);
        assert!((step.pressure()[(48, 48)] / p0 - 1.0).abs() < 3e-3, "pressure at {t}");
        // Corrected for the perimeter, the area is good to a fraction of a ring of cells.
        let exact = std::f64::consts::PI * a * a;
        assert!((row.contact_area_corrected / exact - 1.0).abs() < 0.5 * 1.6 / 97.0 / a, "area at {t}");
    }
    assert_eq!(met, oracle.len());
    let last = march.last().unwrap().row();
    assert_eq!((last.load, last.contact_area, last.max_pressure), (0.0, 0.0, 0.0));
    // The surface goes on recovering: first touch lies at the oracle's 0.13456 at t = 2.
    assert!((last.approach - 0.13456).abs() < 1e-3, "{}", last.approach);
}

#[test]
fn the_direct_sum_equals_the_constant_scheme_and_all_schemes_converge() {
    let base = Simulation {
        loading: load(History::Triangle { peak: 0.3, rise: 1.0, fall: 1.5 }),
        solver: tight(),
        ..rough([24, 24])
    };
    let at = |scheme, steps| {
        let times = TimeGrid::Uniform { end: 2.0, steps };
        run(Simulation { scheme, times, ..base.clone() }).0.last().unwrap().approach
    };
    let (constant, direct) = (at(Scheme::Constant, 20), at(Scheme::Direct, 20));
    assert!((constant - direct).abs() < 1e-9, "{constant} {direct}");
    let best = at(Scheme::Linear, 640);
    let error = |scheme, steps| (at(scheme, steps) - best).abs();
    let linear = [error(Scheme::Linear, 20), error(Scheme::Linear, 40), error(Scheme::Linear, 80)];
    let first = [error(Scheme::Constant, 20), error(Scheme::Constant, 40)];
    assert!((first[0] / first[1] - 2.0).abs() < 0.3, "{first:?}");
    assert!(linear[0] / linear[2] > 9.0, "{linear:?}");
    assert!(linear[0] < 0.1 * first[0], "{linear:?} {first:?}");
}

#[test]
fn a_march_resumed_from_any_row_gives_the_same_bits() {
    for scheme in [Scheme::Linear, Scheme::Constant, Scheme::Direct] {
        let simulation = Simulation {
            hardness: 2.0,
            scheme,
            loading: load(History::Table { points: vec![(0.0, 0.1), (1.0, 0.3), (1.0, 0.2), (2.0, 0.0)] }),
            times: TimeGrid::Uniform { end: 2.5, steps: 10 },
            ..rough([20, 26])
        };
        let mut march = March::new(simulation.clone()).unwrap();
        let mut checkpoints: Vec<Checkpoint> = vec![march.checkpoint().into_owned()];
        let mut rows = vec![];
        while let Some(step) = march.advance().unwrap() {
            rows.push(step.row());
            checkpoints.push(march.checkpoint().into_owned());
        }
        for at in [0, 1, 5, 6, 11] {
            let mut resumed = March::resume(simulation.clone(), &checkpoints[at]).unwrap();
            let mut rest = vec![];
            while let Some(step) = resumed.advance().unwrap() {
                rest.push(step.row());
            }
            assert_eq!(rest, rows[at..], "{scheme:?} from row {at}");
            assert_eq!(resumed.checkpoint().into_owned(), *checkpoints.last().unwrap());
        }
        let other = rough([20, 25]);
        assert!(matches!(March::resume(other, &checkpoints[3]), Err(Error::Invalid { .. })));
    }
}

#[test]
fn the_same_case_gives_the_same_bits_for_any_number_of_threads() {
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let base = rough([130, 140]);
            run(Simulation {
                hardness: 3.0,
                loading: load(History::Step { value: 0.3 }),
                times: TimeGrid::Uniform { end: 2.0, steps: 3 },
                ..base
            })
        })
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(3));
}

#[test]
fn kelvin_voigt_creeps_without_ringing() {
    // C(t) = 1 - exp(-t): no instantaneous compliance. A ramp, then a hold.
    let kelvin = Creep {
        instantaneous: 0.0,
        terms: vec![CreepTerm { compliance: 1.0, retardation_time: 1.0 }],
        fluidity: 0.0,
    };
    let base = Simulation { creep: kelvin.clone(), ..rough([32, 32]) };
    let ramp = History::Ramp { value: 0.1, duration: 0.5 };
    let simulation = Simulation {
        loading: load(ramp.clone()),
        times: TimeGrid::Uniform { end: 6.0, steps: 60 },
        ..base.clone()
    };
    let (rows, _) = run(simulation);
    assert!(rows.windows(2).all(|r| r[1].approach > r[0].approach), "creep is monotone");
    // While the contact grows it is one elastic contact with L = int C dW, in any steps.
    for row in &rows[1..] {
        let ramped = kelvin.integral(row.time()) - kelvin.integral((row.time() - 0.5).max(0.0));
        let (state, _) = elastic(&base, 1.0, Prescribed::Load(0.2 * ramped));
        assert!((row.approach / state.approach - 1.0).abs() < 1e-6, "t = {}", row.time());
    }
    // Under the held load the pressure falls where the contact has been from the start: at every step, not up and down.
    let held: Vec<f64> = rows.iter().filter(|row| row.time() > 0.55).map(|row| row.max_pressure).collect();
    assert!(held.windows(2).all(|pair| pair[1] < pair[0] * (1.0 + 1e-9)), "{held:?}");
    // A jump of load has no solution at t = 0+.
    let jump = Simulation { loading: load(History::Step { value: 0.1 }), ..base };
    assert!(March::new(jump).is_err());
}

#[test]
fn impossible_simulations_are_refused_before_they_start() {
    let base = rough([20, 20]);
    let refused = |s: Simulation| match March::new(s) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted"),
    };
    let step = |value| load(History::Step { value });
    assert!(refused(Simulation { loading: step(-1.0), ..base.clone() }).contains("not negative"));
    assert!(refused(Simulation { loading: step(f64::NAN), ..base.clone() }).contains("finite"));
    assert!(refused(Simulation { loading: step(2.0), hardness: 1.0, ..base.clone() }).contains("exceeds"));
    assert!(refused(Simulation { times: TimeGrid::List(vec![2.0, 1.0]), ..base.clone() }).contains("later"));
    assert!(refused(Simulation { hardness: 0.0, ..base.clone() }).contains("hardness"));
    let mut gap = base.gap.clone();
    gap[(3, 4)] = f64::NAN;
    assert!(refused(Simulation { gap, ..base.clone() }).contains("(3, 4)"));
    assert!(refused(Simulation { creep: Creep::default(), ..base }).contains("rigid"));
}

#[test]
fn constant_load_never_lets_the_area_shrink() {
    // A theorem for linear viscoelastic, non-adhesive contact, after any drop to a constant load.
    let points = vec![(0.0, 0.4), (1.0, 0.4), (1.0, 0.15)];
    let simulation = Simulation {
        loading: load(History::Table { points }),
        times: TimeGrid::Uniform { end: 8.0, steps: 80 },
        ..rough([48, 48])
    };
    let (rows, _) = run(simulation);
    let after: Vec<f64> = rows.iter().filter(|r| r.time() > 1.0).map(|r| r.contact_area).collect();
    assert!(after.windows(2).all(|a| a[1] >= a[0] - 1e-15), "{after:?}");
    assert!(after.last() > after.first());
}

#[test]
fn a_soft_half_carries_its_hardness() {
    let base = Simulation {
        loading: Loading { control: Control::Load, history: History::Step { value: 0.5 } }.into(),
        hardness: 1.5,
        ..rough([48, 48])
    };
    // The lesser of both holds: 0.7 in one half, 1.5 in the other.
    let map = Array2::from_shape_fn((48, 48), |(i, _)| if i < 24 { 0.7 } else { 9.0 });
    let (rows, pressure) = run(Simulation { hardness_map: Some(map.clone()), ..base.clone() });
    let at = |hardness: f64| {
        pressure.indexed_iter().filter(|((i, _), p)| (*i < 24) == (hardness < 1.0) && **p == hardness).count()
    };
    assert!(at(0.7) > 0 && at(1.5) > 0);
    assert!(pressure.indexed_iter().all(|((i, _), p)| *p <= if i < 24 { 1.0 } else { 4.0 }));
    let last = rows.last().unwrap();
    assert_eq!(last.capped_area, (at(0.7) + at(1.5)) as f64 * base.grid.cell_area());

    let wrong = |map: Array2<f64>| match March::new(Simulation { hardness_map: Some(map), ..base.clone() }) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted"),
    };
    assert!(wrong(Array2::ones((48, 47))).contains("(48, 47)"));
    let mut bad = map;
    bad[(3, 5)] = -1.0;
    assert!(wrong(bad).contains("hardness of cell (3, 5)"));
}
