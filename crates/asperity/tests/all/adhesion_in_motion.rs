//! Surfaces that adhere while they slide or roll: their limits at low and at high speed, what is lost, and mirrored motion.

use std::sync::Arc;

use asperity::drive::{Drive, March};
use asperity::load::{Control, History, Loading};
use asperity::material::{Creep, CreepTerm};
use asperity::process::Motion;
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::Simulation;
use asperity::sliding::{Direction, MovingGap, Path, ShearStress};
use asperity::step::{Row, Step};
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::traction::Adhesion;
use asperity::wear::Wear;
use asperity::{Boundary, Grid, SolverOptions, TimeGrid};

/// C(0) and C(∞) of a body that needs a second.
const COMPLIANCES: [f64; 2] = [0.2, 1.0];
/// The loop of the adhesion stops at this share of the sum of the tractions.
const TOLERANCE: f64 = 1e-7;

fn grid() -> Grid {
    Grid::line(256, 4.0).unwrap()
}

fn cylinder() -> Vec<(Part, bool)> {
    vec![(Part::Shape { shape: Shape::Cylinder { radius: 1.0 }, center: [0.0, 0.0] }, true)]
}

fn creep() -> Creep {
    let [instantaneous, relaxed] = COMPLIANCES;
    let term = CreepTerm { compliance: relaxed - instantaneous, retardation_time: 1.0 };
    Creep { instantaneous, terms: vec![term], fluidity: 0.0 }
}

/// A cylinder that adheres to a body of this creep under a load.
fn at_rest(creep: Creep, load: f64) -> Simulation {
    let parts: Vec<Part> = cylinder().into_iter().map(|(part, _)| part).collect();
    let law = Adhesion { tolerance: TOLERANCE, ..Adhesion::new(0.02, 0.05) };
    Simulation {
        boundary: Boundary::Periodic,
        creep,
        loading: Loading { control: Control::Load, history: History::Step { value: load } }.into(),
        solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
        traction: Some(Arc::new(law)),
        ..Simulation::new(grid(), undeformed_gap(&grid(), &parts).unwrap())
    }
}

/// The same that moves as many cells at this velocity.
fn moving(velocity: f64, cells: f64, load: f64) -> Simulation {
    let way = cells * grid().spacing()[0];
    Simulation {
        times: TimeGrid::Uniform { end: way / velocity.abs(), steps: 1 },
        motion: Some(Motion {
            path: Path::of_velocity(History::Step { value: velocity }, 0.0).unwrap(),
            direction: Direction::X,
            gap: MovingGap::new(&grid(), Boundary::Periodic, &cylinder()).unwrap(),
            cells_per_step: 1.0,
            shear_stress: None,
        }),
        quantities: Quantities::of(Quantity::of_motion()),
        ..at_rest(creep(), load)
    }
}

fn rows<T>(simulation: Simulation, of: impl Fn(&Step<'_>) -> T) -> Vec<(Row, T)> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push((step.row(), of(&step)));
    }
    rows
}

fn number(step: &Step<'_>, quantity: Quantity) -> f64 {
    step.quantity(quantity).unwrap()[0]
}

#[test]
fn slow_and_fast_motion_are_the_elastic_contacts_of_both_ends() {
    let load = 0.05;
    // In a cell's passage the body relaxes but for exp(-1000); or it relaxes by 1e-4 of itself in the whole run.
    for (velocity, compliance) in [(1.5e-5, COMPLIANCES[1]), (1.5e4, COMPLIANCES[0])] {
        let rest = rows(at_rest(Creep::elastic(compliance), load), |_| ()).pop().unwrap().0;
        let moved = rows(moving(velocity, 80.0, load), |step| step.friction().unwrap());
        let (row, friction) = moved[moved.len() - 1];
        let off = row.max_pressure / rest.max_pressure - 1.0;
        assert!(off.abs() < 1e-3, "{velocity}: {} {}", row.max_pressure, rest.max_pressure);
        assert_eq!(row.contact_area, rest.contact_area, "{velocity}");
        // A constant traction within a step would lose this share of the largest friction, some 0.3.
        assert!(friction.coefficient.abs() < 1e-3, "{velocity}: {}", friction.coefficient);
    }
}

