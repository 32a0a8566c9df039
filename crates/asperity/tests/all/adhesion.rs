//! Adhesion against closed forms: JKR, Maugis, DMT; its energy; branches, events, resumed runs; rates of viscoelastic bodies.

use std::sync::Arc;

use asperity::drive::{Drive, March};
use asperity::finding::{Diagnostics, ENERGY_BALANCE, Known};
use asperity::load::{Control, Course, Event, History, Loading, Programme, Stage};
use asperity::material::{Creep, CreepTerm};
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::Simulation;
use asperity::step::Row;
use asperity::surface::{Part, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::traction::{Adhesion, AdhesionLaw};
use asperity::{Boundary, Error, Grid, TimeGrid};
use std::f64::consts::PI;

/// Work of adhesion of all spheres \[J/m²\]; their radius is 1 m, E* = 1 Pa.
const WORK: f64 = 1e-4;

/// The unit of the approach in the closed forms, (π² w² R/K²)^(1/3), K = 4 E*/3.
fn unit() -> f64 {
    libm::cbrt(PI * PI * WORK * WORK / (16.0 / 9.0))
}

/// The exponential law with this Tabor number.
fn exponential(tabor: f64) -> Adhesion {
    Adhesion::new(WORK, libm::cbrt(WORK * WORK) / tabor)
}

/// A ramp of the approach through these points, in units of [`unit`] and of 1 s each.
fn sphere(cells: usize, adhesion: Adhesion, points: &[(f64, f64)], steps: usize) -> Simulation {
    wide_sphere(cells, 0.5, adhesion, points, steps)
}

/// The same on a domain with this side.
fn wide_sphere(
    cells: usize,
    side: f64,
    adhesion: Adhesion,
    points: &[(f64, f64)],
    steps: usize,
) -> Simulation {
    let grid = Grid::new([cells, cells], [side, side]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let end = points.last().unwrap().0;
    let points = points.iter().map(|(t, w)| (*t, w * unit())).collect();
    let energies = [Quantity::ElasticEnergy, Quantity::ExternalWork];
    Simulation {
        loading: Loading { control: Control::Approach, history: History::Table { points } }.into(),
        times: TimeGrid::Uniform { end, steps },
        traction: Some(Arc::new(adhesion)),
        quantities: Quantities::of(Quantity::of_adhesion().chain(energies)),
        ..Simulation::new(grid, undeformed_gap(&grid, &[part]).unwrap())
    }
}

fn rows(simulation: Simulation) -> Vec<Row> {
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push(step.row());
    }
    rows
}

/// The least load over π w R, of the parabola through the three rows around it.
fn pull_off(rows: &[Row]) -> f64 {
    let n = (1..rows.len() - 1).min_by(|a, b| rows[*a].load.total_cmp(&rows[*b].load)).unwrap();
    let [a, b, c] = [-1_isize, 0, 1].map(|k| rows[n.wrapping_add_signed(k)].load);
    (b - (a - c).powi(2) / (8.0 * (a - 2.0 * b + c))) / (PI * WORK)
}

#[test]
fn the_pull_off_of_a_sphere_does_not_depend_on_the_grid_where_cells_do_not_snap() {
    // Trap numbers 0.13, 0.07 and 0.27. The values of finer grids, of another implementation: -1.6756 and -1.5822.
    for (tabor, cells, expected) in [(0.93, 64, -1.6756), (1.86, 128, -1.5822)] {
        let found = rows(sphere(cells, exponential(tabor), &[(0.0, 0.5), (1.0, -0.9)], 28));
        let off = pull_off(&found) / expected - 1.0;
        // 0.2 % of the grid (64 cells: -1.6727), and 1e-3 of the steps.
        assert!(off.abs() < 4e-3, "{tabor}: {}", pull_off(&found));
        let convolutions: usize = found.iter().map(|row| row.convolutions).sum();
        assert!(convolutions < 60 * found.len(), "{convolutions}");
    }
}

#[test]
fn without_work_it_is_the_contact_without_adhesion_and_with_a_long_range_a_load_besides() {
    let points = [(0.0, 0.5), (1.0, 1.5)];
    let plain = rows(Simulation {
        traction: None,
        quantities: Quantities::default(),
        ..sphere(64, exponential(1.0), &points, 3)
    });
    let none = rows(sphere(64, Adhesion::new(0.0, 1e-3), &points, 3));
    for (plain, none) in plain.iter().zip(&none) {
        assert!((none.load / plain.load - 1.0).abs() < 1e-5 && none.contact_area == plain.contact_area);
    }
    // Tabor's number 0.03: -2 π w R of a rigid sphere (Derjaguin, Muller & Toporov), to some of Tabor's number and the cut tail.
    let far = rows(wide_sphere(96, 3.0, exponential(0.03), &[(0.0, 1.0), (1.0, -3.0)], 20));
    let least = far.iter().map(|row| row.load).fold(0.0, f64::min) / (PI * WORK);
    assert!(least > -2.0 && least < -1.94, "{least}");
}

#[test]
fn a_closed_cycle_loses_exactly_its_jumps() {
    let simulation = sphere(
        128,
        Adhesion { tolerance: 1e-7, ..exponential(1.86) },
        &[(0.0, -4.0), (1.0, 1.0), (2.0, -4.0)],
        400,
    );
    let mut march = March::new(simulation).unwrap();
    let (mut lost, mut jumps, mut last) = (0.0, 0.0, None);
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        let stored: f64 = [Quantity::ElasticEnergy, Quantity::AdhesionEnergy]
            .map(|q| step.quantity(q).unwrap()[0])
            .iter()
            .sum();
        let state = (row.approach, row.load, stored, row.contact_area > 0.0);
        if let Some((w, load, energy, touched)) = last.replace(state) {
            if touched == state.3 {
                // Trapezoidal work less the change of energy: 0 but for the steps.
                lost += 0.5 * (load + row.load) * (row.approach - w) - (stored - energy);
            } else {
                jumps += energy - stored;
            }
        }
    }
    let energy = WORK * unit() * PI;
    // A jump within a step of 0.025 units leaves the work of up to that step unknown: 2 % of the loss.
    assert!(lost.abs() < 1e-3 * energy, "{} {}", lost / energy, jumps / energy);
    assert!(jumps > 0.1 * energy, "{}", jumps / energy);
}

