//! Line contacts of bodies of layers, against closed forms, against periodic domains, and against themselves.

use asperity::Drive;
use std::f64::consts::PI;
use std::sync::Arc;

use asperity::kernel::{HalfSpace, Kernel};
use asperity::layer::{Base, BodyLayer, Interface, Layer, Layered, LayeredBody, Stack, response};
use asperity::material::{Body, Creep, CreepTerm, Lateral, Material, Modulus};
use asperity::simulation::Simulation;
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::{Boundary, Control, Grid, History, Loading, March, SolverOptions, TimeGrid};

const BONDED: Interface = Interface::Bonded;

fn layer(thickness: f64, shear: f64, poisson: f64) -> Layer {
    Layer { thickness, shear, poisson, interface: BONDED }
}

fn kernel(layers: &[Layer], base: Base) -> Arc<Layered> {
    Arc::new(Layered::new(vec![Stack::new(layers.to_vec(), base).unwrap()]).unwrap())
}

/// A cylinder of radius 1 on a compliance of 1/2: (1 - nu)/mu = 1 of the top layer.
fn cylinder(
    grid: Grid,
    boundary: Boundary,
    control: Control,
    value: f64,
    kernel: Arc<dyn Kernel>,
) -> Simulation {
    let part = Part::Shape { shape: Shape::Cylinder { radius: 1.0 }, center: [0.0, 0.0] };
    Simulation {
        boundary,
        kernel,
        creep: Creep::elastic(0.5),
        loading: Loading { control, history: History::Step { value } }.into(),
        solver: SolverOptions { tolerance: 1e-10, ..SolverOptions::default() },
        ..Simulation::new(grid, undeformed_gap(&grid, &[part]).unwrap())
    }
}

/// Approach, load, largest pressure and length of the contact at the end, and the pressure.
fn solved(simulation: Simulation) -> ([f64; 4], Vec<f64>) {
    let mut march = March::new(simulation).unwrap();
    while march.advance().unwrap().is_some() {}
    let step = march.last().unwrap();
    let row = step.row();
    ([row.approach, row.load, row.max_pressure, row.contact_area], step.pressure().iter().copied().collect())
}

#[track_caller]
fn close(a: &[f64], b: &[f64], tolerance: f64) {
    let scale = b.iter().fold(0.0, |most: f64, b| most.max(b.abs()));
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() < tolerance * scale, "{a} {b}, of {scale}");
    }
}

#[test]
fn a_thick_layer_and_a_layer_of_the_same_material_are_the_half_space() {
    let grid = Grid::line(256, 0.3).unwrap();
    let run = |kernel: Arc<dyn Kernel>| solved(cylinder(grid, Boundary::Free, Control::Load, 5e-3, kernel));
    let (half_space, exact) = run(Arc::new(HalfSpace));
    let same = Base::HalfSpace { shear: 0.7, poisson: 0.3 };
    for (kernel, tolerance) in [
        // The tolerance of the solver.
        (kernel(&[layer(0.01, 0.7, 0.3), layer(0.02, 0.7, 0.3)], same), 1e-7),
        // What the base adds to differences of the displacement: the square of the domain over the thickness, 1e-11.
        (kernel(&[layer(1e5, 0.5, 0.5)], Base::HalfSpace { shear: 1e-2, poisson: 0.0 }), 1e-7),
    ] {
        let (row, pressure) = run(kernel);
        close(&pressure, &exact, tolerance);
        assert!((row[0] / half_space[0] - 1.0).abs() < tolerance, "{row:?} {half_space:?}");
    }
    let (_, pressure) = run(kernel(&[layer(1e5, 0.7, 0.3)], Base::Rigid));
    close(&pressure, &exact, 1e-7);
}

#[test]
fn a_thick_layer_on_a_rigid_base_moves_by_the_logarithm_of_its_thickness() {
    // Far below the contact the displacement goes as (2 W/(pi E*)) ln(d/r): w = (2 W/(pi E*)) (ln(d/a) + a number).
    let load = 5e-3;
    let at = |d: f64| {
        let grid = Grid::line(512, 0.3).unwrap();
        solved(cylinder(
            grid,
            Boundary::Free,
            Control::Load,
            load,
            kernel(&[layer(d, 0.7, 0.3)], Base::Rigid),
        ))
        .0[0]
    };
    let [w, ten_times] = [at(100.0), at(1000.0)];
    let exact = 2.0 * load * 0.5 / PI * 10f64.ln();
    // The square of the contact over the thickness, and the tolerance of the solver.
    assert!(((ten_times - w) / exact - 1.0).abs() < 1e-6, "{w} {ten_times} {exact}");
}

