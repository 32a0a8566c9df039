//! Permanent flattening: what follows from the contact conditions of the dented surface.

use asperity::Drive;
use asperity::drive::March;
use asperity::load::{Course, Event, Programme, Stage};
use asperity::material::{Creep, CreepTerm};
use asperity::simulation::{Plasticity, Simulation};
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Control, Grid, History, Loading, SolverOptions, TimeGrid};
use ndarray::Array2;

/// A sphere whose elastic pressure would rise to 2.6 times the hardness.
fn capped_sphere(plasticity: Plasticity) -> Simulation {
    let grid = Grid::new([40, 40], [0.5, 0.5]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[sphere]).unwrap();
    Simulation {
        creep: Creep::elastic(0.25),
        hardness: 0.15,
        plasticity,
        solver: SolverOptions { tolerance: 1e-11, ..SolverOptions::default() },
        ..Simulation::new(grid, gap)
    }
}

struct State {
    load: f64,
    approach: f64,
    area: f64,
    capped: f64,
    pressure: Array2<f64>,
    gap: Array2<f64>,
    flattening: Array2<f64>,
}

fn run(simulation: Simulation) -> Vec<State> {
    let shape = simulation.grid.shape();
    let mut march = March::new(simulation).unwrap();
    let mut states = vec![];
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        let (mut gap, mut flattening) = (Array2::zeros(shape), Array2::zeros(shape));
        step.gap_into(&mut gap);
        step.flattening_into(&mut flattening);
        states.push(State {
            load: row.load,
            approach: row.approach,
            area: row.contact_area,
            capped: row.capped_area,
            pressure: step.pressure().to_owned(),
            gap,
            flattening,
        });
    }
    states
}

fn loaded(points: &[(f64, f64)], steps: usize, plasticity: Plasticity) -> Simulation {
    let end = points.last().unwrap().0;
    Simulation {
        loading: Loading { control: Control::Load, history: History::Table { points: points.to_vec() } }
            .into(),
        times: TimeGrid::Uniform { end, steps },
        ..capped_sphere(plasticity)
    }
}

