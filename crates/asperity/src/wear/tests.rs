//! Wear against closed forms.

use std::sync::Arc;

use ndarray::Array2;

use super::Wear;
use crate::contact::Solver;
use crate::drive::{Drive, March};
use crate::grid::{Boundary, Grid};
use crate::load::{Control, History, Loading};
use crate::material::{Creep, CreepTerm};
use crate::process::Motion;
use crate::quantities::{Quantities, Quantity};
use crate::simulation::{Plasticity, Simulation};
use crate::sliding::{Direction, MovingGap, Path};
use crate::surface::{Part, Shape, undeformed_gap};
use crate::tangential::{Coupling, Tangential, TangentialControl};
use crate::time::TimeGrid;

const WATCHED: [Quantity; 6] = [
    Quantity::WearVolume,
    Quantity::CounterbodyWearVolume,
    Quantity::WearDistance,
    Quantity::WearDepthMax,
    Quantity::WearError,
    Quantity::WornRoughness,
];

fn sphere(radius: f64) -> Part {
    Part::Shape { shape: Shape::Sphere { radius }, center: [0.0, 0.0] }
}

/// A gap under a constant load that slides at 1 m/s for `end` seconds.
fn sliding(grid: Grid, gap: Array2<f64>, load: f64, k: [f64; 2], end: f64, steps: usize) -> Simulation {
    let path = Path::of_velocity(History::Step { value: 1.0 }, 0.0).unwrap();
    Simulation {
        loading: Loading { control: Control::Load, history: History::Step { value: load } }.into(),
        times: TimeGrid::Uniform { end, steps },
        quantities: Quantities::of(WATCHED),
        wear: Some(Arc::new(Wear { path: Some(path), ..Wear::new(k) })),
        ..Simulation::new(grid, gap)
    }
}

struct End {
    quantities: Vec<f64>,
    pressure: Array2<f64>,
    depth: [Array2<f64>; 2],
    area: f64,
    convolutions: usize,
}

impl End {
    fn of(&self, quantity: Quantity) -> f64 {
        self.quantities[WATCHED.iter().position(|own| *own == quantity).unwrap()]
    }
}

fn run(simulation: Simulation) -> End {
    let mut march = March::new(simulation).unwrap();
    let (mut end, mut convolutions) = (None, 0);
    while let Some(step) = march.advance().unwrap() {
        convolutions += step.row().convolutions;
        let empty = || Array2::zeros(step.pressure().dim());
        let mut depth = [empty(), empty()];
        depth.iter_mut().enumerate().for_each(|(body, depth)| step.wear_depth_into(body, depth));
        end = Some(End {
            quantities: step.quantities().to_vec(),
            pressure: step.pressure().to_owned(),
            depth,
            area: step.row().contact_area,
            convolutions,
        });
    }
    end.unwrap()
}

fn rough(grid: &Grid) -> Array2<f64> {
    let gap = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let (x, y) = (grid.x(i), grid.y(j));
        0.02 * (1.0 - (19.0 * x + 0.3).cos() * (23.0 * y + 0.7).cos()) + 4e-3 * (1.0 - (71.0 * x).cos())
    });
    let least = gap.iter().copied().fold(f64::INFINITY, f64::min);
    gap - least
}