/// A Zener solid ten times softer after a long time, E* = 1 Pa then, with a retardation time of 1 s.
fn zener() -> Creep {
    Creep {
        instantaneous: 0.1,
        terms: vec![CreepTerm { compliance: 0.9, retardation_time: 1.0 }],
        fluidity: 0.0,
    }
}

/// The sphere is held for 40 s, then retracted at the speed `v` in units a second.
fn retraction(v: f64, steps: usize) -> Simulation {
    let base = sphere(64, exponential(0.93), &[(0.0, 1.0), (1.0, 1.0)], 1);
    let uniform = |end, steps| Some(TimeGrid::Uniform { end, steps });
    let at = |value| Stage::new(Control::Approach, History::Step { value });
    let hold = Stage { duration: Some(40.0), times: uniform(40.0, 40), ..at(unit()) };
    let duration = 2.5 / v;
    let course = Course::RampTo { value: -1.5 * unit(), duration };
    let back = Stage { duration: Some(duration), times: uniform(duration, steps), course, ..at(0.0) };
    Simulation {
        creep: zener(),
        loading: Programme::new(vec![hold, back]),
        times: TimeGrid::Uniform { end: 40.0 + duration, steps: 1 },
        ..base
    }
}

#[test]
fn the_pull_off_of_a_viscoelastic_sphere_grows_from_the_elastic_one_to_its_strength() {
    let of = |v| pull_off(&rows(retraction(v, 50)));
    // Slow: the relaxed body.
    assert!((of(1e-3) / -1.6756 - 1.0).abs() < 5e-3);
    let [slow, middle, fast, frozen] = [0.1, 1.0, 10.0, 1e3].map(of);
    assert!(
        -1.7 > slow && slow > middle && middle > fast && fast > frozen,
        "{slow} {middle} {fast} {frozen}"
    );
    // Values of 1600 steps and of the scheme of constant pressures, which agree to 3e-3; 50 steps leave 1 %.
    for (found, exact) in [(slow, -1.8964), (middle, -3.036), (fast, -4.90), (frozen, -5.005)] {
        assert!((found / exact - 1.0).abs() < 0.015, "{found} {exact}");
    }
    // The frozen contact is a flat punch that pulls off at once: its strength times its area, and the ring around it in which the gap is
    // within the range.
    let start = rows(retraction(1e3, 1));
    let held = start.iter().rfind(|row| row.stage == 0).unwrap();
    let reach = held.contact_area / (PI * WORK) * exponential(0.93).strength();
    assert!(frozen > -1.3 * reach && frozen < -reach, "{frozen} {reach}");
}

