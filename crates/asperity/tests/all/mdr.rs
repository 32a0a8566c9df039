//! The march on a grid against the row of springs: loading, unloading, opening, loading again, jumps.

use asperity::Drive;
use asperity::drive::March;
use asperity::material::Relaxation;
use asperity::reference::{Mdr, MdrOptions, MdrProfile, MdrState};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Control, Grid, History, Loading, TimeGrid};

/// E*(t) = 2 + 2 exp(-t/0.5) + exp(-t/2).
fn relaxation() -> Relaxation {
    Relaxation::absolute(2.0, &[(2.0, 0.5), (1.0, 2.0)]).unwrap()
}

fn both(
    shape: Shape,
    size: f64,
    profile: MdrProfile,
    loading: Loading,
    end: f64,
    steps: usize,
) -> Vec<(Row, MdrState)> {
    let grid = Grid::new([64, 64], [size, size]).unwrap();
    let gap = undeformed_gap(&grid, &[Part::Shape { shape, center: [0.0, 0.0] }]).unwrap();
    let simulation = Simulation {
        creep: relaxation().to_creep().unwrap(),
        loading: loading.clone().into(),
        times: TimeGrid::Uniform { end, steps },
        ..Simulation::new(grid, gap)
    };
    let times: Vec<f64> = (1..=steps).map(|n| end * n as f64 / steps as f64).collect();
    let springs = Mdr::march(profile, &relaxation(), &loading, &times, MdrOptions::default()).unwrap();
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    assert_eq!(rows.len(), springs.len());
    for (row, state) in rows.iter().zip(&springs) {
        assert!((row.time() - state.time).abs() < 1e-9, "{} {}", row.time(), state.time);
    }
    rows.into_iter().zip(springs).collect()
}

#[test]
fn a_sphere_that_is_loaded_unloaded_opened_and_loaded_again() {
    // The load: up, down to a tenth, up, a jump down, held, to zero (open), held there, up again.
    let points = vec![
        (0.0, 0.0),
        (1.0, 1.0),
        (1.6, 0.1),
        (2.4, 1.2),
        (2.4, 0.5),
        (3.0, 0.5),
        (3.5, 0.0),
        (3.8, 0.0),
        (4.6, 0.9),
    ];
    let loading = Loading { control: Control::Load, history: History::Table { points } };
    let profile = MdrProfile::Paraboloid { radius: 1.0 };
    let pairs = both(Shape::Sphere { radius: 1.0 }, 1.8, profile, loading, 4.6, 230);
    let largest = pairs.iter().map(|(row, _)| row.approach).fold(0.0, f64::max);
    for (row, state) in &pairs {
        // 25 cells to the radius: (dx/a)^2 = 1.6e-3, the steps of 0.02 less. At first touch
        // and last contact a handful of cells carry the load.
        assert!((row.approach - state.approach).abs() < 2e-3 * largest, "{row:?}\n{state:?}");
        let radius = (row.contact_area_corrected / std::f64::consts::PI).sqrt();
        if state.contact_radius > 0.3 {
            assert!((radius / state.contact_radius - 1.0).abs() < 0.03, "{row:?}\n{state:?}"); // a cell in 25
        }
    }
    // The body is open for a while, and the second contact is not the first.
    assert!(pairs.iter().any(|(row, _)| row.time() > 3.4 && row.contact_area == 0.0));
}

#[test]
fn a_cone_whose_approach_comes_and_goes() {
    let points = vec![
        (0.0, 0.05),
        (0.8, 0.1),
        (0.8, 0.07),
        (1.2, 0.02),
        (1.5, 0.09),
        (2.5, 0.09),
        (3.0, -0.02),
        (3.4, 0.08),
    ];
    let loading = Loading { control: Control::Approach, history: History::Table { points } };
    let profile = MdrProfile::Cone { slope: 0.1 };
    let pairs = both(Shape::Cone { slope: 0.1 }, 1.6, profile, loading, 3.4, 170);
    let largest = pairs.iter().map(|(row, _)| row.load).fold(0.0, f64::max);
    // The tip of a cone is a cell wide: the grid's cone is blunt by about dx slope / 2, and the load an
    // order of dx/a = 1/25 too small for the same approach from first touch. Held against the shape of
    // the whole history.
    for (row, state) in &pairs {
        assert!((row.load - state.load).abs() < 0.04 * largest, "{row:?}\n{state:?}");
    }
    assert!(pairs.iter().any(|(row, state)| row.load == 0.0 && state.load == 0.0));
}