#[test]
fn a_thin_layer_is_a_bed_of_springs_or_is_squeezed_out() {
    // Johnson (1985), section 5.8: a compressible layer is a bed of springs, W = 2 M a³/(3 R d), w = a²/(2 R). From an incompressible one
    // material is squeezed out, u = -(d³/3 mu) p'': p = mu (a² - x²)²/(8 R d³), W = 2 mu a⁵/(15 R d³), w = a²/(6 R).
    let (a, n) = (1e-2, 601);
    let run = |d: f64, nu: f64, w: f64| {
        let grid = Grid::line(n, 3.0 * a).unwrap();
        let stack = kernel(&[layer(d, 1.0 - nu, nu)], Base::Rigid);
        solved(cylinder(grid, Boundary::Free, Control::Approach, w, stack)).0
    };
    let errors = |ratio: f64| {
        let d = a / ratio;
        // M = 2 mu (1 - nu)/(1 - 2 nu), with mu = 1 - nu.
        let springs = 2.0 / 3.0 * 2.0 * 0.7 * 0.7 / 0.4 * a.powi(3) / d;
        let squeezed = 2.0 / 15.0 * 0.5 * a.powi(5) / d.powi(3);
        [run(d, 0.3, a * a / 2.0)[1] / springs - 1.0, run(d, 0.5, a * a / 6.0)[1] / squeezed - 1.0]
    };
    let [thin, thinner] = [20.0, 40.0].map(errors);
    // The zone at the edge, as wide as the layer is thick, has little pressure on springs, and less of it under a squeezed layer: errors
    // of second order in d/a.
    assert!(thin[0].abs() < 1e-3 && thinner[0].abs() < 0.5 * thin[0].abs(), "{thin:?} {thinner:?}");
    assert!(thin[1].abs() < 5e-2 && thinner[1].abs() < 0.4 * thin[1].abs(), "{thin:?} {thinner:?}");
}

#[test]
fn approach_and_load_say_the_same_on_a_rigid_base() {
    let grid = Grid::line(256, 0.3).unwrap();
    let stack = || kernel(&[layer(0.05, 0.5, 0.5), layer(0.02, 2.0, 0.2)], Base::Rigid);
    let (by_load, pressure) = solved(cylinder(grid, Boundary::Free, Control::Load, 5e-3, stack()));
    let (by_approach, same) = solved(cylinder(grid, Boundary::Free, Control::Approach, by_load[0], stack()));
    close(&by_approach, &by_load, 1e-8);
    close(&same, &pressure, 1e-7);
    // The approach is absolute: another domain tells the same.
    let wide = Grid::line(512, 0.6).unwrap();
    let (row, _) = solved(cylinder(wide, Boundary::Free, Control::Load, 5e-3, stack()));
    close(&row, &by_load, 1e-8);
}

#[test]
fn a_free_line_is_a_periodic_one_of_a_long_period() {
    let slip = Layer { interface: Interface::Slip, ..layer(0.03, 0.8, 0.2) };
    let soft = Base::HalfSpace { shear: 0.05, poisson: 0.5 };
    let hard = Base::HalfSpace { shear: 20.0, poisson: 0.3 };
    for (layers, base) in [
        (vec![layer(0.05, 0.7, 0.3)], Base::Rigid),
        (vec![layer(0.05, 0.5, 0.5)], Base::Rigid),
        (vec![slip, layer(0.05, 0.3, 0.4)], Base::Rigid),
        (vec![layer(0.05, 0.7, 0.3)], soft),
        (vec![layer(0.05, 0.5, 0.5)], hard),
    ] {
        let (n, side, times) = (192, 0.3, 32);
        let stack = kernel(&layers, base);
        let free = Grid::line(n, side).unwrap();
        let long = Grid::line(times * n, times as f64 * side).unwrap();
        let (row, pressure) = solved(cylinder(free, Boundary::Free, Control::Load, 3e-3, stack.clone()));
        let (periodic, repeated) = solved(cylinder(long, Boundary::Periodic, Control::Load, 3e-3, stack));
        let middle = &repeated[(times - 1) * n / 2..(times + 1) * n / 2];
        // A periodic kernel has the mean of a cell at its nodes: (q dx)²/24 of the shortest waves, seen at the edge of the contact.
        close(&pressure, middle, 5e-3);
        let mean = |p: &[f64]| p.iter().map(|p| p * p).sum::<f64>();
        assert!((mean(&pressure) / mean(middle) - 1.0).abs() < 5e-4, "{layers:?} {base:?}");
        if base == Base::Rigid {
            assert!((row[0] / periodic[0] - 1.0).abs() < 5e-4, "{layers:?}: {} {}", row[0], periodic[0]);
        }
    }
}