/// V = k W s for every shape, step, material and cut-off, and both bodies take their shares.
#[test]
fn the_worn_volume_is_that_of_archard() {
    let grid = Grid::new([24, 20], [1.0, 1.0]).unwrap();
    let creep = Creep {
        instantaneous: 1.0,
        terms: vec![CreepTerm { compliance: 2.0, retardation_time: 0.7 }],
        fluidity: 0.1,
    };
    for boundary in [Boundary::Free, Boundary::Periodic] {
        for (gap, hardness, plasticity) in [
            (rough(&grid), f64::INFINITY, Plasticity::Cap),
            (undeformed_gap(&grid, &[sphere(1.0)]).unwrap(), 0.05, Plasticity::Accumulate),
        ] {
            for (steps, creep) in [(1, Creep::elastic(1.0)), (7, creep.clone())] {
                let simulation = Simulation {
                    boundary,
                    hardness,
                    plasticity,
                    creep,
                    ..sliding(grid, gap.clone(), 5e-3, [1.0, 3.0], 2.0, steps)
                };
                let end = run(simulation);
                let [volume, track] =
                    [Quantity::WearVolume, Quantity::CounterbodyWearVolume].map(|q| end.of(q));
                // Sums of 480 cells; the load is met to 4e-13.
                assert!((volume / (4.0 * 5e-3 * 2.0) - 1.0).abs() < 1e-12, "{volume}");
                assert!((track / volume - 0.75).abs() < 1e-14);
                let depths = end.depth.each_ref().map(|depth| depth.sum() * grid.cell_area());
                assert!((depths[0] + depths[1] - volume).abs() < 1e-12 * volume);
                assert!((end.of(Quantity::WearDistance) - 2.0).abs() < 1e-14);
            }
        }
    }
}

/// Worn far deeper than it yields, a sphere ends in a flat of a = (4 R k W s/π)^(1/4) at depth a²/2R, under a uniform pressure.
#[test]
fn a_sphere_is_worn_to_a_flat() {
    let (load, radius) = (1e-6, 1.0);
    for steps in [1, 12] {
        let grid = Grid::new([128, 128], [0.3, 0.3]).unwrap();
        let gap = undeformed_gap(&grid, &[sphere(radius)]).unwrap();
        let (k, s) = (100.0, 1.0);
        let end = run(sliding(grid, gap, load, [k, 0.0], s, steps));
        let a = (4.0 * radius * k * load * s / std::f64::consts::PI).powf(0.25);
        // The limit, off by the share of the elastic approach (some 1e-4 of the depth) and by half a cell of the edge, 1 %.
        assert!(((end.area / std::f64::consts::PI).sqrt() / a - 1.0).abs() < 0.01, "{}", end.area);
        assert!(
            (end.of(Quantity::WearDepthMax) / (a * a / 2.0) - 1.0).abs() < 0.01,
            "{}",
            end.of(Quantity::WearDepthMax)
        );
        // In one step the pressure is what wears the paraboloid, in many it becomes even; either is far from 1.5 of Hertz in the middle.
        if steps > 1 {
            let peak = end.pressure[(64, 64)] / (load / end.area);
            assert!((0.2..1.2).contains(&peak), "{peak}");
        }
        assert!(end.convolutions < 30 * (steps + 1), "{}", end.convolutions);
    }
}

/// Under a flat punch wear goes on until the pressure is the same everywhere, W/(π a²).
#[test]
fn a_punch_presses_evenly_in_the_end() {
    let grid = Grid::new([48, 48], [1.2, 1.2]).unwrap();
    let punch = Part::Shape {
        shape: Shape::FlatPunch(crate::surface::Punch::Circle { radius: 0.4 }),
        center: [0.0, 0.0],
    };
    let gap = undeformed_gap(&grid, &[punch]).unwrap();
    let cells = gap.iter().filter(|h| h.is_finite()).count() as f64;
    let end = run(sliding(grid, gap, 1e-3, [1.0, 0.0], 100.0, 10));
    let even = 1e-3 / (cells * grid.cell_area());
    let touching = end.pressure.iter().filter(|p| **p > 0.0);
    // Each step takes off a tenth of the 100 m: what is left of the peak at the edge is 1e-8.
    assert!(touching.clone().count() as f64 == cells);
    assert!(touching.map(|p| (p / even - 1.0).abs()).fold(0.0, f64::max) < 1e-5);
}

