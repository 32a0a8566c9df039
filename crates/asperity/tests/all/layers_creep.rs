//! Layers that creep differently: a viscoelastic coating on an elastic half-space.

use asperity::Drive;
use std::sync::Arc;

use asperity::history::check_layers;
use asperity::layer::{BodyLayer, Interface, LayeredBody, Response, response};
use asperity::material::{Body, Lateral, Material, Modulus, Relaxation};
use asperity::process::Motion;
use asperity::simulation::{Scheme, Simulation};
use asperity::sliding::{Direction, MovingGap, Path};
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Boundary, Control, Grid, History, Loading, March, SolverOptions, TimeGrid};

fn body(name: &str, material: Material, poisson: f64) -> Body {
    Body { name: name.into(), material, lateral: Lateral::Poisson(poisson), hardness: None }
}

/// Shear relaxation g (r + (1 - r) exp(-t)): relaxation time 1, retardation time 1/r.
fn zener(g: f64, r: f64) -> Material {
    let fraction = 1.0 - r;
    Material::prony(Modulus::Shear, Relaxation::from_instantaneous(g, &[(fraction, 1.0)]).unwrap()).unwrap()
}

fn elastic(g: f64) -> Material {
    Material::elastic(Modulus::Shear, g).unwrap()
}

fn layer(thickness: f64, material: Material, poisson: f64) -> BodyLayer {
    BodyLayer { thickness, interface: Interface::Bonded, material: body("coating", material, poisson) }
}

/// An incompressible coating of thickness 1, shear relaxation 0.2 + 0.8 exp(-t), on a half-space of shear modulus 2 and
/// Poisson's ratio 0.3.
fn coated(r: f64) -> Response {
    let base = Some(body("base", elastic(2.0), 0.3));
    response(&[LayeredBody { layers: vec![layer(1.0, zener(1.0, r), 0.5)], base }]).unwrap()
}

fn simulation(grid: Grid, part: Part, of: &Response) -> Simulation {
    Simulation {
        kernel: Arc::new(of.kernel.clone()),
        creep: of.creep.clone(),
        layers: of.waves.clone(),
        solver: SolverOptions { tolerance: 1e-8, ..SolverOptions::default() },
        ..Simulation::new(grid, undeformed_gap(&grid, &[part]).unwrap())
    }
}

fn sphere(
    n: usize,
    side: f64,
    of: &Response,
    control: Control,
    history: History,
    times: TimeGrid,
) -> Simulation {
    let grid = Grid::new([n, n], [side, side]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    Simulation { loading: Loading { control, history }.into(), times, ..simulation(grid, part, of) }
}

/// (approach, load, pressure in the middle) of each row.
fn run(simulation: Simulation) -> Vec<[f64; 3]> {
    let middle = simulation.grid.cells().map(|n| n / 2);
    let mut march = March::new(simulation).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push([step.row().approach, step.row().load, step.pressure()[(middle[0], middle[1])]]);
    }
    rows
}

/// (q, t, C(q, t)) of the coated body, by inversion of the Laplace transform (Talbot's contour).
const TRANSFER: [(f64, f64, f64); 12] = [
    (0.1, 0.0, 3.283373821900204),
    (0.1, 2.0, 3.3029533128247855),
    (0.5, 0.0, 0.593827203072881),
    (0.5, 2.0, 0.6745373216324334),
    (0.5, 10.0, 0.7986470836299333),
    (1.0, 0.5, 0.38207846821338126),
    (1.0, 2.0, 0.500043433463301),
    (1.0, 10.0, 0.7591208911179042),
    (2.0, 0.5, 0.28000435335658036),
    (2.0, 10.0, 0.7808441846533212),
    (5.0, 0.0, 0.09981692825181078),
    (5.0, 10.0, 0.4439097101292621),
];

#[test]
fn each_wave_creeps_as_the_inverted_transform_says() {
    let waves = coated(0.2).waves.unwrap();
    assert!(waves.misfit() < 1e-4, "{}", waves.misfit());
    let [shortest, longest] = waves.times();
    assert!((shortest - 1.0).abs() < 1e-14 && (longest / 5.0 - 1.0).abs() < 1e-14);
    for (q, t, exact) in TRANSFER {
        let found = waves.creep(q).unwrap().value(t);
        // The misfit, and 1e-7 of the digits of one of the numbers.
        assert!((found / exact - 1.0).abs() < 1e-4, "{q} {t}: {found} {exact}");
    }
}

