//! Steady states of motion against closed forms.

use asperity::Drive;
use std::f64::consts::{PI, TAU};

use asperity::step::Row;

use asperity::material::{Creep, CreepTerm};
use asperity::reference::HunterCylinder;
use asperity::simulation::Simulation;
use asperity::sliding::{Direction, Friction, Slopes, Steady, SteadyMotion};
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{Boundary, Control, Grid, History, Loading, SolverOptions};
use ndarray::Array2;

pub fn zener(instantaneous: f64, retarded: f64, time: f64) -> Creep {
    Creep {
        instantaneous,
        terms: vec![CreepTerm { compliance: retarded, retardation_time: time }],
        fluidity: 0.0,
    }
}

pub struct Case<'a> {
    pub grid: Grid,
    pub boundary: Boundary,
    pub parts: &'a [Part],
    pub creep: Creep,
    pub load: f64,
    pub direction: Direction,
    pub tolerance: f64,
}

impl Case<'_> {
    pub fn steady(&self, velocities: &[f64]) -> Steady {
        let gap = undeformed_gap(&self.grid, self.parts).unwrap();
        let slopes = Slopes::of(&self.grid, self.boundary, self.parts).unwrap();
        let simulation = Simulation {
            boundary: self.boundary,
            creep: self.creep.clone(),
            loading: Loading { control: Control::Load, history: History::Step { value: self.load } }.into(),
            solver: SolverOptions { tolerance: self.tolerance, ..SolverOptions::default() },
            ..Simulation::new(self.grid, gap)
        };
        let motion = SteadyMotion {
            direction: self.direction,
            velocities: velocities.to_vec(),
            slopes,
            shear_stress: None,
        };
        Steady::new(simulation, motion).unwrap()
    }

    pub fn run(&self, velocities: &[f64]) -> Vec<(Row, Friction, Array2<f64>)> {
        let mut steady = self.steady(velocities);
        let mut all = vec![];
        while let Some(step) = steady.advance().unwrap() {
            all.push((step.row(), step.friction().unwrap(), step.pressure().to_owned()));
        }
        all
    }
}

pub fn shape(shape: Shape) -> [Part; 1] {
    [Part::Shape { shape, center: [0.0, 0.0] }]
}

#[test]
fn a_rolling_cylinder_is_that_of_hunter_and_of_an_industrial_code() {
    // N, mm, MPa: half-width, centre, friction coefficient, largest pressure (Hunter 1961), and the largest pressure that the
    // program CONTACT prints for its example visc_cylindr.
    let c = 0.000524934383202;
    for (time, a, mu, p_max, printed) in [
        (0.009, 4.87256757381, 0.0244435266358, 78.7336253409, 78.74),
        (0.045, 4.5105206273, 0.011916309216, 84.71801721, 84.72),
        (2.0, 0.0, 0.000648419, 85.302078062, 85.31),
    ] {
        let case = Case {
            grid: Grid::line(600, 22.0).unwrap(),
            boundary: Boundary::Free,
            parts: &shape(Shape::Cylinder { radius: 50.0 }),
            creep: zener(c, c, time),
            load: 600.0,
            direction: Direction::X,
            tolerance: 1e-9,
        };
        let (row, friction, _) = case.run(&[1000.0]).remove(0);
        // a/dx = 128: first to second order in the cell.
        assert!((friction.coefficient / mu - 1.0).abs() < 1e-3);
        assert!((row.max_pressure / p_max - 1.0).abs() < 1e-4);
        assert!((row.max_pressure - printed).abs() < 0.01);
        assert!(a == 0.0 || (row.contact_area - 2.0 * a).abs() < 2.0 * 22.0 / 600.0);
        assert!(friction.uncertainty < 1e-2 && friction.power > 0.0);
    }
}

