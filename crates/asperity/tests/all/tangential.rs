//! Tangential loads: closed forms, symmetries, limits, resumed runs.

use std::sync::Arc;

use asperity::drive::March;
use asperity::material::{Creep, CreepTerm};
use asperity::quantities::{Quantities, Quantity};
use asperity::surface::{Part, Shape, undeformed_gap};
use asperity::tangential::{Coupling, SlipRow, Tangential, TangentialControl};
use asperity::{
    Boundary, Control, Drive, Error, Grid, History, Loading, Simulation, SolverOptions, TimeGrid,
};
use ndarray::Array2;

const MU: f64 = 0.3;

/// A rigid sphere of radius 1 on a half-space with G = 1 under a load of 1, as in the closed forms.
fn sphere(cells: usize, nu: f64, tangential: Tangential) -> Simulation {
    let grid = Grid::new([cells; 2], [1.7; 2]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 1.0 }, center: [0.0, 0.0] };
    let gap = undeformed_gap(&grid, &[sphere]).unwrap();
    Simulation {
        creep: Creep::elastic(0.5 * (1.0 - nu)),
        loading: Loading { control: Control::Load, history: History::Step { value: 1.0 } }.into(),
        times: TimeGrid::Uniform { end: 5.0, steps: 10 },
        tangential: Some(Arc::new(tangential)),
        ..Simulation::new(grid, gap)
    }
}

fn along(axis: usize, nu: f64, control: TangentialControl, points: &[(f64, f64)]) -> Tangential {
    let mut histories = [0; 2].map(|_| History::Step { value: 0.0 });
    histories[axis] = History::Table { points: points.to_vec() };
    Tangential {
        coefficient: MU,
        coefficients: None,
        shear_limit: f64::INFINITY,
        poisson: nu,
        beta: 0.0,
        coupling: Coupling::Neglect,
        control,
        histories,
    }
}

/// Up to 0.6 μ W, down to the opposite, and up again.
fn loop_of(axis: usize, nu: f64) -> Tangential {
    let q = 0.6 * MU;
    along(axis, nu, TangentialControl::Force, &[(0.0, 0.0), (1.0, q), (3.0, -q), (5.0, q)])
}

struct State {
    row: SlipRow,
    path: Array2<f64>,
    heat: Array2<f64>,
    slip: Array2<f64>,
    traction: [Array2<f64>; 2],
    contact: Array2<u8>,
    pressure: Array2<f64>,
}

fn rest(march: &mut March) -> Result<Vec<State>, Error> {
    let mut states = vec![];
    while let Some(step) = march.advance()? {
        let shape = step.simulation().grid.shape();
        let (mut traction, mut contact) = ([0; 2].map(|_| Array2::zeros(shape)), Array2::zeros(shape));
        traction.iter_mut().enumerate().for_each(|(axis, to)| step.tangential_traction_into(axis, to));
        step.contact_into(&mut contact);
        let (row, pressure) = (step.slip_row().unwrap(), step.pressure().to_owned());
        let [mut path, mut heat, mut slip] = [0; 3].map(|_| Array2::zeros(shape));
        step.slip_path_into(&mut path);
        step.friction_work_into(&mut heat);
        step.slip_into(0, &mut slip);
        states.push(State { row, path, heat, slip, traction, contact, pressure });
    }
    Ok(states)
}

fn run(simulation: Simulation) -> Result<Vec<State>, Error> {
    rest(&mut March::new(simulation).unwrap())
}