#[test]
fn a_sphere_sinks_in_from_the_glassy_to_the_relaxed_elastic_body() {
    let of = coated(0.2);
    // (load, radius, approach, peak pressure) of the elastic bodies, by the integral equation.
    let rows = [
        (0, 0.6861028533955584, 0.5, 0.22021827173852504, 1.3128220160497819),
        (1, 1.4241102518316238, 1.0, 0.6307438860075739, 0.7142379480751817),
    ];
    for (row, load, radius, approach, peak) in rows {
        // 20 cells to the radius, an odd number of cells across.
        let (n, side) = (61, 3.05 * radius);
        let times = TimeGrid::List(vec![400.0]);
        let rows = run(sphere(n, side, &of, Control::Load, History::Step { value: load }, times));
        let [w, _, p] = rows[row];
        // Cells of a twentieth of the radius: second order. The half-space: 3e-4 and 1e-3.
        assert!((w / approach - 1.0).abs() < 5e-4, "{w} {approach}");
        assert!((p / peak - 1.0).abs() < 1.5e-3, "{p} {peak}");
    }
}

#[test]
fn full_contact_relaxes_as_each_wave_does_at_any_length_of_the_steps() {
    for r in [0.2, 1e-3] {
        let of = coated(r);
        let (n, side) = (16, 4.0);
        let q = std::f64::consts::TAU / side;
        let amplitude = 1e-3;
        let grid = Grid::new([n, n], [side, side]).unwrap();
        let relaxation = of.waves.as_ref().unwrap().creep(q).unwrap().to_relaxation().unwrap();
        for times in [vec![1000.0], vec![0.3, 10.0, 2e4], (1..20).map(|k| 0.5 * f64::from(k)).collect()] {
            let wave = Part::Shape {
                shape: Shape::Wave { amplitude: amplitude / 2.0, wavelength: [side, f64::INFINITY] },
                center: [0.0, 0.0],
            };
            let simulation = Simulation {
                boundary: Boundary::Periodic,
                loading: Loading { control: Control::Pressure, history: History::Step { value: 1.0 } }.into(),
                times: TimeGrid::List(times),
                ..simulation(grid, wave, &of)
            };
            let shape: Vec<f64> = (0..n).map(|i| (q * grid.x(i)).cos()).collect();
            let amplitude_of =
                |field: Vec<f64>| 2.0 / n as f64 * field.iter().zip(&shape).map(|(p, c)| p * c).sum::<f64>();
            let given = amplitude_of(simulation.gap.column(0).to_vec());
            let mut march = March::new(simulation).unwrap();
            while let Some(step) = march.advance().unwrap() {
                let found = -amplitude_of(step.pressure().column(0).to_vec()) / given;
                let exact = relaxation.value(step.row().time());
                // The tolerance of the solver, in units of the mean pressure over that of the wave.
                let error = (found - exact).abs() / relaxation.instantaneous();
                assert!(error < 1e-5, "{r} {}: {found} {exact}", step.row().time());
            }
        }
    }
}

#[test]
fn a_held_approach_ends_at_the_relaxed_body_whatever_the_steps() {
    for r in [0.1, 1e-3] {
        let of = coated(r);
        let held = |times: Vec<f64>| {
            run(sphere(41, 3.0, &of, Control::Approach, History::Step { value: 0.2 }, TimeGrid::List(times)))
        };
        let end = 1e3 / r;
        let coarse = held(vec![end]);
        let fine = held((0..=60).map(|k| end * 10f64.powf(f64::from(k) / 15.0 - 4.0)).collect());
        // The elastic body of long times.
        let base = Some(body("base", elastic(2.0), 0.3));
        let relaxed = response(&[LayeredBody { layers: vec![layer(1.0, elastic(r), 0.5)], base }]).unwrap();
        let times = TimeGrid::List(vec![1.0]);
        let exact = run(sphere(41, 3.0, &relaxed, Control::Approach, History::Step { value: 0.2 }, times));
        for rows in [&coarse, &fine] {
            let [_, load, _] = rows[rows.len() - 1];
            // What a step of a thousand retardation times leaves: γ is 1 - τ/x.
            assert!((load / exact[1][1] - 1.0).abs() < 3e-3, "{r}: {load} {}", exact[1][1]);
        }
        // In between the load falls and never rises, whatever the step.
        assert!(fine.windows(2).all(|pair| pair[1][1] <= pair[0][1] * (1.0 + 1e-6)), "{fine:?}");
    }
}

