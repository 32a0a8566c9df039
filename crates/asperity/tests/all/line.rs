//! Line contacts in plane strain against closed forms, and against the same contact on a plane.

use asperity::Drive;
use std::f64::consts::PI;

use asperity::drive::March;

use asperity::step::Row;

use asperity::material::{Creep, CreepTerm};
use asperity::quantities::{Quantities, Quantity};
use asperity::simulation::Simulation;
use asperity::surface::{Part, Punch, Roughness, SelfAffine, Shape, undeformed_gap};
use asperity::{Boundary, Control, Event, Grid, History, Loading, SolverOptions, TimeGrid};
use ndarray::Array2;

const RADIUS: f64 = 10e-3;
const MODULUS: f64 = 1e9;
const LOAD: f64 = 2e3;

fn centred(shape: Shape) -> [Part; 1] {
    [Part::Shape { shape, center: [0.0, 0.0] }]
}

fn simulation(grid: Grid, parts: &[Part], boundary: Boundary, load: f64) -> Simulation {
    Simulation {
        boundary,
        creep: Creep::elastic(1.0 / MODULUS),
        loading: Loading { control: Control::Load, history: History::Step { value: load } }.into(),
        solver: SolverOptions { tolerance: 1e-10, ..SolverOptions::default() },
        ..Simulation::new(grid, undeformed_gap(&grid, parts).unwrap())
    }
}

/// The last row, its pressure and its displacement.
fn last(simulation: Simulation) -> (Row, Array2<f64>, Array2<f64>) {
    let shape = simulation.grid.shape();
    let mut march = March::new(simulation).unwrap();
    while march.advance().unwrap().is_some() {}
    let step = march.last().unwrap();
    let mut displacement = Array2::zeros(shape);
    step.displacement_into(&mut displacement);
    (step.row(), step.pressure().to_owned(), displacement)
}

/// Half-width of Hertz's line contact (Johnson 1985, eq. 4.43).
fn hertz() -> f64 {
    (4.0 * LOAD * RADIUS / (PI * MODULUS)).sqrt()
}

/// Displacement at x under Hertz's line contact, up to a constant: -(2/π E*) ∫ p ln|x - s| ds.
fn under_hertz(x: f64) -> f64 {
    let a = hertz();
    let z = (x / a).abs();
    // W/(π E*) times: -z² inside; outside -z² + z sqrt(z² - 1) - ln(z + sqrt(z² - 1)).
    let root = (z * z - 1.0).max(0.0).sqrt();
    2.0 * LOAD / (PI * MODULUS)
        * (-0.5 * z * z + if z > 1.0 { 0.5 * z * root - 0.5 * (z + root).ln() } else { 0.0 })
        * 2.0
}

#[test]
fn a_cylinder_is_the_line_contact_of_hertz() {
    let a = hertz();
    let mut errors = vec![];
    for n in [256, 512] {
        let grid = Grid::line(n, 4.0 * a).unwrap();
        let parts = centred(Shape::Cylinder { radius: RADIUS });
        let (row, pressure, _) = last(simulation(grid, &parts, Boundary::Free, LOAD));
        let dx = grid.spacing()[0];
        let peak = 2.0 * LOAD / (PI * a);
        assert!((row.load / LOAD - 1.0).abs() < 1e-12);
        assert!((row.max_pressure / peak - 1.0).abs() < 1e-4);
        assert!((row.contact_area - 2.0 * a).abs() < 2.0 * dx, "a cell at each end");
        assert_eq!(row.contact_area, row.contact_area_corrected);
        let off = pressure.iter().enumerate().map(|(i, p)| {
            let z = (grid.x(i) - 2.0 * a) / a;
            (p - peak * (1.0 - z * z).max(0.0).sqrt()).abs() / peak
        });
        // The root at the edge is sampled by cells: the worst cell is off by the root of its width.
        assert!(off.clone().fold(0.0, f64::max) < 1.5 * (dx / a).sqrt());
        errors.push(off.sum::<f64>() / n as f64);
        let approach = under_hertz(0.0) - under_hertz(2.0 * a);
        assert!((row.approach / approach - 1.0).abs() < 3e-4, "{} {approach}", row.approach);
    }
    // The mean error falls as dx^1.5 at least: the edge is what is wrong.
    assert!(errors[1] < errors[0] / 2.5, "{errors:?}");
}