#[test]
fn a_rolling_cylinder_loses_what_hunter_says_at_any_contrast_and_speed() {
    // C0 = 1/k, C1 = 1 - 1/k, unit retardation time and radius, relaxed half-width 1.
    for (k, v) in [
        (2.0, 0.1),
        (2.0, 1.0),
        (2.0, 3.0),
        (10.0, 0.3),
        (10.0, 1.0),
        (10.0, 10.0),
        (100.0, 3.0),
        (100.0, 10.0),
    ] {
        let (creep, load) = (zener(1.0 / k, 1.0 - 1.0 / k, 1.0), 0.25 * PI);
        let exact = HunterCylinder::under_load(1.0, &creep, v, load).unwrap();
        // The contact lies within the relaxed half-width 1 of the middle; 128 cells to its half-width.
        let length = 2.5_f64;
        let cells = (128.0 * length / exact.half_width).ceil() as usize;
        let case = Case {
            grid: Grid::line(cells, length).unwrap(),
            boundary: Boundary::Free,
            parts: &shape(Shape::Cylinder { radius: 1.0 }),
            creep,
            load,
            direction: Direction::X,
            tolerance: 1e-8,
        };
        let (row, friction, _) = case.run(&[v]).remove(0);
        let [off_mu, off_p] = [
            friction.coefficient / exact.friction_coefficient() - 1.0,
            row.max_pressure / exact.peak().1 - 1.0,
        ];
        // At v = 0.3 the pressure peaks at the front, within a length of l C0/(C0 + C1) = 12 cells.
        let peak = if v == 0.3 { 2e-3 } else { 1e-4 };
        assert!(off_mu.abs() < 1e-4 && off_p.abs() < peak, "k = {k}, v = {v}: {off_mu:e} {off_p:e}");
    }
}

/// E*(t) = 1 + 3 exp(-t/0.5) + 2 exp(-t/5).
fn two_terms() -> asperity::material::Relaxation {
    asperity::material::Relaxation::absolute(1.0, &[(3.0, 0.5), (2.0, 5.0)]).unwrap()
}

