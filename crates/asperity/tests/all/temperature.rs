//! Bodies whose temperature changes: the march in reduced time.

use asperity::Drive;
use asperity::drive::March;
use asperity::material::{Creep, CreepTerm, ReducedTime, Shift, ThermalCreep};
use asperity::operator::half_space;
use asperity::simulation::{Scheme, Simulation};
use asperity::step::Row;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{
    ContactState, Control, Grid, History, Loading, Method, Prescribed, Problem, Programme, Solver,
    SolverOptions, TimeGrid,
};

fn rough() -> Simulation {
    let grid = Grid::new([40, 33], [1.0, 0.8]).unwrap();
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
    let solver = SolverOptions { tolerance: 1e-10, ..SolverOptions::default() };
    Simulation { solver, creep: Creep::default(), ..Simulation::new(grid, gap) }
}

fn creep(instantaneous: f64, terms: &[(f64, f64)], fluidity: f64) -> Creep {
    let terms =
        terms.iter().map(|&(compliance, retardation_time)| CreepTerm { compliance, retardation_time });
    Creep { instantaneous, terms: terms.collect(), fluidity }
}

fn polymer() -> Creep {
    creep(0.2, &[(0.1, 0.3), (0.2, 4.0)], 0.01)
}

fn wlf() -> Shift {
    Shift::Wlf { c1: 8.86, c2: 101.6, reference: 300.0 }
}

fn arrhenius() -> Shift {
    Shift::Arrhenius { activation_energy: 120e3, reference: 310.0 }
}

fn clock(shift: Shift, temperatures: &[(f64, f64)]) -> ReducedTime {
    ReducedTime::new(shift, temperatures).unwrap()
}

/// A jump up, a ramp down.
const TEMPERATURES: [(f64, f64); 4] = [(0.0, 295.0), (1.0, 295.0), (1.0, 312.0), (3.0, 300.0)];

fn load(history: History) -> Programme {
    Loading { control: Control::Load, history }.into()
}

fn run(simulation: Simulation) -> Vec<Row> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    rows
}

/// Approach of the elastic contact of that compliance.
fn elastic(simulation: &Simulation, compliance: f64, load: f64) -> f64 {
    let mut operator = half_space(simulation.grid, simulation.boundary);
    let mut state = ContactState::new(simulation.grid.len());
    let problem = Problem {
        gap: simulation.gap.as_slice().unwrap(),
        compliance,
        hardness: simulation.hardness.into(),
        prescribed: Prescribed::Load(load),
    };
    Solver::new(Method::ProjectedCg, &*operator)
        .solve(&mut *operator, &problem, &simulation.solver, &mut state, None)
        .unwrap();
    state.approach
}

#[test]
fn a_constant_temperature_scales_the_time() {
    // Two bodies with shifts of their own, loaded and unloaded: the clocks give what stretched times give.
    let history = History::Triangle { peak: 0.3, rise: 1.0, fall: 1.5 };
    let times = TimeGrid::Uniform { end: 3.0, steps: 12 };
    let (hot, other) = (creep(0.1, &[(0.3, 1.5)], 0.0), polymer());
    let (first, second) = (wlf().factor(307.0).unwrap(), arrhenius().factor(307.0).unwrap());
    for scheme in [Scheme::Linear, Scheme::Constant, Scheme::Direct] {
        let base = Simulation { loading: load(history.clone()), times: times.clone(), scheme, ..rough() };
        let stretched =
            Simulation { creep: hot.stretched(first).sum(&other.stretched(second)), ..base.clone() };
        let at = [(0.0, 307.0)];
        let thermal = vec![
            ThermalCreep { creep: hot.clone(), clock: clock(wlf(), &at) },
            ThermalCreep { creep: other.clone(), clock: clock(arrhenius(), &at) },
        ];
        for (a, b) in run(stretched).iter().zip(&run(Simulation { thermal, ..base })) {
            // Equal but for rounding, which the solver's tolerance hides.
            assert!((a.approach - b.approach).abs() < 1e-8 * 0.3, "{scheme:?} {} {}", a.approach, b.approach);
        }
    }
}

