//! Steps that follow their error, the rows at the times asked for, and marches resumed on the way.

use asperity::Drive;
use asperity::contact::Hardness;
use asperity::drive::March;
use asperity::load::{Control, Course, Event, History, Loading, Programme, Stage};
use asperity::material::{Creep, CreepTerm};
use asperity::operator::half_space;
use asperity::quantities::RowNumber;
use asperity::simulation::{Scheme, Simulation};
use asperity::step::{Checkpoint, Row};
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{ContactState, Grid, Method, Prescribed, Problem, Solver, SolverOptions, TimeGrid};
use ndarray::Array2;

/// Three terms over five decades.
fn creep() -> Creep {
    let term = |compliance, retardation_time| CreepTerm { compliance, retardation_time };
    Creep { instantaneous: 0.2, terms: vec![term(0.3, 1e-2), term(0.4, 1.0), term(0.5, 1e3)], fluidity: 0.0 }
}

fn sphere(n: usize) -> Simulation {
    let grid = Grid::new([n, n], [1.0, 1.0]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[part]).unwrap();
    let solver = SolverOptions { tolerance: 1e-9, ..SolverOptions::default() };
    Simulation { creep: creep(), solver, ..Simulation::new(grid, gap) }
}

fn load(history: History) -> Programme {
    Loading { control: Control::Load, history }.into()
}

fn adaptive(end: f64, tolerance: f64, first: f64) -> TimeGrid {
    TimeGrid::Adaptive { end, tolerance, first }
}

fn rows(simulation: Simulation) -> Vec<Row> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    rows
}

/// Largest difference of the approach to that of steps of a twentieth, over the largest approach.
fn beside_finer(rows: &[Row], run: impl Fn(TimeGrid) -> Vec<Row>) -> f64 {
    let steps = rows.windows(2).filter(|pair| pair[1].time() > pair[0].time());
    let parts = |pair: &[Row]| {
        let [start, end] = [pair[0].time(), pair[1].time()];
        (1..=20).map(move |n| start + (end - start) * f64::from(n) / 20.0)
    };
    let fine = run(TimeGrid::List(steps.flat_map(parts).collect()));
    let deepest = fine.iter().map(|row| row.approach).fold(0.0, f64::max);
    let mut rest = &fine[..];
    let mut worst = 0.0_f64;
    for row in rows {
        // The same instant; of a jump's two rows the same.
        let same = |a: &Row| (a.time() - row.time()).abs() <= 1e-12 * row.time();
        let found = rest.iter().position(same).unwrap();
        worst = worst.max((row.approach - rest[found].approach).abs() / deepest);
        rest = &rest[found + 1..];
    }
    worst
}

/// The elastic contact of this compliance under the load.
fn elastic(simulation: &Simulation, compliance: f64, load: f64) -> ContactState {
    let mut operator = half_space(simulation.grid, simulation.boundary);
    let mut state = ContactState::new(simulation.grid.len());
    let problem = Problem {
        gap: simulation.gap.as_slice().unwrap(),
        compliance,
        hardness: Hardness::Uniform(f64::INFINITY),
        prescribed: Prescribed::Load(load),
    };
    let mut solver = Solver::new(Method::ProjectedCg, &*operator);
    solver.solve(&mut *operator, &problem, &simulation.solver, &mut state, None).unwrap();
    state
}