#[test]
fn full_contact_with_a_wave_is_exact_on_any_grid() {
    let (h1, q) = (0.01, TAU);
    let relaxation = two_terms();
    for (cells, direction) in [([16, 1], Direction::X), ([9, 4], Direction::X), ([6, 20], Direction::Y)] {
        let along_y = direction == Direction::Y;
        let (line, wavelength) =
            (cells[1] == 1, if along_y { [f64::INFINITY, 1.0] } else { [1.0, f64::INFINITY] });
        let grid = if line { Grid::line(16, 1.0).unwrap() } else { Grid::new(cells, [1.0, 1.0]).unwrap() };
        let case = Case {
            grid,
            boundary: Boundary::Periodic,
            parts: &shape(Shape::Wave { amplitude: h1, wavelength }),
            creep: relaxation.to_creep().unwrap(),
            load: 1.0,
            direction,
            tolerance: 1e-12,
        };
        let velocities = [0.001, 0.01, 0.1, 1.0, 10.0];
        for (v, (row, friction, _)) in velocities.iter().zip(case.run(&velocities)) {
            let (storage, loss) = relaxation.complex(q * v);
            let stress = 0.25 * q * q * h1 * h1 * loss;
            let amplitude = 0.5 * q * h1 * storage.hypot(loss);
            assert!(
                (friction.force / stress - 1.0).abs() < 1e-9,
                "{cells:?} {v}: {} {stress}",
                friction.force
            );
            // The crest of the pressure lies between two cells.
            assert!(row.max_pressure <= 1.0 + amplitude * (1.0 + 1e-9));
            // The geometric mean of an error of the solve, 1e-12, and what central differences miss of a wave.
            assert!(friction.uncertainty < 1e-5 && (friction.power / (v * stress) - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn a_sphere_tends_to_its_limits_at_low_and_high_speed() {
    // W = 4/3, R = 1, C = 0.1 and 0.9, retardation time 1: the relaxed contact radius is 1.
    let run = |n: usize, v: f64| {
        let case = Case {
            grid: Grid::new([n, n], [4.0, 4.0]).unwrap(),
            boundary: Boundary::Free,
            parts: &shape(Shape::Sphere { radius: 1.0 }),
            creep: zener(0.1, 0.9, 1.0),
            load: 4.0 / 3.0,
            direction: Direction::X,
            tolerance: 1e-6,
        };
        let (_, friction, pressure) = case.run(&[v]).remove(0);
        // Σ p dh/dx over the load.
        let place = |i: usize| (i as f64 + 0.5 - 0.5 * n as f64) * 4.0 / n as f64;
        let slopes: f64 = pressure.indexed_iter().map(|((i, _), p)| p * place(i)).sum();
        (friction, slopes / pressure.sum())
    };
    // An independent solver on 64 x 64 cells, to its digits: its friction is the sum over the slopes.
    for (v, other) in
        [(0.1, 0.0834), (0.3, 0.2146), (1.0, 0.3957), (3.0, 0.3054), (10.0, 0.1288), (100.0, 0.01498)]
    {
        let (_, slopes) = run(64, v);
        assert!((slopes / other - 1.0).abs() < 2e-3, "{v}");
    }
    // Exact: mu -> 0.9 v and 1.55119 / v; the error at low speed falls like dx.
    for (n, v, exact, most) in
        [(64, 1e-3, 0.9e-3, 0.03), (128, 1e-3, 0.9e-3, 0.015), (64, 1e3, 1.55119297682e-3, 0.01)]
    {
        let friction = run(n, v).0;
        let error = (friction.coefficient / exact - 1.0).abs();
        assert!(error < most && error < friction.uncertainty, "{n} {v}: {error:e} {}", friction.uncertainty);
    }
}

#[test]
fn directions_are_equal_and_elastic_bodies_lose_nothing() {
    let rough = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 0.5,
        shortest: 0.08,
        roll_off: 0.25,
        seed: 1,
    };
    let grid = Grid::new([48, 48], [1.0, 1.0]).unwrap();
    let heights = rough.heights(&grid).unwrap();
    let part = |heights: Array2<f64>| [Part::Heights { name: "rough".into(), heights }];
    let turned = heights.t().as_standard_layout().to_owned();
    let (as_is, mirrored) = (part(heights), part(turned));
    for boundary in [Boundary::Periodic, Boundary::Free] {
        let case = |parts, direction, creep| Case {
            grid,
            boundary,
            parts,
            creep,
            load: 5e-3,
            direction,
            tolerance: 1e-8,
        };
        let creep = zener(0.1, 0.9, 1.0);
        let along_x = case(&as_is, Direction::X, creep.clone()).run(&[0.05, 0.5]);
        let along_y = case(&mirrored, Direction::Y, creep).run(&[0.05, 0.5]);
        for ((row, friction, p), (other_row, other, q)) in along_x.iter().zip(&along_y) {
            assert!((friction.force / other.force - 1.0).abs() < 1e-6, "{boundary:?}");
            assert!((row.contact_area - other_row.contact_area).abs() < 1e-12);
            // n is s turned by a right angle: the mirror image has the opposite side force.
            assert!((friction.side + other.side).abs() < 1e-6 * friction.force);
            assert!(p.iter().zip(q.t().iter()).all(|(p, q)| (p - q).abs() < 1e-5 * row.max_pressure));
        }
        let elastic = case(&as_is, Direction::X, Creep::elastic(0.1)).run(&[1.0]);
        assert!(elastic[0].1.power < 1e-12, "{boundary:?}");
        assert_eq!((elastic[0].1.force, elastic[0].1.side), (0.0, 0.0));
    }
}

/// A rubber of 13 terms over 13 decades, 1000 times stiffer at once than relaxed.
fn rubber() -> Creep {
    let terms: Vec<(f64, f64)> =
        (0..13).map(|k| (10f64.powf(3.0 - 0.2307 * f64::from(k)), 10f64.powi(k - 9))).collect();
    let total: f64 = terms.iter().map(|t| t.0).sum();
    let scaled: Vec<(f64, f64)> = terms.iter().map(|(e, t)| (999.0 * e / total, *t)).collect();
    asperity::material::Relaxation::absolute(1.0, &scaled).unwrap().to_creep().unwrap()
}

#[test]
fn a_rough_rubber_converges_at_every_speed_over_eight_decades() {
    let n = 128;
    let rough = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 0.5,
        shortest: 8.0 / n as f64,
        roll_off: 0.25,
        seed: 1,
    };
    let grid = Grid::new([n, n], [1.0, 1.0]).unwrap();
    let case = Case {
        grid,
        boundary: Boundary::Periodic,
        parts: &[Part::SelfAffine(rough)],
        creep: rubber(),
        load: 0.03,
        direction: Direction::X,
        tolerance: 1e-4,
    };
    let velocities: Vec<f64> = (0..17).map(|k| 10f64.powf(3.0 - 0.5 * f64::from(k))).collect();
    let rows = case.run(&velocities);
    let mut work: Vec<usize> = rows.iter().map(|(row, ..)| row.convolutions).collect();
    work.sort_unstable();
    // The median is 90 to 150 from 64 x 64 to 256 x 256 cells.
    assert!(work[8] <= 200, "{work:?}");
    // Slower is softer: the area grows.
    assert!(rows.windows(2).all(|pair| pair[1].0.contact_area >= pair[0].0.contact_area));
    assert!(rows.iter().all(|(_, friction, _)| friction.power > 0.0));
}

/// A cylinder of radius 1 on a line of cells 4 long, C(∞) = 1, of so many times the compliance at once and one term of time 1; the
/// half-width of the relaxed contact is 1.
pub fn cylinder<'a>(parts: &'a [Part], cells: usize, contrast: f64, tolerance: f64) -> Case<'a> {
    Case {
        grid: Grid::line(cells, 4.0).unwrap(),
        boundary: Boundary::Free,
        parts,
        creep: zener(1.0 / contrast, 1.0 - 1.0 / contrast, 1.0),
        load: 0.25 * PI,
        direction: Direction::X,
        tolerance,
    }
}

#[test]
fn a_state_that_failed_has_the_number_of_its_velocity_and_the_next_start_is_the_last_good_one() {
    let parts = shape(Shape::Cylinder { radius: 1.0 });
    let case = cylinder(&parts, 256, 100.0, 1e-6);
    let mut steady = case.steady(&[0.01, 0.3]);
    let mut simulation = steady.simulation().clone();
    simulation.solver.max_iterations = 20;
    steady = Steady::new(simulation, steady.motion().clone()).unwrap();
    let good = steady.advance().unwrap().unwrap().pressure().to_owned();
    for _ in 0..2 {
        assert!(matches!(steady.advance(), Err(asperity::Error::NotConverged(_))));
        let failed = steady.last().unwrap();
        assert_eq!((failed.index(), failed.friction().unwrap().velocity), (1, 0.3));
        assert!(failed.row().residual > 1e-6 && failed.pressure() != good);
        assert!(steady.done() == 1 && !steady.finished());
        assert_eq!(steady.checkpoint().fields[0].1, good);
    }
}

#[test]
fn a_resumed_sweep_has_the_same_bits() {
    let parts = shape(Shape::Cylinder { radius: 1.0 });
    let case = cylinder(&parts, 128, 100.0, 1e-6);
    // The memory of the first two reaches beyond the domain.
    let velocities = [10.0, 3.0, 0.3, 1.0];
    let mut steady = case.steady(&velocities);
    let mut rows = vec![];
    // No shear stress is given.
    let friction = |step: &asperity::step::Step| Friction { total: 0.0, ..step.friction().unwrap() };
    while let Some(step) = steady.advance().unwrap() {
        rows.push((step.row(), friction(&step), step.pressure().to_owned()));
    }
    for done in 1..velocities.len() {
        let mut first = case.steady(&velocities);
        (0..done).for_each(|_| assert!(first.advance().unwrap().is_some()));
        let (simulation, motion) = (first.simulation().clone(), first.motion().clone());
        let mut again = Steady::resume(simulation, motion, &first.checkpoint()).unwrap();
        for (row, forces, pressure) in &rows[done..] {
            let step = again.advance().unwrap().unwrap();
            assert_eq!((step.row(), friction(&step)), (*row, *forces));
            assert_eq!(step.pressure(), *pressure);
        }
        assert!(again.finished() && again.advance().unwrap().is_none());
    }
}

#[test]
fn memory_of_a_sweep_is_bounded_whatever_the_velocity() {
    let parts = shape(Shape::Cylinder { radius: 1.0 });
    let steady = cylinder(&parts, 128, 100.0, 1e-6).steady(&[1.0]);
    assert!(Steady::bytes(steady.simulation(), steady.motion().direction) < 1 << 20);
    let grid = Grid::new([512, 512], [1.0, 1.0]).unwrap();
    let ball = shape(Shape::Sphere { radius: 10.0 });
    let case = Case { grid, ..cylinder(&ball, 128, 100.0, 1e-6) };
    let steady = case.steady(&[1.0]);
    let bytes = Steady::bytes(steady.simulation(), steady.motion().direction);
    assert!((1 << 28..3 << 30).contains(&bytes), "{bytes}");
}

#[test]
fn single_terms_of_any_contrast_converge_alone_at_any_speed() {
    let cylinder_parts = shape(Shape::Cylinder { radius: 1.0 });
    let rough = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 0.5,
        shortest: 0.125,
        roll_off: 0.25,
        seed: 1,
    };
    let rough_parts = [Part::SelfAffine(rough)];
    for contrast in [100.0, 500.0, 3000.0] {
        for v in [0.1, 0.7, 3.0, 10.0, 100.0] {
            let line = cylinder(&cylinder_parts, 128, contrast, 1e-6);
            let plane = Case {
                grid: Grid::new([64, 64], [1.0, 1.0]).unwrap(),
                boundary: Boundary::Periodic,
                load: 0.03,
                tolerance: 1e-5,
                ..cylinder(&rough_parts, 128, contrast, 1e-6)
            };
            for case in [line, plane] {
                let (row, friction, _) = case.run(&[v]).remove(0);
                assert!(row.residual <= case.tolerance && friction.power >= 0.0, "{contrast} {v}");
            }
        }
    }
}