#[test]
fn a_sphere_under_an_alternating_force_follows_cattaneo_and_mindlin() {
    // Displacements at Q = 0.3, 0.6 μW on loading and 0.3, 0, -0.3, -0.6 on unloading, and the area of the loop, for G = R = W = 1.
    let exact = [
        (
            0.0,
            0.0713130441296,
            [0.0392746923632, 0.00528292034182, -0.031249437454, -0.0713130441296],
            0.00256208403612,
        ),
        (
            0.3,
            0.0682687400791,
            [0.0375980831748, 0.0050573961619, -0.029915420793, -0.0682687400791],
            0.00245271045792,
        ),
    ];
    for (nu, largest, unloading, energy) in exact {
        let simulation =
            Simulation { times: TimeGrid::Uniform { end: 5.0, steps: 20 }, ..sphere(96, nu, loop_of(0, nu)) };
        let states = run(simulation).unwrap();
        let displacement = |n: usize| states[n].row.displacement[0];
        // With ν > 0 the closed form neglects the slip across the force.
        let tolerance = largest * if nu == 0.0 { 1e-3 } else { 2e-3 };
        // Rows are a quarter of a second apart; t = 1 is row 4, and from there the force changes by 0.3 μW in half a second.
        assert!((displacement(4) - largest).abs() < tolerance, "{nu}: {} {largest}", displacement(4));
        for (n, exact) in unloading.into_iter().enumerate() {
            let found = displacement(4 + 2 * (n + 1));
            assert!((found - exact).abs() < tolerance, "{nu} {n}: {found} {exact}");
        }
        // Both branches of a loop are alike: it closes, but for what slip across the force leaves.
        let open = (displacement(20) - displacement(4)).abs() / largest;
        assert!(open < if nu == 0.0 { 1e-5 } else { 1e-3 }, "{nu}: {open}");
        let work = states[20].row.work - states[4].row.work;
        assert!((work / energy - 1.0).abs() < 5e-3, "{work} {energy}");
        // The work of the force over the loop is what friction takes: exact in each step, but for the trapezoid over its force.
        let force = |n: usize| states[n].row.force[0];
        let area: f64 =
            (4..20).map(|n| 0.5 * (force(n) + force(n + 1)) * (displacement(n + 1) - displacement(n))).sum();
        assert!((work / area - 1.0).abs() < 0.02, "{nu}: {work} {area}");
        assert!(states.iter().all(|state| state.row.outcome.certificate < 1e-2));
        // The map of the energy holds the work, and the slip goes there and back: in each cell two ways of the same length in a loop.
        let cell = (1.7 / 96.0) * (1.7 / 96.0);
        assert!((states[20].heat.sum() * cell / states[20].row.work - 1.0).abs() < 1e-12);
        let path = &states[20].path - &states[4].path;
        let way = (&states[12].slip - &states[4].slip).mapv(f64::abs);
        let most = way.iter().copied().fold(0.0, f64::max);
        assert!(path.iter().zip(&way).all(|(path, way)| (path - 2.0 * way).abs() < 0.02 * most), "{nu}");
        assert!(states[4].slip.iter().zip(&states[4].contact).all(|(s, c)| *c == 3 || *s == 0.0));
    }
}

#[test]
fn the_axes_are_alike() {
    let (along_x, along_y) =
        (run(sphere(32, 0.4, loop_of(0, 0.4))).unwrap(), run(sphere(32, 0.4, loop_of(1, 0.4))).unwrap());
    for (x, y) in along_x.iter().zip(&along_y) {
        let peak = x.pressure.iter().copied().fold(0.0, f64::max);
        for axis in 0..2 {
            let difference = &x.traction[axis] - &y.traction[1 - axis].t();
            // The tolerance of both solves, times the stiffness of a cell.
            assert!(difference.iter().all(|d| d.abs() < 1e-4 * MU * peak));
        }
        assert_eq!(x.row.slip_area, y.row.slip_area);
    }
}

#[test]
fn without_friction_nothing_holds_and_with_much_everything_sticks() {
    let none = Tangential { coefficient: 0.0, ..loop_of(0, 0.3) };
    let error = run(sphere(24, 0.3, none.clone())).err().unwrap();
    assert!(matches!(error, Error::Sliding { max: 0.0, .. }), "{error}");
    let pulled = along(0, 0.3, TangentialControl::Displacement, &[(0.0, 0.0), (5.0, 0.4)]);
    let states = run(sphere(24, 0.3, Tangential { coefficient: 0.0, ..pulled.clone() })).unwrap();
    assert!(states.iter().all(|state| state.traction.iter().flatten().all(|q| *q == 0.0)));
    assert!((states[10].row.displacement[0] - 0.4).abs() < 1e-15);
    // Full stick: no work, and the same stiffness in every step.
    let states = run(sphere(24, 0.3, Tangential { coefficient: 1e6, ..loop_of(0, 0.3) })).unwrap();
    let stiffness: Vec<f64> = states[1..].iter().map(|state| state.row.stiffness).collect();
    assert!(stiffness.iter().all(|k| (k / stiffness[0] - 1.0).abs() < 1e-5), "{stiffness:?}");
    assert!(states.iter().all(|state| state.row.work == 0.0 && !state.contact.iter().any(|c| *c == 3)));
    // Under a large displacement all slides, with the force μ W.
    let states = run(sphere(24, 0.3, pulled)).unwrap();
    assert!((states[10].row.force[0] / MU - 1.0).abs() < 1e-3);
}