#[test]
fn eight_decades_of_time_take_at_most_eighty_steps_to_a_thousandth() {
    let base = sphere(32);
    let times = adaptive(1e5, 1e-3, 1e-3);
    let run = |loading: Programme| rows(Simulation { loading, times: times.clone(), ..base.clone() });
    // While the contact grows the approach is that of one elastic contact with C(t), on every grid.
    let crept = run(load(History::Step { value: 0.01 }));
    let exact = |row: &Row| elastic(&base, creep().value(row.time()), 0.01).approach;
    let creep_error = crept.iter().map(|row| (row.approach / exact(row) - 1.0).abs()).fold(0.0, f64::max);
    // Held at its approach the load goes as E*(t).
    let relaxation = creep().to_relaxation().unwrap();
    let history = History::Step { value: 0.03 };
    let relaxed = run(Loading { control: Control::Approach, history }.into());
    let exact = |row: &Row| relaxed[0].load * relaxation.value(row.time()) / relaxation.value(0.0);
    let load_error = relaxed.iter().map(|row| (row.load / exact(row) - 1.0).abs()).fold(0.0, f64::max);
    // Unloaded halfway: the load jumps down at 0.1 s. Against steps of a twentieth.
    let points = vec![(0.0, 0.01), (0.1, 0.01), (0.1, 0.003)];
    let step_down = load(History::Table { points });
    let unloaded = run(step_down.clone());
    let finer = |times| rows(Simulation { loading: step_down.clone(), times, ..base.clone() });
    let unload_error = beside_finer(&unloaded, finer);
    println!(
        "{} {} {} rows, {creep_error:e} {load_error:e} {unload_error:e}",
        crept.len(),
        relaxed.len(),
        unloaded.len()
    );
    assert!(crept.len() <= 81 && unloaded.len() <= 81, "{} {} rows", crept.len(), unloaded.len());
    // A load that relaxes is harder.
    assert!(relaxed.len() <= 110, "{} rows", relaxed.len());
    for rows in [&crept, &relaxed] {
        // Every step says its error, the first as well; none is above the tolerance.
        assert!(rows.iter().all(|row| row.time_error.is_some_and(|error| (0.0..1e-3).contains(&error))));
        // Steps grow at most twofold (the last but one may be half of the rest).
        let dt: Vec<f64> = rows.windows(2).map(|pair| pair[1].time() - pair[0].time()).collect();
        assert!(dt.windows(2).all(|pair| pair[1] < 2.3 * pair[0]), "{dt:?}");
    }
    assert!(creep_error < 1e-6, "exact but for the solver: {creep_error:e}");
    assert!(load_error < 1e-3, "{load_error:e}");
    assert!(unload_error < 1e-3, "{unload_error:e}");
}

#[test]
fn a_tighter_tolerance_gives_a_smaller_error_and_breaks_are_hit() {
    let base = sphere(32);
    let history =
        History::Table { points: vec![(0.0, 0.0), (3.0, 0.01), (8.0, 0.01), (8.0, 0.02), (40.0, 0.002)] };
    let run = |times| rows(Simulation { loading: load(history.clone()), times, ..base.clone() });
    let mut errors = vec![];
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let rows = run(adaptive(40.0, tolerance, 1e-3));
        for t in [3.0, 8.0, 40.0] {
            assert!(rows.iter().any(|row| row.time() == t), "{t}");
        }
        assert_eq!(rows.iter().filter(|row| row.time() == 8.0).count(), 2);
        let error = beside_finer(&rows, run);
        println!("{tolerance}: {} rows, {error:e}", rows.len());
        assert!(error < tolerance, "{tolerance}: {error:e}");
        errors.push(error);
    }
    assert!(errors[2] < 0.2 * errors[0], "{errors:?}");
}

/// The pressure at the times that steps must end at.
fn pressures(simulation: Simulation) -> Vec<Array2<f64>> {
    let mut march = March::new(simulation.clone()).unwrap();
    let mut found = vec![];
    while let Some(step) = march.advance().unwrap() {
        if simulation.include.contains(&step.row().time()) {
            found.push(step.pressure().to_owned());
        }
    }
    assert_eq!(found.len(), simulation.include.len());
    found
}