fn largest(field: &Array2<f64>) -> f64 {
    field.iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

fn distance(a: &Array2<f64>, b: &Array2<f64>) -> f64 {
    largest(&(a - b))
}

#[test]
fn a_growing_elastic_load_leaves_the_overlap_of_the_reversible_cut_off_as_a_dent() {
    // Where every overlap grows with the load, the reversible solution meets the conditions of the dented surface
    // too: same pressure and approach at every row, and dents that are its overlaps. Unique solutions, so to the
    // solver's tolerance: 1e-11 of a displacement of 0.02.
    let up = [(0.0, 0.0), (1.0, 0.02)];
    let reversible = run(loaded(&up, 8, Plasticity::Cap));
    let lasting = run(loaded(&up, 8, Plasticity::Accumulate));
    assert!(reversible.last().unwrap().capped > 0.0);
    for (a, b) in reversible.iter().zip(&lasting) {
        assert!(distance(&a.pressure, &b.pressure) < 1e-8, "{}", a.load);
        assert!((a.approach - b.approach).abs() < 1e-10);
        let overlap = a.gap.mapv(|gap| (-gap).max(0.0));
        assert!(distance(&overlap, &b.flattening) < 1e-10, "{}", a.load);
        assert_eq!(largest(&a.flattening), 0.0);
        // The dented surfaces just touch there.
        assert!(b.gap.iter().all(|gap| *gap > -1e-10));
    }
    assert!(largest(&lasting.last().unwrap().flattening) > 1e-4);
}

#[test]
fn loading_again_to_the_same_load_is_elastic() {
    // Up, down to nothing, up again, in equal steps: 0..8, 8..16, 16..24, then the same to 32 and 40.
    let peak = 0.02;
    let points = [(0.0, 0.0), (1.0, peak), (2.0, 0.0), (3.0, peak), (4.0, 0.0), (5.0, peak)];
    let states = run(loaded(&points, 40, Plasticity::Accumulate));
    let [up, top, down, empty, again, back] = [4, 8, 12, 16, 20, 24].map(|n| &states[n]);
    // No further flattening, the same state at the peak: to the solver's tolerance, as above.
    for later in &states[8..] {
        assert!(distance(&top.flattening, &later.flattening) < 1e-9);
    }
    assert_eq!(top.area, back.area);
    assert!(distance(&top.pressure, &back.pressure) < 1e-7);
    assert!((top.approach - back.approach).abs() < 1e-10);
    // At half the load the dented surface is met deeper than the virgin one, on the way down and up alike.
    assert!((down.approach - again.approach).abs() < 1e-10);
    assert!(again.approach > 1.05 * up.approach, "{} {}", again.approach, up.approach);
    assert!(down.capped == 0.0 && up.capped > 0.0);
    // Unloaded, the dents remain: the first touch is where the surface now is, and no pressure.
    assert!(empty.area == 0.0 && empty.approach > 0.0 && largest(&empty.flattening) > 1e-4);
    // Every later cycle repeats the second one.
    for n in 16..24 {
        assert!((states[n].approach - states[n + 16].approach).abs() < 1e-9, "{n}");
    }
}

#[test]
fn the_reversible_cut_off_forgets() {
    let points = [(0.0, 0.0), (1.0, 0.02), (2.0, 0.0)];
    let states = run(loaded(&points, 16, Plasticity::Cap));
    for n in 0..8 {
        assert!((states[n].approach - states[16 - n].approach).abs() < 1e-10, "{n}");
        assert!(distance(&states[n].pressure, &states[16 - n].pressure) < 1e-8);
    }
}

#[test]
fn cycles_of_a_creeping_body_shake_down() {
    // The body stiffens against fast cycles only while it creeps: dents never heal and grow ever less.
    let mut points = vec![(0.0, 0.0)];
    for cycle in 0..8 {
        points.push((cycle as f64 + 0.5, 0.02));
        points.push((cycle as f64 + 1.0, 0.0));
    }
    let simulation = Simulation {
        creep: Creep {
            instantaneous: 0.15,
            terms: vec![CreepTerm { compliance: 0.15, retardation_time: 0.7 }],
            fluidity: 0.0,
        },
        ..loaded(&points, 64, Plasticity::Accumulate)
    };
    let states = run(simulation);
    for pair in states.windows(2) {
        assert!(pair[0].flattening.iter().zip(&pair[1].flattening).all(|(a, b)| b >= a));
    }
    let volume = |n: usize| states[8 * n].flattening.sum();
    let growth: Vec<f64> = (0..8).map(|n| volume(n + 1) - volume(n)).collect();
    assert!(growth[0] > 0.0 && growth[7] < 0.01 * growth[0], "{growth:?}");
    assert!(states.iter().all(|state| state.pressure.iter().all(|p| *p <= 0.15)));
}

#[test]
fn a_step_that_an_event_cuts_dents_once() {
    // Pressed until the approach reaches a value within a step: that step is solved several times, on the surface as
    // the row before has left it. As above the dents of a growing elastic load are the overlaps of the reversible
    // cut-off.
    let until = |plasticity| {
        let press = Stage {
            until: Some(Event::Approach(0.021)),
            ..Stage::new(Control::Load, History::Ramp { value: 0.03, duration: 1.0 })
        };
        let simulation = Simulation {
            loading: Programme::new(vec![press, Stage::new(Control::Approach, Course::Hold)]),
            times: TimeGrid::Uniform { end: 1.0, steps: 5 },
            ..capped_sphere(plasticity)
        };
        run(simulation)
    };
    let (reversible, lasting) = (until(Plasticity::Cap), until(Plasticity::Accumulate));
    assert_eq!(reversible.len(), lasting.len());
    let [a, b] = [&reversible, &lasting].map(|states| states.last().unwrap());
    assert!((a.approach - 0.021).abs() < 1e-9 && a.capped > 0.0, "{} {}", a.approach, a.capped);
    let overlap = a.gap.mapv(|gap| (-gap).max(0.0));
    assert!(largest(&overlap) > 1e-4);
    // The event is met to a millionth of the approach.
    assert!(distance(&overlap, &b.flattening) < 1e-7, "{}", distance(&overlap, &b.flattening));
}
