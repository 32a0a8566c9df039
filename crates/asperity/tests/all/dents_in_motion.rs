//! Dents that stay while the contact moves: they belong to the track, which is ploughed, or to the slider, which wears in.

use asperity::drive::{Drive, March};
use asperity::load::{Control, History, Loading};
use asperity::material::Creep;
use asperity::process::Motion;
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::{Plasticity, Simulation};
use asperity::sliding::{Direction, MovingGap, Path, Steady, SteadyMotion};
use asperity::step::Step;
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Boundary, Grid, SolverOptions, TimeGrid};
use ndarray::Array2;

const CELL: f64 = 1.0 / 32.0;

fn grid() -> Grid {
    Grid::new([128, 48], [4.0, 1.5]).unwrap()
}

fn ball() -> Vec<(Part, bool)> {
    vec![(Part::Shape { shape: Shape::Sphere { radius: 2.0 }, center: [-1.2, 0.0] }, true)]
}

/// A ball that slides over a flat elastic body along this path of (time, position), pressed by these loads.
fn sliding(path: Vec<(f64, f64)>, loads: Vec<(f64, f64)>) -> Simulation {
    let parts: Vec<Part> = ball().into_iter().map(|(part, _)| part).collect();
    let end = path.last().unwrap().0;
    Simulation {
        creep: Creep::elastic(1.0),
        hardness: 0.06,
        plasticity: Plasticity::Accumulate,
        loading: Loading { control: Control::Load, history: History::Table { points: loads } }.into(),
        times: TimeGrid::Uniform { end, steps: 1 },
        solver: SolverOptions { tolerance: 1e-8, ..SolverOptions::default() },
        quantities: Quantities::of(Quantity::of_motion().chain([
            Quantity::PlasticVolume,
            Quantity::ExternalWork,
            Quantity::ElasticEnergy,
            Quantity::FlatteningWork,
        ])),
        motion: Some(Motion {
            path: Path::of_position(History::Table { points: path }, 0.0).unwrap(),
            direction: Direction::X,
            gap: MovingGap::new(&grid(), Boundary::Free, &ball()).unwrap(),
            cells_per_step: 1.0,
            shear_stress: None,
        }),
        ..Simulation::new(grid(), undeformed_gap(&grid(), &parts).unwrap())
    }
}

/// By `cells` cells at one cell a second, under a constant load.
fn way(cells: f64) -> Simulation {
    sliding(vec![(0.0, 0.0), (cells, cells * CELL)], vec![(0.0, 0.02), (cells, 0.02)])
}

/// The volume of the dents, as their field has it.
fn volume(step: &Step<'_>) -> f64 {
    let mut dents = Array2::zeros(grid().shape());
    step.flattening_into(&mut dents);
    dents.sum() * grid().cell_area()
}

fn number(step: &Step<'_>, quantity: Quantity) -> f64 {
    step.quantity(quantity).unwrap()[0]
}

fn rows<T>(simulation: Simulation, of: impl Fn(&Step<'_>) -> T) -> Vec<T> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(of(&step));
    }
    rows
}

#[test]
fn a_track_is_ploughed_and_friction_does_the_work() {
    let found = rows(way(60.0), |step| {
        let of = |quantity| number(step, quantity);
        // Each cell by one sum, or all by another.
        assert!(
            (volume(step) - of(Quantity::PlasticVolume)).abs()
                < 1e-12 * of(Quantity::PlasticVolume).max(1e-9)
        );
        let energies = of(Quantity::ElasticEnergy) + of(Quantity::FlatteningWork);
        let force = step.friction().unwrap().force;
        (
            of(Quantity::PlasticVolume),
            force,
            of(Quantity::ExternalWork),
            energies,
            of(Quantity::FlatteningWork),
        )
    });
    let (middle, last) = (found[30], found[60]);
    // The groove has the same section everywhere: the volume grows with the way.
    let growth = [(middle.0 - found[20].0) / 10.0, (last.0 - middle.0) / 30.0];
    assert!(growth[0] > 0.0 && (growth[0] / growth[1] - 1.0).abs() < 0.02, "{growth:?}");
    // Work of load and friction, by the trapezoids of the steps, against what springs hold and cells at the hardness took. The slopes of
    // a sphere across a contact of ten cells: a few per cent.
    assert!((last.2 / last.3 - 1.0).abs() < 0.05, "{} {}", last.2, last.3);
    let ploughed = (last.4 - middle.4) / (30.0 * CELL);
    assert!(last.1 > 0.0 && (last.1 / ploughed - 1.0).abs() < 0.05, "{} {ploughed}", last.1);
}

#[test]
fn the_way_back_in_the_groove_at_less_load_is_elastic() {
    let path = vec![(0.0, 0.0), (20.0, 20.0 * CELL), (35.0, 5.0 * CELL)];
    let loads = vec![(0.0, 0.02), (20.0, 0.02), (20.5, 0.01), (35.0, 0.01)];
    let volumes =
        rows(sliding(path, loads), |step| (step.row().time(), number(step, Quantity::PlasticVolume)));
    let at = |t: f64| volumes.iter().rfind(|row| row.0 <= t).unwrap().1;
    assert!(at(20.0) > 1.5 * at(2.0));
    // Inside the groove nothing more is pushed aside but by the rounding of the contact's edge.
    assert!(at(35.0) - at(21.0) < 0.01 * at(20.0), "{} {}", at(35.0), at(21.0));
}

#[test]
fn a_slider_with_the_dents_is_dented_once() {
    let simulation = Simulation { dents_move: true, ..way(40.0) };
    let found = rows(simulation, |step| {
        assert!((volume(step) - number(step, Quantity::PlasticVolume)).abs() < 1e-12 * volume(step));
        (number(step, Quantity::PlasticVolume), step.row(), step.friction().unwrap().force)
    });
    let (first, last) = (found[0], found[40]);
    assert!(first.0 > 0.0);
    // It takes its dent along: by whole cells, exactly.
    assert!((last.0 / first.0 - 1.0).abs() < 1e-3, "{} {}", first.0, last.0);
    assert!((last.1.contact_area / first.1.contact_area - 1.0).abs() < 0.05);
    // Symmetric as it is, no force is left.
    assert!(last.2.abs() < 1e-3 * 0.02, "{}", last.2);
}

#[test]
fn a_dented_track_goes_on_from_a_checkpoint_with_the_same_bits() {
    for dents_move in [false, true] {
        let slide = || Simulation { dents_move, ..way(12.0) };
        let mut whole = March::new(slide()).unwrap();
        for _ in 0..7 {
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
}

#[test]
fn dents_that_stay_are_refused_over_velocities_and_in_long_steps() {
    let (gap, slopes) = MovingGap::new(&grid(), Boundary::Free, &ball()).unwrap().at(0.0, Direction::X);
    let loading = Loading { control: Control::Load, history: History::Step { value: 0.02 } };
    let motion = SteadyMotion { direction: Direction::X, velocities: vec![1.0], slopes, shear_stress: None };
    let steady = Simulation {
        gap,
        motion: None,
        quantities: Quantities::default(),
        loading: loading.into(),
        ..way(2.0)
    };
    assert!(Steady::new(steady, motion).err().unwrap().to_string().contains("dents that stay"));
    let mut long = way(12.0);
    long.motion.as_mut().unwrap().cells_per_step = 2.0;
    assert!(March::new(long).err().unwrap().to_string().contains("stripes"));
}
