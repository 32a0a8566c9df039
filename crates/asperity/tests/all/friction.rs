//! The friction of steady states and what is stated of its error, against closed forms and finer grids.

use std::f64::consts::PI;

use asperity::finding::Diagnostics;
use asperity::material::{Creep, CreepTerm};
use asperity::reference::HunterCylinder;
use asperity::sliding::{Direction, Friction, MovingGap, Steady, SteadyMotion};
use asperity::surface::{Part, Roughness, SelfAffine, Shape};
use asperity::{Boundary, Control, Drive, Grid, History, Loading, Simulation};

use crate::sliding::{Case, cylinder, shape, zener};

/// Counts errors that are stated, and those that are overstated more than tenfold.
#[derive(Default)]
struct Stated {
    all: usize,
    missed: Vec<String>,
    overstated: usize,
}

impl Stated {
    fn count(&mut self, what: String, force: f64, uncertainty: f64) {
        let error = (force - 1.0).abs();
        self.all += 1;
        if uncertainty < error {
            self.missed.push(format!("{what}: {error:.1e}, stated {uncertainty:.1e}"));
        }
        self.overstated += usize::from(uncertainty > 10.0 * error);
    }

    /// The stated error covers the true one in 95 of 100 states.
    fn assert(&self) {
        assert!(20 * self.missed.len() <= self.all, "{:?} of {}", self.missed, self.all);
    }
}

#[test]
fn friction_of_a_cylinder_is_that_of_hunter_from_the_slow_to_the_fast_limit() {
    let parts = shape(Shape::Cylinder { radius: 1.0 });
    let mut stated = Stated::default();
    for cells in [64, 256] {
        for contrast in [5.0, 100.0, 3000.0] {
            for v in [1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0, 1e4] {
                let case = cylinder(&parts, cells, contrast, 1e-7);
                let exact = HunterCylinder::under_load(1.0, &case.creep, v, 0.25 * PI).unwrap();
                let friction = case.run(&[v])[0].1;
                let force = friction.coefficient / exact.friction_coefficient();
                stated.count(format!("{cells} {contrast} {v}"), force, friction.uncertainty);
                // In the first body of the coarse grid the fast contact is narrower than a cell.
                let width = 2.0 * exact.half_width * cells as f64 / 4.0;
                let most = if width < 4.0 { 0.1 } else { 0.05 };
                assert!((force - 1.0).abs() < most, "{cells} {contrast} {v}: {force}");
            }
        }
    }
    stated.assert();
    assert!(5 * stated.overstated <= stated.all, "{} of {}", stated.overstated, stated.all);
}

fn rough(cells: usize, contrast: f64, velocities: &[f64]) -> Vec<Friction> {
    let surface = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 0.5,
        shortest: 0.125,
        roll_off: 0.25,
        seed: 1,
    };
    let case = Case {
        grid: Grid::new([cells, cells], [1.0, 1.0]).unwrap(),
        boundary: Boundary::Periodic,
        parts: &[Part::SelfAffine(surface)],
        creep: zener(1.0 / contrast, 1.0 - 1.0 / contrast, 1.0),
        load: 0.01,
        direction: Direction::X,
        tolerance: 1e-7,
    };
    case.run(velocities).into_iter().map(|(_, friction, _)| friction).collect()
}

#[test]
fn friction_of_a_rough_surface_holds_at_both_ends_of_a_sweep() {
    // The sum over the slopes is off by 3 and by 190 times the force on the coarse grid at the first and the last of these.
    let velocities = [1e-4, 0.1, 10.0, 1e3];
    let mut stated = Stated::default();
    for contrast in [5.0, 100.0] {
        let fine = rough(128, contrast, &velocities);
        for cells in [32, 64] {
            for (friction, fine) in rough(cells, contrast, &velocities).iter().zip(&fine) {
                let what = format!("{cells} {contrast} {}", fine.velocity);
                let force = friction.force / fine.force;
                // Four and eight cells to the shortest wave.
                assert!((force - 1.0).abs() < if cells == 32 { 0.3 } else { 0.06 }, "{what}: {force}");
                assert!((friction.power / (friction.velocity * friction.force) - 1.0).abs() < 1e-12);
                stated.count(what, force, friction.uncertainty);
            }
        }
    }
    stated.assert();
}

#[test]
fn a_steady_state_is_judged_by_its_own_force() {
    // At low speed a contact of a few cells leaves friction open, whatever the other velocities.
    let parts = shape(Shape::Sphere { radius: 1.0 });
    let case = Case {
        grid: Grid::new([16, 16], [4.0, 4.0]).unwrap(),
        load: 4.0 / 3.0,
        ..cylinder(&parts, 16, 5.0, 1e-6)
    };
    let rows_of = |velocities: &[f64]| {
        let mut steady = case.steady(velocities);
        let mut diagnostics = Diagnostics::new(steady.simulation(), Default::default());
        while let Some(step) = steady.advance().unwrap() {
            diagnostics.see(&step, &step.row());
        }
        let found = diagnostics.findings(steady.simulation());
        found
            .into_iter()
            .find(|finding| finding.code == "friction-uncertain")
            .and_then(|finding| finding.rows)
    };
    assert_eq!(rows_of(&[1e-3]), Some([0, 0]));
    assert_eq!(rows_of(&[1e-3, 1.0]).map(|rows| rows[0]), Some(0));
}

#[test]
fn single_terms_of_large_contrast_converge_by_exchanges_of_cells() {
    // Cylinders on a periodic line on which Newton's steps and the continuation go round in circles: C(inf)/C0, the load over pi, cells,
    // v lambda over the radius.
    let cases = [
        (1000.0, 0.25, 128, 6.463),
        (2000.0, 0.5, 128, 4.403),
        (3000.0, 0.25, 256, 4.403),
        (3000.0, 0.25, 128, 9.487),
        // Sets on which GMRES stalls.
        (3000.0, 0.5, 512, 0.948_683),
        (3000.0, 0.5, 512, 1.392_477),
        (2000.0, 0.5, 512, 1.392_477),
    ];
    for (contrast, load, cells, velocity) in cases {
        let grid = Grid::line(cells, 8.0).unwrap();
        let cylinder = Part::Shape { shape: Shape::Cylinder { radius: 1.0 }, center: [0.0, 0.0] };
        let gap = MovingGap::new(&grid, Boundary::Periodic, &[(cylinder, true)]).unwrap();
        let (h, slopes) = gap.at(0.0, Direction::X);
        let term = CreepTerm { compliance: 1.0 - 1.0 / contrast, retardation_time: 1.0 };
        let simulation = Simulation {
            boundary: Boundary::Periodic,
            creep: Creep { instantaneous: 1.0 / contrast, terms: vec![term], fluidity: 0.0 },
            loading: Loading { control: Control::Load, history: History::Step { value: load * PI } }.into(),
            ..Simulation::new(grid, h)
        };
        let velocities = vec![velocity];
        let motion = SteadyMotion { direction: Direction::X, velocities, slopes, shear_stress: None };
        let mut steady = Steady::new(simulation, motion).unwrap();
        let step = steady.advance().unwrap().unwrap();
        let (row, friction) = (step.row(), step.friction().unwrap());
        // The solver's tolerance, and the energy that the bodies lose.
        assert!(row.residual <= 1e-6 && friction.force > 0.0, "{contrast} {velocity}: {row:?}");
        println!("{contrast} {load} {cells} {velocity}: {} convolutions", row.convolutions);
    }
}