/// The course over the steps converges with their length, of first order, and the estimated error falls with it.
#[test]
fn the_course_converges_with_the_steps() {
    let grid = Grid::new([32, 32], [1.0, 1.0]).unwrap();
    let gap = undeformed_gap(&grid, &[sphere(1.0)]).unwrap();
    for k in [0.01, 0.1, 3.0] {
        let end = |steps| run(sliding(grid, gap.clone(), 1e-2, [k, 0.0], 1.0, steps));
        let exact = end(128);
        let [(coarse, estimated), (fine, _)] = [4, 8].map(|steps| {
            let end = end(steps);
            let off: f64 = end.depth[0].iter().zip(&exact.depth[0]).map(|(a, b)| (a - b).abs()).sum();
            (off / exact.depth[0].sum(), end.of(Quantity::WearError))
        });
        // The reference has a sixteenth of the error of the finer one.
        assert!((1.6..2.5).contains(&(coarse / fine)), "{k}: {coarse} {fine}");
        assert!(coarse < estimated && estimated < 10.0 * coarse, "{k}: {coarse} {estimated}");
    }
}

/// Below the threshold nothing wears; on a body that hardly yields each cell presses by its own overlap: p = p_0 + (w - h)/κ where it
/// wears.
#[test]
fn the_load_works_on_what_wears() {
    let grid = Grid::new([24, 24], [1.0, 1.0]).unwrap();
    for creep in [
        Creep::elastic(1e-3),
        Creep { terms: vec![CreepTerm { compliance: 1e-3, retardation_time: 0.3 }], ..Creep::elastic(1e-3) },
    ] {
        let history = History::Ramp { value: 2.0, duration: 1.0 };
        let simulation = Simulation {
            boundary: Boundary::Periodic,
            creep,
            loading: Loading { control: Control::Load, history }.into(),
            quantities: Quantities::of([Quantity::ExternalWork, Quantity::ElasticEnergy]),
            ..sliding(grid, rough(&grid), 1.0, [2e-3, 0.0], 2.0, 40)
        };
        let mut march = March::new(simulation).unwrap();
        let (mut work, mut told, mut before): (f64, f64, Option<[f64; 2]>) = (0.0, 0.0, None);
        while let Some(step) = march.advance().unwrap() {
            let row = step.row();
            if let Some([load, approach]) = before {
                work += 0.5 * (load + row.load) * (row.approach - approach);
            }
            before = Some([row.load, row.approach]);
            told = step.quantity(Quantity::ExternalWork).unwrap()[0];
            assert!(told >= step.quantity(Quantity::ElasticEnergy).unwrap()[0] * (1.0 - 1e-9));
        }
        // ∫ W dw by the trapezoidal rule, which has an error of second order in the 40 steps.
        assert!((told / work - 1.0).abs() < 0.02, "{told} {work}");
    }
}

#[test]
fn a_threshold_keeps_cells_from_wearing() {
    let grid = Grid::new([32, 32], [1.0, 1.0]).unwrap();
    let gap = undeformed_gap(&grid, &[sphere(1.0)]).unwrap();
    let path = Path::of_velocity(History::Step { value: 1.0 }, 0.0).unwrap();
    let threshold = 0.1;
    let wear = Wear { path: Some(path), threshold, ..Wear::new([0.5, 0.0]) };
    let end = run(Simulation { wear: Some(Arc::new(wear)), ..sliding(grid, gap, 2e-2, [0.5, 0.0], 1.0, 1) });
    let mut worn = 0;
    for (p, z) in end.pressure.iter().zip(&end.depth[0]) {
        assert!((z - 0.5 * (p - threshold).max(0.0)).abs() < 1e-6 * 0.1);
        worn += usize::from(*z > 0.0);
    }
    let touching = end.pressure.iter().filter(|p| **p > 0.0).count();
    assert!(worn > 20 && touching > worn + 20, "{worn} of {touching}");
}