/// A load that falls from 0 to -2 π w R in 1 s.
fn unloading(times: TimeGrid, until: Option<Event>) -> Simulation {
    let base = sphere(64, exponential(0.93), &[(0.0, 0.0), (1.0, 0.0)], 1);
    let press =
        Stage { duration: Some(1.0), ..Stage::new(Control::Load, History::Step { value: 2.0 * PI * WORK }) };
    let course = Course::RampTo { value: -2.0 * PI * WORK, duration: 1.0 };
    let pull = Stage { duration: Some(1.0), times: Some(times), course, until, ..press.clone() };
    let times = TimeGrid::Uniform { end: 2.0, steps: 2 };
    Simulation { loading: Programme::new(vec![press, pull]), times, ..base }
}

#[test]
fn under_a_load_pull_off_is_an_error_or_the_event_that_ends_a_stage() {
    let uniform = TimeGrid::Uniform { end: 1.0, steps: 10 };
    let adaptive = TimeGrid::Adaptive { end: 1.0, tolerance: 1e-3, first: 0.1 };
    // The load falls by 4 π w R in 1 s from 2: -1.6727 π w R at 0.918 s.
    let exact = -1.6727;
    let mut march = March::new(unloading(uniform.clone(), None)).unwrap();
    let error = loop {
        match march.advance() {
            Ok(step) => assert!(step.is_some()),
            Err(error) => break error,
        }
    };
    let Error::PulledOff { load, time, last: Some(last), unit: "N" } = error else { panic!("{error}") };
    assert!((load / (PI * WORK) + 2.0).abs() < 1e-9 && time == 2.0);
    assert!((last[0] / (PI * WORK) + 1.6).abs() < 1e-9 && last[1] < 0.0);
    // Adaptive steps go on to the last equilibrium.
    let mut march = March::new(unloading(adaptive, None)).unwrap();
    let error = loop {
        match march.advance() {
            Ok(step) => assert!(step.is_some()),
            Err(error) => break error,
        }
    };
    let Error::PulledOff { last: Some(last), .. } = error else { panic!("{error}") };
    assert!((last[0] / (PI * WORK) / exact - 1.0).abs() < 5e-3, "{}", last[0] / (PI * WORK));
    let ended = rows(unloading(uniform, Some(Event::ContactLost)));
    let last = ended.last().unwrap();
    assert!((last.load / (PI * WORK) / exact - 1.0).abs() < 5e-3 && last.time() < 2.0, "{last:?}");
}

#[test]
fn under_a_prescribed_approach_contact_is_lost_where_it_jumps_off() {
    let mut simulation = sphere(64, exponential(0.93), &[(0.0, 0.0), (1.0, 0.0)], 1);
    let course = Course::RampTo { value: -2.0 * unit(), duration: 1.0 };
    let pull = Stage {
        duration: Some(1.0),
        course,
        until: Some(Event::ContactLost),
        ..Stage::new(Control::Approach, History::Step { value: 0.0 })
    };
    let press =
        Stage { duration: Some(1.0), ..Stage::new(Control::Approach, History::Step { value: unit() }) };
    simulation.loading = Programme::new(vec![press, pull]);
    simulation.times = TimeGrid::Uniform { end: 2.0, steps: 40 };
    let found = rows(simulation);
    let [.., before, last] = &found[..] else { panic!("{found:?}") };
    assert!(before.contact_area > 0.0 && last.contact_area == 0.0);
    assert!(last.approach < -0.6 * unit() && last.approach > -1.2 * unit(), "{}", last.approach / unit());
}

#[test]
fn a_run_resumed_before_its_jump_has_the_same_bits() {
    let simulation = || retraction(1.0, 40);
    let whole = rows(simulation());
    let mut march = March::new(simulation()).unwrap();
    for _ in 0..60 {
        march.advance().unwrap();
    }
    let mut resumed = March::resume(simulation(), &march.checkpoint()).unwrap();
    for row in &whole[60..] {
        assert_eq!(resumed.advance().unwrap().unwrap().row(), *row);
    }
}