#[test]
fn the_largest_force_is_held_and_no_more() {
    let at = |share: f64| along(0, 0.3, TangentialControl::Force, &[(0.0, 0.0), (5.0, share * MU)]);
    let states = run(sphere(24, 0.3, at(1.0))).unwrap();
    let last = &states[10];
    assert_eq!(last.row.stick_area, 0.0);
    assert!((&last.traction[0] - MU * &last.pressure).iter().all(|d| d.abs() < 1e-9));
    match run(sphere(24, 0.3, at(1.0 + 1e-6))) {
        Err(Error::Sliding { force, max, time, .. }) => {
            // The load is kept to its own rounding.
            assert!((max / MU - 1.0).abs() < 1e-9 && force > max && time == 5.0);
        }
        other => panic!("{:?}", other.err()),
    }
}

#[test]
fn a_glued_punch_creeps_as_the_material_does() {
    // δ(t) = Q (2 - ν) J(t)/(8 a) on J(t) = 0.25 + 0.75 (1 - exp(-t)); the grid's punch has an effective radius, known from t = 0.
    let (nu, q) = (0.3, 0.5);
    let grid = Grid::new([48, 48], [2.4, 2.4]).unwrap();
    let punch = Array2::from_shape_fn(grid.shape(), |(i, j)| {
        let inside = f64::hypot(grid.x(i) - 1.2, grid.y(j) - 1.2) < 1.0;
        if inside { 0.0 } else { f64::INFINITY }
    });
    let share = 0.5 * (1.0 - nu);
    let creep = Creep {
        instantaneous: 0.25 * share,
        terms: vec![CreepTerm { compliance: 0.75 * share, retardation_time: 1.0 }],
        fluidity: 0.0,
    };
    let mut glued = along(0, nu, TangentialControl::Force, &[(0.0, q), (5.0, q)]);
    glued.coefficient = 1e6;
    let base = sphere(24, nu, glued);
    for steps in [1, 10] {
        let simulation = Simulation {
            creep: creep.clone(),
            loading: base.loading.clone(),
            times: TimeGrid::Uniform { end: 5.0, steps },
            tangential: base.tangential.clone(),
            solver: SolverOptions { tolerance: 1e-8, ..SolverOptions::default() },
            ..Simulation::new(grid, punch.clone())
        };
        let states = run(simulation).unwrap();
        let displacement: Vec<f64> = states.iter().map(|state| state.row.displacement[0]).collect();
        // 0.072 of the closed form would be Q (2 - ν) 0.25/8: the counted punch is larger by some half a cell.
        let exact = q * (2.0 - nu) * 0.25 / 8.0;
        assert!((displacement[0] / exact - 1.0).abs() < 0.03, "{} {exact}", displacement[0]);
        // Under a held force u runs with the creep of the material, in steps of any length.
        for (n, d) in displacement.iter().enumerate() {
            let t = 5.0 * n as f64 / steps as f64;
            let grown = (0.25 + 0.75 * (1.0 - f64::exp(-t))) / 0.25;
            assert!(
                (d / displacement[0] / grown - 1.0).abs() < 1e-6,
                "{steps} {n}: {}",
                d / displacement[0] / grown
            );
        }
    }
}

#[test]
fn a_run_goes_on_in_the_middle_of_a_loop() {
    let simulation = || {
        let mut simulation = sphere(24, 0.4, loop_of(1, 0.4));
        simulation.boundary = Boundary::Periodic;
        simulation.creep.terms = vec![CreepTerm { compliance: 0.4, retardation_time: 2.0 }];
        simulation
    };
    let whole = run(simulation()).unwrap();
    let mut march = March::new(simulation()).unwrap();
    for _ in 0..5 {
        march.advance().unwrap();
    }
    let checkpoint = march.checkpoint().into_owned();
    let resumed = rest(&mut March::resume(simulation(), &checkpoint).unwrap()).unwrap();
    assert_eq!(resumed.len(), whole.len() - 5);
    for (resumed, whole) in resumed.iter().zip(&whole[5..]) {
        assert_eq!(resumed.row, whole.row);
        assert_eq!(resumed.traction, whole.traction);
    }
}

