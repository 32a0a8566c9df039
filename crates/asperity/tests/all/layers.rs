//! Contacts of bodies of layers, against solutions that share nothing with the code.

use asperity::Drive;
use std::sync::Arc;

use asperity::kernel::{HalfSpace, Kernel};
use asperity::layer::{Base, Interface, Layer, Layered, Stack};
use asperity::material::{Creep, CreepTerm};
use asperity::operator::{Operator, plan};
use asperity::simulation::Simulation;
use asperity::surface::{Part, Punch, Shape, undeformed_gap};
use asperity::{Boundary, Control, Grid, History, Loading, March, SolverOptions, TimeGrid};

fn layer(thickness: f64, shear: f64, poisson: f64) -> Layer {
    Layer { thickness, shear, poisson, interface: Interface::Bonded }
}

fn kernel(layers: &[Layer], base: Base) -> Arc<Layered> {
    Arc::new(Layered::new(vec![Stack::new(layers.to_vec(), base).unwrap()]).unwrap())
}

/// A sphere of radius 1 under a step of load; (1 - nu)/mu = 1 of the layer is a compliance of 1/2.
fn sphere(n: usize, side: f64, load: f64, kernel: Arc<dyn Kernel>) -> Simulation {
    let grid = Grid::new([n, n], [side, side]).unwrap();
    let part = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    Simulation {
        kernel,
        creep: Creep::elastic(0.5),
        loading: Loading { control: Control::Load, history: History::Step { value: load } }.into(),
        solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
        ..Simulation::new(grid, undeformed_gap(&grid, &[part]).unwrap())
    }
}

/// (a/d, approach R/a^2, load c1 R/a^3, p0 c1 R/a) of Fredholm's equation of the second kind, solved by Gauss-Nystrom
/// quadrature to 12 digits.
struct Family {
    of: fn(f64) -> (Layer, Base),
    rows: [(f64, f64, f64, f64); 3],
}

const FAMILIES: [Family; 6] = [
    Family {
        of: |d| (layer(d, 0.7, 0.3), Base::Rigid),
        rows: [
            (0.3, 0.8383592609335504, 2.7012322901994485, 1.2901685508423557),
            (1.0, 0.6476223199274068, 3.3572492069990036, 1.6647482926965813),
            (3.0, 0.5471689248435423, 6.843446106126245, 3.948201090696322),
        ],
    },
    Family {
        of: |d| (layer(d, 0.55, 0.45), Base::Rigid),
        rows: [
            (0.3, 0.8106946704972856, 2.71262851801714, 1.2957831727373461),
            (1.0, 0.5947223776361904, 3.603522704467181, 1.810001984583095),
            (3.0, 0.4809093021949289, 9.185860628969206, 5.573907721597693),
        ],
    },
    Family {
        of: |d| (Layer { interface: Interface::Slip, ..layer(d, 0.8, 0.2) }, Base::Rigid),
        rows: [
            (0.3, 0.8603041434175177, 2.688922298084272, 1.2840780195911627),
            (1.0, 0.6739806449887544, 3.1562454945736373, 1.5432419710638519),
            (3.0, 0.5601160515563773, 5.950057794853126, 3.362100925655484),
        ],
    },
    Family {
        of: |d| (layer(d, 0.7, 0.3), Base::HalfSpace { shear: 0.7 / 4.0, poisson: 0.3 }),
        rows: [
            (0.3, 1.3538668334187023, 2.6201223054750176, 1.250570421563387),
            (1.0, 1.5887613066843735, 1.9874073678456987, 0.9041248941381359),
            (3.0, 1.3089492432569807, 1.1409796606684954, 0.4342867392304033),
        ],
    },
    Family {
        of: |d| (layer(d, 0.5, 0.5), Base::HalfSpace { shear: 5.0, poisson: 0.3 }),
        rows: [
            (0.3, 0.8212161564620979, 2.7111897524601147, 1.2950797750132477),
            (1.0, 0.6307438860075733, 3.560275629579062, 1.7855948701879543),
            (3.0, 0.6316281355141051, 8.117327878436141, 4.847425145671106),
        ],
    },
    Family {
        of: |d| (layer(d, 0.75, 0.25), Base::HalfSpace { shear: 0.75 / 50.0, poisson: 0.3 }),
        rows: [
            (0.3, 3.906429730070823, 2.5243796217789303, 1.2043951969904851),
            (1.0, 4.662458395921996, 1.129585242713915, 0.4778496312802082),
            (3.0, 2.295328393078142, 0.25628238472485415, 0.04886827472920913),
        ],
    },
];

/// Cells per contact radius, and the side of the domain over it.
const FINE: f64 = 30.0;
const SIDE: f64 = 3.2;