/// Random broken lines, seeded: values at random times, from zero, with returns to zero in between.
fn random_history(seed: u64, largest: f64, least: f64) -> Vec<(f64, f64)> {
    // Numerical Recipes' generator; its upper bits.
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut points = vec![(0.0, 0.0)];
    let mut time = 0.0;
    for n in 0..7 {
        time += 0.2 + 0.8 * next();
        let value = least + (largest - least) * next();
        points.push((time, if n % 3 == 2 { least.min(0.0) } else { value }));
    }
    points
}

#[test]
fn random_loads_and_approaches_follow_the_springs() {
    // Sphere and cone, load and approach; histories that would open the contact from within the springs refuse.
    let sphere = (Shape::Sphere { radius: 1.0 }, MdrProfile::Paraboloid { radius: 1.0 });
    let cone = (Shape::Cone { slope: 0.3 }, MdrProfile::Cone { slope: 0.3 });
    let mut compared = 0;
    for (shape, profile) in [sphere, cone] {
        for (control, largest, least) in [(Control::Load, 0.8, 0.0), (Control::Approach, 0.16, -0.04)] {
            for seed in 1..=8 {
                let points = random_history(seed, largest, least);
                let end = points.last().unwrap().0;
                let loading = Loading { control, history: History::Table { points } };
                let options = MdrOptions { springs: 400, substeps: 4 };
                let steps = 100;
                let times: Vec<f64> = (1..=steps).map(|n| end * f64::from(n) / f64::from(steps)).collect();
                let springs = Mdr::march(profile, &relaxation(), &loading, &times, options);
                let Ok(springs) = springs else { continue };
                let grid = Grid::new([48, 48], [1.8, 1.8]).unwrap();
                let gap = undeformed_gap(&grid, &[Part::Shape { shape, center: [0.0, 0.0] }]).unwrap();
                let simulation = Simulation {
                    creep: relaxation().to_creep().unwrap(),
                    loading: loading.into(),
                    times: TimeGrid::List(times),
                    ..Simulation::new(grid, gap)
                };
                let mut march = March::new(simulation).unwrap();
                let mut pairs = vec![];
                while let Some(step) = march.advance().unwrap() {
                    pairs.push((step.row(), springs[pairs.len()]));
                }
                assert_eq!(pairs.len(), springs.len());
                let peak =
                    |f: &dyn Fn(&Row) -> f64| pairs.iter().map(|(row, _)| f(row).abs()).fold(0.0, f64::max);
                let error = match control {
                    Control::Approach => {
                        let load = peak(&|row| row.load);
                        pairs
                            .iter()
                            .map(|(row, state)| (row.load - state.load).abs() / load)
                            .fold(0.0, f64::max)
                    }
                    _ => {
                        let deep = peak(&|row| row.approach);
                        pairs
                            .iter()
                            .map(|(row, s)| (row.approach - s.approach).abs() / deep)
                            .fold(0.0, f64::max)
                    }
                };
                // 48 cells over 1.8, radii of 0.3 to 0.6: dx/a is 0.06 to 0.12. A sphere's error is its square, and that
                // of the moments when a few cells carry all.
                // The cone is lower by up to half a cell's rise; its load goes as the square of the approach, and twice that
                // where it comes and goes.
                let blunt = 0.3 * 1.8 / 48.0 / peak(&|row| row.approach);
                let tolerance = match (shape, control) {
                    (Shape::Cone { .. }, Control::Approach) => 2.0 * blunt,
                    (Shape::Cone { .. }, _) => blunt,
                    _ => 0.02,
                };
                println!("{profile:?} {control:?} {seed}: {error:.4} {tolerance:.4}");
                assert!(error < tolerance, "{profile:?} {control:?} seed {seed}: {error}");
                compared += 1;
            }
        }
    }
    assert!(compared >= 24, "{compared} of 32 compared");
}
