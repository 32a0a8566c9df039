//! Contacts that move in time: against closed forms, against the steady state, and by their own balances.

use asperity::Drive;
use std::f64::consts::{PI, TAU};

use asperity::drive::March;

use asperity::process::Motion;

use asperity::step::Row;

use asperity::material::{Creep, CreepTerm, Relaxation};
use asperity::quantities::{Quantities, Quantity, RowNumber};
use asperity::simulation::Simulation;
use asperity::sliding::{Direction, Friction, MovingGap, Path, Steady, SteadyMotion};
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{Boundary, Control, Event, Grid, History, Loading, SolverOptions, TimeGrid};

fn zener(instantaneous: f64, retarded: f64, time: f64) -> Creep {
    Creep {
        instantaneous,
        terms: vec![CreepTerm { compliance: retarded, retardation_time: time }],
        fluidity: 0.0,
    }
}

fn shape(shape: Shape) -> Vec<(Part, bool)> {
    vec![(Part::Shape { shape, center: [0.0, 0.0] }, true)]
}

fn simulation(
    grid: Grid,
    boundary: Boundary,
    parts: &[(Part, bool)],
    creep: Creep,
    load: f64,
    path: Path,
    times: TimeGrid,
) -> Simulation {
    let all: Vec<Part> = parts.iter().map(|(part, _)| part.clone()).collect();
    Simulation {
        boundary,
        creep,
        loading: Loading { control: Control::Load, history: History::Step { value: load } }.into(),
        times,
        solver: SolverOptions { tolerance: 1e-8, ..SolverOptions::default() },
        motion: Some(Motion {
            path,
            direction: Direction::X,
            gap: MovingGap::new(&grid, boundary, parts).unwrap(),
            cells_per_step: 1.0,
            shear_stress: None,
        }),
        ..Simulation::new(grid, undeformed_gap(&grid, &all).unwrap())
    }
}

fn run(simulation: Simulation) -> Vec<(Row, Friction)> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push((step.row(), step.friction().unwrap()));
    }
    rows
}

fn at_speed(v: f64, start: f64) -> Path {
    Path::of_velocity(History::Step { value: v }, start).unwrap()
}

#[test]
fn the_start_of_sliding_in_full_contact_follows_its_closed_form_to_second_order() {
    // E*(t) = 1 + 3 exp(-t/0.5) + 2 exp(-t/5), a sine of amplitude 0.01 and length 1, relaxed and then moved with v = 0.1.
    let relaxation = Relaxation::absolute(1.0, &[(3.0, 0.5), (2.0, 5.0)]).unwrap();
    let exact = [
        (0.1, 0.000291221823559),
        (0.5, 0.00116136039511),
        (1.0, 0.00183024778425),
        (5.0, 0.00162706136893),
        (10.0, 0.00133993216967),
    ];
    let start = 1000.0;
    let error = |cells: usize| {
        let grid = Grid::line(cells, 1.0).unwrap();
        let parts = shape(Shape::Wave { amplitude: 0.01, wavelength: [1.0, f64::INFINITY] });
        let times = TimeGrid::List([&[1.0, 10.0, 100.0, start][..], &exact.map(|(t, _)| start + t)].concat());
        let rows = run(simulation(
            grid,
            Boundary::Periodic,
            &parts,
            relaxation.to_creep().unwrap(),
            1.0,
            at_speed(0.1, start),
            times,
        ));
        exact
            .iter()
            .map(|(t, stress)| {
                let (_, friction) =
                    rows.iter().find(|(row, _)| (row.time() - start - t).abs() < 1e-9).unwrap();
                assert!(
                    (friction.distance - 0.1 * t).abs() < 1e-12 && (friction.velocity - 0.1).abs() < 1e-15
                );
                (friction.force - stress).abs() / 1.4e-3
            })
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(50), error(100));
    assert!(coarse < 5e-3 && fine < coarse / 3.0, "{coarse:e} {fine:e}");
}

#[test]
fn the_stated_error_holds_that_of_waves_of_a_few_cells() {
    // Five and eight cells to a wave, each passed in a step: a wave has between (x/2) cot(x/2) and sin(x)/x of its loss, x = q dx,
    // whatever the material.
    let (q, amplitude) = (TAU, 1e-3);
    for (cells, contrast, v) in
        [(5, 5.0, 0.1), (5, 300.0, 1.0), (5, 3000.0, 10.0), (8, 5.0, 1.0), (8, 300.0, 0.1), (8, 3000.0, 3.0)]
    {
        let creep = zener(1.0 / contrast, 1.0 - 1.0 / contrast, 1.0);
        let w = q * v;
        let [storage, loss] = [
            1.0 / contrast + (1.0 - 1.0 / contrast) / (1.0 + w * w),
            (1.0 - 1.0 / contrast) * w / (1.0 + w * w),
        ];
        let exact = 0.25 * q * q * amplitude * amplitude * loss / (storage * storage + loss * loss);
        let start = 20.0;
        // Three times of relaxation, or three waves.
        let end = start + f64::max(3.0, 3.0 / v);
        let rows = run(simulation(
            Grid::line(cells, 1.0).unwrap(),
            Boundary::Periodic,
            &shape(Shape::Wave { amplitude, wavelength: [1.0, f64::INFINITY] }),
            creep,
            10.0,
            at_speed(v, start),
            TimeGrid::List(vec![0.2, 2.0, start, end]),
        ));
        let friction = rows[rows.len() - 2].1;
        let x = q / cells as f64;
        let share = friction.force / exact;
        let bounds = x.sin() / x - 5e-3..0.5 * x / (0.5 * x).tan() + 5e-3;
        assert!(bounds.contains(&share), "{cells} {contrast} {v}: {share} {bounds:?}");
        assert!(friction.uncertainty > (share - 1.0).abs(), "{cells} {contrast} {v}");
    }
}