#[test]
fn a_sphere_on_a_layer_solves_the_integral_equation() {
    for family in FAMILIES {
        for (a_over_d, approach, load, peak) in family.rows {
            let a = 0.1;
            let (top, base) = (family.of)(a / a_over_d);
            // An odd number of cells has one in the middle: the pressure on a stiff coating is largest at the border.
            let n = (FINE * SIDE) as usize + 1;
            let simulation = sphere(n, a * SIDE, load * a.powi(3), kernel(&[top], base));
            let mut march = March::new(simulation).unwrap();
            let step = march.advance().unwrap().unwrap();
            // The half-space takes 12: a wrong preconditioner would take a hundred.
            let convolutions = step.row().convolutions;
            assert!(convolutions <= 20, "{top:?} {base:?}: {convolutions} convolutions");
            let [w, p] = [step.row().approach / (a * a), step.pressure()[(n / 2, n / 2)] / a];
            let [w, p] = [w / approach - 1.0, p / peak - 1.0];
            // Cells of a thirtieth of the radius: second order. (The half-space: 1e-4.)
            assert!(w.abs() < 3e-4, "{top:?} {base:?}: approach is off by {w:e}");
            assert!(p.abs() < 1e-3, "{top:?} {base:?}: peak pressure is off by {p:e}");
        }
    }
}

#[test]
fn a_flat_punch_on_a_layer_is_as_stiff_as_hayes_says() {
    // W c1/(4 a w) of Hayes et al. (1972), by the integral equation.
    let rows =
        [(0.4, 0.3, 1.4726120019749862), (1.0, 0.5, 3.618735848959762), (2.0, 0.45, 6.4205880185441195)];
    for (a_over_d, nu, kappa) in rows {
        let (a, n) = (1.0, 121);
        let grid = Grid::new([n, n], [2.4 * a; 2]).unwrap();
        let punch = Part::Shape { shape: Shape::FlatPunch(Punch::Circle { radius: a }), center: [0.0, 0.0] };
        let simulation = |kernel: Arc<dyn Kernel>| Simulation {
            gap: undeformed_gap(&grid, std::slice::from_ref(&punch)).unwrap(),
            ..Simulation { grid, ..sphere(n, 2.4 * a, 1.0, kernel) }
        };
        let stiffness = |kernel: Arc<dyn Kernel>| {
            1.0 / March::new(simulation(kernel)).unwrap().advance().unwrap().unwrap().row().approach
        };
        let on_layer = stiffness(kernel(&[layer(a / a_over_d, 1.0 - nu, nu)], Base::Rigid));
        // The ratio to a half-space: the staircase of the edge is the same for both to first order.
        let ratio = on_layer / stiffness(Arc::new(HalfSpace));
        assert!((ratio / kappa - 1.0).abs() < 1e-2, "a/d = {a_over_d}: {ratio} {kappa}");
    }
}

/// Conjugate gradients on K x = b for a rough b, without a preconditioner: the smallest p'Kp/p'p of all directions, over K00.
fn least_curvature(operator: &mut dyn Operator, steps: usize) -> f64 {
    let n = operator.grid().len();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut r: Vec<f64> = (0..n).map(|k| ((k * 7919 % 1013) as f64) / 1013.0 - 0.3).collect();
    let (mut p, mut kp, mut least) = (r.clone(), vec![0.0; n], f64::INFINITY);
    for _ in 0..steps {
        operator.apply_into(&p, &mut kp);
        let curvature = dot(&p, &kp);
        least = least.min(curvature / dot(&p, &p));
        let (old, alpha) = (dot(&r, &r), dot(&r, &r) / curvature);
        r.iter_mut().zip(&kp).for_each(|(r, kp)| *r -= alpha * kp);
        let beta = dot(&r, &r) / old;
        p.iter_mut().zip(&r).for_each(|(p, r)| *p = r + beta * *p);
    }
    least / operator.self_influence()
}

#[test]
fn the_operator_is_positive_for_all_sorts_of_stacks() {
    let grid = Grid::new([40, 32], [1.0, 0.8]).unwrap();
    let mut seed = 12345_u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    for n in 0..80 {
        let count = 1 + n % 3;
        let layers: Vec<Layer> = (0..count)
            .map(|_| Layer {
                // From 0.4 of a cell to 30 times the domain.
                thickness: 10f64.powf(-2.0 + 3.5 * random()),
                shear: 10f64.powf(-3.0 + 6.0 * random()),
                poisson: [0.5, 0.0, 0.5 * random()][(3.0 * random()) as usize],
                interface: if random() < 0.3 { Interface::Slip } else { Interface::Bonded },
            })
            .collect();
        let base = if random() < 0.5 { Base::Rigid } else { Base::HalfSpace { shear: 1.0, poisson: 0.3 } };
        let mut operator = plan(grid, Boundary::Free, kernel(&layers, base)).unwrap();
        let least = least_curvature(&mut *operator, 60);
        assert!(least > 0.0, "{layers:?} {base:?}: {least:e}");
    }
}