#[test]
fn adaptive_steps_end_at_the_times_asked_for_with_the_pressure_of_many_steps() {
    // A contrast of 100 in one term, pressed in 1 s, held, and pressed again: the pressure relaxes within the long steps.
    let terms = vec![CreepTerm { compliance: 0.99, retardation_time: 100.0 }];
    let creep = Creep { instantaneous: 0.01, terms, fluidity: 0.0 };
    let points = vec![(0.0, 0.0), (1.0, 0.02), (40.0, 0.02), (60.0, 0.03)];
    let loading: Programme =
        Loading { control: Control::Approach, history: History::Table { points } }.into();
    let wanted = vec![0.4, 2.2, 5.0, 17.0, 33.0, 47.0, 55.0];
    let run = |times| {
        let (creep, loading, include) = (creep.clone(), loading.clone(), wanted.clone());
        pressures(Simulation { creep, loading, include, times, ..sphere(32) })
    };
    let fine = run(TimeGrid::Uniform { end: 60.0, steps: 1200 });
    for tolerance in [1e-2, 1e-3] {
        for ((found, fine), t) in run(adaptive(60.0, tolerance, 1.0)).iter().zip(&fine).zip(&wanted) {
            let off: f64 = (found - fine).iter().map(|p| p.abs()).sum();
            // The tolerance holds for the sum; in single cells of the rim errors of both signs add half as much. A mixture of
            // the pressures at both ends of a long step is off by several per cent.
            assert!(off < 1.5 * tolerance * fine.sum(), "{tolerance} {t}: {}", off / fine.sum());
        }
    }
}

#[test]
fn events_and_adaptive_steps_resumed_from_any_row_give_the_same_bits() {
    let stage = |control, course: Course| Stage::new(control, course);
    let ramp = History::Ramp { value: 0.02, duration: 1.0 };
    let programme = Programme::new(vec![
        Stage { until: Some(Event::Approach(0.05)), ..stage(Control::Load, ramp.into()) },
        Stage {
            until: Some(Event::Load(0.005)),
            duration: Some(9.0),
            ..stage(Control::Approach, Course::Hold)
        },
        Stage {
            until: Some(Event::ContactLost),
            ..stage(Control::Approach, Course::RampTo { value: -0.05, duration: 1.0 })
        },
        Stage {
            duration: Some(1.0),
            times: Some(TimeGrid::Uniform { end: 1.0, steps: 3 }),
            ..stage(Control::Load, Course::Hold)
        },
        Stage { duration: Some(2.0), ..stage(Control::Load, History::Step { value: 0.01 }.into()) },
    ]);
    for times in [adaptive(50.0, 1e-2, 1e-2), TimeGrid::Uniform { end: 50.0, steps: 200 }] {
        let simulation = Simulation { loading: programme.clone(), times, ..sphere(24) };
        let mut march = March::new(simulation.clone()).unwrap();
        let mut checkpoints: Vec<Checkpoint> = vec![march.checkpoint().into_owned()];
        let mut rows = vec![];
        while let Some(step) = march.advance().unwrap() {
            rows.push(step.row());
            checkpoints.push(march.checkpoint().into_owned());
        }
        println!("{} rows", rows.len());
        assert_eq!(rows.last().unwrap().stage, 4);
        for at in (0..rows.len()).step_by(3).chain([rows.len()]) {
            let mut resumed = March::resume(simulation.clone(), &checkpoints[at]).unwrap();
            let mut rest = vec![];
            while let Some(step) = resumed.advance().unwrap() {
                rest.push(step.row());
            }
            assert_eq!(rest, rows[at..], "from row {at}");
            assert_eq!(resumed.checkpoint().into_owned(), *checkpoints.last().unwrap());
        }
    }
}

/// Prescribes the control and course once as many rows are done as each says, and gives all rows.
fn steered(march: &mut March, plan: &[(usize, Control, Course)], mut see: impl FnMut(&March)) -> Vec<Row> {
    let mut rows: Vec<Row> = vec![];
    while let Some(row) = march.advance().unwrap().map(|step| step.row()) {
        rows.push(row);
        let done = march.done();
        for (_, control, course) in plan.iter().filter(|(after, ..)| *after == done) {
            march.prescribe(Stage::new(*control, course.clone())).unwrap();
        }
        see(march);
    }
    rows
}