#[test]
fn a_long_slide_becomes_the_steady_state() {
    let (cells, length) = (128, 8.0);
    let grid = Grid::line(cells, length).unwrap();
    let parts = shape(Shape::Cylinder { radius: 1.0 });
    let creep = zener(0.2, 0.8, 1.0);
    for v in [0.3, 2.0] {
        let steady = {
            let moving = MovingGap::new(&grid, Boundary::Periodic, &parts).unwrap();
            let (gap, slopes) = moving.at(0.0, Direction::X);
            let simulation = Simulation {
                boundary: Boundary::Periodic,
                creep: creep.clone(),
                loading: Loading { control: Control::Load, history: History::Step { value: 0.25 * PI } }
                    .into(),
                ..Simulation::new(grid, gap)
            };
            let motion =
                SteadyMotion { direction: Direction::X, velocities: vec![v], slopes, shear_stress: None };
            let mut steady = Steady::new(simulation, motion).unwrap();
            let step = steady.advance().unwrap().unwrap();
            (step.row(), step.friction().unwrap())
        };
        let end = 12.0 + 2.0 * length / v;
        let rows = run(Simulation {
            quantities: Quantities::of(Quantity::of_motion()),
            ..simulation(
                grid,
                Boundary::Periodic,
                &parts,
                creep.clone(),
                0.25 * PI,
                at_speed(v, 0.0),
                TimeGrid::Uniform { end, steps: 1 },
            )
        });
        let (row, friction) = rows[rows.len() - 2];
        // One cell to a step: a hundredth.
        let off = friction.coefficient / steady.1.coefficient - 1.0;
        assert!(off.abs() < 0.03, "v = {v}: {} {} ({off:.1e})", friction.coefficient, steady.1.coefficient);
        assert!((row.max_pressure / steady.0.max_pressure - 1.0).abs() < 0.03);
        // What friction does is lost.
        let balance = friction.power / (friction.force * v) - 1.0;
        assert!(balance.abs() < 0.02, "v = {v}: {balance:.1e}");
        let work: usize = rows[10..].iter().map(|(row, _)| row.convolutions).sum();
        assert!(work <= 10 * (rows.len() - 10), "{work} convolutions in {} steps", rows.len() - 10);
    }
}

#[test]
fn work_is_energy_stored_and_lost_over_start_stop_and_return() {
    let rough = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 1.0,
        shortest: 0.25,
        roll_off: 0.5,
        seed: 2,
    };
    let grid = Grid::new([32, 32], [1.0, 1.0]).unwrap();
    let points = vec![(0.0, 0.0), (0.5, 0.4), (1.5, 0.4), (2.0, -0.4), (3.0, -0.4), (3.1, 0.0)];
    let path = Path::of_velocity(History::Table { points }, 0.5).unwrap();
    let energies = [
        Quantity::ElasticEnergy,
        Quantity::DissipatedEnergy,
        Quantity::ExternalWork,
        Quantity::DissipatedPower,
    ];
    let slide = Simulation {
        quantities: Quantities::of(energies),
        ..simulation(
            grid,
            Boundary::Periodic,
            &[(Part::SelfAffine(rough), true)],
            zener(0.2, 0.8, 0.3),
            0.03,
            path,
            TimeGrid::Uniform { end: 4.0, steps: 80 },
        )
    };
    let mut march = March::new(slide).unwrap();
    let (mut least, mut last) = (f64::INFINITY, [0.0; 3]);
    let mut forces = vec![];
    while let Some(step) = march.advance().unwrap() {
        let of = |q| step.quantity(q).unwrap()[0];
        last = [of(Quantity::ElasticEnergy), of(Quantity::DissipatedEnergy), of(Quantity::ExternalWork)];
        least = least.min(of(Quantity::DissipatedPower));
        forces.push((step.row().time(), step.friction().unwrap().force));
    }
    let [elastic, dissipated, work] = last;
    // Steps of a cell, waves of eight of them.
    assert!((work / (elastic + dissipated) - 1.0).abs() < 0.03, "{work} {elastic} {dissipated}");
    assert!(least >= -1e-15, "{least}");
    let at = |t: f64| forces.iter().min_by(|a, b| (a.0 - t).abs().total_cmp(&(b.0 - t).abs())).unwrap().1;
    // Against the motion, there and back.
    assert!(at(1.5) > 0.0 && at(3.2) < 0.0, "{} {}", at(1.5), at(3.2));
}

