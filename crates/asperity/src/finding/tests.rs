//! Each finding is reported for a case made for it, and not reported for a similar case.

use std::f64::consts::{FRAC_PI_2, TAU};

use crate::drive::Drive;
use ndarray::Array2;

use super::*;
use crate::drive::March;
use crate::grid::{Boundary, Grid};
use crate::load::{Control, Course, History, Loading, Programme, Stage};
use crate::material::{Body, Creep, CreepTerm, Lateral, Material, Modulus};
use crate::quantities::{Quantities, Quantity};
use crate::simulation::Simulation;
use crate::surface::statistics::SelfAffineFit;
use crate::surface::{Operation, Part, Roughness, SelfAffine, Shape, Surface, undeformed_gap};
use crate::time::TimeGrid;

fn grid(cells: usize, size: f64) -> Grid {
    Grid::new([cells; 2], [size; 2]).unwrap()
}

fn sphere(radius: f64) -> Part {
    Part::Shape { shape: Shape::Sphere { radius }, center: [0.0; 2] }
}

fn rough(shortest: f64, gradient: f64) -> Part {
    Part::SelfAffine(SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(gradient),
        longest: 1e-3,
        shortest,
        roll_off: 1e-3,
        seed: 1,
    })
}

/// A millimetre in 64 cells, 1 MPa, 10 mN applied suddenly and held for a second.
fn simulation(parts: &[Part]) -> Simulation {
    let grid = grid(64, 1e-3);
    Simulation {
        creep: Creep::elastic(1e-6),
        loading: step(0.01),
        ..Simulation::new(grid, undeformed_gap(&grid, parts).unwrap())
    }
}

fn step(value: f64) -> crate::load::Programme {
    Loading { control: Control::Load, history: History::Step { value } }.into()
}

fn loaded(control: Control, history: History) -> crate::load::Programme {
    Loading { control, history }.into()
}

fn zener() -> Creep {
    Creep {
        instantaneous: 1e-6,
        terms: vec![CreepTerm { compliance: 1e-6, retardation_time: 1.0 }],
        fluidity: 0.0,
    }
}

#[test]
fn the_expected_share_of_a_rough_contact_is_twice_the_pressure_over_modulus_and_slope_and_ends_below_one() {
    let parts = [rough(1e-4, 0.1)];
    let share = |load: f64| {
        let loaded = Simulation { loading: step(load), ..simulation(&parts) };
        match Expected::of(&loaded, &parts).unwrap().contact {
            Some(Contact::Share([first, last])) if first == last => first,
            other => panic!("{other:?}"),
        }
    };
    // p C/h' = load/(1 mm)^2 / 1 MPa / h', with the slope h' of the cells near 0.1.
    let light = share(1e-4);
    assert!((light / 2e-3 - 1.0).abs() < 0.1, "{light}");
    assert!((share(2e-4) / light - 2.0).abs() < 1e-4);
    assert!(share(0.1) > 0.9 && share(0.1) < 1.0);
}

fn before(simulation: &Simulation, parts: &[Part]) -> Vec<Finding> {
    Diagnostics::new(simulation, Known { parts, ..Known::default() }).known().to_vec()
}

fn after(simulation: Simulation, parts: &[Part]) -> Vec<Finding> {
    let mut diagnostics = Diagnostics::new(&simulation, Known { parts, ..Known::default() });
    let mut march = March::new(simulation).unwrap();
    while let Some(step) = march.advance().unwrap() {
        diagnostics.see(&step, &step.row());
    }
    diagnostics.findings(march.simulation())
}

fn codes(findings: &[Finding]) -> Vec<&str> {
    assert!(findings.iter().all(|finding| CODES.contains(&finding.code.as_ref())), "{findings:?}");
    findings.iter().map(|finding| finding.code.as_ref()).collect()
}

const QUIET: [&str; 0] = [];

#[test]
fn a_sound_contact_is_silent() {
    let parts = [sphere(5e-3)];
    assert_eq!(codes(&after(simulation(&parts), &parts)), QUIET);
    assert_eq!(codes(&after(simulation(&parts), &[])), QUIET);
}

#[test]
fn bodies_that_never_touch_are_found() {
    let parts = [sphere(5e-3)];
    let apart = |value| {
        let history = History::Step { value };
        let loading = Loading { control: Control::Approach, history }.into();
        after(Simulation { loading, ..simulation(&parts) }, &parts)
    };
    assert_eq!(codes(&apart(-1e-6)), [NO_CONTACT]);
    assert!(!codes(&apart(1e-6)).contains(&NO_CONTACT));
}

#[test]
fn contact_at_the_border_of_a_free_domain_is_found_with_the_size_needed() {
    let parts = [sphere(5e-3)];
    let heavy = Simulation { loading: step(0.2), ..simulation(&parts) };
    let found = after(heavy.clone(), &parts);
    assert!(codes(&found).contains(&CONTACT_AT_BORDER), "{found:?}");
    let border = &found[0];
    assert_eq!((border.rows, border.value), (Some([0, 1]), Some(1e-3)));
    // Hertz: a^3 = 0.75 * 5 mm * 0.2 N / 1 MPa, a = 0.909 mm; room for 2.5 radii.
    let needed = border.limit.unwrap();
    assert!((needed / (2.5 * 0.909e-3) - 1.0).abs() < 0.01, "{needed}");
    // A domain of the size needed is silent.
    let wide = grid(64, needed);
    let parts = [sphere(5e-3)];
    let enough = Simulation { grid: wide, gap: undeformed_gap(&wide, &parts).unwrap(), ..heavy.clone() };
    assert!(!codes(&after(enough, &parts)).contains(&CONTACT_AT_BORDER));
    // Known before the run if the shape is known.
    let expected = Expected::of(&heavy, &parts).unwrap();
    assert!(codes(&expected.findings(&heavy)).contains(&CONTACT_AT_BORDER));
    let light = simulation(&parts);
    assert_eq!(codes(&Expected::of(&light, &parts).unwrap().findings(&light)), QUIET);
    // A periodic domain has no border.
    let periodic = Simulation { boundary: Boundary::Periodic, ..heavy };
    assert!(!codes(&after(periodic, &parts)).contains(&CONTACT_AT_BORDER));
}