#[test]
fn loads_that_are_not_solved_are_refused() {
    let base = || sphere(16, 0.3, loop_of(0, 0.3));
    let with = |tangential: Tangential| Simulation { tangential: Some(Arc::new(tangential)), ..base() };
    let jump = along(0, 0.3, TangentialControl::Force, &[(0.0, 0.0), (1.0, 0.0), (1.0, 0.1)]);
    let map = Array2::from_elem((3, 3), 0.1);
    let cases = [
        (with(Tangential { coefficient: -0.1, ..loop_of(0, 0.3) }), "friction.coefficient"),
        (with(Tangential { coefficients: Some(map), ..loop_of(0, 0.3) }), "friction.field"),
        (with(Tangential { shear_limit: 0.0, ..loop_of(0, 0.3) }), "friction.shear_limit"),
        (with(jump), "tangential.x"),
        (
            Simulation { times: TimeGrid::Adaptive { end: 5.0, tolerance: 1e-3, first: 0.1 }, ..base() },
            "time",
        ),
    ];
    for (simulation, key) in cases {
        match March::new(simulation) {
            Err(error) => assert_eq!(error.parameter(), key, "{error}"),
            Ok(_) => panic!("{key}"),
        }
    }
}

#[test]
fn any_course_keeps_the_limit_of_friction_and_loses_work() {
    // Reversed in every step, along a turning path, under a load that changes and is lost, on a map with frictionless cells.
    let zigzag: Vec<(f64, f64)> =
        (0..=10).map(|n| (0.5 * f64::from(n), 0.02 * [0.0, 1.0, -1.0][n as usize % 3])).collect();
    let cells = [32, 32];
    let half = Array2::from_shape_fn((32, 32), |(i, j)| if (i + j) % 4 == 0 { 0.0 } else { MU });
    let turning = [
        History::Table { points: vec![(0.0, 0.0), (2.5, 0.08), (5.0, 0.0)] },
        History::Table { points: vec![(0.0, 0.0), (2.5, 0.02), (5.0, 0.09)] },
    ];
    let control = TangentialControl::Displacement;
    let cases = [
        along(0, 0.3, TangentialControl::Force, &zigzag),
        Tangential { histories: turning, ..along(0, 0.3, control, &[(0.0, 0.0)]) },
        Tangential { coefficients: Some(half.clone()), ..along(1, 0.3, control, &[(0.0, 0.0), (5.0, 0.1)]) },
        Tangential { shear_limit: 0.05, ..along(1, 0.3, control, &[(0.0, 0.0), (5.0, 0.1)]) },
    ];
    for (n, tangential) in cases.into_iter().enumerate() {
        // The load falls to 0.3, and in all but the first case to nothing in between.
        let least = if n == 0 { 0.3 } else { 0.0 };
        let points = vec![(0.0, 1.0), (1.0, least), (2.0, least), (5.0, 1.0)];
        let simulation = Simulation {
            loading: Loading { control: Control::Load, history: History::Table { points } }.into(),
            ..sphere(cells[0], 0.3, tangential.clone())
        };
        let states = run(simulation).unwrap();
        for (before, state) in states.iter().zip(&states[1..]) {
            for ((i, j), p) in state.pressure.indexed_iter() {
                let mu = tangential.coefficients.as_ref().map_or(MU, |map| map[(i, j)]);
                let q = f64::hypot(state.traction[0][(i, j)], state.traction[1][(i, j)]);
                assert!(q <= (mu * p).min(tangential.shear_limit) * (1.0 + 1e-12), "{n} ({i}, {j}): {q} {p}");
            }
            // What friction takes is heat, but for the tolerance of the solve.
            assert!(state.row.work >= before.row.work - 1e-9, "{n}: {} {}", before.row.work, state.row.work);
        }
        let area: f64 = states[10].traction[0].sum() * (1.7 / 32.0) * (1.7 / 32.0);
        assert!((states[10].row.force[0] - area).abs() < 1e-12);
    }
}