#[test]
fn a_free_track_is_long_enough_or_refused() {
    let grid = Grid::line(256, 16.0).unwrap();
    let parts = shape(Shape::Cylinder { radius: 1.0 });
    let slide = |end: f64| {
        simulation(
            grid,
            Boundary::Free,
            &parts,
            zener(0.2, 0.8, 1.0),
            0.25 * PI,
            at_speed(1.0, 0.0),
            TimeGrid::Uniform { end, steps: 1 },
        )
    };
    let message = March::new(slide(20.0)).err().unwrap().to_string();
    assert!(message.contains("travel") && message.contains("track"), "{message}");
    let rows = run(slide(5.0));
    assert!(rows.last().unwrap().1.coefficient > 0.1);
    let elastic = run(Simulation { creep: Creep::elastic(1.0), ..slide(2.0) });
    assert!(elastic.iter().all(|(row, friction)| friction.force == 0.0
        && (row.max_pressure / elastic[0].0.max_pressure - 1.0).abs() < 1e-2));
}

#[test]
fn a_run_goes_on_from_a_checkpoint_with_the_same_bits() {
    let grid = Grid::new([24, 16], [1.0, 0.7]).unwrap();
    let parts = vec![(Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] }, true)];
    let slide = || Simulation {
        quantities: Quantities::of(Quantity::of_motion()),
        ..simulation(
            grid,
            Boundary::Periodic,
            &parts,
            zener(0.2, 0.8, 0.3),
            0.01,
            at_speed(TAU / 20.0, 0.1),
            TimeGrid::Uniform { end: 1.0, steps: 12 },
        )
    };
    let mut whole = March::new(slide()).unwrap();
    for _ in 0..9 {
        whole.advance().unwrap();
    }
    let checkpoint = whole.checkpoint().into_owned();
    let mut resumed = March::resume(slide(), &checkpoint).unwrap();
    while let Some(step) = whole.advance().unwrap() {
        let (row, quantities) = (step.row(), step.quantities().to_vec());
        let other = resumed.advance().unwrap().unwrap();
        assert_eq!((row, quantities), (other.row(), other.quantities().to_vec()));
    }
}

#[test]
fn friction_is_right_while_the_body_still_creeps_under_the_load() {
    // Full contact with a wave that moves by a cell in ten retardation times: F = (q² h²/4) E''(q v), from the first second on.
    let grid = Grid::line(21, 0.021).unwrap();
    let parts = shape(Shape::Wave { amplitude: 1e-6, wavelength: [0.021, f64::INFINITY] });
    let creep = zener(0.25e-6, 0.75e-6, 0.1);
    let (v, q) = (2.1e-3, TAU / 0.021);
    let (storage, loss) = creep.to_relaxation().unwrap().complex(q * v);
    assert!(storage > loss);
    let exact = 0.25 * (q * 1e-6) * (q * 1e-6) * loss * 0.021;
    let rows = run(simulation(
        grid,
        Boundary::Periodic,
        &parts,
        creep,
        10e3 * 0.021,
        at_speed(v, 0.0),
        TimeGrid::Uniform { end: 6.0, steps: 1 },
    ));
    for (row, friction) in rows.iter().filter(|(row, _)| row.time() > 0.9) {
        // A step of a cell is five retardation times.
        assert!((friction.force / exact - 1.0).abs() < 0.03, "{}: {} {exact}", row.time(), friction.force);
    }
}

#[test]
fn a_stage_ends_at_a_friction_coefficient() {
    // Sliding starts with no friction, which then grows: the stage ends at half of what 60 steps reach. The same way in 60 steps
    // encloses the time; a coefficient that is met is met to 1e-6 of it.
    let grid = Grid::new([32, 8], [1.0, 0.25]).unwrap();
    let wave = shape(Shape::Wave { amplitude: 0.01, wavelength: [1.0, f64::INFINITY] });
    let slid = |event: Option<Event>, steps: usize| {
        let times = TimeGrid::Uniform { end: 2.0, steps };
        let path = at_speed(0.1, 0.0);
        let mut sliding =
            simulation(grid, Boundary::Periodic, &wave, zener(0.25, 0.75, 0.5), 0.1, path, times);
        sliding.loading.stages[0].until = event;
        run(sliding)
    };
    let all = slid(None, 60);
    let value = 0.5 * all.last().unwrap().1.coefficient;
    let first = all.iter().position(|(_, friction)| friction.coefficient >= value).unwrap();
    let number = RowNumber::from_name("friction_coefficient").unwrap();
    let (row, friction) = slid(Some(Event::Number(number, value)), 60).pop().unwrap();
    assert!((friction.coefficient - value).abs() <= 1e-6 * value, "{} {value}", friction.coefficient);
    assert!(all[first - 1].0.time() < row.time() && row.time() <= all[first].0.time());
}