#[test]
fn long_steps_are_as_good_as_short_ones() {
    let of = coated(0.2);
    let at = |times: Vec<f64>, control, value| {
        run(sphere(41, 3.0, &of, control, History::Step { value }, TimeGrid::List(times)))
    };
    for (control, value, column) in [(Control::Load, 0.6, 0), (Control::Approach, 0.2, 1)] {
        let fine = at((1..=160).map(|k| 0.025 * f64::from(k)).collect(), control, value);
        for (steps, tolerance) in [(1, 2e-2), (4, 4e-3), (16, 1e-3)] {
            let coarse =
                at((1..=steps).map(|k| 4.0 * f64::from(k) / f64::from(steps)).collect(), control, value);
            let (found, exact) = (coarse[steps as usize][column], fine[160][column]);
            assert!((found / exact - 1.0).abs() < tolerance, "{control:?} {steps}: {found} {exact}");
        }
    }
}

#[test]
fn a_layer_of_two_equal_parts_is_one() {
    let base = || Some(body("base", elastic(2.0), 0.3));
    let one = coated(0.2);
    let layers = vec![layer(0.3, zener(1.0, 0.2), 0.5), layer(0.7, zener(1.0, 0.2), 0.5)];
    let two = response(&[LayeredBody { layers, base: base() }]).unwrap();
    let rows = |of: &Response| {
        let times = TimeGrid::Uniform { end: 4.0, steps: 3 };
        run(sphere(33, 3.0, of, Control::Load, History::Step { value: 0.6 }, times))
    };
    for (a, b) in rows(&one).iter().zip(&rows(&two)) {
        // The tolerance of the solver.
        assert!((a[0] / b[0] - 1.0).abs() < 1e-7 && (a[2] / b[2] - 1.0).abs() < 1e-6, "{a:?} {b:?}");
    }
}

#[test]
fn a_base_that_does_not_yield_leaves_the_march_of_one_layer() {
    let layers = vec![layer(1.0, zener(1.0, 0.2), 0.4)];
    let rigid = response(&[LayeredBody { layers: layers.clone(), base: None }]).unwrap();
    let stiff = LayeredBody { layers, base: Some(body("base", elastic(1e7), 0.3)) };
    let stiff = response(&[stiff]).unwrap();
    assert!(rigid.waves.is_none() && stiff.waves.is_some());
    for (control, value) in [(Control::Load, 0.6), (Control::Approach, 0.2)] {
        let rows = |of: &Response| {
            let times = TimeGrid::Uniform { end: 6.0, steps: 12 };
            run(sphere(33, 3.0, of, control, History::Step { value }, times))
        };
        for (a, b) in rows(&rigid).iter().zip(&rows(&stiff)) {
            for k in 0..2 {
                // A base of 1e7 times the stiffness; the misfit of the creep; u in tables of six points.
                assert!((a[k] / b[k] - 1.0).abs() < 1e-4, "{control:?} {a:?} {b:?}");
            }
        }
    }
}

#[test]
fn bodies_recover_when_they_come_apart() {
    // Pressed, taken apart for a while, pressed again to the same depth: the load is less than at first, the less the shorter.
    let of = coated(0.2);
    let loads: Vec<f64> = [0.5, 3.0, 80.0]
        .iter()
        .map(|apart| {
            let again = 2.0 + apart;
            let points =
                vec![(0.0, 0.2), (2.0, 0.2), (2.0, -1.0), (again, -1.0), (again, 0.2), (again + 1.0, 0.2)];
            let history = History::Table { points };
            let times = TimeGrid::Uniform { end: again + 1.0, steps: 3 };
            let rows = run(sphere(33, 3.0, &of, Control::Approach, history, times));
            let open = rows.iter().position(|row| row[1] == 0.0).unwrap();
            let second = rows[open..].iter().find(|row| row[1] > 0.0).unwrap();
            second[1] / rows[0][1]
        })
        .collect();
    assert!(loads[0] < loads[1] && loads[1] < loads[2], "{loads:?}");
    // The retardation time is 5: what is left after 16 of them is below 1e-6.
    assert!((loads[2] - 1.0).abs() < 1e-4, "{loads:?}");
}