/// Of a map with ridges along 30 degrees, continued by its reflections; of ridges along x there is nothing to say. A slope that changes
/// sign at a seam is no jump.
#[test]
fn a_lay_at_an_angle_is_told_where_its_surface_is_mirrored() {
    let half = Grid::new([32, 32], [1e-3, 1e-3]).unwrap();
    let found = |degrees: f64| {
        let across = (degrees.to_radians() + FRAC_PI_2).sin_cos();
        let ridges = |(i, j): (usize, usize)| {
            1e-6 * (TAU * (half.x(i) * across.1 + half.y(j) * across.0) / 2.3e-4).sin()
        };
        let map = Surface::new(half, Array2::from_shape_fn((32, 32), ridges)).unwrap();
        let whole = Operation::Mirror.apply(&map).unwrap();
        let grid = *whole.grid();
        let parts = [Part::Heights { name: "map".into(), heights: whole.into_heights() }];
        let gap = undeformed_gap(&grid, &parts).unwrap();
        let simulation = Simulation { grid, gap, boundary: Boundary::Periodic, ..simulation(&[]) };
        Diagnostics::new(&simulation, Known { parts: &parts, mirrored: true, ..Known::default() })
            .known()
            .to_vec()
    };
    let oblique = found(30.0);
    assert_eq!(codes(&oblique), [LAY_MIRRORED]);
    // The mean of a Hann window over a few ridges finds their angle to a degree.
    assert!((oblique[0].value.unwrap().to_degrees() - 30.0).abs() < 1.0, "{oblique:?}");
    assert_eq!(codes(&found(0.0)), QUIET);
    assert_eq!(codes(&found(90.0)), QUIET);
}