#[test]
fn what_is_prescribed_between_rows_is_a_stage() {
    let ramp = || History::Ramp { value: 0.02, duration: 1.0 };
    let times = TimeGrid::Uniform { end: 10.0, steps: 20 };
    let stage = |control, course: Course, duration| Stage { duration, ..Stage::new(control, course) };
    let down = || Course::RampTo { value: 0.01, duration: 1.0 };
    let programme = Programme::new(vec![
        stage(Control::Load, ramp().into(), Some(2.0)),
        stage(Control::Approach, Course::Hold, Some(3.0)),
        stage(Control::Pressure, History::Step { value: 0.015 }.into(), Some(2.0)),
        stage(Control::Approach, down(), None),
    ]);
    let planned = rows(Simulation { loading: programme, times: times.clone(), ..sphere(24) });
    let simulation = Simulation { loading: load(ramp()), times, ..sphere(24) };
    let mut march = March::new(simulation).unwrap();
    // Rows: 0+ and one each half second, one more for the jump of the pressure at 5 s.
    let plan = [
        (5, Control::Approach, Course::Hold),
        (11, Control::Pressure, History::Step { value: 0.015 }.into()),
        (16, Control::Approach, down()),
    ];
    // The same steps of the same solver: the same bits.
    assert_eq!(steered(&mut march, &plan, |_| ()), planned);
    assert!(planned[11].time() == 5.0 && planned[11].stage == 2 && planned.last().unwrap().stage == 3);
    assert!(march.finished() && march.rows_expected().is_none());
}

#[test]
fn a_steered_march_resumed_from_any_row_gives_the_same_bits() {
    let plan = [
        (4, Control::Approach, Course::Hold),
        (9, Control::Load, History::Sine { mean: 0.01, amplitude: 0.005, frequency: 0.5 }.into()),
        (15, Control::Load, Course::RampTo { value: 0.02, duration: 1.0 }),
    ];
    for times in [adaptive(20.0, 1e-2, 1e-2), TimeGrid::Uniform { end: 20.0, steps: 400 }] {
        let ramp = load(History::Ramp { value: 0.02, duration: 1.0 });
        let simulation = Simulation { loading: ramp, times, ..sphere(16) };
        let mut march = March::new(simulation.clone()).unwrap();
        let mut checkpoints: Vec<Checkpoint> = vec![];
        let rows = steered(&mut march, &plan, |march| checkpoints.push(march.checkpoint().into_owned()));
        assert!(rows.len() > 20 && rows.last().unwrap().stage == 3, "{} rows", rows.len());
        for at in [3, 4, 5, 9, 10, 14, 15, 16, rows.len()] {
            let mut resumed = March::resume(simulation.clone(), &checkpoints[at - 1]).unwrap();
            assert_eq!(steered(&mut resumed, &plan, |_| ()), rows[at..], "from row {at}");
        }
    }
}