#[test]
fn a_march_resumed_from_a_checkpoint_gives_the_same_bits() {
    let of = coated(0.2);
    let of_run = || {
        let times = TimeGrid::Uniform { end: 4.0, steps: 8 };
        sphere(24, 3.0, &of, Control::Load, History::Ramp { value: 0.6, duration: 2.0 }, times)
    };
    let mut whole = March::new(of_run()).unwrap();
    let mut pressures = vec![];
    while let Some(step) = whole.advance().unwrap() {
        pressures.push(step.pressure().to_owned());
    }
    for stop in [1, 4, 6] {
        let mut first = March::new(of_run()).unwrap();
        for _ in 0..stop {
            first.advance().unwrap();
        }
        let checkpoint = first.checkpoint().into_owned();
        let mut second = March::resume(of_run(), &checkpoint).unwrap();
        while let Some(step) = second.advance().unwrap() {
            assert_eq!(step.pressure(), pressures[step.index()], "{stop}: row {}", step.index());
        }
        assert_eq!(second.done(), pressures.len());
    }
}

/// An elastic coating of thickness 0.1 on the rubber of shear relaxation 0.2 + 0.8 exp(-t).
fn stiff_coating(shear: f64) -> Response {
    let base = Some(body("rubber", zener(1.0, 0.2), 0.5));
    response(&[LayeredBody { layers: vec![layer(0.1, elastic(shear), 0.3)], base }]).unwrap()
}

#[test]
fn a_stiff_coating_on_rubber_sinks_in_from_the_glassy_to_the_relaxed_elastic_body() {
    let of = stiff_coating(20.0);
    let elastic_body = |g: f64| {
        let base = Some(body("rubber", elastic(g), 0.5));
        response(&[LayeredBody { layers: vec![layer(0.1, elastic(20.0), 0.3)], base }]).unwrap()
    };
    let step = || History::Step { value: 0.3 };
    let creeping = run(sphere(48, 3.0, &of, Control::Load, step(), TimeGrid::List(vec![1e-6, 300.0])));
    for (row, g) in [(0, 1.0), (2, 0.2)] {
        let exact = run(sphere(48, 3.0, &elastic_body(g), Control::Load, step(), TimeGrid::List(vec![1.0])));
        for k in [0, 2] {
            // The misfit of the creep, and one step of 60 retardation times.
            let (found, exact) = (creeping[row][k], exact[1][k]);
            assert!((found / exact - 1.0).abs() < 1e-3, "{g} {k}: {found} {exact}");
        }
    }
    // A domain of the same cells, twice as wide, sees the same.
    let times = || TimeGrid::List(vec![1.0, 5.0]);
    let [small, large] =
        [(48, 3.0), (96, 6.0)].map(|(n, side)| run(sphere(n, side, &of, Control::Load, step(), times())));
    for (a, b) in small.iter().zip(&large) {
        assert!((a[0] / b[0] - 1.0).abs() < 2e-4 && (a[2] / b[2] - 1.0).abs() < 1e-3, "{a:?} {b:?}");
    }
}

#[test]
fn a_domain_that_is_narrow_against_the_bending_of_a_coating_is_refused() {
    let of = stiff_coating(1e6);
    let simulation = || {
        let history = History::Step { value: 0.1 };
        sphere(24, 3.0, &of, Control::Load, history, TimeGrid::List(vec![1.0]))
    };
    let error = March::new(simulation()).err().unwrap().to_string();
    assert!(error.contains("bend") && error.contains("periodic"), "{error}");
    let waves = of.waves.as_ref().unwrap();
    assert!(check_layers(&simulation().grid, Boundary::Free, waves).is_err());
    assert!(check_layers(&simulation().grid, Boundary::Periodic, waves).is_ok());
    March::new(Simulation { boundary: Boundary::Periodic, ..simulation() }).unwrap();
}

#[test]
fn laws_of_times_that_lie_far_apart_are_fitted_between_them_too() {
    // Terms at 1e-3, 1, 1e3 and 1e5 s on rubber that relaxes in 1 s.
    let terms = [(0.3, 1e-3), (0.3, 1.0), (0.3, 1e3), (0.099, 1e5)];
    let wide = Relaxation::from_instantaneous(100.0, &terms).unwrap();
    let layers = vec![layer(1.0, Material::prony(Modulus::Shear, wide).unwrap(), 0.49)];
    let of = response(&[LayeredBody { layers, base: Some(body("rubber", zener(1.0, 0.2), 0.3)) }]).unwrap();
    let misfit = of.waves.unwrap().misfit();
    assert!(misfit < 5e-4, "{misfit}");
}

/// Largest estimated error of the rows, approach and pressure in the middle at the end, and the number of rows.
fn estimated(simulation: Simulation) -> (f64, [f64; 2], usize) {
    let middle = simulation.grid.cells().map(|n| n / 2);
    let mut march = March::new(simulation).unwrap();
    let (mut most, mut end) = (0.0_f64, [0.0; 2]);
    while let Some(step) = march.advance().unwrap() {
        most = most.max(step.row().time_error.unwrap());
        end = [step.row().approach, step.pressure()[(middle[0], middle[1])]];
    }
    (most, end, march.done())
}