/// A cylinder on a free line that slides over a track: both take their share, the body in its own frame, the track along it.
#[test]
fn a_contact_in_motion_wears_body_and_track() {
    let grid = Grid::line(64, 6.4).unwrap();
    let parts = [(Part::Shape { shape: Shape::Cylinder { radius: 4.0 }, center: [-1.6, 0.0] }, true)];
    let gap = MovingGap::new(&grid, Boundary::Free, &parts).unwrap();
    let (start, _) = gap.at(0.0, Direction::X);
    let path = Path::of_velocity(History::Step { value: 1.0 }, 0.0).unwrap();
    let motion = Motion { path, direction: Direction::X, gap, cells_per_step: 1.0, shear_stress: None };
    let end = run(Simulation {
        motion: Some(motion),
        wear: Some(Arc::new(Wear::new([0.3, 0.1]))),
        ..sliding(grid, start, 0.05, [1.0, 0.0], 3.2, 10)
    });
    let [volume, track] = [Quantity::WearVolume, Quantity::CounterbodyWearVolume].map(|q| end.of(q));
    assert!((volume / (0.4 * 0.05 * 3.2) - 1.0).abs() < 1e-12, "{volume}");
    assert!((track / volume - 0.25).abs() < 1e-14);
    let sums = end.depth.each_ref().map(|depth| depth.sum() * grid.cell_area());
    assert!(
        (sums[1] / track - 1.0).abs() < 1e-12 && (sums[0] / (volume - track) - 1.0).abs() < 1e-12,
        "{sums:?}"
    );
    // Passed as a whole, a place of the track has lost k2 W, whatever the shape.
    let middle = end.depth[1][(32, 0)];
    assert!((middle / (0.1 * 0.05) - 1.0).abs() < 0.01, "{middle}");
}

/// Under a tangential displacement far beyond stick all of the contact slips: each cycle of ±d wears k W 4 d, as many as one stands for.
#[test]
fn fretting_in_gross_slip_wears_by_its_path() {
    let grid = Grid::new([24, 24], [0.6, 0.6]).unwrap();
    let gap = undeformed_gap(&grid, &[sphere(1.0)]).unwrap();
    let (load, d, cycles) = (5e-3, 0.5, 10.0);
    let history = History::Sine { mean: 0.0, amplitude: d, frequency: 1.0 };
    let tangential = Tangential {
        coefficient: 1e-3,
        coefficients: None,
        shear_limit: f64::INFINITY,
        poisson: 0.3,
        beta: 0.0,
        coupling: Coupling::Neglect,
        control: TangentialControl::Displacement,
        histories: [history, History::Step { value: 0.0 }],
    };
    let path: f64 = 4.0 * d;
    let end = run(Simulation {
        tangential: Some(Arc::new(tangential)),
        wear: Some(Arc::new(Wear { cycles, ..Wear::new([1e-2, 0.0]) })),
        ..sliding(grid, gap, load, [1.0, 0.0], 1.0, 40)
    });
    let volume = end.of(Quantity::WearVolume);
    // The bodies stick at each turn for some 1e-3 of the way.
    assert!((volume / (1e-2 * cycles * load * path) - 1.0).abs() < 5e-3, "{volume}");
    assert!(end.of(Quantity::WearError) > 0.0);
}

#[test]
fn the_memory_of_wear_by_slip_counts_the_solver_of_the_worn_surfaces() {
    let grid = Grid::new([24, 24], [0.6, 0.6]).unwrap();
    let gap = undeformed_gap(&grid, &[sphere(1.0)]).unwrap();
    let tangential = Tangential {
        coefficient: 0.3,
        coefficients: None,
        shear_limit: f64::INFINITY,
        poisson: 0.3,
        beta: 0.0,
        coupling: Coupling::Neglect,
        control: TangentialControl::Displacement,
        histories: [History::Step { value: 0.0 }, History::Step { value: 0.0 }],
    };
    let law = Wear::new([1e-2, 0.0]);
    let rubs = sliding(grid, gap, 5e-3, [1.0, 0.0], 1.0, 40);
    let slips = Simulation { tangential: Some(Arc::new(tangential)), ..rubs.clone() };
    let [by_path, by_slip] = [&rubs, &slips].map(|simulation| law.bytes(&grid, simulation));
    // Pressure and displacement of the contact, and three fields of its slip.
    let solver = Solver::bytes(slips.solver.method, &grid, slips.boundary);
    assert!(solver > 0);
    assert_eq!(by_slip, by_path + 5 * 8 * grid.len() + solver);
}