#[test]
fn what_is_prescribed_keeps_the_rules_of_stages() {
    let simulation = Simulation {
        loading: load(History::Step { value: 0.01 }),
        times: TimeGrid::Uniform { end: 1.0, steps: 10 },
        hardness: 1.0,
        ..sphere(16)
    };
    let mut march = March::new(simulation.clone()).unwrap();
    let told = |march: &mut March, control, course: Course| {
        march.prescribe(Stage::new(control, course)).unwrap_err().to_string()
    };
    let step = |value| Course::from(History::Step { value });
    assert!(told(&mut march, Control::Load, step(0.02)).contains("after the first row"));
    march.advance().unwrap();
    assert!(told(&mut march, Control::Load, step(-0.02)).contains("not negative"));
    assert!(told(&mut march, Control::Load, step(f64::NAN)).contains("NaN"));
    // A hardness of 1 over the domain of 1 carries no more than 1.
    assert!(told(&mut march, Control::Pressure, step(1.5)).contains("1.5"));
    let fast = History::Sine { mean: 0.01, amplitude: 0.005, frequency: 10.0 };
    assert!(told(&mut march, Control::Load, fast.into()).contains("sine"));
    // What is refused changes nothing.
    let mut other = March::new(simulation).unwrap();
    other.advance().unwrap();
    assert_eq!(steered(&mut march, &[], |_| ()), steered(&mut other, &[], |_| ()));
    assert!(told(&mut march, Control::Load, step(0.02)).contains("before its last one"));
    // Nothing follows a jump without instantaneous compliance; the ramp from the value reached does.
    let soft = Simulation {
        creep: Creep { instantaneous: 0.0, ..creep() },
        loading: load(History::Ramp { value: 0.01, duration: 1.0 }),
        times: TimeGrid::Uniform { end: 2.0, steps: 8 },
        ..sphere(16)
    };
    let mut march = March::new(soft.clone()).unwrap();
    march.advance().unwrap();
    let table = History::Table { points: vec![(0.0, 0.0), (0.5, 0.01), (0.5, 0.02)] };
    assert!(told(&mut march, Control::Load, table.into()).contains("no instantaneous compliance"));
    for _ in 0..4 {
        march.advance().unwrap();
    }
    march.prescribe(Stage::new(Control::Load, step(0.02))).unwrap();
    let Err(error) = march.advance() else { panic!("followed a jump") };
    assert!(error.to_string().contains("jump"), "{error}");
    let mut march = March::new(soft).unwrap();
    let rows =
        steered(&mut march, &[(5, Control::Load, Course::RampTo { value: 0.02, duration: 0.5 })], |_| ());
    assert!((rows.last().unwrap().load / 0.02 - 1.0).abs() < 1e-12);
}

#[test]
fn a_stage_prescribed_between_rows_ends_at_its_event_and_what_it_reached_is_held() {
    let simulation = Simulation {
        loading: load(History::Step { value: 0.01 }),
        times: TimeGrid::Uniform { end: 4.0, steps: 4 },
        ..sphere(16)
    };
    let mut march = March::new(simulation.clone()).unwrap();
    march.advance().unwrap();
    let row = march.advance().unwrap().unwrap().row();
    // Drawn back within a fraction of a step of the run, until half of the approach is left.
    let stage = Stage {
        until: Some(Event::Approach(0.5 * row.approach)),
        times: Some(TimeGrid::Uniform { end: 0.1, steps: 10 }),
        duration: Some(0.1),
        ..Stage::new(Control::Approach, Course::RampTo { value: 0.0, duration: 0.1 })
    };
    march.prescribe(stage).unwrap();
    let mut rows = vec![];
    let mut resumed = None;
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
        if rows.len() == 3 {
            resumed = Some(March::resume(simulation.clone(), &march.checkpoint()).unwrap());
        }
    }
    let times: Vec<f64> = rows.iter().map(|row| row.coordinate.value()).collect();
    // Rows at each hundredth to the event at 1.05 s, then those of the run.
    assert!(
        times[..6].iter().zip([1.01, 1.02, 1.03, 1.04, 1.05, 2.0]).all(|(t, own)| (t - own).abs() < 1e-6),
        "{times:?}"
    );
    assert_eq!(times.last(), Some(&4.0));
    for held in &rows[4..] {
        assert!((held.approach / row.approach - 0.5).abs() < 1e-9);
    }
    let mut rest = vec![];
    let mut other = resumed.unwrap();
    while let Some(step) = other.advance().unwrap() {
        rest.push(step.row());
    }
    assert_eq!(format!("{rest:?}"), format!("{:?}", &rows[3..]));
    // A quantity that the run does not compute cannot be waited for.
    let mut march = March::new(simulation).unwrap();
    march.advance().unwrap();
    let stiffness = RowNumber::from_name("contact_stiffness").unwrap();
    let stage =
        Stage { until: Some(Event::Number(stiffness, 1.0)), ..Stage::new(Control::Load, Course::Hold) };
    assert!(march.prescribe(stage).unwrap_err().to_string().contains("quantities"));
}

#[test]
fn adaptive_steps_belong_to_the_linear_scheme() {
    let simulation = Simulation { scheme: Scheme::Constant, times: adaptive(1.0, 1e-3, 1e-3), ..sphere(8) };
    let Err(error) = March::new(simulation) else { panic!("accepted") };
    assert!(error.to_string().contains("linear"), "{error}");
}