#[test]
fn a_load_of_nothing_holds_the_bodies_together_and_a_pull_below_pull_off_parts_them() {
    let under = |load: f64| {
        let base = sphere(64, exponential(0.93), &[(0.0, 0.0), (1.0, 0.0)], 1);
        let history = History::Step { value: load * PI * WORK };
        let loading = Loading { control: Control::Load, history }.into();
        March::new(Simulation { loading, ..base }).unwrap().advance().map(|step| step.unwrap().row())
    };
    // The branch of a contact that was pressed before: the same state.
    let pressed = rows(unloading(TimeGrid::Uniform { end: 1.0, steps: 8 }, Some(Event::ContactLost)));
    for (load, row) in [(0.0, under(0.0)), (-1.0, under(-1.0))] {
        let row = row.unwrap();
        let before = pressed.iter().find(|row| (row.load / (PI * WORK) - load).abs() < 1e-6).unwrap();
        assert!((row.approach - before.approach).abs() < 2e-3 * unit(), "{load}: {row:?} {before:?}");
        assert!((row.contact_area / before.contact_area - 1.0).abs() < 0.02);
    }
    assert!(matches!(under(-1.8), Err(Error::PulledOff { last: None, .. })));
    // Without adhesion a load of nothing presses nothing.
    let base = sphere(64, Adhesion::new(0.0, 1e-3), &[(0.0, 0.0), (1.0, 0.0)], 1);
    let loading = Loading { control: Control::Load, history: History::Step { value: 0.0 } }.into();
    let row = March::new(Simulation { loading, ..base }).unwrap().advance().unwrap().unwrap().row();
    assert_eq!(row.contact_area, 0.0);
}

#[test]
fn an_event_at_a_pull_is_met_under_a_prescribed_approach() {
    let base = sphere(64, exponential(0.93), &[(0.0, 0.0), (1.0, 0.0)], 1);
    let pull = -1.2 * PI * WORK;
    let press =
        Stage { duration: Some(1.0), ..Stage::new(Control::Approach, History::Step { value: unit() }) };
    let course = Course::RampTo { value: -0.8 * unit(), duration: 1.0 };
    let times = Some(TimeGrid::Uniform { end: 1.0, steps: 10 });
    let until = Some(Event::Load(pull));
    let back = Stage { duration: Some(1.0), times, course, until, ..press.clone() };
    let times = TimeGrid::Uniform { end: 2.0, steps: 2 };
    let found = rows(Simulation { loading: Programme::new(vec![press, back]), times, ..base.clone() });
    let last = found.last().unwrap();
    // Events are met to a millionth of the largest load so far.
    let heaviest = found.iter().map(|row| row.load.abs()).fold(0.0, f64::max);
    assert!((last.load - pull).abs() <= 1e-6 * heaviest, "{last:?}");
    assert!(last.coordinate.value() < 2.0 && last.contact_area > 0.0, "{last:?}");
    // The same state as under that load, to the width of a cell of the rim.
    let loading = Loading { control: Control::Load, history: History::Step { value: pull } }.into();
    let under = March::new(Simulation { loading, ..base }).unwrap().advance().unwrap().unwrap().row();
    assert!((last.approach - under.approach).abs() < 2e-3 * unit(), "{last:?} {under:?}");
}

#[test]
fn what_adhesion_cannot_do_is_refused() {
    let of = |adhesion| {
        March::new(sphere(32, adhesion, &[(0.0, 0.0), (1.0, 1.0)], 1)).err().map(|e| e.to_string())
    };
    let said = of(Adhesion::new(WORK, 1e-4)).unwrap();
    assert!(said.contains("trap number") && said.contains("cells"), "{said}");
    assert!(of(Adhesion { allow_unresolved: true, ..Adhesion::new(WORK, 1e-3) }).is_none());
    assert!(of(Adhesion::new(-1.0, 1e-3)).unwrap().contains("work of adhesion"));
    assert!(of(Adhesion::new(1.0, 0.0)).unwrap().contains("range"));
    let soft = Simulation {
        hardness: 0.5 * exponential(0.5).strength(),
        ..sphere(32, exponential(0.5), &[(0.0, 0.0), (1.0, 1.0)], 1)
    };
    assert!(March::new(soft).err().unwrap().to_string().contains("strength"));
    let mut stiff = sphere(32, exponential(0.5), &[(0.0, 0.0), (1.0, 1.0)], 1);
    stiff.quantities = Quantities::of([Quantity::ContactStiffness]);
    assert!(March::new(stiff).err().unwrap().to_string().contains("adhesive"));
}

/// A rough surface with a trap number that is brought together and parted again: rms gradient 0.1, E* = 1 Pa on a side of 1 m.
fn rough(cells: usize, boundary: Boundary, range: f64, trap: f64, steps: usize) -> Simulation {
    let grid = Grid::new([cells, cells], [1.0, 1.0]).unwrap();
    let surface = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        roll_off: 0.25,
        longest: 0.5,
        shortest: 1.0 / 16.0,
        seed: 1,
    };
    let gap = undeformed_gap(&grid, &[Part::SelfAffine(surface)]).unwrap();
    let work = trap * range * range * cells as f64 / 1.1222;
    let points = vec![(0.0, -0.001), (1.0, 0.005), (2.0, -0.005)];
    Simulation {
        boundary,
        loading: Loading { control: Control::Approach, history: History::Table { points } }.into(),
        times: TimeGrid::Uniform { end: 2.0, steps },
        traction: Some(Arc::new(Adhesion { allow_unresolved: true, ..Adhesion::new(work, range) })),
        quantities: Quantities::of([Quantity::OuterIterations]),
        ..Simulation::new(grid, gap)
    }
}

