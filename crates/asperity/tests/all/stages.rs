//! Stages, events and pull-off: against closed forms that hold on every grid, and the row of springs.

use asperity::Drive;
use asperity::drive::March;
use asperity::load::{Control, Course, Event, History, Programme, Stage};
use asperity::material::{Creep, CreepTerm, Relaxation};
use asperity::quantities::RowNumber;
use asperity::reference::{Mdr, MdrProfile, MdrTarget};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{Boundary, Error, Grid, SolverOptions, TimeGrid};
use ndarray::Array2;

/// C(t) = 1/4 + 1/4 (1 - exp(-t)), E*(t) = 2 + 2 exp(-2t).
fn zener() -> Creep {
    Creep {
        instantaneous: 0.25,
        terms: vec![CreepTerm { compliance: 0.25, retardation_time: 1.0 }],
        fluidity: 0.0,
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
    let solver = SolverOptions { tolerance: 1e-10, ..SolverOptions::default() };
    Simulation { creep: zener(), solver, ..Simulation::new(grid, gap) }
}

fn rows(simulation: Simulation) -> Vec<Row> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    assert!(march.finished());
    rows
}

fn timed(control: Control, course: impl Into<Course>, duration: f64) -> Stage {
    Stage { duration: Some(duration), ..Stage::new(control, course) }
}

fn until(control: Control, course: impl Into<Course>, event: Event) -> Stage {
    Stage { until: Some(event), ..Stage::new(control, course) }
}

#[test]
fn pressed_under_a_load_then_held_the_load_relaxes_as_the_material_does() {
    // While the contact does not shrink, W(t) = int E*(t - s) dL(s) with L(s) = W0 C(s) the elastic load of unit modulus
    // at the approach w(s), which stands still from t1 = 1 on: W/W0 = 1 - exp(-t1)/2 + exp(t1 - 2t)/2, on every
    // grid.
    let programme = Programme::new(vec![
        timed(Control::Load, History::Step { value: 0.2 }, 1.0),
        Stage::new(Control::Approach, Course::Hold),
    ]);
    let error = |steps| {
        let times = TimeGrid::Uniform { end: 3.0, steps };
        let rows = rows(Simulation { loading: programme.clone(), times, ..rough([32, 32]) });
        assert_eq!(rows.len(), steps + 1, "no row for a switch without a jump");
        let held: Vec<&Row> = rows.iter().filter(|row| row.stage == 1).collect();
        let switch = rows.iter().rfind(|row| row.stage == 0).unwrap();
        assert_eq!(switch.time(), 1.0);
        assert!(held.iter().all(|row| row.approach == switch.approach));
        assert!(held.iter().all(|row| row.contact_area == switch.contact_area));
        let exact = |t: f64| 0.2 * (1.0 - 0.5 * (-1.0_f64).exp() + 0.5 * (1.0 - 2.0 * t).exp());
        held.iter().map(|row| (row.load / exact(row.time()) - 1.0).abs()).fold(0.0, f64::max)
    };
    // Exact but for the solver, in any steps that end at the switch.
    let errors = [error(3), error(60)];
    assert!(errors.iter().all(|error| *error < 1e-7), "{errors:?}");
}

/// The rows of a march, and what the springs say under the prescribed values of the same rows.
fn beside_springs(simulation: Simulation, relaxation: &Relaxation) -> Vec<(Row, [f64; 2])> {
    let controls: Vec<Control> = simulation.loading.stages.iter().map(|stage| stage.control).collect();
    let rows = rows(simulation);
    let mut springs = Mdr::new(MdrProfile::Paraboloid { radius: 1.0 }, relaxation, 0.8, 2000).unwrap();
    let mut out = vec![];
    let mut last = Row::default();
    for row in rows {
        let dt = row.coordinate.value() - last.coordinate.value();
        // The prescribed values are straight from row to row. After a loss of contact under load the springs' own
        // approach is compared, not set.
        let parts = if dt > 0.0 { 20 } else { 1 };
        let mut state = None;
        for n in 1..=parts {
            let share = f64::from(n) / f64::from(parts);
            let target = match controls[row.stage] {
                Control::Approach => {
                    MdrTarget::Approach(last.approach + share * (row.approach - last.approach))
                }
                _ => MdrTarget::Load(last.load + share * (row.load - last.load)),
            };
            state = Some(springs.step(dt / f64::from(parts), target).unwrap());
        }
        let state = state.unwrap();
        out.push((row, [state.load, state.approach]));
        last = row;
    }
    out
}