#[test]
fn what_friction_does_is_lost_in_the_body_under_a_load_and_under_tension() {
    for load in [0.05, -0.002] {
        let moved = rows(moving(0.4, 512.0, load), |step| {
            (step.friction().unwrap(), number(step, Quantity::DissipatedPower))
        });
        let last = &moved[moved.len() - 64..];
        let mean = |of: &dyn Fn(&(asperity::sliding::Friction, f64)) -> f64| {
            last.iter().map(|(_, row)| of(row)).sum::<f64>() / last.len() as f64
        };
        let [force, lost] = [mean(&|row| row.0.force), mean(&|row| row.1)];
        // One cell to a step: a hundredth, as without adhesion.
        assert!((lost / (0.4 * force) - 1.0).abs() < 0.02, "{load}: {lost} {force}");
        let coefficient = last[0].1.0.coefficient;
        assert!(if load > 0.0 { coefficient > 0.1 } else { coefficient.is_nan() }, "{load}: {coefficient}");
    }
}

#[test]
fn mirrored_motion_has_mirrored_forces() {
    let of = |velocity| {
        rows(moving(velocity, 60.0, 0.05), |step| {
            let friction = step.friction().unwrap();
            [friction.force, friction.moment, friction.coefficient]
        })
    };
    for ((there, forces), (back, mirrored)) in of(0.4).into_iter().zip(of(-0.4)) {
        for (force, other) in forces.into_iter().zip(mirrored) {
            // Differences of tractions known to the tolerance, over a contact of a tenth.
            assert!((force + other).abs() < 1e3 * TOLERANCE, "{force} {other}");
        }
        assert!((there.approach / back.approach - 1.0).abs() < 1e2 * TOLERANCE);
    }
}

#[test]
fn without_work_of_adhesion_nothing_changes() {
    let none = Adhesion { tolerance: 1e-9, ..Adhesion::new(0.0, 0.05) };
    let of = |traction: Option<Adhesion>| {
        let simulation =
            Simulation { traction: traction.map(|law| Arc::new(law) as _), ..moving(0.4, 60.0, 0.05) };
        rows(simulation, |step| step.friction().unwrap().force)
    };
    for ((row, force), (plain, expected)) in of(Some(none)).into_iter().zip(of(None)) {
        // The contacts of the loop are solved to a tenth of its tolerance, those alone to 1e-9.
        assert!((force - expected).abs() < 1e-6 && (row.approach / plain.approach - 1.0).abs() < 1e-6);
    }
}

#[test]
fn shear_stress_and_wear_of_a_slider_that_adheres_follow_the_contact_alone() {
    let wear = Wear::new([0.0, 1e-4]);
    let mut simulation = Simulation { wear: Some(Arc::new(wear)), ..moving(0.4, 40.0, 0.05) };
    if let Some(motion) = &mut simulation.motion {
        motion.shear_stress = Some(ShearStress::Constant(0.3));
    }
    let wanted = [Quantity::WearVolume, Quantity::RepulsiveLoad];
    simulation.quantities = Quantities::of(Quantity::of_motion().chain(wanted));
    let (mut worn, way) = (0.0, grid().spacing()[0]);
    for (n, (row, [volume, presses, total, bulk])) in rows(simulation, |step| {
        let friction = step.friction().unwrap();
        let [volume, presses] = wanted.map(|wanted| number(step, wanted));
        [volume, presses, friction.total, friction.coefficient]
    })
    .into_iter()
    .enumerate()
    {
        worn += if n == 0 { 0.0 } else { 1e-4 * presses * way };
        assert!((volume - worn).abs() < 1e-6 * worn.max(1e-12), "{n}: {volume} {worn}");
        assert!(presses > 1.05 * row.load);
        if n > 0 {
            let expected = bulk + 0.3 * row.contact_area / row.load;
            assert!((total / expected - 1.0).abs() < 1e-12, "{n}: {total} {expected}");
        }
    }
}