#[test]
fn displacements_are_measured_from_the_end_of_the_domain() {
    let a = hertz();
    let grid = Grid::line(512, 6.0 * a).unwrap();
    let parts = centred(Shape::Cylinder { radius: RADIUS });
    let (row, _, u) = last(simulation(grid, &parts, Boundary::Free, LOAD));
    for i in [10, 200, 256, 300, 500] {
        let exact = under_hertz(grid.x(i) - 3.0 * a) - under_hertz(3.0 * a);
        // Second order in a/dx = 85, of the approach.
        assert!((u[(i, 0)] - exact).abs() < 3e-4 * row.approach, "{i}: {} {exact}", u[(i, 0)]);
    }
}

/// Displacement at x under pressures that are even in each cell: -(2/π E*) Σ p ∫ ln|x - s| ds, with ∫ ln|z| = z ln|z| - z.
fn potential(grid: &Grid, pressure: &Array2<f64>, x: f64, modulus: f64) -> f64 {
    let dx = grid.spacing()[0];
    let part = |z: f64| if z == 0.0 { 0.0 } else { z * z.abs().ln() - z };
    let of_cell = |i: usize| {
        let s = x - grid.x(i);
        pressure[(i, 0)] * (part(s + 0.5 * dx) - part(s - 0.5 * dx))
    };
    -2.0 / (PI * modulus) * (0..grid.len()).map(of_cell).sum::<f64>()
}

#[test]
fn the_approach_of_a_line_is_measured_from_its_end_wherever_the_contact_is() {
    // A cylinder in 41 cells at several distances from the end x = L, down to one open cell; a body that creeps by a factor of 1.5 under the
    // held load, so that the contact grows.
    let creep = |later: f64| Creep {
        instantaneous: 1.0 / MODULUS,
        terms: vec![CreepTerm { compliance: later / MODULUS, retardation_time: 1.0 }],
        fluidity: 0.0,
    };
    let a = hertz();
    let grid = Grid::line(41, 12.0 * a).unwrap();
    let dx = grid.spacing()[0];
    for (cells, later) in [(0, 0.0), (8, 0.0), (14, 0.0), (16, 0.0), (8, 0.5), (13, 0.5)] {
        let cylinder = Shape::Cylinder { radius: RADIUS };
        let center = [dx * f64::from(cells), 0.0];
        let mut case = simulation(grid, &[Part::Shape { shape: cylinder, center }], Boundary::Free, LOAD);
        case.creep = creep(later);
        case.times = TimeGrid::List(vec![1e3]);
        let (row, pressure, _) = last(case);
        // Under a held load that crept to its end the displacement is that of a body of the relaxed modulus.
        let relaxed = MODULUS / (1.0 + later);
        let u = |x: f64| potential(&grid, &pressure, x, relaxed);
        let i = (grid.len() / 2) + cells as usize;
        let expected = u(grid.x(i)) - u(grid.x(40) + 0.5 * dx);
        // The creep of a contact that grows is not that of one shape: 1e-4 of the constant, which is 0.3 of the approach. Without creep: the
        // tolerance of the solver.
        let tolerance = if later > 0.0 { 1e-4 } else { 1e-8 };
        assert!(
            (row.approach / expected - 1.0).abs() < tolerance,
            "{cells} {later}: {} {expected}",
            row.approach
        );
    }
}