#[test]
fn a_thick_layer_and_a_layer_of_the_same_material_are_the_half_space() {
    let run = |kernel: Arc<dyn Kernel>| {
        let mut march = March::new(sphere(96, 0.3, 1e-3, kernel)).unwrap();
        let row = march.advance().unwrap().unwrap().row();
        [row.approach, row.max_pressure, row.contact_area]
    };
    let half_space = run(Arc::new(HalfSpace));
    let close = |kernel: Arc<Layered>, tolerance: f64| {
        let layered = run(kernel);
        for (a, b) in layered.iter().zip(half_space) {
            assert!((a / b - 1.0).abs() < tolerance, "{layered:?} {half_space:?}");
        }
    };
    let same = Base::HalfSpace { shear: 0.7, poisson: 0.3 };
    // The tolerance of the solver.
    close(kernel(&[layer(0.01, 0.7, 0.3), layer(0.02, 0.7, 0.3)], same), 1e-8);
    // What the base adds: about its compliance over the thickness, 1e-8 of the approach and 1e-6.
    close(kernel(&[layer(1e6, 0.7, 0.3)], Base::Rigid), 1e-7);
    close(kernel(&[layer(1e6, 0.5, 0.5)], Base::HalfSpace { shear: 1e-2, poisson: 0.0 }), 1e-5);
}

#[test]
fn a_separable_stack_creeps_like_its_law() {
    // A held approach on a layer relaxes exactly as 1/C in Laplace space whatever the stack: against the elastic answer.
    let creep = Creep {
        instantaneous: 0.5,
        terms: vec![CreepTerm { compliance: 1.0, retardation_time: 2.0 }],
        fluidity: 0.0,
    };
    let stack = kernel(&[layer(0.05, 0.7, 0.3)], Base::Rigid);
    let simulation = sphere(64, 0.3, 1e-4, stack.clone());
    let run = |creep: &Creep, load: f64| {
        let creep = creep.clone();
        let times = TimeGrid::Uniform { end: 8.0, steps: 4 };
        let loading = Loading { control: Control::Load, history: History::Step { value: load } }.into();
        let mut march = March::new(Simulation { creep, times, loading, ..simulation.clone() }).unwrap();
        let mut rows = vec![];
        while let Some(step) = march.advance().unwrap() {
            rows.push(step.row());
        }
        rows
    };
    // Growing contact under a held load: the approach is that of the elastic contact of compliance C(t).
    let rows = run(&creep, 1e-4);
    for row in &rows {
        let elastic = run(&Creep::elastic(creep.value(row.time())), 1e-4)[0].approach;
        assert!((row.approach / elastic - 1.0).abs() < 1e-6, "{} {}", row.approach, elastic);
    }
}

#[test]
fn full_contact_on_a_rigid_base_is_determined_by_the_approach() {
    let grid = Grid::new([32, 32], [1.0, 1.0]).unwrap();
    let tau = std::f64::consts::TAU;
    let gap = ndarray::Array2::from_shape_fn((32, 32), |(i, _)| 1e-3 * (1.0 + (tau * grid.x(i)).cos()));
    let approach = |kernel: Arc<Layered>| {
        let loading = Loading { control: Control::Approach, history: History::Step { value: 0.1 } };
        let simulation = Simulation {
            boundary: Boundary::Periodic,
            kernel,
            creep: Creep::elastic(0.5),
            loading: loading.into(),
            ..Simulation::new(grid, gap.clone())
        };
        let mut march = March::new(simulation).unwrap();
        march.advance().map(|step| step.unwrap().row().load)
    };
    let compressible = Stack::new(vec![layer(0.2, 0.7, 0.3)], Base::Rigid).unwrap();
    let load = approach(Arc::new(Layered::new(vec![compressible.clone()]).unwrap())).unwrap();
    // The mean gap, 1e-3, is closed and the rest squeezes the layer.
    let exact = (0.1 - 1e-3) / compressible.uniform().unwrap();
    assert!((load / exact - 1.0).abs() < 1e-5, "{load} {exact}");
    // An incompressible layer keeps its volume, and a half-space does not determine its mean.
    for kernel in [
        kernel(&[layer(0.2, 0.5, 0.5)], Base::Rigid),
        kernel(&[layer(0.2, 0.7, 0.3)], Base::HalfSpace { shear: 1.0, poisson: 0.3 }),
    ] {
        assert!(approach(kernel).unwrap_err().to_string().contains("closes the whole periodic gap"));
    }
}

#[test]
fn a_layer_much_thinner_than_a_cell_is_refused() {
    let on = |boundary| Simulation {
        boundary,
        ..sphere(32, 1.0, 1e-3, kernel(&[layer(1e-3, 1.0, 0.3)], Base::Rigid))
    };
    let error = on(Boundary::Free).validate().unwrap_err().to_string();
    assert!(error.contains("4 times the thickness of the top layer"), "{error}");
    // A periodic domain takes the symbol, which knows the layer at every wave of the grid.
    assert!(on(Boundary::Periodic).validate().is_ok());
}
