//! Wear, friction and dents beside adhesion and a fluid: all three follow the contact pressure alone.
//!
//! A fluid of pressure P that acts everywhere leaves the contact of a load less P on a body whose hardness is less P (Terzaghi): an exact
//! twin without fluid where bodies are elastic.

use std::sync::Arc;

use asperity::contact::SolverOptions;
use asperity::drive::{Drive, March};
use asperity::leakage::{Direction, Sides};
use asperity::load::{Control, History, Loading};
use asperity::material::{Creep, CreepTerm};
use asperity::process::Motion;
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::{Plasticity, Simulation};
use asperity::sliding::{Direction as SlidingDirection, MovingGap, Path};
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::tangential::{Coupling, Tangential, TangentialControl};
use asperity::traction::{Action, Adhesion, FluidPressure};
use asperity::wear::Wear;
use asperity::{Boundary, Error, Grid, TimeGrid};

const FLUID: f64 = 0.004;
const HARDNESS: f64 = 0.05;
const TOLERANCE: f64 = 1e-9;
/// Mean pressure over time, without the fluid: pressed, released, pressed again.
const PRESSES: [(f64, f64); 4] = [(0.0, 0.002), (2.0, 0.006), (3.0, 0.003), (4.0, 0.006)];

/// A rough elastic body under the mean pressure of [`PRESSES`] and `more`.
fn rough(more: f64, hardness: f64) -> Simulation {
    let grid = Grid::new([32, 32], [1.0, 1.0]).unwrap();
    let surface = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        roll_off: 0.5,
        longest: 0.5,
        shortest: 0.15,
        seed: 3,
    };
    let points = PRESSES.map(|(t, p)| (t, p + more)).to_vec();
    Simulation {
        boundary: Boundary::Periodic,
        hardness,
        loading: Loading { control: Control::Pressure, history: History::Table { points } }.into(),
        times: TimeGrid::Uniform { end: 4.0, steps: 16 },
        solver: precise(),
        ..Simulation::new(grid, undeformed_gap(&grid, &[Part::SelfAffine(surface)]).unwrap())
    }
}

/// Under a fluid, and its twin.
fn twins() -> [Simulation; 2] {
    let fluid = FluidPressure {
        inlet: History::Step { value: FLUID },
        outlet: FLUID,
        reference: 0.0,
        gas: None,
        viscosity: 0.0,
        direction: Direction::X,
        sides: Sides::Periodic,
        smallest_gap: 0.0,
        action: Action::Everywhere,
        bulk_modulus: None,
    };
    [Simulation { traction: Some(Arc::new(fluid)), ..rough(FLUID, HARDNESS) }, rough(0.0, HARDNESS - FLUID)]
}

/// An adhesive ball that is pressed on and drawn back; without adhesion where `work` is `None`.
fn ball(work: Option<f64>) -> Simulation {
    let grid = Grid::new([64, 64], [0.5, 0.5]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let points = vec![(0.0, 0.0), (1.0, 16e-3), (2.0, 8e-3), (3.0, 16e-3)];
    let law = work.map(|work| Adhesion { tolerance: 10.0 * TOLERANCE, ..Adhesion::new(work, 2.5e-3) });
    Simulation {
        loading: Loading { control: Control::Approach, history: History::Table { points } }.into(),
        times: TimeGrid::Uniform { end: 3.0, steps: 12 },
        solver: precise(),
        traction: law.map(|law| Arc::new(law) as _),
        ..Simulation::new(grid, undeformed_gap(&grid, &[part]).unwrap())
    }
}

fn precise() -> SolverOptions {
    SolverOptions { tolerance: TOLERANCE, ..SolverOptions::default() }
}

fn wearing(coefficient: f64) -> Option<Arc<Wear>> {
    let path = Path::of_velocity(History::Step { value: 1.0 }, 0.0).unwrap();
    Some(Arc::new(Wear { path: Some(path), ..Wear::new([coefficient, 0.0]) }))
}

/// Pulled along x: with this force, or by this way.
fn pulled(control: TangentialControl, value: f64, coefficient: f64) -> Option<Arc<Tangential>> {
    Some(Arc::new(Tangential {
        coefficient,
        coefficients: None,
        shear_limit: f64::INFINITY,
        poisson: 0.5,
        beta: 0.0,
        coupling: Coupling::Neglect,
        control,
        histories: [History::Ramp { value, duration: 1.0 }, History::Step { value: 0.0 }],
    }))
}

/// Of each row: the contact fraction, and what `of` takes from it.
fn rows<T>(simulation: Simulation, mut of: impl FnMut(&asperity::step::Step<'_>) -> T) -> Vec<(f64, T)> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        let fraction = step.row().contact_fraction;
        rows.push((fraction, of(&step)));
    }
    rows
}

fn number(step: &asperity::step::Step<'_>, quantity: Quantity) -> f64 {
    step.quantity(quantity).unwrap()[0]
}

/// The loop beside a fluid stops at ten times the tolerance; what dents and wear add up to over 16 rows, and slip, which is a difference of
/// displacements, are known to a thousand times as much.
const SAME: f64 = 1e4 * TOLERANCE;

fn agree(found: &[(f64, f64)], expected: &[(f64, f64)]) {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0_f64, |most, row| most.max(row.1.abs()));
    assert!(largest > 0.0);
    for (row, ((area, value), (own_area, own))) in found.iter().zip(expected).enumerate() {
        // A cell at the edge of the contact may fall on either side.
        assert!((area - own_area).abs() < 1.5 / 1024.0, "row {row}: {area} {own_area}");
        assert!((value - own).abs() < SAME * largest, "row {row}: {value} {own}");
    }
}