#[test]
fn a_line_is_a_plane_on_which_nothing_changes_along_y() {
    let length = 1e-3;
    let profile = SelfAffine {
        hurst: 0.8,
        roughness: Roughness::RmsGradient(0.1),
        longest: 5e-4,
        shortest: 5e-5,
        roll_off: 2e-4,
        seed: 3,
    };
    let line = Grid::line(128, length).unwrap();
    let heights = profile.heights(&line).unwrap();
    let plane = Grid::new([128, 6], [length, 6.0 * length / 128.0]).unwrap();
    let wide = Array2::from_shape_fn((128, 6), |(i, _)| heights[(i, 0)]);
    let part = |heights| [Part::Heights { name: "profile".into(), heights }];
    let pressure = 1e-2 * MODULUS;
    let mut of_line = simulation(line, &part(heights), Boundary::Periodic, pressure);
    let mut of_plane = simulation(plane, &part(wide), Boundary::Periodic, pressure);
    for simulation in [&mut of_line, &mut of_plane] {
        simulation.loading =
            Loading { control: Control::Pressure, history: History::Ramp { value: pressure, duration: 1.0 } }
                .into();
        simulation.creep = Creep {
            instantaneous: 1.0 / MODULUS,
            terms: vec![CreepTerm { compliance: 3.0 / MODULUS, retardation_time: 0.5 }],
            fluidity: 0.0,
        };
        simulation.times = TimeGrid::Uniform { end: 2.0, steps: 8 };
        simulation.quantities =
            Quantities { list: vec![Quantity::DissipatedEnergy], ..Quantities::default() };
    }
    let ((row, p, u), (wide_row, wide_p, wide_u)) = (last(of_line), last(of_plane));
    for (value, other) in [
        (row.approach, wide_row.approach),
        (row.max_pressure, wide_row.max_pressure),
        (row.contact_fraction, wide_row.contact_fraction),
        (row.mean_gap, wide_row.mean_gap),
    ] {
        // The tolerance of both solves.
        assert!((value / other - 1.0).abs() < 1e-8, "{value} {other}");
    }
    for i in 0..128 {
        assert!((p[(i, 0)] - wide_p[(i, 4)]).abs() < 1e-7 * row.max_pressure);
        assert!((u[(i, 0)] - wide_u[(i, 2)]).abs() < 1e-8 * row.approach);
    }
}

#[test]
fn a_periodic_strip_punch_has_the_pressure_of_its_closed_form() {
    // p = pm cos(πx/l)/sqrt(sin²(πa/l) - sin²(πx/l)), from Westergaard's function of the open gaps.
    let (length, half) = (1.0, 0.25);
    let mut errors = vec![];
    for n in [256, 1024] {
        let grid = Grid::line(n, length).unwrap();
        let parts = centred(Shape::FlatPunch(Punch::Rectangle { size: [2.0 * half, f64::INFINITY] }));
        let (row, pressure, u) = last(simulation(grid, &parts, Boundary::Periodic, LOAD));
        let sine = |x: f64| (PI * x / length).sin();
        let mut worst = 0.0_f64;
        for i in 0..n {
            let x = grid.x(i) - 0.5 * length;
            if x.abs() < 0.8 * half {
                let exact =
                    LOAD / length * (PI * x / length).cos() / (sine(half).powi(2) - sine(x).powi(2)).sqrt();
                worst = worst.max((pressure[(i, 0)] / exact - 1.0).abs());
            }
        }
        errors.push(worst);
        // u under the punch, from its mean: -(2 pm l/(π E*)) ln sin(πa/l).
        let exact = -2.0 * LOAD / (PI * MODULUS) * sine(half).ln();
        assert!((u[(n / 2, 0)] / exact - 1.0).abs() < 6.0 / n as f64, "{} {exact}", u[(n / 2, 0)]);
        assert!((row.contact_area - 2.0 * half).abs() < 1e-12);
    }
    // The edges, at which the pressure is endless, are first order.
    assert!(errors[0] < 2e-2 && errors[1] < errors[0] / 3.0, "{errors:?}");
}