#[test]
fn a_step_of_gross_slip_is_solved_once_its_error_is_rounding() {
    // Steel, at the turn of a displacement far beyond stick. Cells at the rim carry so little that the violation there stays at 1e-4 of the
    // displacement, four orders above the certified error of the tractions.
    let grid = Grid::new([64, 64], [0.6e-3, 0.6e-3]).unwrap();
    let sphere = Part::Shape { shape: Shape::Sphere { radius: 10e-3 }, center: [0.0, 0.0] };
    let history = History::Sine { mean: 0.0, amplitude: 10e-6, frequency: 1.0 };
    let mut march = March::new(Simulation {
        creep: Creep::elastic(2.0 * (1.0 - 0.09) / 210e9),
        loading: Loading { control: Control::Load, history: History::Step { value: 50.0 } }.into(),
        times: TimeGrid::Uniform { end: 0.25, steps: 10 },
        solver: SolverOptions { tolerance: 1e-9, ..SolverOptions::default() },
        tangential: Some(Arc::new(Tangential {
            coefficient: 0.6,
            histories: [history, History::Step { value: 0.0 }],
            ..along(0, 0.3, TangentialControl::Displacement, &[(0.0, 0.0), (1.0, 0.0)])
        })),
        ..Simulation::new(grid, undeformed_gap(&grid, &[sphere]).unwrap())
    })
    .unwrap();
    let mut last = SlipRow::default();
    while let Some(step) = march.advance().unwrap() {
        last = step.slip_row().unwrap();
        assert!(last.outcome.residual <= 1e-9 || last.outcome.certificate < 1e-7, "{:?}", last.outcome);
    }
    // All of the contact slips.
    assert!((last.force[0] / (0.6 * 50.0) - 1.0).abs() < 1e-3 && last.stick_area == 0.0, "{last:?}");
}

/// Force, displacement, work, what springs and dashpots took, and the work of friction, in each row.
fn account(simulation: Simulation) -> Vec<[f64; 5]> {
    let energies = [Quantity::ExternalWork, Quantity::ElasticEnergy, Quantity::DissipatedEnergy];
    let mut march = March::new(Simulation { quantities: Quantities::of(energies), ..simulation }).unwrap();
    let mut rows = vec![];
    while let Some(step) = march.advance().unwrap() {
        let [work, stored, lost] = energies.map(|quantity| step.quantity(quantity).unwrap()[0]);
        let row = step.slip_row().unwrap();
        rows.push([row.force[0], row.displacement[0], work, stored + lost, row.work]);
    }
    rows
}

#[test]
fn surfaces_that_stick_store_half_of_force_times_displacement() {
    let mut stuck = loop_of(0, 0.3);
    stuck.coefficient = 1e3;
    let rows = account(sphere(32, 0.3, stuck));
    let rest = rows[0][3];
    for [force, way, work, kept, rubbed] in rows {
        // The solver's tolerance, 1e-6 of displacements; where the force passes 0 beside the energy of the load.
        assert!((kept - rest - 0.5 * force * way).abs() < 1e-5 * rest, "{force} {way} {kept}");
        assert!((work - kept - rubbed).abs() < 1e-5 * rest && rubbed.abs() < 1e-5 * rest);
    }
}

#[test]
fn the_work_of_an_alternating_force_is_stored_lost_in_the_bodies_and_rubbed() {
    let creep = Creep {
        instantaneous: 0.35,
        terms: vec![CreepTerm { compliance: 0.35, retardation_time: 1.0 }],
        fluidity: 0.0,
    };
    for creep in [Creep::elastic(0.35), creep] {
        let missing = [20, 80].map(|steps| {
            let times = TimeGrid::Uniform { end: 5.0, steps };
            let rows =
                account(Simulation { times, creep: creep.clone(), ..sphere(32, 0.3, loop_of(0, 0.3)) });
            let [.., last] = rows[..] else { panic!("no rows") };
            assert!(last[4] > 0.0);
            rows.iter().map(|row| (row[2] - row[3] - row[4]).abs()).fold(0.0, f64::max) / last[4]
        });
        // Friction takes the end of a step for all of it: of first order.
        assert!(missing[0] < 0.2 && missing[1] < 0.4 * missing[0], "{missing:?}");
    }
}