#[test]
fn press_hold_retract_wait_and_touch_again() {
    let grid = Grid::new([64, 64], [1.8, 1.8]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[part]).unwrap();
    let relaxation = Relaxation::absolute(2.0, &[(2.0, 0.5), (1.0, 2.0)]).unwrap();
    let programme = Programme::new(vec![
        until(Control::Load, History::Ramp { value: 1.5, duration: 1.0 }, Event::Approach(0.3)),
        until(Control::Approach, Course::Hold, Event::Load(0.6)),
        until(Control::Approach, Course::RampTo { value: -0.3, duration: 1.0 }, Event::ContactLost),
        timed(Control::Load, Course::Hold, 0.4),
        until(Control::Approach, Course::RampTo { value: 0.3, duration: 0.5 }, Event::Load(0.5)),
        timed(Control::Load, Course::Hold, 0.5),
    ]);
    let simulation = Simulation {
        creep: relaxation.to_creep().unwrap(),
        loading: programme.clone(),
        times: TimeGrid::Uniform { end: 10.0, steps: 500 },
        ..Simulation::new(grid, gap)
    };
    assert_eq!(March::new(simulation.clone()).unwrap().rows_expected(), None);
    let pairs = beside_springs(simulation, &relaxation);
    let end_of = |stage| pairs.iter().rfind(|(row, _)| row.stage == stage).unwrap().0;
    // Events are met to a millionth of the largest value; a contact is lost to the last cell.
    assert!((end_of(0).approach - 0.3).abs() <= 1e-6 * 0.3);
    assert!((end_of(1).load - 0.6).abs() <= 1e-6 * end_of(0).load);
    assert_eq!((end_of(2).load, end_of(2).contact_area), (0.0, 0.0));
    assert!((end_of(4).load - 0.5).abs() <= 1e-6 * end_of(0).load);
    assert_eq!(end_of(5).stage, 5);
    assert!((end_of(5).time() - end_of(4).time() - 0.5).abs() < 1e-12);
    // The row just before the loss touches still.
    let lost = pairs.iter().position(|(row, _)| row.stage == 2 && row.contact_area == 0.0).unwrap();
    assert!(pairs[lost - 1].0.contact_area > 0.0);
    // While open, the surface comes back: the approach at which it just touches rises towards 0.
    let open: Vec<f64> =
        pairs.iter().filter(|(row, _)| row.stage == 3).map(|(row, _)| row.approach).collect();
    assert!(open.windows(2).all(|w| w[1] < w[0]) && *open.last().unwrap() > 0.0, "{open:?}");
    // 20 cells to the radius: (dx/a)^2 = 2.5e-3 of the load and the approach. A bit more where a few cells carry
    // all of the load.
    let most = pairs.iter().map(|(row, _)| row.load).fold(0.0, f64::max);
    for (row, [load, approach]) in &pairs {
        assert!((row.load - load).abs() < 6e-3 * most, "{row:?} {load}");
        assert!((row.approach - approach).abs() < 6e-3 * 0.3, "{row:?} {approach}");
    }
}

#[test]
fn at_zero_load_the_contact_is_empty_and_the_surface_recovers() {
    // One branch: after the pull-off at t = 1 every displacement falls as exp(-t).
    for boundary in [Boundary::Free, Boundary::Periodic] {
        let simulation = Simulation {
            boundary,
            loading: Programme::new(vec![
                timed(Control::Load, History::Ramp { value: 0.2, duration: 0.6 }, 0.6),
                timed(Control::Load, Course::RampTo { value: 0.0, duration: 0.4 }, 0.4),
                Stage::new(Control::Load, Course::Hold),
            ]),
            times: TimeGrid::Uniform { end: 4.0, steps: 40 },
            ..rough([32, 36])
        };
        let gap = simulation.gap.clone();
        let mut march = March::new(simulation).unwrap();
        let mut pulled: Option<(f64, Array2<f64>)> = None;
        let mut open = 0;
        while let Some(step) = march.advance().unwrap() {
            if step.coordinate().value() < 1.0 - 1e-9 {
                continue;
            }
            let row = step.row();
            assert!(step.pressure().iter().all(|p| *p == 0.0));
            assert_eq!([row.load, row.contact_area, row.max_pressure], [0.0; 3]);
            let mut u = Array2::zeros(gap.dim());
            step.displacement_into(&mut u);
            let touch = gap.iter().zip(&u).map(|(h, u)| h + u).fold(f64::INFINITY, f64::min);
            // one rounding
            assert!((row.approach - touch).abs() < 1e-15, "{} {touch}", row.approach);
            let (start, first) = pulled.get_or_insert_with(|| (row.time(), u.clone()));
            let decay = (*start - row.time()).exp();
            let largest = first.iter().fold(0.0, |m: f64, u| m.max(u.abs()));
            // thirty steps of roundings
            assert!(u.iter().zip(first.iter()).all(|(u, v)| (u - v * decay).abs() < 1e-13 * largest));
            open += 1;
        }
        assert_eq!(open, 31);
    }
}