#[test]
fn a_material_without_instantaneous_compliance_takes_adaptive_steps_too() {
    // Such steps are constant in U; C(t) = 1 - exp(-t), a ramp and a hold, against many steps.
    let terms = vec![CreepTerm { compliance: 1.0, retardation_time: 1.0 }];
    let creep = Creep { instantaneous: 0.0, terms, fluidity: 0.0 };
    let base =
        Simulation { creep, loading: load(History::Ramp { value: 0.01, duration: 0.5 }), ..sphere(24) };
    let fine = rows(Simulation { times: TimeGrid::Uniform { end: 4.0, steps: 4000 }, ..base.clone() });
    let rows = rows(Simulation { times: adaptive(4.0, 0.05, 1e-3), ..base });
    let exact = fine.last().unwrap().approach;
    println!("{} rows", rows.len());
    assert!((rows.last().unwrap().approach / exact - 1.0).abs() < 0.05);
    assert!(rows.len() < 700);
}

#[test]
fn a_contact_whose_load_jumps_as_cells_touch_is_stepped_over() {
    // Without instantaneous compliance the dashpot feels every new cell at once: no step is short enough for that.
    let term = |compliance, retardation_time| CreepTerm { compliance, retardation_time };
    let creep = Creep { instantaneous: 0.0, terms: vec![term(1e-4, 3.0)], fluidity: 0.0 };
    let history = History::Ramp { value: 0.02, duration: 1.0 };
    let run = |tolerance| {
        let loading = Loading { control: Control::Approach, history: history.clone() }.into();
        rows(Simulation { creep: creep.clone(), loading, times: adaptive(5.0, tolerance, 0.1), ..sphere(16) })
    };
    for tolerance in [1e-2, 1e-3] {
        let rows = run(tolerance);
        // A few hundred; without the bound there is no end.
        assert!(rows.len() < 3000, "{tolerance}: {}", rows.len());
        assert!(rows.iter().all(|row| row.time_error.is_some_and(|error| !error.is_nan())));
        // The solid relaxes to its spring: W = E L at the held approach, five retardation times later all but exp(-1.3).
        let last = rows.last().unwrap();
        assert!(last.time() == 5.0 && last.load > 0.0);
    }
}

#[test]
fn a_row_states_its_error_where_a_ring_of_cells_touches_a_dashpot() {
    // A Kelvin-Voigt body under a ramp of the approach. The load jumps where cells touch; in the row after, it is off by up to a third.
    let terms = vec![CreepTerm { compliance: 1.0, retardation_time: 1.0 }];
    let creep = Creep { instantaneous: 0.0, terms, fluidity: 0.0 };
    let history = History::Ramp { value: 0.1, duration: 1.0 };
    let run = |times| {
        let loading = Loading { control: Control::Approach, history: history.clone() }.into();
        rows(Simulation { creep: creep.clone(), loading, times, ..sphere(24) })
    };
    for times in [
        TimeGrid::Uniform { end: 1.0, steps: 10 },
        TimeGrid::Uniform { end: 1.0, steps: 160 },
        adaptive(1.0, 1e-2, 0.1),
    ] {
        let rows = run(times);
        let parts = |pair: &[Row]| {
            let [start, end] = [pair[0].time(), pair[1].time()];
            (1..=8).map(move |n| if n == 8 { end } else { start + (end - start) * f64::from(n) / 8.0 })
        };
        let fine = run(TimeGrid::List(rows.windows(2).flat_map(parts).collect()));
        let errors = rows.iter().zip(fine.iter().step_by(8)).skip(1).map(|(row, fine)| {
            assert!((row.time() - fine.time()).abs() < 1e-9);
            ((row.load / fine.load - 1.0).abs(), row.time_error.unwrap())
        });
        let errors: Vec<_> = errors.collect();
        let worst = errors.iter().map(|row| row.0).fold(0.0, f64::max);
        assert!(worst > 0.2, "{worst}");
        // Between two touches u is linear in time, and the rest is the tolerance of the solver.
        let uncovered: Vec<_> = errors.iter().filter(|(error, stated)| *error > stated.max(1e-5)).collect();
        println!("{} rows, {} uncovered, largest error {worst:.2}", rows.len(), uncovered.len());
        assert!(uncovered.is_empty(), "{uncovered:?}");
    }
}