#[test]
fn under_a_fluid_surfaces_wear_by_what_it_leaves_to_the_contact() {
    let [found, expected] = twins().map(|twin| {
        let quantities = Quantities::of([Quantity::WearVolume]);
        let simulation = Simulation { wear: wearing(0.02), quantities, ..twin };
        rows(simulation, |step| number(step, Quantity::WearVolume))
    });
    agree(&found, &expected);
    // Archard: what is worn does not depend on where.
    let mut volume = 0.0;
    for pair in PRESSES.windows(2) {
        let steps = (4.0 * (pair[1].0 - pair[0].0)) as usize;
        let pressure = |n: usize| pair[0].1 + (pair[1].1 - pair[0].1) * n as f64 / steps as f64;
        volume += (1..=steps).map(|n| 0.02 * 0.25 * pressure(n)).sum::<f64>();
    }
    assert!((found[16].1 / volume - 1.0).abs() < SAME);
}

#[test]
fn under_a_fluid_dents_are_those_of_what_it_leaves_to_the_contact() {
    let [found, expected] = twins().map(|twin| {
        let quantities = Quantities::of([Quantity::PlasticVolume]);
        let simulation = Simulation { plasticity: Plasticity::Accumulate, quantities, ..twin };
        rows(simulation, |step| number(step, Quantity::PlasticVolume))
    });
    agree(&found, &expected);
}

#[test]
fn under_a_fluid_friction_holds_by_what_it_leaves_to_the_contact() {
    // 0.8 of what friction holds at t = 1.
    let pull = 0.8 * 0.3 * 0.004;
    let [found, expected] = twins().map(|twin| {
        let simulation = Simulation {
            tangential: pulled(TangentialControl::Force, pull, 0.3),
            times: TimeGrid::Uniform { end: 1.0, steps: 4 },
            ..twin
        };
        rows(simulation, |step| step.slip_row().unwrap().displacement[0])
    });
    agree(&found, &expected);
    let [fluid, _] = twins();
    let slides = Simulation { tangential: pulled(TangentialControl::Force, 1.3 * pull, 0.3), ..fluid };
    let mut march = March::new(slides).unwrap();
    let end =
        std::iter::from_fn(|| march.advance().map(|step| step.map(|_| ())).transpose()).find_map(Result::err);
    assert!(matches!(end, Some(Error::Sliding { .. })), "μ (W - P A) does not hold it");
}

#[test]
fn under_a_fluid_slip_wears_by_what_it_leaves_to_the_contact() {
    let [found, expected] = twins().map(|twin| {
        let simulation = Simulation {
            tangential: pulled(TangentialControl::Displacement, 0.01, 0.3),
            wear: Some(Arc::new(Wear::new([0.5, 0.0]))),
            quantities: Quantities::of([Quantity::WearVolume]),
            ..twin
        };
        rows(simulation, |step| number(step, Quantity::WearVolume))
    });
    agree(&found, &expected);
}