#[test]
fn a_held_load_widens_a_cylinder_as_the_root_of_the_compliance() {
    let a = hertz();
    let grid = Grid::line(512, 8.0 * a).unwrap();
    let mut creeping = simulation(grid, &centred(Shape::Cylinder { radius: RADIUS }), Boundary::Free, LOAD);
    creeping.creep.terms = vec![CreepTerm { compliance: 3.0 / MODULUS, retardation_time: 1.0 }];
    creeping.times = TimeGrid::Uniform { end: 2.0, steps: 20 };
    let half = |t: f64| a * ((1.0 + 3.0 * (1.0 - (-t).exp())).sqrt());
    let (row, ..) = last(creeping);
    assert!((row.contact_area - 2.0 * half(2.0)).abs() < 2.0 * grid.spacing()[0], "{}", row.contact_area);
    // A growing contact (Lee and Radok 1960): p0(t) = ∫ E(t - s) d(a(s) / 2R), here with E = (1 + 3 exp(-4 t)) / 4 of the modulus.
    let modulus = |t: f64| MODULUS * (0.25 + 0.75 * (-4.0 * t).exp());
    let steps = 4000;
    let at = |k: usize| 2.0 * k as f64 / steps as f64;
    let grown = (0..steps).map(|k| {
        let middle = 0.5 * (at(k) + at(k + 1));
        modulus(2.0 - middle) * (half(at(k + 1)) - half(at(k)))
    });
    let peak = (modulus(2.0) * half(0.0) + grown.sum::<f64>()) / (2.0 * RADIUS);
    // 20 steps of second order.
    assert!((row.max_pressure / peak - 1.0).abs() < 3e-3, "{} {peak}", row.max_pressure);
}

#[test]
fn what_a_free_line_contact_does_not_determine_is_refused() {
    let grid = Grid::line(32, 1e-3).unwrap();
    let parts = centred(Shape::Cylinder { radius: RADIUS });
    let base = || simulation(grid, &parts, Boundary::Free, LOAD);
    let approach = Loading { control: Control::Approach, history: History::Step { value: 1e-6 } };
    let refused = |simulation: Simulation, word: &str| {
        let message = March::new(simulation).err().unwrap().to_string();
        assert!(message.contains(word) && message.contains("periodic"), "{message}");
    };
    refused(Simulation { loading: approach.clone().into(), ..base() }, "approach");
    let mut until = base();
    until.loading.stages[0].until = Some(Event::Approach(1e-6));
    refused(until, "approach");
    let energy = Quantities { list: vec![Quantity::ElasticEnergy], ..Quantities::default() };
    refused(Simulation { quantities: energy, ..base() }, "elastic_energy");
    assert!(
        March::new(Simulation { loading: approach.into(), boundary: Boundary::Periodic, ..base() }).is_ok()
    );
}

#[test]
fn a_rough_profile_falls_off_as_its_hurst_exponent_says() {
    let grid = Grid::line(4096, 1e-3).unwrap();
    let surface = SelfAffine {
        hurst: 0.7,
        roughness: Roughness::RmsGradient(0.2),
        longest: 1e-3,
        shortest: 1e-6,
        roll_off: 1e-3,
        seed: 1,
    };
    let heights = surface.heights(&grid).unwrap();
    let slope = |i: usize| (heights[((i + 1) % 4096, 0)] - heights[(i, 0)]) / grid.spacing()[0];
    let rms = ((0..4096).map(|i| slope(i).powi(2)).sum::<f64>() / 4096.0).sqrt();
    // The shortest wave has four cells: the difference quotient sees up to 0.9 of its slope.
    assert!((rms / 0.2 - 1.0).abs() < 0.1, "{rms}");
    // Structure function <(z(x + l) - z(x))²> ~ l^2H over two decades.
    let structure = |lag: usize| {
        (0..4096).map(|i| (heights[((i + lag) % 4096, 0)] - heights[(i, 0)]).powi(2)).sum::<f64>()
    };
    let hurst = 0.5 * (structure(160) / structure(10)).ln() / 16f64.ln();
    // One profile of a random surface.
    assert!((hurst - 0.7).abs() < 0.12, "{hurst}");
}