#[test]
fn an_event_that_does_not_come_is_said_and_a_duration_makes_it_optional() {
    let stage = until(Control::Load, History::Step { value: 0.1 }, Event::Approach(5.0));
    let simulation = |stage: &Stage| Simulation {
        loading: Programme::new(vec![stage.clone(), Stage::new(Control::Approach, Course::Hold)]),
        times: TimeGrid::Uniform { end: 1.0, steps: 4 },
        ..rough([20, 20])
    };
    let mut march = March::new(simulation(&stage)).unwrap();
    let mut rows = 0;
    let error = loop {
        match march.advance() {
            Ok(step) => rows += usize::from(step.is_some()),
            Err(error) => break error,
        }
    };
    assert_eq!(rows, 5);
    assert!(matches!(error, Error::Missed { stage: 1, .. }));
    assert!(error.to_string().contains("stage 1 waits for approach 5e0 m"), "{error}");
    let optional = Stage { duration: Some(0.5), ..stage };
    let rows = self::rows(simulation(&optional));
    assert_eq!(rows.last().map(|row| (row.time(), row.stage)), Some((1.0, 1)));
}

#[test]
fn a_jump_reaches_the_value_at_which_it_ends() {
    let first = until(Control::Load, History::Step { value: 0.2 }, Event::Load(0.2));
    let second = until(Control::Approach, Course::Hold, Event::Load(0.15));
    let third = timed(Control::Load, History::Step { value: 0.3 }, 0.3);
    let simulation = Simulation {
        loading: Programme::new(vec![first, second, third]),
        times: TimeGrid::Uniform { end: 9.0, steps: 90 },
        ..rough([24, 24])
    };
    let rows = rows(simulation);
    assert_eq!((rows[0].time(), rows[0].stage, rows[1].stage), (0.0, 0, 1));
    let event = rows.iter().rposition(|row| row.stage == 1).unwrap();
    assert!((rows[event].load - 0.15).abs() < 1e-6 * 0.2);
    // The jump to 0.3 is a row of no length.
    assert_eq!(rows[event + 1].time(), rows[event].time());
    assert!((rows[event + 1].load - 0.3).abs() < 1e-12);
}