#[test]
fn a_gap_that_does_not_repeat_is_found() {
    let periodic = |parts: &[Part]| {
        let simulation = Simulation { boundary: Boundary::Periodic, ..simulation(parts) };
        codes(&before(&simulation, parts)).into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    let wave = |length| {
        let shape = Shape::Wave { amplitude: 1e-6, wavelength: [length, f64::INFINITY] };
        Part::Shape { shape, center: [0.0; 2] }
    };
    assert_eq!(periodic(&[sphere(5e-3)]), [GAP_NOT_PERIODIC]);
    assert_eq!(periodic(&[wave(0.7e-3)]), [GAP_NOT_PERIODIC]);
    // A rough surface tilted by 30 um.
    let grid = grid(64, 1e-3);
    let Part::SelfAffine(surface) = rough(1e-4, 0.1) else { unreachable!() };
    let mut heights = surface.heights(&grid).unwrap();
    heights.indexed_iter_mut().for_each(|((i, _), z)| *z += 3e-5 * i as f64 / 64.0);
    let tilted = Part::Heights { name: "tilted".into(), heights };
    let simulation_of =
        |part: &Part| Simulation { boundary: Boundary::Periodic, ..simulation(std::slice::from_ref(part)) };
    let found = before(&simulation_of(&tilted), &[]);
    assert_eq!(codes(&found), [GAP_NOT_PERIODIC]);
    // The jump is that of the tilt, 30 um minus one cell, except for the roughness on both sides.
    assert!((found[0].value.unwrap() / 3e-5 - 1.0).abs() < 0.3, "{found:?}");

    assert_eq!(periodic(&[wave(0.5e-3)]), QUIET);
    assert_eq!(periodic(&[rough(1e-4, 0.1)]), QUIET);
    assert_eq!(periodic(&[]), QUIET);
    // A groove with an edge on the border is equally sharp inside.
    let groove = Array2::from_shape_fn((64, 64), |(i, _)| if i < 20 { 1e-6 } else { 0.0 });
    assert_eq!(periodic(&[Part::Heights { name: "groove".into(), heights: groove }]), QUIET);
}

#[test]
fn what_only_the_end_of_a_free_domain_confines_is_found() {
    let free = |parts: &[Part]| before(&simulation(parts), parts);
    assert_eq!(codes(&free(&[rough(1e-4, 0.1)])), [ROUGH_ON_FREE_DOMAIN]);
    assert_eq!(codes(&free(&[sphere(5e-3), rough(1e-4, 0.05)])), QUIET);
    assert_eq!(codes(&free(&[])), QUIET); // flat on flat: a punch of the size of the domain
    let cone = Part::Shape { shape: Shape::Cone { slope: 0.1 }, center: [1e-4, 0.0] };
    assert_eq!(codes(&free(&[cone])), QUIET);
}

#[test]
fn waves_shorter_than_four_cells_are_found() {
    let cell = 1e-3 / 64.0;
    let periodic = |parts: &[Part], known: &[Part]| {
        let simulation = Simulation { boundary: Boundary::Periodic, ..simulation(parts) };
        codes(&before(&simulation, known)).into_iter().map(str::to_owned).collect::<Vec<_>>()
    };
    for (cells, wanted) in
        [(2.5, vec![SHORTEST_WAVE_UNRESOLVED]), (3.9, vec![SHORTEST_WAVE_UNRESOLVED]), (4.1, vec![])]
    {
        let parts = [rough(cells * cell, 0.1)];
        assert_eq!(periodic(&parts, &parts), wanted, "{cells}");
    }
    // From the gap alone the limit is known roughly.
    assert_eq!(periodic(&[rough(2.2 * cell, 0.1)], &[]), [SHORTEST_WAVE_UNRESOLVED]);
    assert_eq!(periodic(&[rough(4.1 * cell, 0.1)], &[]), QUIET);
}

#[test]
fn steep_surfaces_are_found() {
    let parts = [rough(1e-4, 0.6)];
    let periodic = Simulation { boundary: Boundary::Periodic, ..simulation(&parts) };
    assert_eq!(codes(&before(&periodic, &parts)), [LARGE_SLOPE]);
    // A height of millimetres that should be micrometres.
    let Part::SelfAffine(surface) = rough(1e-4, 0.1) else { unreachable!() };
    let of_height = |height| {
        let parts = [Part::SelfAffine(SelfAffine { roughness: Roughness::RmsHeight(height), ..surface })];
        let periodic = Simulation { boundary: Boundary::Periodic, ..simulation(&parts) };
        codes(&before(&periodic, &parts)).join(" ")
    };
    assert!(of_height(1e-3).contains(UNLIKELY_UNIT) && of_height(1e-4).contains(LARGE_SLOPE));
    assert_eq!(of_height(1e-7), "");
    let parts = [rough(1e-4, 0.4)];
    let periodic = Simulation { boundary: Boundary::Periodic, ..simulation(&parts) };
    assert_eq!(codes(&before(&periodic, &parts)), QUIET);
}

#[test]
fn contacts_and_spots_of_a_few_cells_are_found() {
    let parts = [sphere(5e-3)];
    // a = 9.1 um, on cells of 15.6 um.
    let light = Simulation { loading: step(2e-7), ..simulation(&parts) };
    let found = after(light, &parts);
    assert_eq!(codes(&found), [FEW_CONTACT_CELLS, SPOTS_UNRESOLVED]);
    assert_eq!(found[0].rows, Some([0, 1]));
    // Every contact begins with one cell: a ramp that leads to a resolved contact has no finding.
    let ramp = loaded(Control::Load, History::Ramp { value: 0.01, duration: 1.0 });
    let times = TimeGrid::Logarithmic { end: 1.0, steps: 8, first: 1e-5 };
    let found = after(Simulation { loading: ramp, times, ..simulation(&parts) }, &parts);
    assert_eq!(codes(&found), QUIET);
}

#[test]
fn large_strains_are_found_before_and_after() {
    let parts = [sphere(0.6e-3)];
    let of = |load: f64| Simulation { loading: step(load), ..simulation(&parts) };
    // a/R = (3 W / (4 E* R^2))^(1/3): 0.4 at 30.7 mN, 0.2 at 3.8 mN.
    let found = after(of(30.7e-3), &parts);
    assert_eq!(codes(&found), [LARGE_STRAIN], "{found:?}");
    assert!((found[0].value.unwrap() / 0.4 - 1.0).abs() < 0.05, "{found:?}");
    assert_eq!(codes(&after(of(30.7e-3), &[])), [LARGE_STRAIN]);
    assert_eq!(codes(&after(of(3.8e-3), &parts)), QUIET);
    let expected = |load: f64| codes(&Expected::of(&of(load), &parts).unwrap().findings(&of(load))).join(" ");
    assert_eq!([expected(30.7e-3), expected(3.8e-3)], [LARGE_STRAIN.to_owned(), String::new()]);
    // A cone has no radius: w/a = pi slope/2 = 0.47 of the slope 0.3.
    let cone = [Part::Shape { shape: Shape::Cone { slope: 0.3 }, center: [0.0; 2] }];
    let found = after(Simulation { loading: step(3.8e-3), ..simulation(&cone) }, &cone);
    let told = found.iter().find(|finding| finding.code == LARGE_STRAIN).unwrap();
    assert!(
        told.text.contains("of the radius of the contact") && !told.text.contains("the body"),
        "{told:?}"
    );
    // Deeper than its radius.
    let deep = loaded(Control::Approach, History::Step { value: 0.7e-3 });
    let deep = Simulation { loading: deep, ..simulation(&parts) };
    let found = Expected::of(&deep, &parts).unwrap().findings(&deep);
    assert!(codes(&found).contains(&UNLIKELY_UNIT), "{found:?}");
}

#[test]
fn a_contact_that_shrinks_over_its_imprint_is_no_large_strain() {
    // Held for three retardation times, released in a hundredth of one: the imprint stays while the contact shrinks. By Hertz
    // a^3 = 3/4 R W C, so a/R is 0.2 at the end of the hold.
    let parts = [sphere(1e-3)];
    let terms = vec![CreepTerm { compliance: 1e-6, retardation_time: 10.0 }];
    let creep = Creep { instantaneous: 1e-8, terms, fluidity: 0.0 };
    let history = History::Trapezoid { peak: 11e-3, rise: 0.1, hold: 30.0, fall: 0.1 };
    let times = TimeGrid::Adaptive { end: 30.2, tolerance: 1e-2, first: 1e-2 };
    let simulation =
        Simulation { creep, times, loading: loaded(Control::Load, history), ..simulation(&parts) };
    let mut diagnostics = Diagnostics::new(&simulation, Known { parts: &parts, ..Known::default() });
    let mut march = March::new(simulation).unwrap();
    let (mut widest, mut deepest) = (0.0_f64, 0.0_f64);
    while let Some(step) = march.advance().unwrap() {
        let row = step.row();
        diagnostics.see(&step, &row);
        let radius = (row.contact_area / std::f64::consts::PI).sqrt();
        widest = widest.max(radius / 1e-3);
        if radius > 0.0 {
            deepest = deepest.max(row.approach / radius);
        }
    }
    // The run has rows of this kind, and none with a large strain.
    assert!(deepest > 0.3 && widest < 0.25, "{deepest} {widest}");
    let found = diagnostics.findings(march.simulation());
    assert!(!codes(&found).contains(&LARGE_STRAIN), "{found:?}");
}

/// A thermal body with the terms of [`zener`], warmed from 0 to 40 °C in 10 s.
fn warming() -> crate::material::ThermalCreep {
    let shift = crate::material::Shift::Wlf { c1: 8.86, c2: 101.6, reference: 293.15 };
    let clock = crate::material::ReducedTime::new(shift, &[(0.0, 273.15), (10.0, 313.15)]).unwrap();
    crate::material::ThermalCreep { creep: zener(), clock }
}

#[test]
fn a_temperature_that_changes_within_a_step_is_told_where_it_matters() {
    let parts = [sphere(5e-3)];
    let of = |steps, creep, loading| Simulation {
        creep,
        thermal: vec![warming()],
        loading,
        times: TimeGrid::Uniform { end: 10.0, steps },
        ..simulation(&parts)
    };
    let held = || loaded(Control::Approach, History::Step { value: 1e-6 });
    let ramp = || loaded(Control::Load, History::Ramp { value: 0.01, duration: 10.0 });
    // One reduced time and a held approach: exact. Two reduced times, or a load that changes: not exact.
    assert_eq!(codes(&before(&of(5, Creep::elastic(1e-6), held()), &parts)), QUIET);
    for few in [of(5, zener(), held()), of(5, Creep::elastic(1e-6), ramp())] {
        let found = before(&few, &parts);
        assert_eq!(codes(&found), [STEPS_TOO_LONG]);
        assert!(found[0].text.contains("temperature changes the rate"), "{}", found[0].text);
    }
    assert_eq!(codes(&before(&of(40, zener(), held()), &parts)), QUIET);
}

#[test]
fn a_held_approach_with_cells_at_the_hardness_needs_steps() {
    let parts = [sphere(5e-3)];
    let of = |steps, hardness| Simulation {
        creep: zener(),
        loading: loaded(Control::Approach, History::Step { value: 4e-6 }),
        hardness,
        times: TimeGrid::Uniform { end: 3.0, steps },
        ..simulation(&parts)
    };
    let (low, high) = (5e3, 1e9);
    let found = after(of(3, low), &parts);
    assert!(codes(&found).contains(&STEPS_TOO_LONG), "{found:?}");
    assert!(!codes(&after(of(3, high), &parts)).contains(&STEPS_TOO_LONG));
    assert!(!codes(&after(of(30, low), &parts)).contains(&STEPS_TOO_LONG));
}

#[test]
fn a_hold_of_what_was_reached_and_a_steered_one_at_the_hardness_need_steps_as_well() {
    let parts = [sphere(5e-3)];
    let press = History::Ramp { value: 2e-3, duration: 1.0 };
    let of = |steps, hardness| Simulation {
        creep: zener(),
        hardness,
        times: TimeGrid::Uniform { end: 4.0, steps },
        loading: loaded(Control::Load, press.clone()),
        ..simulation(&parts)
    };
    let hold = || Stage::new(Control::Approach, Course::Hold);
    let in_stages = |simulation: Simulation| {
        let first = Stage { duration: Some(1.0), ..Stage::new(Control::Load, press.clone()) };
        after(Simulation { loading: Programme::new(vec![first, hold()]), ..simulation }, &parts)
    };
    let steered = |simulation: Simulation| {
        let mut diagnostics = Diagnostics::new(&simulation, Known { parts: &parts, ..Known::default() });
        let mut march = March::new(simulation).unwrap();
        while let Some(step) = march.advance().unwrap() {
            let row = step.row();
            diagnostics.see(&step, &row);
            if row.coordinate.value() == 1.0 && row.stage == 0 {
                march.prescribe(Stage::new(Control::Approach, Course::Hold)).unwrap();
            }
        }
        diagnostics.findings(march.simulation())
    };
    // A hold of 3 s, while the material relaxes in half a second.
    let (low, high) = (5e3, 1e9);
    let held = |found: Vec<Finding>| {
        found.into_iter().find(|finding| finding.text.contains("held while cells are at"))
    };
    for few in [in_stages(of(8, low)), steered(of(8, low))] {
        // The ramp has two steps, which is a note of its own.
        let finding = held(few).expect("six steps");
        assert!(finding.is_warning() && finding.code == STEPS_TOO_LONG);
        assert_eq!((finding.value, finding.limit, finding.rows), (Some(6.0), Some(10.0), Some([3, 8])));
    }
    for enough in [in_stages(of(16, low)), steered(of(16, low)), in_stages(of(8, high)), steered(of(8, high))]
    {
        assert_eq!(held(enough), None);
    }
}

#[test]
fn steps_too_long_for_a_falling_load_are_found() {
    let parts = [sphere(5e-3)];
    let of = |control, peak, fall, steps| {
        let history = History::Trapezoid { peak, rise: 1.0, hold: 1.0, fall };
        let times = TimeGrid::Uniform { end: 2.0 + fall, steps };
        Simulation { creep: zener(), loading: loaded(control, history), times, ..simulation(&parts) }
    };
    let found = before(&of(Control::Load, 0.01, 1.0, 6), &parts);
    assert_eq!(codes(&found), [STEPS_TOO_LONG]);
    assert_eq!((found[0].value, found[0].rows), (Some(2.0), Some([5, 6])));
    assert_eq!(codes(&before(&of(Control::Load, 0.01, 1.0, 30), &parts)), QUIET);
    assert_eq!(codes(&before(&of(Control::Approach, 1e-6, 1.0, 6), &parts)), [STEPS_TOO_LONG]);
    // Under a rising load area and approach are exact in any step, the pressures are not, and the heat even less.
    let rising = |steps, list| {
        let ramp = loaded(Control::Load, History::Ramp { value: 0.01, duration: 1.0 });
        let quantities = Quantities { list, ..Quantities::default() };
        Simulation { loading: ramp, quantities, ..of(Control::Load, 0.01, 1.0, steps) }
    };
    assert_eq!(codes(&before(&rising(15, vec![]), &parts)), QUIET);
    for (steps, list, least) in [(6, vec![], 4.0), (15, vec![Quantity::DissipatedEnergy], 10.0)] {
        let found = before(&rising(steps, list), &parts);
        assert_eq!(codes(&found), [STEPS_TOO_LONG]);
        assert_eq!(found[0].limit, Some(least));
        assert!(found[0].text.contains("load rises"), "{}", found[0].text);
    }
    // A body without instantaneous compliance, and one with many weak terms.
    let few = of(Control::Load, 0.01, 1.0, 6);
    let kelvin_voigt = Simulation { creep: Creep { instantaneous: 0.0, ..zener() }, ..few.clone() };
    assert_eq!(codes(&before(&kelvin_voigt, &parts)), [STEPS_TOO_LONG]);
    let terms: Vec<(f64, f64)> = (0..24).map(|n| (1e6, 10f64.powf(f64::from(n) / 4.0 - 3.0))).collect();
    let broad = crate::material::Relaxation::absolute(1e6, &terms).unwrap().to_creep().unwrap();
    assert_eq!(codes(&before(&Simulation { creep: broad, ..few }, &parts)), [STEPS_TOO_LONG]);
    // An elastic body is exact in any step, and so is one that is relaxed all the time or never.
    let elastic = Simulation { creep: Creep::elastic(1e-6), ..of(Control::Load, 0.01, 1.0, 6) };
    assert_eq!(codes(&before(&elastic, &parts)), QUIET);
    for time in [1e-3, 1e3] {
        let mut other = of(Control::Load, 0.01, 1.0, 6);
        other.creep.terms[0].retardation_time = time;
        assert_eq!(codes(&before(&other, &parts)), QUIET, "{time}");
    }
    // A load that is held needs no steps, and one that rises gets a note only.
    let of_load =
        |history| Simulation { loading: loaded(Control::Load, history), ..of(Control::Load, 0.01, 1.0, 3) };
    assert_eq!(codes(&before(&of_load(History::Step { value: 0.01 }), &parts)), QUIET);
    let found = before(&of_load(History::Ramp { value: 0.01, duration: 1.0 }), &parts);
    assert!(found.iter().all(|finding| finding.severity == Severity::Note), "{found:?}");
    // The scatter of a measured history is not a change of the load.
    let points =
        (0..60).map(|k| (0.1 * f64::from(k), 1e-6 * (f64::from(k) + 1.5 * f64::from(k % 2)))).collect();
    let measured = loaded(Control::Approach, History::Table { points });
    let times = TimeGrid::Uniform { end: 6.0, steps: 60 };
    let measured = Simulation { loading: measured, times, ..of(Control::Load, 0.01, 1.0, 6) };
    assert_eq!(codes(&before(&measured, &parts)), QUIET);
}

#[test]
fn the_number_of_steps_that_is_advised_is_enough() {
    // A body that yields a hundred times more in 0.1 s, pressed in and out within 2 s.
    let parts = [sphere(5e-3)];
    let terms = vec![CreepTerm { compliance: 1e-6, retardation_time: 0.1 }];
    let of = |steps| Simulation {
        creep: Creep { instantaneous: 1e-8, terms: terms.clone(), fluidity: 0.0 },
        loading: loaded(Control::Approach, History::Triangle { peak: 4e-6, rise: 1.0, fall: 1.0 }),
        times: TimeGrid::Uniform { end: 2.0, steps },
        ..simulation(&parts)
    };
    let advice = |steps: usize| -> Option<usize> {
        let found = after(of(steps), &parts).into_iter().find(|finding| finding.code == STEPS_TOO_LONG)?;
        let (number, rest) = found.text.split_once("Take ")?.1.split_once(' ')?;
        assert!(rest.starts_with(&format!("steps in place of {steps}, or set spacing")), "{}", found.text);
        number.parse().ok()
    };
    let enough = advice(12).unwrap();
    // The error falls with the square of the step: far more would be wasted.
    assert!(enough > 12 && enough < 100, "{enough}");
    assert_eq!(advice(enough), None);
}

#[test]
fn the_advice_for_steps_after_a_jump_is_the_last_one() {
    // A load applied suddenly to a rubber that relaxes from 1 GPa to 1 MPa over six decades of time, most of it far within a step.
    let parts = [sphere(5e-3)];
    let terms: Vec<(f64, f64)> =
        (0..7).map(|n| (10f64.powf(9.0 - 0.5 * f64::from(n)), 10f64.powi(n - 6))).collect();
    let body = crate::material::Relaxation::absolute(1e6, &terms).unwrap().to_creep().unwrap();
    let advice = |times: TimeGrid| {
        let run = Simulation { creep: body.clone(), times, ..simulation(&parts) };
        after(run, &parts).into_iter().find(|finding| finding.code == STEPS_TOO_LONG).map(|found| found.text)
    };
    let given = [
        TimeGrid::Logarithmic { end: 1.0, steps: 20, first: 0.01 },
        TimeGrid::Uniform { end: 1.0, steps: 20 },
    ];
    for times in given {
        let text = advice(times).unwrap();
        assert!(text.contains("Set spacing = \"adaptive\"") && !text.contains("Take "), "{text}");
    }
    assert_eq!(advice(TimeGrid::Adaptive { end: 1.0, tolerance: 1e-2, first: 0.01 }), None);
}

#[test]
fn a_sine_with_few_steps_is_found() {
    let parts = [sphere(5e-3)];
    let of = |steps| {
        let history = History::Sine { mean: 0.01, amplitude: 0.005, frequency: 2.0 };
        let times = TimeGrid::Uniform { end: 10.0, steps };
        Simulation { loading: loaded(Control::Load, history), times, ..simulation(&parts) }
    };
    let found = before(&of(100), &parts);
    assert_eq!(codes(&found), [ALIASED_HISTORY]);
    assert!((found[0].value.unwrap() - 5.0).abs() < 1e-9 && found[0].text.contains("400 steps"), "{found:?}");
    assert_eq!(codes(&before(&of(400), &parts)), QUIET);
}

#[test]
fn a_broken_energy_balance_is_found() {
    let mut balance = super::energy::Balance::default();
    let row = |work: f64, energies: f64| crate::step::EnergyBalance {
        work,
        energies,
        error: (work - energies).abs(),
        adheres: false,
    };
    balance.see(0, &row(1e-9, 1e-9));
    balance.see(1, &row(2e-9, 1.97e-9));
    assert_eq!(balance.finding(), None);
    balance.see(2, &row(6.64e-9, 2.28e-9));
    let found = balance.finding().unwrap();
    assert_eq!((found.code.as_ref(), found.rows), (ENERGY_BALANCE, Some([2, 2])));
    // A run with energies is checked, and its balance holds.
    let parts = [sphere(5e-3)];
    let quantities = Quantities::of([Quantity::ExternalWork]);
    let times = TimeGrid::Uniform { end: 1.0, steps: 40 };
    let loading = loaded(Control::Load, History::Ramp { value: 0.01, duration: 1.0 });
    let simulation = Simulation { creep: zener(), quantities, times, loading, ..simulation(&parts) };
    assert_eq!(codes(&after(simulation, &parts)), QUIET);
}

#[test]
fn moduli_radii_and_heights_of_unlikely_units_are_found() {
    let steel = Part::Shape { shape: Shape::Sphere { radius: 10.0 }, center: [0.0; 2] };
    assert_eq!(
        codes(&before(&simulation(std::slice::from_ref(&steel)), std::slice::from_ref(&steel))),
        [UNLIKELY_UNIT]
    );
    let huge = Simulation { grid: grid(64, 1000.0), gap: Array2::zeros((64, 64)), ..simulation(&[]) };
    assert_eq!(codes(&before(&huge, &[]))[0], UNLIKELY_UNIT);
    let soft = |shear: f64| Body {
        name: "rubber".into(),
        material: Material::elastic(Modulus::Shear, shear).unwrap(),
        lateral: Lateral::Poisson(0.5),
        hardness: None,
    };
    let parts = [sphere(5e-3)];
    let judged = |bodies: &[Body]| {
        let diagnostics =
            Diagnostics::new(&simulation(&parts), Known { parts: &parts, bodies, ..Known::default() });
        codes(diagnostics.known()).join(" ")
    };
    assert_eq!(judged(&[soft(2e-3)]), UNLIKELY_UNIT);
    // 100 Pa for 100 MPa, and the gel of a brain.
    assert_eq!(judged(&[soft(100.0)]), UNLIKELY_UNIT);
    assert_eq!(judged(&[soft(300.0)]), "");
    assert_eq!(judged(&[soft(2e6), soft(210e9)]), "");
    let grid = grid(64, 1e-3);
    let Part::SelfAffine(surface) = rough(1e-4, 0.1) else { unreachable!() };
    let heights = surface.heights(&grid).unwrap();
    let of =
        |factor: f64| of_heights("the surface", &Surface::new(grid, heights.mapv(|z| factor * z)).unwrap());
    assert_eq!(codes(&of(1e6)), [UNLIKELY_UNIT]);
    assert_eq!(codes(&of(1.0)), QUIET);
    let deep = Part::Heights { name: "deep".into(), heights: heights.mapv(|z| 1e11 * z) };
    let periodic = Simulation { boundary: Boundary::Periodic, ..simulation(&[deep]) };
    assert!(codes(&before(&periodic, &[])).contains(&UNLIKELY_UNIT));
}

#[test]
fn outliers_and_hurst_exponents_are_judged() {
    let grid = grid(64, 1e-3);
    let Part::SelfAffine(surface) = rough(1e-4, 0.1) else { unreachable!() };
    let mut heights = surface.heights(&grid).unwrap();
    assert_eq!(codes(&of_heights("it", &Surface::new(grid, heights.clone()).unwrap())), QUIET);
    heights[[10, 10]] = 3e-4;
    assert!(codes(&of_heights("it", &Surface::new(grid, heights).unwrap())).contains(&OUTLIERS));

    let fit =
        |hurst, misfit| SelfAffineFit { hurst, error: 0.1, roll_off: 1e-4, plateau: 1.0, misfit, stray: 0.1 };
    let judged =
        |hurst, misfit| super::hurst(&fit(hurst, misfit)).map(|finding| (finding.code, finding.severity));
    assert_eq!(judged(-4.76, 0.2), Some((HURST_OUT_OF_RANGE.into(), Severity::Warning)));
    assert_eq!(judged(1.17, 0.2), Some((HURST_OUT_OF_RANGE.into(), Severity::Warning)));
    assert_eq!(judged(f64::NAN, 0.2), Some((HURST_OUT_OF_RANGE.into(), Severity::Warning)));
    assert_eq!(judged(0.8, 0.2), None);
    assert_eq!(judged(0.8, 1.5), Some((HURST_UNCERTAIN.into(), Severity::Note)));
    let bent = SelfAffineFit { stray: 1.2, ..fit(0.15, 0.4) };
    assert_eq!(super::hurst(&bent).map(|finding| finding.code), Some(HURST_UNCERTAIN.into()));
}

#[test]
fn poor_fits_and_times_beyond_the_data_are_told() {
    assert_eq!(misfit("rubber", 0.68, 2.0, 0.3).map(|finding| finding.code), Some(MATERIAL_MISFIT.into()));
    // Two per cent of scatter leave two per cent of misfit.
    assert_eq!(misfit("rubber", 0.02, 0.08, 0.02), None);
    let beyond = beyond_data("rubber", [1e-2, 5e3], [1e-2, 1e3], "the run is longer");
    assert_eq!((beyond.value, beyond.limit), (Some(5e3), Some(1e3)));
}

#[test]
fn magnitudes_that_no_contact_has_are_told() {
    let units = |found: &[Finding]| found.iter().filter(|finding| finding.code == UNLIKELY_UNIT).count();
    // A load in Pa that was meant in MPa, on a rough surface: 0.3 Pa on 1 MPa.
    let parts = [rough(5e-5, 0.1)];
    let expected = |pressure: f64| {
        let simulation = Simulation {
            boundary: Boundary::Periodic,
            loading: loaded(Control::Pressure, History::Step { value: pressure }),
            ..simulation(&parts)
        };
        units(&Expected::of(&simulation, &parts).unwrap().findings(&simulation))
    };
    assert_eq!([0.3, 0.3e6].map(expected), [1, 0]);
    // On a sphere the contact of 1e-20 N has less than a cell: a = (3/4 R W C)^(1/3) = 4 nm on cells of 16 um.
    let parts = [sphere(1e-2)];
    let light = |load: f64| {
        let simulation = Simulation { loading: step(load), ..simulation(&parts) };
        units(&Expected::of(&simulation, &parts).unwrap().findings(&simulation))
    };
    assert_eq!([1e-20, 0.01].map(light), [1, 0]);
    let known = |radius: f64, end: f64| {
        let parts = [sphere(radius)];
        let times = TimeGrid::Uniform { end, steps: 2 };
        let simulation = Simulation { times, ..simulation(&parts) };
        units(Diagnostics::new(&simulation, Known { parts: &parts, ..Known::default() }).known())
    };
    assert_eq!((known(5.0, 1.0), known(0.05, 1.0), known(0.05, 1e12)), (1, 0, 1));
    // Pa for MPa: a glass of 3 kPa; a gel in kPa that hardly relaxes is none, without a unit it may be.
    assert!(unlikely_data("it", [3.0, 3e3], false).is_some());
    assert!(unlikely_data("it", [2e3, 5e3], false).is_none());
    assert!(unlikely_data("it", [2e3, 5e3], true).is_some());
    assert!(unlikely_data("it", [1e6, 3e9], true).is_none());
}

#[test]
fn a_sweep_expects_the_strain_of_its_slowest_velocity() {
    // The relaxed body, ten times softer than at once, is what slow motion feels.
    let parts = [sphere(1e-3)];
    let creep = Creep {
        instantaneous: 1e-7,
        terms: vec![CreepTerm { compliance: 1e-5, retardation_time: 1.0 }],
        fluidity: 0.0,
    };
    let simulation = Simulation { creep, loading: step(0.2), ..simulation(&parts) };
    let streaming = crate::sliding::Streaming::new(&simulation).unwrap();
    let strain = |velocities: &[f64]| {
        Expected::of_sweep(&simulation, &parts, &streaming, velocities).unwrap().strain.unwrap()
    };
    // Hertz: 2 a/(pi R) with a^3 = 3/4 R W C, C = C(0) and C(infinity).
    let hertz = |c: f64| 2.0 / std::f64::consts::PI * (0.75e-3 * 0.2 * c).cbrt() / 1e-3;
    // At 1e-9 m/s the wave passes in 1e6 s, at 1e6 m/s in 1e-9 s: C is reached to 1e-5.
    assert!((strain(&[1e-9, 1.0]) / hertz(1.01e-5) - 1.0).abs() < 1e-4);
    assert!((strain(&[1e6]) / hertz(1e-7) - 1.0).abs() < 1e-4);
    let found = Expected::of_sweep(&simulation, &parts, &streaming, &[1e-9]).unwrap().findings(&simulation);
    assert!(codes(&found).contains(&LARGE_STRAIN), "{found:?}");
    // On a rough surface the mean pressure of the spots over the modulus is about half the rms slope, p C = h'/sqrt(pi) at light loads.
    for (slope, large) in [(0.1, false), (0.4, true)] {
        let parts = [rough(1e-4, slope)];
        let gap = undeformed_gap(&simulation.grid, &parts).unwrap();
        let (boundary, loading) = (Boundary::Periodic, step(1e-3));
        let simulation = Simulation { boundary, gap, loading, ..simulation.clone() };
        let expected = Expected::of_sweep(&simulation, &parts, &streaming, &[1e-3]).unwrap();
        assert_eq!(codes(&expected.findings(&simulation)).contains(&LARGE_STRAIN), large, "{slope}");
    }
}

#[test]
fn a_resumed_run_finds_what_a_whole_one_does() {
    let parts = [sphere(5e-3)];
    let history = History::Triangle { peak: 0.2, rise: 1.0, fall: 1.0 };
    let times = TimeGrid::Uniform { end: 2.0, steps: 20 };
    let simulation = Simulation { loading: loaded(Control::Load, history), times, ..simulation(&parts) };
    let known = Known { parts: &parts, ..Known::default() };
    let mut march = March::new(simulation.clone()).unwrap();
    let mut whole = Diagnostics::new(&simulation, known);
    let mut second = Diagnostics::new(&simulation, known);
    let (mut rows, mut stored) = (vec![], vec![]);
    while let Some(step) = march.advance().unwrap() {
        let (row, index) = (step.row(), step.index());
        whole.see(&step, &row);
        rows.push(row);
        // Stored with more rows than the checkpoint has.
        if index == 13 {
            stored = whole.findings(&simulation);
        }
    }
    second.resume(&rows[..12], &[], &stored);
    let mut march = March::new(simulation.clone()).unwrap();
    while let Some(step) = march.advance().unwrap() {
        if step.index() >= 12 {
            second.see(&step, &step.row());
        }
    }
    let found = whole.findings(&simulation);
    assert!(codes(&found).contains(&CONTACT_AT_BORDER));
    assert_eq!(second.findings(&simulation), found);
}

#[test]
fn a_half_space_that_is_thinner_than_its_contact_needs_is_told() {
    let parts = [sphere(1e-3)];
    let rows = |thickness: f64| {
        let simulation = simulation(&parts);
        let known = Known { parts: &parts, thickness: Some(thickness), ..Known::default() };
        let mut diagnostics = Diagnostics::new(&simulation, known);
        let mut march = March::new(simulation).unwrap();
        let mut radius: f64 = 0.0;
        while let Some(step) = march.advance().unwrap() {
            diagnostics.see(&step, &step.row());
            radius = radius.max((step.row().contact_area / std::f64::consts::PI).sqrt());
        }
        (diagnostics.findings(march.simulation()), radius)
    };
    let (deep, radius) = rows(1.0);
    assert!(deep.iter().all(|finding| finding.code != THIN_BODY), "{deep:?}");
    assert!(rows(10.1 * radius).0.iter().all(|finding| finding.code != THIN_BODY));
    let (found, _) = rows(5.0 * radius);
    let thin = found.iter().find(|finding| finding.code == THIN_BODY).expect("a fifth of the thickness");
    assert!(thin.is_warning() && thin.value == Some(radius) && thin.rows.is_some(), "{thin:?}");
    assert!(thin.text.contains("about 20 %"), "{}", thin.text);
    // A periodic domain of 1.6 times the thickness has waves that are affected by the base.
    let periodic = Simulation { boundary: Boundary::Periodic, ..simulation(&parts) };
    let side = periodic.grid.size()[0];
    for (thickness, told) in [(side / 1.6, true), (side / 1.4, false)] {
        let known = Known { parts: &parts, thickness: Some(thickness), ..Known::default() };
        let diagnostics = Diagnostics::new(&periodic, known);
        assert_eq!(diagnostics.known().iter().any(|finding| finding.code == THIN_BODY), told);
    }
}

#[test]
fn adaptive_steps_that_miss_their_tolerance_are_told() {
    let sphere = simulation(&[sphere(10e-3)]);
    let adaptive = TimeGrid::Adaptive { end: 1.0, tolerance: 1e-3, first: 0.1 };
    let simulation = Simulation { times: adaptive, ..sphere };
    let limit = time::limits(&simulation)[0];
    assert_eq!(limit, 2e-3);
    let told = |error: f64, load: f64| {
        let row = time::Coarse { index: 3, error, limit, load, after_jump: false };
        time::coarse(&simulation, &[row], 1.0)
    };
    let found = told(8e-3, 1.0).unwrap();
    assert_eq!((found.code.as_ref(), found.value, found.limit), (STEPS_TOO_LONG, Some(8e-3), Some(2e-3)));
    assert!(found.is_warning() && found.text.contains("0.0002 in place of 0.001"), "{}", found.text);
    // Within twice the tolerance, or of a load that has all but gone.
    assert!(told(1.9e-3, 1.0).is_none() && told(8e-3, 0.1).is_none());
}