#[test]
fn a_fluid_that_relaxes_to_nothing_takes_few_steps() {
    // A held approach is exact in any step; what is left of the load after a hundred relaxation times is rounding.
    let creep = Creep { instantaneous: 1e-4, terms: vec![], fluidity: 1e-4 };
    let history = History::Ramp { value: 0.02, duration: 200.0 };
    let loading = Loading { control: Control::Approach, history }.into();
    let rows = rows(Simulation { creep, loading, times: adaptive(500.0, 1e-3, 1.0), ..sphere(16) });
    assert!(rows.len() < 3000, "{}", rows.len());
    assert!(rows.last().unwrap().load < 1e-6 * rows.iter().map(|row| row.load).fold(0.0, f64::max));
}

/// A step follows a temperature by reduced time; a load that moves, and a body with another clock, do not: adaptive steps bound
/// the change of the rate.
#[test]
fn adaptive_steps_follow_a_changing_temperature() {
    use asperity::material::{ReducedTime, Relaxation, Shift, ThermalCreep};
    let creep = Relaxation::absolute(1e6, &[(1e8, 1.0)]).unwrap().to_creep().unwrap();
    let shift = Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    let clock = ReducedTime::new(shift, &[(0.0, 263.15), (8.0, 313.15)]).unwrap();
    let body = ThermalCreep { creep: creep.clone(), clock };
    let grid = Grid::new([16, 16], [1e-3, 1e-3]).unwrap();
    let shape = Shape::Sphere { radius: 5e-3 };
    let gap = undeformed_gap(&grid, &[Part::Shape { shape, center: [0.0, 0.0] }]).unwrap();
    let held = (Control::Approach, History::Step { value: 6e-6 }, creep);
    let ramp = (
        Control::Load,
        History::Ramp { value: 0.02, duration: 8.0 },
        asperity::material::Creep::elastic(1e-12),
    );
    for (control, history, creep) in [held, ramp] {
        let base = Simulation {
            creep,
            thermal: vec![body.clone()],
            loading: Loading { control, history }.into(),
            ..Simulation::new(grid, gap.clone())
        };
        let of = |row: &Row| if control == Control::Approach { row.load } else { row.approach };
        for tolerance in [1e-2, 1e-3] {
            let found = rows(Simulation { times: adaptive(10.0, tolerance, 10.0), ..base.clone() });
            // Each step in eight: the error of order two is 1/64.
            let parts = found.windows(2).filter(|pair| pair[1].time() > pair[0].time()).flat_map(|pair| {
                let [a, b] = [pair[0].time(), pair[1].time()];
                (1..=8).map(move |n| if n == 8 { b } else { a + (b - a) * f64::from(n) / 8.0 })
            });
            let fine = rows(Simulation { times: TimeGrid::List(parts.collect()), ..base.clone() });
            for row in found.iter().filter(|row| row.time() > 0.1) {
                let exact =
                    fine.iter().rfind(|other| (other.time() / row.time() - 1.0).abs() < 1e-12).unwrap();
                let off = (of(row) / of(exact) - 1.0).abs();
                assert!(
                    off <= 2.0 * tolerance,
                    "{control:?} {tolerance}: {off} at {} s of {}",
                    row.time(),
                    found.len()
                );
            }
        }
    }
}