#[test]
fn what_a_jump_only_passes_is_not_reached() {
    // At a held approach the load relaxes to half of its first value and no further, at a held load the approach grows.
    let wait = |control, value, event| Simulation {
        loading: Programme::new(vec![until(control, History::Step { value }, event)]),
        times: TimeGrid::Uniform { end: 9.0, steps: 9 },
        ..rough([20, 20])
    };
    let first = rows(Simulation {
        loading: Programme::new(vec![Stage::new(Control::Approach, History::Step { value: 0.05 })]),
        ..wait(Control::Approach, 0.05, Event::Load(0.0))
    })[0];
    let fraction = RowNumber::from_name("contact_fraction").unwrap();
    let never = [
        (Control::Approach, 0.05, Event::Load(0.1 * first.load)),
        (Control::Approach, 0.05, Event::Pressure(0.1 * first.mean_pressure)),
        (Control::Load, first.load, Event::Approach(0.01)),
        (Control::Load, first.load, Event::Load(0.5 * first.load)),
        (Control::Load, first.load, Event::Number(fraction, 0.1 * first.contact_fraction)),
    ];
    for (control, value, event) in never {
        let mut march = March::new(wait(control, value, event)).unwrap();
        let error = loop {
            match march.advance() {
                Ok(step) => assert!(step.is_some(), "{event:?} is complete"),
                Err(error) => break error,
            }
        };
        assert!(matches!(error, Error::Missed { stage: 1, .. }), "{event:?}: {error}");
    }
    // What comes after it is reached, from the side on which the jump has led.
    for (control, value, event) in [
        (Control::Approach, 0.05, Event::Load(0.7 * first.load)),
        (Control::Approach, 0.05, Event::Pressure(0.7 * first.mean_pressure)),
        (Control::Load, first.load, Event::Approach(1.1 * first.approach)),
    ] {
        let last = *rows(wait(control, value, event)).last().unwrap();
        let [reached, wanted] = match event {
            Event::Approach(value) => [last.approach, value],
            Event::Pressure(value) => [last.mean_pressure, value],
            Event::Load(value) => [last.load, value],
            _ => unreachable!(),
        };
        // To a millionth of the largest value so far.
        assert!(last.time() > 0.0 && (reached / wanted - 1.0).abs() < 2e-6, "{event:?}: {last:?}");
    }
}

#[test]
fn a_jump_that_parts_the_surfaces_loses_their_contact() {
    let points = [(0.0, 0.05), (1.0, 0.05), (1.0, -0.5), (2.0, -0.5)];
    for control in [Control::Approach, Control::Load] {
        let points =
            points.iter().map(|(t, v)| (*t, if control == Control::Load { f64::max(*v, 0.0) } else { *v }));
        let stage = until(control, History::Table { points: points.collect() }, Event::ContactLost);
        let last = *rows(Simulation {
            loading: Programme::new(vec![stage]),
            times: TimeGrid::Uniform { end: 2.0, steps: 4 },
            ..rough([20, 20])
        })
        .last()
        .unwrap();
        assert_eq!((last.time(), last.load, last.contact_area), (1.0, 0.0, 0.0));
    }
}

#[test]
fn an_event_within_the_first_step_of_a_stage_is_found() {
    // One step over the whole ramp: the approach passes the value within it, the contact is lost within the next.
    let press = until(Control::Approach, History::Ramp { value: 0.05, duration: 1.0 }, Event::Approach(0.02));
    let retract =
        until(Control::Approach, Course::RampTo { value: -0.05, duration: 1.0 }, Event::ContactLost);
    let simulation = Simulation {
        loading: Programme::new(vec![press, retract]),
        times: TimeGrid::Uniform { end: 3.0, steps: 3 },
        ..rough([24, 24])
    };
    let rows = rows(simulation);
    let shown: Vec<(usize, f64)> = rows.iter().map(|row| (row.stage, row.approach)).collect();
    assert_eq!(shown.len(), 3, "{shown:?}");
    assert!((rows[1].time() - 0.4).abs() < 1e-6 && (rows[1].approach - 0.02).abs() <= 0.02e-6, "{shown:?}");
    // Where the surface is still dented the contact is lost below its first touch.
    assert_eq!(rows[2].load, 0.0);
    assert!(rows[2].approach > 0.0 && rows[2].approach < 0.02, "{shown:?}");
}

#[test]
fn constant_load_never_lets_the_counted_area_shrink() {
    // A theorem for linear viscoelastic, non-adhesive contact, whatever came before; three surfaces, no tolerance.
    for seed in [1, 2, 5] {
        let base = rough([40, 44]);
        let roughness = SelfAffine {
            hurst: 0.7,
            roughness: Roughness::RmsGradient(0.5),
            longest: 0.4,
            shortest: 0.08,
            roll_off: 0.4,
            seed,
        };
        let gap = undeformed_gap(&base.grid, &[Part::SelfAffine(roughness)]).unwrap();
        let creep = Relaxation::absolute(1.0, &[(2.0, 0.5), (1.0, 5.0)]).unwrap().to_creep().unwrap();
        let simulation = Simulation {
            gap,
            creep,
            loading: Programme::new(vec![
                timed(Control::Load, History::Step { value: 0.3 }, 1.0),
                timed(Control::Approach, Course::Hold, 1.0),
                timed(Control::Load, History::Step { value: 0.1 }, 20.0),
            ]),
            times: TimeGrid::Logarithmic { end: 22.0, steps: 60, first: 0.01 },
            ..base
        };
        let held: Vec<Row> = rows(simulation).into_iter().filter(|row| row.stage == 2).collect();
        assert!(held.windows(2).all(|pair| pair[1].contact_area >= pair[0].contact_area));
        assert!(held[held.len() - 1].contact_area > held[0].contact_area);
    }
}