#[test]
fn the_error_of_long_steps_is_estimated() {
    let of = coated(0.2);
    let at = |steps| {
        let times = TimeGrid::Uniform { end: 4.0, steps };
        estimated(sphere(33, 3.0, &of, Control::Load, History::Step { value: 0.6 }, times))
    };
    let (_, [_, exact], _) = at(160);
    for steps in [1, 2, 4, 16] {
        let (told, [_, found], _) = at(steps);
        let error = (found / exact - 1.0).abs();
        // An estimate of the sum over the contact, not of the middle.
        assert!(told > 0.3 * error && told < 30.0 * error + 1e-3, "{steps}: {told} {error}");
    }
    assert!(at(1).0 > 0.02 && at(160).0 < 1e-3, "{} {}", at(1).0, at(160).0);
}

#[test]
fn adaptive_steps_keep_their_tolerance() {
    let of = coated(0.2);
    let ramp = || History::Table { points: vec![(0.0, 0.0), (2.0, 0.6), (6.0, 0.2)] };
    let fine = {
        let times = TimeGrid::Uniform { end: 6.0, steps: 240 };
        estimated(sphere(33, 3.0, &of, Control::Load, ramp(), times))
    };
    for tolerance in [1e-2, 1e-3] {
        let times = TimeGrid::Adaptive { end: 6.0, tolerance, first: 0.05 };
        let (_, end, rows) = estimated(sphere(33, 3.0, &of, Control::Load, ramp(), times));
        let error = (end[1] / fine.1[1] - 1.0).abs();
        assert!(error < tolerance && rows < 150, "{tolerance}: {error} in {rows} rows");
    }
}

#[test]
fn what_is_not_solved_is_refused() {
    let of = coated(0.2);
    let times = TimeGrid::Uniform { end: 1.0, steps: 2 };
    let simulation = sphere(16, 3.0, &of, Control::Load, History::Step { value: 0.1 }, times);
    let constant = Simulation { scheme: Scheme::Constant, ..simulation };
    let error = March::new(constant).err().unwrap().to_string();
    assert!(error.contains("layers that creep differently"), "{error}");
}

/// A cylinder that slides over a coating far thicker than the longest wave, on this base.
fn sliding_over(base: Material, velocity: f64) -> Vec<(asperity::step::Row, f64)> {
    let grid = Grid::line(128, 4.0).unwrap();
    let base = Some(body("base", base, 0.5));
    let of = response(&[LayeredBody { layers: vec![layer(20.0, zener(1.0, 0.2), 0.5)], base }]).unwrap();
    let part = Part::Shape { shape: Shape::Cylinder { radius: 1.0 }, center: [0.0, 0.0] };
    let motion = Motion {
        path: Path::of_velocity(History::Step { value: velocity }, 0.0).unwrap(),
        direction: Direction::X,
        gap: MovingGap::new(&grid, Boundary::Periodic, &[(part.clone(), true)]).unwrap(),
        cells_per_step: 1.0,
        shear_stress: None,
    };
    let mut march = March::new(Simulation {
        boundary: Boundary::Periodic,
        loading: Loading { control: Control::Load, history: History::Step { value: 0.1 } }.into(),
        times: TimeGrid::Uniform { end: 60.0 / 32.0 / velocity, steps: 1 },
        motion: Some(motion),
        ..simulation(grid, part, &of)
    })
    .unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        rows.push((step.row(), step.friction().unwrap().coefficient));
    }
    rows
}

#[test]
fn sliding_over_layers_that_creep_differently_is_that_over_one_law_where_the_base_is_far_away() {
    for velocity in [0.05, 0.5, 5.0] {
        let [found, expected] = [elastic(2.0), zener(1.0, 0.2)].map(|base| sliding_over(base, velocity));
        assert_eq!(found.len(), expected.len());
        let largest = expected.iter().fold(0.0_f64, |most, row| most.max(row.1.abs()));
        assert!(largest > 1e-3, "{velocity}: {largest}");
        for ((row, coefficient), (twin, own)) in found.iter().zip(&expected) {
            // Creep functions of waves are fitted to 1e-4; friction is a difference of forces in front and behind.
            assert!((coefficient - own).abs() < 2e-3 * largest, "{velocity}: {coefficient} {own}");
            assert!((row.max_pressure / twin.max_pressure - 1.0).abs() < 1e-3);
        }
    }
}