/// Cells that have parted recover, and press again where the approach rises once more: an error of their displacement while they
/// are apart is one of the load then. Without them in the estimate the load was 3.5 tolerances of its peak off here.
#[test]
fn a_surface_that_recovers_and_touches_again_holds_the_tolerance() {
    use asperity::material::Relaxation;
    let terms: Vec<(f64, f64)> =
        (0..20_u8).map(f64::from).map(|k| (5e7 * 10f64.powf(-0.1 * k), 10f64.powf(-4.0 + 0.4 * k))).collect();
    let creep = Relaxation::absolute(1e6, &terms).unwrap().to_creep().unwrap();
    let grid = Grid::new([16, 16], [1e-3, 1e-3]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 5e-3 }, center: [0.0, 0.0] };
    let deepest = 6e-6;
    // Pressed, drawn back fast by 30 %, held there for a thousand times as long, pressed again.
    let points =
        vec![(0.0, 0.0), (1.0, deepest), (1.01, 0.7 * deepest), (11.0, 0.7 * deepest), (12.0, 1.1 * deepest)];
    let base = Simulation {
        creep,
        loading: Loading { control: Control::Approach, history: History::Table { points } }.into(),
        ..Simulation::new(grid, undeformed_gap(&grid, &[sphere]).unwrap())
    };
    for tolerance in [1e-2, 1e-3] {
        let found = rows(Simulation { times: adaptive(12.0, tolerance, 12.0), ..base.clone() });
        // Each step in eight: the error of order two is 1/64.
        let steps = found.windows(2).filter(|pair| pair[1].time() > pair[0].time());
        let parts = steps.flat_map(|pair| {
            let [a, b] = [pair[0].time(), pair[1].time()];
            (1..=8).map(move |n| if n == 8 { b } else { a + (b - a) * f64::from(n) / 8.0 })
        });
        let fine = rows(Simulation { times: TimeGrid::List(parts.collect()), ..base.clone() });
        let peak = fine.iter().map(|row| row.load).fold(0.0, f64::max);
        let off = found.iter().map(|row| {
            let exact =
                fine.iter().rfind(|other| (other.time() - row.time()).abs() <= 1e-12 * row.time()).unwrap();
            (row.load - exact.load).abs() / peak
        });
        let worst = off.fold(0.0, f64::max);
        println!("{tolerance}: {} rows, {worst:e}", found.len());
        assert!(worst <= tolerance, "{tolerance}: {worst:e}");
        assert!(found.len() < 400, "{} rows", found.len());
    }
}

#[test]
fn a_dashpot_that_begins_to_retreat_makes_no_pressure_of_what_the_solver_leaves() {
    // C(t) = 1 - exp(-t/0.5): pressed, held and drawn back, with the solver's usual tolerance. The contact opens at once where the
    // approach begins to fall, so that no step is short enough for its error.
    let terms = vec![CreepTerm { compliance: 1.0, retardation_time: 0.5 }];
    let creep = Creep { instantaneous: 0.0, terms, fluidity: 0.0 };
    let points = vec![(0.0, 0.0), (0.5, 0.03), (1.5, 0.03), (2.0, 0.0)];
    let loading: Programme =
        Loading { control: Control::Approach, history: History::Table { points } }.into();
    let base = Simulation { creep, loading, solver: SolverOptions::default(), ..sphere(24) };
    let uniform = rows(Simulation { times: TimeGrid::Uniform { end: 2.5, steps: 500 }, ..base.clone() });
    let largest = |rows: &[Row]| rows.iter().map(|row| row.load).fold(0.0, f64::max);
    for tolerance in [1e-2, 1e-3, 1e-4] {
        let found = rows(Simulation { times: adaptive(2.5, tolerance, 0.1), ..base.clone() });
        let peak = largest(&found);
        // The tolerance, and the chord of the uniform steps at the peak.
        assert!((peak / largest(&uniform) - 1.0).abs() < tolerance + 5e-3, "{tolerance}: {peak}");
        // While the approach falls, loads are below that of the hold or state that they may not be.
        let held = found.iter().rfind(|row| row.time() <= 1.5).unwrap().load;
        for row in found.iter().filter(|row| row.time() > 1.5) {
            let allowed = held * (1.0 + tolerance) / (1.0 - row.time_error.unwrap().min(0.9));
            assert!(row.load <= allowed, "{tolerance}: {} {}", row.time(), row.load);
        }
    }
}