#[test]
fn a_load_that_falls_to_nothing_ends_its_contact_exactly_then() {
    // 0.2 + 0.3 + 0.2 s: the sum is no round number, and the load at its end is none all the same.
    let fall = History::Trapezoid { peak: 0.2, rise: 0.2, hold: 0.3, fall: 0.2 };
    let simulation = Simulation {
        loading: Programme::new(vec![until(Control::Load, fall, Event::ContactLost)]),
        times: TimeGrid::Uniform { end: 4.0, steps: 4 },
        ..rough([20, 20])
    };
    let last = *rows(simulation).last().unwrap();
    assert!((last.time() - 0.7).abs() < 1e-12 && last.contact_area == 0.0, "{last:?}");
}

#[test]
fn no_load_is_the_loss_of_contact_whatever_the_steps() {
    let there_and_back = History::Triangle { peak: 0.05, rise: 1.0, fall: 2.0 };
    let at = |event, times| {
        let stage = until(Control::Approach, there_and_back.clone(), event);
        rows(Simulation { loading: Programme::new(vec![stage]), times, ..rough([20, 20]) })
            .last()
            .unwrap()
            .time()
    };
    let adaptive = TimeGrid::Adaptive { end: 4.0, tolerance: 1e-3, first: 0.1 };
    let best = at(Event::ContactLost, TimeGrid::Uniform { end: 4.0, steps: 400 });
    for times in
        [TimeGrid::Uniform { end: 4.0, steps: 8 }, TimeGrid::Uniform { end: 4.0, steps: 40 }, adaptive]
    {
        let (load, lost) = (at(Event::Load(0.0), times.clone()), at(Event::ContactLost, times));
        // One event, of second order in the steps.
        assert!(load == lost && (load - best).abs() < 0.02, "{load} {lost} {best}");
    }
}

#[test]
fn an_event_between_two_steps_is_met_at_the_turn_of_a_sine() {
    // The load is above 1.999 N of 2 N for 1 % of the period; twenty steps do not fall on its peak.
    let sine = History::Sine { mean: 0.1, amplitude: 0.1, frequency: 0.9 };
    let simulation = Simulation {
        loading: Programme::new(vec![until(Control::Load, sine, Event::Load(0.19999))]),
        times: TimeGrid::Uniform { end: 2.0, steps: 37 },
        ..rough([20, 20])
    };
    let last = *rows(simulation).last().unwrap();
    assert!(last.time() < 0.25 / 0.9 && (last.load / 0.19999 - 1.0).abs() < 1e-5, "{last:?}");
}

#[test]
fn an_event_after_the_jump_is_the_relaxation_and_too_few_steps_of_a_sine_are_refused() {
    let press = until(Control::Approach, History::Step { value: 0.05 }, Event::Load(0.0));
    let first = rows(Simulation {
        loading: Programme::new(vec![Stage { until: None, ..press.clone() }]),
        times: TimeGrid::Uniform { end: 0.1, steps: 1 },
        ..rough([20, 20])
    })[0]
        .load;
    // E*(t) = 2 + 2 exp(-2t) falls to 0.75 of its start at t = ln(2)/2.
    let wanted = Event::Load(0.75 * first);
    let run = |after_jump| {
        let stage = Stage { until: Some(wanted), after_jump, ..press.clone() };
        let times = TimeGrid::Uniform { end: 4.0, steps: 4 };
        *rows(Simulation { loading: Programme::new(vec![stage]), times, ..rough([20, 20]) }).last().unwrap()
    };
    for after_jump in [false, true] {
        let row = run(after_jump);
        assert!((row.time() - 0.5 * 2f64.ln()).abs() < 1e-4, "{row:?}");
        assert!((row.load / (0.75 * first) - 1.0).abs() < 2e-6, "{row:?}");
    }
    let sine = History::Sine { mean: 0.1, amplitude: 0.1, frequency: 2.0 };
    let simulation = Simulation {
        loading: Programme::new(vec![Stage::new(Control::Load, sine)]),
        times: TimeGrid::Uniform { end: 100.0, steps: 100 },
        ..rough([20, 20])
    };
    let Err(error) = March::new(simulation) else { panic!("accepted") };
    assert!(error.to_string().contains("4000 uniform steps"), "{error}");
}