#[test]
fn under_a_held_load_the_approach_follows_the_reduced_time_whatever_the_temperature() {
    // A growing contact is one elastic solve with C(0) and the load W C/C(0): exact on any grid, for any
    // steps, here with a jump, a ramp, an elastic counter-body, and two bodies on clocks of their own.
    let base = rough();
    let second = creep(0.05, &[(0.1, 2.0)], 0.0);
    let (c1, c2) = (clock(wlf(), &TEMPERATURES), clock(arrhenius(), &TEMPERATURES));
    let simulation = Simulation {
        creep: Creep::elastic(0.03),
        thermal: vec![
            ThermalCreep { creep: polymer(), clock: c1.clone() },
            ThermalCreep { creep: second.clone(), clock: c2.clone() },
        ],
        loading: load(History::Step { value: 0.2 }),
        times: TimeGrid::List(vec![0.4, 1.7, 4.0, 9.0]),
        ..base.clone()
    };
    let rows = run(simulation);
    let times: Vec<f64> = rows.iter().map(|row| row.time()).collect();
    assert_eq!(times, [0.0, 0.4, 1.0, 1.7, 3.0, 4.0, 9.0], "breaks of the temperature are steps");
    for row in &rows {
        let now = 0.03 + polymer().value(c1.value(row.time())) + second.value(c2.value(row.time()));
        let approach = elastic(&base, 0.28, 0.2 * now / 0.28);
        assert!((row.approach / approach - 1.0).abs() < 1e-7, "t = {}", row.time());
    }
}

#[test]
fn the_linear_scheme_keeps_its_order_while_the_temperature_climbs() {
    // Load and temperature ramp together: the load runs linearly in t, the scheme takes it linear in xi.
    let base = Simulation { creep: Creep::default(), ..rough() };
    let warm = clock(wlf(), &[(0.0, 290.0), (2.0, 310.0)]);
    // (1/C0) int C(xi(2) - xi(s)) dW(s) by the midpoint rule, error 1e-8.
    let n = 4000;
    let sum: f64 = (0..n)
        .map(|k| 2.0 * (f64::from(k) + 0.5) / f64::from(n))
        .map(|s| polymer().value(warm.elapsed(s, 2.0)))
        .sum();
    let exact = elastic(&base, 0.2, 0.3 * sum / f64::from(n) / 0.2);
    let error = |steps: usize, scheme: Scheme| {
        let rows = run(Simulation {
            thermal: vec![ThermalCreep { creep: polymer(), clock: warm.clone() }],
            loading: load(History::Ramp { value: 0.3, duration: 2.0 }),
            times: TimeGrid::Uniform { end: 2.0, steps },
            scheme,
            ..base.clone()
        });
        (rows[steps].approach / exact - 1.0).abs()
    };
    let [coarse, fine] = [8, 16].map(|steps| error(steps, Scheme::Linear));
    assert!(coarse < 5e-3 && ((coarse / fine).log2() - 2.0).abs() < 0.15, "{coarse:e} {fine:e}");
    // The direct sum is the constant scheme; both are of first order.
    let [constant, direct] = [Scheme::Constant, Scheme::Direct].map(|scheme| error(8, scheme));
    assert!((constant / direct - 1.0).abs() < 1e-5 && constant > coarse, "{constant:e} {direct:e}");
}

#[test]
fn a_resumed_march_gives_the_same_bits_with_clocks() {
    for scheme in [Scheme::Linear, Scheme::Direct] {
        let simulation = Simulation {
            creep: creep(0.02, &[(0.1, 1.0)], 0.0),
            thermal: vec![ThermalCreep { creep: polymer(), clock: clock(wlf(), &TEMPERATURES) }],
            loading: load(History::Triangle { peak: 0.3, rise: 1.0, fall: 2.5 }),
            times: TimeGrid::Uniform { end: 4.0, steps: 8 },
            scheme,
            ..rough()
        };
        let whole = run(simulation.clone());
        for stop in [1, 4, 6] {
            let mut march = March::new(simulation.clone()).unwrap();
            for _ in 0..stop {
                march.advance().unwrap();
            }
            let mut march = March::resume(simulation.clone(), &march.checkpoint()).unwrap();
            let mut rows = vec![];
            while let Some(step) = march.advance().unwrap() {
                rows.push(step.row());
            }
            assert_eq!(rows, whole[stop..], "{scheme:?} from row {stop}");
        }
        // Without its clock the memory is another one.
        let march = March::new(simulation.clone()).unwrap();
        let mut plain = march.checkpoint();
        plain.numbers.retain(|(name, _)| !name.starts_with("step/history"));
        if scheme == Scheme::Linear {
            assert!(March::resume(simulation, &plain).is_err());
        }
    }
}

#[test]
fn kelvin_voigt_bodies_on_a_clock_still_refuse_a_jump() {
    let body = ThermalCreep { creep: creep(0.0, &[(1.0, 1.0)], 0.0), clock: clock(wlf(), &TEMPERATURES) };
    let simulation =
        Simulation { thermal: vec![body], loading: load(History::Step { value: 0.1 }), ..rough() };
    let error = March::new(simulation.clone()).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("no instantaneous compliance"), "{error}");
    let ramp = load(History::Ramp { value: 0.1, duration: 0.5 });
    assert!(March::new(Simulation { loading: ramp, ..simulation }).is_ok());
}