#[test]
fn a_rough_surface_takes_few_convolutions_a_step() {
    // Trap number 0.6. 256 x 256 cells take 28 to 71 with ranges of 2e-4 and 4e-4, periodic and free.
    let found = rows(rough(128, Boundary::Periodic, 4e-4, 0.6, 40));
    let convolutions: usize = found.iter().map(|row| row.convolutions).sum();
    assert!(convolutions < 40 * found.len(), "{convolutions}");
    let [first, last] = [found.first(), found.last()].map(|row| row.unwrap().contact_area);
    assert!((first, last) == (0.0, 0.0) && found.iter().any(|row| row.mean_pressure < 0.0));
}

#[test]
fn an_attraction_stronger_than_the_roughness_closes_the_gap_and_holds() {
    let base = rough(64, Boundary::Periodic, 1e-3, 0.3, 1);
    // Its strength is that of E*.
    let law = Adhesion { allow_unresolved: true, ..Adhesion::new(1e-3, 1e-3) };
    let history = History::Table { points: vec![(0.0, 0.0), (1.0, -0.1)] };
    let simulation = Simulation {
        loading: Loading { control: Control::Pressure, history }.into(),
        times: TimeGrid::Uniform { end: 1.0, steps: 1 },
        traction: Some(Arc::new(law)),
        ..base
    };
    let mut march = March::new(simulation).unwrap();
    let [closed, pulled] = [(); 2].map(|()| {
        let step = march.advance().unwrap().unwrap();
        assert_eq!(step.row().contact_area, 1.0);
        step.pressure().to_owned()
    });
    // In full contact a mean pressure adds to all cells alike; the tolerance of the loop is 1e-4 of the strength.
    let off = closed.iter().zip(&pulled).map(|(a, b)| (a - b - 0.1).abs()).fold(0.0, f64::max);
    assert!(off < 1e-3, "{off}");
}

#[test]
fn the_work_over_a_jump_into_contact_and_off_it_is_known_to_what_the_finding_tells() {
    // A law of finite range: nothing acts before the surfaces jump into contact, so that what the bodies take is no work. The rows of 480
    // steps are 16 times as dense as those of 30.
    let work = |steps: usize| {
        let law = Adhesion { law: AdhesionLaw::Linear, ..exponential(2.36) };
        let simulation = sphere(48, law, &[(0.0, -6.0), (1.0, 1.5), (3.0, -6.0)], steps);
        let known = Known { parts: &[], bodies: &[], thickness: None, mirrored: false };
        let mut diagnostics = Diagnostics::new(&simulation, known);
        let mut march = March::new(simulation).unwrap();
        let mut work = vec![];
        while let Some(step) = march.advance().unwrap() {
            let row = step.row();
            diagnostics.see(&step, &row);
            work.push((row.time(), step.quantity(Quantity::ExternalWork).unwrap()[0]));
        }
        let deepest = work.iter().find(|(time, _)| (time - 1.0).abs() < 1e-9).unwrap().1;
        let found = diagnostics.findings(march.simulation());
        let share = found
            .iter()
            .find(|found| found.code == ENERGY_BALANCE)
            .map_or(0.02, |found| found.value.unwrap());
        let largest = work.iter().map(|(_, work)| work.abs()).fold(0.0, f64::max);
        ([deepest, work.last().unwrap().1], share * largest)
    };
    let (fine, _) = work(480);
    // It does work on the bodies as they come together, and the load does more as they part.
    assert!(fine[0] < 0.0 && fine[1] > 0.0, "{fine:?}");
    let unknown = [30, 36, 45, 60].map(|steps| {
        let (coarse, unknown) = work(steps);
        for (coarse, fine) in coarse.iter().zip(fine) {
            assert!((coarse - fine).abs() <= unknown, "{steps} steps: {coarse} {fine} {unknown}");
        }
        unknown
    });
    // In proportion to the step, but for where in it the jumps lie.
    assert!(unknown[3] < 0.75 * unknown[0], "{unknown:?}");
}