#[test]
fn a_stage_ends_where_a_number_of_its_rows_reaches_a_value() {
    // A sphere of radius 2 on an elastic half-space with E* = 4. 400 rows enclose the time; straight lines between them are right to
    // a row's spacing. The event itself is met to 1e-6 of the larger of its value and the number in the row before it.
    let grid = Grid::new([32, 32], [1.0, 1.0]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 2.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[sphere]).unwrap();
    let solver = SolverOptions { tolerance: 1e-10, ..SolverOptions::default() };
    let creep = Creep { instantaneous: 0.25, terms: vec![], fluidity: 0.0 };
    let base = Simulation { creep, solver, ..Simulation::new(grid, gap) };
    let ramp = History::Ramp { value: 0.1, duration: 1.0 };
    let pressed = |event: Option<Event>, steps: usize| {
        let stage = Stage { until: event, ..Stage::new(Control::Load, ramp.clone()) };
        rows(Simulation {
            loading: Programme::new(vec![stage]),
            times: TimeGrid::Uniform { end: 1.0, steps },
            ..base.clone()
        })
    };
    let all = pressed(None, 400);
    let number = |name: &str, value: f64| Some(Event::Number(RowNumber::from_name(name).unwrap(), value));
    let between = |of: fn(&Row) -> f64, value: f64| {
        let pair =
            all.windows(2).find(|pair| (of(&pair[0]) - value) * (of(&pair[1]) - value) <= 0.0).unwrap();
        let share = (value - of(&pair[0])) / (of(&pair[1]) - of(&pair[0]));
        pair[0].time() + share * (pair[1].time() - pair[0].time())
    };
    type Read = fn(&Row) -> f64;
    let smooth: [(&str, Read); 2] =
        [("mean_gap", |row| row.mean_gap), ("max_pressure", |row| row.max_pressure)];
    for (name, of) in smooth {
        let value = 0.5 * (of(&all[100]) + of(&all[300]));
        let found = pressed(number(name, value), 7).pop().unwrap();
        assert!((of(&found) - value).abs() <= 2e-6 * value.abs().max(of(&all[0]).abs()), "{name}");
        let time = between(of, value);
        assert!((found.time() - time).abs() < 1.0 / 400.0, "{name}: {} {time}", found.time());
    }
    // The contact fraction rises in steps: the stage ends with the first row at or above the value.
    let found = pressed(number("contact_fraction", 0.1), 7).pop().unwrap();
    let first = all.iter().position(|row| row.contact_fraction >= 0.1).unwrap();
    assert!(all[first - 1].time() < found.time() && found.time() <= all[first].time() + 1e-8);
    assert!(found.contact_fraction >= 0.1 && found.contact_fraction <= all[first].contact_fraction);

    // What never comes is told at the end.
    let stage = Stage { until: number("contact_fraction", 0.9), ..Stage::new(Control::Load, ramp.clone()) };
    let simulation = |stage: &Stage| Simulation {
        loading: Programme::new(vec![stage.clone()]),
        times: TimeGrid::Uniform { end: 1.0, steps: 3 },
        ..base.clone()
    };
    let mut march = March::new(simulation(&stage)).unwrap();
    let error = loop {
        match march.advance() {
            Ok(step) => assert!(step.is_some()),
            Err(error) => break error.to_string(),
        }
    };
    assert!(error.contains("waits for contact_fraction 0.9"), "{error}");

    // A contact at rest has no friction; work of the solver and sums over rows are nothing to wait for.
    let stage = Stage { until: number("friction_coefficient", 0.1), ..stage };
    let error = March::new(simulation(&stage)).err().unwrap().to_string();
    assert!(error.contains("friction_coefficient") && error.contains("[motion]"), "{error}");
    for name in ["iterations", "stage", "time", "elastic_energy", "gap_histogram"] {
        assert_eq!(RowNumber::from_name(name), None);
    }
}