fn body(name: &str, material: Material, poisson: f64) -> Body {
    Body { name: name.into(), material, lateral: Lateral::Poisson(poisson), hardness: None }
}

fn zener(shear: f64, kelvin: f64, time: f64) -> Material {
    Material::zener(Modulus::Shear, shear, kelvin, time).unwrap()
}

/// Layers that creep differently.
fn creeping(layers: Vec<(f64, Body)>, base: Option<Body>) -> LayeredBody {
    let layer = |(thickness, material)| BodyLayer { thickness, interface: BONDED, material };
    LayeredBody { layers: layers.into_iter().map(layer).collect(), base }
}

#[test]
fn layers_that_creep_differently_end_at_the_relaxed_elastic_bodies() {
    // Shear moduli of the spring and of the Kelvin element (endless: elastic), its time, and Poisson's ratio.
    let rubber = |time: f64, nu: f64| (1.0, 0.5, time, nu);
    let elastic = |shear: f64, nu: f64| (shear, f64::INFINITY, 1.0, nu);
    for (layers, base) in [
        (vec![(0.05, rubber(1.0, 0.5))], Some(elastic(50.0, 0.3))),
        (vec![(0.05, rubber(1.0, 0.4)), (0.05, rubber(10.0, 0.5))], None),
        (vec![(0.02, elastic(5.0, 0.3))], Some(rubber(1.0, 0.5))),
    ] {
        let grid = Grid::line(192, 0.8).unwrap();
        let run = |relaxed: bool, times: TimeGrid| {
            let material = |&(shear, kelvin, time, nu): &(f64, f64, f64, f64)| {
                let material = match (relaxed, kelvin.is_finite()) {
                    (_, false) => Material::elastic(Modulus::Shear, shear).unwrap(),
                    (true, _) => {
                        Material::elastic(Modulus::Shear, 1.0 / (1.0 / shear + 1.0 / kelvin)).unwrap()
                    }
                    (false, _) => zener(shear, kelvin, time),
                };
                body("material", material, nu)
            };
            let layers = layers.iter().map(|(d, of)| (*d, material(of))).collect();
            let of = response(&[creeping(layers, base.as_ref().map(material))]).unwrap();
            let simulation = cylinder(grid, Boundary::Free, Control::Load, 5e-3, Arc::new(of.kernel));
            solved(Simulation { creep: of.creep, layers: of.waves, times, ..simulation })
        };
        let (row, pressure) = run(false, TimeGrid::Logarithmic { first: 1e-2, end: 1e4, steps: 60 });
        let (exact, at_rest) = run(true, TimeGrid::Uniform { end: 1.0, steps: 1 });
        // The misfit of the waves, below 1e-4, and the error of the steps.
        assert!((row[0] / exact[0] - 1.0).abs() < 5e-4, "{layers:?} {base:?}: {row:?} {exact:?}");
        close(&pressure, &at_rest, 2e-3);
    }
}

#[test]
fn a_separable_stack_under_a_held_approach_relaxes_as_its_law() {
    let creep = Creep {
        instantaneous: 0.5,
        terms: vec![CreepTerm { compliance: 1.0, retardation_time: 2.0 }],
        fluidity: 0.0,
    };
    let grid = Grid::line(128, 0.3).unwrap();
    let stack = kernel(&[layer(0.05, 0.7, 0.3)], Base::Rigid);
    let simulation = cylinder(grid, Boundary::Free, Control::Approach, 2e-3, stack);
    let (first, _) = solved(simulation.clone());
    let times = TimeGrid::Uniform { end: 3.0, steps: 5 };
    let (row, _) = solved(Simulation { creep: creep.clone(), times, ..simulation });
    let modulus = creep.to_relaxation().unwrap();
    let share = modulus.value(3.0) / modulus.value(0.0);
    // A held approach is exact in steps of any length.
    assert!((row[1] / first[1] / share - 1.0).abs() < 1e-8, "{} {} {share}", row[1], first[1]);
}