#[test]
fn an_adhesive_ball_wears_by_what_presses() {
    let adhesive = [Quantity::WearVolume, Quantity::RepulsiveLoad, Quantity::AdhesiveLoad];
    let simulation = |work: Option<f64>| Simulation {
        wear: wearing(0.1),
        quantities: Quantities::of(
            if work.is_some() { &adhesive[..] } else { &adhesive[..1] }.iter().copied(),
        ),
        ..ball(work)
    };
    let mut volume = 0.0;
    for (_, [found, presses, pulls]) in
        rows(simulation(Some(1e-4)), |step| adhesive.map(|own| number(step, own)))
    {
        volume += 0.1 * 0.25 * presses;
        // At t = 0 nothing has slid.
        let found_expected = if found == 0.0 {
            volume = 0.0;
            0.0
        } else {
            volume
        };
        assert!((found - found_expected).abs() <= 1e-12 * volume, "{found} {volume}");
        assert!(pulls > 0.0);
    }
    let plain = rows(simulation(None), |step| number(step, Quantity::WearVolume));
    let none = rows(simulation(Some(0.0)), |step| number(step, Quantity::WearVolume));
    agree(&none, &plain);
}

#[test]
fn an_adhesive_ball_slides_at_the_friction_of_what_presses() {
    let simulation = Simulation {
        tangential: pulled(TangentialControl::Displacement, 0.1, 0.2),
        quantities: Quantities::of([Quantity::RepulsiveLoad]),
        ..ball(Some(1e-4))
    };
    let found = rows(simulation, |step| {
        let row = step.slip_row().unwrap();
        (row.force[0], row.stick_area, number(step, Quantity::RepulsiveLoad))
    });
    // At t = 1 it has been pulled much farther than its surface follows.
    let (force, sticks, presses) = found[4].1;
    assert_eq!(sticks, 0.0);
    assert!((force / (0.2 * presses) - 1.0).abs() < 1e-6, "{force} {presses}");
}

#[test]
fn dents_of_an_adhesive_ball_stay_and_grow_no_more_under_the_same_approach() {
    let simulation = |work| Simulation {
        hardness: 0.06,
        plasticity: Plasticity::Accumulate,
        quantities: Quantities::of([Quantity::PlasticVolume]),
        ..ball(work)
    };
    let of = |work| rows(simulation(work), |step| number(step, Quantity::PlasticVolume));
    let found = of(Some(1e-4));
    let volumes: Vec<f64> = found.iter().map(|row| row.1).collect();
    assert!(volumes[4] > 0.0 && volumes[8] == volumes[4], "{volumes:?}");
    // Pressed again as far as before: to the tolerance of the loop.
    assert!((volumes[12] / volumes[4] - 1.0).abs() < 1e-3, "{volumes:?}");
    agree(&of(Some(0.0)), &of(None));
}

#[test]
fn friction_of_a_submerged_slider_is_that_of_the_dry_one_under_the_rest_of_the_load() {
    let [wet, dry] = twins().map(|twin| {
        let grid = twin.grid;
        let surface = SelfAffine {
            hurst: 0.8,
            roughness: Roughness::RmsGradient(0.1),
            roll_off: 0.5,
            longest: 0.5,
            shortest: 0.15,
            seed: 3,
        };
        let parts = [(Part::SelfAffine(surface), true)];
        let motion = Motion {
            path: Path::of_velocity(History::Step { value: 0.1 }, 0.0).unwrap(),
            direction: SlidingDirection::X,
            gap: MovingGap::new(&grid, Boundary::Periodic, &parts).unwrap(),
            cells_per_step: 1.0,
            shear_stress: None,
        };
        let term = CreepTerm { compliance: 2.0, retardation_time: 0.5 };
        rows(
            Simulation {
                creep: Creep { instantaneous: 0.5, terms: vec![term], fluidity: 0.0 },
                motion: Some(motion),
                quantities: Quantities::of(Quantity::of_motion()),
                ..twin
            },
            |step| step.friction().unwrap().force,
        )
    });
    agree(&wet, &dry);
}
